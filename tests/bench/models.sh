#!/bin/sh
# SPDX-License-Identifier: MIT
#
# models.sh NMTAN FOLDER: writes real models into a folder as PLY: some of ../shared/models where that
# is, and all meshes of the folder that $MODELS names. Prints the paths; what cannot be read is said on standard error.
nmtan=$1 folder=$2
mkdir -p "$folder" || exit 2
rm -f "$folder"/*.ply
shared=../shared/models
for file in "$shared"/obj/spot.obj "$shared"/obj/tangeract.obj "$shared"/obj/crangeract.obj \
	"$shared"/gltf/CesiumMan/glTF_Binary/CesiumMan.glb "$shared"/gltf/SheenCloth/glTF_Binary/SheenCloth.glb \
	${MODELS:+"$MODELS"/*.obj "$MODELS"/*.ply "$MODELS"/*.glb "$MODELS"/*.gltf}; do
	[ -f "$file" ] || continue
	name=${file##*/}
	out=$folder/${name%.*}.ply
	if [ -e "$out" ]; then
		echo "bench: $file: there is a model of that name already, skipped" >&2
		continue
	fi
	"$nmtan" -q --only=needed "$file" "$out" && echo "$out"
done

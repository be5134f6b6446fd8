#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/fuzz/seeds.sh BUILD FOLDER: small inputs for every target, in FOLDER/obj and so on: the files of data/ and
# data/damaged, what the tool makes of them, and, where ../shared is, its small models. BUILD is a build of the tool
# without sanitizers.
set -eu
cd "$(dirname "$0")/../.."
nmtan=$PWD/$1/nmtan images=$PWD/$1/tests/unit/image/test_image meshopt=$PWD/$1/tests/faults/make_meshopt seeds=$2
rm -rf "$seeds"
mkdir -p "$seeds"/{obj,mtl,ply,gltf,glb,drc,image,layouts}
seeds=$(cd "$seeds" && pwd)

models=(data data/damaged)
[ ! -d ../shared/models ] || models+=(../shared/models ../shared/corpus)
for extension in obj mtl ply gltf glb drc; do
	find "${models[@]}" -type f -name "*.$extension" -size -17k | LC_ALL=C sort | while read -r file; do
		cp "$file" "$seeds/$extension/$(basename "$(dirname "$file")")_${file##*/}"
	done
done

# Coordinates that float does not hold.
awk '$1 == "v" { $2 += 431234.12; $3 += 5412345.67 } 1' CONVFMT=%.9g OFMT=%.9g data/mirrored_cube.obj >"$seeds/obj/far.obj"
printf '%s\n' ply 'format ascii 1.0' 'element vertex 5' 'property double x' 'property double y' 'property int z' \
	'element face 2' 'property list uchar int vertex_indices' end_header 5000000.01 0 0 5000000.03 0 0 5000000.03 0.01 0 \
	5000000.02 0.03 0 5000000.01 0.02 0 '5 0 1 2 3 4' '3 0 1 2' >"$seeds/ply/far.ply"

# One mesh in every way that glTF can store one.
python3 tests/support/gltf_layouts.py "$seeds/layouts" >/dev/null
for file in "$seeds"/layouts/*.gltf; do
	"$nmtan" -q --buffers=embed "$file" "$seeds/gltf/layout_${file##*/}" || true
done
rm -rf "$seeds/layouts"
find "$seeds/gltf" -size +24k -delete
"$meshopt" "$seeds/glb/meshopt.glb"

for file in data/*.gltf data/quad.obj data/mirrored_cube.obj data/quad_wedge.ply; do
	name=$(basename "${file%.*}")
	"$nmtan" -q --only=all --images=embed "$file" "$seeds/glb/$name.glb" || true
	for draco in sequential edgebreaker; do
		"$nmtan" -q --only=all --existing=replace --draco=$draco "$seeds/glb/$name.glb" "$seeds/glb/${name}_$draco.glb" || true
	done
done
"$nmtan" -q "$seeds/glb/meshopt.glb" "$seeds/gltf/meshopt.gltf" --buffers=embed || true
for name in quad morph skin; do
	"$nmtan" -q --buffers=embed "$seeds/glb/${name}_edgebreaker.glb" "$seeds/gltf/${name}_edgebreaker.gltf"
	"$nmtan" -q "$seeds/glb/$name.glb" "$seeds/ply/$name.ply"
done

cp data/bumps.png "$seeds/image/"
NT_SEEDS=$seeds/image "$images" >/dev/null 2>&1
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n0123456789abcdef' >"$seeds/image/flat.hdr"
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n\2\2\0\10\210a\210b\210c\210d' >"$seeds/image/packed.hdr"

# The compressed blocks of those files are .drc files.
python3 - "$seeds" <<'END'
import glob, json, os, struct, sys
for path in sorted(glob.glob(sys.argv[1] + "/glb/*.glb")):
    data = open(path, "rb").read()
    length = struct.unpack_from("<I", data, 12)[0] if data[:4] == b"glTF" and len(data) > 20 else 0
    try:
        document = json.loads(data[20:20 + length])
        blocks = {p["extensions"]["KHR_draco_mesh_compression"]["bufferView"] for mesh in document["meshes"]
                  for p in mesh["primitives"] if "KHR_draco_mesh_compression" in p.get("extensions", {})}
    except (ValueError, KeyError, AttributeError, TypeError):
        continue  # a damaged one
    for number in blocks:
        view = document["bufferViews"][number]
        begin = 28 + length + view.get("byteOffset", 0)
        name = "%s_%d.drc" % (os.path.basename(path)[:-4], number)
        with open(os.path.join(sys.argv[1], "drc", name), "wb") as file:
            file.write(data[begin:begin + view["byteLength"]])
END

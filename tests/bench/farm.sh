#!/bin/bash
# SPDX-License-Identifier: MIT
#
# make bench-farm: 10 000 files (COUNT) of data/ and some larger ones, in a scratch folder: how long one process takes, and
# GNU parallel and Slurm with the recipes of data/farm; a second time with everything up to date; and how often a file
# calls the system, by kind. Engines that the machine does not have are said and skipped.
set -eu
cd "$(dirname "$0")/../.."
ROOT=$PWD NMTAN=$PWD/$1 count=${COUNT:-10000}
WORK=$(mktemp -d)
trap 'cd / && rm -rf "$WORK"' EXIT
export NMTAN PATH=$PATH:/usr/sbin
farm=$ROOT/data/farm
. "$ROOT/tests/support/slurm.sh"
cd "$WORK"

# One of 100 files is an OBJ of 0.7 MB, nine are heads of 40 KB, the others what data/ has of a few KB.
make_files() {
	local i small
	python3 "$ROOT/tests/support/inputs.py" obj_torus 7200 large.obj
	small=("$ROOT"/data/quad*.ply "$ROOT"/data/{quad,mirrored_cube}.obj "$ROOT"/data/{plates.glb,plates.gltf,morph.gltf,skin.gltf})
	for ((i = 0; i < count; i++)); do
		[ $((i % 1000)) != 0 ] || { folder=in/$((i / 1000)) && mkdir -p "$folder" && cp "$ROOT/data/plates.bin" \
			"$ROOT/data/bumps.png" "$ROOT/data/mirrored_cube.mtl" "$folder"; }
		case $((i % 100)) in
		0) cp large.obj "$folder/$i.obj" ;;
		[1-9]) cp "$ROOT/data/head.obj" "$folder/$i.obj" ;;
		*)
			local file=${small[i % ${#small[@]}]}
			cp "$file" "$folder/$i.${file##*.}"
			;;
		esac
	done
	find in \( -name '*.obj' -o -name '*.ply' -o -name '*.gl*' \) -print0 | sort -z >list0
}

# row NAME COMMAND...: seconds, and files in one of them.
row() {
	local begin name=$1
	shift
	begin=$(date +%s%N)
	"$@" >said 2>&1 || { cat said && exit 1; }
	awk -v name="$name" -v count="$count" -v ns=$(($(date +%s%N) - begin)) \
		'BEGIN { printf "%-58s %7.2f s %9.0f files/s\n", name, ns / 1e9, count * 1e9 / ns }'
}
once() { "$NMTAN" -q "$@" -d out --keep-tree=in --files-from=list0; }
prepare() { rm -rf work && "$farm/nmtan-farm" prepare work "$1" -d out --keep-tree=in --threads=1 <list0; }
on_slurm() {
	"$farm/slurm.sh" work --cpus-per-task=1
	await_jobs
	# which may have failed
	"$farm/nmtan-farm" merge work
}

make_files
echo "$count files, $(du -shL --apparent-size in | cut -f1)B; $(nproc) processors, $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1)"
row "one process, one thread" once --threads=1
rm -rf out
row "one process, $(nproc) threads" once
mv out clean
row "one process, $(nproc) threads, --update" once --update
row "one process, everything up to date" once --update
diff -r clean out -x .nmtan-record
rm -rf out
prepare 16
row "GNU parallel, 2 slots, 16 chunks" "$farm/parallel.sh" work --jobs 2
row "GNU parallel, everything up to date, 16 chunks again" sh -c 'exec "$0" work --jobs 2' "$farm/parallel.sh"
diff -r clean out
rm -rf out
if has_slurm; then
	start_slurm || { cat "$slurm"/*.log; exit 1; }
	prepare 2
	row "Slurm, 2 tasks" on_slurm
	diff -r clean out
	stop_slurm
else
	echo "Slurm: not installed (slurm-wlm, munge), or this is not root"
fi
rm -rf out

# Calls of the system per file, where there are many: those of 300 less those of 100.
command -v strace >/dev/null || { echo "strace is not installed: no calls are counted" && exit; }
calls() {
	local files=$1
	shift
	seq "$files" | sed 's|.*|calls/&.glb|' >names
	strace -f -c -o "calls.$files" "$NMTAN" -q -j1 "$@" -d made --files-from=names
	awk '$1 ~ /^[0-9.]+$/ && $NF != "total" { print $NF, $4 }' "calls.$files" | sort >"calls.$files.by_kind"
}
mkdir calls
for i in $(seq 300); do cp "$ROOT/data/plates.glb" "calls/$i.glb"; done
sleep 0.1
per_file() {
	local name=$1
	shift
	rm -rf made
	if [ "$name" = "up to date" ]; then calls 300 "$@"; fi
	calls 100 "$@"
	[ "$name" = "up to date" ] || rm -rf made
	calls 300 "$@"
	join -a2 -e0 -o 0,1.2,2.2 calls.100.by_kind calls.300.by_kind | awk -v name="$name" '
		{ n = int(($3 - $2) / 200 + 0.5); sum += n; if (n) text = text "  " n " " $1 }
		END { printf "%-20s %3d calls a file:%s\n", name, sum, text }'
}
per_file "plain"
per_file "--update" --update
per_file "up to date" --update

#!/bin/sh
# SPDX-License-Identifier: MIT
#
# blender.sh BUILD: Blender's tangents beside those of the Python module, on Suzanne, the OBJs of ../shared/models and
# those of the folder that $MODELS names; then glTF that Blender exports, whose tangents are those of quads. Needs
# Debian's blender, whose Python finds Debian's numpy, and node.
set -eu
build=$1
cd "$(dirname "$0")/../.."
if ! command -v blender >/dev/null 2>&1; then
	echo "blender: not installed (700 MB), nothing was compared"
	exit 0
fi
make -s python
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m zipfile -e build/python/nmtan.whl "$work/wheel"
set --
for file in ../shared/models/obj/*.obj ${MODELS:+"$MODELS"/*.obj}; do
	[ ! -f "$file" ] || set -- "$@" "$file"
done
blender -b --factory-startup --python-exit-code 2 --python tests/soak/blender.py -- "$work/wheel" "$@" >"$work/said" 2>&1 ||
	{ status=$?; cat "$work/said"; exit $status; }
grep -E 'triangles, worst|^Blender [0-9.]+, nmtan' "$work/said"
echo "blender: $(grep -c 'triangles, worst' "$work/said") meshes compared, no other sign"

# Its exports: triangles with the tangents of quads. `--check` agrees with them and warns of none; solved anew they come
# back within 0.05 degrees at every corner, with every sign.
mkdir "$work/exports"
blender -b --factory-startup --python-exit-code 2 --python tests/soak/blender_quads.py -- "$work/exports" >"$work/said" 2>&1 ||
	{ status=$?; cat "$work/said"; exit $status; }
bad=0
for file in "$work"/exports/*.glb; do
	name=$(basename "$file" .glb) status=0
	"$build/nmtan" -q --check --report="$work/report.json" "$file" || status=$?
	codes=$(node -p 'JSON.parse(fs.readFileSync(process.argv[1])).files[0].findings.map((f) => f.code).join(" ")' "$work/report.json")
	made=$(node -p 'const m = JSON.parse(fs.readFileSync(process.argv[1])).files[0].meshes[0].made_by;
		m ? `${m.method} on ${m.faces}, w ${m.w}${m.across === "mesh" ? ", across" : ""}` : "no tangents"' "$work/report.json")
	case $name/$made in
	ngon/no\ tangents) echo "$name: no tangents, $codes"; continue ;;
	parts/*,\ across | mixed/*,\ across | suzanne*/mikktspace*\ on\ quads,\ w\ right | [tc]*/mikktspace*,\ w\ right | sphere/mikktspace*,\ w\ right) ;;
	*) bad=1 ;;
	esac
	case $status/$codes in
	6/* | */*TAN_SIGN_MISMATCH* | */*TAN_MIRROR_SHARED_VERTEX*) bad=1 ;;
	esac
	"$build/nmtan" -q --existing=replace --across=mesh "$file" "$work/out.glb"
	within=$(OUT=$work/out.glb node tests/support/answer.mjs gltf "$file" '(() => {
		const corners = (f) => f.g.meshes[0].primitives.flatMap((p) => {
			const t = f.rows(p.attributes.TANGENT); return f.rows(p.indices).map(([v]) => t[v]); });
		const ours = corners(open(process.env.OUT)), theirs = corners({ g, rows });
		const degrees = ours.map((a, i) => { const b = theirs[i];
			const cross = [0, 1, 2].map((k) => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
			return Math.atan2(Math.hypot(...cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * 180 / Math.PI; });
		const off = degrees.filter((d) => !(d <= 0.05)).length, signs = ours.filter((a, i) => a[3] !== theirs[i][3]).length;
		return `${off || signs ? "bad" : "good"} ${off} of ${degrees.length} corners off, ${signs} other signs`; })()')
	case $within in bad*) bad=1 ;; esac
	echo "$name: exit $status, $made, ${within#* }"
done
[ $bad = 0 ] || { echo "blender: an export is not as it should be"; exit 1; }

# Nobody baked the quads that the triangles of DamagedHelmet happen to make.
helmet=${MODELS:+$MODELS/DamagedHelmet.glb}
if [ -n "$helmet" ] && [ -f "$helmet" ]; then
	said=$("$build/nmtan" --existing=replace "$helmet" "$work/out.glb" 2>&1)
	pairs=$("$build/nmtan" --existing=replace --quads=pairs "$helmet" "$work/out.glb" 2>&1)
	echo "DamagedHelmet: ${said#*primitive, }; with --quads=pairs: ${pairs#*primitive, }"
	case $said in *quads*) echo "blender: DamagedHelmet was solved as quads"; exit 1 ;; esac
	case $pairs in *quads*) ;; *) echo "blender: DamagedHelmet has no pairs"; exit 1 ;; esac
fi

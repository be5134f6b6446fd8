# SPDX-License-Identifier: MIT
# The npm package: its functions, and real programs with it in them.
. "$ROOT/tests/support/cli.sh"

if ! command -v clang >/dev/null 2>&1 || ! command -v node >/dev/null 2>&1; then
	scene "the npm package"
	skip_case "no clang or node"
	done_testing
	exit
fi

scene "make wasm builds the package"
make -C "$ROOT" -s wasm >make.txt 2>&1 || wrong "$(tail -5 make.txt)"

scene "npm packs the module, its types and the licence, and nothing else"
(cd "$ROOT/build/npm" && npm pack --dry-run --json 2>/dev/null) >pack.json
node -e 'for (const file of JSON.parse(require("fs").readFileSync("pack.json"))[0].files) console.log(file.path)' | sort >names.txt
printf '%s\n' LICENSE README.md core.js external.js external.node.js index.d.ts index.js nmtan.wasm package.json wasm.js | sort |
	diff - names.txt >diff.txt || wrong "$(cat diff.txt)"
finish_case

cases_of wasm "$ROOT/tests/bindings/wasm.mjs" "$ROOT/build/npm" "$data" "$ROOT/include/nmtan.h"

modules=$ROOT/build/clients
scene "real programs"
if ! make -C "$ROOT" -s build/clients/node_modules/three/package.json >make.txt 2>&1 || ! command -v chromium >/dev/null 2>&1 ||
	[ ! -f "$ROOT/build/node/node_modules/playwright-core/package.json" ]; then
	skip_case "three, glTF-Transform, esbuild, chromium or playwright-core is not installed"
	done_testing
	exit
fi
case_name=
mkdir -p "$WORK/clients"
cp "$data/mirrored_cube.obj" "$WORK/clients/cube.obj"
awk 'BEGIN { n = 24
	for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) { a = i * 6.2831853 / n; b = j * 6.2831853 / n
		printf "v %.6f %.6f %.6f\nvt %.5f %.5f\nvn %.6f %.6f %.6f\n", (2 + cos(b)) * cos(a), (2 + cos(b)) * sin(a), sin(b),
			i < n / 2 ? i / n : 1 - i / n, j / n, cos(b) * cos(a), cos(b) * sin(a), sin(b) }
	for (i = 0; i < n; i++) for (j = 0; j < n; j++) { a = i * (n + 1) + j + 1; b = a + n + 1
		printf "f %d/%d/%d %d/%d/%d %d/%d/%d\nf %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, b + 1, b + 1, b + 1,
			a, a, a, b + 1, b + 1, b + 1, a + 1, a + 1, a + 1 } }' >"$WORK/clients/torus.obj"
# from glTF to glTF, so that both see the same texture coordinates
for name in cube torus repaired; do
	# a triangle without UV area, whose tangents raw MikkTSpace leaves to whoever writes them
	[ $name = repaired ] && { cat "$WORK/clients/torus.obj" && echo "f 30/30/30 55/30/30 56/30/30"; } >"$WORK/clients/repaired.obj"
	run "$WORK/clients/$name.obj" "$WORK/clients/first.glb"
	[ $name = repaired ] && raw= || raw=--raw
	run $raw --only=all --existing=replace "$WORK/clients/first.glb" "$WORK/clients/$name.glb"
done
cases_of client "$ROOT/tests/bindings/clients.mjs" "$ROOT/build/npm" "$modules" "$ROOT/build/node" "$WORK/clients" \
	"$WORK/clients/cube.glb" "$WORK/clients/torus.glb" "$WORK/clients/repaired.glb"
done_testing

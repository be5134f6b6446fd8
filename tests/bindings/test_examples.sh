# SPDX-License-Identifier: MIT
# The importers of data/examples, with what they import from where that can be had, else with a stand-in: one mesh, a quad
# and its mirror image that share two vertices, and the same tangents and copies from all; nmtan-engines(7) shows them.
. "$ROOT/tests/support/cli.sh"
examples=$ROOT/data/examples page=$ROOT/man/nmtan-engines.7

# As README.md has it, triangles for quads.
cat >"$WORK/expected" <<'END'
1 0 0 1
1 0 0 1
1 0 0 1
1 0 0 1
-1 0 0 -1
-1 0 0 -1
-1 0 0 -1
-1 0 0 -1
0 1 2 0 2 3 6 4 5 6 5 7
END
python3 - >"$WORK/quads.gltf" <<'END'
import base64, json, struct
content = struct.pack("<48f12H", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, *[0, 0, 1] * 6,
                      0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2)
views = [(0, 72), (72, 72), (144, 48), (192, 24)]
accessors = [{"bufferView": i, "componentType": 5126, "count": 6, "type": "VEC3" if i < 2 else "VEC2"} for i in range(3)]
accessors[0].update(min=[0, 0, 0], max=[2, 1, 0])
print(json.dumps({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
    "materials": [{}], "accessors": accessors + [{"bufferView": 3, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": length} for at, length in views],
    "buffers": [{"byteLength": len(content),
                 "uri": "data:application/octet-stream;base64," + base64.b64encode(content).decode()}]}))
END
# importer FILE: the lines between "begin" and "end".
importer() {
	awk '/^(\/\*|\/\/|#) end/ { on = 0 } on { print } /^(\/\*|\/\/|#) begin/ { on = 1 }' "$examples/$1"
}

scene "each importer has at most 20 lines, without braces that stand alone"
for file in cgltf.c three.mjs with_trimesh.py; do
	lines=$(importer $file | grep -cvE '^\s*[{}]*\s*$')
	[ "$lines" -gt 5 ] && [ "$lines" -le 20 ] || wrong "$file has $lines"
done

scene "the manual shows them as they are"
for file in cgltf.c three.mjs with_trimesh.py; do
	importer $file | sed 's/^\t*//; s/^ *//' | grep . >lines
	sed -n "/^\.\\\\\" $file/,/^\.EE/p" "$page" | sed '1,2d;$d' | sed 's/\\e/\\/g; s/\\&//g; s/\\-/-/g; s/^\t*//; s/^ *//' | grep . |
		diff lines - >difference || wrong "$file: $(cat difference)"
done

scene "the tool gives the mesh the same tangents"
run --only=all "$WORK/quads.gltf" out.gltf
exits 0
says "6 -> 8 vertices"

scene "C, cgltf${CGLTF:+ of \$CGLTF}"
cc -std=c11 -Wall -Wextra ${CGLTF:+-w} -I"${CGLTF:-$ROOT/tests/support}" -I"$ROOT/include" -o program "$examples/cgltf.c" \
	"$BUILD/libnmtan.a" -pthread -lm 2>"$WORK/err.txt" && [ ! -s "$WORK/err.txt" ] || wrong "does not compile"
./program "$WORK/quads.gltf" | diff "$WORK/expected" - >difference || wrong "$(cat difference)"

scene "Python, trimesh or what stands in for it"
make -C "$ROOT" -s python >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
python=$(type -P python3) # not the word of cli.sh, whose process has its modules already
"$python" -c 'import numpy' 2>/dev/null || python=/usr/bin/python3
python3 -m zipfile -e "$ROOT/build/python/nmtan.whl" wheel
"$python" -c 'import trimesh' 2>/dev/null || cat >wheel/trimesh.py <<'END'
from types import SimpleNamespace
import numpy


class Visual(SimpleNamespace):
    def copy(self, uv):
        return Visual(uv=uv)


class Trimesh(SimpleNamespace):
    def __init__(self, vertices, faces, vertex_normals, visual, process):
        assert not process and len(vertices) == len(vertex_normals) == len(visual.uv)
        super().__init__(vertices=vertices, faces=faces, vertex_normals=vertex_normals, visual=visual, vertex_attributes={})


def load(path, process, force):
    assert not process and force == "mesh"
    rows = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]], float)
    uv = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [0, 1]], float)  # up, as trimesh has glTF's
    return Trimesh(rows, numpy.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]), numpy.tile([0.0, 0, 1], (6, 1)),
                   Visual(uv=uv), False)
END
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=wheel "$python" "$examples/with_trimesh.py" "$WORK/quads.gltf" 2>"$WORK/err.txt" |
	diff "$WORK/expected" - >difference || wrong "$(cat difference)"

scene "JavaScript, three.js"
if ! command -v node >/dev/null || ! command -v clang >/dev/null ||
	! make -C "$ROOT" -s build/clients/node_modules/three/package.json wasm >make.txt 2>&1; then
	skip_case "no node, clang or three"
	done_testing
	exit
fi
mkdir -p js/node_modules
ln -s "$ROOT/build/clients/node_modules/three" "$ROOT/build/npm" js/node_modules
mv js/node_modules/npm js/node_modules/nmtan
cp "$examples/three.mjs" js
cat >js/run.mjs <<'END'
import { readFileSync } from 'node:fs';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { addTangents } from './three.mjs';
Object.assign(globalThis, { self: globalThis, ProgressEvent: class {} });
const { scene } = await new GLTFLoader().parseAsync(readFileSync(process.argv[2], 'utf8'), '');
const { geometry } = scene.children[0];
await addTangents(geometry);
const { tangent, position, uv } = geometry.attributes;
if (position.count !== tangent.count || uv.getX(7) !== uv.getX(2))
	throw new Error('the copies are not there');
for (let v = 0; v < tangent.count; v++)
	console.log(['getX', 'getY', 'getZ', 'getW'].map((get) => tangent[get](v) + 0).join(' '));
console.log(geometry.index.array.join(' '));
END
node js/run.mjs "$WORK/quads.gltf" 2>"$WORK/err.txt" | diff "$WORK/expected" - >difference || wrong "$(cat difference)"

done_testing

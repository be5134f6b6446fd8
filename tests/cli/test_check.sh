# SPDX-License-Identifier: MIT
# --check judges, writes nothing, and fails for the right reason only.
. "$ROOT/tests/support/cli.sh"

scene "a sound mesh passes and nothing is written"
run --check "$data/quad.obj" "$data/quad_le.ply"
exits 0
says "quad.obj: checked, 1 primitive, 1 info"
says "quad_le.ply: checked, 1 primitive, no findings"
only
run --check "$data/plates.gltf"
says "plates.gltf: checked, 3 primitives, 1 error, 1 warning"

scene "findings at or above --fail-on make the exit code 6"
cp "$data/mirrored_cube.obj" .
run --check mirrored_cube.obj
prints "warning   MTL_MISSING"
prints "mirrored_cube.mtl"
exits 0
run --check --fail-on=warning mirrored_cube.obj
exits 6
run --check --fail-on=never mirrored_cube.obj
exits 0
run --fail-on=warning mirrored_cube.obj out.glb
exits 6
exists out.glb
run mirrored_cube.obj out.glb
exits 0

scene "standard input can be judged"
"$NMTAN" --check - <"$data/quad.obj" 2>"$WORK/err.txt"
is $? 0

scene "an input that cannot be read counts more than findings"
cp "$data/mirrored_cube.obj" .
run --check --fail-on=info mirrored_cube.obj nothing.obj
exits 2

# Optimizers leave such primitives behind: accessors of 0 elements, at some byte of a view of 0 bytes.
scene "elements that are not there lie in no bytes"
cat >empty.gltf <<END
{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":0},
{"bufferView":0,"byteOffset":12,"componentType":5126,"type":"VEC2","count":0},
{"bufferView":0,"byteOffset":20,"componentType":5123,"type":"SCALAR","count":0}],
"bufferViews":[{"buffer":0,"byteLength":0,"byteStride":20}],
"buffers":[{"byteLength":4,"uri":"data:application/octet-stream;base64,AAAAAA=="}]}
END
run --check --report=empty.html empty.gltf
exits 0
says "empty.gltf: checked"
run --only=all --existing=replace --verify empty.gltf empty.glb
exits 0
says "skipped 1 (no faces)"

done_testing

#!/bin/bash
# SPDX-License-Identifier: MIT
#
# make bench-need [FILES="FILE..."]: peak memory of one run for each FILE, over that of the smallest run, beside the guess of
# src/batch/gate.c. Without FILES, for some that are made: ordinary ones, and the worst of each format, in which every
# corner is a vertex of its own.
set -eu
nmtan=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
make_obj=$work/make_obj
here=$(cd "$(dirname "$0")" && pwd)

# How many MB a run takes at most.
peak() {
	python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)' "$nmtan" -q --threads=1 --only=all --existing=replace "$@"
}

make_files() {
	cc -O1 -o "$make_obj" "$here/make_obj.c" -lm
	"$make_obj" 250 >"$work/ordinary.obj"
	for name in ordinary.ply ordinary.glb ordinary.gltf; do "$nmtan" -q "$work/ordinary.obj" "$work/$name"; done
	"$nmtan" -q --draco=edgebreaker --existing=replace --only=all "$work/ordinary.glb" "$work/draco.glb"
	python3 - "$work" <<'END'
import json, random, struct, sys
random.seed(1)
work, points = sys.argv[1], 99
corner = lambda: random.randrange(points)
with open(work + '/corners.obj', 'w') as f:
    for _ in range(points):
        f.write('v %d %d %d\nvt %d %d\n' % tuple(random.randrange(10) for _ in range(5)))
    for _ in range(200000):
        f.write('f %d/%d %d/%d %d/%d\n' % tuple(1 + corner() for _ in range(6)))
with open(work + '/terse.obj', 'w') as f:
    n = 300
    for j in range(n + 1):
        for i in range(n + 1):
            f.write('v %d %d 0\nvt %d %d\n' % (i, j, i, j))
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            f.write('f %d/%d %d/%d %d/%d %d/%d\n' % (a, a, a + 1, a + 1, a + n + 2, a + n + 2, a + n + 1, a + n + 1))
with open(work + '/corners.ply', 'wb') as f:
    f.write(('ply\nformat binary_little_endian 1.0\nelement vertex %d\n' % points +
             ''.join('property float %s\n' % name for name in 'xyzst') +
             'element face 200000\nproperty list uchar uchar vertex_indices\nend_header\n').encode())
    f.write(struct.pack('<%df' % (5 * points), *(random.randrange(10) for _ in range(5 * points))))
    for _ in range(200000):
        f.write(bytes([4] + random.sample(range(points), 4)))
with open(work + '/far.ply', 'w') as f:
    n = 300 # rounding to float makes one point of 10 x 10
    f.write('ply\nformat ascii 1.0\nelement vertex %d\n' % (n + 1) ** 2 + ''.join('property double %s\n' % name for name in 'xyzst') +
            'element face %d\nproperty list uchar int vertex_indices\nend_header\n' % (n * n))
    for j in range(n + 1):
        for i in range(n + 1):
            f.write('%.2f %.2f 0 %d %d\n' % (431234 + 0.05 * i, 5412345 + 0.05 * j, i, j))
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            f.write('4 %d %d %d %d\n' % (a, a + 1, a + n + 2, a + n + 1))
data = b''
views, accessors = [], []
def accessor(bytes_, component, kind, count, **more):
    global data
    data += b'\0' * (-len(data) % 4)
    views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(bytes_)})
    data += bytes_
    accessors.append(dict(bufferView=len(views) - 1, componentType=component, type=kind, count=count, **more))
    return len(accessors) - 1
floats = lambda n: struct.pack('<%df' % n, *(random.random() for _ in range(n)))
attributes = {'POSITION': accessor(floats(3 * points), 5126, 'VEC3', points, min=[0, 0, 0], max=[1, 1, 1]),
              'NORMAL': accessor(struct.pack('<3f', 0, 0, 1) * points, 5126, 'VEC3', points),
              'TEXCOORD_0': accessor(floats(2 * points), 5126, 'VEC2', points)}
indices = accessor(bytes(corner() for _ in range(600000)), 5121, 'SCALAR', 600000)
document = {'asset': {'version': '2.0'}, 'meshes': [{'primitives': [{'attributes': attributes, 'indices': indices}]}],
            'nodes': [{'mesh': 0}], 'scenes': [{'nodes': [0]}], 'accessors': accessors, 'bufferViews': views}
def write(name, document):
    global data
    data += b'\0' * (-len(data) % 4)
    text = json.dumps(dict(document, buffers=[{'byteLength': len(data)}])).encode()
    text += b' ' * (-len(text) % 4)
    with open(work + '/' + name, 'wb') as f:
        f.write(struct.pack('<5I', 0x46546c67, 2, 28 + len(text) + len(data), len(text), 0x4e4f534a) + text +
                struct.pack('<2I', len(data), 0x4e4942) + data)
write('corners.glb', document)
indices = accessors[indices]
indices['count'] = views[indices['bufferView']]['byteLength'] = 300
write('nodes.glb', dict(document, nodes=[{'mesh': 0, 'translation': [i, 0, 0]} for i in range(200000)]))
END
}

least=$(peak "$here/../../data/quad.obj" "$work/least.glb")
row() {
	local need
	need=$("$(dirname "$nmtan")/tests/bench/need" "$@" out.glb)
	awk -v name="$(basename "$1")" -v options="${*:2}" -v peak=$(($(peak "$@" "$work/out.glb") - least)) \
		-v need="$need" -v size="$(stat -Lc %s "$1")" 'BEGIN {
		printf "%-16s %-24s %8.2f MB file %8.1f MB taken %8.1f MB guessed %7.1f taken per byte\n",
			name, options, size / 1e6, peak / 1e6, need / 1e6, peak / size }'
}
if [ $# -gt 0 ]; then
	for file; do row "$file"; done
	exit
fi
make_files
for file in ordinary terse corners; do row "$work/$file.obj"; row "$work/$file.obj" --verify --report="$work/r.html"; done
for file in ordinary corners; do row "$work/$file.ply"; done
row "$work/far.ply" --origin=keep --verify --report="$work/r.json"
for file in ordinary corners nodes draco; do
	row "$work/$file.glb"
	row "$work/$file.glb" --verify --report="$work/r.html"
done
for file in ordinary corners; do row "$work/$file.glb" --draco=edgebreaker; done
row "$work/ordinary.gltf"

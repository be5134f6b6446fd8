#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""json_big.py OUT.gltf [NODES [MESHES]]: a .gltf of about 100 bytes a node (1 000 000: 100 MB of JSON), a chain of
groups of a thousand nodes, and MESHES meshes (default NODES / 10) of one quad each, each with accessors of its own,
every second one with a normal texture. The quads' bytes are the same few, in a data URI."""
import array
import base64
import json
import sys

NODES = int(sys.argv[2]) if len(sys.argv) > 2 else 1000000
MESHES = int(sys.argv[3]) if len(sys.argv) > 3 else NODES // 10
VERTICES = array.array("f", [k for y in (0, 1) for x in (0, 1) for k in (x, y, 0, 0, 0, 1, x, 1 - y)]).tobytes()
INDICES = array.array("H", (0, 1, 3, 0, 3, 2)).tobytes()
SIZE = len(VERTICES) + len(INDICES)


def joined(items):
    return ",".join(items)


with open(sys.argv[1], "w") as file:
    file.write('{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"materials":[{},{"normalTexture":'
               '{"index":0}}],"textures":[{}],"nodes":[')
    for first in range(0, NODES, 1000):
        last = min(first + 1000, NODES)
        children = list(range(first + 1, last)) + ([last] if last < NODES else [])
        rows = ['{"name":"group %d","children":%s}' % (first, json.dumps(children, separators=(",", ":")))]
        rows += ['{"name":"node %d","mesh":%d,"translation":[%d,%.3f,-0.125],"rotation":[0,0,0,1],"scale":[1,1,1]}'
                 % (i, i % MESHES, i, i / 7) for i in range(first + 1, last)]
        file.write(("," if first else "") + joined(rows))
    file.write('],"meshes":[')
    file.write(joined('{"primitives":[{"attributes":{"POSITION":%d,"NORMAL":%d,"TEXCOORD_0":%d},"indices":%d,"material":%d}]}'
                      % (4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3, i % 2) for i in range(MESHES)))
    file.write('],"accessors":[')
    file.write(joined(
        '{"bufferView":%d,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},'
        '{"bufferView":%d,"byteOffset":12,"componentType":5126,"count":4,"type":"VEC3"},'
        '{"bufferView":%d,"byteOffset":24,"componentType":5126,"count":4,"type":"VEC2"},'
        '{"bufferView":%d,"componentType":5123,"count":6,"type":"SCALAR"}'
        % (2 * i, 2 * i, 2 * i, 2 * i + 1) for i in range(MESHES)))
    file.write('],"bufferViews":[')
    file.write(joined('{"buffer":0,"byteOffset":%d,"byteLength":128,"byteStride":32},'
                      '{"buffer":0,"byteOffset":%d,"byteLength":12}' % (SIZE * i, SIZE * i + 128) for i in range(MESHES)))
    file.write('],"buffers":[{"byteLength":%d,"uri":"data:application/octet-stream;base64,%s"}]}'
               % (SIZE * MESHES, base64.b64encode((VERTICES + INDICES) * MESHES).decode()))

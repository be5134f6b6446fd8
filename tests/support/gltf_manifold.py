#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_manifold.py OUT.gltf [JSON]: a box of two primitives as EXT_mesh_manifold has it, with the members of JSON in the
extension instead. At x = 1 its texture coordinates are mirrored; one corner has two vertices, which the manifold merges. The
scene has FB_geometry_metadata."""
import base64
import json
import struct
import sys

positions = [(x, y, z) for z in (0, -1) for y in (0, 1) for x in (0, 1, 2)] + [(0, 0, 0)]
quads = [(0, 1, 4, 3), (1, 2, 5, 4), (7, 6, 9, 10), (8, 7, 10, 11), (12, 3, 9, 6), (2, 8, 11, 5),
         (12, 6, 7, 1), (1, 7, 8, 2), (3, 4, 10, 9), (4, 5, 11, 10)]
indices = [v for a, b, c, d in quads for v in (a, b, c, a, c, d)]
corners = [c for c, v in enumerate(indices) if v == 12]
arrays = [(b''.join(struct.pack('<3f', *p) for p in positions), 5126, 13, 'VEC3'),
          (struct.pack('<3f', 0, 0, 1) * 13, 5126, 13, 'VEC3'),
          (b''.join(struct.pack('<2f', 1 - abs(1 - x), y - z / 2) for x, y, z in positions), 5126, 13, 'VEC2'),
          (struct.pack('<60H', *indices), 5123, 60, 'SCALAR'),
          (struct.pack('<%dH' % len(corners), *corners), 5123, len(corners), 'SCALAR'),
          (struct.pack('<%dH' % len(corners), *(0 for c in corners)), 5123, len(corners), 'SCALAR')]
views, accessors, data = [], [], b''
for i, (content, kind, count, shape) in enumerate(arrays):
    views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(content)})
    accessors.append({'bufferView': i, 'componentType': kind, 'count': count, 'type': shape})
    data += content + b'\0' * (-len(content) % 4)
accessors[0].update(min=[0, 0, -1], max=[2, 1, 0])
accessors += [dict(accessors[3], count=12), dict(accessors[3], byteOffset=24, count=48)]
accessors[3]['sparse'] = {'count': len(corners), 'indices': {'bufferView': 4, 'componentType': 5123},
                          'values': {'bufferView': 5}}
attributes = {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}
manifold = {'manifoldPrimitive': {'attributes': {'POSITION': 0}, 'indices': 3}, 'mergeIndices': 4, 'mergeValues': 5}
manifold.update(json.loads(sys.argv[2]) if len(sys.argv) > 2 else {})
json.dump({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0], 'extensions': {
               'FB_geometry_metadata': {'vertexCount': 26, 'primitiveCount': 20}}}], 'nodes': [{'mesh': 0}],
           'extensionsUsed': ['EXT_mesh_manifold', 'FB_geometry_metadata'],
           'meshes': [{'extensions': {'EXT_mesh_manifold': manifold},
                       'primitives': [{'attributes': attributes, 'indices': i} for i in (6, 7)]}],
           'accessors': accessors, 'bufferViews': views, 'buffers': [{'byteLength': len(data),
               'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]},
          open(sys.argv[1], 'w'))

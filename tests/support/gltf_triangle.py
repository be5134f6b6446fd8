#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
#
# gltf_triangle.py POSITIONS NORMALS TEXCOORDS: prints a glTF of one triangle with a normal map; each argument is a list
# of numbers as JSON, texture coordinates as stored.
import base64
import json
import struct
import sys

rows = [json.loads(text) for text in sys.argv[1:4]]
data = b''.join(struct.pack('<%df' % len(r), *r) for r in rows)
lengths = [4 * len(r) for r in rows]
types = ['VEC3', 'VEC3', 'VEC2']
accessors = [{'bufferView': i, 'componentType': 5126, 'count': 3, 'type': types[i]} for i in range(3)]
accessors[0]['min'] = [min(rows[0][i::3]) for i in range(3)]
accessors[0]['max'] = [max(rows[0][i::3]) for i in range(3)]
json.dump({
    'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
    'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'material': 0}]}],
    'materials': [{'normalTexture': {'index': 0}}], 'textures': [{'source': 0}],
    'images': [{'uri': 'normal.png'}], 'accessors': accessors,
    'bufferViews': [{'buffer': 0, 'byteOffset': sum(lengths[:i]), 'byteLength': lengths[i]} for i in range(3)],
    'buffers': [{'byteLength': len(data), 'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}],
}, sys.stdout)

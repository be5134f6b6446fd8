#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_morphs.py OUTPUT TARGET MOVED: base plus delta of a morph target's TANGENT, corner by corner, is what
a solve of the mesh that this target has moved gave, but for the rounding of one difference and one sum."""
import struct
import sys

from gltf_lossless import File, corner_tangents

out, target, moved = File(sys.argv[1]), int(sys.argv[2]), File(sys.argv[3])
primitive = out.g['meshes'][0]['primitives'][0]
base = out.rows(primitive['attributes']['TANGENT'])
delta = out.rows(primitive['targets'][target]['TANGENT'])
expected = corner_tangents(moved)
corners = out.corners(primitive)
turned = 0
for corner, tangent in zip(corners, expected):
    b, d = struct.unpack('<4f', base[corner]), struct.unpack('<3f', delta[corner])
    turned += any(abs(x) > 1e-3 for x in d)
    if any(abs(x + y - z) > 2e-7 for x, y, z in zip(b, d, tangent)):
        sys.exit('%s: target %d at vertex %d: %s + %s, expected %s' % (sys.argv[1], target, corner, b, d, tangent))
if len(corners) != len(expected) or not corners:
    sys.exit('%d corners, expected %d' % (len(corners), len(expected)))
print('%d corners, %d of them turned' % (len(corners), turned))
sys.exit(0 if turned else 'the target turns nothing: no test')

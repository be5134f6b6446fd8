#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""morph_files.py FOLDER: glTF files with many morph targets, as avatars have them.

sparse.gltf       a grid of 121 x 121 vertices, 100 targets that lift 5 vertices each, in sparse accessors
avatar.gltf       a grid of 61 x 61 with normals of bytes, 103 targets that bend a hundredth of it and its normals; all
                  of them have dense TANGENT accessors of floats, which say nothing right
still.gltf        the grid of avatar.gltf with floats, 20 targets that move nothing
moved.gltf        sparse.gltf as its target 7 moves it"""
import base64
import json
import math
import struct
import sys


class Document:
    def __init__(self):
        self.bytes, self.g = bytearray(), {
            'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
            'materials': [{'normalTexture': {'index': 0}}], 'textures': [{'source': 0}],
            'images': [{'uri': 'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNoaPgP'
                               'AAODAgA+WCglAAAAAElFTkSuQmCC'}],
            'bufferViews': [], 'accessors': []}

    def view(self, data, **more):
        self.bytes += bytes(-len(self.bytes) % 4)
        self.g['bufferViews'].append({'buffer': 0, 'byteOffset': len(self.bytes), 'byteLength': len(data), **more})
        self.bytes += data
        return len(self.g['bufferViews']) - 1

    def accessor(self, kind, rows, code='f', component=5126, pad=0, bounds=False, **more):
        width = len(rows[0])
        data = b''.join(struct.pack('<%d%s%dx' % (width, code, pad), *row) for row in rows)
        stride = {'byteStride': len(data) // len(rows)} if pad else {}
        a = {'bufferView': self.view(data, **stride), 'componentType': component, 'count': len(rows), 'type': kind,
             **more}
        if bounds:
            a['min'], a['max'] = [min(c) for c in zip(*rows)], [max(c) for c in zip(*rows)]
        self.g['accessors'].append(a)
        return len(self.g['accessors']) - 1

    def sparse(self, count, rows):
        """rows: {vertex: floats}"""
        order = sorted(rows)
        zero = (0.0, 0.0, 0.0)
        some = [rows[v] for v in order] + [zero]
        self.g['accessors'].append({
            'componentType': 5126, 'count': count, 'type': 'VEC3',
            'min': [min(c) for c in zip(*some)], 'max': [max(c) for c in zip(*some)],
            'sparse': {
                'count': len(order),
                'indices': {'bufferView': self.view(struct.pack('<%dH' % len(order), *order)), 'componentType': 5123},
                'values': {'bufferView': self.view(b''.join(struct.pack('<3f', *rows[v]) for v in order))}}})
        return len(self.g['accessors']) - 1

    def save(self, path, attributes, indices, targets):
        primitive = {'attributes': attributes, 'indices': indices, 'material': 0}
        if targets:
            primitive['targets'] = targets
        self.g['meshes'] = [{'primitives': [primitive]}]
        self.g['buffers'] = [{'byteLength': len(self.bytes), 'uri': 'data:application/octet-stream;base64,' +
                              base64.b64encode(self.bytes).decode()}]
        with open(path, 'w') as file:
            json.dump(self.g, file)


def single(x):
    return struct.unpack('<f', struct.pack('<f', x))[0]


def grid(n):
    points = [(single(x / n), single(y / n), single(0.05 * math.sin(9 * x / n) * math.sin(7 * y / n)))
              for y in range(n + 1) for x in range(n + 1)]
    indices = []
    for y in range(n):
        for x in range(n):
            a, b, c, d = y * (n + 1) + x, y * (n + 1) + x + 1, (y + 1) * (n + 1) + x, (y + 1) * (n + 1) + x + 1
            indices += [a, b, d, a, d, c]
    return points, indices


def start(n, normal_bytes=False, move=None):
    d, (points, indices) = Document(), grid(n)
    moved = [tuple(single(a + b) for a, b in zip(p, (move or {}).get(v, (0, 0, 0)))) for v, p in enumerate(points)]
    normals = [(0, 0, 127)] * len(points) if normal_bytes else [(0.0, 0.0, 1.0)] * len(points)
    attributes = {
        'POSITION': d.accessor('VEC3', moved, bounds=True),
        'NORMAL': d.accessor('VEC3', normals, 'b', 5120, 1, normalized=True) if normal_bytes else
        d.accessor('VEC3', normals),
        'TEXCOORD_0': d.accessor('VEC2', [(single(p[0] + 0.2 * p[1] * p[1]), p[1]) for p in points])}
    if normal_bytes:
        d.g['extensionsUsed'] = d.g['extensionsRequired'] = ['KHR_mesh_quantization']
    return d, points, attributes, d.accessor('SCALAR', [(i,) for i in indices], 'H', 5123)


def lift(target, count):
    """Five vertices of a grid, apart from each other."""
    return {(37 + 131 * target + 2903 * k) % count: (0.0, single(0.001 * k), single(0.01 + 0.001 * k))
            for k in range(5)}


def main():
    folder = sys.argv[1]
    d, points, attributes, indices = start(120)
    targets = [{'POSITION': d.sparse(len(points), lift(t, len(points)))} for t in range(100)]
    d.save(folder + '/sparse.gltf', attributes, indices, targets)
    d, points, attributes, indices = start(120, move=lift(7, len(points)))
    d.save(folder + '/moved.gltf', attributes, indices, None)

    d, points, attributes, indices = start(60, True)
    targets = []
    for t in range(103):
        cx, cy = (t * 0.617) % 1, (t * 0.331) % 1
        near = {v: 0.003 - (p[0] - cx) ** 2 - (p[1] - cy) ** 2 for v, p in enumerate(points)}
        near = {v: h for v, h in near.items() if h > 0}
        targets.append({
            'POSITION': d.sparse(len(points), {v: (0.0, 0.0, single(9 * h)) for v, h in near.items()}),
            'NORMAL': d.accessor('VEC3', [(int(9000 * near[v] * (points[v][0] - cx) / 0.055), 0, 0) if v in near
                                          else (0, 0, 0) for v in range(len(points))], 'b', 5120, 1, normalized=True),
            'TANGENT': d.accessor('VEC3', [(0.0, single(0.25 + t / 512), 0.0)] * len(points))})
    attributes['TANGENT'] = d.accessor('VEC4', [(0.0, 1.0, 0.0, 1.0)] * len(points))
    d.save(folder + '/avatar.gltf', attributes, indices, targets)

    d, points, attributes, indices = start(60)
    d.save(folder + '/still.gltf', attributes, indices,
           [{'POSITION': d.sparse(len(points), {0: (0.0, 0.0, 0.0)})} for _ in range(20)])


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_layouts.py FOLDER [--doubled]: the same mesh in every way that glTF can store one.

A sheet whose middle columns run backwards in u, so that the vertices at the two turns must be split. It
comes with colours, joints, weights, a custom attribute and two morph targets, and every layout of
accessors, views and buffers gets a file of its own. Corner k of every file is corner k of plain.gltf.

With --doubled each vertex is there twice, and every other quad uses the second one.
"""
import base64
import json
import os
import struct
import sys

import gltf_table as table
from gltf_table import BYTE, FLOAT, SHORT, UBYTE, UINT, USHORT, Stream

FOLDER = sys.argv[1]
DOUBLED = '--doubled' in sys.argv
NX, NY = 12, 9  # quads


def sheet():
    """Rows of every attribute: name -> (component type, normalized, rows)."""
    positions, normals, uvs, colors, joints, weights, custom, up, turn = [], [], [], [], [], [], [], [], []
    for y in range(NY + 1):
        for x in range(NX + 1):
            i = len(positions)
            positions.append((x * 0.25, y * 0.25, ((x * 7 + y * 3) % 5) * 0.03))
            normals.append((0.0, 0.0, 1.0))
            u = x if x <= 4 else 8 - x if x <= 8 else x - 8
            uvs.append((u * 0.2, y * 0.1))
            colors.append((i % 256, (i * 3) % 256, (i * 5) % 256, 255))
            joints.append((i % 4, 0, 1, 2))
            weights.append((65535 - i, i, 0, 0))
            custom.append((i * 0.5,))
            up.append((0.0, 0.0, x * 0.01))
            turn.append((0.0, 0.02 * (x % 5), 0.0))
    if DOUBLED:
        for rows in (positions, normals, uvs, colors, joints, weights, custom, up, turn):
            rows += rows
    return {'POSITION': Stream(FLOAT, positions, bounds=True), 'NORMAL': Stream(FLOAT, normals),
            'TEXCOORD_0': Stream(FLOAT, uvs), 'COLOR_0': Stream(UBYTE, colors, True), 'JOINTS_0': Stream(UBYTE, joints),
            'WEIGHTS_0': Stream(USHORT, weights, True), '_CUSTOM': Stream(FLOAT, custom)}, \
           [{'POSITION': Stream(FLOAT, up, bounds=True), 'NORMAL': Stream(FLOAT, turn)},
            {'POSITION': Stream(FLOAT, turn, bounds=True)}]


def triangles(x0=0, x1=NX):
    out = []
    for y in range(NY):
        for x in range(x0, x1):
            a = y * (NX + 1) + x + (NX + 1) * (NY + 1) * (DOUBLED and (x + y) % 2)
            out += [a, a + 1, a + NX + 2, a, a + NX + 2, a + NX + 1]
    return out


def pack(kind, rows):
    return b''.join(Stream(kind, [row]).bytes(row) for row in rows)


class Document(table.Document):
    def __init__(self):
        super().__init__('')
        del self.json['extensionsUsed']
        self.json.update(nodes=[{'mesh': 0, 'extras': {}}], scenes=[{'nodes': [0]}], meshes=[{'name': 'sheet', 'primitives': []}],
                         materials=[{'name': 'bumpy', 'normalTexture': {'index': 0}}])
        self.bins = [bytearray()]

    def lay(self, how, attributes, **more):
        """The numbers of accessors that a layout gives attributes."""
        how(self, list(attributes.values()), **more)
        return {name: s.number for name, s in attributes.items()}

    def separate(self, attributes):
        return self.lay(lambda d, streams: [d.alone(s) for s in streams], attributes)

    def indices(self, list_, kind, view=None, offset=0):
        numbers = Stream(kind, [(i,) for i in list_])
        self.accessor(numbers, self.view(pack(kind, numbers.rows), target=34963) if view is None else view, offset)
        return numbers.number

    def again(self, names):
        """Accessors of their own over the same bytes."""
        self.json['accessors'] += [dict(self.json['accessors'][a]) for a in names.values()]
        return {n: len(self.json['accessors']) - len(names) + i for i, n in enumerate(names)}

    def replace(self, accessor, kind, where, rows):
        self.json['accessors'][accessor]['sparse'] = {
            'count': len(where),
            'indices': {'bufferView': self.view(pack(kind, [(i,) for i in where])), 'componentType': kind},
            'values': {'bufferView': self.view(pack(FLOAT, rows))}}

    def quantized(self):
        self.json['extensionsUsed'] = self.json['extensionsRequired'] = ['KHR_mesh_quantization']

    def primitive(self, attributes, indices=None, **more):
        p = {'attributes': attributes, 'material': 0}
        if indices is not None:
            p['indices'] = indices
        p.update(more)
        self.json['meshes'][0]['primitives'].append(p)

    def write(self, name, how='file', chunks=()):
        path = os.path.join(FOLDER, name)
        stem = os.path.splitext(name)[0]
        for i, data in enumerate(self.bins):
            buffer = {'byteLength': len(data)}
            if how == 'data':
                buffer['uri'] = 'data:application/gltf-buffer;base64,' + base64.b64encode(data).decode()
            elif how == 'file' or i > 0:
                buffer['uri'] = '%s%%20%d.bin' % (stem, i)
                with open(os.path.join(FOLDER, '%s %d.bin' % (stem, i)), 'wb') as f:
                    f.write(data)
            self.json['buffers'].append(buffer)
        if how != 'glb':
            with open(path, 'w') as f:
                json.dump(self.json, f, indent=2)
            return
        text = json.dumps(self.json, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        data = bytes(self.bins[0]) + b'\0' * (-len(self.bins[0]) % 4)
        body = struct.pack('<II', len(text), 0x4E4F534A) + text + struct.pack('<II', len(data), 0x004E4942) + data
        for kind, extra in chunks:
            body += struct.pack('<II', len(extra), kind) + extra
        with open(path, 'wb') as f:
            f.write(b'glTF' + struct.pack('<II', 2, 12 + len(body)) + body)


def one(name, lay_out, kind=USHORT, how='file', chunks=(), **more):
    """A file of one primitive."""
    d = Document()
    d.primitive(lay_out(d), d.indices(triangles(), kind), **more)
    d.write(name, how, chunks)


def interleaved(d, streams, gap=0):
    table.interleaved(d, streams, gap, joined=True)


def with_targets(d, targets):
    return [d.separate({name: Stream(FLOAT, s.rows, **s.how) for name, s in t.items()}) for t in targets]


attributes, targets = sheet()
if DOUBLED:  # more than a byte can number
    UBYTE_INDEX = USHORT
else:
    UBYTE_INDEX = UBYTE

d = Document()
d.primitive(d.separate(attributes), d.indices(triangles(), USHORT), targets=with_targets(d, targets))
d.write('plain.gltf')

d = Document()
d.primitive(d.lay(table.sequential, attributes), d.indices(triangles(), UBYTE_INDEX), targets=with_targets(d, targets))
tail = d.view(b'an unknown extension owns these bytes', align=8)
d.json['extensionsUsed'] = ['VENDOR_secret']
d.json['extensions'] = {'VENDOR_secret': {'bufferView': tail, 'accessor': 0}}
d.write('sequential_u8.gltf')

d = Document()
tight = d.indices(triangles(), UINT)
d.primitive(d.lay(interleaved, attributes, gap=0), tight, targets=with_targets(d, targets))
d.write('interleaved_u32.gltf', 'data')

one('interleaved_gap.glb', lambda d: d.lay(interleaved, attributes, gap=8), how='glb', chunks=[(0x41525458, b'extra chunk.')])

d = Document()
flat = triangles()
unshared = {n: Stream(s.kind, [s.rows[i] for i in flat], s.normalized, **s.how) for n, s in attributes.items()}
d.primitive(d.separate(unshared))
d.write('unindexed.gltf')

# a second primitive over the same vertices has indices that use some of them twice: it gets copies, which the first,
# with none to be copied, must not draw
d = Document()
shared = d.separate(unshared)
first = {i: k for k, i in reversed(list(enumerate(flat)))}
d.primitive(dict(shared))
d.primitive(dict(shared), d.indices([first[i] for i in flat], USHORT))
d.write('two_ranges_unindexed.gltf')

# two primitives on one set of accessors, meeting at a column where u turns
d = Document()
shared = d.separate(attributes)
view = d.view(pack(USHORT, [(i,) for i in triangles(0, 6) + triangles(6, NX)]))
d.primitive(dict(shared), d.indices(triangles(0, 6), USHORT, view))
d.primitive(dict(shared), d.indices(triangles(6, NX), USHORT, view, 2 * len(triangles(0, 6))))
d.write('two_ranges.gltf')

# the same with accessors of their own over the same bytes, and a third primitive that needs nothing
d = Document()
shared = d.separate(attributes)
twins = d.again(shared)
d.primitive(shared, d.indices(triangles(0, 6), USHORT))
d.primitive(twins, d.indices(triangles(6, NX), UINT))
d.json['materials'].append({'name': 'smooth'})
d.primitive({'POSITION': twins['POSITION'], 'NORMAL': shared['NORMAL']}, d.indices(triangles(0, 2), USHORT), material=1)
d.write('twin_accessors.gltf')

# one primitive three times: twice with the same accessors, once with others over the same bytes. A fourth is
# turned by its texture transform, and has a TANGENT of its own over the same rows.
d = Document()
shared = d.separate(attributes)
moves = with_targets(d, targets)
whole = d.indices(triangles(), USHORT)
again = d.again(shared)
d.json['materials'].append({'name': 'bumpy too', 'normalTexture': {'index': 0, 'scale': 0.5}})
d.primitive(dict(shared), whole, targets=[dict(t) for t in moves])
d.primitive(dict(shared), whole, targets=[dict(t) for t in moves], material=1)
d.primitive(again, whole, targets=[dict(t) for t in moves])
d.write('instanced.gltf')
d.json['buffers'] = []
d.json['extensionsUsed'] = ['KHR_texture_transform']
d.json['materials'].append({'name': 'turned', 'normalTexture': {
    'index': 0, 'extensions': {'KHR_texture_transform': {'rotation': 0.5}}}})
d.primitive(dict(shared), whole, targets=[dict(t) for t in moves], material=2)
d.write('instanced_turned.gltf')

# points without indices share the positions: these must keep their count
d = Document()
shared = d.separate(attributes)
d.primitive(shared, d.indices(triangles(), USHORT))
d.json['materials'].append({'name': 'plain'})
d.primitive({'POSITION': shared['POSITION']}, mode=0, material=1)
d.write('shared_with_points.gltf')

# sparse: positions over a base, a morph target of zeros with some rows
d = Document()
positions = attributes['POSITION'].rows
some = range(0, len(positions), 5)
names = d.separate({**attributes, 'POSITION': Stream(FLOAT, [(9.0, 9.0, 9.0) if i in some else r for i, r in enumerate(positions)])})
d.replace(names['POSITION'], UBYTE_INDEX, some, [positions[i] for i in some])
attributes['POSITION'].number = names['POSITION']
d.bounds(attributes['POSITION'])
moved = [i for i in range(len(positions)) if i % 13 in (4, 8)]
target = Stream(FLOAT, [(0.0, 0.0, i * 0.01) if i in moved else (0.0, 0.0, 0.0) for i in range(len(positions))], bounds=True)
d.accessor(target)
d.replace(target.number, USHORT, moved, [target.rows[i] for i in moved])
d.primitive(names, d.indices(triangles(), USHORT), targets=[{'POSITION': target.number}])
d.write('sparse.gltf')

# wrong tangents are there already, interleaved with the rest
tangents = Stream(FLOAT, [(0.0, 1.0, 0.0, 1.0)] * len(positions))
one('tangents_interleaved.gltf', lambda d: d.lay(interleaved, {**attributes, 'TANGENT': tangents}))
# the same in views of their own: as floats, as integers, and sparse over zeros
one('tangents_separate.gltf', lambda d: d.separate({'TANGENT': tangents, **attributes}))
d = Document()
d.quantized()
names = d.separate({'TANGENT': Stream(SHORT, [(0, 32767, 0, 32767)] * len(positions), True), **attributes})
d.primitive(names, d.indices(triangles(), USHORT))
d.write('tangents_short.gltf')
d = Document()
names = d.separate(attributes)
d.accessor(tangents)
names['TANGENT'] = tangents.number
d.replace(names['TANGENT'], USHORT, range(len(positions)), tangents.rows)
d.primitive(names, d.indices(triangles(), USHORT))
d.write('tangents_sparse.gltf')

# in a view of their own, behind them bytes of nobody
d = Document()
names = d.separate({'TANGENT': tangents})
d.bins[0] += b'?' * 40
d.json['bufferViews'][0]['byteLength'] += 40
d.primitive({**names, **d.separate(attributes)}, d.indices(triangles(), USHORT))
d.write('tangents_tail.gltf')

# those of two primitives in one view, as all else of theirs
d = Document()
both = d.lay(table.sequential, {n + twin: Stream(s.kind, s.rows, s.normalized, **s.how) for twin in ('', '!')
                                for n, s in {**attributes, 'TANGENT': tangents}.items()})
for twin in ('', '!'):
    d.primitive({n: both[n + twin] for n in (*attributes, 'TANGENT')}, d.indices(triangles(), USHORT))
d.write('tangents_one_view.gltf')

# several buffers, one of which nothing touches
d = Document()
d.bins += bytearray(), bytearray(b'untouched bytes')
names = d.separate({n: attributes[n] for n in ('POSITION', 'NORMAL')})
d.home = 1
names.update(d.separate({n: attributes[n] for n in attributes if n not in names}))
d.home = 0
d.view(b'more of them', 2)
d.primitive(names, d.indices(triangles(), USHORT))
d.write('three_buffers.gltf')

# KHR_mesh_quantization
d = Document()
d.quantized()
d.primitive(d.lay(interleaved, {
    **attributes, 'POSITION': Stream(SHORT, [tuple(round(v * 8000) for v in r) for r in positions], True, bounds=True),
    'NORMAL': Stream(BYTE, [(0, 0, 127)] * len(positions), True),
    'TEXCOORD_0': Stream(USHORT, [tuple(round(v * 60000) for v in r) for r in attributes['TEXCOORD_0'].rows], True)}),
    d.indices(triangles(), USHORT))
d.write('quantized.gltf')

# a strip and a fan
d = Document()
strip = [i for x in range(NX + 1) for i in (x + NX + 1, x)]
d.primitive(d.separate(attributes), d.indices(strip, USHORT), mode=5)
fan = [6, 5, 6 + NX, 7 + NX, 8 + NX, 7]
d.primitive(d.separate(attributes), d.indices(fan, USHORT), mode=6)
d.write('strip_and_fan.gltf')

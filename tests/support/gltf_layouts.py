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

FOLDER = sys.argv[1]
DOUBLED = '--doubled' in sys.argv
NX, NY = 12, 9  # quads
FLOAT, USHORT, UBYTE, UINT, BYTE, SHORT = 5126, 5123, 5121, 5125, 5120, 5122
CODES = {FLOAT: 'f', USHORT: 'H', UBYTE: 'B', UINT: 'I', BYTE: 'b', SHORT: 'h'}
SIZES = {FLOAT: 4, USHORT: 2, UBYTE: 1, UINT: 4, BYTE: 1, SHORT: 2}
TYPES = {1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4'}


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
    return {'POSITION': (FLOAT, False, positions), 'NORMAL': (FLOAT, False, normals),
            'TEXCOORD_0': (FLOAT, False, uvs), 'COLOR_0': (UBYTE, True, colors),
            'JOINTS_0': (UBYTE, False, joints), 'WEIGHTS_0': (USHORT, True, weights),
            '_CUSTOM': (FLOAT, False, custom)}, \
           [{'POSITION': (FLOAT, False, up), 'NORMAL': (FLOAT, False, turn)}, {'POSITION': (FLOAT, False, turn)}]


def triangles(x0=0, x1=NX):
    out = []
    for y in range(NY):
        for x in range(x0, x1):
            a = y * (NX + 1) + x + (NX + 1) * (NY + 1) * (DOUBLED and (x + y) % 2)
            out += [a, a + 1, a + NX + 2, a, a + NX + 2, a + NX + 1]
    return out


def pack(kind, row):
    return struct.pack('<%d%s' % (len(row), CODES[kind]), *row)


class Document:
    def __init__(self):
        self.json = {'asset': {'generator': 'layouts', 'version': '2.0'}, 'scene': 0,
                     'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0, 'extras': {}}],
                     'meshes': [{'name': 'sheet', 'primitives': []}],
                     'materials': [{'name': 'bumpy', 'normalTexture': {'index': 0}}],
                     'textures': [{'source': 0}], 'images': [{'uri': PNG}],
                     'accessors': [], 'bufferViews': [], 'buffers': [],
                     'extras': {'big': 9007199254740993, 'small': -9223372036854775808, 'tiny': 1e-300,
                                'nothing': None, 'empty': {}, 'list': [[], {}]}}
        self.bins = [bytearray()]

    def view(self, data, buffer=0, align=4, **more):
        target = self.bins[buffer]
        while len(target) % align:
            target.append(0)
        self.json['bufferViews'].append({'buffer': buffer, 'byteOffset': len(target), 'byteLength': len(data), **more})
        target.extend(data)
        return len(self.json['bufferViews']) - 1

    def accessor(self, attribute, view, offset=0, **more):
        kind, normalized, rows = attribute
        a = {'bufferView': view, 'byteOffset': offset, 'componentType': kind, 'count': len(rows),
             'type': TYPES[len(rows[0])]}
        if view is None:
            del a['bufferView'], a['byteOffset']
        if normalized:
            a['normalized'] = True
        a.update(more)
        self.json['accessors'].append(a)
        return len(self.json['accessors']) - 1

    def bounds(self, attribute):
        columns = list(zip(*[struct.unpack('<%df' % len(r), struct.pack('<%df' % len(r), *r)) for r in attribute[2]]))
        return {'min': [min(c) for c in columns], 'max': [max(c) for c in columns]}

    def more(self, name, attribute):
        return self.bounds(attribute) if name == 'POSITION' else {}

    def separate(self, attributes, buffer=0):
        """A view for every accessor."""
        return {n: self.accessor(a, self.view(b''.join(self.padded(a, r) for r in a[2]), buffer,
                                              **self.stride(a)), **self.more(n, a)) for n, a in attributes.items()}

    def row_size(self, attribute):
        return (SIZES[attribute[0]] * len(attribute[2][0]) + 3) // 4 * 4

    def padded(self, attribute, row):
        return pack(attribute[0], row).ljust(self.row_size(attribute), b'\0')

    def stride(self, attribute):
        return {'byteStride': self.row_size(attribute)}

    def sequential(self, attributes):
        """One view per row size, accessors one behind the other, as many exporters do."""
        out = {}
        for size in sorted({self.row_size(a) for a in attributes.values()}):
            names = [n for n in attributes if self.row_size(attributes[n]) == size]
            data, offsets = b'', {}
            for n in names:
                offsets[n] = len(data)
                data += b''.join(self.padded(attributes[n], r) for r in attributes[n][2])
            view = self.view(data, byteStride=size, target=34962)
            for n in names:
                out[n] = self.accessor(attributes[n], view, offsets[n], **self.more(n, attributes[n]))
        return out

    def interleaved(self, attributes, views_overlap=False, gap=0, cut=False, views_cut=False):
        offsets, size = {}, 0
        for n, a in attributes.items():
            offsets[n] = size
            size += self.row_size(a)
        stride = size + gap
        rows = len(next(iter(attributes.values()))[2])
        data = b''.join(b''.join(self.padded(a, a[2][i]) for a in attributes.values()) + b'\xEE' * gap
                        for i in range(rows))
        if cut:
            data = data[:len(data) - gap]
        view = self.view(data, byteStride=stride)
        out = {}
        for n, a in attributes.items():
            if views_overlap:
                base = self.json['bufferViews'][view]['byteOffset']
                self.json['bufferViews'].append({'buffer': 0, 'byteOffset': base + offsets[n],
                                                 'byteLength': (rows - 1) * stride + self.row_size(a) if views_cut
                                                 else len(data) - offsets[n], 'byteStride': stride})
                out[n] = self.accessor(a, len(self.json['bufferViews']) - 1, **self.more(n, a))
            else:
                out[n] = self.accessor(a, view, offsets[n], **self.more(n, a))
        if views_overlap:  # the first view was for the bytes only
            for a in self.json['accessors']:
                if a.get('bufferView', -1) > view:
                    a['bufferView'] -= 1
            del self.json['bufferViews'][view]
        return out

    def indices(self, list_, kind, view=None, offset=0):
        if view is None:
            view = self.view(b''.join(pack(kind, (i,)) for i in list_), target=34963)
        return self.accessor((kind, False, [(i,) for i in list_]), view, offset)

    def again(self, names):
        """Accessors of their own over the same bytes."""
        self.json['accessors'] += [dict(self.json['accessors'][a]) for a in names.values()]
        return {n: len(self.json['accessors']) - len(names) + i for i, n in enumerate(names)}

    def sparse(self, accessor, kind, where, rows):
        self.json['accessors'][accessor]['sparse'] = {
            'count': len(where),
            'indices': {'bufferView': self.view(b''.join(pack(kind, (i,)) for i in where)), 'componentType': kind},
            'values': {'bufferView': self.view(b''.join(pack(FLOAT, r) for r in rows))}}

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


# 1x1, one grey pixel
PNG = 'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg=='


def one(name, lay_out, kind=USHORT, how='file', chunks=(), **more):
    """A file of one primitive."""
    d = Document()
    d.primitive(lay_out(d), d.indices(triangles(), kind), **more)
    d.write(name, how, chunks)


def with_targets(d, targets):
    return [d.separate(t) for t in targets]


attributes, targets = sheet()
if DOUBLED:  # more than a byte can number
    UBYTE_INDEX = USHORT
else:
    UBYTE_INDEX = UBYTE

d = Document()
d.primitive(d.separate(attributes), d.indices(triangles(), USHORT), targets=with_targets(d, targets))
d.write('plain.gltf')

d = Document()
d.primitive(d.sequential(attributes), d.indices(triangles(), UBYTE_INDEX), targets=with_targets(d, targets))
tail = d.view(b'an unknown extension owns these bytes', align=8)
d.json['extensionsUsed'] = ['VENDOR_secret']
d.json['extensions'] = {'VENDOR_secret': {'bufferView': tail, 'accessor': 0}}
d.write('sequential_u8.gltf')

d = Document()
tight = d.indices(triangles(), UINT)
d.primitive(d.interleaved(attributes), tight, targets=with_targets(d, targets))
d.write('interleaved_u32.gltf', 'data')

one('interleaved_gap.glb', lambda d: d.interleaved(attributes, gap=8, cut=True), how='glb',
    chunks=[(0x41525458, b'extra chunk.')])
one('overlapping_views.gltf', lambda d: d.interleaved(attributes, views_overlap=True))
# each view ends with its last element, as Magnum writes them
one('overlapping_cut_views.gltf', lambda d: d.interleaved(attributes, views_overlap=True, views_cut=True))

d = Document()
flat = triangles()
unshared = {n: (k, z, [rows[i] for i in flat]) for n, (k, z, rows) in attributes.items()}
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
view = d.view(b''.join(pack(USHORT, (i,)) for i in triangles(0, 6) + triangles(6, NX)))
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
# and without targets
d.json['buffers'] = []
d.json['meshes'][0]['primitives'] = [{k: v for k, v in p.items() if k != 'targets'}
                                     for p in d.json['meshes'][0]['primitives'][:3]]
d.write('instanced_still.gltf')

# points without indices share the positions: these must keep their count
d = Document()
shared = d.separate(attributes)
d.primitive(shared, d.indices(triangles(), USHORT))
d.json['materials'].append({'name': 'plain'})
d.primitive({'POSITION': shared['POSITION']}, mode=0, material=1)
d.write('shared_with_points.gltf')

# sparse: positions over a base, a morph target of zeros with some rows
d = Document()
plain = dict(attributes)
positions = attributes['POSITION']
wrong = (FLOAT, False, [(9.0, 9.0, 9.0) if i % 5 == 0 else r for i, r in enumerate(positions[2])])
names = d.separate({**plain, 'POSITION': wrong})
some = [i for i in range(len(positions[2])) if i % 5 == 0]
d.sparse(names['POSITION'], UBYTE_INDEX, some, [positions[2][i] for i in some])
d.json['accessors'][names['POSITION']].update(d.bounds(positions))
moved = [i for i in range(len(positions[2])) if i % 13 in (4, 8)]
target = d.accessor((FLOAT, False, positions[2]), None)
d.sparse(target, USHORT, moved, [(0.0, 0.0, i * 0.01) for i in moved])
d.json['accessors'][target].update({'min': [0, 0, 0], 'max': [0, 0, struct.unpack('<f', struct.pack('<f', max(moved) * 0.01))[0]]})
d.primitive(names, d.indices(triangles(), USHORT), targets=[{'POSITION': target}])
d.write('sparse.gltf')

# wrong tangents are there already, interleaved with the rest
tangents = (FLOAT, False, [(0.0, 1.0, 0.0, 1.0)] * len(positions[2]))
one('tangents_interleaved.gltf', lambda d: d.interleaved({**attributes, 'TANGENT': tangents}))
one('tangents_cut_views.gltf',
    lambda d: d.interleaved({'TANGENT': tangents, **attributes}, views_overlap=True, views_cut=True))
# the same in views of their own: as floats, as integers, and sparse over zeros
one('tangents_separate.gltf', lambda d: d.separate({'TANGENT': tangents, **attributes}))
d = Document()
d.quantized()
names = d.separate({'TANGENT': (SHORT, True, [(0, 32767, 0, 32767)] * len(positions[2])), **attributes})
d.primitive(names, d.indices(triangles(), USHORT))
d.write('tangents_short.gltf')
d = Document()
names = d.separate(attributes)
names['TANGENT'] = d.accessor(tangents, None)
d.sparse(names['TANGENT'], USHORT, range(len(positions[2])), tangents[2])
d.primitive(names, d.indices(triangles(), USHORT))
d.write('tangents_sparse.gltf')

# those of two primitives in one view, as all else of theirs
d = Document()
both = d.sequential({n + twin: a for twin in ('', '!') for n, a in {**attributes, 'TANGENT': tangents}.items()})
d.json['accessors'][both['POSITION!']].update(d.bounds(attributes['POSITION']))
for twin in ('', '!'):
    d.primitive({n: both[n + twin] for n in (*attributes, 'TANGENT')}, d.indices(triangles(), USHORT))
d.write('tangents_one_view.gltf')

# several buffers, one of which nothing touches
d = Document()
d.bins.append(bytearray())
d.bins.append(bytearray(b'untouched bytes'))
names = d.separate({n: attributes[n] for n in ('POSITION', 'NORMAL')})
names.update(d.separate({n: attributes[n] for n in attributes if n not in names}, 1))
d.view(b'more of them', 2)
d.primitive(names, d.indices(triangles(), USHORT))
d.write('three_buffers.gltf')

# KHR_mesh_quantization
d = Document()
quantized = dict(attributes)
quantized['POSITION'] = (SHORT, True, [tuple(round(v * 8000) for v in r) for r in positions[2]])
quantized['NORMAL'] = (BYTE, True, [(0, 0, 127)] * len(positions[2]))
quantized['TEXCOORD_0'] = (USHORT, True, [tuple(round(v * 60000) for v in r) for r in attributes['TEXCOORD_0'][2]])
d.quantized()
d.primitive(d.interleaved(quantized), d.indices(triangles(), USHORT))
for a in d.json['accessors']:
    if a['componentType'] == SHORT:
        columns = list(zip(*quantized['POSITION'][2]))
        a['min'], a['max'] = [min(c) for c in columns], [max(c) for c in columns]
d.write('quantized.gltf')

# a strip and a fan
d = Document()
strip = [i for x in range(NX + 1) for i in (x + NX + 1, x)]
d.primitive(d.separate(attributes), d.indices(strip, USHORT), mode=5)
fan = [6, 5, 6 + NX, 7 + NX, 8 + NX, 7]
d.primitive(d.separate(attributes), d.indices(fan, USHORT), mode=6)
d.write('strip_and_fan.gltf')

# the plain mesh as each of its targets moves it, to compare targets' tangents with
def single(value):
    return struct.unpack('<f', struct.pack('<f', value))[0]


for number, target in enumerate(targets):
    moved = dict(attributes)
    for n, delta in target.items():
        rows = [tuple(single(single(a) + single(b)) for a, b in zip(r, t))
                for r, t in zip(attributes[n][2], delta[2])]
        if n == 'NORMAL':
            rows = [tuple(c / sum(x * x for x in r) ** 0.5 for c in r) for r in rows]
        moved[n] = (FLOAT, False, rows)
    one('moved_%d.gltf' % number, lambda d: d.separate(moved))

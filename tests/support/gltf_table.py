#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_table.py make [SEED]      small glTF files in the folder in, made by chance: who shares what, how bytes lie, which tangents are there
gltf_table.py sets                 the sets of options, a line for each: name, options
gltf_table.py run SET NMTAN N      converts the files with the options of SET, of some sets a third, and of those one in N, and says
                                   what is wrong

Each primitive is a plane strip of two squares whose texture is mirrored at the edge between them, turned in another way
in each primitive, so that its tangents are known: along dP/du, the same in a square. The vertices of the edge need copies. The
output must have these tangents at every corner, all else of the input bit for bit, no vertex more than needed, no byte that nobody
uses, and nothing that the specification forbids.
"""
import base64
import json
import math
import os
import random
import struct
import subprocess
import sys
from urllib.parse import unquote

import gltf_lossless as lossless

FLOAT, UINT, USHORT, SHORT, UBYTE, BYTE = 5126, 5125, 5123, 5122, 5121, 5120
CODES = {FLOAT: 'f', UINT: 'I', USHORT: 'H', SHORT: 'h', UBYTE: 'B', BYTE: 'b'}
SIZES = lossless.SIZES
TYPES = {1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4'}
UNIT = {BYTE: 127, UBYTE: 255, SHORT: 32767, USHORT: 65535}


class Stream:
    """Rows of one accessor. `over`: it has the bytes of that one, from row `first` on."""

    def __init__(self, kind, rows, normalized=False, over=None, first=0, **how):
        self.kind, self.rows, self.normalized, self.over, self.first = kind, rows, normalized, over, first
        self.how, self.number = how, None

    def size(self):
        return len(self.bytes(self.rows[0]))

    def type(self):
        return self.how.get('type', TYPES.get(len(self.rows[0])))

    def bytes(self, row):
        """Columns of matrices begin at multiples of four bytes."""
        high = {'MAT2': 2, 'MAT3': 3}.get(self.type(), len(row))
        columns = [struct.pack('<%d%s' % (high, CODES[self.kind]), *row[at:at + high]) for at in range(0, len(row), high)]
        return b''.join(x if len(columns) == 1 else x.ljust((len(x) + 3) // 4 * 4, b'\xDD') for x in columns)


def again(stream):
    return Stream(stream.kind, stream.rows, stream.normalized, over=stream)


POINTS = [(x, y) for y in (0, 1) for x in (0, 1, 2)]
CORNERS = [3, 0, 4, 0, 1, 4, 1, 2, 5, 1, 5, 4]
TURNS = [(1, 0), (0.6, 0.8), (0, 1), (-0.8, 0.6), (-1, 0)]


def strip(k, quantized=False, turn=None):
    """Attributes of the k-th primitive and what a target may add to them."""
    axes = [[0, 0, 0] for _ in range(3)]
    for i in range(3):
        axes[i][(i + k) % 3] = 1
    place = lambda x, y, z: tuple(x * a + y * b + z * c for a, b, c in zip(*axes))
    cos, sin = TURNS[(k if turn is None else turn) % 5]
    turned = lambda u, v: ((2 + cos * u - sin * v) / 4, (2 + sin * u + cos * v) / 4)
    uvs = [turned(abs(x - 1), y) for x, y in POINTS]
    count = len(POINTS)
    attributes = {
        'POSITION': Stream(FLOAT, [place(x, y, k) for x, y in POINTS]),
        'NORMAL': Stream(FLOAT, [place(0, 0, 1)] * count),
        'TEXCOORD_0': Stream(FLOAT, uvs),
        'COLOR_0': Stream(UBYTE, [(i, 2 * i, 3 * i, 255 - k) for i in range(count)], True),
        '_ID': Stream(USHORT, [(10 * k + i,) for i in range(count)]),
    }
    targets = [{'POSITION': Stream(FLOAT, [place(0, 0.5 * max(x - 1, 0), 0) for x, y in POINTS])},
               {'POSITION': Stream(FLOAT, [place(0, 0, 0.25 * x) for x, y in POINTS]),
                'NORMAL': Stream(FLOAT, [place(-0.25, 0, 0)] * count)},
               {'COLOR_0': Stream(FLOAT, [(0.0, 0.5, 0.0, 0.0)] * count)}]
    if quantized:
        targets[1] = {'POSITION': Stream(SHORT, [place(0, 0, x) for x, y in POINTS]),
                      'NORMAL': Stream(BYTE, [place(-32, 0, 0)] * count, True)}
        attributes['POSITION'].kind = SHORT
        attributes['NORMAL'] = Stream(BYTE, [place(0, 0, 127)] * count, True)
        attributes['TEXCOORD_0'] = Stream(USHORT, [tuple(round(65535 * c) for c in row) for row in uvs], True)
    return attributes, targets


def corners(list_=None, kind=USHORT):
    return Stream(kind, [(i,) for i in (CORNERS if list_ is None else list_)])


def primitive(attributes, indices=None, material=0, targets=None, **more):
    return {'attributes': attributes, 'indices': indices, 'material': material, 'targets': targets, **more}


# ---- who shares what: lists of meshes, which are lists of primitives ----

def alone(q):
    return [[primitive(strip(1, q)[0], corners(kind=UBYTE))]]


def two(q):
    return [[primitive(strip(1, q)[0], corners())], [primitive(strip(2, q)[0], corners(kind=UINT))]]


def soup(q):
    attributes = strip(3, q)[0]
    for stream in attributes.values():
        stream.rows = [stream.rows[i] for i in CORNERS]
    return [[primitive(attributes)]]


def ranges(q):
    attributes, whole = strip(1, q)[0], corners()
    part = lambda first, count: Stream(USHORT, whole.rows[first:first + count], over=whole, first=first)
    return [[primitive(attributes, part(0, 6)), primitive(dict(attributes), part(6, 6)), primitive(dict(attributes), whole)]]


def ranges_apart(q):
    """Each user needs less than both."""
    attributes = strip(1, q)[0]
    return [[primitive(attributes, corners(CORNERS[:6])), primitive(dict(attributes), corners(CORNERS[6:], UBYTE))]]


def twins(q):
    attributes = strip(1, q, turn=2)[0]
    return [[primitive(attributes, corners(CORNERS[:9]))],
            [primitive({n: again(s) for n, s in attributes.items()}, corners(CORNERS[6:]))]]


def instances(q):
    attributes, whole = strip(1, q)[0], corners()
    return [[primitive(attributes, whole), primitive({n: again(s) for n, s in attributes.items()}, again(whole))],
            [primitive(dict(attributes), whole)]]


def same_indices(q):
    """One primitive splits the edge between the squares, the other nothing."""
    whole, other = corners(), strip(2, q)[0]
    cos_sin = [(x, y) for x, y in POINTS]
    other['TEXCOORD_0'].rows = [(x, y) for x, y in cos_sin] if not q else [(20000 * x, 20000 * y) for x, y in cos_sin]
    return [[primitive(strip(1, q)[0], whole), primitive(other, whole)]]


def same_positions(q):
    """Other texture coordinates over the same positions and normals: a TANGENT for each."""
    first, second = strip(1, q)[0], strip(1, q, turn=2)[0]
    for name in ('POSITION', 'NORMAL'):
        second[name] = first[name]
    return [[primitive(first, corners()), primitive(second, corners(CORNERS[6:] + CORNERS[:6]))]]


def same_texcoords(q):
    first, second = strip(1, q)[0], strip(2, q, turn=1)[0]
    second['TEXCOORD_0'] = again(first['TEXCOORD_0'])
    return [[primitive(first, corners())], [primitive(second, corners())]]


def needless(q):
    """The second has the same vertices and a material that needs no tangents."""
    attributes, whole = strip(1, q)[0], corners()
    return [[primitive(attributes, whole), primitive(dict(attributes), whole, material=1)]]


def points(q):
    """Points and lines over the same vertices; points count all of an accessor."""
    attributes = strip(1, q)[0]
    return [[primitive(attributes, corners()), primitive({'POSITION': attributes['POSITION']}, material=1, mode=0)]]


def lines(q):
    attributes = strip(1, q)[0]
    return [[primitive(attributes, corners()), primitive(dict(attributes), corners([0, 1, 1, 2]), material=1, mode=1)]]


def named_twice(q):
    """The accessor of an attribute is that of another one, too."""
    attributes = strip(1, q)[0]
    attributes['TEXCOORD_1'] = attributes['TEXCOORD_0']
    attributes['_NORMAL'] = again(attributes['NORMAL'])
    return [[primitive(attributes, corners())]]


def modes(q):
    first, second = strip(1, q)[0], strip(2, q)[0]
    return [[primitive(first, corners([3, 0, 4, 1, 5, 2]), mode=5), primitive(second, corners([1, 2, 5, 4, 3, 0]), mode=6)]]


def morphs(q):
    attributes, targets = strip(1, q)
    return [[primitive(attributes, corners(), targets=targets)]]


def morphs_shared(q):
    """Two primitives of the same vertices and targets, and a third with other targets of a target's accessors."""
    attributes, (first, second, third) = strip(1, q)
    other = strip(1, q)[0]
    return [[primitive(attributes, corners(CORNERS[:6]), targets=[first, second]),
             primitive(dict(attributes), corners(CORNERS[6:]), targets=[dict(first), {n: again(s) for n, s in second.items()}])],
            [primitive(other, corners(), targets=[{'POSITION': again(first['POSITION'])}, {}])]]


def morphs_sparse(q):
    attributes, (first, second, third) = strip(1, q)[0], strip(1)[1]
    first['POSITION'].how = {'sparse': 'zeros'}
    second['NORMAL'].how = {'sparse': 'base'}
    return [[primitive(attributes, corners(), targets=[first, second])]]


def morphs_nothing(q):
    """Targets without bytes move nothing; a target's deltas are the values of an attribute."""
    attributes, (first, second, third) = strip(1, q)[0], strip(1)[1]
    zero = Stream(FLOAT, [(0.0, 0.0, 0.0)] * len(POINTS), bare=True)
    return [[primitive(attributes, corners(), targets=[{'POSITION': zero}, {}, {'NORMAL': again(first['POSITION'])}, first])]]


def loose(q):
    """Accessors of nobody have the bytes of positions and indices."""
    attributes, whole = strip(1, q)[0], corners()
    return [[primitive(attributes, whole, loose=[
        again(attributes['POSITION']), Stream(USHORT, [(a, b) for (a,), (b,) in zip(whole.rows[::2], whole.rows[1::2])], over=whole)])]]


def loose_soup(q):
    """The same of vertices that --weld takes away."""
    (mesh,) = soup(q)
    mesh[0]['loose'] = [again(stream) for stream in mesh[0]['attributes'].values()]
    return [mesh]


def loose_morphs(q):
    """Vertices that --weld would take away, but for an accessor of nobody with the deltas of their targets."""
    (mesh,), (first, second, third) = soup(q), strip(3)[1]
    for stream in [*first.values(), *second.values()]:
        stream.rows = [stream.rows[i] for i in CORNERS]
    mesh[0].update(targets=[first, second], loose=[again(second['NORMAL'])])
    return [mesh]


def unused(q):
    """Vertices that no triangle has stay where they are."""
    attributes = strip(1, q)[0]
    return [[primitive(attributes, corners(CORNERS[6:]))]]


def other_set(q):
    """The normal texture has the second set of coordinates; the first is on another side."""
    attributes = strip(1, q)[0]
    attributes['TEXCOORD_1'] = strip(1, q, turn=3)[0]['TEXCOORD_0']
    return [[primitive(attributes, corners(), material=2), primitive(dict(attributes), corners())]]


def mirrored(q):
    """A texture transform turns the second primitive's tangents, and w, over."""
    attributes, whole = strip(1, q)[0], corners()
    return [[primitive(attributes, whole), primitive(dict(attributes), whole, material=3)]]


def animated(q):
    """Positions are what an animation puts a node to, too."""
    attributes = strip(1)[0]
    attributes['_TIME'] = Stream(FLOAT, [(float(i),) for i in range(len(POINTS))], exact=True)

    def animate(g, numbers):
        a = g['accessors'][numbers['_TIME']]
        a['min'], a['max'] = [0.0], [5.0]
        g['animations'] = [{'channels': [{'sampler': 0, 'target': {'node': 0, 'path': 'translation'}}],
                            'samplers': [{'input': numbers['_TIME'], 'output': numbers['POSITION']}]}]
    return [[primitive(attributes, corners(), more=animate)]]


def placed(q):
    """Positions are the places of instances, too."""
    def place(g, numbers):
        g['extensionsUsed'].append('EXT_mesh_gpu_instancing')
        g['nodes'][0]['extensions'] = {'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': numbers['POSITION']}}}
    return [[primitive(strip(1)[0], corners(), more=place)]]


def normals_missing(q):
    first, second = strip(1, q)[0], strip(2, q)[0]
    del first['NORMAL'], second['NORMAL']
    return [[primitive(first, corners(CORNERS[:6])), primitive(dict(first), corners(CORNERS[6:]))], [primitive(second, corners())]]


def sparse_together(q):
    """Targets of two primitives and of one have the same list of sparse indices."""
    meshes = []
    for k in (1, 2):
        attributes, (first, second, third) = strip(k, q)[0], strip(k)[1]
        first['POSITION'].how = {'sparse': 'zeros', 'list': 'one'}
        also = {'POSITION': Stream(FLOAT, [tuple(2 * c for c in row) for row in first['POSITION'].rows], sparse='zeros', list='one')}
        meshes.append([primitive(attributes, corners(), targets=[first, also])])
    return meshes


def unfinished(q):
    """Indices behind the last triangle; bounds of indices."""
    whole = corners(CORNERS + [2])
    whole.how['bounds'] = True
    return [[primitive(strip(1, q)[0], whole)]]


def many(q, targets=False):
    """Copies come to more than a byte can number."""
    attributes, (moves, second, third) = strip(1, q)[0], strip(1)[1]
    for name, stream in [*attributes.items(), *moves.items()]:
        stream.rows = stream.rows * 40
    attributes['_ID'].rows = [(i,) for i in range(240)]
    indices = corners([6 * k + c for k in range(40) for c in CORNERS], UBYTE)
    if targets:
        moves['POSITION'].how = {'sparse': 'zeros'}
    return [[primitive(attributes, indices, targets=[moves] if targets else None)]]


def many_sparse(q):
    return many(q, True)


def far(q):
    """A primitive with few vertices of a wide range, and one with some vertices of their end."""
    (mesh,) = many(q)
    attributes = mesh[0]['attributes']
    return [[primitive(attributes, corners(CORNERS[:6] + [234 + c for c in CORNERS[6:]])),
             primitive(dict(attributes), corners([228 + c for c in CORNERS], UINT)), primitive(dict(attributes), mesh[0]['indices'])]]


def soup_again(q):
    """Sparse are all vertices but the first of each, and indices."""
    (mesh,) = soup(q)
    for name in ('_ID', 'COLOR_0'):
        mesh[0]['attributes'][name].how['sparse'] = 'again'
    whole = Stream(USHORT, [(i,) for i in range(12)], sparse='base')
    return [mesh, [primitive({n: again(s) for n, s in mesh[0]['attributes'].items() if not s.how} | {
        n: s for n, s in mesh[0]['attributes'].items() if s.how}, whole)]]


def soup_left(q):
    """Primitives that get no tangents; --weld takes them, too."""
    first, second = soup(q)[0][0]['attributes'], soup(q)[0][0]['attributes']
    return [[primitive(first, material=1)], [primitive(second, corners(range(12)), material=1), primitive(
        {'POSITION': second['POSITION']}, material=1, mode=3)]]


SHARING = [alone, two, soup, ranges, ranges_apart, twins, instances, same_indices, same_positions, same_texcoords, needless, points,
           lines, named_twice, modes, morphs, morphs_shared, morphs_sparse, morphs_nothing, loose, loose_soup, unused, other_set, mirrored, animated,
           placed, normals_missing, sparse_together, unfinished, many, many_sparse, far, soup_again, soup_left, loose_morphs]


# ---- which tangents are there ----

def all_primitives(meshes):
    return [p for mesh in meshes for p in mesh]


def wrong_tangents(p, kind=FLOAT, **how):
    one = UNIT.get(kind, 1)
    count = len(p['attributes']['POSITION'].rows)
    return Stream(kind, [(0, 0, one, one) if i % 2 else (one, 0, 0, -one) for i in range(count)], kind != FLOAT, **how)


def by_vertices(meshes, make):
    """The same TANGENT for primitives with the same positions."""
    made = {}
    for p in all_primitives(meshes):
        if p.get('mode', 4) > 3 and 'TEXCOORD_0' in p['attributes']:
            key = id(p['attributes']['POSITION'])
            if key not in made:
                made[key] = make(p)
            p['attributes']['TANGENT'] = made[key]


def none(meshes):
    pass


def floats(meshes):
    by_vertices(meshes, wrong_tangents)


def shorts(meshes):
    by_vertices(meshes, lambda p: wrong_tangents(p, SHORT))
    return True


def sparse_tangents(meshes):
    by_vertices(meshes, lambda p: wrong_tangents(p, sparse='zeros'))


def bare_tangents(meshes):
    by_vertices(meshes, lambda p: Stream(FLOAT, [(0, 0, 0, 0)] * len(p['attributes']['POSITION'].rows), bare=True))


def first_has(meshes):
    """The first primitive alone has tangents."""
    p = meshes[0][0]
    p['attributes']['TANGENT'] = wrong_tangents(p)


def each_has(meshes):
    """Each primitive has tangents of its own, whatever else it shares."""
    for p in all_primitives(meshes):
        if 'TEXCOORD_0' in p['attributes']:
            p['attributes']['TANGENT'] = wrong_tangents(p)


def used_elsewhere(meshes):
    """Another attribute of the first primitive has the tangents' accessor, another accessor has their bytes."""
    floats(meshes)
    p = meshes[0][0]
    p['attributes']['_OTHER'] = p['attributes']['TANGENT']
    for other in all_primitives(meshes)[1:]:
        if 'TANGENT' in other['attributes']:
            other['attributes']['_OTHER'] = again(other['attributes']['TANGENT'])


def part_elsewhere(meshes):
    """An accessor of nobody has bytes of the tangents."""
    floats(meshes)
    stream = meshes[0][0]['attributes']['TANGENT']
    meshes[0][0].setdefault('loose', []).append(Stream(FLOAT, [row[:2] for row in stream.rows], over=stream))


TANGENTS = [none, floats, shorts, sparse_tangents, bare_tangents, first_has, each_has, used_elsewhere, part_elsewhere]


# ---- how bytes lie ----

class Document:
    def __init__(self, name):
        self.name = name
        self.json = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': []}], 'nodes': [], 'meshes': [],
                     'textures': [{'source': 0}], 'materials': [
                         {'normalTexture': {'index': 0}}, {}, {'normalTexture': {'index': 0, 'texCoord': 1}},
                         {'normalTexture': {'index': 0, 'extensions': {'KHR_texture_transform': {'scale': [-1, 1]}}}}],
                     'extensionsUsed': ['KHR_texture_transform'], 'images': [{'uri': PNG}], 'accessors': [], 'bufferViews': [], 'buffers': [],
                     'extras': {'big': 9007199254740993, 'small': -9223372036854775808, 'tiny': 1e-300, 'nothing': None, 'empty': {}, 'list': [[], {}]}}
        self.bins = [bytearray(), bytearray(), bytearray()]
        self.fallback, self.lists, self.home, self.numbers = {}, {}, 0, UBYTE  # of sparse elements: their type

    def primitives(self):
        return [p for mesh in self.json['meshes'] for p in mesh['primitives']]

    def view(self, data, buffer=None, align=4, **more):
        buffer = self.home if buffer is None else buffer
        target = self.bins[buffer]
        target.extend(bytes(-len(target) % align))
        self.json['bufferViews'].append({'buffer': buffer, 'byteOffset': len(target), 'byteLength': len(data), **more})
        target.extend(data)
        return len(self.json['bufferViews']) - 1

    def accessor(self, s, view=None, offset=0):
        a = {'componentType': s.kind, 'count': len(s.rows), 'type': s.type()}
        if view is not None:
            a['bufferView'] = view
            if offset:
                a['byteOffset'] = offset
        if s.normalized:
            a['normalized'] = True
        self.json['accessors'].append(a)
        s.number = len(self.json['accessors']) - 1
        self.bounds(s)

    def bounds(self, s):
        if s.how.get('bounds'):
            rows = [struct.unpack('<%d%s' % (len(row), CODES[s.kind]), s.bytes(row)) for row in s.rows]
            a = self.json['accessors'][s.number]
            a['min'], a['max'] = ([f(column) for column in zip(*rows)] for f in (min, max))

    def alone(self, s, buffer=None, width=None, **more):
        """A view of its own; rows are as wide as attributes need."""
        width = width or (s.size() if s.how.get('indices') else (s.size() + 3) // 4 * 4)
        if width != s.size():
            more['byteStride'] = width
        self.accessor(s, self.view(b''.join(s.bytes(row).ljust(width, b'\0') for row in s.rows), buffer, **more))

    def sparse(self, s):
        zero = (0,) * len(s.rows[0])
        base, kind = s.how['sparse'] != 'zeros', self.numbers
        rows = [i for i, row in enumerate(s.rows) if any(row) and (not base or i % 2)]
        if s.how['sparse'] == 'again':
            rows = [i for i, row in enumerate(s.rows) if row in s.rows[:i]]
        whole = s.rows
        if base:
            s.rows = [tuple(5 for _ in row) if i in rows else row for i, row in enumerate(whole)]
            self.alone(s)
        else:
            self.accessor(s)
        s.rows = whole
        self.bounds(s)
        indices = self.lists.get(s.how.get('list'))
        if indices is None:
            indices = self.lists[s.how.get('list', id(s))] = self.view(struct.pack('<%d%s' % (len(rows), CODES[kind]), *rows))
        self.json['accessors'][s.number]['sparse'] = {
            'count': len(rows), 'indices': {'bufferView': indices, 'componentType': kind},
            'values': {'bufferView': self.view(b''.join(s.bytes(whole[i]) for i in rows) or s.bytes(zero))}}

    def put(self, lay_out, streams):
        """Gives all streams an accessor; what is sparse or bare is so in each layout."""
        usual = []
        for s in streams:
            if s.over:
                continue
            if s.how.get('bare'):
                self.accessor(s)
            elif s.how.get('sparse'):
                self.sparse(s)
            else:
                usual.append(s)
        lay_out(self, [s for s in usual if s.how.get('vertex')])
        for s in usual:
            if not s.how.get('vertex'):
                self.alone(s, target=34963) if s.how.get('indices') else self.alone(s)
        for s in streams:
            if s.over:
                root = s.over
                a = dict(self.json['accessors'][root.number], count=len(s.rows), type=s.type())
                if s.first:
                    a['byteOffset'] = a.get('byteOffset', 0) + s.first * s.size()
                self.json['accessors'].append(a)
                s.number = len(self.json['accessors']) - 1

    def write(self, folder, binary=False, images=0, embedded=False):
        if images == 1:
            self.json['images'] = [{'uri': 'n%20(1).png', 'name': 'n'}]
        elif images == 2:
            self.json['images'] = [{'bufferView': self.view(PIXEL, align=1), 'mimeType': 'image/png'}]
        numbers = {}
        for number, data in enumerate(self.bins):
            if not data and number:
                continue
            numbers[number] = len(self.json['buffers'])
            buffer = {'byteLength': max(1, len(data))}
            stands_in = number == self.fallback.get('number')
            if stands_in:
                buffer['extensions'] = {self.fallback['extension']: {'fallback': True}}
            if (number or not binary) and (not stands_in or self.fallback['bytes']):
                buffer['uri'] = '%s-%d.bin' % (self.name, number)
                if embedded:
                    buffer['uri'] = 'data:application/octet-stream;base64,' + base64.b64encode(data or b'\0').decode()
                else:
                    with open(os.path.join(folder, buffer['uri']), 'wb') as file:
                        file.write(data or b'\0')
            self.json['buffers'].append(buffer)
        for view in self.json['bufferViews']:
            view['buffer'] = numbers[view['buffer']]
        text = json.dumps(self.json, separators=(',', ':')).encode()
        if binary:
            text += b' ' * (-len(text) % 4)
            data = bytes(self.bins[0] or 1)
            data += bytes(-len(data) % 4)
            data = struct.pack('<II', len(data), 0x004E4942) + data + struct.pack('<II', 12, 0x41525458) + b'extra chunk.'
            text = struct.pack('<4sIIII', b'glTF', 2, 20 + len(text) + len(data), len(text), 0x4E4F534A) + text + data
        with open(os.path.join(folder, self.name + ('.glb' if binary else '.gltf')), 'wb') as file:
            file.write(text)


def separate(d, streams):
    for s in streams:
        d.alone(s, target=34962)


def buffers(d, streams):
    """Streams in two buffers; a third has bytes of which nobody knows."""
    for number, s in enumerate(streams):
        d.alone(s, buffer=number % 2)
    d.view(b'not ours', 2)


def sequential(d, streams):
    """A view for each width, accessors one behind the other."""
    for width in sorted({(s.size() + 3) // 4 * 4 for s in streams}):
        group = [s for s in streams if (s.size() + 3) // 4 * 4 == width]
        view, offset = d.view(b''.join(s.bytes(row).ljust(width, b'\0') for s in group for row in s.rows), byteStride=width), 0
        for s in group:
            d.accessor(s, view, offset)
            offset += width * len(s.rows)


def blocks(streams, joined):
    """Streams of one length and primitive."""
    key = lambda s: (len(s.rows), 0 if joined else s.how['owner'])
    for one in sorted({key(s) for s in streams}):
        group = []
        for s in [s for s in streams if key(s) == one]:
            if group and sum(x.size() + 3 for x in [*group, s]) > 240:  # a stride is at most 252
                yield group
                group = []
            group.append(s)
        yield group


def interleaved(d, streams, gap=4, views=False, joined=False, cut=True):
    for group in blocks(streams, joined):
        offsets, stride = [], 0
        for s in group:
            offsets.append(stride)
            stride += (s.size() + 3) // 4 * 4
        stride += gap
        rows = zip(*[[s.bytes(row).ljust((s.size() + 3) // 4 * 4, b'\0') for row in s.rows] for s in group])
        data = b''.join(b''.join(row) + b'\xEE' * gap for row in rows)
        view = d.view(data, byteStride=stride)
        begin = d.json['bufferViews'][view]['byteOffset']
        if views:
            del d.json['bufferViews'][view]
        for s, offset in zip(group, offsets):
            if views:  # each ends with its last element, or with the bytes of all
                length = (len(s.rows) - 1) * stride + s.size() if cut else len(data) - offset
                d.json['bufferViews'].append({'buffer': d.home, 'byteOffset': begin + offset, 'byteStride': stride, 'byteLength': length})
                d.accessor(s, len(d.json['bufferViews']) - 1)
            else:
                d.accessor(s, view, offset)


def tight(d, streams):
    interleaved(d, streams, 0)


def together(d, streams):
    """Vertices of all primitives beside each other."""
    interleaved(d, streams, 0, joined=True)


def overlapping(d, streams):
    """Positions last."""
    interleaved(d, streams[::-1], 0, True)


def overlapping_whole(d, streams):
    interleaved(d, streams, 4, True, cut=False)


def backwards(d, streams):
    """The bytes of later streams come first; views have another order than bytes."""
    first = len(d.json['bufferViews'])
    for s in reversed(streams):
        d.alone(s)
    d.json['bufferViews'][first:] = d.json['bufferViews'][first:][::-1]
    for s in streams:
        a = d.json['accessors'][s.number]
        a['bufferView'] = first + len(d.json['bufferViews']) - 1 - a['bufferView']


def sparse_positions(d, streams):
    for s in streams:
        if s.how.get('name') in ('POSITION', 'TEXCOORD_0', '_ID') and any(map(any, s.rows)):
            s.how = dict(s.how, sparse='base')
            d.sparse(s)
        else:
            d.alone(s)


# ---- views that meshoptimizer compresses ----

def pack_rows(rows, width):
    """Version 0 of the vertex codec, in which each group of differences is stored as it is."""
    data, last, most = b'\xa0', rows[0], min(256, 8192 // width // 16 * 16)
    for begin in range(0, len(rows), most):
        block = rows[begin:begin + most]
        for k in range(width):
            column = [row[k] for row in block]
            signed = [(b - a + 128) % 256 - 128 for a, b in zip([last[k]] + column, column)]
            groups = bytes((d << 1 ^ d >> 7) & 255 for d in signed).ljust((len(block) + 15) // 16 * 16, b'\0')
            data += b'\xff' * ((len(groups) // 16 + 3) // 4) + groups
        last = block[-1]
    return data + bytes(max(0, 32 - width)) + rows[0]


def pack_indices(numbers, triangles):
    """Each index by its difference to the last one: of a list of triangles, or of any list."""
    def varint(v):
        out = b''
        while v >= 128:
            out, v = out + bytes([v & 127 | 128]), v >> 7
        return out + bytes([v])
    zigzag = lambda d: d << 1 if d >= 0 else (-d << 1) - 1
    last, data = 0, b''
    for i, number in enumerate(numbers):
        data += b'\xff' * (triangles and i % 3 == 0) + varint(zigzag(number - last) << (not triangles))
        last = number
    return b'\xe1' + b'\xff' * (len(numbers) // 3) + data + bytes(16) if triangles else b'\xd1' + data + bytes(4)


def octahedral(row):
    """A unit vector along an axis as it is before the filter, which makes integers of it."""
    x, y, z = row[:3]
    return struct.pack('<4b', x, y, 127, 0) if z >= 0 else struct.pack('<4b', 127, 127, 127, 0)


def exponential(row):
    """Floats as 24 bits and an exponent: quarters of integers."""
    return b''.join(struct.pack('<I', round(4 * x) & 0xFFFFFF | 254 << 24) for x in row)


def pack_views(d, extension, filters, fallback):
    """Compresses the views that have whole rows of attributes, or indices."""
    g = d.json
    attributes = [(n, i) for p in d.primitives() for o in [p['attributes']] + p.get('targets', []) for n, i in o.items()]
    lists = [(p['indices'], p.get('mode', 4)) for p in d.primitives() if 'indices' in p]
    plain, packed = len(d.bins), bytearray()
    d.bins.append(bytearray())
    for number, view in enumerate(g['bufferViews']):
        users = [i for i, a in enumerate(g['accessors']) if a.get('bufferView') == number]
        data = bytes(d.bins[view['buffer']][view['byteOffset']:view['byteOffset'] + view['byteLength']])
        a = g['accessors'][users[0]] if users else {}
        row = SIZES[a['componentType']] * lossless.WIDTHS[a['type']] if users else 1
        stride = view.get('byteStride', row)
        how = {}
        if users and all(i in [x for _, x in attributes] for i in users) and stride % 4 == 0 and len(data) % stride == 0:
            names, kind = {n for n, i in attributes if i in users}, a['componentType']
            rows = [data[at:at + stride] for at in range(0, len(data), stride)]
            if filters and len(users) == 1 and names == {'NORMAL'} and kind == BYTE and 127 in data:
                rows, how = [octahedral(struct.unpack('<4b', r)) for r in rows], {'filter': 'OCTAHEDRAL'}
            elif filters and len(users) == 1 and kind == FLOAT and names == {'POSITION'}:
                rows, how = [exponential(struct.unpack('<3f', r)) for r in rows], {'filter': 'EXPONENTIAL'}
            bytes_, how['mode'] = pack_rows(rows, stride), 'ATTRIBUTES'
        elif users and row in (2, 4) and [m for i, m in lists if i in users]:
            numbers = [int.from_bytes(data[at:at + row], 'little') for at in range(0, len(data), row)]
            how['mode'] = 'TRIANGLES' if {m for i, m in lists if i in users} == {4} and len(numbers) % 3 == 0 else 'INDICES'
            bytes_ = pack_indices(numbers, how['mode'] == 'TRIANGLES')
        else:
            continue
        packed.extend(bytes(-len(packed) % 4))
        view['extensions'] = {extension: {'buffer': 0, 'byteOffset': len(packed), 'byteLength': len(bytes_), 'byteStride': stride,
                                          'count': len(data) // stride, **how}}
        packed.extend(bytes_)
        target = d.bins[plain]
        target.extend(bytes(-len(target) % 4))
        view['buffer'], view['byteOffset'] = plain, len(target)
        target.extend(data)
    # what is plain stays in its buffer, the packed bytes come behind it
    base = len(d.bins[0]) + -len(d.bins[0]) % 4
    d.bins[0].extend(bytes(base - len(d.bins[0])) + packed)
    for view in g['bufferViews']:
        if 'extensions' in view:
            view['extensions'][extension]['byteOffset'] += base
    d.fallback = {'number': plain, 'extension': extension, 'bytes': fallback}
    for key in ('extensionsUsed', 'extensionsRequired'):
        if key == 'extensionsUsed' or not fallback:
            g[key] = g.get(key, []) + [extension]


LAYOUTS = [separate, sequential, interleaved, tight, together, overlapping, overlapping_whole, backwards, buffers, sparse_positions]
PNG = 'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg=='
PIXEL = base64.b64decode(PNG.split(',')[1])


def build(name, sharing, tangents, lay_out, quantized=False):
    d, meshes, streams = Document(name), sharing(quantized), []
    quantized = bool(tangents(meshes)) or quantized

    def use(stream, **how):
        if stream is None:
            return None
        if stream.over:
            use(stream.over, **how)
        if stream not in streams:
            stream.how = {**how, **stream.how}
            streams.append(stream)
        return stream
    for owner, p in enumerate(all_primitives(meshes)):
        for name_, stream in p['attributes'].items():
            use(stream, vertex=True, name=name_, bounds=name_ == 'POSITION', owner=owner)
        for target in p['targets'] or []:
            for name_, stream in target.items():
                use(stream, vertex=True, bounds=name_ == 'POSITION', owner=owner)
        use(p['indices'], indices=True)
        for stream in p.get('loose', []):
            use(stream)
    d.put(lay_out, streams)
    for mesh in meshes:
        d.json['scenes'][0]['nodes'].append(len(d.json['nodes']))
        d.json['nodes'].append({'mesh': len(d.json['meshes'])})
        list_ = []
        for p in mesh:
            q = {'attributes': {n: s.number for n, s in p['attributes'].items()}, 'material': p['material']}
            if p['indices']:
                q['indices'] = p['indices'].number
            if p['targets']:
                q['targets'] = [{n: s.number for n, s in target.items()} for target in p['targets']]
            if 'mode' in p:
                q['mode'] = p['mode']
            list_.append(q)
        d.json['meshes'].append({'primitives': list_})
    if quantized:
        d.json['extensionsUsed'].append('KHR_mesh_quantization')
        d.json['extensionsRequired'] = ['KHR_mesh_quantization']
    for p in all_primitives(meshes):
        if 'more' in p:
            p['more'](d.json, {n: s.number for n, s in p['attributes'].items()})
    return d


# Attributes that tangents do not need, beside those of strip(): type, what each vertex has.
MORE = {
    'TEXCOORD_1': (FLOAT, None, lambda i: (i % 5 / 4, 1.0)), 'COLOR_1': (USHORT, None, lambda i: (i, 7, 65535)),
    'JOINTS_0': (UBYTE, None, lambda i: (i % 5, 0, 1, 2)), 'WEIGHTS_0': (FLOAT, None, lambda i: (0.25, 0.5, 0.25, 0.0)),
    '_BYTES': (BYTE, None, lambda i: (-i % 100, i % 100)), '_NUMBER': (UINT, None, lambda i: (70000 + i,)),
    '_ROUND': (UBYTE, 'MAT2', lambda i: (i % 250, 1, 2, 3)), '_SHORT': (SHORT, 'MAT3', lambda i: (-i, 1, 2, 3, 4, 5, 6, 7, 8)),
    '_WIDE': (FLOAT, 'MAT4', lambda i: (i, *range(15)))}


class Chance:
    """How one file is: all that depends on chance is decided here, so that it can be built twice."""

    def __init__(self, seed, layouts):
        chance = random.Random(seed)
        few = [sharing for sharing in SHARING if sharing not in (many, many_sparse, far)]
        self.sharing = [chance.choice(SHARING)] + chance.sample(few, chance.choice((0, 0, 1, 2)))
        self.tangents, self.layouts = chance.choice(TANGENTS), chance.sample(layouts, chance.choice((1, 1, 2)))
        self.quantized, self.seed = chance.random() < 0.25, seed
        self.name = '-'.join(x.__name__ for x in (*self.sharing, self.tangents, *self.layouts)) + '-quantized' * self.quantized

    def meshes(self, quantized):
        chance, meshes = random.Random(self.seed), sum([sharing(quantized) for sharing in self.sharing], [])
        for p in all_primitives(meshes):
            count = len(p['attributes']['POSITION'].rows)
            for name in chance.sample(list(MORE), chance.choice((0, 0, 1, 2))):
                kind, type_, row = MORE[name]
                p['attributes'].setdefault(name, Stream(kind, [row(i) for i in range(count)], name[0] == 'C', **(
                    {'type': type_} if type_ else {})))
        return meshes

    def lay_out(self, d, streams):
        """Some streams in one way, the others in another; between them lies what nobody knows."""
        chance = random.Random(self.seed)
        d.numbers = chance.choice((UBYTE, USHORT, UINT))
        groups = [[] for _ in self.layouts]
        for s in streams:
            chance.choice(groups).append(s)
        for layout, group in zip(self.layouts, groups):
            if chance.random() < 0.25:
                d.view(b'?' * chance.randrange(1, 9), align=chance.choice((1, 4)))
            d.home = chance.choice((0, 0, 0, 1))
            layout(d, group)
        if chance.random() < 0.25:
            d.json['extensionsUsed'].append('VENDOR_secret')
            d.json['extensions'] = {'VENDOR_secret': {'bufferView': d.view(b'an unknown extension owns these bytes', align=8)}}

    def build(self):
        return build(self.name, self.meshes, self.tangents, self.lay_out, self.quantized)


def make(seed=1):
    for folder in ('in', 'plain', 'packed'):
        os.makedirs(folder, exist_ok=True)
    with open('in/n (1).png', 'wb') as file:
        file.write(PIXEL)
    for number in range(200):
        one = Chance('%d in %d' % (seed, number), LAYOUTS)
        one.name = '%03d-%s' % (number, one.name)
        one.build().write('in', number % 5 == 0, number % 3, number % 7 == 0)
    # the same with compressed views
    for number in range(100):
        one = Chance('%d packed %d' % (seed, number), [separate, sequential, tight, sparse_positions])
        one.name = '%03d-%s' % (number, one.name)
        one.build().write('plain')
        d = one.build()
        pack_views(d, ('EXT_meshopt_compression', 'KHR_meshopt_compression')[number % 2], number % 3 == 0, number % 3 == 2)
        d.write('packed', binary=number % 5 < 2)


# ---- what must be ----

def unpack_rows(data, count, width):
    """The vertex codec, version 0."""
    out, at, last = [bytearray(width) for _ in range(count)], 1, bytearray(data[-width:])
    most = min(256, 8192 // width // 16 * 16)
    for first in range(0, count, most):
        n = min(most, count - first)
        for k in range(width):
            groups = (n + 15) // 16
            head, at = data[at:], at + (groups + 3) // 4
            for group in range(groups):
                bits = (0, 2, 4, 8)[head[group // 4] >> group % 4 * 2 & 3]
                values = [int.from_bytes(data[at:at + 2 * bits], 'big') >> (15 - i) * bits & (1 << bits) - 1 for i in range(16)]
                at += 2 * bits
                for i, v in enumerate(values):
                    if bits in (2, 4) and v == (1 << bits) - 1:
                        v, at = data[at], at + 1
                    if group * 16 + i < n:
                        last[k] = last[k] + (v >> 1 ^ -(v & 1)) & 255
                        out[first + group * 16 + i][k] = last[k]
    return b''.join(out)


def unpack_indices(data, count, width):
    """Both codecs of indices."""
    numbers, at = [], 1 + count // 3 * (data[0] >> 4 == 14)

    def varint():
        nonlocal at
        v = shift = 0
        while True:
            v, shift, at = v | (data[at] & 127) << shift, shift + 7, at + 1
            if data[at - 1] < 128:
                return v
    signed = lambda v: v >> 1 ^ -(v & 1)
    if data[0] >> 4 == 13:
        last = [0, 0]
        for _ in range(count):
            v = varint()
            last[v & 1] += signed(v >> 1)
            numbers.append(last[v & 1])
        return b''.join(x.to_bytes(width, 'little') for x in numbers)
    edges, vertices, following, last, table = [(0, 0)] * 16, [0] * 16, 0, 0, data[-16:]
    steps = 13 if data[0] & 15 else 15

    def explicit():
        nonlocal last
        last += signed(varint())
        return last

    def fresh(keep):
        nonlocal following
        following += 1
        keep(following - 1)
        return following - 1
    seen = lambda v: vertices.insert(0, v)
    for code in data[1:1 + count // 3]:
        if code < 0xF0:
            a, b = edges[code >> 4]
            low = code & 15
            if low < steps:
                c = vertices[low] if low else fresh(seen)
            else:
                if low == 15:
                    c = explicit()
                else:
                    last += 1 if low == 14 else -1
                    c = last
                seen(c)
            edges[:0] = [(a, c), (c, b)]
        else:
            aux = table[code & 15] if code < 0xFE else data[at]
            at += code >= 0xFE
            if code >= 0xFE and aux == 0:
                following = 0
            keep = lambda v: None
            a = explicit() if code == 0xFF else fresh(keep)
            b, c = aux >> 4, aux & 15
            old = list(vertices)
            b = fresh(keep) if b == 0 else explicit() if b == 15 else old[b - 1]
            c = fresh(keep) if c == 0 else explicit() if c == 15 else old[c - 1]
            seen(a)
            if aux >> 4 in (0, 15):
                seen(b)
            if aux & 15 in (0, 15):
                seen(c)
            edges[:0] = [(a, c), (c, b), (b, a)]
        numbers += [a, b, c]
    return b''.join(x.to_bytes(width, 'little') for x in numbers)


def unfilter(data, filter_, width):
    """Octahedral vectors, and floats of 24 bits and an exponent."""
    part = 8 if (filter_, width) == ('OCTAHEDRAL', 8) else 4
    code, most = ('<4h', 32767) if part == 8 else ('<4b', 127)
    rows = [data[i:i + part] for i in range(0, len(data), part)]
    if filter_ == 'EXPONENTIAL':
        value = lambda v: ((v & 0xFFFFFF) - ((v & 0x800000) << 1)) * 2.0 ** ((v >> 24) - ((v >> 31) << 8))
        return b''.join(struct.pack('<f', value(int.from_bytes(r, 'little'))) for r in rows)
    out = []
    for r in rows:
        x, y, one, w = struct.unpack(code, r)
        z = one - abs(x) - abs(y)
        t = max(-z, 0)
        x, y = x - (t if x >= 0 else -t), y - (t if y >= 0 else -t)
        scale = most / math.sqrt(x * x + y * y + z * z)
        out.append(struct.pack(code, *(round(c * scale) for c in (x, y, z)), w))
    return b''.join(out)


class File(lossless.File):
    """Views that meshoptimizer compressed have the bytes that a decoder gives."""

    def view(self, i):
        packed = next((e for n, e in self.g['bufferViews'][i].get('extensions', {}).items() if 'meshopt' in n), None)
        if not packed:
            return super().view(i)
        if ('view', i) not in self.cache:
            at, count, width = packed.get('byteOffset', 0), packed['count'], packed['byteStride']
            data = self.buffer(packed['buffer'])[at:at + packed['byteLength']]
            data = (unpack_rows if packed['mode'] == 'ATTRIBUTES' else unpack_indices)(data, count, width)
            if packed.get('filter', 'NONE') != 'NONE':
                data = unfilter(data, packed['filter'], width)
            self.cache['view', i] = data
        return self.cache['view', i]

    def buffer(self, i):
        if self.g['buffers'][i].get('uri') is None and 'extensions' in self.g['buffers'][i]:
            return bytes(self.g['buffers'][i]['byteLength'])
        return super().buffer(i)


# Sets of options: the folder of the inputs, the options, one input in how many, and words that names have.
SETS = {
    'replace': ('in', '--only=all --existing=replace', 1),
    'default': ('in', '--verify', 3),
    'keep': ('in', '--only=all', 3),
    'repair': ('in', '--only=all --existing=repair --buffers=embed --verify', 3),
    'smooth': ('in', '--only=all --existing=replace --normals=smooth', 1, ['normals_missing']),
    'smooth-draco': ('in', '--only=all --existing=replace --normals=smooth --draco=sequential', 1, ['normals_missing']),
    'smooth-weld': ('in', '--only=all --existing=replace --normals=smooth --weld', 1, ['normals_missing']),
    'glb': ('in', '--only=all --existing=replace --output-format=glb --bitangents', 3),
    'short': ('in', '--only=all --existing=replace --precision=short --verify', 3),
    'byte': ('in', '--existing=replace --precision=byte --verify', 3),
    'float': ('in', '--only=all --existing=replace --precision=float --morph=keep', 3),
    # points lie between tangents, and who they belong to is not asked
    'again': ('replace', '--only=all --existing=replace', 1, ['!points']),
    'weld': ('in', '--only=all --existing=replace --weld --bitangents --verify', 3),
    'weld-loose': ('in', '--only=all --existing=replace --weld', 1, ['loose_soup', 'loose_morphs']),
    'weld-left': ('in', '--weld --images=copy', 1, ['soup']),
    'no-morphs': ('in', '--only=all --existing=replace --morph=drop --images=embed', 1, ['morphs', 'many']),
    'across': ('in', '--only=all --existing=replace --across=mesh', 3),
    'across-draco': ('in', '--only=all --existing=replace --across=mesh --draco=sequential', 3),
    'drop': ('in', '--existing=drop --images=link --buffers=copy', 1, ['needless', 'same_', 'soup_left']),
    'drop-weld': ('in', '--existing=drop --weld', 1, ['soup']),
    'meshopt': ('packed', '--only=all --existing=replace', 1),
    'meshopt-off': ('packed', '--only=all --existing=replace --meshopt=off', 3),
    'meshopt-short': ('packed', '--only=all --existing=replace --precision=short', 3),
    'meshopt-float': ('packed', '--only=all --existing=replace --precision=float', 3),
    'meshopt-weld': ('packed', '--only=all --existing=replace --weld', 3),
    'draco': ('in', '--only=all --existing=replace --draco=sequential --verify', 1),
    'draco-again': ('draco', '--only=all --existing=replace --verify', 3),
    'block-keep': ('block', '--only=all --existing=replace', 1),
    'block-off': ('block', '--only=all --existing=replace --draco=off', 1),
    'draco-off': ('draco', '--only=all --existing=replace --draco=off', 3),
    'edgebreaker': ('in', '--only=all --existing=replace --draco=edgebreaker --verify', 3),
    'glb-again': ('glb', '--only=all --existing=replace --output-format=glb --bitangents', 1, ['!points', 'alone', 'two', 'soup', 'ranges', 'modes', 'same', 'many', 'other']),
}


def components(f, accessor):
    """Rows of numbers, normalized ones as they are meant."""
    a = f.g['accessors'][accessor]
    high = {'MAT2': 2, 'MAT3': 3}.get(a['type'], lossless.WIDTHS[a['type']])
    code, step = '<%d%s' % (high, CODES[a['componentType']]), f.element(a) * high // lossless.WIDTHS[a['type']]
    rows = [sum([struct.unpack_from(code, row, at) for at in range(0, len(row), step)], ()) for row in f.rows(accessor)]
    if a.get('normalized'):
        rows = [tuple(max(x / UNIT[a['componentType']], -1) for x in row) for row in rows]
    return rows


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def frames(chain, p, n, t):
    """The tangent of each corner: all triangles of one orientation around a vertex are in one plane."""
    out = []
    for at in range(0, len(chain) - 2, 3):
        v = chain[at:at + 3]
        e, f = minus(p[v[1]], p[v[0]]), minus(p[v[2]], p[v[0]])
        (s1, t1), (s2, t2) = minus(t[v[1]], t[v[0]]), minus(t[v[2]], t[v[0]])
        area = s1 * t2 - s2 * t1
        along = [(t2 * x - t1 * y) / area for x, y in zip(e, f)]
        down = [(s1 * y - s2 * x) / area for x, y in zip(e, f)]
        for corner in v:
            normal = unit(n[corner])
            tangent = unit(minus(along, [dot(along, normal) * x for x in normal]))
            out.append((*tangent, -1.0 if dot(cross(normal, tangent), down) > 0 else 1.0))
    return out


def values_of(a, p):
    """Positions, normals and texture coordinates, as the material's normal texture takes them."""
    map_ = a.g['materials'][p['material']].get('normalTexture', {})
    rows = {n: components(a, i) for n, i in p['attributes'].items() if n in ('POSITION', 'NORMAL') or n[:8] == 'TEXCOORD'}
    scale = map_.get('extensions', {}).get('KHR_texture_transform', {}).get('scale', [1, 1])
    texcoords = [(u * scale[0], v * scale[1]) for u, v in rows['TEXCOORD_%d' % map_.get('texCoord', 0)]]
    if 'NORMAL' not in rows:  # all of a primitive is in one plane
        chain, positions = a.corners(p), rows['POSITION']
        x, y, z = (positions[v] for v in chain[:3])
        rows['NORMAL'] = [unit(cross(minus(y, x), minus(z, x)))] * len(positions)
    return [rows['POSITION'], rows['NORMAL'], texcoords]


def solved(a, p, options):
    """Whether a primitive of the input gets tangents."""
    has = p['attributes'].get('TANGENT')
    if p.get('mode', 4) < 4 or 'TEXCOORD_0' not in p['attributes'] or (p.get('material') == 1 and '--only=all' not in options) or (
            'NORMAL' not in p['attributes'] and '--normals' not in options):
        return False
    return has is None or '--existing=replace' in options


def differ(x, y, tolerance):
    return len(x) != len(y) or any(abs(a - b) > tolerance for a, b in zip(x, y))


def check_tangents(a, b, m, k, options, fault, compressed):
    p, q = a.g['meshes'][m]['primitives'][k], b.g['meshes'][m]['primitives'][k]
    where = 'mesh %d primitive %d: ' % (m, k)
    old, chain = a.corners(p), lossless.turned(a, b, p, q)
    repaired = '--existing=repair' in options and 'TANGENT' in p['attributes'] and 'NORMAL' in p['attributes'] and p.get('mode', 4) > 3
    if not solved(a, p, options) and not repaired:
        if ('TANGENT' in p['attributes']) != ('TANGENT' in q['attributes']) and not ('=drop' in options and p.get('material') == 1):
            fault(where + 'TANGENT appears or goes')
        elif 'TANGENT' in q['attributes']:
            x, y = a.rows(p['attributes']['TANGENT']), b.rows(q['attributes']['TANGENT'])
            if [x[i] for i in old] != [y[i] for i in chain]:
                fault(where + 'tangents that stay have other values')
        return
    if 'TANGENT' not in q['attributes']:
        fault(where + 'no tangents')
        return
    accessor = b.g['accessors'][q['attributes']['TANGENT']]
    tolerance = {FLOAT: 1e-6, SHORT: 1e-4, BYTE: 1e-2}[accessor['componentType']]
    if a.g['accessors'][p['attributes']['TEXCOORD_0']]['componentType'] != FLOAT:
        tolerance = max(tolerance, 1e-4)
    want = SHORT if '=short' in options else BYTE if '=byte' in options else FLOAT
    before = p['attributes'].get('TANGENT')
    if want == FLOAT and '=float' not in options and before is not None:
        want = a.g['accessors'][before]['componentType']
    if compressed and '--precision' not in options:
        want = accessor['componentType']  # perhaps that of the normals
    if accessor['componentType'] != want or accessor.get('normalized', False) != (want != FLOAT):
        fault(where + 'tangents of type %d, expected %d' % (accessor['componentType'], want))
    old, chain = old[:len(old) // 3 * 3], chain[:len(chain) // 3 * 3]
    values = values_of(a, p)
    expected = frames(old, *values)
    if 'NORMAL' not in p['attributes']:
        normals = components(b, q['attributes']['NORMAL'])
        if any(differ(normals[v], values[1][0], 1e-6 + tolerance) for v in chain):
            fault(where + 'normals are not those of its plane')
    found = components(b, q['attributes']['TANGENT'])
    wrong = [i for i, v in enumerate(chain) if differ(found[v], expected[i], tolerance)]
    if wrong:
        fault(where + 'corner %d has tangent %s, expected %s' % (wrong[0], found[chain[wrong[0]]], expected[wrong[0]]))
    if '--bitangents' in options:
        bitangents, normals = components(b, q['attributes']['_BITANGENT']), components(b, q['attributes']['NORMAL'])
        for v in chain:
            if differ(bitangents[v], [found[v][3] * x for x in cross(unit(normals[v]), found[v])], 1e-5 + tolerance):
                fault(where + 'bitangent %s of vertex %d' % (bitangents[v], v))
                break
    for number, target in enumerate(p.get('targets', [])):
        deltas = q['targets'][number].get('TANGENT')
        moves = [name for name in ('POSITION', 'NORMAL') if name in target]
        if bool(moves) and '--morph' not in options and deltas is None or deltas is not None and (not moves or '--morph' in options):
            fault(where + 'target %d: TANGENT is %s' % (number, deltas))
            continue
        if deltas is None:
            continue
        moved = list(values)
        for i, name in enumerate(('POSITION', 'NORMAL')):
            if name in moves:
                moved[i] = [[x + y for x, y in zip(*rows)] for rows in zip(values[i], components(a, target[name]))]
        rows, expected = components(b, deltas), frames(old, *moved)
        least = max(tolerance, {FLOAT: 1e-6, SHORT: 1e-4, BYTE: 1e-2}[b.g['accessors'][deltas]['componentType']])
        for i, v in enumerate(chain):
            sum_ = [x + y for x, y in zip(found[v], rows[v])]
            if differ(sum_, expected[i][:3], 2 * least):
                fault(where + 'target %d: corner %d comes to %s, expected %s' % (number, i, sum_, expected[i]))
                break


def place(f, number):
    a = f.g['accessors'][number]
    sparse = json.dumps(a.get('sparse'))
    return (a.get('bufferView'), a.get('byteOffset', 0), sparse) if 'bufferView' in a or 'sparse' in a else number


def pools_of(f):
    """Primitives that share accessors, or others over the same bytes: lists of (mesh, primitive)."""
    pools = []
    for m, mesh in enumerate(f.g['meshes']):
        for k, p in enumerate(mesh['primitives']):
            own = {place(f, i) for o in [p['attributes']] + p.get('targets', []) for i in o.values()}
            users = [(m, k)]
            for other in [x for x in pools if x[0] & own]:
                own |= other[0]
                users = other[1] + users
                pools.remove(other)
            pools.append((own, users))
    return [users for _, users in pools]


def check_counts(a, b, options, fault):
    """A vertex is there as often as one primitive needs it with other tangents; primitives of the same positions, normals
    and texture coordinates have one TANGENT."""
    if '--weld' in options and not any(word in b.path for word in ('loose', 'animated', 'placed', 'elsewhere')):
        lossless.no_equal_vertices(b)
    if '--weld' in options or '--across' in options or 'repair' in options:
        return
    for users in pools_of(a):
        needs, count = {}, 0
        for m, k in users:
            p, q = a.g['meshes'][m]['primitives'][k], b.g['meshes'][m]['primitives'][k]
            old, new = a.corners(p), lossless.turned(a, b, p, q)
            count = a.g['accessors'][p['attributes']['POSITION']]['count']
            if not solved(a, p, options):
                continue
            key = tuple(place(a, i) if 'sparse' not in a.g['accessors'][i] else i for i in
                        [p['attributes'][n] for n in ('POSITION', 'NORMAL', 'TEXCOORD_0') if n in p['attributes']]) + (p['material'] > 1 and p['material'],)
            rows = b.rows(q['attributes']['TANGENT'])
            vertices = needs.setdefault(key, {})
            for x, y in zip(old, new):
                vertices.setdefault(x, set()).add(rows[y])
        most = count + sum(max([len(needs[key].get(v, ())) for key in needs] + [1]) - 1 for v in range(count))
        for m, k in users:
            p, q = a.g['meshes'][m]['primitives'][k], b.g['meshes'][m]['primitives'][k]
            got = b.g['accessors'][q['attributes']['POSITION']]['count']
            if got != most and not (got == count and not solved(a, p, options)):
                fault('mesh %d primitive %d has %d vertices, expected %d' % (m, k, got, most))


def check_bytes(f, fault):
    """Tells faults that the specification forbids; gives the number of bytes that nobody uses, and accessors that no primitive has."""
    g, used = f.g, [set() for _ in f.g.get('buffers', [])]
    views = g.get('bufferViews', [])
    for number, buffer in enumerate(g.get('buffers', [])):
        if len(f.buffer(number)) < buffer['byteLength'] or ('uri' not in buffer and len(f.buffer(number)) - buffer['byteLength'] > 3):
            fault('buffer %d has %d bytes of %d' % (number, len(f.buffer(number)), buffer['byteLength']))
    for i, v in enumerate(views):
        if v.get('byteOffset', 0) + v['byteLength'] > g['buffers'][v['buffer']]['byteLength'] or v['byteLength'] < 1:
            fault('view %d has bytes %s' % (i, v))
    primitives = [p for mesh in g['meshes'] for p in mesh['primitives']]
    vertex = {i for p in primitives for o in [p['attributes']] + p.get('targets', []) for i in o.values()}
    index = {p['indices'] for p in primitives if 'indices' in p}
    others = {x for animation in g.get('animations', []) for s in animation['samplers'] for x in (s['input'], s['output'])}
    others |= {x for n in g.get('nodes', []) for e in n.get('extensions', {}).values() for x in e['attributes'].values()}
    strides = {}

    def mark(view, offset, count, size, step, unit_, what):
        v = views[view]
        begin = v.get('byteOffset', 0) + offset
        end = begin + (count - 1) * step + size
        if end > v.get('byteOffset', 0) + v['byteLength'] or begin % unit_ or offset % unit_:
            fault('%s lies at %d to %d of view %s' % (what, offset, offset + end - begin, v))
        used[v['buffer']].update(range(begin, end))
        strides.setdefault(view, set()).add(what)
    for i, a in enumerate(g.get('accessors', [])):
        size, part = f.element(a), SIZES[a['componentType']]
        if 'bufferView' in a:
            step = views[a['bufferView']].get('byteStride', size)
            if step % part or (i in vertex and (step % 4 or a.get('byteOffset', 0) % 4)) or step < size:
                fault('accessor %d: elements of %d bytes, %d apart at %d' % (i, size, step, a.get('byteOffset', 0)))
            mark(a['bufferView'], a.get('byteOffset', 0), a['count'], size, step, part, 'accessor %d' % i)
        for name, width in ('indices', None), ('values', size):
            if 'sparse' in a:
                s = a['sparse'][name]
                width = width or SIZES[s['componentType']]
                mark(s['bufferView'], s.get('byteOffset', 0), a['sparse']['count'], width, width, SIZES[s['componentType']] if
                     name == 'indices' else part, 'sparse %s of accessor %d' % (name, i))
                if 'byteStride' in views[s['bufferView']] or 'target' in views[s['bufferView']]:
                    fault('accessor %d: sparse %s in a view of vertices' % (i, name))
        if 'min' in a and 'bufferView' in a:
            rows = list(zip(*[struct.unpack('<%d%s' % (lossless.WIDTHS[a['type']], CODES[a['componentType']]), r) for r in f.rows(i)]))
            if [min(r) for r in rows] != a['min'] or [max(r) for r in rows] != a['max']:
                fault('accessor %d: bounds %s %s' % (i, a['min'], a['max']))
        if i in vertex and i in index:
            fault('accessor %d has vertices and indices' % i)
    for image in g.get('images', []):
        if 'bufferView' in image:
            strides.setdefault(image['bufferView'], set())
            view = views[image['bufferView']]
            used[view['buffer']].update(range(view.get('byteOffset', 0), view.get('byteOffset', 0) + view['byteLength']))
    for i, v in enumerate(views):
        if i not in strides:
            used[v['buffer']].update(range(v.get('byteOffset', 0), v.get('byteOffset', 0) + v['byteLength']))
    dead = sum(buffer['byteLength'] - len(bytes_) for buffer, bytes_ in zip(g.get('buffers', []), used))
    return dead, {i for i in range(len(g.get('accessors', []))) if i not in vertex | index | others}


def image_of(f):
    """The bytes of the one image."""
    image = f.g['images'][0]
    if 'bufferView' in image:
        return f.view(image['bufferView'])
    if image['uri'][:5] == 'data:':
        return base64.b64decode(image['uri'].split(',')[1])
    with open(os.path.join(os.path.dirname(f.path), unquote(image['uri'])), 'rb') as file:
        return file.read()


def check_image(b, options, fault):
    image = b.g['images'][0]
    if image_of(b) != PIXEL or 'bufferView' in image and image.get('mimeType') != 'image/png':
        fault('the image is another: %s' % image)
    where = 'embed' if 'bufferView' in image or image['uri'][:5] == 'data:' else 'link' if '/' in image['uri'] else 'copy'
    if '--images' in options and '--images=' + where not in options and where != 'embed':
        fault('the image is at %s' % image)


def check(options, before, after, fault, compressed=''):
    """compressed: the input as meshoptimizer packed it."""
    a, b = File(before), File(after)
    lossless.complaints = []
    lossless.complain.__globals__['complaints'] = lossless.complaints
    if '--precision' in options and '=float' not in options and any(
            solved(a, p, options) for mesh in a.g['meshes'] for p in mesh['primitives']):
        for key in ('extensionsUsed', 'extensionsRequired'):
            if 'KHR_mesh_quantization' not in b.g.get(key, []):
                fault('KHR_mesh_quantization is not in ' + key)
            elif 'KHR_mesh_quantization' not in a.g.get(key, []):
                b.g[key].remove('KHR_mesh_quantization')
                if not b.g[key]:
                    del b.g[key]
    if not compressed and not any(word in options for word in ('--morph=drop', 'repair', '--existing=drop', '--normals')):
        lossless.Own.find(a.g)
        lossless.same_json(a.g, b.g)
    lossless.same_geometry(a, b)
    lossless.same_views(a, b)
    check_counts(a, b, options, fault)
    places = [place(a, i) for i in range(len(a.g['accessors']))]
    numbers = [p.get('indices') for mesh in a.g['meshes'] for p in mesh['primitives']]
    shared = ['/accessors/%d/sparse is gone' % i for i, x in enumerate(places) if places.count(x) > 1 or i in numbers]
    # views that were emptied have other content
    emptied = ['/bufferViews/%d/' % v for v in range(len(a.g['bufferViews'])) if all(
        x.get('bufferView') != v or y.get('bufferView') != v or x['count'] != y['count']
        for x, y in zip(a.g['accessors'], b.g['accessors']))]
    for text in lossless.complaints:
        # elements that others have, too, are baked
        if text not in shared and 'keys in another order' not in text and not text.startswith(tuple(emptied)):
            fault(text)
    for m, mesh in enumerate(a.g['meshes']):
        for k in range(len(mesh['primitives'])):
            check_tangents(a, b, m, k, options, fault, compressed)
    check_image(b, options, fault)
    packs = {n for v in b.g['bufferViews'] for n in v.get('extensions', {})}
    packed = {n for v in File(compressed).g['bufferViews'] for n in v.get('extensions', {})} if compressed else ()
    for name in b.g.get('extensionsRequired', []):
        if 'meshopt' in name and name not in packs and packed:
            fault('%s is required and nothing has it' % name)
    if compressed:
        return
    dead, loose = check_bytes(a, lambda text: None)
    for i in loose:
        if a.rows(i) != b.rows(i):
            fault('accessor %d of nobody has other values' % i)
    dead_now, loose_now = check_bytes(b, fault)
    # what lies between attributes of others cannot go, nor what shares a view with their bytes
    if dead_now > dead + (3 + 12 * ('--precision' in options)) * len(b.g.get('bufferViews', [])) and not any(
            word in before for word in ('together', 'tight', 'part_elsewhere')) and '=drop' not in options:
        fault('%d bytes that nobody uses, there were %d' % (dead_now, dead))
    # of several accessors over some of the same bytes one may be left, and one that was the TANGENT of what is solved with others
    views = [x.get('bufferView') for x in a.g['accessors']]
    places = [place(a, i) if 'target' not in a.g['bufferViews'][view or 0] else view for i, view in enumerate(views)]
    tangents = [p['attributes'].get('TANGENT') for mesh in a.g['meshes'] for p in mesh['primitives']]
    for i in sorted(loose_now - loose):
        left = i in tangents and ('--across' in options or '--existing=drop' in options)
        if i >= len(places) or places.count(places[i]) == 1 and not left:
            fault('nobody uses accessor %d' % i)


def check_draco(options, before, after, fault):
    """Corners of triangles, whatever their order, within the steps of the block's grid."""
    a, b = File(before), File(after)
    for m, mesh in enumerate(a.g['meshes']):
        for k, p in enumerate(mesh['primitives']):
            q = b.g['meshes'][m]['primitives'][k]
            if p.get('mode', 4) < 4 or not solved(a, p, options):
                continue
            old, new = (chain[:len(chain) // 3 * 3] for chain in (a.corners(p), b.corners(q)))
            names = [n for n in p['attributes'] if n not in ('TANGENT', '_OTHER')]
            values = values_of(a, p)
            rows = [(components(a, p['attributes'][n]), components(b, q['attributes'][n])) for n in names]
            found = components(b, q['attributes']['TANGENT'])
            both = []
            for side, chain, tangents in (0, old, frames(old, *values)), (1, new, [found[v] for v in new]):
                corner = [sum([tuple(round(x, 2) + 0 for x in r[side][v]) for r in rows], ()) + tuple(round(x, 1) + 0 for x in t)
                          for v, t in zip(chain, tangents)]
                triangles = [corner[i:i + 3] for i in range(0, len(corner), 3)]
                both.append(sorted(min(t, t[1:] + t[:1], t[2:] + t[:2]) for t in triangles))
            if both[0] != both[1]:
                at = [x != y for x, y in zip(*both)].index(True) if len(both[0]) == len(both[1]) else 0
                fault('mesh %d primitive %d: triangle %s, expected %s' % (m, k, both[1][at], both[0][at]))


def sharing_of(stem):
    return [x for x in stem.split('-') if x in [sharing.__name__ for sharing in SHARING]]


def share_blocks():
    """Blocks of the set "draco" that two primitives have, or whose accessors a plain one has, too; and the same without blocks."""
    os.makedirs('block', exist_ok=True)
    os.makedirs('block-plain', exist_ok=True)
    for stem, path in names_of('draco').items():
        if sharing_of(stem)[0] not in ('alone', 'many', 'other_set', 'morphs') or 'quantized' in stem:
            continue
        for source, folder in (path, 'block'), (names_of('draco-plain')[stem], 'block-plain'):
            f = File(source)
            p = f.g['meshes'][0]['primitives'][0]
            # a texture transform turns the second one's tangents over
            f.g['meshes'][0]['primitives'].append({**json.loads(json.dumps(p)), 'material': 3})
            for number, buffer in enumerate(f.g['buffers']):
                uri = 'data:application/octet-stream;base64,' + base64.b64encode(f.buffer(number)[:buffer['byteLength']]).decode()
                buffer['uri'] = uri
                buffer.pop('extras', None)
            with open('%s/%s.gltf' % (folder, stem), 'w', encoding='utf-8') as file:
                json.dump(f.g, file)


def names_of(folder):
    """The glTF files of a folder without their endings."""
    names = os.listdir(folder) if os.path.isdir(folder) else []
    return {os.path.splitext(x)[0]: os.path.join(folder, x) for x in names if x.endswith(('.gltf', '.glb'))}


def convert(name, program, stride):
    """Converts the inputs of a set's turn and says what is wrong."""
    number, (source, options, share, *words) = list(SETS).index(name), SETS[name]
    if name == 'block-keep':
        share_blocks()
    files = names_of(source)
    stems = [stem for i, stem in enumerate(sorted(files)) if (i + number) % (share * stride) == 0]
    words = sum(words, [])
    wanted, unwanted = [word for word in words if word[0] != '!'], [word[1:] for word in words if word[0] == '!']
    files = [files[stem] for stem in stems if any(word in stem for word in wanted or ['']) and not any(word in stem for word in unwanted)]
    if not files:
        return [] if stride > 1 else ['no file has what is asked for']

    def run(options, folder, files):
        done = subprocess.run([program, *options.split(), '-d', folder, *files], stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        refused = [line for line in done.stderr.split('\n') if 'NOT_VERIFIED' in line]
        return refused if done.returncode == 0 else ['exit code %d: %s' % (done.returncode, done.stderr[-600:])]
    said = run(options, name, files)
    outputs = names_of(name)
    with open('pairs', 'a', encoding='utf-8') as file:
        for i, x in enumerate(files):
            stem = os.path.splitext(os.path.basename(x))[0]
            if stem in outputs and i % 2 == 0:
                file.write('%s\t%s\n' % (os.path.abspath(outputs[stem]), os.path.abspath(x)))
    # blocks are judged when they are plain again
    draco = 'draco' in options + source or source == 'block'
    packed = outputs
    if draco and outputs:
        said += run('--only=all --existing=repair --draco=off', name + '-plain', outputs.values())
        outputs = names_of(name + '-plain')
    for x in files:
        stem = os.path.splitext(os.path.basename(x))[0]
        found = []
        try:
            if stem not in outputs:
                found.append('there is no output')
            elif source in ('replace', 'glb'):
                with open(x, 'rb') as old, open(outputs[stem], 'rb') as new:
                    if old.read() != new.read():
                        found.append('a second run changes it')
            elif draco:
                twin = 'block-plain' if source == 'block' else 'in'
                check_draco(options, names_of(twin)[stem], outputs[stem], found.append)
                plain = not any(word in stem for word in ('sparse', 'bare', 'shorts', 'elsewhere', 'quantized'))
                if all(x in ('alone', 'two', 'soup', 'morphs', 'many') for x in sharing_of(stem)) and plain and source != 'block' and (
                        'KHR_draco_mesh_compression' in File(packed[stem]).g['extensionsUsed']) == ('=off' in options):
                    found.append('it is plain' if '=off' not in options else 'it is compressed')
            else:
                check(options, x if source == 'in' else 'plain/%s.gltf' % stem, outputs[stem], found.append, x if source == 'packed' else '')
        except (IndexError, KeyError, ValueError, struct.error) as error:
            found.append('cannot be read: %r' % error)
        said += ['%s: %s' % (stem, text[:300]) for text in found[:2]]
    return said


if __name__ == '__main__':
    if sys.argv[1] == 'make':
        make(*map(int, sys.argv[2:]))
    elif sys.argv[1] == 'sets':
        for name, (_, options, *_) in SETS.items():
            print(name, options)
    else:
        faults = convert(sys.argv[2], sys.argv[3], int(sys.argv[4]))
        print('\n'.join(faults[:20]))
        sys.exit(1 if faults else 0)

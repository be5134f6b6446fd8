#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""inputs.py NAME COUNT FILE [SIDE]: an input that has COUNT of something, for tests of what it costs.

NAME is a function below or a row of inputs.tsv, FILE the folder and the name; what belongs to an input is beside it, by a name
that begins as its own does, or one that is the same for every COUNT. SIDE is the size of a grid or an image. tests/soak/counts.py
runs all of them, with the sets of options that stand beside each.
"""
import base64
import json
import math
import os
import random
import shutil
import struct
import subprocess
import sys
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
JPEG = HERE + '/../../data/colour.jpg'
MOST = 100000
nmtan = os.environ.get('NMTAN')
quantities = {}
folder, base, side = '.', 'a', 0


def quantity(*options, most=MOST, code=None):
    """The option sets; IN and OUT stand for the files. most: of what grows by its square, or has a limit of its own. code:
    how inputs are refused."""
    def add(make):
        quantities[make.__name__] = (make, options or PLAIN, most, code)
        return make
    return add


PLAIN = ('IN OUT.glb', '--check --report=r.json IN')
MESHES = PLAIN + ('--check --report=r.html IN', '--only=all --existing=replace --verify IN OUT.glb',
                  '--only=all --across=mesh --normals=replace-smooth IN OUT.gltf', '--only=all IN OUT.ply',
                  '--check --report=r.csv --baseline=b.json IN')
IMAGES = ('IN OUT.gltf', '--images=embed IN OUT.glb', '--images=copy IN out/o.gltf', '--buffers=embed --images=embed IN OUT.gltf',
          '--depfile=d --manifest=m --update IN OUT.glb', '--flip-green=on IN OUT.glb', '--check --check-maps=on IN')


def save(name, data):
    """A file in the folder; ".png" is the input's name with that ending."""
    path = '%s/%s' % (folder, base + name if name.startswith('.') else name)
    with open(path, 'wb') as out:
        out.write(data.encode() if isinstance(data, str) else data)
    return path


# ---- glTF ----

TRIANGLE = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack('<9f', *(0, 0, 1) * 3) + struct.pack(
    '<6f', 0, 0, 1, 0, 0, 1) + struct.pack('<3H', 0, 1, 2) + b'\0\0'
VIEWS = [(0, 36), (36, 36), (72, 24), (96, 6)]


def document():
    return {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 3,
                                    'material': 0}]}],
        'materials': [{'normalTexture': {'index': 0}}], 'textures': [{'source': 0}],
        'images': [{'uri': 'data:image/png;base64,' + base64.b64encode(png(1, 1)).decode()}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 0]},
                      {'bufferView': 1, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},
                      {'bufferView': 2, 'componentType': 5126, 'count': 3, 'type': 'VEC2'},
                      {'bufferView': 3, 'componentType': 5123, 'count': 3, 'type': 'SCALAR'}],
        'bufferViews': [{'buffer': 0, 'byteOffset': a, 'byteLength': b} for a, b in VIEWS],
        'buffers': [{'byteLength': len(TRIANGLE)}]}


def glb(doc, binary=TRIANGLE):
    binary += b'\0' * (-len(binary) % 4)
    doc['buffers'][0]['byteLength'] = len(binary)
    text = json.dumps(doc, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    return save('.glb', struct.pack('<4sIIII', b'glTF', 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text +
                struct.pack('<II', len(binary), 0x004E4942) + binary)


def gltf(doc, binary=TRIANGLE):
    doc['buffers'][0] |= {'uri': base + '.bin', 'byteLength': len(binary)}
    save('.bin', binary)
    return save('.gltf', json.dumps(doc))


def grid(doc, side, fold=3, form='I'):
    """One primitive's arrays become a grid of side squared quads, whose texture turns back at each fold; returns the buffer."""
    width = side + 1
    rows = [(x, y) for y in range(width) for x in range(width)]
    cells = [(y * width + x) for y in range(side) for x in range(side)]
    arrays = [b''.join(struct.pack('<3f', x, y, 0) for x, y in rows), struct.pack('<3f', 0, 0, 1) * len(rows),
              b''.join(struct.pack('<2f', abs((x + fold) % (2 * fold) - fold), y) for x, y in rows),
              b''.join(struct.pack('<6' + form, a, a + 1, a + width, a + 1, a + width + 1, a + width) for a in cells)]
    offset = 0
    for k, array in enumerate(arrays):
        doc['bufferViews'][k] |= {'byteOffset': offset, 'byteLength': len(array)}
        doc['accessors'][k]['count'] = 6 * len(cells) if k == 3 else len(rows)
        offset += len(array)
    doc['accessors'][3]['componentType'] = 5125 if form == 'I' else 5123
    doc['accessors'][0] |= {'max': [side, side, 0]}
    return b''.join(arrays)


def of_materials(doc, n):
    """n primitives, each with a material of its own."""
    one = doc['meshes'][0]['primitives'][0]
    doc['meshes'][0]['primitives'] = [dict(one, material=i) for i in range(n)]


def of_textures(doc, images):
    """A texture and a material for each image."""
    doc |= {'images': images, 'textures': [{'source': i} for i in range(len(images))],
            'materials': [{'normalTexture': {'index': i}} for i in range(len(images))]}
    return doc


@quantity(*MESHES)
def gltf_everything_of_its_own(n):
    doc = document()
    one, views, accessors = doc['meshes'][0]['primitives'][0], doc['bufferViews'], doc['accessors']
    doc['bufferViews'] = [dict(v, byteOffset=v['byteOffset'] + len(TRIANGLE) * i) for i in range(n) for v in views]
    doc['accessors'] = [dict(a, bufferView=a['bufferView'] + 4 * i) for i in range(n) for a in accessors]
    doc['meshes'] = [{'primitives': [dict(one, attributes={'POSITION': 4 * i, 'NORMAL': 4 * i + 1, 'TEXCOORD_0': 4 * i + 2},
                                          indices=4 * i + 3)]} for i in range(n)]
    doc['nodes'] = [{'mesh': i} for i in range(n)]
    return glb(doc, TRIANGLE * n)


@quantity(*MESHES, most=10000)
def gltf_grids(n):
    """Small grids of their own, ten in a mesh, of 50 materials."""
    doc, binary = document(), b''
    doc |= {'accessors': [], 'bufferViews': [], 'materials': doc['materials'] * 50, 'meshes': []}
    parts = []
    for i in range(n):
        part = document()
        arrays = grid(part, side or 3, 4, 'H')
        parts.append(struct.pack('<3f', 0, 0, i / n) + arrays[12:])
        part['accessors'][0]['max'][2] = i / n
        doc['bufferViews'] += [dict(v, byteOffset=v['byteOffset'] + i * len(arrays)) for v in part['bufferViews']]
        doc['accessors'] += [dict(a, bufferView=4 * i + k) for k, a in enumerate(part['accessors'])]
        doc['meshes'] += [{'primitives': []}] if i % 10 == 0 else []
        doc['meshes'][-1]['primitives'].append({'attributes': {'POSITION': 4 * i, 'NORMAL': 4 * i + 1, 'TEXCOORD_0': 4 * i + 2},
                                                'indices': 4 * i + 3, 'material': i % 50})
    doc['nodes'] = [{'mesh': i} for i in range(len(doc['meshes']))]
    doc['scenes'] = [{'nodes': list(range(len(doc['meshes'])))}]
    return glb(doc, b''.join(parts))


@quantity(most=0)
def gltf_hundred(n):
    """A hundred grids of n megabytes, of which the 38th has a normal texture, or none where SIDE is 1. Prints where that one's
    attributes and indices lie in the file."""
    doc, size = document(), int((n * 1e4 / 56) ** 0.5)
    piece = grid(doc, size - 1, size)
    views, accessors, every = doc['bufferViews'], doc['accessors'], range(100)
    doc['bufferViews'] = [dict(v, byteOffset=v['byteOffset'] + len(piece) * i) for i in every for v in views]
    doc['accessors'] = [dict(a, bufferView=a['bufferView'] + 4 * i) for i in every for a in accessors]
    doc['meshes'][0]['primitives'] = [{'attributes': {'POSITION': 4 * i, 'NORMAL': 4 * i + 1, 'TEXCOORD_0': 4 * i + 2},
                                       'indices': 4 * i + 3, 'material': int(i == 37 and side != 1)} for i in every]
    doc |= {'materials': [{}] + doc['materials'], 'textures': [{}], 'images': []}
    path = glb(doc, piece * 100)
    print(os.path.getsize(path) - 63 * len(piece), os.path.getsize(path) - 62 * len(piece))
    return path


@quantity('IN OUT.glb', 'IN OUT.gltf', '--buffers=copy IN out/o.gltf', '--only=all --verify IN OUT.glb', most=10000)
def gltf_buffers_of_one_file(n):
    doc = document()
    one = doc['meshes'][0]['primitives'][0]
    doc['bufferViews'] += [dict(doc['bufferViews'][2], buffer=i + 1) for i in range(n)]
    doc['accessors'] += [dict(doc['accessors'][2], bufferView=4 + i) for i in range(n)]
    doc['meshes'][0]['primitives'] = [dict(one, attributes=dict(one['attributes'], TEXCOORD_0=4 + i)) for i in range(n)]
    gltf(doc)
    doc['buffers'] *= n + 1
    return save('.gltf', json.dumps(doc))


def of_files(buffers, length, images):
    """A glTF of a mesh and a material for each pair of files."""
    doc = of_textures(document(), [{'uri': name} for name in images])
    views, accessors, every = doc['bufferViews'][:3], doc['accessors'][:3], range(len(buffers))
    doc['buffers'] = [{'uri': name, 'byteLength': length} for name in buffers]
    doc['bufferViews'] = [dict(v, buffer=i) for i in every for v in views]
    doc['accessors'] = [dict(a, bufferView=3 * i + k) for i in every for k, a in enumerate(accessors)]
    doc['meshes'] = [{'primitives': [{'attributes': {'POSITION': 3 * i, 'NORMAL': 3 * i + 1, 'TEXCOORD_0': 3 * i + 2},
                                      'material': i}]} for i in every]
    doc |= {'nodes': [{'mesh': i} for i in every], 'scenes': [{'nodes': list(every)}]}
    return save('.gltf', json.dumps(doc))


@quantity('--only=all IN OUT.gltf', *IMAGES, most=1000)
def gltf_names_of_one_pair(n):
    """Buffers that all are one file of a megabyte, and images that all are another."""
    save('.bin', TRIANGLE + bytes((1 << 20) - len(TRIANGLE)))
    save('.png', png(1, 1, 160) + bytes(1 << 20))
    return of_files(['./' * (i % 4) + base + '.bin' for i in range(n)], 1 << 20, ['./' * (i % 4) + base + '.png' for i in range(n)])


@quantity('--only=all IN OUT.gltf', *IMAGES, most=10000)
def gltf_files_apart(n):
    for i in range(n):
        save('.%d.bin' % i, TRIANGLE)
        save('.%d.png' % i, png(1, 1, 160))
    return of_files(['%s.%d.bin' % (base, i) for i in range(n)], len(TRIANGLE), ['%s.%d.png' % (base, i) for i in range(n)])


@quantity(*IMAGES)
def gltf_images_in_views(n):
    image = png(1, 1)
    doc = of_textures(document(), [{'bufferView': 4 + i, 'mimeType': 'image/png'} for i in range(n)])
    doc['bufferViews'] += [{'buffer': 0, 'byteOffset': len(TRIANGLE) + len(image) * i, 'byteLength': len(image)}
                           for i in range(n)]
    return glb(doc, TRIANGLE + image * n)


@quantity(*IMAGES, most=10000)
def gltf_images_of_one_file(n):
    save('i.png', png(8, 8))
    return gltf(of_textures(document(), [{'uri': './' * random.randrange(3) + 'i.png'} for i in range(n)]))


@quantity(*IMAGES, most=10000)
def gltf_images_of_their_own(n):
    for i in range(n):
        save('i%d.png' % i, png(1, 1))
    return gltf(of_textures(document(), [{'uri': 'i%d.png' % i} for i in range(n)]))


@quantity(*PLAIN, most=10000)
def gltf_targets_of_their_own(n):
    doc = document()
    deltas = b''.join(struct.pack('<9f', *(random.random() for k in range(9))) for i in range(n))
    doc['bufferViews'].append({'buffer': 0, 'byteOffset': len(TRIANGLE), 'byteLength': len(deltas)})
    doc['accessors'] += [dict(doc['accessors'][1], bufferView=4, byteOffset=36 * i) for i in range(n)]
    doc['meshes'][0]['primitives'][0]['targets'] = [{'POSITION': 4 + i} for i in range(n)]
    return glb(doc, TRIANGLE + deltas)


@quantity(*PLAIN)
def gltf_sparse(n):
    doc = document()
    rows = int(math.sqrt(n))
    binary, count = grid(doc, rows), rows * rows
    indices, values = struct.pack('<%dI' % count, *range(count)), struct.pack('<2f', 0, 0) * count
    doc['bufferViews'] += [{'buffer': 0, 'byteOffset': len(binary), 'byteLength': len(indices)},
                           {'buffer': 0, 'byteOffset': len(binary) + len(indices), 'byteLength': len(values)}]
    doc['accessors'][2]['sparse'] = {'count': count, 'indices': {'bufferView': 4, 'componentType': 5125},
                                     'values': {'bufferView': 5}}
    return glb(doc, binary + indices + values)


@quantity(*PLAIN)
def gltf_animated_transforms(n):
    doc = document()
    doc['materials'] = [{'normalTexture': {'index': 0, 'extensions': {'KHR_texture_transform': {'rotation': i}}}}
                        for i in range(n)]
    pointer = '/materials/%d/normalTexture/extensions/KHR_texture_transform/rotation'
    doc['animations'] = [{'samplers': [], 'channels': [{'sampler': 0, 'target': {'path': 'pointer', 'extensions': {
        'KHR_animation_pointer': {'pointer': pointer % random.randrange(n)}}}} for i in range(n)]}]
    of_materials(doc, n)
    return glb(doc)


def written_as(material):
    """A glTF whose JSON has this text in place of the key "material"."""
    gltf(document())
    return save('.gltf', json.dumps(document() | {'buffers': [{'uri': base + '.bin', 'byteLength': len(TRIANGLE)}]}).replace(
        '"material"', material))


# ---- OBJ and MTL ----


CORNERS = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n'
FACE = 'f 1/1/1 2/2/1 3/3/1\n'


def obj(text, mtl=None):
    if mtl is not None:
        save('.mtl', mtl)
        text = 'mtllib %s.mtl\n' % base + text
    return save('.obj', text)


def of_each(n, material):
    """An OBJ of n materials, each of these lines."""
    return obj(CORNERS + ''.join('usemtl m%d\n' % i + FACE for i in range(n)),
               ''.join('newmtl m%d\n%s\n' % (i, material(i)) for i in range(n)))


def face(*corners):
    return 'f ' + ' '.join('%d/%d' % (c, c) for c in corners) + '\n'


def circle(n):
    points = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(n)]
    return ''.join('v %.9g %.9g 0\nvt %.9g %.9g\n' % (p + p) for p in points)


def lines_of(*lines, face=FACE):
    """A quantity of lines: an OBJ of n of each, between faces."""
    return lambda n: obj(CORNERS + ''.join((line % i if '%' in line else line) + '\n' + face for i in range(n) for line in lines))


for name, line in {'objects': 'o x%d', 'groups': 'g x%d y', 'equal_objects': 'o x', 'materials': 'usemtl m%d', 'smoothing': 's %d',
                   'normals': 'vn 0 0 %d.5', 'coordinates': 'vt .%d 1', 'vertices': 'v %d 0 0', 'comments': '# %d',
                   'unknown': 'xyz %d', 'lines': 'l 1 2 3', 'points': 'p 1', 'curves': 'curv 0 1 1 2 3',
                   'long_lines': 'g ' + 'x ' * 100 + '%d', 'libraries': 'mtllib x%d.mtl',
                   'colors': 'v 0 0 0 1 .%d 0', 'mrgb': '#MRGB ff%08x'}.items():
    make = lines_of(line)
    make.__name__ = 'obj_' + name
    quantity(*(MESHES if name in ('objects', 'materials', 'smoothing') else PLAIN))(make)


@quantity(*MESHES)
def obj_torus(n):
    """Triangles, two for each cell, with seams of texture coordinates; 980 000 are 104 MB."""
    size, turn, lines = math.isqrt(n // 2), 2 * math.acos(-1), ['o torus\n']
    turns = [(math.cos(turn * i / size), math.sin(turn * i / size)) for i in range(size)]
    for c, s in turns:
        for x, y in turns:
            lines.append('v %.7f %.7f %.7f\nvn %.7f %.7f %.7f\n' % ((2 + c) * x, (2 + c) * y, s, c * x, c * y, s))
    lines += ['vt %.7f %.7f\n' % (column / size, row / size) for row in range(size + 1) for column in range(size + 1)]
    for cell in range(size * size):
        row, column = divmod(cell, size)
        corners = []
        for down, right in ((0, 0), (0, 1), (1, 1), (1, 0)):
            vertex = (row + down) % size * size + (column + right) % size + 1
            corners.append('%d/%d/%d' % (vertex, (row + down) * (size + 1) + column + right + 1, vertex))
        lines += ['f %s %s %s\n' % (corners[0], corners[k], corners[k + 1]) for k in (1, 2)]
    return obj(''.join(lines))


@quantity(*MESHES)
def obj_patches(n):
    """Quads that are islands over the same texels, every other one mirrored."""
    text = 'vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n'
    for i in range(n):
        text += ''.join('v %.9g %.9g 0\n' % (i % 500 + x, i // 500 + y) for x, y in ((0, 0), (.8, 0), (.8, .8), (0, .8)))
        text += 'f -4/%d -3/%d -2/%d -1/%d\n' % ((1, 2, 3, 4) if i % 2 else (2, 1, 4, 3))
    return obj(text)


@quantity(*MESHES)
def obj_quads_of_objects(n):
    """Every other one is mirrored, with texels of its own; two at one edge each."""
    rows, text = math.isqrt(n) + 1, ''
    for i in range(n):
        x, u, v, size = i + i // 2, i % rows / rows, i // rows / rows, 0.8 / rows
        text += 'o %d\nv %d 0 0\nv %d 0 0\nv %d 1 0\nv %d 1 0\n' % (i, x, x + 1, x + 1, x)
        text += ''.join('vt %.7f %.7f\n' % (u + (right ^ i % 2) * size, v + up * size)
                        for right, up in ((0, 0), (1, 0), (1, 1), (0, 1))) + 'f -4/-4 -3/-3 -2/-2 -1/-1\n'
    return obj(text)


@quantity(*PLAIN)
def obj_folded_quads(n):
    """Quads around one point, whose halves have opposite tangents."""
    text = 'v 0 0 0\nvt 0 0\nvn 0 0 1\n'
    for i in range(n + 1):
        away, out = -1 if i % 2 else 1, 1 + i / 65536
        text += 'v %.9g 0 0\nvt %d 0\nv %d %.9g 0\nvt 0 %d\n' % (out, away, i % 7, out, away)
    return obj(text + ''.join('f 1/1/1 %d/%d/1 %d/%d/1 %d/%d/1\n' % (i, i, i + 1, i + 1, i + 2, i + 2)
                              for i in range(2, 2 * n + 2, 2)))


@quantity(*PLAIN, '--images=embed IN OUT.glb', '--images=copy IN out/o.gltf', '--textures=png IN out/o.gltf', most=10000)
def mtl_images_of_their_own(n):
    for i in range(n):
        save('c%d.png' % i, png(1, 1, i))
    return of_each(n, lambda i: 'map_Kd c%d.png' % i)


@quantity(*PLAIN, '--images=embed IN OUT.glb', '--textures=png IN out/o.gltf', most=10000)
def mtl_tga_images(n):
    for i in range(n):
        save('.%d.tga' % i, b'\0\0\2' + bytes(9) + struct.pack('<HHBBBBB', 1, 1, 24, 32, i % 256, i // 256, 1))
    return of_each(n, lambda i: 'map_Kd %s.%d.tga' % (base, i))


@quantity(*PLAIN, '--images=embed IN OUT.glb', '--images=copy IN out/o.gltf', '--textures=png IN out/o.gltf')
def mtl_images_of_one_file(n):
    save('c.png', png(1, 1))
    return of_each(n, lambda i: 'map_Kd %sc.png' % ('./' * random.randrange(9)))


# ---- PLY ----

ROWS = b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n'


def ply(header, body=ROWS + b'3 0 1 2\n', vertices=3, faces=1, form='ascii', more='', kind='float',
        face='property list uchar int vertex_indices\n'):
    return save('.ply', ('ply\nformat %s 1.0\n%selement vertex %d\n' % (form, header, vertices) +
                         ''.join('property %s %c\n' % (kind, c) for c in 'xyzst') + more +
                         'element face %d\n%send_header\n' % (faces, face)).encode() + body)


PLYS = ('IN OUT.glb', 'IN OUT.ply', '--check --report=r.json IN')


# ---- images ----


def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(width, height, shade=0, before=b'', parts=1, kind=(8, 2), row=None):
    row = row or bytes((128, shade % 256, 255)) * width
    data = zlib.compress((b'\0' + row) * height, 9)
    size = max(1, -(-len(data) // parts))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, *kind, 0, 0, 0)) + before + b''.join(
        chunk(b'IDAT', data[i:i + size]) for i in range(0, len(data), size)) + chunk(b'IEND', b''))


DECODED = ('--textures=png IN OUT.glb', '--images=embed --textures=png --flip-green=on IN OUT.glb', '--check --check-maps=on IN')


def image(ending, data, maps=('map_Kd', 'norm')):
    save('.' + ending, data)
    return obj(CORNERS + 'usemtl m\n' + FACE, 'newmtl m\n' + ''.join('%s %s.%s\n' % (key, base, ending) for key in maps))


def tiff(width, height, strips, entries, compression=1):
    """A grey TIFF whose strips are [(offset, size)] or bytes; entries: more tags."""
    data, offsets, sizes = b'', [], []
    for strip in strips:
        if isinstance(strip, bytes):
            offsets.append(8 + len(data))
            sizes.append(len(strip))
            data += strip
        else:
            offsets.append(strip[0])
            sizes.append(strip[1])
    per = max(1, -(-height // len(strips)))
    tables = struct.pack('<%dI' % len(strips), *offsets) + struct.pack('<%dI' % len(strips), *sizes)
    at = 8 + len(data)
    one = len(strips) == 1
    tags = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, compression), (262, 3, 1, 1),
            (273, 4, len(strips), offsets[0] if one else at), (277, 3, 1, 1), (278, 4, 1, per),
            (279, 4, len(strips), sizes[0] if one else at + 4 * len(strips))] + entries
    directory = struct.pack('<H', len(tags)) + b''.join(struct.pack('<HHII', *t) for t in tags) + b'\0\0\0\0'
    return struct.pack('<2sHI', b'II', 42, at + len(tables)) + data + tables + directory


# ---- lists of options and of inputs ----


@quantity('-d out @INPUTS', '--check --report=r.json @INPUTS', '--check --report=r.sarif @INPUTS', '--check --report=pages/ @INPUTS',
          '-d out --files-from=IN --depfile=d --manifest=m', '-d out --files-from=IN --update',
          '--check --report=r.xml --files-from=IN', '-d out --keep-tree=. -r .', '--check -q -r . --exclude=x* --include=*.obj',
          '--dry-run -d out --files-from=IN', most=10000)
def option_inputs(n):
    for i in range(n):
        save('f%d.obj' % i, CORNERS + FACE)
    return save('.txt', ''.join('f%d.obj\n' % i for i in range(n)))


@quantity('--in-place --files-from=IN', most=10000)
def option_in_place(n):
    first = glb(document())
    for i in range(n):
        shutil.copy(first, '%s/f%d.glb' % (folder, i))
    return save('.txt', ''.join('f%d.glb\n' % i for i in range(n)))


@quantity('--check --files-from=IN', '-d out --files-from=IN')
def option_equal_inputs(n):
    obj(CORNERS + FACE)
    return save('.txt', './' * random.randrange(5) + (base + '.obj\n') * n)


@quantity('-q --check --files-from=IN', '-q -d out --files-from=IN')
def option_missing_inputs(n):
    return save('.txt', ''.join('no/%d.obj\n' % i for i in range(n)))


# ---- inputs that a few statements make ----


def from_row(name, statements):
    """Makes the input of a row of inputs.tsv. If the statements set no path, the document becomes a GLB."""
    def make(n):
        scope = dict(globals(), n=n, doc=document())
        exec(statements, scope)
        return scope.get('path') or glb(scope['doc'])
    make.__name__ = name
    globals()[name] = make
    return make


with open(HERE + '/inputs.tsv', encoding='utf-8') as table:
    for row in table:
        if not row.startswith('#'):
            row_name, row_options, row_statements = row.rstrip('\n').split('\t')
            eval('quantity(%s)' % row_options)(from_row(row_name, row_statements))


def make_input(name, n, path, size=0):
    """Makes one whose name but for the ending is that of the path; returns its own path."""
    global folder, base, side
    folder, base, side = os.path.dirname(path) or '.', os.path.splitext(os.path.basename(path))[0], size
    random.seed(int(os.environ.get('NT_SEED', 1)))
    return quantities[name][0](n)


if __name__ == '__main__':
    make_input(sys.argv[1], int(sys.argv[2]), sys.argv[3], int((sys.argv + [0])[4]))

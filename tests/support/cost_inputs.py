#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cost_inputs.py KIND COUNT FILE [SIDE]: small files that ask for much work, by test_cost.sh.

elements  a PLY header of COUNT elements
usemtl    an OBJ that changes its material COUNT times
names     a GLB of COUNT primitives over one set of accessors, of a mesh whose name has 1000 COUNT bytes
same      a GLB of COUNT primitives over one set of accessors, 43 218 triangles each
windows   a GLB of COUNT primitives over one grid of SIDE (118) quads squared, each with another window of its 16-bit
          indices; the texture coordinates turn back at every fourth column, so that vertices are split
ranges    a GLB of COUNT primitives over one grid of SIDE (100) quads squared, each with triangles of its own
scene     a GLB of COUNT primitives, ten in a mesh, of SIDE (3) quads squared and with accessors of their own, of 50
          materials
images    an OBJ of COUNT materials, and FILE.mtl beside it, with two images each that are not there
libraries an OBJ that names one library by COUNT names, and FILE.mtl beside it with COUNT materials
slashes   an OBJ, or a PLY or glTF by the name of FILE, that names library or images with COUNT slashes
colors    an OBJ of COUNT materials, and FILE.mtl and FILE.0.tga and so on beside it, with an image of one pixel each
bumps     an OBJ of COUNT materials, and FILE.mtl and FILE.png beside it: each makes other normals of one white PNG of
          SIDE (4096) pixels squared and one bit
scans     an OBJ, FILE.mtl and FILE.jpg beside it: a JPEG of 512 x 512 pixels and COUNT scans
strips    an OBJ, FILE.mtl and FILE.tif beside it: a TIFF of COUNT strips of 256 x 16 pixels, which share their bytes
list      the names of COUNT OBJ files of one triangle, which are beside it
apart     a glTF of COUNT images and COUNT buffers, and a file for each beside it
animated  a GLB of COUNT materials, each with a texture transform, and an animation of COUNT others
buffers   a glTF, and FILE.bin of 1 MB beside it, of COUNT buffers that all name that, and COUNT images of one file
targets   a GLB of one grid of SIDE (48) quads squared with COUNT morph targets, which all share one accessor
halves    the same grid, as two primitives over one set of vertices
levels    a GLB of COUNT primitives of one material with COUNT levels of detail
turned    a GLB of COUNT materials, each with a texture and an image of its own, as normal map and as emissive
properties a PLY of one triangle with COUNT properties of its vertices
strip     an OBJ strip of COUNT quads
hub       an OBJ of COUNT triangles around one point
tiles     an OBJ of COUNT quads in a row, all with the same texels, every other one mirrored
folded    an OBJ of COUNT quads around one point, whose halves have opposite tangents
edge      an OBJ of COUNT triangles on one edge
repeated  an OBJ of one triangle, COUNT times
centre    an OBJ of COUNT triangles of three points each, all around one centre
patches   an OBJ of COUNT quads, each an island of its own over the same texels, every other one mirrored
known     a report of COUNT findings of FILE without .json
objects   an OBJ of COUNT quads that are objects, every other one mirrored and with texels of its own
"""
import base64
import json
import math
import os.path
import struct
import sys
import zlib


def elements(count, out):
    out.write(b'ply\nformat ascii 1.0\n')
    for i in range(count):
        out.write(b'element thing%06d 0\nproperty int x\n' % i)
    out.write(b'element vertex 3\n' + b''.join(b'property float %c\n' % c for c in b'xyzst') +
              b'element face 1\nproperty list uchar int vertex_indices\nend_header\n'
              b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n')


def properties(count, out):
    out.write(b'ply\nformat ascii 1.0\nelement vertex 3\n' + b''.join(b'property float %c\n' % c for c in b'xyzst'))
    out.write(b''.join(b'property int p%d\n' % i for i in range(count)))
    out.write(b'element face 1\nproperty list uchar int vertex_indices\nend_header\n')
    for row in b'0 0 0 0 0', b'1 0 0 1 0', b'0 1 0 0 1':
        out.write(row + b' 0' * count + b'\n')
    out.write(b'3 0 1 2\n')


def usemtl(count, out):
    out.write(b'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n')
    for i in range(count):
        out.write(b'usemtl m%d\nf 1/1/1 2/2/1 3/3/1\n' % i)


def images(count, out):
    out.write(b'mtllib %s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n' %
              os.path.basename(sys.argv[3]).encode())
    for i in range(count):
        out.write(b'usemtl m%d\nf 1/1/1 2/2/1 3/3/1\n' % i)
    with open(sys.argv[3] + '.mtl', 'w') as materials:
        for i in range(count):
            materials.write('newmtl m%d\nmap_Kd c%d.png\nnorm n%d.png\n' % (i, i, i))


def libraries(count, out):
    name = os.path.basename(sys.argv[3]).encode() + b'.mtl'
    out.write(b'mtllib' + b''.join(b' ' + b'./' * (i % 8) + name for i in range(count)) +
              b'\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nusemtl m0\nf 1/1/1 2/2/1 3/3/1\n')
    with open(sys.argv[3] + '.mtl', 'w') as materials:
        for i in range(count):
            materials.write('newmtl m%d\nKd 0 1 0\nmap_Kd x.png\n' % i)


def slashes(count, out):
    name = 'a/' * count
    if sys.argv[3].endswith('.obj'):
        out.write(b'mtllib %sm.mtl\nmtllib %s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n'
                  b'usemtl m0\nf 1/1/1 2/2/1 3/3/1\n' % (name.encode(), os.path.basename(sys.argv[3]).encode()))
        with open(sys.argv[3] + '.mtl', 'w') as materials:
            materials.write('newmtl m0\nmap_Kd %sx.png\n' % name)
    elif sys.argv[3].endswith('.ply'):
        out.write(b'ply\nformat ascii 1.0\ncomment TextureFile %sx.png\nelement vertex 3\n' % name.encode() +
                  b''.join(b'property float %c\n' % c for c in b'xyzst') +
                  b'element face 1\nproperty list uchar int vertex_indices\nend_header\n'
                  b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n')
    else:
        glb(1, out, 1, False, more={'images': [{'uri': name + 'x.png'}]})


def colors(count, out):
    images(count, out)
    name = sys.argv[3]
    with open(name + '.mtl', 'w') as materials:
        for i in range(count):
            materials.write('newmtl m%d\nmap_Kd %s.%d.tga\n' % (i, os.path.basename(name), i))
            with open('%s.%d.tga' % (name, i), 'wb') as image:
                image.write(b'\0\0\2' + bytes(9) + struct.pack('<HHBBBBB', 1, 1, 24, 32, i % 256, i // 256, 1))


def bumps(count, out, side):
    images(count, out)
    name = sys.argv[3]
    with open(name + '.mtl', 'w') as materials:
        for i in range(count):
            materials.write('newmtl m%d\nmap_Bump -bm %d %s.png\n' % (i, i + 1, os.path.basename(name)))
    with open(name + '.png', 'wb') as image:
        image.write(png(side, 0, 1, b'\xff' * (side // 8)))


def one_image(out, ending, content):
    name = sys.argv[3]
    out.write(b'mtllib %s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/3/1\n' %
              os.path.basename(name).encode())
    with open(name + '.mtl', 'w') as materials:
        materials.write('newmtl m\nmap_Kd %s.%s\n' % (os.path.basename(name), ending))
    with open('%s.%s' % (name, ending), 'wb') as image:
        image.write(content)


def scans(count, out):
    def segment(marker, data):
        return b'\xff' + bytes((marker,)) + struct.pack('>H', 2 + len(data)) + data
    scan = segment(0xda, bytes((1, 1, 0, 0, 0, 0))) + b'\x12\xff\x00'
    one_image(out, 'jpg', b'\xff\xd8' + segment(0xc2, struct.pack('>BHHB', 8, 512, 512, 1) + b'\1\x11\0') + count * scan)


def strips(count, out):
    data = zlib.compress(bytes(256 * 16), 9)
    tables = struct.pack('<%dI' % count, *[8] * count) + struct.pack('<%dI' % count, *[len(data)] * count)
    at = 8 + len(data)
    tags = [(256, 1, 256), (257, 1, 16 * count), (258, 1, 8), (259, 1, 8), (262, 1, 1), (273, count, at), (277, 1, 1), (278, 1, 16),
            (279, count, at + 4 * count)]
    one_image(out, 'tif', struct.pack('<2sHI', b'II', 42, at + len(tables)) + data + tables + struct.pack('<H', len(tags)) +
              b''.join(struct.pack('<HHII', tag, 4, n, value) for tag, n, value in tags) + bytes(4))


def names(count, out):
    for i in range(count):
        with open('%s.%d.obj' % (sys.argv[3], i), 'wb') as triangle:
            repeated(1, triangle)
        out.write(b'%s.%d.obj\n' % (sys.argv[3].encode(), i))


def apart(count, out):
    base = os.path.basename(sys.argv[3])
    triangle = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack('<9f', *(0, 0, 1) * 3) + struct.pack('<6f', 0, 0, 1, 0, 0, 1)
    for i in range(count):
        with open('%s.%d.bin' % (sys.argv[3], i), 'wb') as binary:
            binary.write(triangle)
        with open('%s.%d.png' % (sys.argv[3], i), 'wb') as image:
            image.write(png(1, 2, 8, b'\x80\xa0\xf0'))
    out.write(many(count, ['%s.%d.bin' % (base, i) for i in range(count)], len(triangle),
                   ['%s.%d.png' % (base, i) for i in range(count)]))


def strip(count, out):
    for i in range(count + 1):
        out.write(b'v %d 0 0\nv %d 1 0\nvt %d 0\nvt %d 1\n' % (i, i, i, i))
    for i in range(count):
        a, b, c, d = 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2
        out.write(b'f %d/%d %d/%d %d/%d %d/%d\n' % (a, a, b, b, c, c, d, d))


def circle(count, out):
    for i in range(count):
        angle = 2 * math.pi * i / count
        out.write(b'v %.9g %.9g 0\nvt %.9g %.9g\n' % (math.cos(angle), math.sin(angle), math.cos(angle), math.sin(angle)))


def hub(count, out):
    circle(count, out)
    out.write(b'v 0 0 0\nvt 0 0\n')
    for i in range(count):
        a, b, c = i + 1, (i + 1) % count + 1, count + 1
        out.write(b'f %d/%d %d/%d %d/%d\n' % (a, a, b, b, c, c))


def folded(count, out):
    out.write(b'v 0 0 0\nvt 0 0\nvn 0 0 1\n')
    for i in range(count + 1):
        side = -1 if i % 2 else 1
        out.write(b'v %.9g 0 0\nvt %d 0\nv %d %.9g 0\nvt 0 %d\n' % (1 + i / 65536, side, i % 7, 1 + i / 65536, side))
    for i in range(2, 2 * count + 2, 2):
        out.write(b'f 1/1/1 %d/%d/1 %d/%d/1 %d/%d/1\n' % (i, i, i + 1, i + 1, i + 2, i + 2))


def tiles(count, out):
    for i in range(count + 1):
        out.write(b'v %d 0 0\nvt %d 0\nv %d 1 0\nvt %d 1\n' % (i, i % 2, i, i % 2))
    for i in range(1, 2 * count + 1, 2):
        out.write(b'f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n' % (i, i, i + 2, i + 2, i + 1, i + 1,
                                                              i + 1, i + 1, i + 2, i + 2, i + 3, i + 3))


def repeated(count, out):
    out.write(b'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n' + b'f 1/1/1 2/2/1 3/3/1\n' * count)


def centre(count, out):
    out.write(b'vt 0 0\nvt 1 0\nvt 0 1\n')
    for i in range(3 * count):
        angle = 2 * math.pi * (i // 3 / count + i % 3) / 3
        out.write(b'v %.9g %.9g %d\n' % (math.cos(angle), math.sin(angle), 0))
    for i in range(1, 3 * count, 3):
        out.write(b'f %d/1 %d/2 %d/3\n' % (i, i + 1, i + 2))


def edge(count, out):
    circle(count, out)
    out.write(b'v 0 0 0\nv 0 0 1\nvt 0 0\nvt 0 2\n')
    for i in range(count):
        a, b, c = i + 1, count + 1, count + 2
        out.write(b'f %d/%d %d/%d %d/%d\n' % (a, a, b, b, c, c))


def patches(count, out):
    out.write(b'vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n')
    for i in range(count):
        for x, y in (0, 0), (.8, 0), (.8, .8), (0, .8):
            out.write(b'v %.9g %.9g 0\n' % (i % 500 + x, i // 500 + y))
        corners = (1, 2, 3, 4) if i % 2 else (2, 1, 4, 3)
        out.write(b'f %d/%d %d/%d %d/%d %d/%d\n' % tuple(n for k in range(4) for n in (4 * i + k + 1, corners[k])))


def objects(count, out):
    """Two at one edge each."""
    rows = math.isqrt(count) + 1
    for i in range(count):
        x, u, v, side = i + i // 2, i % rows / rows, i // rows / rows, 0.8 / rows
        out.write(b'o %d\nv %d 0 0\nv %d 0 0\nv %d 1 0\nv %d 1 0\n' % (i, x, x + 1, x + 1, x))
        for right, up in (((1, 0), (0, 0), (0, 1), (1, 1)) if i % 2 else ((0, 0), (1, 0), (1, 1), (0, 1))):
            out.write(b'vt %.7f %.7f\n' % (u + right * side, v + up * side))
        out.write(b'f -4/-4 -3/-3 -2/-2 -1/-1\n')


def known(count, out):
    number = 1
    out.write(b'{"report":"nmtan","files":[{"file":"%s","findings":[' % sys.argv[3][:-5].encode())
    for i in range(count):
        number = number * 6364136223846793005 + 1442695040888963407 & (1 << 64) - 1
        out.write(b'%s{"fingerprint":"%016x","geometry":"%016x"}' % (b',' if i else b'', number, number))
    out.write(b']}]}')


def grid(side, windows):
    """Positions, normals, texture coordinates and indices."""
    width = side + 1
    arrays = [b'', b'', b'', b'']
    for y in range(width):
        for x in range(width):
            u = x % 8 if x % 8 < 4 else 8 - x % 8
            arrays[0] += struct.pack('<3f', x, y, 0)
            arrays[1] += struct.pack('<3f', 0, 0, 1)
            arrays[2] += struct.pack('<2f', (u if windows else x) / side, y / side)
    form = '<6H' if windows else '<6I'
    for y in range(side):
        for x in range(side):
            a = y * width + x
            arrays[3] += struct.pack(form, a, a + 1, a + width, a + 1, a + width + 1, a + width)
    return arrays


def glb(count, out, side, windows, ranges=False, name='', more={}, materials=None, change=dict):
    arrays, kind, width_bytes = grid(side, windows), *((5123, 2) if windows else (5125, 4))
    views, offset = [], 0
    for array in arrays:
        views.append({'buffer': 0, 'byteOffset': offset, 'byteLength': len(array)})
        offset += len(array)
    vertices, triangles = (side + 1) ** 2, 2 * side * side
    accessors = [{'bufferView': 0, 'componentType': 5126, 'count': vertices, 'type': 'VEC3',
                  'min': [0, 0, 0], 'max': [side, side, 0]},
                 {'bufferView': 1, 'componentType': 5126, 'count': vertices, 'type': 'VEC3'},
                 {'bufferView': 2, 'componentType': 5126, 'count': vertices, 'type': 'VEC2'}]
    for i in range(count if ranges else 0):
        first, end = triangles * i // count, triangles * (i + 1) // count
        accessors.append({'bufferView': 3, 'byteOffset': 3 * width_bytes * first, 'componentType': kind,
                          'type': 'SCALAR', 'count': 3 * (end - first)})
    for i in range(0 if ranges else count if windows else 1):
        accessors.append({'bufferView': 3, 'byteOffset': 3 * width_bytes * i, 'componentType': kind, 'type': 'SCALAR',
                          'count': 3 * (triangles - (count if windows else 0))})
    primitives = [{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'material': materials[i] if materials else 0,
                   'indices': 3 + i if windows or ranges else 3} for i in range(count)]
    write_glb(out, {'meshes': [{'name': name, 'primitives': [change(p) for p in primitives]}], 'materials': [{'normalTexture': {'index': 0}}],
                    'accessors': accessors, 'bufferViews': views} | more, arrays)


def png(side, color, bits, row):
    chunks = ((b'IHDR', struct.pack('>IIBBBBB', side, side, bits, color, 0, 0, 0)),
              (b'IDAT', zlib.compress((b'\0' + row) * side, 9)), (b'IEND', b''))
    return b'\x89PNG\r\n\x1a\n' + b''.join(struct.pack('>I', len(data)) + kind + data +
                                           struct.pack('>I', zlib.crc32(kind + data)) for kind, data in chunks)


def scene(count, out, side):
    arrays, accessors, views, chunks, meshes = grid(side, True), [], [], [], []
    vertices, offset = (side + 1) ** 2, 0
    for i in range(count):
        # each has positions of its own
        chunks.append(struct.pack('<3f', 0, 0, i / count) + arrays[0][12:])
        chunks += arrays[1:]
        for k, array in enumerate(arrays):
            views.append({'buffer': 0, 'byteOffset': offset, 'byteLength': len(array)})
            accessors.append({'bufferView': len(views) - 1, 'componentType': 5126 if k < 3 else 5123,
                              'count': vertices if k < 3 else 6 * side * side,
                              'type': ('VEC3', 'VEC3', 'VEC2', 'SCALAR')[k]})
            offset += len(array)
        accessors[-4] |= {'min': [0, 0, 0], 'max': [side, side, i / count]}
        if i % 10 == 0:
            meshes.append({'primitives': []})
        meshes[-1]['primitives'].append({'attributes': {'POSITION': 4 * i, 'NORMAL': 4 * i + 1, 'TEXCOORD_0': 4 * i + 2},
                                         'indices': 4 * i + 3, 'material': i % 50})
    write_glb(out, {'meshes': meshes, 'materials': [{'normalTexture': {'index': 0}}] * 50, 'accessors': accessors,
                    'bufferViews': views}, chunks)


def turned(count, out):
    image = {'uri': 'data:image/png;base64,' + base64.b64encode(png(1, 2, 8, b'\x80\xa0\xf0')).decode()}
    glb(1, out, 1, False, more={
        'materials': [{'normalTexture': {'index': i}, 'emissiveTexture': {'index': i}} for i in range(count)],
        'textures': [{'source': i} for i in range(count)], 'images': [image] * count})


def animated(count, out):
    texture = [{'index': 0, 'extensions': {'KHR_texture_transform': {'rotation': i + 1}}} for i in range(count)]
    channels = [{'sampler': 0, 'target': {'path': 'pointer', 'extensions': {'KHR_animation_pointer': {
        'pointer': '/materials/%d/emissiveTexture/extensions/KHR_texture_transform/rotation' % i}}}} for i in range(count)]
    glb(count, out, 1, False, more={'materials': [{'normalTexture': t} for t in texture],
                                    'animations': [{'channels': channels, 'samplers': []}],
                                    'extensionsUsed': ['KHR_texture_transform', 'KHR_animation_pointer']},
        materials=range(count))


def levels(count, out):
    glb(count, out, 1, False, more={'materials': [
        {'normalTexture': {'index': 0}, 'extensions': {'MSFT_lod': {'ids': list(range(1, count))}}}] +
        [{'normalTexture': {'index': 0}}] * (count - 1), 'extensionsUsed': ['MSFT_lod']})


def buffers(count, out):
    name = sys.argv[3]
    triangle = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack('<9f', *(0, 0, 1) * 3) + struct.pack('<6f', 0, 0, 1, 0, 0, 1)
    with open(name + '.bin', 'wb') as binary:
        binary.write(triangle + bytes((1 << 20) - len(triangle)))
    with open(name + '.png', 'wb') as image:
        image.write(png(1, 2, 8, b'\x80\xa0\xf0') + bytes(1 << 20))
    base = os.path.basename(name)
    out.write(many(count, ['./' * (i % 4) + base + '.bin' for i in range(count)], 1 << 20,
                   ['./' * (i % 4) + base + '.png' for i in range(count)]))


def many(count, buffers, length, images):
    """A glTF of COUNT meshes, materials and textures, with the names of a buffer and an image for each."""
    views = [{'buffer': i, 'byteOffset': offset, 'byteLength': length} for i in range(count) for offset, length in ((0, 36), (36, 36), (72, 24))]
    accessors = [{'bufferView': i, 'componentType': 5126, 'count': 3, 'type': 'VEC2' if i % 3 == 2 else 'VEC3'} |
                 ({'min': [0, 0, 0], 'max': [1, 1, 0]} if i % 3 == 0 else {}) for i in range(3 * count)]
    meshes = [{'primitives': [{'attributes': {'POSITION': 3 * i, 'NORMAL': 3 * i + 1, 'TEXCOORD_0': 3 * i + 2}, 'material': i}]}
              for i in range(count)]
    return json.dumps({'asset': {'version': '2.0'}, 'meshes': meshes, 'scenes': [{'nodes': list(range(count))}],
                       'nodes': [{'mesh': i} for i in range(count)], 'textures': [{'source': i} for i in range(count)],
                       'materials': [{'normalTexture': {'index': i}} for i in range(count)],
                       'images': [{'uri': name} for name in images],
                       'buffers': [{'byteLength': length, 'uri': name} for name in buffers],
                       'bufferViews': views, 'accessors': accessors}).encode()


def targets(count, out, side, parts=1):
    def moved(primitive):
        return dict(primitive, targets=[{'POSITION': 1, 'NORMAL': 0}] * count)
    glb(parts, out, side, False, parts > 1, change=moved)


def write_glb(out, document, chunks):
    count = len(document['meshes'])
    binary = b''.join(chunks)
    document = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(count))}],
                'nodes': [{'mesh': i} for i in range(count)], 'textures': [{'source': 0}],
                'images': [{'uri': 'n.png'}], 'buffers': [{'byteLength': len(binary)}]} | document
    text = json.dumps(document, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    out.write(struct.pack('<4sIIII', b'glTF', 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A))
    out.write(text + struct.pack('<II', len(binary), 0x004E4942) + binary)


kind, count, side = sys.argv[1], int(sys.argv[2]), int((sys.argv + [0])[4])
with open(sys.argv[3], 'wb') as out:
    if kind == 'same':
        glb(count, out, 147, False)
    elif kind == 'names':
        glb(count, out, 3, False, name='x' * 1000 * count)
    elif kind == 'windows':
        glb(count, out, side or 118, True)
    elif kind == 'ranges':
        glb(count, out, side or 100, False, True)
    elif kind == 'scene':
        scene(count, out, side or 3)
    elif kind == 'targets':
        targets(count, out, side or 48)
    elif kind == 'halves':
        targets(count, out, side or 48, 2)
    elif kind == 'bumps':
        bumps(count, out, side or 4096)
    else:
        {'elements': elements, 'properties': properties, 'usemtl': usemtl, 'images': images, 'strip': strip, 'hub': hub, 'edge': edge,
         'patches': patches, 'repeated': repeated, 'centre': centre, 'folded': folded,
         'tiles': tiles, 'turned': turned, 'libraries': libraries, 'slashes': slashes, 'colors': colors,
         'buffers': buffers, 'animated': animated, 'levels': levels, 'scans': scans,
         'strips': strips, 'list': names, 'apart': apart, 'objects': objects, 'known': known}[kind](count, out)

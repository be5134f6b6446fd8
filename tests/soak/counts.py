#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""counts.py NMTAN [WORD...]: what is counted in inputs, from 1 000 to 100 000 of it, takes n log n time.

Each quantity is a function that writes an input with n of something, and each input is run with several sets of options.
Processor time and memory of 10 000 and 100 000 may be at most 1.5 times what n log n makes of those of the size before;
less than FLOOR seconds or bytes count as that. Runs end with an exit code that the manual has, but for 4. WORDs choose
quantities by parts of their names, a word with "--" sets of options. NT_SEED (1) is the seed of values and orders,
NT_LEAST and NT_MOST other sizes.
"""
import base64
import json
import math
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import zlib

FLOOR_SECONDS, FLOOR_BYTES, LIMIT_SECONDS, GROWTH = 0.04, 12 << 20, 40, 1.5
LEAST, MOST = int(os.environ.get('NT_LEAST', 1000)), int(os.environ.get('NT_MOST', 100000))
nmtan = os.path.abspath(sys.argv[1])
quantities = {}


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


def glb(path, doc, binary=TRIANGLE):
    binary += b'\0' * (-len(binary) % 4)
    doc['buffers'][0]['byteLength'] = len(binary)
    text = json.dumps(doc, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    with open(path, 'wb') as out:
        out.write(struct.pack('<4sIIII', b'glTF', 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A))
        out.write(text + struct.pack('<II', len(binary), 0x004E4942) + binary)
    return path


def gltf(path, doc, binary=TRIANGLE):
    with open(path + '.bin', 'wb') as out:
        out.write(binary)
    doc['buffers'][0] |= {'uri': os.path.basename(path) + '.bin', 'byteLength': len(binary)}
    with open(path, 'w') as out:
        json.dump(doc, out)
    return path


def grid(doc, side, binary=b''):
    """One primitive's arrays become a grid of side squared quads; returns the buffer."""
    width = side + 1
    rows = [(x, y) for y in range(width) for x in range(width)]
    cells = [(y * width + x) for y in range(side) for x in range(side)]
    arrays = [b''.join(struct.pack('<3f', x, y, 0) for x, y in rows), struct.pack('<3f', 0, 0, 1) * len(rows),
              b''.join(struct.pack('<2f', x % 3, y) for x, y in rows),
              b''.join(struct.pack('<6I', a, a + 1, a + width, a + 1, a + width + 1, a + width) for a in cells)]
    offset = 0
    for k, array in enumerate(arrays):
        doc['bufferViews'][k] |= {'byteOffset': offset, 'byteLength': len(array)}
        doc['accessors'][k]['count'] = 6 * len(cells) if k == 3 else len(rows)
        offset += len(array)
    doc['accessors'][3]['componentType'] = 5125
    doc['accessors'][0] |= {'max': [side, side, 0]}
    return b''.join(arrays) + binary


@quantity(*MESHES)
def gltf_primitives(n, folder):
    doc = document()
    doc['meshes'][0]['primitives'] *= n
    return glb(folder + '/a.glb', doc)


@quantity(*MESHES)
def gltf_primitives_with_materials(n, folder):
    doc = document()
    one = doc['meshes'][0]['primitives'][0]
    doc['meshes'][0]['primitives'] = [one | {'material': i} for i in range(n)]
    doc['materials'] = [{'name': 'm%d' % random.randrange(n), 'normalTexture': {'index': 0}} for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*MESHES)
def gltf_meshes_and_nodes(n, folder):
    doc = document()
    doc['meshes'] = [dict(doc['meshes'][0], name='x' * random.randrange(9)) for i in range(n)]
    doc['nodes'] = [{'mesh': i, 'scale': [1, -1, 1]} for i in range(n)]
    doc['scenes'][0]['nodes'] = list(range(n))
    return glb(folder + '/a.glb', doc)


@quantity(*MESHES)
def gltf_nodes_of_one_mesh(n, folder):
    doc = document()
    doc['nodes'] = [{'mesh': 0, 'translation': [i, 0, 0]} for i in range(n)]
    doc['scenes'][0]['nodes'] = list(range(n))
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN, '--only=all IN OUT.ply')
def gltf_node_chain(n, folder):
    doc = document()
    doc['nodes'] = [{'children': [i + 1]} for i in range(n - 1)] + [{'mesh': 0}]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_scenes(n, folder):
    doc = document()
    doc['scenes'] *= n
    return glb(folder + '/a.glb', doc)


@quantity(*MESHES)
def gltf_accessors_of_one_view(n, folder):
    doc = document()
    one = doc['meshes'][0]['primitives'][0]
    doc['accessors'] += [dict(doc['accessors'][2]) for i in range(n)]
    doc['meshes'][0]['primitives'] = [dict(one, attributes=dict(one['attributes'], TEXCOORD_0=4 + i)) for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*MESHES)
def gltf_everything_of_its_own(n, folder):
    doc = document()
    one, views, accessors = doc['meshes'][0]['primitives'][0], doc['bufferViews'], doc['accessors']
    doc['bufferViews'] = [dict(v, byteOffset=v['byteOffset'] + len(TRIANGLE) * i) for i in range(n) for v in views]
    doc['accessors'] = [dict(a, bufferView=a['bufferView'] + 4 * i) for i in range(n) for a in accessors]
    doc['meshes'] = [{'primitives': [dict(one, attributes={'POSITION': 4 * i, 'NORMAL': 4 * i + 1, 'TEXCOORD_0': 4 * i + 2},
                                          indices=4 * i + 3)]} for i in range(n)]
    doc['nodes'] = [{'mesh': i} for i in range(n)]
    return glb(folder + '/a.glb', doc, TRIANGLE * n)


@quantity(*MESHES)
def gltf_existing_tangents(n, folder):
    path = gltf_everything_of_its_own(n, folder)
    subprocess.run([nmtan, '-q', path, folder + '/b.glb'], check=True)
    return folder + '/b.glb'


@quantity('IN OUT.glb', 'IN OUT.gltf', '--buffers=copy IN out/o.gltf', '--buffers=embed IN OUT.gltf')
def gltf_buffers(n, folder):
    doc = document()
    doc['buffers'] += [{'byteLength': 3, 'uri': 'data:;base64,AAAA'} for i in range(n)]
    doc['bufferViews'] += [{'buffer': i + 1, 'byteLength': 3} for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity('IN OUT.glb', 'IN OUT.gltf', '--buffers=copy IN out/o.gltf', '--only=all --verify IN OUT.glb', most=10000)
def gltf_buffers_of_one_file(n, folder):
    doc = document()
    one = doc['meshes'][0]['primitives'][0]
    doc['bufferViews'] += [dict(doc['bufferViews'][2], buffer=i + 1) for i in range(n)]
    doc['accessors'] += [dict(doc['accessors'][2], bufferView=4 + i) for i in range(n)]
    doc['meshes'][0]['primitives'] = [dict(one, attributes=dict(one['attributes'], TEXCOORD_0=4 + i)) for i in range(n)]
    gltf(folder + '/a.gltf', doc)
    doc['buffers'] = doc['buffers'] * (n + 1)
    with open(folder + '/a.gltf', 'w') as out:
        json.dump(doc, out)
    return folder + '/a.gltf'


@quantity(*IMAGES)
def gltf_images_in_views(n, folder):
    doc, image = document(), png(1, 1)
    doc['images'] = [{'bufferView': 4 + i, 'mimeType': 'image/png'} for i in range(n)]
    doc['bufferViews'] += [{'buffer': 0, 'byteOffset': len(TRIANGLE) + len(image) * i, 'byteLength': len(image)}
                           for i in range(n)]
    doc['textures'] = [{'source': i} for i in range(n)]
    doc['materials'] = [{'normalTexture': {'index': i}} for i in range(n)]
    return glb(folder + '/a.glb', doc, TRIANGLE + image * n)


@quantity(*IMAGES, most=10000)
def gltf_images_of_one_file(n, folder):
    doc = document()
    with open(folder + '/i.png', 'wb') as out:
        out.write(png(8, 8))
    doc['images'] = [{'uri': './' * random.randrange(3) + 'i.png'} for i in range(n)]
    doc['textures'] = [{'source': i} for i in range(n)]
    doc['materials'] = [{'normalTexture': {'index': i}} for i in range(n)]
    return gltf(folder + '/a.gltf', doc)


@quantity(*IMAGES, most=10000)
def gltf_images_of_their_own(n, folder):
    doc = document()
    for i in range(n):
        with open('%s/i%d.png' % (folder, i), 'wb') as out:
            out.write(png(1, 1))
    doc['images'] = [{'uri': 'i%d.png' % i} for i in range(n)]
    doc['textures'] = [{'source': i} for i in range(n)]
    doc['materials'] = [{'normalTexture': {'index': i}} for i in range(n)]
    return gltf(folder + '/a.gltf', doc)


@quantity(*IMAGES[:-2])
def gltf_images_missing(n, folder):
    doc = document()
    doc['images'] = [{'uri': 'no/%d.png' % i} for i in range(n)]
    doc['textures'] = [{'source': i} for i in range(n)]
    doc['materials'] = [{'normalTexture': {'index': i}} for i in range(n)]
    return gltf(folder + '/a.gltf', doc)


@quantity(*PLAIN)
def gltf_samplers_and_textures(n, folder):
    doc = document()
    doc['samplers'] = [{'wrapS': random.choice((33071, 33648, 10497))} for i in range(n)]
    doc['textures'] = [{'source': 0, 'sampler': i} for i in range(n)]
    doc['materials'] = [{'normalTexture': {'index': random.randrange(n)}} for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN, '--only=all IN OUT.ply')
def gltf_texture_sets(n, folder):
    doc = document()
    attributes = doc['meshes'][0]['primitives'][0]['attributes']
    attributes |= {'TEXCOORD_%d' % i: 2 for i in range(n)} | {'_X%d' % i: 2 for i in range(n)}
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_attributes_of_their_own(n, folder):
    doc = document()
    doc['accessors'] += [dict(doc['accessors'][2]) for i in range(n)]
    doc['meshes'][0]['primitives'][0]['attributes'] |= {'_X%d' % i: 4 + i for i in range(n)}
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN, '--only=all --morph=keep IN OUT.glb', '--only=all --morph=drop IN OUT.glb', '--only=all --draco=edgebreaker IN OUT.glb')
def gltf_targets(n, folder):
    doc = document()
    primitive = doc['meshes'][0]['primitives'][0]
    primitive['targets'] = [{'POSITION': 0, 'NORMAL': 1}] * n
    doc['meshes'][0]['weights'] = [0] * n
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN, most=10000)
def gltf_targets_of_their_own(n, folder):
    doc = document()
    primitive = doc['meshes'][0]['primitives'][0]
    deltas = b''.join(struct.pack('<9f', *(random.random() for k in range(9))) for i in range(n))
    doc['bufferViews'].append({'buffer': 0, 'byteOffset': len(TRIANGLE), 'byteLength': len(deltas)})
    doc['accessors'] += [dict(doc['accessors'][1], bufferView=4, byteOffset=36 * i) for i in range(n)]
    primitive['targets'] = [{'POSITION': 4 + i} for i in range(n)]
    return glb(folder + '/a.glb', doc, TRIANGLE + deltas)


@quantity(*PLAIN)
def gltf_sparse(n, folder):
    doc = document()
    side = int(math.sqrt(n))
    binary = grid(doc, side)
    count = side * side
    indices, values = struct.pack('<%dI' % count, *range(count)), struct.pack('<2f', 0, 0) * count
    doc['bufferViews'] += [{'buffer': 0, 'byteOffset': len(binary), 'byteLength': len(indices)},
                           {'buffer': 0, 'byteOffset': len(binary) + len(indices), 'byteLength': len(values)}]
    doc['accessors'][2]['sparse'] = {'count': count, 'indices': {'bufferView': 4, 'componentType': 5125},
                                     'values': {'bufferView': 5}}
    return glb(folder + '/a.glb', doc, binary + indices + values)


@quantity(*PLAIN)
def gltf_sparse_accessors(n, folder):
    doc = document()
    sparse = {'count': 1, 'indices': {'bufferView': 3, 'componentType': 5123}, 'values': {'bufferView': 2}}
    one = doc['meshes'][0]['primitives'][0]
    doc['accessors'] += [dict(doc['accessors'][2], sparse=sparse) for i in range(n)]
    doc['meshes'][0]['primitives'] = [dict(one, attributes=dict(one['attributes'], TEXCOORD_0=4 + i)) for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_animations(n, folder):
    doc = document()
    doc['animations'] = [{'channels': [{'sampler': 0, 'target': {'node': 0, 'path': 'translation'}}],
                          'samplers': [{'input': 2, 'output': 0}]}] * n
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_channels(n, folder):
    doc = document()
    doc['animations'] = [{'channels': [{'sampler': i, 'target': {'node': 0, 'path': 'weights'}} for i in range(n)],
                          'samplers': [{'input': 2, 'output': 0}] * n}]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_animated_transforms(n, folder):
    doc = document()
    transform = 'extensions/KHR_texture_transform'
    doc['materials'] = [{'normalTexture': {'index': 0, 'extensions': {'KHR_texture_transform': {'rotation': i}}}}
                        for i in range(n)]
    doc['animations'] = [{'samplers': [], 'channels': [{'sampler': 0, 'target': {'path': 'pointer', 'extensions': {
        'KHR_animation_pointer': {'pointer': '/materials/%d/normalTexture/%s/rotation' % (random.randrange(n), transform)}}}}
        for i in range(n)]}]
    one = doc['meshes'][0]['primitives'][0]
    doc['meshes'][0]['primitives'] = [dict(one, material=i) for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN, '--only=all IN OUT.ply')
def gltf_skins_and_joints(n, folder):
    doc = document()
    doc['nodes'] += [{}] * n
    doc['nodes'][0]['skin'] = 0
    doc['skins'] = [{'joints': list(range(1, n + 1))}] + [{'joints': [1]}] * n
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_cameras_and_lights(n, folder):
    doc = document()
    doc['cameras'] = [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 1}}] * n
    doc['extensions'] = {'KHR_lights_punctual': {'lights': [{'type': 'point'}] * n}}
    doc['nodes'] += [{'camera': i, 'extensions': {'KHR_lights_punctual': {'light': i}}} for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_variants(n, folder):
    doc = document()
    doc['materials'] = [{'normalTexture': {'index': 0}}] * n
    doc['extensions'] = {'KHR_materials_variants': {'variants': [{'name': 'v%d' % i} for i in range(n)]}}
    doc['meshes'][0]['primitives'][0]['extensions'] = {'KHR_materials_variants': {
        'mappings': [{'material': i, 'variants': [i]} for i in range(n)]}}
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_levels_of_detail(n, folder):
    doc = document()
    doc['meshes'][0]['primitives'] *= n
    doc['materials'] = [{'normalTexture': {'index': 0}, 'extensions': {'MSFT_lod': {'ids': list(range(1, n))}}}] + [
        {'normalTexture': {'index': 0}}] * (n - 1)
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_extensions_used(n, folder):
    doc = document()
    doc['extensionsUsed'] = ['X_%d' % i for i in range(n)]
    doc['meshes'][0]['primitives'] *= n
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_unknown_extensions(n, folder):
    doc = document()
    doc['meshes'][0]['primitives'][0]['extensions'] = {'X_%d' % i: {'accessor': i % 4} for i in range(n)}
    doc['extensionsUsed'] = ['X_%d' % i for i in range(n)]
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_features(n, folder):
    doc = document()
    doc['accessors'].append({'componentType': 5126, 'count': 3, 'type': 'SCALAR'})
    doc['meshes'][0]['primitives'][0]['attributes'] |= {'_FEATURE_ID_%d' % i: 4 for i in range(n)}
    doc['meshes'][0]['primitives'][0]['extensions'] = {'EXT_mesh_features': {
        'featureIds': [{'featureCount': 1, 'attribute': i} for i in range(n)]}}
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_instances(n, folder):
    doc = document()
    doc['nodes'] = [{'mesh': 0, 'extensions': {'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': 0}}}}] * n
    doc['scenes'][0]['nodes'] = list(range(n))
    return glb(folder + '/a.glb', doc)


@quantity(*PLAIN)
def gltf_members(n, folder):
    doc = document()
    doc['extras'] = {'k%d' % random.randrange(n): [i, 'x\u20ac"', None] for i in range(n)}
    doc['materials'][0]['extras'] = [{'k%d' % i: 0} for i in range(n)]
    return glb(folder + '/a.glb', doc)


def written_as(folder, material):
    """A glTF whose JSON has this text in place of the key "material"."""
    path = gltf(folder + '/a.gltf', document())
    text = open(path).read()
    with open(path, 'w') as out:
        out.write(text.replace('"material"', material))
    return path


@quantity(*PLAIN, code=3)
def gltf_equal_members(n, folder):
    return written_as(folder, '"x": 1, ' * n + '"material"')


@quantity(*PLAIN)
def gltf_blanks_and_escapes(n, folder):
    return written_as(folder, '"x": "%s"%s, "material"' % ('\\u0041' * n, ' \n\t' * n))


@quantity(*PLAIN, code=3)
def gltf_nesting(n, folder):
    return written_as(folder, '"x": %s%s, "material"' % ('[' * n, ']' * n))


@quantity('IN OUT.glb', '--check --report=r.json IN', '--check --report=r.html IN')
def gltf_long_names(n, folder):
    doc = document()
    doc['meshes'][0]['name'] = 'x' * 30 * n
    doc['materials'][0]['name'] = '<\x1b' * n
    doc['meshes'][0]['primitives'] *= 1000
    return glb(folder + '/a.glb', doc)


@quantity(*MESHES, '--only=all --draco=sequential IN OUT.glb', '--only=all --draco=edgebreaker --verify IN OUT.glb',
          '--only=all --method=robust --precision=short IN OUT.glb', '--only=all --quads=pairs IN OUT.glb')
def gltf_triangles(n, folder):
    doc = document()
    return glb(folder + '/a.glb', doc, grid(doc, int(math.sqrt(n / 2))))


@quantity(*MESHES)
def gltf_windows(n, folder):
    """Primitives with different parts of one index array."""
    doc = document()
    binary = grid(doc, int(math.sqrt(n)))
    one, indices = doc['meshes'][0]['primitives'][0], doc['accessors'][3]
    doc['accessors'] += [dict(indices, byteOffset=24 * i, count=3) for i in range(min(n, indices['count'] // 6))]
    doc['meshes'][0]['primitives'] = [dict(one, indices=4 + i) for i in range(len(doc['accessors']) - 4)]
    return glb(folder + '/a.glb', doc, binary)


@quantity('--only=all IN OUT.glb', '--only=all --draco=off IN OUT.glb', most=10000)
def gltf_draco_blocks(n, folder):
    path = gltf_everything_of_its_own(n, folder)
    subprocess.run([nmtan, '-q', '--only=all', '--draco=sequential', path, folder + '/b.glb'], check=True)
    return folder + '/b.glb'

# ---- OBJ and MTL ----


CORNERS = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n'
FACE = 'f 1/1/1 2/2/1 3/3/1\n'


def obj(folder, text, mtl=None):
    with open(folder + '/a.obj', 'w') as out:
        out.write(('mtllib a.mtl\n' if mtl is not None else '') + text)
    if mtl is not None:
        with open(folder + '/a.mtl', 'w') as out:
            out.write(mtl)
    return folder + '/a.obj'


def lines_of(*lines, face=FACE):
    """A quantity of lines: an OBJ of n of each, between faces."""
    return lambda n, folder: obj(folder, CORNERS + ''.join((line % i if '%' in line else line) + '\n' + face
                                                           for i in range(n) for line in lines))


for name, line in {'objects': 'o x%d', 'groups': 'g x%d y', 'equal_objects': 'o x', 'materials': 'usemtl m%d', 'smoothing': 's %d',
                   'normals': 'vn 0 0 %d.5', 'coordinates': 'vt .%d 1', 'vertices': 'v %d 0 0', 'comments': '# %d',
                   'unknown': 'xyz %d', 'lines': 'l 1 2 3', 'points': 'p 1', 'curves': 'curv 0 1 1 2 3',
                   'long_lines': 'g ' + 'x ' * 100 + '%d', 'libraries': 'mtllib x%d.mtl',
                   'colors': 'v 0 0 0 1 .%d 0', 'mrgb': '#MRGB ff%08x'}.items():
    make = lines_of(line)
    make.__name__ = 'obj_' + name
    quantity(*(MESHES if name in ('objects', 'materials', 'smoothing') else PLAIN))(make)


@quantity(*PLAIN)
def obj_names_of_one_library(n, folder):
    return obj(folder, 'mtllib' + ''.join(' ' + './' * random.randrange(4) + 'a.mtl' for i in range(n)) + '\n' + CORNERS +
               'usemtl m0\n' + FACE, ''.join('newmtl m%d\nmap_Kd x.png\n' % i for i in range(n)))


@quantity(*PLAIN)
def obj_statements_of_one_library(n, folder):
    return obj(folder, ''.join('mtllib %sa.mtl\n' % ('./' * random.randrange(40)) for i in range(n)) + CORNERS +
               'usemtl m0\n' + FACE, ''.join('newmtl m%d\nmap_Kd x.png\n' % i for i in range(n)))


@quantity(*PLAIN, '--only=all --normals=replace-smooth IN OUT.ply')
def obj_polygon(n, folder):
    corners = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(n)]
    return obj(folder, ''.join('v %.9f %.9f 0\nvt %.9f %.9f\n' % (p + p) for p in corners) + 'f ' + ' '.join(
        '%d/%d' % (i + 1, i + 1) for i in range(n)) + '\n')


@quantity(*PLAIN)
def obj_concave_polygon(n, folder):
    corners = [(i, (i * 7919) % 13 + 20 if i < n // 2 else 0) for i in range(n // 2)] + [(i, -1 - i % 2) for i in
                                                                                   range(n // 2, 0, -1)]
    return obj(folder, ''.join('v %d %d 0\nvt %d %d\n' % (p + p) for p in corners) + 'f ' + ' '.join(
        '%d/%d' % (i + 1, i + 1) for i in range(len(corners))) + '\n')


@quantity(*PLAIN)
def obj_continued_line(n, folder):
    return obj(folder, CORNERS + 'g' + ' x\\\n' * n + '\n' + FACE)


@quantity(*MESHES)
def obj_hub(n, folder):
    text = ''.join('v %.9f %.9f 0\nvt %.9f %d\n' % (math.cos(i), math.sin(i), math.cos(i), i % 2) for i in range(n))
    return obj(folder, text + 'v 0 0 0\nvt 0 0\n' + ''.join('f %d/%d %d/%d %d/%d\n' % (
        i + 1, i + 1, (i + 1) % n + 1, (i + 1) % n + 1, n + 1, n + 1) for i in range(n)))


@quantity(*MESHES)
def obj_equal_faces(n, folder):
    return obj(folder, CORNERS + FACE * n)


@quantity(*MESHES)
def obj_random_faces(n, folder):
    text = ''.join('v %g %g %g\nvt %g %g\n' % tuple(random.random() for k in range(5)) for i in range(n // 3))
    pick = lambda: 2 * (random.randint(1, n // 3),)
    return obj(folder, text + ''.join('f %d/%d %d/%d %d/%d\n' % (pick() + pick() + pick()) for i in range(n)))


@quantity(*PLAIN, '--depfile=d --manifest=m --update IN OUT.glb')
def mtl_materials(n, folder):
    return obj(folder, CORNERS + ''.join('usemtl m%d\n' % i + FACE for i in range(n)),
               ''.join('newmtl m%d\nKd 1 0 0\nPr .5\n' % i for i in range(n)))


@quantity(*PLAIN)
def mtl_equal_materials(n, folder):
    return obj(folder, CORNERS + 'usemtl m\n' + FACE, 'newmtl m\nKd 1 0 0\n' * n)


@quantity(*PLAIN)
def mtl_statements(n, folder):
    return obj(folder, CORNERS + 'usemtl m\n' + FACE, 'newmtl m\n' + ''.join(
        'map_Kd a%d.png\nnorm b%d.png\nNs %d\nxyz\ndisp %d.png\n' % (i, i, i, i) for i in range(n)))


@quantity(*PLAIN)
def mtl_map_options(n, folder):
    return obj(folder, CORNERS + 'usemtl m\n' + FACE, 'newmtl m\nmap_Kd ' + '-s 1 1 1 -o 0 0 0 -mm 0 1 ' * n + 'a.png\n')


@quantity(*PLAIN, '--depfile=d --manifest=m --update IN OUT.glb', '--textures=keep IN OUT.gltf')
def mtl_missing_images(n, folder):
    return obj(folder, CORNERS + ''.join('usemtl m%d\n' % i + FACE for i in range(n)),
               ''.join('newmtl m%d\nmap_Kd c%d.png\nnorm sub/n%d.png\nmap_Pr C:\\x\\y\\r%d.png\n' % (i, i, i, i) for i in range(n)))


@quantity(*PLAIN, '--images=embed IN OUT.glb', '--images=copy IN out/o.gltf', '--textures=png IN out/o.gltf', most=10000)
def mtl_images_of_their_own(n, folder):
    for i in range(n):
        with open('%s/c%d.png' % (folder, i), 'wb') as out:
            out.write(png(1, 1, i))
    return obj(folder, CORNERS + ''.join('usemtl m%d\n' % i + FACE for i in range(n)),
               ''.join('newmtl m%d\nmap_Kd c%d.png\n' % (i, i) for i in range(n)))


@quantity(*PLAIN, '--images=embed IN OUT.glb', '--images=copy IN out/o.gltf', '--textures=png IN out/o.gltf')
def mtl_images_of_one_file(n, folder):
    with open(folder + '/c.png', 'wb') as out:
        out.write(png(1, 1))
    return obj(folder, CORNERS + ''.join('usemtl m%d\n' % i + FACE for i in range(n)),
               ''.join('newmtl m%d\nmap_Kd %sc.png\n' % (i, './' * random.randrange(9)) for i in range(n)))


@quantity(*PLAIN)
def mtl_slashes(n, folder):
    return obj(folder, CORNERS + 'usemtl m\n' + FACE, 'newmtl m\nmap_Kd %sc.png\nmap_Ke %s/c.png\n' % ('a/' * n, 'x/../' * n))

# ---- PLY ----


def ply(folder, header, body=b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n', vertices=3, faces=1, form='ascii', more='',
        face='property list uchar int vertex_indices\n'):
    with open(folder + '/a.ply', 'wb') as out:
        out.write(('ply\nformat %s 1.0\n%selement vertex %d\n' % (form, header, vertices) +
                   ''.join('property float %c\n' % c for c in 'xyzst') + more +
                   'element face %d\n%send_header\n' % (faces, face)).encode() + body)
    return folder + '/a.ply'


PLYS = ('IN OUT.glb', 'IN OUT.ply', '--check --report=r.json IN')


@quantity(*PLYS)
def ply_comments(n, folder):
    return ply(folder, ''.join('comment %d\nobj_info %d\n' % (i, i) for i in range(n)))


@quantity(*PLYS)
def ply_textures(n, folder):
    return ply(folder, ''.join('comment TextureFile t%d.png\n' % i for i in range(n)))


@quantity(*PLYS)
def ply_elements(n, folder):
    return ply(folder, ''.join('element x%d 0\nproperty int y\n' % i for i in range(n)))


@quantity(*PLYS)
def ply_properties(n, folder):
    return ply(folder, '', b''.join(b'%d %d 0 %d %d' % (i % 2, i // 2, i % 2, i // 2) + b' 0' * n + b'\n' for i in range(3)) +
               b'3 0 1 2\n', more=''.join('property int p%d\n' % i for i in range(n)))


@quantity(*PLYS)
def ply_face_properties(n, folder):
    return ply(folder, '', b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2' + b' 1 0' * n + b'\n', face=
               'property list uchar int vertex_indices\n' + ''.join('property list uchar int p%d\n' % i for i in range(n)))


@quantity(*PLYS)
def ply_faces(n, folder):
    return ply(folder, '', b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n' + b'3 0 1 2\n' * n, faces=n)


@quantity(*PLYS)
def ply_polygon(n, folder):
    rows = ''.join('%.9f %.9f 0 %.9f 0\n' % (math.cos(6.2831 * i / n), math.sin(6.2831 * i / n), i / n) for i in range(n))
    return ply(folder, '', (rows + '%d ' % n + ' '.join(map(str, range(n))) + '\n').encode(), vertices=n,
               face='property list int int vertex_indices\n')


@quantity(*PLYS)
def ply_wedges(n, folder):
    rows = b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n'
    return ply(folder, '', rows + b''.join(b'3 0 1 2 6 0 0 1 0 0 %d %d\n' % (i, i % 7) for i in range(n)), faces=n, face=
               'property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n')


@quantity(*PLYS)
def ply_binary(n, folder):
    rows = b''.join(struct.pack('<5f', *(random.random() for k in range(5))) for i in range(n))
    faces = b''.join(struct.pack('<BIII', 3, *(random.randrange(n) for k in range(3))) for i in range(n))
    return ply(folder, '', rows + faces, n, n, 'binary_little_endian')

# ---- images ----


def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(width, height, shade=0, before=b'', parts=1):
    row = b'\0' + bytes((128, shade % 256, 255)) * width
    data = zlib.compress(row * height, 9)
    size = max(1, -(-len(data) // parts))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)) + before + b''.join(
        chunk(b'IDAT', data[i:i + size]) for i in range(0, len(data), size)) + chunk(b'IEND', b''))


DECODED = ('--textures=png IN OUT.glb', '--images=embed --textures=png --flip-green=on IN OUT.glb', '--check --check-maps=on IN')


def image(folder, ending, data):
    with open('%s/i.%s' % (folder, ending), 'wb') as out:
        out.write(data)
    return obj(folder, CORNERS + 'usemtl m\n' + FACE, 'newmtl m\nmap_Kd i.%s\nnorm i.%s\n' % (ending, ending))


@quantity(*DECODED)
def png_chunks(n, folder):
    return image(folder, 'png', png(64, 64, before=b''.join(chunk(b'tEXt', b'k\0%d' % i) for i in range(n))))


@quantity(*DECODED)
def png_parts(n, folder):
    noise = bytes(random.randrange(256) for i in range(n))
    return image(folder, 'png', b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', n, 1, 8, 0, 0, 0, 0)) + b''.join(
        chunk(b'IDAT', bytes((b,))) for b in zlib.compress(b'\0' + noise)) + chunk(b'IEND', b''))


@quantity(*DECODED)
def png_rows(n, folder):
    return image(folder, 'png', png(4, n))


@quantity(*DECODED)
def png_columns(n, folder):
    return image(folder, 'png', png(n, 4))


@quantity(*DECODED)
def tga_runs(n, folder):
    return image(folder, 'tga', bytes((0, 0, 10)) + bytes(9) + struct.pack('<HHBB', n % 60000 or 1000, max(1, n // 60000) or 1, 24, 32) +
                 b'\x80\1\2\3' * n)


@quantity(*DECODED)
def jpeg_segments(n, folder):
    first = open(JPEG, 'rb').read()
    return image(folder, 'jpg', first[:2] + b'\xff\xfe\0\4xx' * n + first[2:])


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


@quantity(*DECODED, most=60000)
def tiff_strips(n, folder):
    return image(folder, 'tif', tiff(8, n, [bytes((i % 256,)) * 8 for i in range(n)], []))


@quantity(*DECODED, most=60000)
def tiff_tags(n, folder):
    return image(folder, 'tif', tiff(8, 8, [bytes(64)], [(300 + i, 4, 1, i) for i in range(min(n, 60000))]))


@quantity(*DECODED, most=60000)
def tiff_shared_strips(n, folder):
    """Strips that share their bytes."""
    row = zlib.compress(bytes(256))
    return image(folder, 'tif', tiff(256, n, [row] + [(8, len(row))] * (n - 1), [], 8))

# ---- lists of options and of inputs ----


@quantity('--check --ignore=@LIST IN', '--check --severity=@LEVELS IN', most=10000)
def option_codes(n, folder):
    return obj(folder, CORNERS + FACE)


@quantity('-d out @INPUTS', '--check --report=r.json @INPUTS', '--check --report=r.sarif @INPUTS', '--check --report=pages/ @INPUTS',
          '-d out --files-from=names --depfile=d --manifest=m', '-d out --files-from=names --update',
          '--check --report=r.xml --files-from=names', '-d out --keep-tree=. -r .', '--check -q -r . --exclude=x* --include=*.obj',
          '--dry-run -d out --files-from=names', most=10000)
def option_inputs(n, folder):
    for i in range(n):
        with open('%s/f%d.obj' % (folder, i), 'w') as out:
            out.write(CORNERS + FACE)
    with open(folder + '/names', 'w') as out:
        out.write(''.join('f%d.obj\n' % i for i in range(n)))
    return folder + '/f0.obj'


@quantity('--in-place --files-from=names', most=10000)
def option_in_place(n, folder):
    first = glb(folder + '/a.glb', document())
    for i in range(n):
        shutil.copy(first, '%s/f%d.glb' % (folder, i))
    with open(folder + '/names', 'w') as out:
        out.write(''.join('f%d.glb\n' % i for i in range(n)))
    return first


@quantity('--check --files-from=names', '-d out --files-from=names')
def option_equal_inputs(n, folder):
    obj(folder, CORNERS + FACE)
    with open(folder + '/names', 'w') as out:
        out.write('./' * random.randrange(5) + 'a.obj\n' * n)
    return folder + '/a.obj'


@quantity('-q --check --files-from=names', '-q -d out --files-from=names')
def option_missing_inputs(n, folder):
    with open(folder + '/names', 'w') as out:
        out.write(''.join('no/%d.obj\n' % i for i in range(n)))
    return folder + '/names'


@quantity('--check --baseline=b.json IN', '--check --baseline=b.json --report=r.html IN')
def option_baseline(n, folder):
    path = obj(folder, CORNERS + ''.join('o x%d\n' % i + FACE for i in range(n)))
    subprocess.run([nmtan, '-q', '--check', '--fail-on=never', '--report=b.json', 'a.obj'], cwd=folder, check=True)
    return path


@quantity('--texture-path=@FOLDERS IN OUT.glb', most=1000)
def option_texture_paths(n, folder):
    return mtl_missing_images(n, folder)

# ---- running ----


CODES = 'UV_UNMAPPED', 'UV_MIRROR_SEAM', 'TAN_UNUSED', 'NORMALS_MADE'
JPEG = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../data/colour.jpg')


def words_of(options, n, path, folder):
    words = ['-j2']
    for word in options.split():
        if word == 'IN':
            word = os.path.relpath(path, folder)
        elif word == '@INPUTS':
            words += ['f%d.obj' % i for i in range(n)]
            continue
        elif word.endswith('@LIST'):
            word = word.replace('@LIST', ','.join(CODES * (n // 5)))
        elif word.endswith('@LEVELS'):
            word = word.replace('@LEVELS', ','.join(c + '=info' for c in CODES * (n // 8)))
        elif word.endswith('@FOLDERS'):
            words += [word.replace('@FOLDERS', '.')] * min(n, 32)
            continue
        words.append(word)
    return words


def run(words, folder):
    """Processor time, memory and exit code; below 0: ended by a signal."""
    shutil.rmtree(folder + '/out', ignore_errors=True)
    os.mkdir(folder + '/out')
    if '--baseline=b.json' in words and not os.path.exists(folder + '/b.json'):
        subprocess.run([nmtan, '-q', '--check', '--fail-on=never', '--report=b.json', words[-1]], cwd=folder,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    child = subprocess.Popen([nmtan] + words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL, preexec_fn=lambda: resource.setrlimit(
                                 resource.RLIMIT_CPU, (LIMIT_SECONDS, LIMIT_SECONDS)))
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss << 10, child.returncode


def measure(name, make, options, most, code, failures):
    before, before_n = None, 0
    n = LEAST
    while n <= min(most, MOST):
        with tempfile.TemporaryDirectory() as folder:
            random.seed(int(os.environ.get('NT_SEED', 1)))
            os.mkdir(folder + '/in')
            path = make(n, folder + '/in')
            now = run(words_of(options, n, path, folder + '/in'), folder + '/in')
            if before:
                allowed = [GROWTH * max(b, f) * n * math.log(n) / (before_n * math.log(before_n))
                           for b, f in zip(before, (FLOOR_SECONDS, FLOOR_BYTES))]
                if now[0] > allowed[0]: # others may have had the caches
                    now = min(now, run(words_of(options, n, path, folder + '/in'), folder + '/in'))
        fault = (now[2] < 0 or now[2] in (1, 3, 4, 99)) and now[2] != code and 'ends with %d' % now[2]
        if before and not fault:
            fault = now[0] > allowed[0] and 'takes %.2f s, after %.2f' % (now[0], before[0])
            fault = fault or now[1] > allowed[1] and 'takes %d MB, after %d' % (now[1] >> 20, before[1] >> 20)
        if os.environ.get('NT_SHOW'):
            print('  %s %s: %d: %.2f s, %d MB, %d' % (name, options, n, now[0], now[1] >> 20, now[2]), flush=True)
        if fault:
            failures.append('%s, %s: %d %s' % (name, options, n, fault))
            print('FAILED ' + failures[-1], flush=True)
            return
        before, before_n = now, n
        n *= 10


def main():
    failures, count = [], 0
    words = sys.argv[2:]
    for name, (make, sets, most, code) in quantities.items():
        chosen = [word for word in words if not word.startswith('--')]
        if chosen and not any(word in name for word in chosen):
            continue
        for options in sets:
            if all(word in options for word in words if word.startswith('--')):
                count += 1
                measure(name, make, options, most, code, failures)
    print('%d passed, %d failed' % (count - len(failures), len(failures)))
    sys.exit(len(failures) > 0)


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""counts.py NMTAN [WORD...]: what is counted in inputs, from 1 000 to 100 000 of it, takes n log n time.

Each quantity is a function, or a row of counts.tsv, that writes an input with n of something, and each input is run with several
sets of options.
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
def gltf_everything_of_its_own(n, folder):
    doc = document()
    one, views, accessors = doc['meshes'][0]['primitives'][0], doc['bufferViews'], doc['accessors']
    doc['bufferViews'] = [dict(v, byteOffset=v['byteOffset'] + len(TRIANGLE) * i) for i in range(n) for v in views]
    doc['accessors'] = [dict(a, bufferView=a['bufferView'] + 4 * i) for i in range(n) for a in accessors]
    doc['meshes'] = [{'primitives': [dict(one, attributes={'POSITION': 4 * i, 'NORMAL': 4 * i + 1, 'TEXCOORD_0': 4 * i + 2},
                                          indices=4 * i + 3)]} for i in range(n)]
    doc['nodes'] = [{'mesh': i} for i in range(n)]
    return glb(folder + '/a.glb', doc, TRIANGLE * n)


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


def written_as(folder, material):
    """A glTF whose JSON has this text in place of the key "material"."""
    path = gltf(folder + '/a.gltf', document())
    text = open(path).read()
    with open(path, 'w') as out:
        out.write(text.replace('"material"', material))
    return path


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


# ---- PLY ----


def ply(folder, header, body=b'0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n', vertices=3, faces=1, form='ascii', more='',
        face='property list uchar int vertex_indices\n'):
    with open(folder + '/a.ply', 'wb') as out:
        out.write(('ply\nformat %s 1.0\n%selement vertex %d\n' % (form, header, vertices) +
                   ''.join('property float %c\n' % c for c in 'xyzst') + more +
                   'element face %d\n%send_header\n' % (faces, face)).encode() + body)
    return folder + '/a.ply'


PLYS = ('IN OUT.glb', 'IN OUT.ply', '--check --report=r.json IN')


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


# ---- inputs that a few statements make ----


def from_row(name, statements):
    """Makes the input of a row of counts.tsv. If the statements set no path, the document becomes a GLB."""
    def make(n, folder):
        scope = dict(globals(), n=n, folder=folder, doc=document())
        exec(statements, scope)
        return scope.get('path') or glb(folder + '/a.glb', scope['doc'])
    make.__name__ = name
    globals()[name] = make
    return make


with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'counts.tsv'), encoding='utf-8') as table:
    for row in table:
        if not row.startswith('#'):
            row_name, row_options, row_statements = row.rstrip('\n').split('\t')
            eval('quantity(%s)' % row_options)(from_row(row_name, row_statements))

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

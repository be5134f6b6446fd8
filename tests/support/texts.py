#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""texts.py NMTAN TABLE: small files that a table has as text, and what is said of them or made of them, all in one run.

A row is a sentence (. for that of the row above), a file (. for the one above), a question and its answer. A file is its ending,
"=", and lines with | between them; "@@NAME " and lines behind it are another file beside it, a.png and b.png are there, too. {9*x#} is x0 to x8.
$NAME stands for what a row "$NAME text" gave before. "ply:" is written as text and in both byte orders, its numbers by the types
of its header. Questions are: fails, and the answer is place and message; says, and the answer is what stands in one line; none, and
nothing is to be said; or a Python expression, which is to be equal to the answer: P, N, U, C, T and I are positions, normals,
texture coordinates, colours, tangents and indices of the first primitive p of the output, g is its document, m its first material,
r what that has for roughness and so on, near() rounds to 4 digits, said has lines, out is what is written as PLY.
"""
import os
import re
import struct
import subprocess
import sys

import gltf_lossless as lossless
import images

TYPES = {name: code for names, code in (('char int8', 'b'), ('uchar uint8', 'B'), ('short int16', 'h'), ('ushort uint16', 'H'),
                                        ('int int32', 'i'), ('uint uint32', 'I'), ('float float32', 'f'), ('double float64', 'd'))
         for name in names.split()}
PICTURE = images.png(2, 2, lambda x, y: (128, 128, 255))
ORDERS = {'ascii': None, 'binary_little_endian': '<', 'binary_big_endian': '>'}


def encode(text, order):
    """The same PLY with binary rows."""
    head, body = text.split(b'end_header\n', 1)
    words, out, elements = body.split(), [], []
    for line in head.decode('latin-1').split('\n'):
        if line.startswith('element'):
            elements.append((int(line.split()[2]), []))
        elif line.startswith('property'):
            elements[-1][1].append([TYPES[word] for word in line.split()[1:-1] if word != 'list'])
    at = 0

    def put(code):
        nonlocal at
        word = words[at].decode()
        out.append(struct.pack(ORDERS[order] + code, float(word) if code in 'fd' else int(word)))
        at += 1
        return word
    for count, properties in elements:
        for _ in range(count):
            for codes in properties:
                for _ in range(int(put(codes[0])) if len(codes) == 2 else 1):
                    put(codes[-1])
    return head.replace(b'ascii', order.encode()) + b'end_header\n' + b''.join(out)


def unescape(text):
    return text.replace('|', '\n').encode('latin-1').decode('unicode_escape').encode('latin-1')


def put(folder, name, content):
    os.makedirs('in/' + folder, exist_ok=True)
    with open('in/%s/%s' % (folder, name), 'wb') as out:
        out.write(content)


def read(path):
    """The rows of a table, each with the names of its files, which are written."""
    names, text, name, where = {}, '', '', []
    with open(path, encoding='utf-8') as table:
        for number, line in enumerate(table):
            if line.startswith('$'):
                names.update([line[1:].rstrip('\n').split(' ', 1)])
                continue
            if line.startswith('#') or not line.strip():
                continue
            sentence, file, question, answer = line.rstrip('\n').split('\t')
            name = name if sentence == '.' else sentence
            if file != '.':
                for key in sorted(names, key=len, reverse=True):
                    file = file.replace('$' + key, names[key])
                file = re.sub(r'\{(\d+)\*([^}]*)\}', lambda found: ''.join(
                    found[2].replace('#', str(i)) for i in range(int(found[1]))), file)
                kind, text = re.split('[:=]', file, maxsplit=1)
                text, *others = text.split('@@')
                text = unescape(text)
                where = []
                for order in ORDERS if file.startswith('ply:') else ['ascii']:
                    where.append('%03d%s' % (number, order[7:8]))
                    put(where[-1], where[-1] + '.' + kind, text if order == 'ascii' else encode(text, order))
                    for other in others:
                        other_name, content = other.split(' ', 1)
                        put(where[-1], unescape(other_name).decode(), unescape(content))
                    for image in ('a.png', 'b.png') if others else ():
                        put(where[-1], image, PICTURE)
            yield number + 1, name, [stem + '.' + kind for stem in where], question, answer


def near(rows):
    return [[round(x, 4) for x in row] for row in rows]


def facts(path):
    f = lossless.File(path)
    p = f.g['meshes'][0]['primitives'][0]
    names = {'P': 'POSITION', 'N': 'NORMAL', 'U': 'TEXCOORD_0', 'C': 'COLOR_0', 'T': 'TANGENT'}
    values = {}
    for letter, name in names.items():
        accessor = p['attributes'].get(name)
        values[letter] = [] if accessor is None else [list(value_of(f, accessor, row)) for row in f.rows(accessor)]
    indices = p.get('indices')
    values['I'] = [int.from_bytes(row, 'little') for row in f.rows(indices)] if indices is not None else list(range(len(values['P'])))
    m = f.g['materials'][0]
    r = {'roughnessFactor': 1, 'metallicFactor': 1, 'baseColorFactor': [1, 1, 1, 1]} | m.get('pbrMetallicRoughness', {})
    return dict(values, g=f.g, p=p, m=m, r=r)


def value_of(f, accessor, row):
    a = f.g['accessors'][accessor]
    code = {5120: 'b', 5121: 'B', 5122: 'h', 5123: 'H', 5125: 'I', 5126: 'f'}[a['componentType']]
    most = {'B': 255, 'H': 65535, 'b': 127, 'h': 32767}.get(code) if a.get('normalized') else None
    values = struct.unpack('<%d%s' % (len(row) // struct.calcsize(code), code), row)
    return [value / most for value in values] if most else values


def main():
    nmtan, table = sys.argv[1:3]
    os.makedirs('in')
    rows = list(read(table))
    files = ['in/%s/%s' % (os.path.splitext(file)[0], file) for file in dict.fromkeys(file for row in rows for file in row[2])]
    run = lambda *words: subprocess.run([nmtan, *words, *files], stdin=subprocess.DEVNULL, capture_output=True, check=False)
    said, ends = '', []
    for output in 'glb', 'ply':
        done = run('-v', '--only=all', '--output-format=' + output, '-d', output)
        said += done.stderr.decode('utf-8', 'replace')
        ends.append(done.returncode)
    said = said.split('\n')
    # the worst code of files that are wrong; a sanitizer's is another
    faults = {'both runs end as files that are wrong ask for': [] if ends == [3, 3] else ['# %s' % line for line in [ends] + said[-40:]]}
    for number, name, where, question, answer in rows:
        faults.setdefault(name, [])
        for file in where:
            stem = os.path.splitext(file)[0]
            begin = 'nmtan: in/%s/' % stem
            got = [line[len(begin):].removeprefix(file) for line in said if line.startswith(begin)]
            glb, ply = 'glb/%s.glb' % stem, 'ply/%s.ply' % stem
            if question == 'fails':
                right = any(line.startswith(answer) for line in got) and not os.path.exists(glb)
            elif question == 'says':
                right = any(answer in line for line in got)
            elif not os.path.exists(glb):
                right = False
            elif question == 'none':
                right = not any(re.search(r'\[(?!TAN_NO_UV|REFERENCE_LOST)', line) for line in got)
            else:
                values = dict(near=near, said=got, out=open(ply, 'rb').read() if os.path.exists(ply) else b'', **facts(glb))
                try:
                    got = eval(question, values)
                    right = got == eval(answer, values)
                except (KeyError, IndexError) as error:
                    got, right = repr(error), False
            if not right:
                faults[name].append('# row %d, %s: %s, got %s' % (number, file, question, got))
    for name, list_ in faults.items():
        print('\n'.join(list_ + ['%s - %s' % ('not ok' if list_ else 'ok', name)]))
    print('1..%d' % len(faults))
    return any(faults.values())


if __name__ == '__main__':
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""transcript.py [--update] NMTAN TRANSCRIPT: are reports what the transcript says? In TAP.

A transcript has cases, files and commands. "@@ A SENTENCE" begins a case; behind it is where expected numbers come from.
"=== NAME" begins a file, "$ WORDS" a run of nmtan with these words; behind it is what the run said, standard output and then
standard error, and its exit code unless that is 0. " | page" at the end, or " | page FILE": the data of an HTML page alone,
with the geometry as numbers; " | EXPRESSION" in Python: of r, a JSON report, or of its rows.

A file whose first line begins with "= " is the value of a Python expression; `source` has the files before. A PNG is written
as width, height and what images.py makes pixels of.

A glTF is written as lines: "mesh NAME ATTRIBUTE..." or "primitive ATTRIBUTE..." (POSITION and so on; "material=0" and other
members in JSON), then a line of numbers for each vertex, "f" and indices; "again NAME material=1" with what the primitive
before has; and "json", what the document has besides.
"""
import base64
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
import images  # noqa: E402
import schema  # noqa: E402

WIDTHS = {'POSITION': 3, 'NORMAL': 3, 'TANGENT': 4, 'TEXCOORD_0': 2, 'TEXCOORD_1': 2, 'COLOR_0': 4}


def gltf_of(lines):
    document = {'asset': {'version': '2.0'}, 'accessors': [], 'bufferViews': [], 'meshes': []}
    data, more = bytearray(), {}

    def add(code, kind, component, rows):
        document['bufferViews'].append({'buffer': 0, 'byteOffset': len(data), 'byteLength': 4 * sum(map(len, rows))})
        for row in rows:
            data.extend(struct.pack('<%d%s' % (len(row), code), *row))
        accessor = {'bufferView': len(document['bufferViews']) - 1, 'componentType': component, 'type': kind, 'count': len(rows)}
        if kind == 'VEC3':
            finite = [row for row in rows if all(abs(x) < 1e30 for x in row)] or rows
            accessor.update(min=[min(x) for x in zip(*finite)], max=[max(x) for x in zip(*finite)])
        document['accessors'].append(accessor)
        return len(document['accessors']) - 1

    def end(names, rows, faces, primitive):
        at = 0
        for name in names:
            width = WIDTHS[name]
            kind = 'VEC%d' % width
            primitive['attributes'][name] = add('f', kind, 5126, [row[at:at + width] for row in rows])
            at += width
        if faces:
            primitive['indices'] = add('I', 'SCALAR', 5125, [[i] for i in faces])

    names, rows, faces, primitive = [], [], [], None
    for line in lines + ['primitive']:
        words = line.split()
        if words[0] in ('mesh', 'primitive', 'again'):
            if primitive is not None and rows:
                end(names, rows, faces, primitive)
            before, rows = primitive, []
            if words == ['primitive']:
                break
            if words[0] != 'primitive':
                document['meshes'].append({'name': words.pop(1), 'primitives': []})
            primitive = {'attributes': {}}
            document['meshes'][-1]['primitives'].append(primitive)
            names = [word for word in words[1:] if '=' not in word]
            primitive.update((k, json.loads(v)) for k, v in (word.split('=', 1) for word in words[1:] if '=' in word))
            if words[0] == 'again':
                primitive.update((k, before[k]) for k in ('attributes', 'indices') if k in before)
            faces = []
        elif words[0] == 'f':
            faces += map(int, words[1:])
        elif words[0] == 'json':
            more.update(json.loads(line[5:]))
        else:
            rows.append([float(word) for word in words])
    document['nodes'] = [{'mesh': i} for i in range(len(document['meshes']))]
    document['buffers'] = [{'byteLength': len(data), 'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]
    document.update(more)
    return json.dumps(document)


def numbers_of(head, text):
    """The arrays of a mesh in a page: see src/report/pack/pack.h."""
    raw, arrays, at = zlib.decompress(base64.b64decode(text), -15), [], 0
    sizes = {'corners': 3 * head['triangles'], 'triangles': head['triangles'], 'vertices': head['vertices']}
    kinds = ['triangles', 'corners'] + 13 * ['vertices'] + ['triangles', 'triangles', 'seams', 'ends']
    found = 0
    for kind, planes in zip(kinds, map(int, head['planes'])):
        count = head['seams'] if kind == 'seams' else 4 * found if kind == 'ends' else sizes[kind]
        count = count if planes else 0
        codes, value = [], 0
        for i in range(count):
            code = sum(raw[at + k * count + i] << 8 * k for k in range(planes))
            value = (value + (code >> 1 ^ -(code & 1))) % (1 << 8 * planes)
            codes.append(value)
        at += planes * count
        found = sum(codes) if kind == 'seams' else found
        arrays.append(codes)
    assert at == len(raw), (at, len(raw), head)
    return arrays


def page_of(text):
    text = re.sub('data:image/png;base64,([^"]*)', lambda m: 'data:image/png,%08x' % zlib.adler32(repr(images.rows(
        base64.b64decode(m[1]))).encode()), text)
    said = [re.sub(r'("(meaning|remedy)":"[^"]{0,30})[^"]*', r'\1', re.search('id="data">(.*?)</script>', text, re.S)[1])]
    for head, body in re.findall('id="g-[0-9-]*">({.*?})\n(.*?)</script>', text):
        said += [head] + [' '.join(map(str, codes)) for codes in numbers_of(json.loads(head), body) if codes]
    shown = lambda x: str([(i, x.count(i)) for i in sorted(set(x))])
    return re.sub('"(model|layout)":"([^"]+)"', lambda m: '"%s":%s' % (m[1], shown(zlib.decompress(base64.b64decode(m[2]), -15))),
                  '\n'.join(said)) + '\n'


def write(name, text, source):
    text = text.rstrip('\n') + '\n'
    if text.startswith('= '):
        text = eval(text[2:], {'source': source, 'math': math})
    source[name] = text
    os.makedirs(os.path.dirname(name) or '.', exist_ok=True)
    if name.endswith('.gltf'):
        text = gltf_of(text.rstrip('\n').split('\n'))
    if name.endswith('.png'):
        width, height, pixel = text.split(None, 2)
        names = {'math': math, 'w': int(width), 'h': int(height)}
        text = images.png(int(width), int(height), lambda x, y: eval(pixel, dict(names, x=x, y=y)))
    with open(name, 'wb') as file:
        file.write(text if isinstance(text, bytes) else text.encode('utf-8', 'surrogateescape'))


def faults_of(text):
    """A line for each rule of its schema that a JSON report breaks."""
    faults, document = [], json.loads(text, object_pairs_hook=schema.unique, parse_constant=schema.refuse)
    with open('data/nmtan-%s.schema.json' % document['report'].replace('nmtan-', '').replace('nmtan', 'report')) as file:
        rules = json.load(file)
    schema.check(rules, rules, document, '', faults)
    return ''.join('schema: %s\n' % fault for fault in faults)


def answer(tool, words):
    words, _, part = words.partition(' | ')
    part, _, name = part.partition(' ') if part.startswith('page') else (part, '', '')
    run = subprocess.run([tool] + words.split(), capture_output=True, stdin=subprocess.DEVNULL)
    text, messages = (said.decode('utf-8', 'backslashreplace').replace('\r', '\\r') for said in (run.stdout, run.stderr))
    if text.startswith('{\n\t"report":'):
        messages += faults_of(text)
    if part == 'page':
        text = page_of(open(name, encoding='utf-8').read() if name else text)
    elif part:
        found = eval(part, {'r': json.loads(text) if text.startswith('{\n') else None, 'rows': text.split('\n'), 'json': json})
        text = found if isinstance(found, str) else '\n'.join(json.dumps(row) for row in found)
    text = re.sub(r'nmtan \d+\.\d+\.\d+', 'nmtan VERSION', text) + re.sub(r', \d+\.?\d* m?s$', '', messages, flags=re.M)
    return text + ('' if text.endswith('\n') or not text else '\n') + ('exit code %d\n' % run.returncode if run.returncode else '')


def end_case(case, wrong):
    for line in '\n'.join(wrong).split('\n') if wrong else []:
        print('# ' + line)
    print(('not ok - ' if wrong else 'ok - ') + case, flush=True)


def play(tool, parts):
    """Writes the files and runs the commands; returns the transcript as it is, and how many cases there are."""
    said, source, case, cases, wrong = [], {}, None, 0, []
    for part in parts + ['@@ ']:
        first, _, rest = part.partition('\n')
        if first.startswith('@@ '):
            if case:
                end_case(case, wrong)
            case, cases, wrong = first[3:], cases + bool(first[3:]), []
        elif first.startswith('=== '):
            write(first[4:], rest, source)
        elif first.startswith('$ '):
            try:
                text = answer(tool, first[2:]) + '\n'
            except (LookupError, ValueError, OSError, TypeError, zlib.error) as fault:  # the output is none
                text = repr(fault) + '\n\n'
            if text != rest:
                old, new = rest.split('\n'), text.split('\n')
                at = next(i for i in range(len(old) + 1) if old[i:i + 1] != new[i:i + 1])
                wrong.append('%s\nexpected: %s\ngot:      %s' % (first, ''.join(old[at:at + 1]), ''.join(new[at:at + 1])))
            part = first + '\n' + text
        said.append(part)
    return ''.join(said[:-1]), cases


def main():
    tool, path = map(os.path.abspath, sys.argv[-2:])
    data = os.path.join(os.path.dirname(path), '../../data')
    with open(path, encoding='utf-8', errors='surrogateescape') as file:
        parts = re.split(r'(?m)^(?====|\$ |@@ )', file.read())
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(os.path.abspath(data), os.path.join(folder, 'data'))
        os.chdir(folder)
        said, cases = play(tool, parts)
    if sys.argv[1] == '--update':
        with open(path, 'w', encoding='utf-8', errors='surrogateescape') as file:
            file.write(said)
    print('1..%d' % cases)


main()

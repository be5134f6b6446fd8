#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""oracle.py [--commit=HASH] [--jobs=N] [--only=WORD] FOLDER...: does this tree do what an older one did?

Builds HASH from git in build/oracle, converts every mesh below the folders with both programs and a dozen sets of
options, and compares exit codes, messages (by code and place), reports (field by field) and outputs: their names and bytes,
and where the bytes of a glTF differ, every value. It prints a table of kinds and counts, the first five of each kind, and
fails if a difference is not among those that EXPLAINED names.
"""
import collections
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
import time

# The tree that the house is rebuilt against.
COMMIT = 'b3b08337'
MESHES = ('.obj', '.ply', '.gltf', '.glb', '.drc')
LIMIT = 60

# Name, ending of the output, options. {name} is the name that the output has.
SETS = [
    ('default', '.glb', ''),
    ('all', '.glb', '--only=all --existing=replace'),
    ('repair', '.glb', '--only=all --existing=repair'),
    ('across', '.glb', '--only=all --across=mesh'),
    ('quads', '.glb', '--only=all --existing=replace --quads=pairs'),
    ('draco=off', '.glb', '--only=all --existing=replace --draco=off'),
    ('draco=sequential', '.glb', '--only=all --existing=replace --draco=sequential'),
    ('draco=edgebreaker', '.glb', '--only=all --existing=replace --draco=edgebreaker'),
    ('meshopt=off', '.glb', '--only=all --existing=replace --meshopt=off'),
    ('precision=short', '.glb', '--only=all --existing=replace --precision=short'),
    ('precision=byte', '.glb', '--only=all --existing=replace --precision=byte'),
    ('morph=drop', '.glb', '--only=all --morph=drop'),
    ('weld', '.glb', '--only=all --existing=replace --weld'),
    ('drop', '.glb', '--existing=drop'),
    ('bitangents', '.glb', '--only=all --existing=replace --bitangents'),
    ('gltf', '.gltf', '--only=all --existing=replace'),
    ('embedded', '.gltf', '--only=all --existing=replace --buffers=embed --images=embed'),
    ('copied', '.gltf', '--only=all --images=copy'),
    ('ply', '.ply', '--only=all'),
    ('one thread', '.glb', '--only=all --existing=replace --threads=1'),
    ('four threads', '.glb', '--only=all --existing=replace --threads=4'),
    ('report', '.glb', '--only=all --report=report.json --verify'),
    ('check', None, '--check --fail-on=warning --max-issues=0 --report=report.json'),
]

# Intended changes of a step of the rebuilding: (kind, pattern of "set path detail", why). See "what users lose".
EXPLAINED = [
    ('report', r'/(texel_density|texture_size)\b.*: None -> ', 'an image in a view that an edit moved is found'),
    ('values', r'mesh/uv\.gltf .*/accessors has 5 elements, had 6', 'a TANGENT of two sets goes to the last of them'),
    ('messages', r'cases/implicit_ids/', 'feature ids that are numbers of vertices are told'),
    ('report', r'cases/implicit_ids/', 'feature ids that are numbers of vertices are told'),
    ('values', r'draco=(sequential|edgebreaker) .*KHR_draco_mesh_compression/bufferView: \d+ became',
     'a block takes the number of the view that became free last'),
    ('values', r'/bufferViews/\d+/target: 3496\d became 3496\d', 'a TANGENT of another type takes back the number of its view'),
    ('values', r'weld .*mesh/valid\.gltf .*/accessors has', 'indices that get a new view keep their accessor'),
    ('report', r'could not be verified, since tinygltf refuses', 'what tinygltf refuses is told, whoever is at fault'),
    ('values', r'animation_data/invalid_input_values\.gltf', 'JSON that loses a member is laid out as the document is'),
    ('words', r'cases/animated_uv/', 'what tinygltf refuses is told, whoever is at fault'),
]

TIMES = re.compile(r'\b\d[\d.e-]* (m?s|ms|us|seconds)\b|"(seconds|generator|version)": *[^,}\n]+')


def build(commit):
    commit = subprocess.run(['git', 'rev-parse', commit], capture_output=True, text=True, check=True).stdout.strip()
    folder = os.path.abspath('build/oracle/' + commit)
    program = folder + '/build/release/nmtan'
    if not os.path.exists(program):
        os.makedirs(folder, exist_ok=True)
        tree = subprocess.run(['git', 'archive', commit], capture_output=True, check=True).stdout
        subprocess.run(['tar', '-xf', '-', '-C', folder], input=tree, check=True)
        subprocess.run(['make', '-s', '-C', folder, '-j%d' % (os.cpu_count() or 1), 'config=release', 'all'], check=True)
    return program


def files_below(folder):
    found = {}
    for path, _, names in os.walk(folder):
        for name in names:
            full = os.path.join(path, name)
            with open(full, 'rb') as f:
                found[os.path.relpath(full, folder)] = f.read()
    return found


def run(program, options, source, ending, folder):
    """Exit code, messages, files that are there afterwards."""
    words = [program] + options.split() + ['--'] + [source] + (['out' + ending] if ending else [])
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, timeout=LIMIT)
        code, text = done.returncode, done.stderr.decode('utf-8', 'replace') + done.stdout.decode('utf-8', 'replace')
    except subprocess.TimeoutExpired:
        code, text = 'over %d s' % LIMIT, ''
    return code, TIMES.sub('TIME', text), files_below(folder)


def places(text):
    """Codes, JSON pointers, lines of files and numbers of meshes in messages: what stays if the words change."""
    return collections.Counter(re.findall(r'\b[A-Z]+(?:_[A-Z]+)+\b|/(?:meshes|accessors|bufferViews|buffers|images|nodes|materials)/\d[\w/]*|'
                                          r':\d+:|byte \d+|mesh "[^"]*", primitive \d+', text))


def fields(value, path=''):
    if isinstance(value, dict):
        for key in value:
            yield from fields(value[key], path + '/' + key)
    elif isinstance(value, list):
        yield path + '#', len(value)
        for number, item in enumerate(value):
            yield from fields(item, '%s/%d' % (path, number))
    else:
        yield path, value


def compare_json(old, new):
    a, b = dict(fields(json.loads(old))), dict(fields(json.loads(new)))
    for key in sorted(set(a) | set(b)):
        if a.get(key) != b.get(key) and not re.search(r'seconds|version$', key):
            yield '%s: %r -> %r' % (re.sub(r'\d+', 'N', key), a.get(key), b.get(key))


def compare_outputs(name, old, new, folders):
    if name.endswith(('.gltf', '.glb')):
        paths = [os.path.join(folder, name) for folder in folders]
        done = subprocess.run([sys.executable, '-B', 'tests/support/gltf_lossless.py', paths[0], paths[1], '--tangents=' + paths[0]],
                              capture_output=True, text=True)
        return ('values', (done.stdout + done.stderr).strip()[:300]) if done.returncode else ('layout', 'same values')
    return 'bytes', '%s: %d -> %d bytes' % (name, len(old), len(new))


def compare(job):
    source, (label, ending, options) = job
    found = []
    with tempfile.TemporaryDirectory(prefix='nmtan-oracle-') as folder:
        folders = [os.path.join(folder, which) for which in ('old', 'new')]
        for name in folders:
            os.mkdir(name)
        old, new = (run(program, options, source, ending, name) for program, name in zip(programs, folders))
        if old[0] != new[0]:
            found.append(('exit code', '%s -> %s' % (old[0], new[0])))
        if old[1] != new[1]:
            a, b = places(old[1]), places(new[1])
            found.append(('words', '') if a == b else ('messages', '-%s +%s' % (dict(a - b), dict(b - a))))
        for name in sorted(set(old[2]) | set(new[2])):
            a, b = old[2].get(name), new[2].get(name)
            if a is None or b is None:
                found.append(('names', '%s is %s' % (name, 'new' if a is None else 'gone')))
            elif name == 'report.json':
                found += [('report', text) for text in list(compare_json(a, b))[:5]] if a != b else []
            elif a != b:
                found.append(compare_outputs(name, a, b, folders))
    return [(kind, label, source, text) for kind, text in found]


commit, jobs, only, inputs = COMMIT, os.cpu_count() or 1, '', []
for word in sys.argv[1:]:
    if word.startswith('--commit='):
        commit = word[9:]
    elif word.startswith('--jobs='):
        jobs = int(word[7:])
    elif word.startswith('--only='):
        only = word[7:]
    else:
        for path, _, names in os.walk(word):
            inputs += [os.path.abspath(os.path.join(path, name)) for name in names if name.lower().endswith(MESHES)]
programs = [build(commit), os.path.abspath('build/release/nmtan')]
work = [(source, options) for source in sorted(inputs) for options in SETS if only in options[0]]
began = time.monotonic()
counts, examples, unexplained = collections.Counter(), collections.defaultdict(list), 0
with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
    for result in pool.map(compare, work):
        for kind, label, source, text in result:
            line = '%s %s %s' % (label, source, text)
            why = next((row[2] for row in EXPLAINED if row[0] == kind and re.search(row[1], line)), None)
            kind += ': ' + why if why else ''
            unexplained += not why
            counts[kind] += 1
            if len(examples[kind]) < 5:
                examples[kind].append(line)
for kind, count in counts.most_common():
    print('%7d  %s' % (count, kind))
    for line in examples[kind]:
        print('         ' + line)
print('%d files, %d sets of options, %d pairs of runs in %.0f s beside %s: %d differences, %d unexplained' % (
    len(inputs), len(work) // max(len(inputs), 1), len(work), time.monotonic() - began, commit[:8], sum(counts.values()), unexplained))
sys.exit(bool(unexplained))

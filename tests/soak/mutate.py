#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""mutate.py [--all] ROOM N SEED: which of N random faults in the sources of a room do the tests notice?

A copy of the tree in build/mutate gets all faults that the room's lines can have, in one build: a relation, a constant, a
statement that is gone. Each stands in a conditional beside what it replaces, and NT_FAULT in the environment chooses one
(tests/support/faults.py). The last line counts faults that are left out: they do not fit a conditional, do not compile in
one, or stand in a header. Then each script of the room's subject and each unit test of the room runs without a fault: a
test that fails is left out; of the others a note keeps the seconds, and which faults each executes, for the next seed. A
fault is shown to the tests that execute it, those first that execute it most often in their time, until one notices. With
--all all other tests follow, but those of cost, pages, tree and bindings, and the first scripts again under sanitizers, as
`make check` has both. A change that no test notices is listed with its line, unless its file compiles to the same code with
it. ROOM is a folder of src ("gltf", "report/render"), or "all". The choice follows from SEED alone.
"""
import concurrent.futures
import contextlib
import glob
import hashlib
import json
import math
import os
import random
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from faults import MARKS, file_with_faults, mutations, places_in  # noqa: E402

TREE = os.path.abspath('build/mutate/tree')
B = 'build/release'
JOBS = os.cpu_count() or 1
LIMIT = 300  # seconds for a test that a fault may keep from ending; less if it takes less without

# Tests of a room whose name does not say so.
SUBJECTS = {
    'topology': ['frames', 'quads'], 'tangent': ['frames', 'quads', 'conformance'], 'api': ['frames'],
    'gltf': ['layouts', 'extensions', 'damaged', 'verify', 'convert', 'draco', 'lossless', 'precision', 'meshopt', 'choose',
             'materials', 'normals', 'textures'],
    'json': ['damaged', 'layouts', 'extensions', 'lossless', 'convert'],
    'scene': ['choose', 'colors', 'convert', 'normals', 'report', 'textures', 'origin', 'texts'],
    'file': ['sets', 'output', 'damaged', 'stale', 'update', 'batch', 'textures', 'depfile', 'limits', 'system',
             'memory'],
    'image': ['textures', 'materials', 'limits'],
    'obj': ['texts', 'materials', 'colors', 'convert', 'damaged', 'normals', 'origin', 'report'], 'ply': ['texts', 'convert', 'damaged', 'small_models', 'origin', 'normals'],
    'format': ['convert', 'verdict', 'textures', 'transcript', 'draco'], 'report': ['report', 'check', 'verdict', 'diff', 'report_folder', 'page'],
    'pipeline': ['convert', 'quads', 'normals', 'morphs', 'choose', 'report', 'manifest', 'textures'],
    'batch': ['batch', 'choose', 'update', 'manifest', 'depfile', 'stale', 'limits', 'usage', 'system', 'memory'],
    'cli': ['transcript', 'usage', 'output', 'limits', 'choose', 'manifest', 'batch', 'diff', 'convert', 'verdict', 'manual',
            'update', 'depfile', 'report', 'modules'],
    'ext': ['draco', 'meshopt', 'modules', 'textures', 'verify', 'texts', 'limits', 'memory'],
    'base': ['limits', 'batch', 'texts', 'damaged', 'output', 'manifest', 'report', 'system', 'memory'],
}
# Rooms whose unit tests are those of a room, too.
UNITS = {'topology': ['api'], 'tangent': ['api'], 'ext': ['image'], 'base': ['api']}
LEFT_OUT = re.compile(r'test_cost|test_page|/tree/(?!test_manual)|/bindings/')


def shell(*words):
    return subprocess.run(words, cwd=TREE, capture_output=True, text=True, errors='replace')


def bytes_of(path):
    with open(path, 'rb') as file:
        return file.read()


def write(path, data, mode=0o644):
    """A file that is the same stays, so that nothing is built again."""
    if not os.path.exists(path) or bytes_of(path) != data:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'wb') as file:
            file.write(data)
    os.chmod(path, mode)


def sources():
    """Files of the room."""
    root = os.path.join('src', '' if room == 'all' else room)
    files = subprocess.run(['git', 'ls-files', root], capture_output=True, text=True, check=True).stdout.split()
    return [path for path in sorted(files) if path.endswith(('.c', '.cpp', '.h')) and not path.startswith('src/bindings')]


def copy_tree(names):
    """The tree without the files that build() writes."""
    for folder, _, files in os.walk(TREE):
        for name in files:
            path = os.path.relpath(os.path.join(folder, name), TREE)
            if path not in names and not path.startswith('build/'):
                os.remove(os.path.join(TREE, path))
    for name in names:
        if name in lines_of and not name.endswith('.h'):
            continue
        write(os.path.join(TREE, name), bytes_of(name), os.stat(name).st_mode)
    for name, at in (('../shared', os.path.join(TREE, '../shared')), ('build/node', os.path.join(TREE, 'build/node'))):
        if os.path.isdir(name) and not os.path.lexists(at):
            os.makedirs(os.path.dirname(at), exist_ok=True)
            os.symlink(os.path.abspath(name), at)


def build(names):
    """The tree with all faults of the room that compile; returns them."""
    copy_tree(names)
    targets = ['all', B + '/tests/preload/calls.so', B + '/tests/unit/ext/test_meshopt'] + [p for p in needed if p.startswith(B)]
    targets += [B + '/tests/faults/' + name for name in ('faulty.so', 'make_meshopt')] + ['tests'] * everything
    left_out = set()
    for attempt in range(30):
        table = []
        for path in lines_of:
            if not path.endswith('.h'):  # every file would be compiled anew
                write(os.path.join(TREE, path), file_with_faults(path, lines_of[path], table, left_out).encode())
        made = shell('make', '-s', '-k', '-j%d' % JOBS, *targets)
        if not made.returncode:
            break
        before = len(left_out)
        for path, number, column in set(re.findall(r'^(src/[\w/.-]+):(\d+):(?:(\d+):)? error', made.stderr, re.M)):
            line = bytes_of(os.path.join(TREE, path)).decode().split('#line 1\n')[1].split('\n')[int(number) - 1].expandtabs(8)
            culprits = [int(fault) for fault in re.findall(r'nt_fault\((\d+)\)', line[:int(column or 0)])]
            begins = [fault[4] for fault in table if fault and fault[0] == path and fault[4] < int(number)]
            left_out.add(culprits[-1] if culprits and attempt < 4 else (path, max(begins) if begins and attempt < 20 else -1))
        if before == len(left_out):
            sys.exit('the tree does not build:\n' + made.stderr[-3000:])
    if everything and shell('make', '-s', '-j%d' % JOBS, 'config=sanitize', 'all').returncode:
        sys.exit('the tree does not build with sanitizers')
    return table


def tests_of(path):
    """Scripts of the file's room and subject, those that say most first; unit tests of the room; all others."""
    parts, stem = path.split('/')[1:-1], os.path.basename(path).split('.')[0]
    programs = sorted(p for p in glob.glob('tests/unit/**/test_*.c', recursive=True) + glob.glob('tests/api/test_*.c'))
    programs = [B + '/' + p[:-2] for p in programs]
    scripts = sorted(glob.glob('tests/*/test_*.sh'))
    scripts = [p for p in scripts if not LEFT_OUT.search(p)]
    words = list(dict.fromkeys(SUBJECTS.get(parts[0], []) + stem.split('_')))
    name = lambda p: os.path.basename(p)[5:-3]
    rank = lambda p: min([k for k, word in enumerate(words) if word == name(p) or word in name(p).split('_')], default=99)
    outside = sorted([p for p in scripts if rank(p) < 99], key=rank)
    units = [p for p in programs if re.search(r'tests/(?:unit/)?(\w+)/', p)[1] in [parts[0]] + UNITS.get(parts[0], [])]
    units.sort(key=lambda p: not p.endswith('test_' + stem))
    return outside, units, [p for p in programs + scripts if p not in outside + units]


def end_group(find):
    with contextlib.suppress(OSError, ValueError):  # it has ended
        os.killpg(find(), signal.SIGKILL)


def ask(test, fault=-1, marks=''):
    """Whether the test notices something, and after how many seconds."""
    script, _, sanitized = test.partition(', ')
    built = TREE + '/' + ('build/sanitize' if sanitized else B)
    limit = min(LIMIT, 10 + 5 * seconds.get(script, LIMIT)) * (4 if sanitized else 1)
    with tempfile.TemporaryDirectory(prefix='nmtan-mutate-', ignore_cleanup_errors=True) as folder:
        more = dict(os.environ, CMOCKA_MESSAGE_OUTPUT='TAP', NMTAN=built + '/nmtan', BUILD=built, ROOT=TREE, WORK=folder,
                    NT_STOP='1', NT_FAULT=str(fault), NT_MARKS=marks)
        begin = time.monotonic()
        with open(os.path.join(folder, '.said'), 'w+', errors='replace') as said:
            run = subprocess.Popen(['bash', script] if script.endswith('.sh') else [script], cwd=TREE, env=more,
                                   stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.DEVNULL, start_new_session=True)
            with contextlib.suppress(subprocess.TimeoutExpired):
                run.wait(limit)
            took = time.monotonic() - begin
            end_group(lambda: run.pid)
            for server in glob.glob(folder + '/.ask/*/pid'):  # which `ask` in cli.sh began
                end_group(lambda: int(bytes_of(server)))
            run.wait()
            said.seek(0)
            text = said.read()
        subprocess.run(['chmod', '-R', 'u+rwX', folder])
        return run.returncode != 0 or bool(re.search('^not ok(?!.*# SKIP)', text, re.M)), took


def ask_usual(test):
    """How a test does without a fault: whether it fails, its seconds, and how often it executes each fault."""
    with tempfile.NamedTemporaryFile() as marks:
        marks.truncate(MARKS)
        os.chmod(marks.name, 0o666)  # some run the tool as nobody
        failed, took = ask(test, marks=marks.name)
        times = {fault: n for fault, n in enumerate(bytes_of(marks.name)) if n}
    print(test + (' FAILS without a fault, and is left out' if failed else ': %.1f s, %d faults' % (took, len(times))), flush=True)
    return test, (failed, took, times)


def kept(names):
    """The faults in the binary and how tests do without one: of now, or of an earlier run over the same tree."""
    note, key = TREE + '/../faults.json', hashlib.sha256(repr((room, everything)).encode())
    for name in names:
        key.update(name.encode() + b'\0' + bytes_of(name))
    if os.path.exists(note) and json.loads(bytes_of(note))['key'] == key.hexdigest():
        return json.loads(bytes_of(note), object_hook=lambda x: {int(k) if k.isdigit() else k: v for k, v in x.items()})
    if os.path.exists(note):
        os.remove(note)
    table = build(names)
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        found = {'key': key.hexdigest(), 'table': table, 'usual': dict(pool.map(ask_usual, needed))}
    write(note, json.dumps(found).encode())
    return found


def same_code(path, number, new):
    """Whether the file compiles to the same code with a fault as without."""
    command = shell('make', '-nB', 'V=1', '%s/%s.o' % (B, path[4:])).stdout
    command = re.search(r'^(\S.*) -c -o \S+ \S+$', command.replace('\\\n', ' '), re.M)
    if not command:
        return False
    lines, objects = lines_of[path], []
    for text in (lines, lines[:number] + [new] + lines[number + 1:]):
        with tempfile.TemporaryDirectory() as folder:
            words = shlex.split(command[1]) + ['-g0', '-c', '-iquote', os.path.dirname(path), '-o', folder + '/x.o', '-x',
                                               'c++' if path.endswith('.cpp') else 'c', '-']
            made = subprocess.run(words, input='\n'.join(text), capture_output=True, text=True)
            objects.append(bytes_of(folder + '/x.o') if not made.returncode else b'%d' % len(objects))
    return objects[0] == objects[1]


def who_notices(fault):
    """The first test that notices a fault, '' if none does, None if it compiles to the same code."""
    path, number, _, new = table[fault][:4]
    executes = lambda p: p in usual and not usual[p][0] and fault in usual[p][2]
    outside, units, others = [list(filter(executes, tests)) for tests in tests_of(path)]
    cost = lambda p: usual[p][1] / math.log2(2 + usual[p][2][fault])
    tests = sorted(outside + units, key=cost)
    if everything:
        tests += sorted(others, key=cost) + [p + ', sanitized' for p in sorted(outside, key=cost) if 'meshopt' not in p][:4]
    seen = next((test for test in tests if ask(test, fault)[0]), '')
    return None if not seen and same_code(path, number, new) else seen


everything = '--all' in sys.argv
room, count, seed = [int(word) if word.isdigit() else word for word in sys.argv[1:] if word != '--all']
names = subprocess.run(['git', 'ls-files', '-z'], capture_output=True, check=True, text=True).stdout.split('\0')[:-1]
names = [name for name in names if os.path.isfile(name)]
lines_of = {path: bytes_of(path).decode().split('\n') for path in sources()}
places = [(path, number) for path in lines_of for number in places_in(lines_of[path])]
needed = sorted({test for path in lines_of for tests in tests_of(path)[:3 if everything else 2] for test in tests})
seconds = {}  # of each test without a fault
found = kept(names)
table, usual = found['table'], found['usual']
seconds = {test: of[1] for test, of in usual.items()}
number_of = {tuple(fault[:4]): number for number, fault in enumerate(table) if fault}
of_room = sum(len(mutations(lines_of[path][number])) for path, number in places)
chance = random.Random(seed)
asked, tried, by_units, survivors, begin = set(), 0, 0, [], time.monotonic()
with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
    while tried < count and len(asked) < len(number_of):
        batch = []
        while len(batch) < count - tried and len(asked) < len(number_of):
            path, number = chance.choice(places)
            fault = number_of.get((path, number) + chance.choice(mutations(lines_of[path][number])))
            if fault is not None and fault not in asked:
                batch.append(fault)
                asked.add(fault)
        for fault, seen in zip(batch, pool.map(who_notices, batch)):
            path, number, kind, new, _ = table[fault]
            where = '%s:%d %s: `%s` -> `%s`' % (path, number + 1, kind, lines_of[path][number].strip(), new.strip())
            print('%s  %s' % ('same code' if seen is None else seen or 'SURVIVES', where), flush=True)
            tried += seen is not None
            by_units += bool(seen) and not seen.split(',')[0].endswith('.sh')
            if seen == '':
                survivors.append(where + ('' if any(fault in of[2] for of in usual.values()) else ', which no test executes'))
print('\nNo test notices:\n  ' + '\n  '.join(survivors) if survivors else '')
print('%s, seed %d: %d of %d noticed, %.0f %%, %d of them by unit tests, in %.0f s; ' % (
    room, seed, tried - len(survivors), tried, 100 - 100 * len(survivors) / max(tried, 1), by_units, time.monotonic() - begin)
    + "%d of the room's %d faults are not in the binary" % (of_room - len(number_of), of_room))

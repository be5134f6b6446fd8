#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""mutate.py [--all] ROOM N SEED: which of N random faults in the sources of a room do the tests notice?

A copy of the tree in build/mutate gets one fault at a time: a relation, a constant, a statement that is gone. First the
scripts of the file's room and subject run, which see the tool from outside and outlive a room that is written anew (the unit
tests of the room, which take seconds, before those that take longest). With --all then all others, but those of cost, pages,
tree and bindings, and the first scripts again under sanitizers, as `make check` has both. A change that no test notices is
listed with its line. A fault that does not compile, or that compiles to the same code, does not count. Scripts that do not
execute the line (gcov says it, of a build of the tree without faults) are passed over; of the others those come first that
execute it most often in their time. A note keeps how the tests do without a fault for the next seed. ROOM is a folder of
src ("gltf", "report/render"), or "all". The choice follows from SEED alone.
"""
import concurrent.futures
import glob
import json
import math
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

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
    'file': ['sets', 'output', 'placement', 'damaged', 'stale'],
    'image': ['textures', 'materials', 'limits'],
    'obj': ['texts', 'materials', 'colors', 'convert', 'damaged', 'normals', 'origin'], 'ply': ['texts', 'convert', 'damaged', 'small_models'],
    'format': ['convert', 'verdict', 'textures'], 'report': ['report', 'check', 'verdict', 'diff', 'report_folder', 'page'],
    'pipeline': ['convert', 'quads', 'normals', 'morphs', 'choose', 'report', 'manifest', 'textures'],
    'batch': ['batch', 'update', 'manifest', 'depfile', 'placement'],
    'cli': ['usage', 'output', 'limits', 'choose', 'manifest', 'batch', 'diff', 'convert', 'verdict'],
    'ext': ['draco', 'meshopt', 'modules', 'textures', 'verify'], 'base': ['limits', 'batch'],
}
LEFT_OUT = re.compile(r'test_cost|test_page|/tree/|/bindings/')


QUICK = 5  # scripts before the unit tests


def shell(*words, **more):
    return subprocess.run(words, cwd=TREE, capture_output=True, text=True, errors='replace', **more)


def bytes_of(path):
    with open(path, 'rb') as file:
        return file.read()


def copy_tree():
    """Files that are the same stay, so that they are not built again."""
    names = subprocess.run(['git', 'ls-files', '-z'], capture_output=True, check=True, text=True).stdout.split('\0')[:-1]
    names = [name for name in names if os.path.isfile(name)]
    for folder, _, files in os.walk(TREE):
        for name in files:
            path = os.path.relpath(os.path.join(folder, name), TREE)
            if path not in names and not path.startswith('build/'):
                os.remove(os.path.join(TREE, path))
    for name in names:
        path = os.path.join(TREE, name)
        if not os.path.exists(path) or bytes_of(path) != bytes_of(name):
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, 'wb') as file:
                file.write(bytes_of(name))
            os.chmod(path, os.stat(name).st_mode)
    for name, at in (('../shared', os.path.join(TREE, '../shared')), ('build/node', os.path.join(TREE, 'build/node'))):
        if os.path.isdir(name) and not os.path.lexists(at):
            os.makedirs(os.path.dirname(at), exist_ok=True)
            os.symlink(os.path.abspath(name), at)


def quoted(line):
    """For each character whether it stands in a string, a character or a comment."""
    marks, at, inside = [], 0, ''
    while at < len(line):
        c = line[at]
        if not inside and (line.startswith('//', at) or line.startswith('/*', at)):
            return marks + [True] * (len(line) - at)
        if inside and c == '\\':
            marks += [True, True]
            at += 2
            continue
        if c in '"\'' and (not inside or inside == c):
            inside = '' if inside else c
            marks.append(True)
        else:
            marks.append(bool(inside))
        at += 1
    return marks[:len(line)]


SWAPS = [('relational', ' < ', ' <= '), ('relational', ' <= ', ' < '), ('relational', ' > ', ' >= '),
         ('relational', ' >= ', ' > '), ('equality', ' == ', ' != '), ('equality', ' != ', ' == '),
         ('logic', ' && ', ' || '), ('logic', ' || ', ' && '), ('arith', ' + ', ' - '), ('arith', ' - ', ' + '),
         ('arith', ' * ', ' + '), ('arith', ' += ', ' -= '), ('return', 'return true;', 'return false;'),
         ('return', 'return false;', 'return true;')]
STATEMENT = re.compile(r'^(\t+)(?!return|break|continue|goto|case|default|const |static |else|if|for|while|struct |enum )'
                       r'(\*?[a-z_][\w.\[\]>-]*( [-+|&*/^]?= .+|\(.*\)|(\+\+|--)));$')
CHECK = re.compile(r'^(\t+(?:\} else )?(?:else )?if \()(.+)(\)( \{)?)$')
CALL = re.compile(r'(\b[a-z_]\w*\()([a-z_][\w.>\[\]-]*), ([a-z_][\w.>\[\]-]*)(?=[,)])')
BIT_FIELD = re.compile(r'^\t[\w ]+ : \d+;')
NUMBER = re.compile(r'(?<![\w.])(\d+)(?![\w.])')


def mutations(line):
    """All faults that the line can get: (kind, the line with it)."""
    found, text = [], quoted(line)
    for kind, old, new in SWAPS:
        for match in re.finditer(re.escape(old), line):
            if not any(text[match.start():match.end()]):
                found.append((kind, line[:match.start()] + new + line[match.end():]))
    for match in NUMBER.finditer(line):
        if not text[match.start()]:
            found.append(('constant', '%s%d%s' % (line[:match.start()], int(match[1]) + 1, line[match.end():])))
    match = CHECK.match(line)
    if match and match[2].count('(') == match[2].count(')'):
        found.append(('skip check', '%s(%s) && 0%s' % match.group(1, 2, 3)))
    if STATEMENT.match(line) and line.count('(') == line.count(')'):
        found.append(('delete', STATEMENT.match(line)[1] + ';'))
    for match in CALL.finditer(line):
        if not text[match.start()] and match[2] != match[3]:
            found.append(('swap args', line[:match.start()] + '%s%s, %s' % match.group(1, 3, 2) + line[match.end():]))
    return found


def places(room):
    """(file, line number) of what may get a fault: code within functions, not declarations, comments, preprocessor."""
    root = os.path.join('src', '' if room == 'all' else room)
    files = subprocess.run(['git', 'ls-files', root], capture_output=True, text=True, check=True).stdout.split()
    for path in sorted(files):
        if not path.endswith(('.c', '.cpp', '.h')) or path.startswith('src/bindings'):
            continue
        comment = False
        for number, line in enumerate(open(os.path.join(TREE, path), encoding='utf-8').read().split('\n')):
            if comment or line.lstrip().startswith(('/*', '*')):
                comment = '*/' not in line
            elif line.startswith('\t') and not BIT_FIELD.match(line) and mutations(line):
                yield path, number


def tests_of(path):
    """Scripts of the file's room and subject, those that say most first; unit tests of the room; all others."""
    parts, stem = path.split('/')[1:-1], os.path.basename(path).split('.')[0]
    programs = sorted(p for p in glob.glob(TREE + '/tests/unit/**/test_*.c', recursive=True) + glob.glob(TREE + '/tests/api/test_*.c'))
    programs = [B + p[len(TREE):-2] for p in programs]
    scripts = [p[len(TREE) + 1:] for p in sorted(glob.glob(TREE + '/tests/*/test_*.sh'))]
    scripts = [p for p in scripts if not LEFT_OUT.search(p)]
    words = list(dict.fromkeys(SUBJECTS.get(parts[0], []) + stem.split('_')))
    name = lambda p: os.path.basename(p)[5:-3]
    rank = lambda p: min([k for k, word in enumerate(words) if word == name(p) or word in name(p).split('_')], default=99)
    outside = sorted([p for p in scripts if rank(p) < 99], key=rank)
    units = [p for p in programs if '/unit/%s/' % parts[0] in p or '/api/' in p and parts[0] in ('topology', 'tangent', 'api')]
    units.sort(key=lambda p: not p.endswith('test_' + stem))
    return outside, units, [p for p in programs + scripts if p not in outside + units]


def fails(test, stopped=None, build=B, prefix=''):
    """Whether the test notices something."""
    with tempfile.TemporaryDirectory(prefix='nmtan-mutate-', ignore_cleanup_errors=True) as folder:
        more = dict(os.environ, CMOCKA_MESSAGE_OUTPUT='TAP', NMTAN='%s/%s/nmtan' % (TREE, build), BUILD='%s/%s' % (TREE, build),
                    ROOT=TREE, WORK=folder, NT_STOP='1', GCOV_PREFIX=prefix)
        words = ['bash', test] if test.endswith('.sh') else [test]
        begin = time.monotonic()
        with open(os.path.join(folder, '.said'), 'w+', errors='replace') as said:
            run = subprocess.Popen(words, cwd=TREE, env=more, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.DEVNULL,
                                   start_new_session=True)
            while run.poll() is None:
                if stopped and stopped.is_set() or time.monotonic() - begin > min(LIMIT, 20 + 5 * seconds.get(test, LIMIT)):
                    os.killpg(run.pid, signal.SIGKILL)
                    run.wait()
                    for server in glob.glob(folder + '/.ask/*/pid'):  # which `ask` in cli.sh began
                        os.killpg(int(bytes_of(server)), signal.SIGKILL)
                    break
                time.sleep(0.02)
            said.seek(0)
            text = said.read()
        seconds.setdefault(test, time.monotonic() - begin)
        subprocess.run(['chmod', '-R', 'u+rwX', folder])
        return run.returncode != 0 or bool(re.search('^not ok(?!.*# SKIP)', text, re.M))


def first_that_fails(tests):
    stopped, found = threading.Event(), []

    def attempt(test):
        if not stopped.is_set() and fails(test, stopped) and not stopped.is_set():
            stopped.set()
            found.append(test)
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        list(pool.map(attempt, tests))
    return found[0] if found else None


def lines_of(room):
    """Lines of the room with code, and those that the tests before this executed: [path][line] -> times."""
    found = {}
    for name in glob.glob('%s/build/debug/%s/**/*.gcda' % (TREE, room), recursive=True):
        for file in json.loads(shell('gcov', '-i', '-t', name).stdout or '{"files": []}')['files']:
            lines = found.setdefault(file['file'], {})
            for line in file['lines']:
                lines[line['line_number']] = lines.get(line['line_number'], 0) + line['count']
        os.remove(name)
    return found


def kept(name, find):
    """Asks find() about the tree without a fault, or takes the note of an earlier run over the same tree."""
    note = os.path.join(TREE, '../%s.json' % name)
    key = shell('sh', '-c', 'cat src/*/*.[ch] src/*/*/*.[ch] tests/cli/* tests/support/* tests/unit/*/*.c tests/unit/*/*/*.c | '
                'sha256sum').stdout + room
    if os.path.exists(note) and json.loads(bytes_of(note))['key'] == key:
        return json.loads(bytes_of(note))['found']
    found = find()
    with open(note, 'w', encoding='utf-8') as file:
        json.dump({'key': key, 'found': found}, file)
    return found


def find_reached(room, scripts):
    """[script][path] -> lines that it executes."""
    shell('make', '-s', '-j%d' % JOBS, 'config=debug', 'CFLAGS=--coverage', 'LDFLAGS=--coverage', 'all',
          'build/debug/tests/preload/calls.so', 'build/debug/tests/unit/ext/test_meshopt')
    reached = {}
    for script in scripts:
        with tempfile.TemporaryDirectory() as prefix:
            fails(script, build='build/debug', prefix=prefix)
            top = prefix + TREE + '/build/debug/'
            for folder, _, files in os.walk(top):
                for name in files:
                    path = os.path.relpath(os.path.join(folder, name), top)
                    if path.startswith(room):
                        os.replace(os.path.join(folder, name), os.path.join(TREE, 'build/debug', path))
        lines = {path: sorted(lines.items()) for path, lines in lines_of(room).items()}
        executed = sum(bool(n) for x in lines.values() for _, n in x)
        if executed:  # else it was not asked
            reached[script] = lines
        print('%s executes %d lines' % (script, executed), flush=True)
    return reached


def find_usual(tests):
    """Tests that fail without a fault, and the seconds that each takes."""
    seconds.clear()
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        failing = [test for test, failed in zip(tests, pool.map(fails, tests)) if failed]
    return failing, seconds


def executions(script, path, number):
    """How often a script executes a line, or the one on which its statement begins."""
    before = [(line, times) for line, times in reached.get(script, {}).get(path, []) if line <= number]
    return 1 if script not in reached else before[-1][1] if before else 0


def scripts_for(outside, path, number):
    """Scripts that execute the line, those first that are most likely to notice it soon."""
    times = {script: executions(script, path, number) for script in outside}
    cost = lambda script: seconds.get(script, LIMIT) / math.log2(2 + times[script])
    return sorted([script for script in outside if times[script]], key=cost)


def make(*targets):
    return shell('make', '-s', '-j%d' % JOBS, *targets).returncode == 0


def built_code():
    """A sum of what is built, without the columns that -g1 notes."""
    return shell('sh', '-c', 'for f in %s/*.so %s/nmtan; do objcopy -S "$f" build/stripped && cat build/stripped; done | sha256sum'
                 % (B, B)).stdout


def try_one(path, number):
    """Which test notices the fault, and whether it is one from outside."""
    outside, units, others = [[p for p in tests if p not in ignored] for tests in tests_of(path)]
    if not make('all'):
        return 'does not compile', False
    if built_code() == usual:
        return 'same code', False
    outside = scripts_for(outside, path, number + 1)
    seen = first_that_fails(outside[:QUICK])
    if seen:
        return seen, True
    if not make(*units):
        return 'does not compile', False
    seen = first_that_fails(units)
    if seen:
        return seen, False
    seen = first_that_fails(outside[QUICK:])
    if seen or not everything:
        return seen, bool(seen)
    if not make('all', 'tests'):
        return 'does not compile', False
    seen = first_that_fails(others)
    if seen:
        return seen, seen.endswith('.sh')
    if not make('config=sanitize', 'all'):
        return 'does not compile', False
    scripts = [p for p in outside if 'meshopt' not in p][:4]
    seen = next(('%s, sanitized' % p for p in scripts if fails(p, build='build/sanitize')), None)
    return seen, bool(seen)


everything = '--all' in sys.argv
sys.argv = [word for word in sys.argv if word != '--all']
room, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
seconds = {}  # of each test without a fault
copy_tree()
sample = tests_of('src/%s/x.c' % ('gltf' if room == 'all' else room))
needed = sum(sample[:3 if everything else 2], [])
if not make('all', *(['tests'] if everything else sample[1] + [B + '/tests/preload/calls.so', B + '/tests/unit/ext/test_meshopt'])):
    sys.exit('the tree does not build')
reached = kept('reached', lambda: find_reached('' if room == 'all' else room, sample[0]))
ignored, seconds = kept('usual', lambda: find_usual(needed))
for test in sorted(ignored):
    print('fails without a fault, and is left out: ' + test)
usual = built_code()
choices = list(places(room))
chance = random.Random(seed)
noticed = from_outside = tried = 0
survivors = []
while tried < count:
    path, number = chance.choice(choices)
    full = os.path.join(TREE, path)
    text = open(full, encoding='utf-8').read()
    lines = text.split('\n')
    kind, new = chance.choice(mutations(lines[number]))
    old, lines[number] = lines[number], new
    open(full, 'w', encoding='utf-8').write('\n'.join(lines))
    try:
        seen, outside = try_one(path, number)
    finally:
        open(full, 'w', encoding='utf-8').write(text)
    where = '%s:%d %s: `%s` -> `%s`' % (path, number + 1, kind, old.strip(), new.strip())
    if seen not in ('does not compile', 'same code'):
        tried += 1
        noticed += bool(seen)
        from_outside += outside
        if not seen:
            survivors.append(where)
    print('%s  %s' % (seen or 'SURVIVES', where), flush=True)
print('\nNo test notices:\n  ' + '\n  '.join(survivors) if survivors else '')
print('%s, seed %d: %d of %d noticed, %.0f %%; %d of them from outside, %.0f %%' % (
    room, seed, noticed, tried, 100 * noticed / max(tried, 1), from_outside, 100 * from_outside / max(tried, 1)))

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""mutate.py ROOM N SEED: which of N random faults in the sources of a room do the tests notice?

A copy of the tree in build/mutate gets one fault at a time: a relation, a constant, a statement that is gone. First the
tests of the file's room and subject run, then all others but those of cost, pages, tree and bindings. A change that
no test notices is listed with its line. A fault that does not compile, or that compiles to the same code, does not
count. ROOM is a folder of src ("gltf", "report/render"), or "all". The choice follows from SEED alone.
"""
import concurrent.futures
import glob
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

TREE = os.path.abspath('build/mutate/tree')
B = 'build/release'
JOBS = os.cpu_count() or 1
LIMIT = 120  # seconds for a test that a fault may keep from ending

# Tests of a room whose name does not say so.
SUBJECTS = {
    'topology': ['frames', 'quads'], 'tangent': ['frames', 'quads', 'conformance'], 'api': ['frames'],
    'gltf': ['lossless', 'convert', 'morphs', 'extensions', 'draco', 'meshopt', 'precision', 'verify', 'validator', 'sets', 'damaged'],
    'json': ['lossless', 'damaged', 'extensions'], 'scene': ['choose', 'colors', 'convert', 'normals'],
    'file': ['sets', 'output', 'placement', 'damaged', 'stale'], 'image': ['textures', 'materials'],
    'obj': ['materials', 'colors', 'convert', 'damaged', 'normals'], 'ply': ['convert', 'damaged', 'small_models'],
    'format': ['convert', 'verdict', 'textures'], 'report': ['report', 'check', 'verdict', 'diff', 'report_folder', 'page'],
    'pipeline': ['convert', 'quads', 'normals', 'morphs', 'choose', 'report', 'manifest', 'textures'],
    'batch': ['batch', 'update', 'manifest', 'depfile', 'placement'], 'cli': ['usage', 'output', 'limits', 'choose'],
    'ext': ['draco', 'meshopt', 'modules', 'textures', 'verify'], 'base': ['limits', 'batch'],
}
LEFT_OUT = re.compile(r'test_cost|test_page|/tree/|/bindings/')


def shell(*words, **more):
    return subprocess.run(words, cwd=TREE, capture_output=True, text=True, errors='replace', **more)


def copy_tree():
    shutil.rmtree(TREE, ignore_errors=True)
    os.makedirs(TREE)
    files = subprocess.run(['git', 'ls-files', '-z'], capture_output=True, check=True).stdout
    archive = subprocess.run(['tar', '--null', '-T', '-', '-cf', '-'], input=files, capture_output=True, check=True).stdout
    subprocess.run(['tar', '-xf', '-', '-C', TREE], input=archive, check=True)
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
    """Programs and scripts of the file's room and subject; then all others."""
    parts, stem = path.split('/')[1:-1], os.path.basename(path).split('.')[0]
    programs = sorted(p for p in glob.glob(TREE + '/tests/unit/**/test_*.c', recursive=True) + glob.glob(TREE + '/tests/api/test_*.c'))
    programs = [B + p[len(TREE):-2] for p in programs]
    scripts = [p[len(TREE) + 1:] for p in sorted(glob.glob(TREE + '/tests/*/test_*.sh')) if not LEFT_OUT.search(p)]
    words = SUBJECTS.get(parts[0], []) + stem.split('_')
    near = [p for p in programs if '/unit/%s/' % parts[0] in p or '/api/' in p and parts[0] in ('topology', 'tangent', 'api')]
    near.sort(key=lambda p: not p.endswith('test_' + stem))
    near += [p for p in scripts if any(word in os.path.basename(p)[5:-3].split('_') for word in words) or
             os.path.basename(p)[5:-3] in words]
    return near, [p for p in programs + scripts if p not in near]


def fails(test):
    """Whether the test notices something."""
    with tempfile.TemporaryDirectory(prefix='nmtan-mutate-') as folder:
        more = dict(os.environ, CMOCKA_MESSAGE_OUTPUT='TAP', NMTAN='%s/%s/nmtan' % (TREE, B), BUILD='%s/%s' % (TREE, B),
                    ROOT=TREE, WORK=folder)
        words = ['bash', test] if test.endswith('.sh') else [test]
        try:
            done = shell('timeout', '-k', '5', str(LIMIT if test.endswith('.sh') else 60), *words, env=more,
                         stdin=subprocess.DEVNULL)
        finally:
            subprocess.run(['chmod', '-R', 'u+rwX', folder])
        return done.returncode != 0 or bool(re.search('^not ok(?!.*# SKIP)', done.stdout, re.M))


def first_that_fails(tests):
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        waiting = {pool.submit(fails, test): test for test in tests}
        for done in concurrent.futures.as_completed(waiting):
            if done.result():
                for other in waiting:
                    other.cancel()
                return waiting[done]
    return None


def make(*targets):
    return shell('make', '-s', '-j%d' % JOBS, *targets).returncode == 0


def code_of(path):
    return shell('sh', '-c', 'cat %s/*.so %s/nmtan %s/libnmtan.so | sha256sum' % (B, B, B)).stdout


def try_one(path, number, kind, new):
    near, others = tests_of(path)
    quick = [p for p in near if not p.endswith('.sh')]
    if not make('all', *quick):
        return 'does not compile'
    if code_of(path) == usual:
        return 'same code'
    seen = first_that_fails(quick) or first_that_fails([p for p in near if p.endswith('.sh')])
    if not seen:
        if not make('all', 'tests'):
            return 'does not compile'
        seen = first_that_fails([p for p in others if p not in ignored])
    return seen


room, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
copy_tree()
if not make('all', 'tests'):
    sys.exit('the tree does not build')
everything = sum(tests_of('src/%s/x.c' % ('gltf' if room == 'all' else room)), [])
with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
    ignored = {test for test, failed in zip(everything, pool.map(fails, everything)) if failed}
for test in sorted(ignored):
    print('fails without a fault, and is left out: ' + test)
# -g1 puts line numbers into what is built, but no fault changes those.
usual = code_of('')
choices = list(places(room))
chance = random.Random(seed)
noticed = tried = 0
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
        seen = try_one(path, number, kind, new)
    finally:
        open(full, 'w', encoding='utf-8').write(text)
    where = '%s:%d %s: `%s` -> `%s`' % (path, number + 1, kind, old.strip(), new.strip())
    if seen not in ('does not compile', 'same code'):
        tried += 1
        noticed += bool(seen)
        if not seen:
            survivors.append(where)
    print('%s  %s' % (seen or 'SURVIVES', where), flush=True)
print('\nNo test notices:\n  ' + '\n  '.join(survivors) if survivors else '')
print('%s, seed %d: %d of %d noticed, %.0f %%' % (room, seed, noticed, tried, 100 * noticed / max(tried, 1)))

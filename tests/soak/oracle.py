#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""oracle.py [--commit=HASH] [--jobs=N] [--only=WORD] [--all] [--sample=N] [--bytes=N] FOLDER...: does this tree do what an older one did?

Builds HASH from git in build/oracle, converts every mesh below the folders with both programs and a dozen sets of
options, and compares exit codes, messages (by code and place), reports (field by field) and outputs: their names and bytes,
and where the bytes of a glTF differ, every value. It prints a table of kinds and counts, the first five of each kind
(all of them with --all), and fails if a difference is not among those that NEWER and OLDER name. With --sample, at most N files
of each folder are taken, the same ones each time; with --bytes, only files up to that size.
"""
import collections
import concurrent.futures
import json
import os
import random
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

RULES = 'rules of flipped, nearly degenerate and mirrored triangles (309a1b1f, 325de67c, f63d0ada, 1c327b56)'
# Changes that are meant: (kind, pattern of "set path detail", why). The first that fits is taken.
LAYOUT = [('layout', '', 'the same values lie elsewhere, or in a view of another number')]
# Since 956a97d6.
GRID = 'what rounding to a grid may have turned, and below eight texels (86124ecd, c43bbe0d, 0cf081ed, 1e03bf18)'
LATER = LAYOUT + [
    ('messages', r' UV_FLIPPED_TRIANGLE: -\d+ \+0$', GRID),
    ('report', r' /findings (UV_(FLIPPED_TRIANGLE|MIXED_WINDING_ISLAND|MIRROR_(SEAM|OVERLAP|LONE))|TAN_MIRROR_SHARED_VERTEX): ', GRID),
    ('report', r' /seams: | /files/N/meshes/N/(seam_(count|length)|edges/mirror|islands_by_kind/\w+|islands/N/(kind|covered_share|twin)): ',
     GRID),
    ('report', r" /files/N/(meshes/N/)?verdict: .*( flipped|is folded|; and \d+ more')", GRID),
    ('report', r' /findings UV_(DEGENERATE_TRIANGLE|UNMAPPED): -(\d+) \+\2$', 'triangles that are flat in space, and words (b33fdc1c, d8a844a9)'),
    ('report', r'^report \S+\.gl\w+ /files/N/meshes/N/(texture_size|islands/N/texel_density)\S*: \S+ -> None$',
     'a texture without an image has no picture (a5a27fd0)'),
    ('messages', r'^weld .*\.(obj|ply) .*(nothing that --|--weld welds gl|--weld: only glTF made from glTF)', 'only glTF is welded (ecd99a82)'),
    ('messages', r'^check .* checked, \d+ (primitives?|mesh|meshes), .*": -[01] \+[01]$', 'an OBJ has meshes (ecd99a82)'),
    ('messages', r' "nmtan: .*\.gl\w+ -> out\.gl\w+: .*": -[01] \+[01]$',
     'vertices and triangles of Draco blocks are counted (52d073aa, e14c563a)'),
    ('messages', r' NOT_VERIFIED: -1 \+1$', 'words (d3024742)'),
    ('report', r' /findings NOT_VERIFIED: -1 \+1$|verdict: .Look at this: the output could not be verified', 'words (d3024742)'),
]
# Since 682f52f6.
NEWER = LATER + [
    ('messages', r' UV_(FLIPPED_TRIANGLE|NEAR_DEGENERATE|DEGENERATE_TRIANGLE|MIRROR_SEAM): ', RULES),
    ('messages', r'^weld .* WELD_LEFT: -1 \+1$', 'that numbers of elements differ is told before an accessor is read (8e34904f)'),
    ('report', r' /findings (UV_(FLIPPED_TRIANGLE|NEAR_DEGENERATE|DEGENERATE_TRIANGLE|MIRROR_(SEAM|OVERLAP|LONE)|'
               r'MIXED_WINDING_ISLAND)|TAN_MIRROR_SHARED_VERTEX): ', RULES),
    ('report', r' /seams: | /files/N/meshes/N/(seam_(count|length)|edges/mirror|triangles_left_out|islands_by_kind/\w+|'
               r'islands/N/(kind|covered_share|twin)): ', RULES),
    ('report', r' /findings (NOT_VERIFIED|UV_UNMAPPED): -(\d+) \+\2$', 'words (d3024742), and triangles that are flat in space (b33fdc1c)'),
    ('messages', r' "nmtan: and \d+ more findings that fail', RULES),
    ('report', r" /files/N/verdict: .*( flipped|; and \d+ more')", RULES),
]
# Since COMMIT, which is older than issues 44, 47 and 49.
FINDINGS = (r'(NORMALS_MADE|REFERENCE_LOST|MATERIAL_LOST|MATERIAL_FIRST|IMAGE_MISSING|TAN_QUADS_LIKELY|TAN_QUADS_NONE|UV_HARD_EDGE|'
            r'UV_MISSING|UV_UNMAPPED|UV_FOLDED_QUAD|UV_MIXED_WINDING_ISLAND|UV_DEGENERATE_TRIANGLE|POS_DEGENERATE_TRIANGLE|'
            r'MESH_INCONSISTENT_WINDING|MESH_NON_MANIFOLD_EDGE|MESH_NORMAL_ZERO|POS_NOT_FINITE|POS_ORIGIN|DRACO_SEQUENTIAL|'
            r'MESH_NORMAL_AGAINST_FACE|TAN_DIRECTION_MISMATCH|TAN_SIGN_MISMATCH|TAN_NON_UNIT|TAN_MIXED_W_TRIANGLE|TAN_ZERO|'
            r'STATEMENT_IGNORED)')
WORDED = (r'(TAN_NO_NORMAL|TAN_GREEN_PAIR|TAN_KEPT_SIGN|TAN_EXISTING_BAD|TAN_ACCESSOR|TAN_MISSING_REQUIRED|NMAP_CONSTANT|'
          r'NOT_VERIFIED): -(\d+) \+\2$')
NO_NUMBER = 'a number of an MTL that is none costs the material, not the file'
OLDER = NEWER + [
    ('values', r' out\.gl\w+: \S*/name is new(\nout\.gl\w+: \S*/name is new)*$', 'a view whose number is taken again keeps its name'),
    ('values', r'^weld .*/indices/(min|max) is new', 'indices that get a new view keep their accessor, whose bounds are those of the new ones'),
    ('values', r'^quads ', 'halves of quads are found otherwise (35df539b, a444b5ff)'),
    ('report', r'/(texel_density|texture_size)\b.*: None -> ', 'an image in a view that an edit moved is found'),
    ('messages', r'cases/implicit_ids/', 'feature ids that are numbers of vertices are told'),
    ('report', r'cases/implicit_ids/.* EXTENSION_STALE: -0 ', 'feature ids that are numbers of vertices are told'),
    ('report', r' /findings TAN_UNUSED: -0 ', 'tangents that nothing uses are told wherever they were made'),
    ('report', r'cases/w_almost/.* TAN_EXISTING_BAD: -1 \+0$', 'tangents that are told by what is wrong with them are told once'),
    ('report', r'cases/vec3_tangent/.* TAN_MISSING_REQUIRED: -1 ', 'tangents that cannot be read are told as such'),
    ('messages', ' ' + FINDINGS + ': ', 'findings of issues 44, 47 and 49'),
    ('report', ' /findings ' + FINDINGS + ': ', 'findings of issues 44, 47 and 49'),
    ('messages', ' ' + WORDED, 'as many as before, worded otherwise'),
    ('report', ' /findings ' + WORDED, 'as many as before, worded otherwise'),
    ('messages', r' "nmtan: .* (primitives?|triangles?|checked), .*": -[01] \+[01]$', 'the last line says more, or nothing of a rounding by 0'),
    ('messages', r'--across=mesh changes nothing: .*": -0 \+1$', 'an option that changes nothing says what would'),
    ('messages', r'a buffer cannot be opened', 'a buffer that is missing is told once'),
    ('report', r'cases/dot_map/in\.obj /files/N/meshes/N/(slots|why)', 'a map of one dot is no normal map'),
    ('report', r'cases/double_sheet/in\.gltf /files/N/meshes/N/', 'sides at one place are told apart'),
    ('exit code', r'^check .* (0 -> 6|6 -> 0)$', 'what is a warning changed with the findings'),
    ('exit code', r'^check .*\.ply 0 -> 5$', 'a PLY without faces is refused, as a conversion refuses it'),
    ('exit code', r'mtl_number\.obj', NO_NUMBER),
    ('names', r'mtl_number\.obj', NO_NUMBER),
    ('messages', r'mtl_number\.obj', NO_NUMBER),
    ('report', r'mtl_number\.obj', NO_NUMBER),
    ('report', r' /files/N/(verdict|message|failure|meshes/N/(verdict|repair))\b', 'verdicts and remedies of issues 44, 47 and 49'),
    ('report', r'\.ply /files/N/(format|meshes)\b', 'a PLY without faces is refused, as a conversion refuses it'),
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


def compare_messages(old, new):
    """By code; a line that has none by its words. How many of each severity there are follows from the findings."""
    texts = []
    for text in (old, new):
        lines = collections.defaultdict(list)
        for line in re.sub(r', (?:\d+ (?:info|warning|error)s?|no findings)\b', '', text).splitlines():
            code = re.search(r'\[([A-Z]+_[A-Z_]+)\]', line)
            lines[code[1] if code else '"%s"' % re.sub(r'\S*/', '', line)[:150]].append(line)
        texts.append({name: sorted(lines[name]) for name in lines})
    for name in sorted(texts[0].keys() | texts[1].keys()):
        a, b = (collections.Counter(text.get(name, ())) for text in texts)
        if a != b:
            yield '%s: -%d +%d' % (name, (a - b).total(), (b - a).total())


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


def compare_reports(old, new):
    """Findings by code and seams as sets, all else field by field. Totals follow from the findings."""
    reports, sets = [json.loads(old), json.loads(new)], []
    for report in reports:
        found = collections.defaultdict(collections.Counter)
        for file in report.get('files', [report]):
            lists = [('/findings ' + finding['code'], finding) for finding in file.pop('findings', ())]
            lists += [('/seams', seam) for mesh in file.get('meshes', ()) for seam in mesh.pop('seams', None) or ()]
            for name, item in lists:
                found[name][json.dumps(item, sort_keys=True)] += 1
        sets.append(found)
    for name in sorted(sets[0].keys() | sets[1].keys()):
        a, b = (found[name] for found in sets)
        if a != b:
            yield '%s: -%d +%d' % (name, (a - b).total(), (b - a).total())
    a, b = (dict(fields(report)) for report in reports)
    differ = sets[0] != sets[1]
    for key in sorted(set(a) | set(b)):
        follows = differ and '/totals/' in key
        if a.get(key) != b.get(key) and not follows and not re.search(r'seconds|version$', key):
            yield '%s: %r -> %r' % (re.sub(r'\d+', 'N', key), a.get(key), b.get(key))


def compare_outputs(name, old, new, folders):
    if name.endswith(('.gltf', '.glb')):
        paths = [os.path.join(folder, name) for folder in folders]
        done = subprocess.run([sys.executable, '-B', 'tests/support/gltf_lossless.py', '--outputs'] + paths,
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
        found += [('messages', text) for text in compare_messages(old[1], new[1])]
        both = {name for name in old[2].keys() & new[2].keys() if old[2][name] != new[2][name]}
        parts = {name for name in both if name.endswith('.bin')} if 'out.gltf' in new[2] else set()
        if parts:
            both |= {'out.gltf'}  # which refers to them
        for name in sorted((set(old[2]) | set(new[2])) - parts):
            a, b = old[2].get(name), new[2].get(name)
            if a is None or b is None:
                found.append(('names', '%s is %s' % (name, 'new' if a is None else 'gone')))
            elif name == 'report.json':
                found += [('report', text) for text in compare_reports(a, b)] if a != b else []
            elif name in both:
                found.append(compare_outputs(name, a, b, folders))
    return [(kind, label, source, text) for kind, text in found]


commit, jobs, only, most, sample, largest, inputs = COMMIT, os.cpu_count() or 1, '', 5, sys.maxsize, sys.maxsize, []
for word in sys.argv[1:]:
    if word.startswith('--commit='):
        commit = word[9:]
    elif word.startswith('--jobs='):
        jobs = int(word[7:])
    elif word.startswith('--only='):
        only = word[7:]
    elif word == '--all':
        most = sys.maxsize
    elif word.startswith('--sample='):
        sample = int(word[9:])
    elif word.startswith('--bytes='):
        largest = int(word[8:])
    else:
        below = sorted(os.path.abspath(os.path.join(path, name)) for path, _, names in os.walk(word) for name in names
                       if name.lower().endswith(MESHES) and os.path.getsize(os.path.join(path, name)) <= largest)
        inputs += random.Random(45).sample(below, min(sample, len(below)))
programs = [build(commit), os.path.abspath('build/release/nmtan')]
rows = next((rows for name, rows in ((COMMIT, OLDER), ('682f52f6', NEWER), ('956a97d6', LATER)) if commit.startswith(name)), LAYOUT)
work = [(source, options) for source in sorted(inputs) for options in SETS if only in options[0]]
began = time.monotonic()
counts, examples, unexplained = collections.Counter(), collections.defaultdict(list), 0
with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
    for result in pool.map(compare, work):
        for kind, label, source, text in result:
            line = '%s %s %s' % (label, source, text)
            why = next((row[2] for row in rows if row[0] == kind and re.search(row[1], line)), None)
            kind += ': ' + why if why else ''
            unexplained += not why
            counts[kind] += 1
            if len(examples[kind]) < most:
                examples[kind].append(line)
for kind, count in counts.most_common():
    print('%7d  %s' % (count, kind))
    for line in examples[kind]:
        print('         ' + line)
print('%d files, %d sets of options, %d pairs of runs in %.0f s beside %s: %d differences, %d unexplained' % (
    len(inputs), len(work) // max(len(inputs), 1), len(work), time.monotonic() - began, commit[:8], sum(counts.values()), unexplained))
sys.exit(bool(unexplained))

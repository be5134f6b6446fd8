#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""counts.py NMTAN [WORD...]: what is counted in inputs, from 1 000 to 100 000 of it, takes n log n time.

Each quantity of tests/support/inputs.py is run with several sets of options.
Processor time and memory of 10 000 and 100 000 may be at most 1.5 times what n log n makes of those of the size before;
less than FLOOR seconds or bytes count as that. Runs end with an exit code that the manual has, but for 4. WORDs choose
quantities by parts of their names, a word with "--" sets of options. NT_SEED (1) is the seed of values and orders,
NT_LEAST and NT_MOST other sizes.
"""
import math
import os
import resource
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
import inputs  # noqa: E402

FLOOR_SECONDS, FLOOR_BYTES, LIMIT_SECONDS, GROWTH = 0.04, 12 << 20, 40, 1.5
LEAST, MOST = int(os.environ.get('NT_LEAST', 1000)), int(os.environ.get('NT_MOST', inputs.MOST))
inputs.nmtan = nmtan = os.path.abspath(sys.argv[1])
CODES = 'UV_UNMAPPED', 'UV_MIRROR_SEAM', 'TAN_UNUSED', 'NORMALS_MADE'


def words_of(options, n, path, folder):
    words = ['-j2']
    for word in options.split():
        if word.split('=')[-1] == 'IN':
            word = word[:-2] + os.path.relpath(path, folder)
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


def measure(name, options, most, code, failures):
    before, before_n = None, 0
    n = LEAST
    while n <= min(most, MOST):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(folder + '/in')
            path = inputs.make_input(name, n, folder + '/in/a')
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
    for name, (_, sets, most, code) in inputs.quantities.items():
        chosen = [word for word in words if not word.startswith('--')]
        if chosen and not any(word in name for word in chosen):
            continue
        for options in sets:
            if all(word in options for word in words if word.startswith('--')):
                count += 1
                measure(name, options, most, code, failures)
    print('%d passed, %d failed' % (count - len(failures), len(failures)))
    sys.exit(len(failures) > 0)


main()

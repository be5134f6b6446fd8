#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""growth.py MOST LEAST FILE FILE FILE -- COMMAND...: how the processor time of a command grows with its input.

The files are of one kind, each twice as large as the one before, and stand for IN in the command, also behind "=" and before
".json". Prints the best times of up to eight tries, and ends with 1 where the last is MOST times the first or more: what is
linear takes four times as long, what is quadratic sixteen. Times below LEAST seconds say nothing. A run that takes a hundred
times LEAST is ended.
"""
import os
import re
import resource
import subprocess
import sys

most, least, *files = float(sys.argv[1]), float(sys.argv[2]), *sys.argv[3:6]
command = sys.argv[7:]
limit = int(100 * least) + 1
best = [float('inf')] * 3


def seconds(words):
    before = os.times()
    code = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))).returncode
    if code not in (0, 6):
        sys.exit('exit code %d: %s' % (code, ' '.join(words)))
    after = os.times()
    return after[2] + after[3] - before[2] - before[3]


# On a loaded machine the kernel may take several times as long for the same calls: a wrong answer is asked for again.
for attempt in range(8):
    for i, file in enumerate(files):
        best[i] = min(best[i], seconds([re.sub(r'^(.*=)?IN(\.json)?$', r'\g<1>' + file + r'\2', word) for word in command]))
    if best[2] < most * best[0]:
        break
print('%.2f, %.2f and %.2f seconds' % tuple(best))
sys.exit(best[2] >= least and best[2] >= most * best[0])

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""sweep.py KIND STRIDE <CASES: commands of $NMTAN, each in a folder of its own with some files of $WORK/in.

KIND is memory, ERRNO or shorten, with "onwards" behind it where all that comes after fails, too. A case is a line "name | files |
many, report=FILE or nothing | arguments"; of KIND shorten its name is a file. Each runs once as it is, then again and again with
the n-th allocation (memory) or the n-th system call (EIO, ENOMEM, EINTR, ENOSPC) failing, or with the file becoming empty at the
n-th call, for n = a first one, + STRIDE, ... until nothing fails any more. The folder is put back before each run. It checks each run:

  - it ends by itself, with the code of the run without faults, 4 for memory, 2 or 4 for system calls, 2 or 3 (where
    it was empty when it was opened) for a file that became empty;
  - with that of the run without faults: files, standard output and standard error are what they were then;
  - else it says so on standard error, in one line unless there are "many" inputs, and leaves each file as it was
    before or as it should be, and no others, and not all of them and standard output as they should be, unless it
    says that "the output stands", or names a manifest. A folder of outputs may have been made, and the "report" may
    tell of the fault.

Prints a line for each of the first bad ones of a case, and how many were tried. Times in messages do not count.
"""
import errno
import mmap
import multiprocessing
import os
import re
import shutil
import signal
import struct
import subprocess
import sys

SHARED = '@iN?i512sN?32s0N'  # the struct of faulty.c: kind, target, onwards, errno, file; calls, whether one failed, its name
MEMORY, CALLS, SHORTEN = range(3)
SHOWN, NEVER = 20, 2 ** 64 - 1


def listed():
    """Everything in the working folder: a file's bytes, '' for a folder, None for what is neither; a folder before what it has."""
    found = {}
    for folder, folders, files in os.walk('.'):
        for name in folders + files:
            path = os.path.join(folder, name)
            if os.path.isdir(path) and not os.path.islink(path):
                found[path] = ''
            elif os.path.isfile(path) and not os.path.islink(path):
                with open(path, 'rb') as file:
                    found[path] = file.read()
            else:
                found[path] = None
    return found


def restore(before, now):
    for path in reversed(list(now)):
        if path not in before:
            os.rmdir(path) if now[path] == '' else os.remove(path)
    for path, content in before.items():
        if isinstance(content, bytes) and now.get(path) != content:
            if path in now:
                os.remove(path)
            with open(path, 'wb') as file:
                file.write(content)


def has_times(path):
    """Records and manifests have the times of their run; a record says nothing of a file that cannot be looked at again."""
    return '/.nmtan-record' in path or '.jsonl' in path


class Sweep:
    def __init__(self, kind, stride, number, case):
        name, files, told, arguments = case.rstrip('\n').split('|', 3)
        self.name, self.what, self.stride, self.first = name.strip(), kind[0], stride, number * 7 % stride
        self.onwards, self.shortened = len(kind) > 1, self.name if kind == ['shorten'] else None
        self.kind = SHORTEN if self.shortened else MEMORY if self.what == 'memory' else CALLS
        self.many, self.report = 'many' in told, told.partition('report=')[2].strip()
        self.command = [os.environ['NMTAN']] + arguments.split()
        self.folder = '%s/case%d' % (os.environ['WORK'], number)
        shutil.rmtree(self.folder, ignore_errors=True)
        os.mkdir(self.folder)
        for file in files.split():
            shutil.copy('%s/in/%s' % (os.environ['WORK'], file), self.folder)
        os.chdir(self.folder)
        with open(self.folder + '.shared', 'w+b') as file:
            file.truncate(struct.calcsize(SHARED))
            self.shared = mmap.mmap(file.fileno(), 0)

    def run(self, target):
        """Status, standard output, standard error and files; how many calls there were; the name of what failed, or ''."""
        number = getattr(errno, self.what, 0)
        file = os.path.join(self.folder, self.shortened or '').encode()
        struct.pack_into(SHARED, self.shared, 0, self.kind, target, self.onwards and target != NEVER, number, file, 0, False, b'')
        environment = {'NT_FAULTY_FILE': self.folder + '.shared', 'LD_PRELOAD': os.environ['BUILD'] + '/tests/faults/faulty.so', 'LC_ALL': 'C', 'PATH': '/usr/bin:/bin'}
        with open(self.folder + '.out', 'w+b') as out, open(self.folder + '.err', 'w+b') as err:
            status = subprocess.call(self.command, stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=environment)
            out.seek(0)
            err.seek(0)
            said = re.sub(r'\d[\d.]*(e[-+]?\d+)? m?s(?![A-Za-z])', '', err.read().decode(errors='replace'))
            result = status, out.read(), said, listed()
        *_, count, fired, name = struct.unpack_from(SHARED, self.shared)
        return result, count, name.rstrip(b'\0').decode() if fired else ''

    def compared(self, path):
        return not has_times(path) and path[2:] != self.shortened

    def judge_files(self, now, whole, said):
        """The fault of the files, or None. whole: all must be what they should be."""
        for path, content in now.items():
            if content == '' or not self.compared(path):
                continue
            right = path in self.clean[3] and content == self.clean[3][path]
            told = said.rsplit(':', 1)[-1].lstrip(' ').split('\n')[0]
            if not right and not whole and self.report and self.report in path and content and told in content.decode(errors='replace'):
                continue
            if not right and not whole and path in self.before and content == self.before[path]:
                continue
            if not right:
                return path + ': a file has wrong content' if path in self.clean[3] or path in self.before else path + ': a file is left behind'
        if not self.before.keys() <= now.keys():
            return 'a file is gone'
        if whole and any(not has_times(path) and path not in now for path in self.clean[3]):
            return 'a file is missing'
        return None

    def judge(self, status, out, said, files):
        if status < 0:
            return 'it hangs' if status == -signal.SIGALRM else 'it dies of a signal'
        if status == self.clean[0]:
            if out != self.clean[1]:
                return 'standard output differs'
            return 'standard error differs' if said != self.clean[2] else self.judge_files(files, True, said)
        if status not in {MEMORY: (4,), CALLS: (2, 4), SHORTEN: (2, 3)}[self.kind]:
            return 'wrong exit code'
        lines = [line for line in said.splitlines(True) if not line.endswith('\n') or line not in self.clean[2]]
        if not lines:
            return 'it says nothing'
        if len(lines) > 1 and not self.many:
            return 'it says more than one line'
        makes_files = any(content != '' and self.compared(path) and self.before.get(path, '') != content
                          for path, content in self.clean[3].items())
        blamed = any(has_times(path) and path[2:] in said for path in self.clean[3])
        if (makes_files and out == self.clean[1] and not blamed and 'the output stands' not in said and
                not self.judge_files(files, True, said)):
            return 'it fails although its files stand'
        return self.judge_files(files, False, said)

    def lines(self):
        """Lines of the first bad ones; how many were tried, how many are bad."""
        self.before = listed()
        self.clean, calls, _ = self.run(NEVER)
        if self.clean[0] not in (0, 6) or not calls:
            return ['%s: the command fails without a fault: %s' % (self.name, self.clean[2])], 0, 1
        restore(self.before, self.clean[3])
        found, tried = [], 0
        for n in range(self.first, calls + 1000000, self.stride):
            result, _, name = self.run(n)
            tried += name != ''
            wrong = self.judge(*result)
            if wrong:
                found.append('%s: %s %d (%s): %s (status %d): %.200s' % (self.name, self.what, n, name, wrong, result[0], result[2]))
            restore(self.before, result[3])
            if not name:
                break
        return found[:SHOWN], tried, len(found)


def swept(case):
    return Sweep(sys.argv[1].split(), int(sys.argv[2]), *case).lines()


with multiprocessing.Pool() as pool:
    results = pool.map(swept, enumerate(sys.stdin.readlines()), 1)
for line in (line for found, _, _ in results for line in found):
    print(line)
tried, bad = sum(result[1] for result in results), sum(result[2] for result in results)
print('%s: %d cases, tried %d, bad %d' % (sys.argv[1], len(results), tried, bad))
sys.exit(bad > 0 or tried < len(results))

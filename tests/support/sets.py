#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""sets.py kill|fail|power|state ...: whether an output set is whole, whatever cuts its making short.

    sets.py state MAIN
    sets.py kill|fail|power [--stride=N] [--also=NAME:ERRNO] [--other=ARGUMENT] PROGRAM CALLS.SO BEFORE MAIN ARGUMENT...

"state" prints what a reader of MAIN gets: a hash of the document, without the names of its files, and of the bytes of all
that it refers to; "nothing" where there is no MAIN; "broken: ..." where a file is missing or of another size.

The others run PROGRAM with the arguments in copies of the folder BEFORE, once undisturbed, then

    kill   killed before each of its calls that change files: MAIN is the old or the new one, whole, and another run ends where
           the undisturbed one did, with the same files in the folder, also one with the argument of --other
    fail   with each of those calls failing once: the same, with success only where MAIN is the new one
    power  with the power cut after each of its calls: of those since the last fsync of the folder any may be lost, and a file has
           what its last fsync saw; MAIN is the old or the new one

and print how many states they tried and how many were bad, the first few with their reason. --stride takes every N-th.
--also makes all calls of a name fail besides. CALLS.SO is tests/preload/calls.c.
"""
import hashlib
import itertools
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from urllib.parse import unquote

EIO, ENOSPC, KILLED = 5, 28, -9


class Broken(Exception):
    pass


def read_main(data):
    """JSON and BIN chunk."""
    if data[:4] != b'glTF':
        return json.loads(data), b''
    if len(data) != struct.unpack_from('<I', data, 8)[0]:
        raise Broken('the main file is cut off')
    size = struct.unpack_from('<I', data, 12)[0]
    return json.loads(data[20:20 + size]), data[20 + size:]


def state_of(read, main):
    """`read` gives the bytes of a name, None where there is none."""
    data = read(main)
    if data is None:
        return 'nothing'
    digest = hashlib.sha256()
    try:
        document, chunk = read_main(data)
        digest.update(chunk)
        for array in ('buffers', 'images'):
            for item in document.get(array, []):
                uri = item.get('uri')
                if uri is None or uri.startswith('data:'):
                    continue
                if '/' in uri:  # a file of the input, which is not of the set
                    item['uri'] = ''
                    continue
                content = read(unquote(uri))
                if content is None:
                    raise Broken(uri + ' is missing')
                if array == 'buffers' and len(content) != item['byteLength']:
                    raise Broken(uri + ' has another size')
                digest.update(hashlib.sha256(content).digest())
                item['uri'] = ''
                if isinstance(item.get('extras'), dict):
                    extras = {k: v for k, v in item.pop('extras').items() if not k.startswith('nmtan:')}
                    if extras:
                        item['extras'] = extras
    except (Broken, ValueError, KeyError, struct.error) as fault:
        return 'broken: %s' % fault
    digest.update(json.dumps(document, sort_keys=True).encode())
    return digest.hexdigest()[:16]


def in_folder(folder):
    def read(name):
        path = os.path.join(folder, name)
        if not os.path.exists(path):
            return None
        with open(path, 'rb') as f:
            return f.read()
    return read


def names(folder):
    return sorted(os.listdir(folder))


class Sweep:
    def __init__(self, program, calls, before, main, arguments, also):
        self.command = [program] + arguments
        self.calls, self.before, self.main, self.also = os.path.abspath(calls), before, main, also
        self.room = tempfile.mkdtemp(dir=os.path.dirname(os.path.abspath(before)))
        self.folder = os.path.join(self.room, 'folder')
        self.tried, self.bad, self.other = 0, [], []
        self.old = state_of(in_folder(before), main)

    def restore(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(self.before, self.folder, symlinks=True)

    def run(self, **how):
        environment = dict(os.environ, LD_PRELOAD=self.calls)
        options = environment.get('ASAN_OPTIONS', '')
        environment['ASAN_OPTIONS'] = options + ':verify_asan_link_order=0'
        if self.also:
            environment['NT_CALLS_FAIL'] = self.also
        for key, value in how.items():
            environment['NT_CALLS_' + key] = str(value)
        result = subprocess.run(self.command + (self.other if 'OTHER' in how else []), cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.said = result.stderr.decode(errors='replace').strip()
        return result.returncode

    def judge(self, what, good):
        self.tried += 1
        if not good:
            self.bad.append(what)

    def now(self):
        return state_of(in_folder(self.folder), self.main)

    def undisturbed(self):
        self.restore()
        count = os.path.join(self.room, 'count')
        code = self.run(COUNT=count)
        self.new, self.names = self.now(), names(self.folder)
        self.judge('an undisturbed run ends with %d: %s' % (code, self.said), code == 0)
        self.judge('an undisturbed run leaves "%s"' % self.new,
                   self.new not in ('nothing', self.old) and not self.new.startswith('broken'))
        with open(count) as f:
            return f.read().split()

    def kill(self, stride):
        count = len(self.undisturbed())
        expected = self.new
        if self.other:
            self.restore()
            self.run(OTHER=1)
            expected, self.names = self.now(), names(self.folder)
        for n in range(1, count + 1, stride):
            self.restore()
            code, state = self.run(KILL=n), self.now()
            where = 'killed before call %d of %d: ' % (n, count)
            self.judge(where + 'ends with %d' % code, code == KILLED)
            self.judge(where + state, state in (self.old, self.new))
            left = names(self.folder)
            code = self.run(OTHER=1)
            self.judge(where + 'the next run ends with %d: %s' % (code, self.said), code == 0)
            self.judge(where + 'then ' + self.now(), self.now() == expected)
            self.judge(where + 'left %s, then there is %s, expected %s' % (left, names(self.folder), self.names),
                       names(self.folder) == self.names)

    def fail(self, stride):
        calls = self.undisturbed()
        for index in range(0, len(calls), stride):
            self.restore()
            name, n = calls[index], calls[:index + 1].count(calls[index])
            number = ENOSPC if name in ('write', 'writev') else EIO
            code, state = self.run(FAIL='%s:%d:%d' % (name, number, n)), self.now()
            where = '%s %d failing, exit %d: ' % (name, n, code)
            self.judge(where + state, state == self.new if code == 0 else state in (self.old, self.new))
            self.judge(where + 'said nothing', code == 0 or (code == 2 and self.said))
            if name != 'unlink':
                self.judge(where + str(names(self.folder)), not any(x.startswith('.nmtan') for x in names(self.folder)))

    # ---- power ----

    def trace(self):
        self.undisturbed()
        self.restore()
        trace = os.path.join(self.room, 'trace')
        os.mkdir(trace)
        self.inodes = {n: os.stat(os.path.join(self.folder, n)).st_ino for n in names(self.folder)}
        self.content = {}
        for name, inode in self.inodes.items():
            self.content[inode] = in_folder(self.folder)(name)
        self.run(TRACE=trace)
        with open(os.path.join(trace, 'log')) as f:
            log = [line.rstrip('\n').split('\t') for line in f]
        self.snapshot = lambda number: in_folder(trace)(number)
        return log

    @staticmethod
    def apply(entries, operation):
        kind, arguments = operation[0], [os.path.basename(a) for a in operation[1:]]
        if kind in ('create', 'link'):
            entries[arguments[0]] = int(arguments[1])
        elif kind == 'rename' and arguments[0] in entries:
            inode = entries.pop(arguments[0])
            entries[arguments[1]] = inode
        elif kind == 'unlink':
            entries.pop(arguments[0], None)

    def power(self, stride):
        log = self.trace()
        self.judge('nothing was synchronised', any(o[0] == 'sync-folder' for o in log))
        for end in [*range(0, len(log), stride), len(log)]:
            durable, content, pending = dict(self.inodes), dict(self.content), []
            for operation in log[:end]:
                if operation[0] == 'sync-file':
                    content[int(operation[1])] = self.snapshot(operation[2])
                elif operation[0] == 'sync-folder':
                    for one in pending:
                        self.apply(durable, one)
                    pending = []
                else:
                    if operation[0] == 'create':
                        content.pop(int(operation[2]), None)  # numbers are given again
                    pending.append(operation)
            for size in range(len(pending) + 1):
                for kept in itertools.combinations(pending, size):
                    entries = dict(durable)
                    for one in kept:
                        self.apply(entries, one)
                    # a file that was never synchronised has a name and nothing in it
                    read = lambda name: content.get(entries[name], b'') if name in entries else None
                    state = state_of(read, self.main)
                    self.judge('power cut after %d of %d calls, of the pending ones %s: %s' %
                               (end, len(log), kept, state), state in (self.old, self.new))
        self.judge('what a run leaves behind is not lasting: %s' % state,
                   state_of(lambda name: content.get(durable[name], b'') if name in durable else None, self.main) == self.new)


def main():
    words = sys.argv[1:]
    if words[0] == 'state':
        print(state_of(in_folder(os.path.dirname(words[1]) or '.'), os.path.basename(words[1])))
        return 0
    mode, stride, also, other = words.pop(0), 1, None, []
    while words[0].startswith('--'):
        key, value = words.pop(0).split('=', 1)
        if key == '--stride':
            stride = int(value)
        elif key == '--other':
            other = [value]
        else:
            also = value
    program, calls, before, file, *arguments = words
    sweep = Sweep(program, calls, before, file, arguments, also)
    sweep.other = other
    getattr(sweep, mode)(stride)
    shutil.rmtree(sweep.room)
    print('%s: %d tried, %d bad' % (mode, sweep.tried, len(sweep.bad)))
    for text in sweep.bad[:8]:
        print('  ' + text)
    return 1 if sweep.bad else 0


sys.exit(main())

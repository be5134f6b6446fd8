#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""stale.py NMTAN STEPS [SEED]: whether --update is ever stale, or makes what nobody changed.

A tree of meshes with libraries, buffers and images, some of them behind links, is converted with --update after each of STEPS
random edits, and compared with what a run without a record makes. An output that differs is stale. A storm is an output that
was made although nothing that its last run read, looked for or wrote was touched, or that is made once more by a second run.
Edits restore times, swap files, set links anew, damage the record, and kill the run. Prints the counts, and what was wrong.
"""
import hashlib
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

OPTIONS = ([], ['--method=area'])
QUAD = 'mtllib %s.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 %d\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n'
FOLDERS = ('in', 'in/a', 'in/b')


def write(path, data):
    with open(path, 'wb') as f:
        f.write(data)


def read(path):
    with open(path, 'rb') as f:
        return f.read()


class Fuzz:
    def __init__(self, nmtan, data, seed):
        self.nmtan, self.data, self.random = nmtan, data, random.Random(seed)
        self.options, self.counter = OPTIONS[0], 0
        self.stale, self.storms, self.failures, self.log = 0, 0, 0, []
        png = read(data + '/bumps.png')
        # of equal sizes: a byte of its pixels differs, which PNG's check does not have to find for images that are copied
        self.images = [png[:60] + bytes([i]) + png[61:] for i in range(4)]
        self.build()

    def build(self):
        for folder in FOLDERS:
            os.makedirs(folder + '/v1')
            os.makedirs(folder + '/v2')
            for i, version in enumerate(('v1', 'v2')):
                write('%s/%s/n.png' % (folder, version), self.images[i])
                write('%s/%s/c.png' % (folder, version), self.images[i + 2])
            os.symlink('v1', folder + '/tex')
            os.symlink('v2/c.png', folder + '/link.png')
            for name in ('p', 'q'):
                write('%s/%s.obj' % (folder, name), (QUAD % (name, 0)).encode())
                write('%s/%s.mtl' % (folder, name), b'newmtl m\nmap_Kd tex/n.png\nmap_Ks link.png\nmap_Ke gone.png\n')
            write(folder + '/r.obj', (QUAD % ('none', 1)).encode())
            for name in ('plates.gltf', 'plates.bin', 'bumps.png'):
                shutil.copy(os.path.join(self.data, name), folder)
        for folder, _, names in os.walk('in'):
            for name in names:
                if not os.path.islink(os.path.join(folder, name)):
                    os.utime(os.path.join(folder, name), (1700000000, 1700000000))

    # ---- runs ----

    def command(self, out, *more):
        return [self.nmtan, '-q', '--images=embed', '-r', '-d', out, '--keep-tree=in', *self.options, *more, 'in']

    def update(self):
        """The lines of the manifest by input."""
        result = subprocess.run(self.command('out', '--update', '--manifest=m'), stderr=subprocess.DEVNULL)
        self.failures += result.returncode not in (0, 2, 3)
        return {line['input']: line for line in map(json.loads, read('m').decode().splitlines())}

    def outputs(self, folder):
        """A reader's data of each main file, whatever its .bin is called."""
        found = {}
        for place, _, names in os.walk(folder):
            for name in names:
                path = os.path.join(place, name)
                if name.endswith('.glb'):
                    found[os.path.relpath(path, folder)] = hashlib.sha256(read(path)).hexdigest()
                elif name.endswith('.gltf'):
                    try:
                        document = json.loads(read(path))
                        for buffer in document.get('buffers', []):
                            buffer.pop('extras', None)
                            buffer['uri'] = hashlib.sha256(read(os.path.join(place, buffer['uri']))).hexdigest()
                        found[os.path.relpath(path, folder)] = json.dumps(document)
                    except (ValueError, OSError) as fault:
                        found[os.path.relpath(path, folder)] = str(fault)
        return found

    def wrong(self, what, edit):
        self.log.append('%s after: %s' % (what, edit))

    def step(self):
        before = {name: (line, self.touchable(line)) for name, line in self.last.items()}
        edit, touched = self.edit()
        touched = None if touched is None else {os.path.abspath(p) for p in touched} | {os.path.realpath(p) for p in touched}
        lines = self.update()
        for name, line in lines.items():
            known = before.get(name)
            if (line['status'] in ('done', 'left') and touched is not None and known and
                    known[0]['status'] not in ('failed', 'untried') and
                    not any(p == t or p.startswith(t + '/') or t.startswith(p + '/.') for p in known[1] for t in touched)):
                self.storms += 1
                self.wrong('storm: %s (%s)' % (name, line['status']), edit)
        again = [n for n, line in self.update().items() if line['status'] in ('done', 'left')]
        if again:
            self.storms += len(again)
            self.wrong('made twice: %s' % again, edit)
        self.last = {**self.last, **lines}
        shutil.rmtree('clean', ignore_errors=True)
        subprocess.run(self.command('clean'), stderr=subprocess.DEVNULL)
        out = self.outputs('out')
        for name, state in self.outputs('clean').items():
            if out.get(name) != state:
                self.stale += 1
                self.wrong('STALE: %s' % name, edit)

    def touchable(self, line):
        """All that decides on an output, as it is spelled and as it is."""
        paths = [f['path'] for f in line['dependencies'] + line['outputs']] + line['missing'] + line['searched']
        stem = os.path.splitext(line['input'])[0]
        paths += [os.path.join(os.path.dirname(p), x) for p in paths for x in ('tex', 'link.png')] + [stem + '.mtl']
        # a folder that is searched has a new time when anything arrives, but that alone makes nothing
        return {os.path.abspath(p) for p in paths} | {os.path.realpath(p) for p in paths}

    # ---- edits ----

    def pick(self, *endings):
        files = [os.path.join(place, n) for place, _, names in sorted(os.walk('in')) for n in sorted(names)]
        files = [f for f in files if f.lower().endswith(endings) and not os.path.islink(f)]
        return self.random.choice(files) if files else None

    def folder(self):
        return self.random.choice(FOLDERS)

    def keeping_times(self, path, change):
        info = os.stat(path)
        change()
        if self.random.random() < 0.7:
            os.utime(path, ns=(info.st_atime_ns, info.st_mtime_ns))

    def edit(self):
        kinds = [getattr(self, n) for n in sorted(dir(self)) if n.startswith('edit_')]
        while True:
            kind = self.random.choice(kinds)
            done = kind()
            if done:
                return '%s %s' % (kind.__name__, done[0]), done[1]

    def edit_touch(self):
        path = self.pick('.obj', '.mtl', '.png', '.bin', '.gltf')
        os.utime(path)
        return path, [path]

    def edit_status(self):
        path = self.pick('.obj', '.mtl', '.png', '.bin', '.gltf')
        if self.random.random() < 0.5:
            os.chmod(path, self.random.choice((0o600, 0o644)))
        else:
            shutil.copy2(path, path + '.new')
            os.replace(path + '.new', path)
        return path, [path]

    def edit_image(self):
        path = self.pick('.png')
        if not path:
            return None
        self.keeping_times(path, lambda: write(path, self.random.choice(self.images)))
        return path, [path]

    def edit_text(self):
        path = self.pick('.obj', 'none.mtl')
        text = read(path)
        digit = b'%d' % self.random.randrange(10)
        self.keeping_times(path, lambda: write(path, text.replace(b'v 1 1 ', b'v 1 1 ' + digit)[:len(text) + 1]))
        return path, [path]

    def edit_library(self):
        path = self.pick('.mtl')
        if not path:
            return None
        line = self.random.choice((b'map_Kd tex/n.png', b'map_Kd tex/c.png', b'map_Kd  v2/n.png', b'norm bumps.png  '))
        rest = b'\nmap_Ks link.png\nmap_Ke gone.png\n' if self.random.random() < 0.7 else b'\n'
        self.keeping_times(path, lambda: write(path, b'newmtl m\n' + line + rest))
        return path, [path]

    def edit_swap(self):
        folder = self.folder()
        one, two = folder + '/v1/n.png', folder + '/v2/n.png'
        if not (os.path.isfile(one) and os.path.isfile(two)):
            return None
        os.rename(one, 'swapped')
        os.rename(two, one)
        os.rename('swapped', two)
        return folder, [one, two]

    def edit_folder_link(self):
        link = self.folder() + '/tex'
        target = self.random.choice(('v1', 'v2', './v1', '../a/v1', 'nowhere', 'loop'))
        if os.path.islink(link) or os.path.isfile(link):
            os.unlink(link)
        elif os.path.isdir(link):
            shutil.rmtree(link)
        if target == 'loop':
            shutil.copytree(os.path.dirname(link) + '/v2', link)
        else:
            os.symlink(target, link)
        return '%s -> %s' % (link, target), [link]

    def edit_file_link(self):
        link = self.folder() + '/link.png'
        if os.path.lexists(link):
            os.unlink(link)
        target = self.random.choice(('v1/c.png', 'v2/c.png', '../b/v1/n.png', '/gone', None))
        if target:
            os.symlink(target, link)
        return '%s -> %s' % (link, target), [link]

    def edit_delete(self):
        path = self.pick('.png', '.mtl', '.bin')
        if not path or self.random.random() < 0.5:
            return None
        os.unlink(path)
        return path, [path]

    def edit_arrive(self):
        folder = self.folder()
        name = self.random.choice(('gone.png', 'GONE.png', 'Gone.PNG', 'v1/n.png', 'v1/N.png', 'none.mtl', 'p.mtl', 'q.mtl',
                                   'plates.bin', 'bumps.png', 'TEX/n.png'))
        path = os.path.join(folder, name)
        if os.path.lexists(path):
            return None
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if name.endswith('.mtl'):
            write(path, b'newmtl m\nmap_Kd tex/n.png\n')
        elif name in ('plates.bin', 'bumps.png'):
            shutil.copy2(os.path.join(self.data, name), path)
        else:
            write(path, self.random.choice(self.images))
        os.utime(path, (1600000000, 1600000000))
        same_in_any_case = [os.path.join(folder, n) for n in ('gone.png', 'tex', 'tex/n.png', 'v1/n.png')]
        return path, [path] + same_in_any_case

    def edit_case(self):
        path = self.pick('.png')
        if not path:
            return None
        folder, name = os.path.split(path)
        other = os.path.join(folder, name.upper() if self.random.random() < 0.5 else name.lower())
        if os.path.lexists(other):
            return None
        os.rename(path, other)
        return '%s to %s' % (path, other), [path, other, os.path.join(folder, name.lower())]

    def edit_unrelated(self):
        self.counter += 1
        path = '%s/%s%d' % (self.random.choice(FOLDERS + ('in/a/v1', 'out')), self.random.choice(('note', '.new', 'x')), self.counter)
        write(path, b'x')
        return path, []

    def edit_output(self):
        files = [os.path.join(place, n) for place, _, names in sorted(os.walk('out')) for n in sorted(names)
                 if n.endswith(('.glb', '.gltf', '.bin'))]
        path = self.random.choice(files)
        how = self.random.randrange(3)
        if how == 0:
            os.unlink(path)
        elif how == 1:
            bytes_ = bytearray(read(path))
            bytes_[self.random.randrange(len(bytes_))] ^= 1
            self.keeping_times(path, lambda: write(path, bytes(bytes_)))
        else:
            shutil.copy2(path, path + '.new')
            os.replace(path + '.new', path)
        return path, [path]

    def edit_record(self):
        path = 'out/.nmtan-record'
        text = bytearray(read(path))
        how = self.random.randrange(5)
        if how == 0:
            text = text[:self.random.randrange(len(text))]
        elif how == 1:
            for _ in range(self.random.randrange(1, 20)):
                text[self.random.randrange(len(text))] = self.random.randrange(256)
        elif how == 2:
            text = bytearray()
        elif how == 3:
            text += text + text[:self.random.randrange(len(text))]
        else:
            lines = text.splitlines(True)
            text = bytearray(b''.join(line for line in lines if self.random.random() < 0.7))
        write(path, bytes(text))
        return path, None

    def edit_kill(self):
        path, touched = self.edit_touch()
        run = subprocess.Popen(self.command('out', '--update'), stderr=subprocess.DEVNULL)
        time.sleep(self.random.random() * 0.02)
        run.kill()
        run.wait()
        return path, None

    def edit_options(self):
        if self.random.random() < 0.8:
            return None
        self.options = self.random.choice(OPTIONS)
        return ' '.join(self.options), None


def main():
    nmtan, steps = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(1 << 30)
    data = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../data')
    with tempfile.TemporaryDirectory() as room:
        os.chdir(room)
        fuzz = Fuzz(nmtan, data, seed)
        fuzz.last = fuzz.update()
        for _ in range(steps):
            fuzz.step()
        os.chdir('/')
    print('seed %d: %d steps, %d stale, %d storms, %d failures' % (seed, steps, fuzz.stale, fuzz.storms, fuzz.failures))
    print('\n'.join(fuzz.log[:20]))
    return 1 if fuzz.stale or fuzz.storms or fuzz.failures else 0


sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_lossless.py [--quantized] [--welded] INPUT OUTPUT [--tangents=REFERENCE]: says what OUTPUT changed that it should not have.
gltf_lossless.py --outputs ONE OTHER: says what differs in two outputs of one input but where their bytes lie.

A second reading of both files that shares no code with nmtan. Per triangle corner every attribute and
morph target holds the same bytes; the JSON is equal value for value and in key order but for what
tangents need; views that no triangle uses hold the same bytes; the buffers grew by TANGENT and the copied
rows. With --tangents, corners have the tangents that REFERENCE has. With --quantized, OUTPUT requires
KHR_mesh_quantization and its tangents are normalized integers. With --welded, no two vertices of OUTPUT are equal in
everything that primitives with one of their accessors have, and the buffers lost what INPUT had of those.

With --outputs, references are followed: what an accessor or a view holds is compared, whatever its number, and of primitives
what each corner has, whatever its vertex.
"""
import base64
import copy
import hashlib
import json
import os
import struct
import sys
from urllib.parse import unquote

SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
WIDTHS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT2': 4, 'MAT3': 9, 'MAT4': 16}
ADDED = ('TANGENT', '_BITANGENT', 'NORMAL')
complaints = []


def complain(text):
    complaints.append(text)


class File:
    def __init__(self, path):
        self.path = path
        with open(path, 'rb') as f:
            data = f.read()
        self.chunk, self.others = None, []
        if data[:4] == b'glTF':
            at, n = 12, 0
            while at + 8 <= len(data):
                size, kind = struct.unpack_from('<II', data, at)
                body = data[at + 8:at + 8 + size]
                if n == 0:
                    text = body
                elif n == 1 and kind == 0x004E4942:
                    self.chunk = body
                else:
                    self.others.append((kind, body))
                at, n = at + 8 + size, n + 1
        else:
            text = data
        self.g = json.loads(text)
        self.cache = {}
        for buffer in self.g.get('buffers', []):
            self.forget_record(buffer)

    def forget_record(self, buffer):
        """The digest that nmtan notes of a .bin that it wrote."""
        extras = buffer.get('extras')
        if isinstance(extras, dict) and 'nmtan:xxh128' in extras:
            del extras['nmtan:xxh128']
            if not extras:
                del buffer['extras']

    def buffer(self, i):
        if i not in self.cache:
            uri = self.g['buffers'][i].get('uri')
            if uri is None:
                self.cache[i] = self.chunk or b''
            elif uri.startswith('data:'):
                self.cache[i] = base64.b64decode(uri.split(',', 1)[1])
            else:
                with open(os.path.join(os.path.dirname(self.path), unquote(uri)), 'rb') as f:
                    self.cache[i] = f.read()
        return self.cache[i]

    def view(self, i):
        v = self.g['bufferViews'][i]
        o = v.get('byteOffset', 0)
        return self.buffer(v['buffer'])[o:o + v['byteLength']]

    def element(self, a):
        """Columns of matrices begin at multiples of four bytes."""
        columns = {'MAT2': 2, 'MAT3': 3}.get(a['type'], 1)
        column = SIZES[a['componentType']] * WIDTHS[a['type']] // columns
        return columns * ((column + 3) // 4 * 4 if columns > 1 else column)

    def rows(self, i):
        """The bytes of each element."""
        a = self.g['accessors'][i]
        size, count = self.element(a), a['count']
        rows = [b'\0' * size] * count
        if 'bufferView' in a:
            data = self.view(a['bufferView'])
            stride = self.g['bufferViews'][a['bufferView']].get('byteStride') or size
            o = a.get('byteOffset', 0)
            if count and o + (count - 1) * stride + size > len(data):
                complain('accessor %d ends behind its view' % i)
                return rows
            rows = [data[o + k * stride:o + k * stride + size] for k in range(count)]
        if 'sparse' in a:
            s = a['sparse']
            w = SIZES[s['indices']['componentType']]
            where = self.view(s['indices']['bufferView'])[s['indices'].get('byteOffset', 0):]
            values = self.view(s['values']['bufferView'])[s['values'].get('byteOffset', 0):]
            last = -1
            for k in range(s['count']):
                row = int.from_bytes(where[k * w:k * w + w], 'little')
                if not last < row < count:
                    complain('accessor %d: sparse indices are not in order' % i)
                last = row
                rows[row] = values[k * size:k * size + size]
        return rows

    def packs_triangles(self, p):
        """Whether a codec of triangles stores a primitive's indices."""
        view = self.g['accessors'][p['indices']].get('bufferView') if 'indices' in p else None
        packed = {} if view is None else self.g['bufferViews'][view].get('extensions', {})
        return any(e.get('mode') == 'TRIANGLES' for n, e in packed.items() if 'meshopt' in n)

    def corners(self, p):
        """Vertex of each corner of each triangle; the plain list for points and lines."""
        mode = p.get('mode', 4)
        if 'indices' in p:
            chain = [int.from_bytes(r, 'little') for r in self.rows(p['indices'])]
            width = SIZES[self.g['accessors'][p['indices']]['componentType']]
            if chain and max(chain) == (1 << 8 * width) - 1:
                complain('indices use the reserved value')
        else:
            chain = list(range(self.g['accessors'][p['attributes']['POSITION']]['count']))
        if mode == 5:
            chain = [c for i in range(len(chain) - 2)
                     for c in (chain[i], chain[i + 1 + i % 2], chain[i + 2 - i % 2])]
        elif mode == 6:
            chain = [c for i in range(len(chain) - 2) for c in (chain[i + 1], chain[i + 2], chain[0])]
        return chain


def turned(a, b, p, q):
    """Corners of the new file, whose codec of triangles may begin one with any corner: with the one of the old file."""
    old, new = a.corners(p), b.corners(q)
    if len(old) != len(new) or not b.packs_triangles(q):
        return new
    rows = [(a.rows(i), b.rows(q['attributes'][n])) for n, i in p['attributes'].items() if n != 'TANGENT']
    for t in range(0, len(old), 3):
        for k in range(3):
            turn = [new[t + (i + k) % 3] for i in range(3)]
            if all(x[i] == y[j] for x, y in rows for i, j in zip(old[t:t + 3], turn)):
                new[t:t + 3] = turn
                break
    return new


def same_geometry(a, b):
    for m, mesh in enumerate(a.g.get('meshes', [])):
        for k, p in enumerate(mesh['primitives']):
            q = b.g['meshes'][m]['primitives'][k]
            where = 'mesh %d primitive %d' % (m, k)
            old, new = a.corners(p), turned(a, b, p, q)
            if len(old) != len(new):
                complain('%s: %d corners became %d' % (where, len(old), len(new)))
                continue
            pairs = [(p['attributes'], q['attributes'])]
            pairs += list(zip(p.get('targets', []), q.get('targets', [])))
            counts = set()
            for before, after in pairs:
                counts |= {b.g['accessors'][i]['count'] for i in after.values()}
                for name, accessor in before.items():
                    if name == 'TANGENT':
                        continue
                    x, y = a.rows(accessor), b.rows(after[name])
                    wrong = sum(x[i] != y[j] for i, j in zip(old, new))
                    if wrong:
                        complain('%s: %s differs at %d corners' % (where, name, wrong))
            if len(counts) > 1:
                complain('%s: attributes of different counts %s' % (where, sorted(counts)))


class Own:
    """Accessors that only TANGENT uses in the input: it may change its type, and its view may take other content."""
    accessors, views = set(), set()

    @classmethod
    def find(cls, g):
        primitives = [p for m in g.get('meshes', []) for p in m['primitives']]
        others = {i for p in primitives for o in [p['attributes']] + p.get('targets', [])
                  for n, i in o.items() if n != 'TANGENT'} | {p.get('indices') for p in primitives}
        cls.accessors = {p['attributes'].get('TANGENT') for p in primitives} - others
        parts = lambda a: {a.get('bufferView')} | {x.get('bufferView') for x in a.get('sparse', {}).values()
                                                   if isinstance(x, dict)}
        kept = set().union(*[parts(a) for i, a in enumerate(g.get('accessors', [])) if i not in cls.accessors])
        cls.views = set().union(*[parts(g['accessors'][i]) for i in cls.accessors if i is not None]) - kept


def allowed(path, key):
    """Whether a member may differ, appear or go."""
    head = path[0] if path else ''
    if head == 'accessors' and len(path) == 2 and path[1] in Own.accessors and key in ('normalized', 'sparse'):
        return True
    if head == 'bufferViews' and len(path) == 2 and path[1] in Own.views and key in ('buffer', 'byteStride', 'target'):
        return True
    if head == 'accessors':
        return key in ('bufferView', 'byteOffset', 'count', 'componentType', 'min', 'max') if len(path) == 2 else True
    if head == 'bufferViews':
        return key in ('byteOffset', 'byteLength')
    if head == 'buffers':
        return key in ('byteLength', 'uri')
    if head == 'images':
        return key in ('uri', 'bufferView', 'mimeType')
    if head == 'meshes':
        # the value of an attribute that other primitives share may be a copy of the accessor
        return key in ADDED + ('indices', 'mode') or path[-1] == 'attributes' or 'targets' in path
    return False


def same_json(a, b, path=()):
    where = '/' + '/'.join(map(str, path))
    if isinstance(a, dict) and isinstance(b, dict):
        if [k for k in a if k in b] != [k for k in b if k in a]:
            complain('%s: keys in another order' % where)
        for k in list(a) + [k for k in b if k not in a]:
            if k in a and k in b:
                if not (allowed(path, k) and not isinstance(a[k], (dict, list))):
                    same_json(a[k], b[k], path + (k,))
            elif not allowed(path, k) and not (not path and k in ('buffers', 'bufferViews', 'accessors')):
                complain('%s/%s %s' % (where, k, 'is gone' if k in a else 'is new'))
    elif isinstance(a, list) and isinstance(b, list):
        may_grow = path in (('accessors',), ('bufferViews',), ('buffers',))
        if len(a) > len(b) or (len(a) < len(b) and not may_grow):
            complain('%s has %d elements, had %d' % (where, len(b), len(a)))
        for i, (x, y) in enumerate(zip(a, b)):
            same_json(x, y, path + (i,))
    elif type(a) is not type(b) and not (isinstance(a, (int, float)) and isinstance(b, (int, float))) or a != b:
        if not (len(path) >= 3 and path[0] == 'accessors' and path[2] in ('min', 'max')):
            complain('%s: %r became %r' % (where, a, b))


def same_views(a, b):
    used = {x.get('bufferView') for x in a.g.get('accessors', [])}
    for x in a.g.get('accessors', []):
        for part in ('indices', 'values'):
            used.add(x.get('sparse', {}).get(part, {}).get('bufferView'))
    for i in range(len(a.g.get('bufferViews', []))):
        if i not in used and a.view(i) != b.view(i):
            complain('view %d holds other bytes' % i)
    if a.others and b.chunk is not None and a.others != b.others:
        complain('extra chunks are gone')


def bytes_of(f, a):
    size = a['count'] * f.element(a) * ('bufferView' in a)
    if 'sparse' in a:
        size += a['sparse']['count'] * (SIZES[a['sparse']['indices']['componentType']] + f.element(a))
    return size


def pools(f):
    """Accessors of primitives that share one, as lists of numbers; those over the same bytes are one."""
    place = lambda i: json.dumps([f.g['accessors'][i].get(k) for k in ('bufferView', 'byteOffset', 'type', 'sparse')])
    lists = []
    for mesh in f.g['meshes']:
        for p in mesh['primitives']:
            own = {place(i): i for o in [p['attributes']] + p.get('targets', []) for i in o.values()}
            for other in [x for x in lists if x.keys() & own.keys()]:
                own.update(other)
                lists.remove(other)
            lists.append(own)
    return [sorted(x.values()) for x in lists]


def no_equal_vertices(f):
    for pool in pools(f):
        vertices = list(zip(*[f.rows(i) for i in pool]))
        if len(set(vertices)) != len(vertices):
            complain('%d of %d vertices are equal to others' % (len(vertices) - len(set(vertices)), len(vertices)))


def no_dead_bytes(a, b, welded):
    total = lambda f: sum(x['byteLength'] for x in f.g.get('buffers', []))
    grown = least = 0
    slack = 16
    seen = set()
    for i, x in enumerate(b.g.get('accessors', [])):
        place = json.dumps([x.get(k) for k in ('bufferView', 'byteOffset', 'type', 'sparse')])
        if welded and place in seen:
            continue
        seen.add(place)
        if i >= len(a.g['accessors']):
            grown += x['count'] * ((b.element(x) + 3) // 4 * 4)
        else:
            old = a.g['accessors'][i]
            view = b.g['bufferViews'][x['bufferView']] if 'bufferView' in x else {}
            added = bytes_of(b, x) - bytes_of(a, old)
            grown += added
            # a column of a block may be narrower than its stride
            wide = max(view.get('byteStride', 0), b.element(x)) / b.element(x) if welded else 1
            least += min(added, 0) * (welded or i in Own.accessors) * wide
            slack += 8 * welded
            slack += 8 * (added != 0) + (view.get('byteStride', 0) - b.element(x)) * max(0, x['count'] - old['count']) * (
                'byteStride' in view)
    if 'images' in a.g:
        grown += sum(len(b.view(i['bufferView'])) for i, j in zip(b.g['images'], a.g['images'])
                     if 'bufferView' in i and 'bufferView' not in j)
    if not least - 16 * (least < 0) <= total(b) - total(a) <= grown + slack:
        complain('buffers grew by %d, expected at most %d' % (total(b) - total(a), grown + slack))


def corner_tangents(f):
    out = []
    for mesh in f.g['meshes']:
        for p in mesh['primitives']:
            if 'TANGENT' in p['attributes']:
                rows = f.rows(p['attributes']['TANGENT'])
                out += [struct.unpack('<4f', rows[i]) for i in f.corners(p)]
    return out


def take_quantization(a, b):
    for key in ('extensionsUsed', 'extensionsRequired'):
        if 'KHR_mesh_quantization' not in b.g.get(key, []):
            complain('%s has no KHR_mesh_quantization' % key)
        elif 'KHR_mesh_quantization' not in a.g.get(key, []):
            b.g[key].remove('KHR_mesh_quantization')
            if not b.g[key]:
                del b.g[key]
    for mesh in b.g['meshes']:
        for p in mesh['primitives']:
            accessor = b.g['accessors'][p['attributes']['TANGENT']] if 'TANGENT' in p['attributes'] else None
            if accessor and (accessor['componentType'] not in (5120, 5122) or not accessor.get('normalized')):
                complain('a TANGENT is of type %d' % accessor['componentType'])


def digest(rows):
    return hashlib.sha256(b''.join(rows)).hexdigest()[:16]


class Resolved:
    """The JSON of a file in which references to accessors and views are replaced by what is there."""
    PLACES = ('buffer', 'byteOffset', 'byteLength')

    def __init__(self, f):
        self.f, self.seen = f, {}
        self.g = copy.deepcopy(f.g)
        for mesh in self.g.get('meshes', []):
            for p in mesh['primitives']:
                self.primitive(p)
        for animation in self.g.get('animations', []):
            for sampler in animation['samplers']:
                self.name(sampler, ('input', 'output'))
        for skin in self.g.get('skins', []):
            self.name(skin, ('inverseBindMatrices',))
        self.walk(self.g)
        for name in ('accessors', 'bufferViews'):
            self.g.pop(name, None)
        for buffer in self.g.get('buffers', []):
            buffer.pop('byteLength', None), buffer.pop('uri', None)
        # how many there are is a matter of layout
        self.g['buffers'] = [x for x in self.g.get('buffers', []) if x]

    def view(self, i):
        if not isinstance(i, int) or i >= len(self.f.g.get('bufferViews', [])):
            return i
        view = copy.deepcopy(self.f.g['bufferViews'][i])
        packed = next((e for n, e in view.get('extensions', {}).items() if 'meshopt' in n), None)
        place = view if packed is None else packed
        at = place.get('byteOffset', 0)
        bytes_there = self.f.buffer(place['buffer'])[at:at + place['byteLength']]
        for part in (view, place):
            for key in self.PLACES:
                part.pop(key, None)
        return dict(view, bytes=digest([bytes_there]), length=len(bytes_there))

    def accessor(self, i, corners=None):
        """The values of an accessor; of a primitive's, those of its corners."""
        if not isinstance(i, int) or i >= len(self.f.g.get('accessors', [])):
            return i
        a = self.f.g['accessors'][i]
        found = {k: v for k, v in a.items() if k not in ('bufferView', 'byteOffset', 'sparse')}
        view = self.view(a['bufferView']) if 'bufferView' in a else {}
        if 'extensions' in view:
            return dict(found, packed=view, at=a.get('byteOffset', 0))
        found['view'] = {k: v for k, v in view.items() if k not in ('bytes', 'length', 'byteStride')}
        if 'bufferView' in a or 'sparse' in a:
            if i not in self.seen:
                self.seen[i] = self.f.rows(i)
            rows = self.seen[i]
            found['values'] = digest(rows) if corners is None else digest([rows[c] for c in corners])
        return found

    def name(self, holder, keys, corners=None):
        for key in keys:
            if key in holder:
                holder[key] = self.accessor(holder[key], corners)

    def primitive(self, p):
        draco = 'KHR_draco_mesh_compression' in p.get('extensions', {})
        packed = self.f.packs_triangles(p)
        # a codec's own corners are told by its bytes
        corners = None if draco or packed else self.f.corners(p)
        for attributes in [p['attributes']] + p.get('targets', []):
            self.name(attributes, list(attributes), corners)
        if 'indices' in p:
            p['indices'] = self.accessor(p['indices'], None if corners is None else ())
            if corners is not None:
                p['indices']['count'] = len(corners)

    def walk(self, x):
        """Views, and accessors of extensions, wherever they are named."""
        for key, value in x.items() if isinstance(x, dict) else enumerate(x):
            if key == 'bufferView' or key in ('values', 'arrayOffsets', 'stringOffsets') and isinstance(value, int):
                x[key] = self.view(value)
            elif key == 'EXT_mesh_gpu_instancing':
                self.name(value.get('attributes', {}), list(value.get('attributes', {})))
            elif key == 'EXT_mesh_manifold':
                self.name(value.get('manifoldPrimitive', {}), ['indices'])
                self.name(value, ['mergeIndices', 'mergeValues'])
            elif key == 'CESIUM_primitive_outline':
                self.name(value, ['indices'])
            elif isinstance(value, (dict, list)):
                self.walk(value)


def compare_resolved(a, b, path=''):
    if isinstance(a, dict) and isinstance(b, dict):
        for k in list(a) + [k for k in b if k not in a]:
            if k in a and k in b:
                compare_resolved(a[k], b[k], '%s/%s' % (path, k))
            else:
                complain('%s/%s %s' % (path, k, 'is gone' if k in a else 'is new'))
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for i, (x, y) in enumerate(zip(a, b)):
            compare_resolved(x, y, '%s/%d' % (path, i))
    elif a != b and not (a != a and b != b):
        show = lambda x: '%d elements' % len(x) if isinstance(x, (list, dict)) else repr(x)
        complain('%s: %s became %s' % (path, show(a), show(b)))


def tell(name):
    for text in complaints[:20]:
        print('%s: %s' % (os.path.basename(name), text))
    sys.exit(1 if complaints else 0)


def main():
    if sys.argv[1] == '--outputs':
        compare_resolved(Resolved(File(sys.argv[2])).g, Resolved(File(sys.argv[3])).g)
        tell(sys.argv[3])
    quantized, welded = '--quantized' in sys.argv, '--welded' in sys.argv
    sys.argv = [x for x in sys.argv if x not in ('--quantized', '--welded')]
    a, b = File(sys.argv[1]), File(sys.argv[2])
    if quantized:
        take_quantization(a, b)
    Own.find(a.g)
    same_json(a.g, b.g)
    same_geometry(a, b)
    same_views(a, b)
    no_dead_bytes(a, b, welded)
    if welded:
        no_equal_vertices(b)
    for option in sys.argv[3:]:
        r = File(option.split('=', 1)[1])
        mine, theirs = corner_tangents(b), corner_tangents(r)
        if mine != theirs:
            wrong = sum(x != y for x, y in zip(mine, theirs))
            complain('tangents differ from the reference at %d of %d corners (%d)' % (wrong, len(mine), len(theirs)))
    tell(sys.argv[2])


if __name__ == '__main__':
    main()

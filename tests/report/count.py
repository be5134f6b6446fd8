#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
#
# count.py FILE.obj
#
# An independent count of what the report counts, over OBJ files of one object whose faces are triangles or
# quads: exact rational arithmetic, dictionaries of positions, nothing shared with the tool. Prints
# normal, mirrored, degenerate triangles; edges, boundary, non-manifold, inconsistent and mirror edges; UV
# islands. The vertices of a face are read as the file has them: nothing is welded but equal numbers.
import sys
from fractions import Fraction


def f32(text):
    import struct
    return Fraction(struct.unpack('f', struct.pack('f', float(text)))[0])


def read(name):
    positions, texcoords, faces = [], [], []
    for line in open(name):
        words = line.split()
        if not words:
            continue
        if words[0] == 'v':
            positions.append(tuple(f32(w) for w in words[1:4]))
        elif words[0] == 'vt':
            texcoords.append(tuple(f32(w) for w in words[1:3]))
        elif words[0] == 'f':
            face = []
            for word in words[1:]:
                numbers = word.split('/')
                p, t = int(numbers[0]), int(numbers[1])
                face.append((positions[p - 1 if p > 0 else p], texcoords[t - 1 if t > 0 else t]))
            faces.append(face)
    return faces


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b))


def triangles(faces):
    for face in faces:
        if len(face) == 3:
            yield face
            continue
        assert len(face) == 4, 'triangles and quads only'
        a, b, c, d = face
        first, second = distance(a[1], c[1]), distance(b[1], d[1])
        if first == second:
            first, second = distance(a[0], c[0]), distance(b[0], d[0])
        if second < first:
            yield [a, b, d]
            yield [b, c, d]
        else:
            yield [a, b, c]
            yield [a, c, d]


def orientation(triangle):
    (au, av), (bu, bv), (cu, cv) = (corner[1] for corner in triangle)
    det = (bu - au) * (cv - av) - (bv - av) * (cu - au)
    return (det > 0) - (det < 0)


def main():
    tris = list(triangles(read(sys.argv[1])))
    signs = [orientation(t) for t in tris]
    edges = {}
    for number, triangle in enumerate(tris):
        if len({corner[0] for corner in triangle}) < 3:
            continue
        for k in range(3):
            a, b = triangle[k], triangle[(k + 1) % 3]
            forward = a[0] < b[0]
            low, high = (a, b) if forward else (b, a)
            edges.setdefault((low[0], high[0]), []).append((number, forward, (low[1], high[1])))
    boundary = sum(len(sides) == 1 for sides in edges.values())
    many = sum(len(sides) > 2 for sides in edges.values())
    inconsistent = sum(len(s) == 2 and s[0][1] == s[1][1] for s in edges.values())
    mirror = sum({1, -1} <= {signs[side[0]] for side in sides} for sides in edges.values())

    group = list(range(len(tris)))

    def top(i):
        while group[i] != i:
            group[i] = group[group[i]]
            i = group[i]
        return i

    with_edges = set()
    for sides in edges.values():
        seen = {}
        for number, _, coordinates in sides:
            with_edges.add(number)
            if coordinates in seen:
                group[top(number)] = top(seen[coordinates])
            else:
                seen[coordinates] = number
    islands = len({top(i) for i in with_edges})
    print(signs.count(1), signs.count(-1), signs.count(0), len(edges), boundary, many, inconsistent, mirror,
          islands)


main()

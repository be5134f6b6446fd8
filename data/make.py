#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the meshes of data/ (they are committed; this says where they come from and makes them again).

    python3 data/make.py [DIR]      default: the folder of this script

quad.obj            one quad, upright texture: the smallest thing that has tangents
mirrored_cube.obj   a cube whose left half carries the mirrored texture of its right half, with a
                    material and a normal map; 8 vertices on the mirror plane have to be split
head.obj            a symmetric head-like surface of smooth quads, mirrored at x = 0
plates.gltf, .glb   three primitives: normal texture, no slot at all, clearcoat normal texture
quad_*.ply          the quad in the variants of PLY: ascii, little and big endian, texture
                    coordinates per vertex and per face corner
"""
import json
import math
import os
import struct
import sys
import zlib

HERE = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))


def save(name, data):
    with open(os.path.join(HERE, name), "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())


def number(value):
    text = "%.6g" % (value + 0.0)
    return "0" if text == "-0" else text


def png(width, height, pixel):
    """An RGB image; pixel(x, y) gives three bytes."""
    def chunk(kind, body):
        return (struct.pack(">I", len(body)) + kind + body
                + struct.pack(">I", zlib.crc32(kind + body)))
    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in pixel(x, y)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def normal_map():
    """Sixteen by sixteen: one round bump, green up."""
    def pixel(x, y):
        dx, dy = (x - 7.5) / 8, (7.5 - y) / 8
        r = math.hypot(dx, dy)
        k = 0.7 * math.sin(math.pi * r) / r if 0 < r < 1 else 0.0
        nx, ny = dx * k, dy * k
        nz = math.sqrt(max(0.0, 1 - nx * nx - ny * ny))
        return [round(127.5 + 127.5 * c) for c in (nx, ny, nz)]
    return png(16, 16, pixel)


def quad_obj():
    save("quad.obj", "# one quad, texture upright\no quad\n"
         "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
         "f 1/1/1 2/2/1 3/3/1 4/4/1\n")


class Obj:
    """Collects corners and writes each distinct v, vt, vn once."""

    def __init__(self):
        self.lists, self.maps, self.faces = ([], [], []), ({}, {}, {}), []

    def corner(self, *rows):
        indices = []
        for rows_so_far, known, row in zip(self.lists, self.maps, rows):
            key = " ".join(number(c) for c in row)
            if key not in known:
                known[key] = len(rows_so_far) + 1
                rows_so_far.append(key)
            indices.append(str(known[key]))
        return "/".join(indices)

    def text(self, head):
        out = [head]
        for word, rows in zip(("v", "vt", "vn"), self.lists):
            out += ["%s %s" % (word, row) for row in rows]
        return "\n".join(out + self.faces_text()) + "\n"

    def faces_text(self):
        return self.faces


def mirrored_cube():
    obj = Obj()

    def face(normal, corners, uvs):
        obj.faces.append("f " + " ".join(obj.corner(p, t, normal) for p, t in zip(corners, uvs)))

    # The sides at +x and -x: the same texture, mirrored on the left.
    face((1, 0, 0), [(1, -1, 1), (1, -1, -1), (1, 1, -1), (1, 1, 1)],
         [(0.5, 0), (1, 0), (1, 1), (0.5, 1)])
    face((-1, 0, 0), [(-1, -1, -1), (-1, -1, 1), (-1, 1, 1), (-1, 1, -1)],
         [(1, 0), (0.5, 0), (0.5, 1), (1, 1)])
    # The other four, cut at x = 0; u grows with the distance from the cut. a(x) is the lower edge and
    # b(x) the upper one, so that b - a is the direction of v.
    for normal, a, b in (((0, 0, 1), lambda x: (x, -1, 1), lambda x: (x, 1, 1)),
                         ((0, 0, -1), lambda x: (x, 1, -1), lambda x: (x, -1, -1)),
                         ((0, 1, 0), lambda x: (x, 1, 1), lambda x: (x, 1, -1)),
                         ((0, -1, 0), lambda x: (x, -1, -1), lambda x: (x, -1, 1))):
        face(normal, [a(0), a(1), b(1), b(0)], [(0, 0), (0.5, 0), (0.5, 1), (0, 1)])
        face(normal, [a(-1), a(0), b(0), b(-1)], [(0.5, 0), (0, 0), (0, 1), (0.5, 1)])
    head = "# a cube, textured by mirroring at x = 0\nmtllib mirrored_cube.mtl\no cube"
    obj.faces.insert(0, "usemtl bumps")
    save("mirrored_cube.obj", obj.text(head))
    save("mirrored_cube.mtl", "newmtl bumps\nKd 0.8 0.7 0.6\nPr 0.5\nPm 0\nnorm bumps.png\n")
    save("bumps.png", normal_map())


def head_obj(columns=12, rows=14):
    """An ellipsoid with a nose. Columns run over half the head, from the nose's line to the neck's; the
    left half mirrors the right one."""
    def point(i, j):
        around = math.pi * i / columns            # 0: front, pi: back
        up = math.pi * (0.06 + 0.88 * j / rows)   # stays away from the poles
        nose = 0.35 * math.exp(-((around / 0.22) ** 2 + ((up - 1.75) / 0.18) ** 2))
        ring = math.sin(up)
        return (0.75 * ring * math.sin(around),
                -1.05 * math.cos(up),
                (0.9 + nose) * ring * math.cos(around))

    def normal(i, j):
        def sub(a, b):
            return [x - y for x, y in zip(a, b)]
        u, v = sub(point(i + 1e-3, j), point(i - 1e-3, j)), sub(point(i, j + 1e-3), point(i, j - 1e-3))
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        if i in (0, columns):
            n = (0.0, n[1], n[2])  # the plane of symmetry
        length = math.sqrt(sum(c * c for c in n))
        return tuple(c / length for c in n)

    obj = Obj()
    for side in (1, -1):
        def corner(i, j):
            p, n = point(i, j), normal(i, j)
            x = 0.0 if i in (0, columns) else p[0]
            return obj.corner((side * x, p[1], p[2]), (i / columns, j / rows), (side * n[0], n[1], n[2]))
        for j in range(rows):
            for i in range(columns):
                ring = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
                obj.faces.append("f " + " ".join(ring if side == 1 else ring[::-1]))
    save("head.obj", obj.text("# a head of sorts, textured by mirroring at x = 0\no head\ns 1"))


def plates():
    """Three plates side by side, one primitive each."""
    buffer = bytearray()
    views, accessors = [], []

    def accessor(rows, kind, width, component, target):
        flat = [c for row in rows for c in row]
        views.append({"buffer": 0, "byteOffset": len(buffer),
                      "byteLength": len(flat) * struct.calcsize(component), "target": target})
        buffer.extend(struct.pack("<%d%s" % (len(flat), component), *flat))
        buffer.extend(b"\0" * (-len(buffer) % 4))
        entry = {"bufferView": len(views) - 1, "componentType": {"f": 5126, "H": 5123}[component],
                 "count": len(rows), "type": kind}
        if target == 34962 and kind == "VEC3" and width == "position":
            entry["min"] = [min(row[k] for row in rows) for k in range(3)]
            entry["max"] = [max(row[k] for row in rows) for k in range(3)]
        accessors.append(entry)
        return len(accessors) - 1

    def plate(x, material, mirrored):
        """Two by one quads; on a mirrored plate the second quad carries the first one's texture
        backwards, over shared vertices."""
        positions = [(x + i, j, 0.0) for j in range(2) for i in range(3)]
        us = [0.0, 1.0, 0.0] if mirrored else [0.0, 0.5, 1.0]
        uvs = [(us[i], 1.0 - j) for j in range(2) for i in range(3)]
        triangles = [(0,), (1,), (4,), (0,), (4,), (3,), (1,), (2,), (5,), (1,), (5,), (4,)]
        return {"attributes": {
            "POSITION": accessor(positions, "VEC3", "position", "f", 34962),
            "NORMAL": accessor([(0.0, 0.0, 1.0)] * 6, "VEC3", "normal", "f", 34962),
            "TEXCOORD_0": accessor(uvs, "VEC2", "uv", "f", 34962)},
            "indices": accessor(triangles, "SCALAR", "index", "H", 34963), "material": material}

    primitives = [plate(0.0, 0, True), plate(3.0, 1, False), plate(6.0, 2, False)]
    document = {
        "asset": {"version": "2.0", "generator": "data/make.py"},
        "extensionsUsed": ["KHR_materials_clearcoat"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "plates", "mesh": 0, "extras": {"id": 9007199254740993, "note": {}}}],
        "meshes": [{"name": "plates", "primitives": primitives}],
        "materials": [
            {"name": "bumpy", "normalTexture": {"index": 0, "scale": 0.5}},
            {"name": "plain", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}},
            {"name": "coated", "extensions": {"KHR_materials_clearcoat": {
                "clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}}}}],
        "textures": [{"source": 0}],
        "images": [{"uri": "bumps.png"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": "plates.bin", "byteLength": len(buffer)}],
    }
    save("plates.bin", bytes(buffer))
    save("plates.gltf", json.dumps(document, indent=1) + "\n")

    image = normal_map()
    views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(image)})
    buffer.extend(image)
    buffer.extend(b"\0" * (-len(buffer) % 4))
    document["images"] = [{"bufferView": len(views) - 1, "mimeType": "image/png"}]
    document["buffers"] = [{"byteLength": len(buffer)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    save("plates.glb", struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(buffer))
         + struct.pack("<I4s", len(text), b"JSON") + text
         + struct.pack("<I4s", len(buffer), b"BIN\0") + bytes(buffer))


def quad_plys():
    points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    uvs = [(0, 0), (1, 0), (1, 1), (0, 1)]
    vertex = ("element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
              "property float nx\nproperty float ny\nproperty float nz\n")
    uv = "property float s\nproperty float t\n"
    face = "element face 1\nproperty list uchar int vertex_indices\n"
    rows = [p + (0, 0, 1) + t for p, t in zip(points, uvs)]
    save("quad_ascii.ply", "ply\nformat ascii 1.0\ncomment one quad, texture upright\n" + vertex + uv
         + face + "end_header\n"
         + "".join(" ".join(str(c) for c in row) + "\n" for row in rows) + "4 0 1 2 3\n")
    for name, order, sign in (("le", "little", "<"), ("be", "big", ">")):
        save("quad_%s.ply" % name,
             ("ply\nformat binary_%s_endian 1.0\n" % order + vertex + uv + face + "end_header\n").encode()
             + b"".join(struct.pack(sign + "8f", *row) for row in rows)
             + struct.pack(sign + "B4i", 4, 0, 1, 2, 3))
    save("quad_wedge.ply",
         ("ply\nformat binary_little_endian 1.0\n" + vertex
          + "element face 2\nproperty list uchar int vertex_indices\n"
          "property list uchar float texcoord\nend_header\n").encode()
         + b"".join(struct.pack("<6f", *(p + (0, 0, 1))) for p in points)
         + b"".join(struct.pack("<B3iB6f", 3, *ring, 6, *(c for k in ring for c in uvs[k]))
                    for ring in ((0, 1, 2), (0, 2, 3))))


quad_obj()
mirrored_cube()
head_obj()
plates()
quad_plys()

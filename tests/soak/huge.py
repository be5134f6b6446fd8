#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""huge.py NMTAN FOLDER: .bin files of more than 4 GiB, sparse, with vertices and indices behind the first 4 GiB.

The mesh is a strip of two quads over one row of texture coordinates, u = |x|: its left half is mirrored, so that
the two vertices in the middle split, which moves everything behind them. Its tangents are known without a program:
u grows along +x on the right and along -x on the left, w is 1 and -1 (v runs down in glTF, along -y here).
It checks: exit codes, where the bytes lie, the bytes, and the tool's peak of memory."""
import array
import json
import os
import sys

TOOL, FOLDER = sys.argv[1], sys.argv[2]
GIB = 1 << 30
FAR = 4 * GIB + 4096      # where the geometry begins
LENGTH = FAR + 300000000  # of the .bin: what lies behind the geometry has to move
MARK = b"the last bytes of a long file..."
MOST_MEGABYTES = 64
failed = passed = 0


def check(name, good, said=""):
    global failed, passed
    passed, failed = passed + bool(good), failed + (not good)
    if not good:
        print(f"FAILED {name}: {said}")


POSITIONS = [(x, y, 0) for y in (0, 1) for x in (-1, 0, 1)]
ROWS = array.array("f", [k for p in POSITIONS for k in (*p, 0, 0, 1, abs(p[0]), 1 - p[1])]).tobytes()
INDICES = array.array("H", (0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4)).tobytes()


def document(buffers, vertices, indices, mark, accessor_offset=0):
    """vertices, indices, mark: (buffer, byteOffset) of their views."""
    def view(place, size, **more):
        return {"buffer": place[0], "byteOffset": place[1] - accessor_offset, "byteLength": size + accessor_offset, **more}
    def accessor(number, offset, component, kind, count, **more):
        return {"bufferView": number, "byteOffset": offset, "componentType": component, "count": count, "type": kind, **more}
    far = accessor_offset
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "materials": [{"normalTexture": {"index": 0}}], "textures": [{}], "buffers": buffers,
            "bufferViews": [view(vertices, len(ROWS), byteStride=32), view(indices, len(INDICES)), view(mark, len(MARK))],
            "accessors": [accessor(0, far, 5126, "VEC3", 6, min=[-1, 0, 0], max=[1, 1, 0]),
                          accessor(0, far + 12, 5126, "VEC3", 6), accessor(0, far + 24, 5126, "VEC2", 6),
                          accessor(1, far, 5123, "SCALAR", 12), accessor(2, far, 5121, "SCALAR", len(MARK))],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3,
                                        "material": 0}]}]}


def store(path, length, pieces):
    with open(path, "wb") as file:
        file.truncate(length)
        for offset, piece in pieces:
            file.seek(offset)
            file.write(piece)


def store_json(path, value):
    with open(path, "w") as file:
        json.dump(value, file)


def convert(*words):
    """Exit code, messages and peak in MB."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.dup2(writer, 2)
        os.close(reader)
        os.execv(TOOL, [TOOL, *words])
    os.close(writer)
    with os.fdopen(reader) as pipe:
        said = pipe.read()
    _, status, usage = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(status), said, usage.ru_maxrss // 1024


class Result:
    def __init__(self, path):
        self.folder = os.path.dirname(path)
        with open(path) as file:
            self.json = json.load(file)

    def buffer(self, view):
        return os.path.normpath(os.path.join(self.folder, self.json["buffers"][view["buffer"]]["uri"]))

    def rows(self, number):
        a = self.json["accessors"][number]
        view = self.json["bufferViews"][a["bufferView"]]
        code, size = {5126: ("f", 4), 5123: ("H", 2), 5121: ("B", 1)}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[a["type"]]
        result = []
        with open(self.buffer(view), "rb") as file:
            for i in range(a["count"]):
                file.seek(view.get("byteOffset", 0) + a.get("byteOffset", 0) + i * view.get("byteStride", size * width))
                result.append(tuple(array.array(code, file.read(size * width))))
        return result

    def attribute(self, name):
        return self.rows(self.json["meshes"][0]["primitives"][0]["attributes"][name])


def check_result(name, path):
    """The solved strip: eight vertices, and what each corner sees."""
    result = Result(path)
    positions, tangents = result.attribute("POSITION"), result.attribute("TANGENT")
    normals, texcoords = result.attribute("NORMAL"), result.attribute("TEXCOORD_0")
    indices = [i for (i,) in result.rows(result.json["meshes"][0]["primitives"][0]["indices"])]
    check(name + ": rows", positions[:6] == [tuple(map(float, p)) for p in POSITIONS] and len(positions) == 8 and
          len(tangents) == 8, f"{positions} {tangents}")
    corners = [positions[i] for i in indices]
    old = array.array("H", INDICES)
    check(name + ": corners", corners == [tuple(map(float, POSITIONS[i])) for i in old], corners)
    expected = [(-1, 0, 0, -1)] * 6 + [(1, 0, 0, 1)] * 6
    check(name + ": tangents", [tangents[i] for i in indices] == expected, [tangents[i] for i in indices])
    check(name + ": others", all(n == (0, 0, 1) for n in normals) and
          all(t == (abs(p[0]), 1 - p[1]) for p, t in zip(positions, texcoords)), texcoords)
    check(name + ": what lies behind", bytes(b for (b,) in result.rows(4)) == MARK)
    for number, buffer in enumerate(result.json["buffers"]):
        there = os.path.getsize(os.path.join(result.folder, buffer["uri"]))
        check(f"{name}: buffer {number}", there >= buffer["byteLength"], f"{there} of {buffer['byteLength']}")
    return result


def main():
    def at(*names):
        return os.path.join(FOLDER, *names)
    os.mkdir(at("in"))
    os.mkdir(at("out"))
    end = LENGTH - len(MARK)
    store(at("in", "huge.bin"), LENGTH, [(FAR, ROWS), (FAR + 1024, INDICES), (end, MARK)])
    store(at("in", "small.bin"), 1024, [(0, ROWS), (512, INDICES)])
    huge, small = {"uri": "huge.bin", "byteLength": LENGTH}, {"uri": "small.bin", "byteLength": 1024}
    store_json(at("in", "views.gltf"), document([huge], (0, FAR), (0, FAR + 1024), (0, end)))
    store_json(at("in", "accessors.gltf"), document([huge], (0, FAR), (0, FAR + 1024), (0, end), FAR))
    store_json(at("in", "beside.gltf"), document([small, huge], (0, 0), (0, 512), (1, end)))
    store_json(at("in", "second.gltf"), document([small, huge], (1, FAR), (1, FAR + 1024), (1, end)))
    largest = 0
    for name, options, copies in (("views", (), 1), ("accessors", (), 1), ("second", (), 1), ("beside", (), 0),
                                  ("beside", ("--buffers=copy",), 1)):
        output = at("out", name + ".gltf")
        code, said, megabytes = convert("-q", *options, at("in", name + ".gltf"), output)
        label = " ".join((name, *options))
        largest = max(largest, megabytes)
        check(label + ": exit code", code == 0, f"{code} {said}")
        if code == 0:
            check_result(label, output)
        there = [n for n in os.listdir(at("out")) if os.path.getsize(at("out", n)) > 4 * GIB]
        check(label + ": long files", len(there) == copies, there)
        for n in os.listdir(at("out")):
            os.remove(at("out", n))
    # A GLB ends at 4 GiB: refused before anything is made, whichever buffer is too long.
    for name, pointer in (("views", "/buffers/0"), ("second", "/buffers/1"), ("beside", "/buffers/1")):
        code, said, megabytes = convert("-q", at("in", name + ".gltf"), at("out", "o.glb"))
        largest = max(largest, megabytes)
        check(name + " to .glb: exit code", code == 5, f"{code} {said}")
        check(name + " to .glb: place and reason", pointer + ":" in said and "4 GiB" in said and name + ".gltf" in said, said)
        check(name + " to .glb: nothing is left", os.listdir(at("out")) == [], os.listdir(at("out")))
    check("memory", largest <= MOST_MEGABYTES, f"{largest} MB")
    print(f".bin of {LENGTH / GIB:.2f} GiB: peak of memory {largest} MB")
    print(f"{passed} passed, {failed} failed")
    return failed != 0


sys.exit(main())

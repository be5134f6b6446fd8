#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""mikktspace.c's answers on the meshes of meshes.json.

    reference.py DIR           compares; DIR has mikktspace.c and mikktspace.h as published; exit 1 where they differ
    reference.py --write DIR   writes the answers into meshes.json

"published" is the file as it is, "sorted" the same with its edge sort completed, as its rewrites for Blender and
three.js have it: the run of edges that its loop leaves behind is sorted, too.
"""
import ctypes
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

MESHES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "meshes.json")
DIALECTS = ("published", "sorted")

POINTER, INT = ctypes.c_void_p, ctypes.c_int
FLOATS = ctypes.POINTER(ctypes.c_float)
COUNT = ctypes.CFUNCTYPE(INT, POINTER)
SIZE = ctypes.CFUNCTYPE(INT, POINTER, INT)
GET = ctypes.CFUNCTYPE(None, POINTER, FLOATS, INT, INT)
SET = ctypes.CFUNCTYPE(None, POINTER, FLOATS, ctypes.c_float, INT, INT)


class Interface(ctypes.Structure):
    _fields_ = [("face_count", COUNT), ("face_size", SIZE), ("position", GET), ("normal", GET), ("texcoord", GET),
                ("basic", SET), ("all", POINTER)]


class Context(ctypes.Structure):
    _fields_ = [("interface", ctypes.POINTER(Interface)), ("user", POINTER)]


def build(folder, dialect, to):
    """Builds the library of a dialect."""
    with open(os.path.join(folder, "mikktspace.c")) as file:
        text = file.read()
    if dialect == "sorted":
        text, runs = re.subn(r"for \(i=1; i<iEntries; i\+\+\)(\s*\{\s*)if \((pEdges\[iCurStartIndex\]\.i(?:0|1)) != ",
                             r"for (i=1; i<=iEntries; i++)\1if (i == iEntries || \2 != ", text)
        text, ends = re.subn(r"for \(i=1; i<iEntries; i\+\+\)(\s*\{\s*)if \((pEdges\[iCurStartIndex\]\.i0 != [^|]*\|\|[^)]*)\)",
                             r"for (i=1; i<=iEntries; i++)\1if (i == iEntries || \2)", text)
        if runs + ends != 2:
            sys.exit("reference.py: mikktspace.c has not the two loops of its edge sort")
    source, library = os.path.join(to, dialect + ".c"), os.path.join(to, dialect + ".so")
    with open(source, "w") as file:
        file.write(text)
    subprocess.run(["cc", "-O1", "-ffp-contract=off", "-shared", "-fPIC", "-I", folder, "-o", library, source, "-lm"],
                   check=True)
    return ctypes.CDLL(library)


def solve(library, vertices, faces):
    """[x, y, z, w] of each corner, face by face."""
    found = [[None] * len(face) for face in faces]

    def get(begin, count):
        def callback(_, to, face, corner):
            for i in range(count):
                to[i] = vertices[faces[face][corner]][begin + i]
        return GET(callback)

    def take(_, tangent, sign, face, corner):
        found[face][corner] = [tangent[0], tangent[1], tangent[2], sign]

    interface = Interface(COUNT(lambda _: len(faces)), SIZE(lambda _, face: len(faces[face])), get(0, 3), get(3, 3),
                          get(6, 2), SET(take), None)
    context = Context(ctypes.pointer(interface), None)
    if not library.genTangSpaceDefault(ctypes.byref(context)):
        sys.exit("reference.py: mikktspace.c gave up")
    return [shortest(corner) for face in found for corner in face]


def shortest(floats):
    """The shortest decimals of floats of 32 bits, so that rows can be read."""
    def of(value):
        for digits in range(1, 10):
            text = "%.*g" % (digits, value)
            if struct.pack("f", float(text)) == struct.pack("f", value):
                return int(text) if re.fullmatch(r"-?[1-9]\d*|0", text) else float(text)
        return value
    return [of(value) for value in floats]


def expected(libraries, mesh):
    """{"quads": ...} where faces have four corners, {"triangles": ...}, each by dialect; sorted only where it differs."""
    answers = {}
    for kind in ("quads", "triangles"):
        if kind in mesh:
            published, completed = (solve(library, mesh["vertices"], mesh[kind]) for library in libraries)
            answers[kind] = {"published": published}
            if completed != published:
                answers[kind]["sorted"] = completed
    return answers


def rows(value, depth):
    """JSON with one line for each row."""
    pad = "\t" * depth
    if isinstance(value, dict):
        return "{\n" + ",\n".join("%s\t%s: %s" % (pad, json.dumps(k), rows(v, depth + 1)) for k, v in value.items()) + \
            "\n" + pad + "}"
    if isinstance(value, list) and any(isinstance(v, (dict, list)) for v in value):
        return "[\n" + ",\n".join(pad + "\t" + rows(v, depth + 1) for v in value) + "\n" + pad + "]"
    return json.dumps(value)


def main():
    write = sys.argv[1] == "--write"
    with open(MESHES) as file:
        meshes = json.load(file)
    with tempfile.TemporaryDirectory() as to:
        libraries = [build(sys.argv[-1], dialect, to) for dialect in DIALECTS]
        answers = [expected(libraries, mesh) for mesh in meshes]
    if write:
        for mesh, answer in zip(meshes, answers):
            mesh["expected"] = answer
        with open(MESHES, "w") as file:
            file.write(rows(meshes, 0) + "\n")
        return
    wrong = [mesh["name"] for mesh, answer in zip(meshes, answers) if mesh["expected"] != answer]
    for name in wrong:
        print("reference.py: %s: mikktspace.c answers otherwise" % name)
    print("%d passed, %d failed" % (len(meshes) - len(wrong), len(wrong)))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

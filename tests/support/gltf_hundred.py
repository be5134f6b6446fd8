#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_hundred.py OUT.glb MEGABYTES [all|none]: a GLB of one hundred grids of which one, the 38th, has a normal
texture. Prints "begin end", the bytes of the file that this one's attributes and indices lie in."""
import array
import json
import struct
import sys

NAME, TOTAL = sys.argv[1], int(float(sys.argv[2]) * 1e6)
NEEDED = {"none": ()}.get(sys.argv[3] if len(sys.argv) > 3 else "", (37,))
COUNT = 100
# A grid of n x n vertices has 32 bytes for each and 4 for each of six indices per quad.
n = int((TOTAL / COUNT / 56) ** 0.5)

vertices = array.array("f")
for y in range(n):
    for x in range(n):
        vertices.extend((x, y, 0, 0, 0, 1, x / 8, -y / 8))
indices = array.array("I")
for y in range(n - 1):
    for x in range(n - 1):
        a = y * n + x
        indices.extend((a, a + 1, a + n + 1, a, a + n + 1, a + n))
piece = vertices.tobytes() + indices.tobytes()

document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}], "materials": [{}, {"normalTexture": {"index": 0}}],
            "textures": [{}], "accessors": [], "bufferViews": [],
            "buffers": [{"byteLength": COUNT * len(piece)}]}
for k in range(COUNT):
    at, first = k * len(piece), 4 * k
    document["bufferViews"] += [
        {"buffer": 0, "byteOffset": at, "byteLength": 4 * len(vertices), "byteStride": 32, "target": 34962},
        {"buffer": 0, "byteOffset": at + 4 * len(vertices), "byteLength": 4 * len(indices), "target": 34963}]
    def accessor(kind, offset, **more):
        return {"bufferView": 2 * k, "byteOffset": offset, "componentType": 5126, "count": n * n, "type": kind, **more}
    document["accessors"] += [
        accessor("VEC3", 0, min=[0, 0, 0], max=[n - 1, n - 1, 0]), accessor("VEC3", 12), accessor("VEC2", 24),
        {"bufferView": 2 * k + 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}]
    document["meshes"][0]["primitives"].append({
        "attributes": {"POSITION": first, "NORMAL": first + 1, "TEXCOORD_0": first + 2}, "indices": first + 3,
        "material": int(k in NEEDED)})
text = json.dumps(document, separators=(",", ":")).encode()
text += b" " * (-len(text) % 4)
with open(NAME, "wb") as file:
    file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + COUNT * len(piece)))
    file.write(struct.pack("<I4s", len(text), b"JSON") + text)
    file.write(struct.pack("<I4s", COUNT * len(piece), b"BIN\0"))
    for k in range(COUNT):
        file.write(piece)
begin = 28 + len(text) + 37 * len(piece)
print(begin, begin + len(piece))

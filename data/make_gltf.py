#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the small glTF models of data/, one for each way in which a document bends the rules.

    python3 data/make_gltf.py [DIR]      default: the folder of this script

All are unit squares seen from +z, normals +z, corners a b c d counterclockwise from the lower left, and the
tangent of each follows from one sentence. Upright texture coordinates (u = x, v = 1 - y) have the tangent
(1, 0, 0) and w = 1; turned ones (u = y, v = x) have (0, 1, 0), and w = 1 since -dP/dv = -x = N x T.

morph.gltf        the target turns the square by 90 degrees about z: (1, 0, 0) becomes (0, 1, 0)
skin.gltf         two squares, mirrored at x = 0 (u = |x|): the two vertices there are split
quantized.gltf    positions in shorts, normals in bytes, texture coordinates in normalized shorts
sparse.gltf       turned texture coordinates, sparse over zeros without a view: row 0 is not among them
transformed.gltf  KHR_texture_transform turns one square's normal texture by 90 degrees, mirrors the other's
multi_uv.gltf     set 0 is upright, set 1 turned; the normal texture asks for set 1
variants.gltf     three primitives of a plain material: a variant of the second one alone has a normal texture
"""
import base64
import json
import math
import os
import struct
import sys

HERE = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
CODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5126: "f"}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
TRIANGLES = [(i,) for i in (0, 1, 2, 0, 2, 3)]
UPRIGHT = [(x, 1 - y) for x, y, _ in SQUARE]
TURNED = [(y, x) for x, y, _ in SQUARE]
PIXEL = ("data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNoaPgPAAODAgA+WCglAAAAAElF"
         "TkSuQmCC")


class Model:
    def __init__(self):
        self.bytes, self.json = bytearray(), {
            "asset": {"version": "2.0", "generator": "data/make_gltf.py"},
            "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}],
            "materials": [{"name": "bumpy", "normalTexture": {"index": 0}}],
            "textures": [{"source": 0}], "images": [{"uri": PIXEL}],
            "accessors": [], "bufferViews": []}

    def view(self, rows, component, **more):
        """Rows start at multiples of four bytes, but for indices."""
        width = struct.calcsize(CODES[component]) * len(rows[0])
        stride = -(-width // 4) * 4 if more.get("target") == 34962 else width
        data = b"".join(struct.pack("<%d%s" % (len(r), CODES[component]), *r).ljust(stride, b"\0") for r in rows)
        entry = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more}
        if stride != width:
            entry["byteStride"] = stride
        self.bytes.extend(data + b"\0" * (-len(data) % 4))
        self.json["bufferViews"].append(entry)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows, component=5126, target=34962, **more):
        entry = {"bufferView": self.view(rows, component, target=target), "componentType": component,
                 "count": len(rows), "type": KINDS[len(rows[0])], **more}
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def positions(self, rows, component=5126, **more):
        return self.accessor(rows, component, min=[min(c) for c in zip(*rows)], max=[max(c) for c in zip(*rows)],
                             **more)

    def square(self, rows=SQUARE, triangles=TRIANGLES, material=0, uvs=None, **attributes):
        """A primitive; attributes are added, or taken instead."""
        own = {"POSITION": lambda: self.positions(rows), "NORMAL": lambda: self.accessor([(0, 0, 1)] * len(rows)),
               "TEXCOORD_0": lambda: self.accessor(uvs or UPRIGHT)}
        primitive = {"attributes": {**{n: make() for n, make in own.items() if n not in attributes}, **attributes},
                     "indices": self.accessor(triangles, 5123, 34963), "material": material}
        self.json["meshes"][0]["primitives"].append(primitive)
        return primitive

    def uses(self, name, required=False):
        self.json["extensionsUsed"] = [name]
        if required:
            self.json["extensionsRequired"] = [name]

    def save(self, name):
        text = base64.b64encode(bytes(self.bytes)).decode()
        self.json["buffers"] = [{"uri": "data:application/octet-stream;base64," + text, "byteLength": len(self.bytes)}]
        with open(os.path.join(HERE, name), "w") as file:
            file.write(json.dumps(self.json, indent=1) + "\n")


def morph():
    m = Model()
    moves = [(-y - x, x - y, 0) for x, y, _ in SQUARE]  # to (-y, x)
    m.square()["targets"] = [{"POSITION": m.positions(moves)}]
    m.json["meshes"][0]["weights"] = [0]
    m.save("morph.gltf")


def skin():
    m = Model()
    rows = [(x, y, 0) for y in (0, 1) for x in (-1, 0, 1)]
    triangles = [(i,) for i in (0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4)]
    joints = [(0, 1, 0, 0)] * 6
    weights = [((4 - k) / 8, (4 + k) / 8, 0, 0) for k in (-3, 1, 3, -2, -1, 2)]  # a different one for each vertex
    m.square(rows, triangles, uvs=[(abs(x), 1 - y) for x, y, _ in rows],
             JOINTS_0=m.accessor(joints, 5121), WEIGHTS_0=m.accessor(weights))
    m.json["nodes"] = [{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [0, 1, 0]}]
    m.json["scenes"] = [{"nodes": [0, 1]}]
    matrices = [tuple(float(k % 5 == 0) for k in range(12)) + (0, -y, 0, 1) for y in (0, 1)]
    m.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": len(m.json["accessors"])}]
    m.json["accessors"].append({"bufferView": m.view(matrices, 5126), "componentType": 5126, "count": 2, "type": "MAT4"})
    m.save("skin.gltf")


def quantized():
    m = Model()
    m.uses("KHR_mesh_quantization", True)
    m.square(POSITION=m.positions([(x * 1000, y * 1000, 0) for x, y, _ in SQUARE], 5122),
             NORMAL=m.accessor([(0, 0, 127)] * 4, 5120, normalized=True),
             TEXCOORD_0=m.accessor([(u * 65535, v * 65535) for u, v in UPRIGHT], 5123, normalized=True))
    m.save("quantized.gltf")


def sparse():
    m = Model()
    rows = m.view([(k,) for k in (1, 2, 3)], 5121)
    m.json["accessors"].append({"componentType": 5126, "count": 4, "type": "VEC2", "sparse": {
        "count": 3, "indices": {"bufferView": rows, "componentType": 5121},
        "values": {"bufferView": m.view(TURNED[1:], 5126)}}})
    m.square(TEXCOORD_0=0)
    m.save("sparse.gltf")


def transformed():
    m = Model()
    m.uses("KHR_texture_transform")
    def texture(**transform):
        return {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    m.json["materials"] = [{"name": "turned", "normalTexture": texture(rotation=math.pi / 2, offset=[0.5, 7])},
                           {"name": "mirrored", "normalTexture": texture(scale=[-3, 0.5])}]
    m.square()
    m.square([(x + 2, y, z) for x, y, z in SQUARE], material=1)
    m.save("transformed.gltf")


def multi_uv():
    m = Model()
    m.json["materials"][0]["normalTexture"]["texCoord"] = 1
    m.square(TEXCOORD_1=m.accessor(TURNED))
    m.save("multi_uv.gltf")


def variants():
    m = Model()
    m.uses("KHR_materials_variants")
    m.json["materials"] += [{"name": "plain"}, {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]
    m.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "flat"}, {"name": "bumpy"}]}}
    for k, mapped in enumerate((None, 0, 2)):
        primitive = m.square([(x + 2 * k, y, z) for x, y, z in SQUARE], material=1)
        if mapped is not None:
            primitive["extensions"] = {"KHR_materials_variants": {
                "mappings": [{"material": 1, "variants": [0]}, {"material": mapped, "variants": [1]}]}}
    m.save("variants.gltf")


morph()
skin()
quantized()
sparse()
transformed()
multi_uv()
variants()

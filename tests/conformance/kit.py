#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the conformance kit of meshes.json, which has mikktspace.c's answers: see README.md, which goes with it.

    kit.py DIR      DIR and DIR.zip; an old DIR goes
"""
import json
import math
import os
import shutil
import struct
import sys
import zipfile
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
FONT = {"P": "###  #..# #..# ###  #    #    #   ", "A": " ##  #  # #  # #### #  # #  # #  # ",
        "S": " ### #    #     ##     #    # ### ", "F": "#### #    #    ###  #    #    #    ",
        "I": "###   #    #    #    #    #   ### ", "L": "#    #    #    #    #    #    #### "}
FLAT = (0, 0, 1)
# The light falls from +y, 53 degrees off the normal. So far are the letters turned to it, or away from it, that they
# are as bright as the ground when they are turned the other way: 0.19 and 0.89 of the light.
LIGHT = (0, 0.8, 0.6)
SINE, COSINE = 0.4418, 0.8971
GROUND = (0.949, 0, 0.3153)
CARD_TOP = 2.2  # y of the first strip's middle


def png(rows):
    """An RGB image of unit vectors."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + bytes(round(127.5 + 127.5 * c) for n in row for c in n) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


class Gltf:
    def __init__(self, generator, image):
        self.bin = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": generator}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "accessors": [], "bufferViews": [],
                     "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 33071}],
                     "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1},
                                    "normalTexture": {"index": 0}}],
                     "images": [{"mimeType": "image/png", "bufferView": 0}]}
        self.view(image)

    def view(self, data, **more):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data), **more})
        self.bin += data + b"\0" * (-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows, kind, **more):
        code, component, target = ("H", 5123, 34963) if kind == "SCALAR" else ("f", 5126, 34962)
        data = b"".join(struct.pack("<%d%s" % (len(r), code), *r) for r in rows)
        self.json["accessors"].append({"bufferView": self.view(data, target=target), "componentType": component,
                                       "count": len(rows), "type": kind, **more})
        return len(self.json["accessors"]) - 1

    def mesh(self, name, vertices, triangles, texcoords, tangents=None, node=None):
        """Vertices are rows of position and normal, texcoords have v down."""
        places = [v[:3] for v in vertices]
        attributes = {"POSITION": self.accessor(places, "VEC3", min=[min(c) for c in zip(*places)],
                                                max=[max(c) for c in zip(*places)]),
                      "NORMAL": self.accessor([v[3:6] for v in vertices], "VEC3"),
                      "TEXCOORD_0": self.accessor(texcoords, "VEC2")}
        if tangents:
            attributes["TANGENT"] = self.accessor(tangents, "VEC4")
        indices = self.accessor([(i,) for t in triangles for i in t], "SCALAR")
        self.json["nodes"].append({"name": name, "mesh": len(self.json["meshes"]), **(node or {})})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)
        self.json["meshes"].append({"name": name, "primitives": [{"attributes": attributes, "indices": indices,
                                                                  "material": 0}]})

    def save(self, path):
        self.json["buffers"] = [{"byteLength": len(self.bin)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.bin)) +
                       struct.pack("<I4s", len(text), b"JSON") + text +
                       struct.pack("<I4s", len(self.bin), b"BIN\0") + self.bin)


def sampled(mesh):
    """The texture coordinates that the file has: v down, before the texture's transform."""
    scale = mesh.get("transform", {}).get("scale", [1, 1])
    return [(v[6] / scale[0], (1 - v[7]) / scale[1]) for v in mesh["vertices"]]


def begin(mesh):
    g = Gltf("nmtan conformance kit", png([[FLAT] * 4] * 4))
    if "transform" in mesh:
        g.json["extensionsUsed"] = ["KHR_texture_transform"]
        g.json["materials"][0]["normalTexture"]["extensions"] = {"KHR_texture_transform": mesh["transform"]}
    return g


def write_obj(mesh, path):
    with open(path, "w") as file:
        file.write("# %s\n" % mesh["about"])
        for key, begin_, end in (("v", 0, 3), ("vn", 3, 6), ("vt", 6, 8)):
            for v in mesh["vertices"]:
                file.write(key + "".join(" %r" % c for c in v[begin_:end]) + "\n")
        for face in mesh.get("quads", mesh["triangles"]):
            file.write("f" + "".join(" %d/%d/%d" % (i + 1, i + 1, i + 1) for i in face) + "\n")


def write_expected(mesh, dialect, path):
    """Each corner has a vertex of its own, so that nobody's splitting is in the way."""
    answers = mesh["expected"]["triangles"]
    corners = [i for t in mesh["triangles"] for i in t]
    texcoords = sampled(mesh)
    g = begin(mesh)
    g.mesh(mesh["name"], [mesh["vertices"][i] for i in corners],
           [range(3 * t, 3 * t + 3) for t in range(len(mesh["triangles"]))], [texcoords[i] for i in corners],
           answers.get(dialect, answers["published"]), mesh.get("node"))
    g.save(path)


def lettered(mirrored):
    """The normals of a strip of 64 x 16: PASS turned to +y on the left, FAIL to -y on the right."""
    rows = [[GROUND] * 64 for _ in range(16)]
    for begin_, word, sine in ((5, "PASS", SINE), (37, "FAIL", -SINE)):
        for k, letter in enumerate(word):
            for at, dot in enumerate(FONT[letter]):
                if dot == "#":
                    rows[4 + at // 5][begin_ + 6 * k + at % 5] = (0, sine, COSINE)
    # mirrored in u, T runs along -x, and x of a vector is counted along it
    return [row[::-1] for row in rows] if mirrored else rows


def combined(frame, weights):
    """The sum of T, B and N by weights, of unit length."""
    n = [sum(w * axis[i] for w, axis in zip(weights, frame)) for i in range(3)]
    length = math.sqrt(sum(c * c for c in n))
    return [c / length for c in n]


def cross(a, b):
    return tuple(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3))


def turned_about(axis, v, angle):
    """A vector perpendicular to the axis, turned about it."""
    return tuple(math.cos(angle) * c + math.sin(angle) * d for c, d in zip(v, cross(axis, v)))


def half_of(word, dot, ground):
    """Half a strip: a word of dots on ground, each a function of how far up a row is."""
    rows = [[ground(1 - (y + 0.5) / 16)] * 32 for y in range(16)]
    for k, letter in enumerate(word):
        for at, mark in enumerate(FONT[letter]):
            if mark == "#":
                y = 4 + at // 5
                rows[y][5 + 6 * k + at % 5] = dot(1 - (y + 0.5) / 16)
    return rows


def length_strip():
    """T is turned by 80 degrees about N to either side at the edges, so that it is short between them, which scales x
    and y. Dots have a slope that is lit with a short T, and dark with one that was made a unit again; FAIL the other way
    round. Normals lie in the plane of the light, 37 and 120 degrees off it."""
    wide = math.radians(80)

    def slope(up, steep, towards):
        across, along = math.cos(wide), (1 - 2 * up) * math.sin(wide)
        length = math.hypot(across, along)
        # the direction that is +-y in space, in the frame of T as it is interpolated
        x, y = towards * along / length, towards * across / length
        return combined(((1, 0, 0), (0, 1, 0), (0, 0, 1)), (steep(length) * x, steep(length) * y, 1))

    halves = []
    for word, normal, dot, ground in (
            ("PASS", (0, 0.28, 0.96), lambda t: slope(t, lambda short: 1.5, -1),
             lambda t: slope(t, lambda short: 1.4 / short, -1)),
            ("FAIL", (0, -0.9196, 0.3928), lambda t: slope(t, lambda short: 0.548 / short, 1), lambda t: FLAT)):
        low, high = (turned_about(normal, (1, 0, 0), angle) for angle in (wide, -wide))
        halves.append(((normal, low), (normal, high), half_of(word, dot, ground)))
    return halves


# Frames at the edges of a strip (N, T below, N, T above), and values of the map (dots, ground), that were searched for:
# dots are lit where B is the cross product of what is interpolated, and dark where B itself is (PASS), or the other way
# round (FAIL), whatever is made a unit.
SEARCHED = (("PASS", (((0.6843, -0.4672, 0.5599), (-0.1353, 0.6731, 0.7271)),
                      ((-0.5164, 0.8042, 0.2943), (0.8258, 0.5586, -0.07719)),
                     (0.1737, 0.9229, 0.3436), (-0.7601, -0.6477, 0.05216))),
            ("FAIL", (((-0.5665, 0.8179, 0.1008), (0.8223, 0.553, 0.1339)),
                      ((0.4547, -0.3889, 0.8012), (-0.6294, 0.4962, 0.5981)),
                     (-0.4778, -0.8723, 0.1041), (-0.6499, 0.7567, 0.07053))))


def bitangent_strip():
    halves = []
    for word, (below, above, dot, ground) in SEARCHED:
        frames = []
        for n, t in (below, above):
            n = combined((n,), (1,))
            t = combined((t, n), (1, -sum(a * b for a, b in zip(t, n))))
            frames.append((n, t))
        halves.append((*frames, half_of(word, lambda t, v=dot: v, lambda t, v=ground: v)))
    return halves


def write_card(path):
    """Five strips under one light: plain, mirrored, upside down (u and v both turned), and two whose frames are not
    those of their texture coordinates."""
    strips = [("plain", [(0, 1), (1, 1), (1, 0), (0, 0)], (1, 0, 0, 1)),
              ("mirrored", [(1, 1), (0, 1), (0, 0), (1, 0)], (-1, 0, 0, -1)),
              ("turned", [(1, 0), (0, 0), (0, 1), (1, 1)], (-1, 0, 0, 1))]
    turned = [[(-x, -y, z) for x, y, z in row[::-1]] for row in lettered(False)[::-1]]
    image = lettered(False) + lettered(True) + turned
    made = (("bitangent", bitangent_strip()), ("length", length_strip()))
    for name, (left, right) in made:
        image += [a + b for a, b in zip(left[2], right[2])]
    g = Gltf("nmtan conformance kit", png([[c for c in row for _ in range(8)] for row in image for _ in range(8)]))
    for k, (name, square, tangent) in enumerate(strips):
        y = CARD_TOP - 1.1 * k
        vertices = [(x, y + z, 0, 0, 0, 1) for x, z in ((-2, -0.5), (2, -0.5), (2, 0.5), (-2, 0.5))]
        g.mesh(name, vertices, [(0, 1, 2), (0, 2, 3)], [(u, (k + v) / 5) for u, v in square], [tangent] * 4)
    for k, (name, halves) in enumerate(made, len(strips)):
        y, vertices, tangents, texcoords = CARD_TOP - 1.1 * k, [], [], []
        for x, (below, above, _) in enumerate(halves):
            for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                normal, tangent = above if j else below
                vertices.append((2 * (x + i) - 2, y + j - 0.5, 0, *normal))
                tangents.append((*tangent, 1))
                texcoords.append(((x + i) / 2, (k + 1 - j) / 5))
        g.mesh(name, vertices, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)], texcoords, tangents)
    g.json["extensionsUsed"] = ["KHR_lights_punctual"]
    g.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}}
    g.json["scenes"][0]["nodes"] += [len(g.json["nodes"]), len(g.json["nodes"]) + 1]
    g.json["nodes"] += [{"name": "light", "rotation": [-0.4472136, 0, 0, 0.8944272],
                         "extensions": {"KHR_lights_punctual": {"light": 0}}},
                        {"name": "camera", "translation": [0, 0, 8], "camera": 0}]
    g.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.1, "zfar": 100}}]
    g.save(path)


def write_zip(folder):
    """The same bytes for the same files."""
    with zipfile.ZipFile(folder + ".zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for path, folders, names in os.walk(folder):
            folders.sort()
            for name in sorted(names):
                full = os.path.join(path, name)
                entry = zipfile.ZipInfo(os.path.join(os.path.basename(folder), os.path.relpath(full, folder)))
                entry.external_attr = (os.stat(full).st_mode & 0o755) << 16
                entry.compress_type = zipfile.ZIP_DEFLATED
                with open(full, "rb") as file:
                    archive.writestr(entry, file.read())


def main(folder):
    with open(os.path.join(HERE, "meshes.json")) as file:
        meshes = json.load(file)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.join(folder, "expected"))
    for mesh in meshes:
        if "transform" not in mesh and "node" not in mesh:
            write_obj(mesh, os.path.join(folder, mesh["name"] + ".obj"))
        g = begin(mesh)
        g.mesh(mesh["name"], mesh["vertices"], mesh["triangles"], sampled(mesh), node=mesh.get("node"))
        g.save(os.path.join(folder, mesh["name"] + ".glb"))
        expected = os.path.join(folder, "expected", mesh["name"])
        with open(expected + ".json", "w") as file:
            json.dump(mesh, file, indent=1)
        write_expected(mesh, "published", expected + ".glb")
        if "sorted" in mesh["expected"]["triangles"]:
            write_expected(mesh, "sorted", expected + ".sorted.glb")
    write_card(os.path.join(folder, "card.glb"))
    for name in ("README.md", "score.sh"):
        shutil.copy(os.path.join(HERE, name), folder)
    write_zip(folder)


if __name__ == "__main__":
    main(sys.argv[1].rstrip("/"))

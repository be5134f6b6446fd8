#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the damaged files from the good ones of data/: each has one fault. What nmtan must say of each
stands in tests/cli/damaged.tsv.

    python3 data/damaged/make.py [DIR]      default: the folder of this script
"""
import os
import shutil
import struct
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
GOOD = os.path.join(HERE, "..")
OUT = sys.argv[1] if len(sys.argv) > 1 else HERE


def good(name):
    with open(os.path.join(GOOD, name), "rb") as file:
        return file.read()


def save(name, data):
    with open(os.path.join(OUT, name), "wb") as file:
        file.write(data)


def replace(source, name, old, new, count=1):
    """The good file with one occurrence of `old` replaced; it must be there."""
    old, new = [t if isinstance(t, bytes) else t.encode() for t in (old, new)]
    data = good(source)
    assert old in data, (name, old)
    save(name, data.replace(old, new, count))


def patch(source, name, offset, layout, *values):
    """The good file with a packed value at `offset` (from the end when negative)."""
    data = bytearray(good(source))
    struct.pack_into(layout, data, offset % len(data), *values)
    save(name, bytes(data))


def obj():
    face = "f 1/1/1 2/2/1 3/3/1 4/4/1"
    for name, new in (("vertex_above", "f 1/1/1 2/2/1 3/3/1 5/4/1"),
                      ("vertex_zero", "f 0/1/1 2/2/1 3/3/1 4/4/1"),
                      ("vertex_below", "f -5/1/1 2/2/1 3/3/1 4/4/1"),
                      ("texcoord_above", "f 1/5/1 2/2/1 3/3/1 4/4/1"),
                      ("normal_above", "f 1/1/1 2/2/2 3/3/1 4/4/1"),
                      ("index_huge", "f 1/1/1 2/2/1 3/3/1 99999999999999999999/4/1"),
                      ("index_word", "f 1/1/1 2/2/1 3/three/1 4/4/1"),
                      ("face_of_two", "f 1/1/1 2/2/1")):
        replace("quad.obj", "obj_%s.obj" % name, face, new)
    replace("quad.obj", "obj_number_word.obj", "v 1 -1 0", "v 1 minus 0")
    replace("quad.obj", "obj_number_missing.obj", "v 1 -1 0", "v 1 -1")
    replace("quad.obj", "obj_nan.obj", "v 1 -1 0", "v 1 nan 0")
    replace("quad.obj", "obj_infinite.obj", "v 1 -1 0", "v 1 -1e999 0")
    save("obj_empty.obj", b"")
    save("mtl_number.mtl", good("mirrored_cube.mtl").replace(b"Pr 0.5", b"Pr rough"))
    save("mtl_number.obj", good("mirrored_cube.obj").replace(b"mirrored_cube.mtl", b"mtl_number.mtl"))


def ply():
    ascii_ply, binary = "quad_ascii.ply", "quad_le.ply"
    replace(ascii_ply, "ply_vertices_too_many.ply", "element vertex 4", "element vertex 5")
    replace(ascii_ply, "ply_faces_too_many.ply", "element face 1", "element face 2")
    replace(ascii_ply, "ply_index_above.ply", "4 0 1 2 3", "4 0 1 2 4")
    replace(ascii_ply, "ply_index_negative.ply", "4 0 1 2 3", "4 0 -1 2 3")
    replace(ascii_ply, "ply_list_short.ply", "4 0 1 2 3", "4 0 1 2")
    replace(ascii_ply, "ply_number_word.ply", "1 -1 0 0 0 1 1 0", "1 -1 zero 0 0 1 1 0")
    replace(ascii_ply, "ply_version.ply", "format ascii 1.0", "format ascii 2.0")
    replace(ascii_ply, "ply_type.ply", "property float x", "property flot x")
    replace(ascii_ply, "ply_header_open.ply", "end_header\n", "")
    replace(ascii_ply, "ply_count_word.ply", "element vertex 4", "element vertex four")
    replace(binary, "ply_count_huge.ply", "element vertex 4", "element vertex 4000000000")
    patch(binary, "ply_index_binary.ply", -4, "<i", 4)
    save("ply_truncated.ply", good(binary)[:-5])


def glb():
    source = "plates.glb"
    json_size = struct.unpack_from("<I", good(source), 12)[0]
    patch(source, "glb_magic.glb", 0, "<4s", b"glTf")
    patch(source, "glb_version.glb", 4, "<I", 3)
    patch(source, "glb_old.glb", 4, "<I", 1)
    patch(source, "glb_length.glb", 8, "<I", len(good(source)) + 64)
    patch(source, "glb_chunk_length.glb", 12, "<I", 0x7ffffff0)
    patch(source, "glb_chunk_type.glb", 16, "<4s", b"JSOM")
    patch(source, "glb_bin_length.glb", 20 + json_size, "<I", len(good(source)))
    save("glb_truncated.glb", good(source)[:300])
    save("glb_header.glb", good(source)[:11])


def gltf():
    source = "plates.gltf"
    shutil.copyfile(os.path.join(GOOD, "plates.bin"), os.path.join(OUT, "plates.bin"))

    def edit(name, old, new, count=1):
        replace(source, "gltf_%s.gltf" % name, old, new, count)

    edit("syntax", '"scene": 0,', '"scene": 0')
    edit("version", '"version": "2.0"', '"version": "3.0"')
    edit("old", '"version": "2.0"', '"version": "1.0"')
    edit("count_above", '"count": 6', '"count": 7')
    edit("count_negative", '"count": 6', '"count": -6')
    edit("count_fraction", '"count": 6', '"count": 6.5')
    edit("accessor_offset", '"count": 6', '"byteOffset": 4, "count": 6')
    edit("component_type", '"componentType": 5126', '"componentType": 5127')
    edit("accessor_type", '"type": "VEC3"', '"type": "VEC5"')
    edit("view_missing", '"bufferView": 0', '"bufferView": 99')
    edit("view_offset", '"byteOffset": 0', '"byteOffset": 640')
    edit("view_buffer", '"buffer": 0', '"buffer": 1')
    edit("stride_small", '"byteOffset": 0,', '"byteOffset": 0, "byteStride": 8,')
    edit("stride_large", '"byteOffset": 0,', '"byteOffset": 0, "byteStride": 16,')
    edit("attribute", '"POSITION": 0', '"POSITION": 99')
    edit("attribute_word", '"POSITION": 0', '"POSITION": "zero"')
    edit("indices", '"indices": 3', '"indices": 99')
    edit("mode", '"indices": 3,', '"indices": 3, "mode": 9,')
    edit("material", '"material": 0', '"material": 9')
    edit("views_object", '"bufferViews": [', '"bufferViews": {}, "were": [')
    edit("buffer_short", '"uri": "plates.bin"', '"uri": "short.bin"')
    save("short.bin", good("plates.bin")[:600])
    edit("uri_missing", '"uri": "plates.bin"', '"uri": "nowhere.bin"')
    edit("uri_outside", '"uri": "plates.bin"', '"uri": "../plates.bin"')
    edit("uri_absolute", '"uri": "plates.bin"', '"uri": "/etc/passwd"')
    edit("uri_scheme", '"uri": "plates.bin"', '"uri": "http://example.com/plates.bin"')
    edit("uri_base64", '"uri": "plates.bin"',
         '"uri": "data:application/octet-stream;base64,AA*A"')
    edit("draco", '"indices": 3,',
         '"indices": 3, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}},')
    save("gltf_deep.gltf", b'{"asset":{"version":"2.0"},"extras":' + b"[" * 5000 + b"]" * 5000 + b"}")
    edit("index_above", '"uri": "plates.bin"', '"uri": "index.bin"')
    data = bytearray(good("plates.bin"))
    struct.pack_into("<H", data, 6 * 32 + 2 * 4, 6)  # index 4 of the first plate, behind 6 * 32 bytes
    save("index.bin", bytes(data))


obj()
ply()
glb()
gltf()

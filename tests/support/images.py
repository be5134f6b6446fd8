#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Images for tests, with nothing but zlib, and libwebp for WebP.

    images.py write FILE WIDTH HEIGHT EXPRESSION   a TGA, BMP, TIFF, WebP (with loss if FILE begins with "lossy") or PNG by its ending; EXPRESSION of x, y (rows down), w, h and
                                                   math gives (r, g, b) of bytes, in a PNG (r, g, b, a), too, a grey byte, or ("16", grey or
                                                   r, g, b and perhaps a) of 16 bits
    images.py rows FILE [EXPRESSION]               the samples of a PNG as JSON, row by row; or an expression over the rows
    images.py tga FILE.png FILE.tga                the same picture
    images.py jpegtif FILE.jpg FILE.tif            the same grey picture, 8 x 8; tables apart from the scan, as TIFFs have them
    images.py embedded GLB NUMBER FILE             the bytes of an image of a GLB
"""
import ctypes
import json
import math
import struct
import sys
import zlib


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, pixel, more=b""):
    first = pixel(0, 0)
    wide = isinstance(first, tuple) and first[0] == "16"
    kind = {1: 0, 3: 2, 4: 6}[1 if not isinstance(first, tuple) else len(first) - wide]
    raw = bytearray()
    for y in range(height):
        raw.append(0)
        for x in range(width):
            p = pixel(x, y)
            raw += struct.pack(">%dH" % (len(p) - 1), *p[1:]) if wide else bytes(p if kind else [p])
    header = struct.pack(">IIBBBBB", width, height, 16 if wide else 8, kind, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + more + chunk(b"IDAT", zlib.compress(bytes(raw))) +
            chunk(b"IEND", b""))


def tga(width, height, pixel):
    data = bytes([0, 0, 2]) + bytes(9) + struct.pack("<HHBB", width, height, 24, 0x20)
    return data + b"".join(bytes(pixel(x, y)[::-1]) for y in range(height) for x in range(width))


def bmp(width, height, pixel):
    row = (3 * width + 3) // 4 * 4
    data = b"BM" + struct.pack("<IIIIiiHHIIIIII", 54 + row * height, 0, 54, 40, width, height, 1, 24, 0, 0, 0, 0, 0, 0)
    for y in reversed(range(height)):
        data += b"".join(bytes(pixel(x, y)[::-1]) for x in range(width)).ljust(row, b"\0")
    return data


def webp(width, height, pixel):
    library = ctypes.CDLL("libwebp.so.7")
    loses = sys.argv[2].startswith("lossy")
    encode, quality = (library.WebPEncodeRGB, [ctypes.c_float(90)]) if loses else (library.WebPEncodeLosslessRGB, [])
    encode.restype = ctypes.c_size_t
    made = ctypes.POINTER(ctypes.c_ubyte)()
    size = encode(b"".join(bytes(pixel(x, y)) for y in range(height) for x in range(width)), width, height, 3 * width,
                  *quality, ctypes.byref(made))
    data = ctypes.string_at(made, size)
    library.WebPFree(made)
    return data


def tif_of(data, behind, entries):
    """entries: tag, type, count, value; None: it is in `behind`, after the directory."""
    at = 8 + len(data) + len(data) % 2
    directory = struct.pack("<H", len(entries))
    for tag, kind, count, value in entries:
        directory += struct.pack("<HHII", tag, kind, count, at + 2 + 12 * len(entries) + 4 if value is None else value)
    return b"II*\0" + struct.pack("<I", at) + data + bytes(len(data) % 2) + directory + bytes(4) + behind


def palette_tif(width, height, pixel):
    """Grey bytes are numbers of a palette: from blue to yellow."""
    data = bytes(pixel(x, y) for y in range(height) for x in range(width))
    ramp = [257 * i for i in range(256)]
    return tif_of(data, struct.pack("<768H", *ramp, *ramp, *ramp[::-1]), [
        (256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 3), (273, 4, 1, 8), (277, 3, 1, 1),
        (278, 4, 1, height), (279, 4, 1, len(data)), (320, 3, 768, None)])


def tif(width, height, pixel):
    if not isinstance(pixel(0, 0), tuple):
        return palette_tif(width, height, pixel)
    data = b"".join(bytes(pixel(x, y)) for y in range(height) for x in range(width))
    return tif_of(data, struct.pack("<HHH", 8, 8, 8), [
        (256, 4, 1, width), (257, 4, 1, height), (258, 3, 3, None), (259, 3, 1, 1), (262, 3, 1, 2),
        (273, 4, 1, 8), (277, 3, 1, 3), (278, 4, 1, height), (279, 4, 1, len(data))])


def jpegtif(jpeg):
    at, parts = 2, {True: b"", False: b""}
    while jpeg[at + 1] != 0xda:  # the scan
        size = 2 + struct.unpack(">H", jpeg[at + 2:at + 4])[0]
        parts[jpeg[at + 1] in (0xdb, 0xc4)] += jpeg[at:at + size]
        at += size
    data, tables = b"\xff\xd8" + parts[False] + jpeg[at:], b"\xff\xd8" + parts[True] + b"\xff\xd9"
    return tif_of(data, tables, [
        (256, 4, 1, 8), (257, 4, 1, 8), (258, 3, 1, 8), (259, 3, 1, 7), (262, 3, 1, 1),
        (273, 4, 1, 8), (277, 3, 1, 1), (278, 4, 1, 8), (279, 4, 1, len(data)), (347, 7, len(tables), None)])


def paeth(a, b, c):
    p = a + b - c
    return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]


def rows(data):
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    at, packed = 8, b""
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    raw, step = zlib.decompress(packed), channels * depth // 8
    size = width * step
    above, result = bytearray(size), []
    for y in range(height):
        method, line = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
        for i in range(size):
            a = line[i - step] if i >= step else 0
            c = above[i - step] if i >= step else 0
            line[i] = (line[i] + (0, a, above[i], (a + above[i]) // 2, paeth(a, above[i], c))[method]) & 255
        above = line
        samples = list(struct.unpack(">%dH" % (size // 2), line)) if depth == 16 else list(line)
        result.append([samples[i:i + channels] for i in range(0, len(samples), channels)])
    return result


def embedded(data, number):
    size = struct.unpack("<I", data[12:16])[0]
    document = json.loads(data[20:20 + size])
    view = document["bufferViews"][document["images"][number]["bufferView"]]
    begin = 28 + size + view.get("byteOffset", 0)
    return data[begin:begin + view["byteLength"]]


def main():
    if sys.argv[1] == "write":
        path, width, height = sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
        code = compile(sys.argv[5], "pixel", "eval")
        make = {"tga": tga, "bmp": bmp, "tif": tif, "png": png, "webp": webp}[path.rsplit(".", 1)[1].lower()]
        with open(path, "wb") as file:
            file.write(make(width, height, lambda x, y: eval(code, {"x": x, "y": y, "w": width, "h": height, "math": math})))
    elif sys.argv[1] == "rows":
        picture = rows(open(sys.argv[2], "rb").read())
        print(eval(sys.argv[3], {"rows": picture, "math": math}) if sys.argv[3:] else json.dumps(picture, separators=(",", ":")))
    elif sys.argv[1] == "tga":
        picture = rows(open(sys.argv[2], "rb").read())
        with open(sys.argv[3], "wb") as file:
            file.write(tga(len(picture[0]), len(picture), lambda x, y: picture[y][x][:3]))
    elif sys.argv[1] == "jpegtif":
        with open(sys.argv[3], "wb") as file:
            file.write(jpegtif(open(sys.argv[2], "rb").read()))
    else:
        with open(sys.argv[4], "wb") as file:
            file.write(embedded(open(sys.argv[2], "rb").read(), int(sys.argv[3])))


if __name__ == "__main__":
    main()

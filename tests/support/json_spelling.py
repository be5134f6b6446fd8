#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""json_spelling.py respell SEED IN OUT: the same document with odd numbers, escapes, white space and extras.
json_spelling.py compare A B: prints the paths of what B has otherwise than A, spelling and white space included: values
that are others, "+ path" for what only B has, "- path" for what only A has. Members come in the same order."""
import json
import random
import re
import sys

SPACE = re.compile(r"[ \t\r\n]*")
STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
SCALAR = re.compile(r"[^\s,\]}]+")
EXTRAS = '{"\\u00e9" :1.0E+03,"n":1e400,\t"n":[ -0.0,"\\/" ],"extras":{ },"n":-1E+999 }'


def parse(text, at):
    """(kind, children or token, end); a child is (text before its value, key, value), the last one the tail alone."""
    if text[at] not in "{[":
        end = (STRING if text[at] == '"' else SCALAR).match(text, at).end()
        return "scalar", text[at:end], end
    kind, children = text[at], []
    begin = at + 1
    at = SPACE.match(text, begin).end()
    while text[at] not in "}]":
        key = None
        if kind == "{":
            key_end = STRING.match(text, at).end()
            key = text[at:key_end]
            at = SPACE.match(text, SPACE.match(text, key_end).end() + 1).end()
        value = parse(text, at)
        children.append((text[begin:at], key, value))
        begin = value[2]
        at = SPACE.match(text, begin).end()
        if text[at] == ",":
            at = SPACE.match(text, at + 1).end()
    children.append((text[begin:at], None, None))
    return kind, children, at + 1


def compare(a, b, path):
    if a[0] != b[0] or a[0] == "scalar":
        if a[:2] != b[:2]:
            print(path or "/")
        return
    xs, ys = a[1][:-1], b[1][:-1]
    y = 0
    for i, (before, key, value) in enumerate(xs):
        name = f"{path}/{i if key is None else json.loads(key)}"
        if y == len(ys) or ys[y][1] != key:
            print("-", name)
            continue
        if ys[y][0] != before:
            print(f"{name}: {before!r} became {ys[y][0]!r}")
        compare(value, ys[y][2], name)
        y += 1
    for k, (_, key, _) in enumerate(ys[y:]):
        print("+", f"{path}/{y + k if key is None else json.loads(key)}")
    if a[1][-1][0] != b[1][-1][0]:
        print(f"{path}: the end {a[1][-1][0]!r} became {b[1][-1][0]!r}")


def space(rng):
    return "".join(rng.choices(" \t\n", k=rng.choice((0, 0, 1, 2)))) + rng.choice(("", "", "\r\n"))


def number(rng, token):
    if not re.fullmatch(r"[1-9]\d*", token):
        return token + rng.choice(("e0", "E+00", "")) if "e" not in token.lower() else token
    return rng.choice((token, token + ".0", token + "E0", token + "0e-1", token + ".000E+00"))


def string(rng, token):
    return re.sub(r"(?<!\\)[a-z/](?![^\"]*\\)", lambda m: rng.choice((m[0],) * 6 + ("\\u%04X" % ord(m[0]),) +
                  (("\\/",) if m[0] == "/" else ())), token)


def respell(rng, value):
    if value[0] == "scalar":
        return {'"': string, "-": number}.get(value[1][0], number if value[1][0].isdigit() else
                                              lambda _, token: token)(rng, value[1])
    parts = []
    for _, key, child in value[1][:-1]:
        name = "" if key is None else string(rng, key) + space(rng) + ":" + space(rng)
        parts.append(space(rng) + name + (EXTRAS if key == '"extras"' else respell(rng, child)) + space(rng))
    return value[0] + (",".join(parts) or space(rng)) + ("}" if value[0] == "{" else "]")


def read(path):
    with open(path, newline="") as file:
        return file.read()


if sys.argv[1] == "respell":
    source = read(sys.argv[3])
    with open(sys.argv[4], "w", newline="") as out:
        out.write(" \n" + respell(random.Random(sys.argv[2]), parse(source, SPACE.match(source).end())) + "\t\n")
else:
    texts = [read(path) for path in sys.argv[2:]]
    begins = [SPACE.match(text).end() for text in texts]
    values = [parse(text, begin) for text, begin in zip(texts, begins)]
    compare(*values, "")
    if texts[0][:begins[0]] != texts[1][:begins[1]] or texts[0][values[0][2]:] != texts[1][values[1][2]:]:
        print("white space around the document")

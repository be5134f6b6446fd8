# SPDX-License-Identifier: MIT
"""Checks the rooms of src against the table in src/README.md.

    rooms.py [BUILD_DIR]

A room is a folder below src. An arrow goes from a file to another that it includes and, with BUILD_DIR, from
one whose object needs a symbol to the one that defines it. Prints a line for each arrow between rooms that the
table does not allow, each circle of headers (by includes), of source files (by symbols) and of rooms (by both),
each room that is too large, and each difference between the table and the folders. Ends with 1 if there was any.
"""
import os
import re
import subprocess
import sys
from collections import defaultdict

MOST_FILES = 24
MOST_LINES = 6500
SOURCES = (".c", ".h", ".cpp", ".hpp")
# every room may use it, so the table does not repeat it
FREE = "base"

faults = 0


def fault(text):
    global faults
    faults += 1
    print("lint: " + text)


def read_table(path):
    """Rooms in the order of the table, each with the set of those that it may use."""
    may, inside = {}, False
    if not os.path.exists(path):
        fault(f"{path}: is missing; its table says who may use whom")
        return may
    for line in open(path, encoding="utf-8"):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and cells[0] == "room" and cells[-1] == "may use":
            inside = True
        elif inside and not line.startswith("|"):
            break
        elif inside and not set(line.strip()) <= set("|-: "):
            names = cells[-1].replace("-", "").replace("–", "").split()
            may[cells[0].strip("`").rstrip("/")] = {name.strip("`").rstrip("/") for name in names}
    if not may:
        fault(f"{path}: no table with the columns room and may use")
    return may


def rooms_of_tree():
    """Room -> its source files."""
    rooms = defaultdict(list)
    for folder, _, names in os.walk("src"):
        for name in sorted(names):
            if name.endswith(SOURCES):
                rooms[os.path.relpath(folder, "src")].append(os.path.join(folder, name))
    return rooms


def room_of(path):
    return os.path.dirname(os.path.relpath(path, "src"))


def included(path):
    pattern = re.compile(r'\s*#\s*include\s+"([^"]+)"')
    for line in open(path, encoding="utf-8"):
        found = pattern.match(line)
        if found and os.path.exists(os.path.join("src", found[1])):
            yield os.path.join("src", found[1])


def symbols(build, sources):
    """The definition of each strong symbol, and the symbols that each source file needs, by its object."""
    defines, needs = {}, {}
    for source in sources:
        built = os.path.join(build, os.path.relpath(source, "src") + ".o")
        if not os.path.exists(built):
            continue
        text = subprocess.run(["nm", "-P", built], capture_output=True, text=True, check=True)
        for line in text.stdout.splitlines():
            symbol, kind = line.split()[:2]
            if kind in "TDBRC":
                defines[symbol] = source
            elif kind == "U":
                needs.setdefault(source, set()).add(symbol)
    return defines, needs


def circles(arrows):
    """Strongly connected components of more than one node (Tarjan, "Depth-first search and linear graph
    algorithms", 1972)."""
    index, low, stack, result = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for target in sorted(arrows.get(node, ())):
            if target not in index:
                visit(target)
                low[node] = min(low[node], low[target])
            elif target in stack:
                low[node] = min(low[node], index[target])
        if low[node] == index[node]:
            component = []
            while node not in component:
                component.append(stack.pop())
            if len(component) > 1:
                result.append(sorted(component))

    for node in sorted(arrows):
        if node not in index:
            visit(node)
    return result


def check_sizes(rooms, may):
    for room, paths in sorted(rooms.items()):
        if room not in may:
            fault(f"src/{room}: not in the table of src/README.md")
        lines = sum(sum(1 for _ in open(path, encoding="utf-8")) for path in paths)
        sources = sum(path.endswith((".c", ".cpp")) for path in paths)
        if sources > MOST_FILES or lines > MOST_LINES:
            fault(f"src/{room}: {sources} source files, {lines} lines; at most {MOST_FILES} and {MOST_LINES}")
    for room, targets in may.items():
        for name in sorted({room} | targets):
            if name not in rooms:
                fault(f"src/README.md: the table names {name}, and src has no such folder")


def main():
    sys.setrecursionlimit(10000)
    may = read_table("src/README.md")
    rooms = rooms_of_tree()
    files = [path for paths in rooms.values() for path in paths]
    check_sizes(rooms, may)

    arrows = {}  # (from, to) -> why
    headers, calls, between = defaultdict(set), defaultdict(set), defaultdict(set)
    for path in files:
        for target in included(path):
            arrows.setdefault((path, target), f"includes {target}")
            if path.endswith((".h", ".hpp")):
                headers[path].add(target)
    if len(sys.argv) > 1:
        defines, needs = symbols(sys.argv[1], files)
        if not defines:
            fault(f"{sys.argv[1]}: no objects to read symbols from")
        for path, wanted in needs.items():
            for symbol in sorted(wanted & defines.keys()):
                target = defines[symbol]
                arrows.setdefault((path, target), f"calls {symbol} of {target}")
                calls[path].add(target)

    for (path, target), how in sorted(arrows.items()):
        room, other = room_of(path), room_of(target)
        if room == other:
            continue
        between[room].add(other)
        if other != FREE and room in may and other not in may[room]:
            fault(f"{path}: {room} may not use {other}; it {how}")
    for name, graph in (("headers", headers), ("files", calls), ("folders", between)):
        for circle in circles(graph):
            fault(f"{name} in a circle: " + " ".join(circle))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: MIT
"""The Python module against the goldens and the example of nmtan.h. NMTAN_DATA names the folder data."""

import doctest
import glob
import multiprocessing
import os
import struct
import threading
from types import SimpleNamespace

import numpy as np
import pytest

import nmtan

DATA = os.environ["NMTAN_DATA"]
POSITIONS = np.float32([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
NORMALS = np.tile(np.float32([0, 0, 1]), (6, 1))
TEXCOORDS = np.float32([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [0, 1]])
FACES = np.uint32([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
QUADS = np.uint32([[0, 1, 2, 3], [1, 4, 5, 2]])
FACES_OF_CUBE = 10  # quads of data/mirrored_cube.obj
LEFT, RIGHT = [1, 0, 0, 1], [-1, 0, 0, -1]


def read_golden(path):
    with open(path, "rb") as file:
        data = file.read()
    faces, corners = struct.unpack_from("<II", data, 8)
    sizes = np.frombuffer(data, np.uint8, faces, 16)
    numbers = np.frombuffer(data, "<f4", 12 * corners, 16 + (faces + 3 & ~3))
    cut = np.split(numbers, [3 * corners, 6 * corners, 8 * corners])
    return sizes, [part.reshape(corners, -1) for part in cut]


# Meshes whose faces have one size, as an array [faces, 3] or [faces, 4] has.
GOLDENS = {os.path.basename(path): golden for path in sorted(glob.glob(os.path.join(DATA, "golden", "*.nmtg")))
           if len(set((golden := read_golden(path))[0])) == 1}


@pytest.mark.parametrize("name", GOLDENS)
def test_goldens(name):
    sizes, (positions, normals, texcoords, expected) = GOLDENS[name]
    faces = None if sizes[0] == 3 else np.arange(len(positions)).reshape(-1, 4)
    found = nmtan.tangents(positions, normals, texcoords, faces, repair=False)
    assert found.tobytes() == expected.tobytes()


@pytest.mark.parametrize("folder, method", [("published", "mikktspace"), ("sorted", "mikktspace-sorted")])
def test_goldens_of_the_sort_of_edges(folder, method):
    paths = glob.glob(os.path.join(DATA, "golden", "edge_sort", folder, "*.nmtg"))
    alike = [golden for golden in map(read_golden, paths) if len(set(golden[0])) == 1]
    assert len(alike) > 5
    for sizes, (positions, normals, texcoords, expected) in alike:
        faces = None if sizes[0] == 3 else np.arange(len(positions)).reshape(-1, 4)
        found = nmtan.tangents(positions, normals, texcoords, faces, repair=False, method=method)
        assert found.tobytes() == expected.tobytes()


def test_a_limit_is_counted():
    far = POSITIONS.copy()
    far[0, 0] = np.inf
    assert nmtan.vertex_tangents(far, NORMALS, TEXCOORDS, FACES).counts.sorted_instead == 1
    assert nmtan.vertex_tangents(POSITIONS, NORMALS, TEXCOORDS, FACES).counts.sorted_instead == 0


def test_there_are_goldens():
    assert sum(sizes[0] == 3 for sizes, _ in GOLDENS.values()) > 20


def test_corners():
    found = nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)
    assert found.dtype == np.float32
    assert (found == [LEFT] * 6 + [RIGHT] * 6).all()
    assert (nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, QUADS) == [LEFT] * 4 + [RIGHT] * 4).all()


def test_vertices():
    result = nmtan.vertex_tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)
    assert result.sources.tolist() == [1, 2]
    assert result.faces.tolist() == [[0, 1, 2], [0, 2, 3], [6, 4, 5], [6, 5, 7]]
    assert (result.tangents == [LEFT] * 4 + [RIGHT] * 4).all()
    assert result.counts.mirrored == 2
    assert result.apply(POSITIONS)[6:].tolist() == [[1, 0, 0], [1, 1, 0]]


def test_split_of_corners_is_the_same():
    corners = nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)
    one, other = nmtan.split(FACES, corners, 6), nmtan.vertex_tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)
    for a, b in zip(one[:3], other[:3]):
        assert (a == b).all()


def test_v_down():
    down = TEXCOORDS * [1, -1] + [0, 1]
    before = down.copy()
    found = nmtan.tangents(POSITIONS, NORMALS, down, FACES, v_down=True)
    assert (found == nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)).all()
    assert (down == before).all()


@pytest.mark.parametrize("method", ["mikktspace", "area", "lengyel", "robust", "mikktspace-sorted"])
def test_methods(method):
    assert (nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, FACES, method=method) == [LEFT] * 6 + [RIGHT] * 6).all()


def test_arrays_of_other_kinds():
    expected = nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, FACES).tobytes()
    rows = np.concatenate([POSITIONS, NORMALS, TEXCOORDS], axis=1)  # interleaved: read where they stand
    kinds = {
        "lists": (POSITIONS.tolist(), NORMALS.tolist(), TEXCOORDS.tolist(), FACES.tolist()),
        "double, int64": (POSITIONS.astype(float), NORMALS.astype(float), TEXCOORDS.astype(float), FACES.astype(np.int64)),
        "interleaved": (rows[:, :3], rows[:, 3:6], rows[:, 6:], FACES),
        "columns": tuple(np.asfortranarray(a) for a in (POSITIONS, NORMALS, TEXCOORDS, FACES)),
        "backwards": tuple(a[::-1].copy()[::-1] for a in (POSITIONS, NORMALS, TEXCOORDS, FACES)),
        "big endian": tuple(a.astype(a.dtype.newbyteorder(">")) for a in (POSITIONS, NORMALS, TEXCOORDS, FACES)),
    }
    for name, arrays in kinds.items():
        assert nmtan.tangents(*arrays).tobytes() == expected, name


def test_a_mesh_as_trimesh_has_it():
    mesh = SimpleNamespace(vertices=POSITIONS.astype(float), vertex_normals=NORMALS.astype(float), faces=FACES.astype(np.int64),
                           visual=SimpleNamespace(uv=TEXCOORDS.astype(float)))
    result = nmtan.vertex_tangents(mesh.vertices, mesh.vertex_normals, mesh.visual.uv, mesh.faces)
    assert result.apply(mesh.vertices)[result.faces].tolist() == mesh.vertices[mesh.faces].tolist()
    assert result.apply(mesh.visual.uv).shape == (8, 2)


def test_no_copy_of_what_fits():
    rows = np.concatenate([POSITIONS, NORMALS, TEXCOORDS], axis=1)
    given = nmtan._Input(rows[:, :3], rows[:, 3:6], TEXCOORDS, FACES)
    assert np.shares_memory(given.positions, rows) and np.shares_memory(given.normals, rows)
    assert np.shares_memory(given.texcoords, TEXCOORDS) and np.shares_memory(given.faces, FACES)
    assert given.mesh.position_stride_bytes == 32


WRONG = {
    "positions of two numbers": (dict(positions=POSITIONS[:, :2]), "positions: shape"),
    "positions in one row": (dict(positions=POSITIONS.ravel()), "positions: shape"),
    "words": (dict(positions=np.array([["a", "b", "c"]] * 6)), "positions: numbers"),
    "fewer normals": (dict(normals=NORMALS[:5]), "normals: 5 vertices, positions has 6"),
    "fewer texcoords": (dict(texcoords=TEXCOORDS[:5]), "texcoords: 5 vertices"),
    "a pentagon": (dict(faces=[[0, 1, 2, 3, 4]]), "faces: shape"),
    "an index too large": (dict(faces=[[0, 1, 6]]), "index"),
    "a negative index": (dict(faces=[[0, 1, -1]]), "out of range"),
    "an index above 32 bits": (dict(faces=[[0, 1, 2 ** 32]]), "out of range"),
    "indices that are no integers": (dict(faces=[[0.0, 1.0, 2.0]]), "integers"),
    "a method": (dict(method="best"), "method: one of"),
    "unsigned normals": (dict(normals=NORMALS.astype(np.uint8)), "normals: floats are expected, or int8"),
    "a face of five corners": (dict(faces=[0, 1, 2, 3, 4], face_sizes=[5]), "face_sizes: one row of 3 and 4"),
    "sizes of fewer corners": (dict(faces=FACES.ravel(), face_sizes=[3, 4]), "face_sizes: they make 7 corners, there are 12"),
    "rows of faces with sizes": (dict(face_sizes=[3] * 4), r"faces: shape \[corners\] is expected"),
    "threads": (dict(threads=-1), "threads"),
    "a threshold": (dict(angular_threshold=181.0), "argument"),
}


@pytest.mark.parametrize("name", WRONG)
@pytest.mark.parametrize("function", [nmtan.tangents, nmtan.vertex_tangents])
def test_refused(function, name):
    change, text = WRONG[name]
    with pytest.raises(ValueError, match=text):
        function(**{**dict(positions=POSITIONS, normals=NORMALS, texcoords=TEXCOORDS, faces=FACES), **change})


@pytest.mark.parametrize("function", [nmtan.tangents, nmtan.vertex_tangents])
def test_the_old_word_names_the_new_one(function):
    with pytest.raises(TypeError, match="convention: it is v_down now"):
        function(POSITIONS, NORMALS, TEXCOORDS, FACES, convention="gltf")
    with pytest.raises(TypeError, match="v_down: True or False"):
        function(POSITIONS, NORMALS, TEXCOORDS, FACES, v_down="gltf")
    with pytest.raises(TypeError):
        function(POSITIONS, NORMALS, TEXCOORDS, FACES, vdown=True)


def test_normals_of_signed_integers():
    slanted = np.tile(np.float64([100, 30, 70]), (6, 1))
    unit = slanted / np.linalg.norm(slanted[0])
    expected = nmtan.tangents(POSITIONS, unit, TEXCOORDS, FACES)
    for kind, most in ((np.int8, 127), (np.int16, 32767)):
        result = nmtan.corner_tangents(POSITIONS, np.round(slanted / 127 * most).astype(kind), TEXCOORDS, FACES)
        assert np.abs(result.tangents - expected).max() < 1e-4
        assert result.counts.normals_not_unit == 0
    assert nmtan.corner_tangents(POSITIONS, slanted, TEXCOORDS, FACES).counts.normals_not_unit == 6
    minus = nmtan.tangents(POSITIONS, (-128 * NORMALS).astype(np.int8), TEXCOORDS, FACES)
    assert minus.tobytes() == nmtan.tangents(POSITIONS, -NORMALS, TEXCOORDS, FACES).tobytes()


def test_mixed_faces():
    faces, sizes = [0, 1, 2, 3, 1, 4, 5, 1, 5, 2], [4, 3, 3]
    assert (nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, faces, face_sizes=sizes) == [LEFT] * 4 + [RIGHT] * 6).all()
    result = nmtan.vertex_tangents(POSITIONS, NORMALS, TEXCOORDS, faces, face_sizes=sizes)
    assert result.sources.tolist() == [1, 2] and result.faces.tolist() == [0, 1, 2, 3, 6, 4, 5, 6, 5, 7]
    corners = nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, faces, face_sizes=sizes)
    assert nmtan.split(faces, corners, 6, face_sizes=sizes).faces.tolist() == result.faces.tolist()
    soup = [array[faces] for array in (POSITIONS, NORMALS, TEXCOORDS)]
    assert (nmtan.tangents(*soup, face_sizes=sizes) == corners).all()


def test_what_is_known_of_corners():
    result = nmtan.corner_tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)
    assert (result.tangents == nmtan.tangents(POSITIONS, NORMALS, TEXCOORDS, FACES)).all()
    assert (result.bitangents == [0, 1, 0]).all() and not result.faults.any() and result.counts.mirrored == 2
    flat = nmtan.corner_tangents(POSITIONS, NORMALS, 0 * TEXCOORDS, FACES)
    assert (flat.faults & 16 == 16).all() and flat.counts.repaired_unassigned == 12  # NMTAN_FAULT_UNASSIGNED


def test_refused_without_faces():
    with pytest.raises(ValueError, match="do not make triangles"):
        nmtan.tangents(POSITIONS[:4], NORMALS[:4], TEXCOORDS[:4])
    with pytest.raises(ValueError, match="faces: shape"):
        nmtan.vertex_tangents(POSITIONS, NORMALS, TEXCOORDS, None)
    with pytest.raises(ValueError, match=r"tangents: shape \[12, 4\]"):
        nmtan.split(FACES, np.zeros((6, 4)), 6)
    with pytest.raises(ValueError, match="index"):
        nmtan.split(FACES, np.zeros((12, 4)), 5)


def test_empty():
    empty = np.zeros((0, 3), np.float32)
    assert nmtan.tangents(empty, empty, empty[:, :2]).shape == (0, 4)
    assert nmtan.vertex_tangents(POSITIONS, NORMALS, TEXCOORDS, []).tangents.shape == (6, 4)


def grid(n):
    """A bumpy grid of 2 n^2 triangles: many enough for threads."""
    u, v = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    z = 0.1 * np.sin(9 * u) * np.cos(7 * v)
    positions = np.stack([u, v, z], axis=-1).reshape(-1, 3).astype(np.float32)
    normals = np.stack([-0.9 * np.cos(9 * u) * np.cos(7 * v), 0.7 * np.sin(9 * u) * np.sin(7 * v), np.ones_like(u)], axis=-1)
    normals = (normals / np.linalg.norm(normals, axis=-1, keepdims=True)).reshape(-1, 3).astype(np.float32)
    texcoords = np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32)
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + n + 1], 1)]).astype(np.uint32)
    return positions, normals, texcoords, faces


def test_theory_on_a_height_field():
    positions, normals, texcoords, faces = grid(64)
    found = nmtan.vertex_tangents(positions, normals, texcoords, faces)
    assert len(found.sources) == 0 and (found.tangents[:, 3] == 1).all()
    # T is along dP/du = (1, 0, dz/du), which crosses the normal; a grid of 64 leaves 0.02
    u, v = texcoords.astype(float).T
    exact = np.stack([np.ones_like(u), 0 * u, 0.9 * np.cos(9 * u) * np.cos(7 * v)], 1)
    exact -= normals * np.sum(exact * normals, 1, keepdims=True)
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    inside = (u > 0) & (u < 1) & (v > 0) & (v < 1)
    assert np.abs(found.tangents[inside, :3] - exact[inside]).max() < 0.02


def test_threads_of_both_kinds():
    mesh = grid(400)
    expected = nmtan.tangents(*mesh, threads=1).tobytes()
    assert nmtan.tangents(*mesh, threads=2).tobytes() == expected
    results = [None] * 4

    def solve(i):
        results[i] = nmtan.tangents(*mesh).tobytes()

    threads = [threading.Thread(target=solve, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected] * 4


def solve_in_child(_):
    return nmtan.tangents(*grid(400), threads=2).tobytes()


def test_fork_after_threads():
    expected = nmtan.tangents(*grid(400), threads=2).tobytes()
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(solve_in_child, range(3)).get(timeout=600) == [expected] * 3


def test_gil_is_released():
    mesh, ticks, done = grid(700), [0], threading.Event()

    def tick():
        while not done.wait(0.001):
            ticks[0] += 1

    thread = threading.Thread(target=tick)
    thread.start()
    before = ticks[0]
    for _ in range(5):
        nmtan.tangents(*mesh, threads=1)
    during = ticks[0] - before
    done.set()
    thread.join()
    assert during >= 5


def test_structs_are_those_of_the_header():
    with open(os.environ["NMTAN_HEADER"], encoding="utf-8") as file:
        header = file.read()
    from nmtan import _library
    for struct_type, name in ((_library.Mesh, "mesh"), (_library.Options, "options"), (_library.Counts, "counts"),
                              (_library.Output, "output"), (_library.SplitOutput, "split_output")):
        begin = header.index(f"typedef struct nmtan_{name} {{")
        body = header[begin:header.index(f"}} nmtan_{name};", begin)]
        at = 0
        for member, _ in struct_type._fields_:  # in this order; a newer header may have more
            at = body.index(f"{member};", at)


def convert(*arguments, **options):
    return nmtan.convert(*arguments, program=os.environ["NMTAN"], **options)


def test_convert(tmp_path):
    output = tmp_path / "cube.gltf"
    result = convert(os.path.join(DATA, "mirrored_cube.obj"), output, verify=True, quiet=True, report=None)
    assert result.status == "done" and result.exit_code == 0
    assert str(output) in result.outputs and str(tmp_path / "cube.bin") in result.outputs
    assert all(os.path.exists(path) for path in result.outputs)
    assert any(path.endswith("mirrored_cube.obj") for path in result.dependencies)
    assert result.manifest["triangles"] == 2 * FACES_OF_CUBE


def test_convert_fails_as_the_tool_does(tmp_path):
    with pytest.raises(nmtan.ConversionError, match="no such file") as caught:
        convert(tmp_path / "nothing.obj", tmp_path / "nothing.glb")
    assert caught.value.exit_code == 2 and caught.value.conversion.status == "failed"
    with pytest.raises(nmtan.ConversionError, match="unknown option") as caught:
        convert("a.obj", "a.glb", no_such_option=True)
    assert caught.value.exit_code == 1 and caught.value.conversion is None
    for paths in (("-", "a.glb"), ("a.obj", "-")):
        with pytest.raises(ValueError, match="put: the path of a file"):
            convert(*paths)
    with pytest.raises(FileNotFoundError):
        nmtan.convert("a.obj", "a.glb", program="/no/such/nmtan")


def test_version():
    with open(os.environ["NMTAN_HEADER"], encoding="utf-8") as file:
        assert f'"{nmtan.version()}"' in file.read()


def test_example():
    assert doctest.testmod(nmtan).attempted >= 8
    assert doctest.testmod(nmtan).failed == 0

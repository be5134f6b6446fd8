# SPDX-License-Identifier: MIT
"""Tangents for normal-mapped meshes: mikktspace.c to the byte, indexed or not, in NumPy arrays.

    >>> import numpy as np, nmtan
    >>> positions = np.array([[0,0,0], [1,0,0], [1,1,0], [0,1,0], [2,0,0], [2,1,0]], np.float32)
    >>> normals = np.tile(np.float32([0, 0, 1]), (6, 1))
    >>> texcoords = np.array([[0,0], [1,0], [1,1], [0,1], [0,0], [0,1]], np.float32)
    >>> faces = np.array([[0,1,2], [0,2,3], [1,4,5], [1,5,2]], np.uint32)
    >>> result = nmtan.vertex_tangents(positions, normals, texcoords, faces)
    >>> result.sources  # vertices 6 and 7 are copies of these
    array([1, 2], dtype=uint32)
    >>> result.apply(texcoords)[6:].tolist()
    [[1.0, 0.0], [1.0, 1.0]]

Arrays of float32 whose rows are contiguous are read where they stand; others are converted. V points up, as in OBJ
files, Blender and bakers: pass v_down=True where it points down, as in glTF. Normals of int8 and int16 are normalized as
glTF has them. The GIL is released while a mesh is solved.

convert() runs the tool on whole files.

Errors: ValueError for arrays that do not fit each other, numbers out of range and unknown names; MemoryError.
"""

from typing import Any, Callable, NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _library
from ._convert import Conversion, ConversionError, convert

__all__ = ["Conversion", "ConversionError", "CornerTangents", "Counts", "VertexTangents", "convert", "corner_tangents",
           "split", "tangents", "version", "vertex_tangents"]

_lib = _library.load()
_METHODS = ("mikktspace", "area", "lengyel", "robust", "mikktspace-sorted")
_OUT_OF_MEMORY = 5


class Counts(NamedTuple):
    """Counts of a solve and its repair, in corners unless nmtan.h says otherwise."""

    degenerate_positions: int
    degenerate_texcoords: int
    mirrored: int
    stored_differently: int
    folded_quads: int
    repaired_zero: int
    repaired_not_finite: int
    repaired_parallel: int
    repaired_sign: int
    repaired_unassigned: int
    repaired_leaning: int
    ill_conditioned: int
    sorted_instead: int
    summed_instead: int
    normals_not_unit: int


class CornerTangents(NamedTuple):
    """The attributes of each corner of the faces, in their order."""

    tangents: NDArray[np.float32]  #: [corners, 4]: x, y, z, w
    bitangents: NDArray[np.float32]  #: [corners, 3]: MikkTSpace's own, not cross(N, T) * w
    faults: NDArray[np.uint8]  #: [corners]: bits of nmtan_fault in nmtan.h
    counts: Counts


class VertexTangents(NamedTuple):
    """One tangent for each vertex, and the copies that this takes."""

    tangents: NDArray[np.float32]  #: [vertices + copies, 4]: x, y, z, w
    faces: NDArray[np.uint32]  #: the shape that was given: vertices after the split
    sources: NDArray[np.uint32]  #: [copies]: of which vertex each is a copy
    counts: Counts

    def apply(self, attribute: ArrayLike) -> NDArray[Any]:
        """An array of one row per vertex with the rows of the copies appended."""
        attribute = np.asarray(attribute)
        return np.concatenate([attribute, attribute[self.sources]])


def version() -> str:
    """Version of the library that runs, as "0.1.0"."""
    return str(_lib.nmtan_version().decode())


def _pointer(array: Optional[NDArray[Any]], kind: Any) -> Any:
    return None if array is None else array.ctypes.data_as(kind)


def _rows(values: ArrayLike, name: str, size: int) -> NDArray[np.float32]:
    """float32 rows with stride_bytes; no copy where they are that already."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != size:
        raise ValueError(f"{name}: shape [vertices, {size}] is expected, not {list(array.shape)}")
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: numbers are expected, not {array.dtype}")
    rows: NDArray[np.float32] = array.astype(np.float32, copy=False)
    if rows.strides[1] != 4 or rows.strides[0] % 4 or rows.strides[0] < 4 * size or rows.ctypes.data % 4 or \
            not rows.dtype.isnative:
        rows = np.ascontiguousarray(rows, np.dtype(np.float32))
    return rows


def _normals(values: ArrayLike) -> NDArray[np.float32]:
    """Signed integers of 8 and 16 bits are normalized, as glTF has them, and made unit as the tool does."""
    array = np.asarray(values)
    if array.dtype.kind == "u" and array.dtype.itemsize <= 2:
        raise ValueError(f"normals: floats are expected, or int8 or int16, which are normalized, not {array.dtype}")
    rows = _rows(array, "normals", 3)
    if array.dtype.kind == "i" and array.dtype.itemsize <= 2:
        rows = np.maximum(array / (2 ** (8 * array.dtype.itemsize - 1) - 1), -1).astype(np.float32)
        x, y, z = rows.T.astype(np.float64)
        squared = x * x + y * y + z * z
        length = np.sqrt(np.where((np.abs(squared - 1) <= 2 ** -11) | (squared == 0), 1, squared))
        rows = np.ascontiguousarray(rows / length[:, None], np.float32)
    return rows


def _indices(values: ArrayLike, name: str) -> NDArray[np.uint32]:
    array = np.asarray(values)
    if array.size == 0:
        array = array.astype(np.uint32)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: integers are expected, not {array.dtype}")
    if array.dtype != np.uint32:
        if array.size and (array.min() < 0 or array.max() > 0xffffffff):
            raise ValueError(f"{name}: the number of a vertex is out of range")
    return np.ascontiguousarray(array, np.uint32)


class _Input:
    """The struct for C, and what it points to for as long as it is used."""

    def __init__(self, positions: ArrayLike, normals: ArrayLike, texcoords: ArrayLike, faces: Optional[ArrayLike],
                 face_sizes: Optional[ArrayLike] = None, v_down: bool = False) -> None:
        if not isinstance(v_down, (bool, np.bool_)):
            raise TypeError(f"v_down: True or False is expected, not {v_down!r}")
        self.positions = _rows(positions, "positions", 3)
        self.normals = _normals(normals)
        self.texcoords = _rows(texcoords, "texcoords", 2)
        count = len(self.positions)
        for name in ("normals", "texcoords"):
            if len(getattr(self, name)) != count:
                raise ValueError(f"{name}: {len(getattr(self, name))} vertices, positions has {count}")
        self.faces = None if faces is None else _indices(faces, "faces")
        self.face_sizes: Optional[NDArray[np.uint8]] = None
        if face_sizes is not None:
            self._take_sizes(np.asarray(face_sizes), count)
        elif self.faces is not None:
            if self.faces.size == 0 and self.faces.ndim != 2:
                self.faces = self.faces.reshape(0, 3)
            if self.faces.ndim != 2 or self.faces.shape[1] not in (3, 4):
                raise ValueError("faces: shape [faces, 3] or [faces, 4] is expected, or [corners] with face_sizes, not "
                                 f"{list(self.faces.shape)}")
            self.face_count, corners_of_face = self.faces.shape
            self.corner_count = self.faces.size
            if corners_of_face == 4:
                self.face_sizes = np.full(self.face_count, 4, np.uint8)
        else:
            if count % 3:
                raise ValueError(f"positions: without faces {count} vertices do not make triangles")
            self.face_count, self.corner_count = count // 3, count
        self.mesh = _library.Mesh(
            face_count=self.face_count, vertex_count=count, face_sizes=_pointer(self.face_sizes, _library.uint8_p),
            indices=_pointer(self.faces, _library.uint32_p), v_down=int(v_down),
            positions=_pointer(self.positions, _library.float_p), position_stride_bytes=_stride(self.positions),
            normals=_pointer(self.normals, _library.float_p), normal_stride_bytes=_stride(self.normals),
            texcoords=_pointer(self.texcoords, _library.float_p), texcoord_stride_bytes=_stride(self.texcoords))

    def _take_sizes(self, sizes: NDArray[Any], vertex_count: int) -> None:
        if sizes.ndim != 1 or not np.isin(sizes, (3, 4)).all():
            raise ValueError("face_sizes: one row of 3 and 4 is expected")
        if self.faces is not None and self.faces.ndim != 1:
            raise ValueError(f"faces: shape [corners] is expected with face_sizes, not {list(self.faces.shape)}")
        self.face_sizes = sizes.astype(np.uint8)
        self.face_count, self.corner_count = len(sizes), int(sizes.sum())
        corners = vertex_count if self.faces is None else len(self.faces)
        if corners != self.corner_count:
            raise ValueError(f"face_sizes: they make {self.corner_count} corners, there are {corners}")


def _stride(array: NDArray[Any]) -> int:
    # NumPy says 0 or anything for arrays of no or one row
    return array.strides[0] if len(array) > 1 else 0


def _options(method: str, repair: bool, threads: int, angular_threshold: float = 0.0,
             convention: None = None) -> _library.Options:
    if convention is not None:
        raise TypeError(f"convention: it is v_down now: True for 'gltf', False, the default, otherwise; not {convention!r}")
    if method not in _METHODS:
        raise ValueError(f"method: one of {', '.join(_METHODS)} is expected, not {method!r}")
    if not 0 <= threads < 2 ** 31:
        raise ValueError(f"threads: 0 or more is expected, not {threads}")
    return _library.Options(method=_METHODS.index(method), repair=0 if repair else 1, threads=threads,
                            angular_threshold_degrees=angular_threshold)


def _check(status: int) -> None:
    text = _lib.nmtan_status_text(status).decode()
    if status == _OUT_OF_MEMORY:
        raise MemoryError(text)
    if status:
        raise ValueError(text)


def _read(counts: _library.Counts) -> Counts:
    return Counts(*(getattr(counts, name) for name in Counts._fields))


def tangents(positions: ArrayLike, normals: ArrayLike, texcoords: ArrayLike, faces: Optional[ArrayLike] = None, *,
             face_sizes: Optional[ArrayLike] = None, method: str = "mikktspace", repair: bool = True,
             v_down: bool = False, angular_threshold: float = 180.0, threads: int = 0,
             convention: None = None) -> NDArray[np.float32]:
    """One tangent for each corner of each face.

    positions, normals: [vertices, 3]; texcoords: [vertices, 2]; faces: [faces, 3] or [faces, 4], or None where each
    three vertices make a triangle; with face_sizes, [faces] of 3 and 4, the vertices of all corners in one row. method: "mikktspace", with the bytes of mikktspace.c as published,
    "mikktspace-sorted", with those of the rewrites of Blender and three.js, which complete its sort of edges, "area",
    "lengyel" or "robust". repair: replace what a renderer cannot use. v_down: v points down in texcoords, as in
    glTF. threads: 0 is one per processor; the result does not depend on it.

    Positions that are not finite or reach half of the largest float, and the bounds on work that nmtan.h states under
    "Results", give the answer of "mikktspace-sorted" (Counts.sorted_instead).

    Returns float32 [corners, 4]: T and w; the bitangent is cross(N, T) * w.
    """
    given = _Input(positions, normals, texcoords, faces, face_sizes, v_down)
    result = np.empty((given.corner_count, 4), np.float32)
    _check(_lib.nmtan_tangents(given.mesh, _options(method, repair, threads, angular_threshold, convention),
                               _library.Output(tangents=_pointer(result, _library.float_p)), None))
    return result


def corner_tangents(positions: ArrayLike, normals: ArrayLike, texcoords: ArrayLike, faces: Optional[ArrayLike] = None, *,
                    face_sizes: Optional[ArrayLike] = None, method: str = "mikktspace", repair: bool = True,
                    v_down: bool = False, angular_threshold: float = 180.0, threads: int = 0) -> CornerTangents:
    """tangents(), and what else is known: bitangents, what was wrong with each corner, counts."""
    given, counts = _Input(positions, normals, texcoords, faces, face_sizes, v_down), _library.Counts()
    result, bitangents = np.empty((given.corner_count, 4), np.float32), np.empty((given.corner_count, 3), np.float32)
    faults = np.empty(given.corner_count, np.uint8)
    output = _library.Output(tangents=_pointer(result, _library.float_p), bitangents=_pointer(bitangents, _library.float_p),
                             corner_faults=_pointer(faults, _library.uint8_p))
    _check(_lib.nmtan_tangents(given.mesh, _options(method, repair, threads, angular_threshold), output, counts))
    return CornerTangents(result, bitangents, faults, _read(counts))


def vertex_tangents(positions: ArrayLike, normals: ArrayLike, texcoords: ArrayLike, faces: ArrayLike, *,
                    face_sizes: Optional[ArrayLike] = None, method: str = "mikktspace", repair: bool = True,
                    v_down: bool = False, angular_threshold: float = 180.0, threads: int = 0,
                    convention: None = None) -> VertexTangents:
    """One tangent for each vertex; vertices whose corners need different ones are copied. Arguments: see tangents().

    A mesh of trimesh has them all, in double and int64, which are converted:

        result = nmtan.vertex_tangents(mesh.vertices, mesh.vertex_normals, mesh.visual.uv, mesh.faces)
        vertices, texcoords = result.apply(mesh.vertices), result.apply(mesh.visual.uv)
    """
    if faces is None:
        raise ValueError("faces: shape [faces, 3] or [faces, 4] is expected, not None")
    given = _Input(positions, normals, texcoords, faces, face_sizes, v_down)
    options, counts = _options(method, repair, threads, angular_threshold, convention), _library.Counts()
    split_faces, sources, rows = _solve_split(
        given, lambda output: int(_lib.nmtan_vertex_tangents(given.mesh, options, output, counts)))
    return VertexTangents(rows, split_faces, sources, _read(counts))


def split(faces: ArrayLike, tangents: ArrayLike, vertex_count: int, *, face_sizes: Optional[ArrayLike] = None,
          threads: int = 0) -> VertexTangents:
    """The copies of vertices that the tangents of corners need, as tangents() returns them. All counts are 0."""
    corners = np.ascontiguousarray(tangents, np.float32)
    none = np.zeros((vertex_count, 3), np.float32)
    given = _Input(none, none, none[:, :2], faces, face_sizes)
    if corners.shape != (given.corner_count, 4):
        raise ValueError(f"tangents: shape [{given.corner_count}, 4] is expected, not {list(corners.shape)}")
    options = _options("mikktspace", True, threads)
    split_faces, sources, rows = _solve_split(
        given, lambda output: int(_lib.nmtan_split(given.mesh, _pointer(corners, _library.float_p), options, output)))
    return VertexTangents(rows, split_faces, sources, Counts(*[0] * len(Counts._fields)))


def _solve_split(given: _Input, solve: Callable[[_library.SplitOutput], int]) \
        -> Tuple[NDArray[np.uint32], NDArray[np.uint32], NDArray[np.float32]]:
    """Calls solve(output) with room for a copy of every corner; faces, sources and tangents that it wrote."""
    assert given.faces is not None
    faces = np.empty_like(given.faces)
    sources = np.empty(given.corner_count, np.uint32)
    rows = np.empty((given.mesh.vertex_count + given.corner_count, 4), np.float32)
    output = _library.SplitOutput(indices=_pointer(faces, _library.uint32_p), sources=_pointer(sources, _library.uint32_p),
                                  source_capacity=given.corner_count, vertex_tangents=_pointer(rows, _library.float_p))
    _check(solve(output))
    count = output.source_count
    return faces, sources[:count].copy(), rows[:given.mesh.vertex_count + count].copy()

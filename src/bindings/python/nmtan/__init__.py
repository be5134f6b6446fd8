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
files, Blender and bakers: pass convention="gltf" where it points down. The GIL is released while a mesh is solved.

convert() runs the tool on whole files.

Errors: ValueError for arrays that do not fit each other, numbers out of range and unknown names; MemoryError.
"""

from typing import NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _library
from ._convert import Conversion, ConversionError, convert

__all__ = ["Conversion", "ConversionError", "Counts", "VertexTangents", "convert", "split", "tangents", "version",
           "vertex_tangents"]

_lib = _library.load()
_METHODS = ("mikktspace", "area", "lengyel", "robust", "mikktspace-sorted")
_CONVENTIONS = ("mikktspace", "gltf")
_OUT_OF_MEMORY = 5

Counts = NamedTuple("Counts", [(name, int) for name, _ in _library.Counts._fields_[1:]])
Counts.__doc__ = "What a solve met and repaired, in corners unless nmtan.h says otherwise."


class VertexTangents(NamedTuple):
    """One tangent for each vertex, and the copies that this takes."""

    tangents: NDArray[np.float32]  #: [vertices + copies, 4]: x, y, z, w
    faces: NDArray[np.uint32]  #: the shape that was given: vertices after the split
    sources: NDArray[np.uint32]  #: [copies]: of which vertex each is a copy
    counts: Counts

    def apply(self, attribute: ArrayLike) -> NDArray:
        """An array of one row per vertex with the rows of the copies appended."""
        attribute = np.asarray(attribute)
        return np.concatenate([attribute, attribute[self.sources]])


def version() -> str:
    """Version of the library that runs, as "0.1.0"."""
    return _lib.nmtan_version().decode()


def _pointer(array, kind):
    return None if array is None else array.ctypes.data_as(kind)


def _rows(values, name, size):
    """float32 rows with stride_bytes; no copy where they are that already."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != size:
        raise ValueError(f"{name}: shape [vertices, {size}] is expected, not {list(array.shape)}")
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: numbers are expected, not {array.dtype}")
    array = array.astype(np.float32, copy=False)
    if array.strides[1] != 4 or array.strides[0] % 4 or array.strides[0] < 4 * size or array.ctypes.data % 4 or \
            not array.dtype.isnative:
        array = np.ascontiguousarray(array, np.dtype(np.float32))
    return array


def _indices(values, name):
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

    def __init__(self, positions, normals, texcoords, faces, convention="mikktspace"):
        self.positions = _rows(positions, "positions", 3)
        self.normals = _rows(normals, "normals", 3)
        self.texcoords = _rows(texcoords, "texcoords", 2)
        count = len(self.positions)
        for name in ("normals", "texcoords"):
            if len(getattr(self, name)) != count:
                raise ValueError(f"{name}: {len(getattr(self, name))} vertices, positions has {count}")
        if _choose(convention, _CONVENTIONS, "convention"):
            self.texcoords = self.texcoords * np.float32([1, -1])
        self.faces = self.face_sizes = None
        corners_of_face, face_count = 3, count // 3
        if faces is not None:
            self.faces = _indices(faces, "faces")
            if self.faces.size == 0 and self.faces.ndim != 2:
                self.faces = self.faces.reshape(0, 3)
            if self.faces.ndim != 2 or self.faces.shape[1] not in (3, 4):
                raise ValueError(f"faces: shape [faces, 3] or [faces, 4] is expected, not {list(self.faces.shape)}")
            face_count, corners_of_face = self.faces.shape
        elif count % 3:
            raise ValueError(f"positions: without faces {count} vertices do not make triangles")
        if corners_of_face == 4:
            self.face_sizes = np.full(face_count, 4, np.uint8)
        self.corner_count = face_count * corners_of_face
        self.mesh = _library.Mesh(
            face_count=face_count, vertex_count=count, face_sizes=_pointer(self.face_sizes, _library.uint8_p),
            indices=_pointer(self.faces, _library.uint32_p),
            positions=_pointer(self.positions, _library.float_p), position_stride_bytes=_stride(self.positions),
            normals=_pointer(self.normals, _library.float_p), normal_stride_bytes=_stride(self.normals),
            texcoords=_pointer(self.texcoords, _library.float_p), texcoord_stride_bytes=_stride(self.texcoords))


def _stride(array):
    # NumPy says 0 or anything for arrays of no or one row
    return array.strides[0] if len(array) > 1 else 0


def _choose(value, choices, name):
    if value not in choices:
        raise ValueError(f"{name}: one of {', '.join(choices)} is expected, not {value!r}")
    return choices.index(value)


def _options(method, repair, threads, angular_threshold=0.0):
    if not 0 <= threads < 2 ** 31:
        raise ValueError(f"threads: 0 or more is expected, not {threads}")
    return _library.Options(method=_choose(method, _METHODS, "method"), repair=0 if repair else 1, threads=threads,
                            angular_threshold_degrees=angular_threshold)


def _check(status):
    if status == _OUT_OF_MEMORY:
        raise MemoryError(_lib.nmtan_status_text(status).decode())
    if status:
        raise ValueError(_lib.nmtan_status_text(status).decode())


def tangents(positions: ArrayLike, normals: ArrayLike, texcoords: ArrayLike, faces: Optional[ArrayLike] = None, *,
             method: str = "mikktspace", repair: bool = True, convention: str = "mikktspace",
             angular_threshold: float = 180.0, threads: int = 0) -> NDArray[np.float32]:
    """One tangent for each corner of each face.

    positions, normals: [vertices, 3]; texcoords: [vertices, 2]; faces: [faces, 3] or [faces, 4], or None where each
    three vertices make a triangle. method: "mikktspace", with the bytes of mikktspace.c as published,
    "mikktspace-sorted", with those of the rewrites of Blender and three.js, which complete its sort of edges, "area",
    "lengyel" or "robust". repair: replace what a renderer cannot use. convention: where v points, "mikktspace" up,
    "gltf" down. threads: 0 is one per processor; the result does not depend on it.

    Positions that are not finite or reach half of the largest float, and the bounds on work that nmtan.h states under
    "Results", give the answer of "mikktspace-sorted" (Counts.sorted_instead).

    Returns float32 [faces * corners of a face, 4]: T and w; the bitangent is cross(N, T) * w.
    """
    given = _Input(positions, normals, texcoords, faces, convention)
    result = np.empty((given.corner_count, 4), np.float32)
    _check(_lib.nmtan_tangents(given.mesh, _options(method, repair, threads, angular_threshold),
                               _library.Output(tangents=_pointer(result, _library.float_p)), None))
    return result


def vertex_tangents(positions: ArrayLike, normals: ArrayLike, texcoords: ArrayLike, faces: ArrayLike, *,
                    method: str = "mikktspace", repair: bool = True, convention: str = "mikktspace",
                    angular_threshold: float = 180.0, threads: int = 0) -> VertexTangents:
    """One tangent for each vertex; vertices whose corners need different ones are copied. Arguments: see tangents().

    A mesh of trimesh has them all, in double and int64, which are converted:

        result = nmtan.vertex_tangents(mesh.vertices, mesh.vertex_normals, mesh.visual.uv, mesh.faces)
        vertices, texcoords = result.apply(mesh.vertices), result.apply(mesh.visual.uv)
    """
    if faces is None:
        raise ValueError("faces: shape [faces, 3] or [faces, 4] is expected, not None")
    given = _Input(positions, normals, texcoords, faces, convention)
    options, counts = _options(method, repair, threads, angular_threshold), _library.Counts()
    split_faces, sources, rows = _solve_split(
        given, lambda output: _lib.nmtan_vertex_tangents(given.mesh, options, output, counts))
    return VertexTangents(rows, split_faces, sources,
                          Counts(*(getattr(counts, name) for name in Counts._fields)))


def split(faces: ArrayLike, tangents: ArrayLike, vertex_count: int, *, threads: int = 0) -> VertexTangents:
    """The copies of vertices that the tangents of corners need, as tangents() returns them. All counts are 0."""
    corners = np.ascontiguousarray(tangents, np.float32)
    none = np.zeros((vertex_count, 3), np.float32)
    given = _Input(none, none, none[:, :2], faces)
    if corners.shape != (given.corner_count, 4):
        raise ValueError(f"tangents: shape [{given.corner_count}, 4] is expected, not {list(corners.shape)}")
    options = _options("mikktspace", True, threads)
    split_faces, sources, rows = _solve_split(
        given, lambda output: _lib.nmtan_split(given.mesh, _pointer(corners, _library.float_p), options, output))
    return VertexTangents(rows, split_faces, sources, Counts(*[0] * len(Counts._fields)))


def _solve_split(given, solve):
    """Calls solve(output) with room for a copy of every corner; faces, sources and tangents that it wrote."""
    faces = np.empty_like(given.faces)
    sources = np.empty(given.corner_count, np.uint32)
    rows = np.empty((given.mesh.vertex_count + given.corner_count, 4), np.float32)
    output = _library.SplitOutput(indices=_pointer(faces, _library.uint32_p), sources=_pointer(sources, _library.uint32_p),
                                  source_capacity=given.corner_count, vertex_tangents=_pointer(rows, _library.float_p))
    _check(solve(output))
    count = output.source_count
    return faces, sources[:count].copy(), rows[:given.mesh.vertex_count + count].copy()

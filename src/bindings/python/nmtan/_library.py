# SPDX-License-Identifier: MIT
"""libnmtan.so by ctypes: the structs of nmtan.h and the functions that take them. Calls release the GIL."""

import ctypes
import os
from ctypes import POINTER, c_char_p, c_float, c_int, c_size_t, c_uint, c_uint8, c_uint32, c_void_p

from typing import Any, Dict, List, Tuple

float_p, uint8_p, uint32_p = POINTER(c_float), POINTER(c_uint8), POINTER(c_uint32)


class Struct(ctypes.Structure):
    """A struct of nmtan.h: struct_bytes is its size, and zero is the default of all else."""

    def __init__(self, **members: Any) -> None:
        super().__init__(struct_bytes=ctypes.sizeof(type(self)), **members)


class Mesh(Struct):
    _fields_ = [("struct_bytes", c_size_t), ("face_count", c_size_t), ("vertex_count", c_size_t),
                ("face_sizes", uint8_p), ("indices", uint32_p), ("positions", float_p),
                ("position_stride_bytes", c_size_t), ("normals", float_p), ("normal_stride_bytes", c_size_t),
                ("texcoords", float_p), ("texcoord_stride_bytes", c_size_t), ("stored", c_void_p),
                ("v_down", c_size_t)]


class Options(Struct):
    _fields_ = [("struct_bytes", c_size_t), ("method", c_int), ("repair", c_int),
                ("angular_threshold_degrees", c_float), ("threads", c_uint), ("allocator", c_void_p),
                ("timing", c_void_p), ("workspace", c_void_p)]


class Counts(Struct):
    _fields_ = [(name, c_size_t) for name in (
        "struct_bytes", "degenerate_positions", "degenerate_texcoords", "mirrored", "stored_differently",
        "folded_quads", "repaired_zero", "repaired_not_finite", "repaired_parallel", "repaired_sign",
        "repaired_unassigned", "repaired_leaning", "ill_conditioned", "sorted_instead", "summed_instead", "normals_not_unit")]


class Output(Struct):
    _fields_ = [("struct_bytes", c_size_t), ("tangents", float_p), ("bitangents", float_p), ("magnitudes", float_p),
                ("corner_faults", uint8_p)]


class SplitOutput(Struct):
    _fields_ = [("struct_bytes", c_size_t), ("indices", uint32_p), ("sources", uint32_p),
                ("source_capacity", c_size_t), ("source_count", c_size_t), ("vertex_tangents", float_p)]


def load() -> ctypes.CDLL:
    """The library beside this file, where a wheel has it, or else the system's."""
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "libnmtan.so.0")
    library = ctypes.CDLL(own if os.path.exists(own) else "libnmtan.so.0")
    signatures: Dict[str, Tuple[Any, List[Any]]] = {
        "nmtan_tangents": (c_int, [POINTER(Mesh), POINTER(Options), POINTER(Output), POINTER(Counts)]),
        "nmtan_split": (c_int, [POINTER(Mesh), float_p, POINTER(Options), POINTER(SplitOutput)]),
        "nmtan_vertex_tangents": (c_int, [POINTER(Mesh), POINTER(Options), POINTER(SplitOutput), POINTER(Counts)]),
        "nmtan_status_text": (c_char_p, [c_int]),
        "nmtan_version": (c_char_p, []),
    }
    for name, (result, arguments) in signatures.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library

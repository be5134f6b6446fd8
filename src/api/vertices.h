/* SPDX-License-Identifier: MIT */
/*
 * From the tangents of corners to those of vertices: see vertices.c.
 */
#ifndef NT_API_VERTICES_H
#define NT_API_VERTICES_H

#include "tangent/solve.h"
#include "topology/split.h"

/* From a method's result, which may be sparse: checks or repairs it, and splits. Returns what
 * nmtan_vertex_tangents() does. */
nmtan_status nt_repair_and_split(const nt_solve *solve, nmtan_counts *counts, nt_splitter *splitter);

#endif

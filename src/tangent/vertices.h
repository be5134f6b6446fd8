/* SPDX-License-Identifier: MIT */
/*
 * Solve, repair and split in one: what nmtan_vertex_tangents() stands on.
 */
#ifndef NT_TANGENT_VERTICES_H
#define NT_TANGENT_VERTICES_H

#include "tangent/solve.h"
#include "topology/split.h"

/* What the tool asks beyond nmtan.h. */
typedef struct nt_vertex_request {
	bool lazy_indices; /* with source_count 0 output->indices is not written: they are the mesh's own */
	void (*passed)(void *user, nt_mesh_part part); /* see nt_solve */
	void *user;
} nt_vertex_request;

/* nmtan_vertex_tangents() with a request. */
nmtan_status nt_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_vertex_request *request, nmtan_split_output *output, nmtan_counts *counts);

/* From a method's result, which may be sparse, to vertices: judges or repairs it, and splits. Returns what
 * nmtan_vertex_tangents() does. */
nmtan_status nt_repair_and_split(const nt_solve *solve, bool repair, nmtan_counts *counts, nt_splitter *splitter);

/* Takes the tangents of all corners of triangles from solve->vouched, which has ids, and from solve->tangents where
 * a triangle is suspect. Returns NMTAN_OK, NMTAN_ERROR_MEMORY or NMTAN_ERROR_TOO_LARGE. */
nmtan_status nt_split_shared(const nt_solve *solve, nt_splitter *splitter);

#endif

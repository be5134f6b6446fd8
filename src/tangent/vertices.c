/* SPDX-License-Identifier: MIT */
/*
 * Tangents of vertices: solve, repair and split in one, without a row for every corner.
 *
 * Nearly every corner's tangent is the record of its welded vertex (fast.h), so the split reads it
 * there; only the corners of suspect triangles have a row of their own. Where something has to be repaired,
 * and for meshes with quads, all rows are written and the ordinary functions do the work.
 */
#include "tangent/vertices.h"

#include "base/clock.h"
#include "tangent/fast.h"
#include "tangent/judge.h"
#include "tangent/repair.h"
#include "topology/corners.h"

/* The tangent of corner i of the triangles. */
static const float *corner_tangent(const nt_fast *fast, size_t t, size_t i)
{
	const uint8_t flags = fast->flags[t];
	if (!fast->sparse || (flags & NT_TRIANGLE_SUSPECT))
		return fast->solve->tangents + 4 * i;
	/* x, y, z, and as state the sign */
	return &fast->records[flags & NT_TRIANGLE_ORIENT][fast->ids[i]].x;
}

static nmtan_status split_triangles(const nt_fast *fast, nt_splitter *splitter)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	const double begin = nt_seconds();
	for (size_t t = 0; t < fast->triangle_count; t++) {
		for (size_t i = 3 * t; i < 3 * t + 3; i++) {
			const nmtan_status status = nt_splitter_take(splitter,
				(uint32_t)nt_vertex_of(mesh, i), corner_tangent(fast, t, i), i);
			if (status)
				return status;
		}
	}
	if (fast->solve->timing)
		fast->solve->timing->split += nt_seconds() - begin;
	return NMTAN_OK;
}

nmtan_status nt_split_rows(const nt_solve *solve, nt_splitter *splitter)
{
	const double begin = nt_seconds();
	for (size_t c = 0; c < solve->corner_count; c++) {
		const nmtan_status status = nt_splitter_take(splitter,
			(uint32_t)nt_vertex_of(solve->mesh, c), solve->tangents + 4 * c, c);
		if (status)
			return status;
	}
	if (solve->timing)
		solve->timing->split += nt_seconds() - begin;
	return NMTAN_OK;
}

nmtan_status nt_mikktspace_vertices(const nt_solve *solve, bool repair, nmtan_counts *counts,
	nt_splitter *splitter)
{
	nt_fast fast;
	nmtan_status status = nt_fast_solve(&fast, solve, !solve->mesh->face_sizes && solve->vouched);
	if (status == NMTAN_ERROR_TOO_LARGE)
		status = nt_mikktspace_scalar(solve);
	else if (!status && fast.sparse) {
		status = nt_judge(solve, counts);
		if (!status && (!repair || nt_fault_count(counts) == 0)) {
			nt_forget_faults(counts);
			return split_triangles(&fast, splitter);
		}
		nt_fast_write_rest(&fast);
	}
	if (!status)
		status = nt_repair(solve, repair, counts);
	return status ? status : nt_split_rows(solve, splitter);
}

/* SPDX-License-Identifier: MIT */
/*
 * Tangents of vertices: solve, repair and split in one, without a row for every corner.
 *
 * Nearly every corner's tangent is the record of its welded vertex (fast.h), so the split reads it there:
 * vertex_split.c. Where something has to be repaired, and for meshes with quads, all rows are written and the
 * ordinary functions do the work.
 */
#include "tangent/vertices.h"

#include "base/clock.h"
#include "tangent/fast.h"
#include "tangent/judge.h"
#include "tangent/repair.h"
#include "topology/corners.h"

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
			return nt_split_records(&fast, splitter);
		}
		nt_fast_write_rest(&fast);
	}
	if (!status)
		status = nt_repair(solve, repair, counts);
	return status ? status : nt_split_rows(solve, splitter);
}

/* SPDX-License-Identifier: MIT */
/*
 * Tangents of vertices: solve, repair and split in one, without a row for every corner.
 *
 * Nearly every corner's tangent is that of its welded vertex (nt_vouched.ids), so the split reads it there:
 * vertex_split.c. Where something has to be repaired, and for meshes with quads, all rows are written and the
 * ordinary functions do the work.
 */
#include "tangent/vertices.h"

#include "base/clock.h"
#include "tangent/judge.h"
#include "tangent/repair.h"
#include "tangent/vertex_split.h"
#include "topology/corners.h"

/* Writes the rows that a sparse solve left out. */
static void write_shared(const nt_solve *solve)
{
	const nt_vouched *v = solve->vouched;
	for (size_t t = 0; t < solve->mesh->face_count; t++) {
		const float *shared = v->rows[(v->flags[t] & v->positive) != 0];
		for (size_t i = 3 * t; !(v->flags[t] & v->suspect) && i < 3 * t + 3; i++)
			memcpy(solve->tangents + 4 * i, shared + v->row_step * v->ids[i], 4 * sizeof(float));
	}
}

static nmtan_status split_rows(const nt_solve *solve, nt_splitter *splitter)
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

nmtan_status nt_repair_and_split(const nt_solve *solve, bool repair, nmtan_counts *counts, nt_splitter *splitter)
{
	nmtan_status status = NMTAN_OK;
	if (solve->vouched && solve->vouched->ids) {
		status = nt_judge(solve, counts);
		if (!status && (!repair || nt_fault_count(counts) == 0)) {
			nt_forget_faults(counts);
			if (solve->passed)
				solve->passed(solve->user, NT_PART_INDICES);
			return nt_split_shared(solve, splitter);
		}
		write_shared(solve);
	}
	if (!status)
		status = nt_repair(solve, repair, counts);
	return status ? status : split_rows(solve, splitter);
}

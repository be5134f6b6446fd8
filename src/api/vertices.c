/* SPDX-License-Identifier: MIT */
/*
 * Tangents of vertices: solve, repair and split in one, without a row for every corner.
 *
 * Nearly every corner's tangent is that of its welded vertex (nt_known.ids), so the split reads it there:
 * vertex_split.c. For meshes with quads all rows are written and split one after the other.
 */
#include "api/vertices.h"

#include "api/vertex_split.h"
#include "base/clock.h"
#include "tangent/repair.h"
#include "topology/corners.h"

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

nmtan_status nt_repair_and_split(const nt_solve *solve, nmtan_counts *counts, nt_splitter *splitter)
{
	const nmtan_status status = nt_repair(solve, counts);
	if (status)
		return status;
	if (!solve->known || !solve->known->ids)
		return split_rows(solve, splitter);
	if (solve->passed)
		solve->passed(solve->user, NT_PART_INDICES);
	return nt_split_shared(solve, splitter);
}

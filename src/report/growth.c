/* SPDX-License-Identifier: MIT */
/*
 * Vertices that mirrored and unmirrored triangles share, and the copies that splitting made, by cause:
 * a copy whose w differs from its source's stands on the other side of a mirror, any other one has
 * another direction.
 */
#include "report/check.h"

#include <math.h>
#include <string.h>
#include "report/maker/quads.h"

enum { UNMIRRORED = 1, MIRRORED = 2 };

static nt_status check_shared(nt_check *check)
{
	const nt_surface *s = &check->surface;
	const size_t vertex_count = check->mesh->vertex_count;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	uint8_t *sides = nt_scratch_alloc(check->scratch, vertex_count, 1);
	if (!sides)
		return NT_ERROR_MEMORY;
	memset(sides, 0, vertex_count);
	for (size_t t = 0; t < s->triangle_count; t++) {
		/* both halves of a folded quad may have the quad's tangents */
		const int folded = nt_quad_orientation(check, t);
		const int sign = folded ? folded : nt_settled_orientation(check, t);
		for (size_t c = 3 * t; c < 3 * t + 3 && sign && sign != NT_FOLDED_EITHER; c++)
			sides[nt_side_vertex(s, c)] |= sign > 0 ? UNMIRRORED : MIRRORED;
	}
	nt_tally shared = {.code = NT_CODE_TAN_MIRROR_SHARED_VERTEX};
	for (size_t v = 0; v < vertex_count; v++)
		if (sides[v] == (UNMIRRORED | MIRRORED))
			nt_tally_vertex(check, &shared, (uint32_t)v, NAN);
	nt_scratch_back(check->scratch, mark);
	/* who makes tangents splits them, too */
	const bool stored = check->stored != NT_STORED_NONE;
	nt_check_report_as(check, &shared, stored && nt_needs_tangents(check) ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO,
		"%s", stored ? "their tangents are wrong on one side" : "");
	return NT_OK;
}

static void check_copies(nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	nt_report_mesh *facts = check->facts;
	facts->added_normals = mesh->vertex_count - (facts->vertices_before - mesh->unused_vertices);
	const float *tangents = mesh->split.vertex_tangents;
	const size_t copies = nt_is_written(check) ? mesh->split.source_count : 0;
	for (size_t i = 0; i < copies; i++) {
		const size_t source = mesh->split.sources[i];
		const bool mirror = tangents &&
			tangents[4 * source + 3] != tangents[4 * (mesh->vertex_count + i) + 3];
		*(mirror ? &facts->added_mirror : &facts->added_direction) += 1;
	}
	facts->vertices_after = mesh->unused_vertices + mesh->vertex_count + copies;
}

nt_status nt_check_growth(nt_check *check)
{
	/* what is split is counted by check_copies() */
	const bool split = nt_is_written(check) && check->mesh->split.vertex_tangents;
	const bool both = check->facts->triangles[0] && check->facts->triangles[2];
	const nt_status status = both && !split ? check_shared(check) : NT_OK;
	if (!status)
		check_copies(check);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * Groups that are their sums. Where step 5 has found no more than that a vertex has several groups, and all directions
 * of an orientation within a half-space, no group splits: u alone is wanted, nothing is extreme, and a group's sum over
 * its corners is its result. So corners are solved by the arithmetic of step 4, some of several vertices at a time, and
 * added to their groups one after the other; results are made and judged as those of records are, in lanes.
 */
#include "tangent/fast/complex_sums.h"

#include <string.h>
#include "topology/corners.h"

void nt_take_sums(const nt_complex *c, nt_summed *s, size_t v, const bool done[2])
{
	const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
	if (s->count + (end - begin) > NT_SUMMED)
		nt_write_sums(c, s);
	uint8_t number[NT_FAN_DEPTH]; /* of groups, by the corners that they begin with */
	for (uint32_t i = begin; i < end; i++) {
		number[i - begin] = (uint8_t)s->group_count;
		s->group_count += c->group[i] == i && !done[(c->corners[i] & NT_COMPLEX_PLUS) != 0];
	}
	for (uint32_t i = begin; i < end; i++) {
		const uint32_t corner = c->corners[i], group = c->group[i];
		if (group == NT_NONE)
			continue;
		NT_PREFETCH(c->fast->solve->tangents + 4 * nt_complex_corner(c, corner), 1);
		s->corners[s->count] = corner;
		s->group[s->count] = number[group - begin];
		s->count += !done[(corner & NT_COMPLEX_PLUS) != 0];
	}
}

void nt_load_rows(const nt_complex *c, const uint32_t *corners, size_t count, nt_weld_row *rows)
{
	/* copies, which no store to a row may change */
	const nmtan_mesh mesh = *c->fast->solve->mesh;
	const nt_triangles triangles = c->fast->triangles;
	for (size_t i = 0; i < count; i++) {
		const size_t t = (corners[i] & NT_COMPLEX_CORNER) >> 2;
		NT_UNROLL(3)
		for (unsigned k = 0; k < 3; k++)
			nt_weld_load(&mesh, nt_vertex_of(&mesh, nt_triangle_corner(&triangles, t, k)),
				&rows[3 * i + k]);
	}
}

void nt_write_sums(const nt_complex *c, nt_summed *s)
{
	nt_weld_row rows[3 * NT_SUMMED];
	nt_record add[NT_SUMMED], sums[NT_SUMMED];
	uint32_t vertices[NT_SUMMED];
	uint32_t signs[NT_SUMMED];
	nt_load_rows(c, s->corners, s->count, rows);
	c->kernels->corner_sums(rows, s->corners, s->count, add);
	/* lanes behind the last group, too */
	for (size_t g = 0; g < (s->group_count + NT_LANES - 1) / NT_LANES * NT_LANES; g++)
		sums[g] = (nt_record){0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
	for (uint32_t i = 0; i < s->count; i++) {
		const uint32_t corner = s->corners[i], group = s->group[i];
		nt_int4 sum;
		memcpy(&sum, &add[i], sizeof sum);
		if (!(corner & NT_COMPLEX_ANY))
			nt_record_add(&sums[group], sum);
		vertices[group] = 3 * i + (corner & 3);
		signs[group] = corner & NT_COMPLEX_PLUS ? 0 : NT_RESULT_PLUS ^ NT_RESULT_MINUS;
	}
	c->kernels->group_results(rows, vertices, s->group_count, sums);
	const bool judges = nt_fast_judges(c->fast->solve);
	for (size_t g = 0; g < s->group_count; g++) {
		if (judges && (sums[g].state & NT_RESULT_UNUSABLE))
			nt_fast_tell_open(c->fast->solve);
		sums[g].state = (sums[g].state & (judges ? ~0u : ~NT_RESULT_UNUSABLE)) | signs[g];
	}
	for (size_t i = 0; i < s->count; i++)
		memcpy(c->fast->solve->tangents + 4 * nt_complex_corner(c, s->corners[i]), &sums[s->group[i]],
			sizeof *sums);
	s->count = s->group_count = 0;
}

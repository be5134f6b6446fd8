/* SPDX-License-Identifier: MIT */
/*
 * Triangles that the lanes of kernel.h leave to the definition in frames.c: triangles whose values are not finite or
 * whose vertices have no normal, differences that are no doubles and cancel, signs that are in doubt. All triangles
 * go this way where the caller asks for the scalar path. And the second look at sums that are ill-conditioned, which
 * few are.
 */
#include "tangent/sums/parts.h"

#include <string.h>
#include "topology/corners.h"

/* The sums that a triangle adds to its corners: parts[k] to corners[k]. */
static void NT_NOINLINE find_parts(const nt_sums *s, size_t t, uint32_t corners[3], nt_frame_sum parts[3])
{
	const nmtan_mesh *mesh = s->solve->mesh;
	nt_frame_sum *const to[3] = {&parts[0], &parts[1], &parts[2]};
	nt_dvec3 normals[3];
	memset(parts, 0, 3 * sizeof *parts);
	for (size_t k = 0; k < 3; k++) {
		corners[k] = (uint32_t)nt_sums_corner(s, 3 * t + k);
		normals[k] = nt_unit_normal(mesh, nt_vertex_of(mesh, corners[k]));
	}
	nt_add_triangle(mesh, s->weight, corners, normals, to);
}

void nt_sums_do_hard(const nt_sums *s, size_t t, int lane, nt_sum_block *block)
{
	const nmtan_mesh *mesh = s->solve->mesh;
	nt_frame_sum parts[3];
	uint32_t corners[3];
	find_parts(s, t, corners, parts);
	for (int k = 0; k < 3; k++) {
		block->add[k][0][lane] = parts[k].u.x;
		block->add[k][1][lane] = parts[k].u.y;
		block->add[k][2][lane] = parts[k].u.z;
		block->add[k][3][lane] = parts[k].sensitivity;
	}
	block->sign[lane] = nt_triangle_orientation(mesh, corners, false);
	block->plain[lane] = 0;
	block->certain[lane] = !nt_has_stored(mesh);
}

/* Whether the sum at a vertex is ill-conditioned, and is not lost. */
static bool is_ill(const nt_sums *s, uint32_t id, int side)
{
	const unsigned mask = NT_VERTEX_MET | NT_VERTEX_LOST | NT_VERTEX_ILL;
	return (s->vertex_flags[id] >> side & mask) == (NT_VERTEX_MET | NT_VERTEX_ILL);
}

/* Takes out of the sensitivity of a sum what a triangle's corner k added to it and cannot move its direction: an error
 * of the angle moves it by the part across it, which a lone triangle has not. */
static void ease(const nt_sums *s, size_t t, size_t k, nt_vertex_sum *sum)
{
	nt_frame_sum parts[3];
	uint32_t corners[3];
	find_parts(s, t, corners, parts);
	const nt_dvec3 u = parts[k].u, direction = {sum->x, sum->y, sum->z};
	const double lengths = nt_dvec3_length(u) * nt_dvec3_length(direction);
	if (lengths > 0.0)
		sum->sensitivity -= (1.0 - nt_dvec3_length(nt_dvec3_cross(u, direction)) / lengths) * parts[k].stretch;
}

void nt_sums_judge_ill(const nt_sums *s)
{
	for (size_t i = 0; i < 3 * s->triangle_count; i++) {
		const int side = s->flags[i / 3] & NT_SUM_POSITIVE;
		if (!(s->flags[i / 3] & NT_SUM_NONE) && is_ill(s, nt_sums_vertex(s, i), side))
			ease(s, i / 3, i % 3, &s->sums[side][nt_sums_vertex(s, i)]);
	}
	for (uint32_t id = 0; id < s->weld.count; id++)
		for (int side = 0; side < 2; side++) {
			if (!is_ill(s, id, side))
				continue;
			const nt_vertex_sum sum = s->sums[side][id];
			if (sum.sensitivity <= NT_WELL_CONDITIONED * nt_dvec3_length((nt_dvec3){sum.x, sum.y, sum.z}))
				s->vertex_flags[id] &= (uint8_t)~(NT_VERTEX_ILL << side);
		}
}

void nt_sums_orient(const nt_sums *s, size_t t)
{
	const unsigned count = t + 1 < s->triangle_count && nt_is_cut_between(&s->triangles, t) ? 2 : 1;
	uint32_t cut[2][3];
	for (size_t i = 0; i < 3 * count; i++)
		cut[i / 3][i % 3] = (uint32_t)nt_sums_corner(s, 3 * t + i);
	const int sign = nt_cut_orientation(s->solve->mesh, cut, count, true, NULL);
	for (unsigned i = 0; i < count; i++)
		s->flags[t + i] = (uint8_t)((s->flags[t + i] & NT_SUM_SECOND) | NT_SUM_SUSPECT |
			(sign > 0 ? NT_SUM_POSITIVE : 0) | (sign == 0 ? NT_SUM_NONE : 0));
}

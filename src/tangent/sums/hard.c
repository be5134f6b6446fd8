/* SPDX-License-Identifier: MIT */
/*
 * What the lanes of kernel.h leave to the definition in frames.c: triangles whose values are not finite or whose
 * vertices have no normal, differences that are no doubles and cancel, signs that are in doubt. All triangles go this
 * way where the caller asks for the scalar path.
 */
#include "tangent/sums/parts.h"

#include "topology/corners.h"

void nt_sums_do_hard(const nt_sums *s, size_t t, int lane, nt_sum_block *block)
{
	const nmtan_mesh *mesh = s->solve->mesh;
	nt_frame_sum parts[3] = {{.weights = 0}, {.weights = 0}, {.weights = 0}};
	nt_frame_sum *const to[3] = {&parts[0], &parts[1], &parts[2]};
	uint32_t corners[3];
	nt_dvec3 normals[3];
	for (size_t k = 0; k < 3; k++) {
		corners[k] = (uint32_t)nt_sums_corner(s, 3 * t + k);
		normals[k] = nt_unit_normal(mesh, nt_vertex_of(mesh, corners[k]));
	}
	nt_add_triangle(mesh, s->weight, corners, normals, to);
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

void nt_sums_orient(const nt_sums *s, size_t t)
{
	const unsigned count = t + 1 < s->triangle_count && s->corners && (s->flags[t + 1] & NT_SUM_SECOND) ? 2 : 1;
	uint32_t cut[2][3];
	for (size_t i = 0; i < 3 * count; i++)
		cut[i / 3][i % 3] = (uint32_t)nt_sums_corner(s, 3 * t + i);
	const int sign = nt_cut_orientation(s->solve->mesh, cut, count, true, NULL);
	for (unsigned i = 0; i < count; i++)
		s->flags[t + i] = (uint8_t)((s->flags[t + i] & NT_SUM_SECOND) | NT_SUM_SUSPECT |
			(sign > 0 ? NT_SUM_POSITIVE : 0) | (sign == 0 ? NT_SUM_NONE : 0));
}

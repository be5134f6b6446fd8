/* SPDX-License-Identifier: MIT */
/*
 * Sums of frames, and the two methods that are nothing else. See frames.h.
 *
 * `area` weighs corner angle times the two edge lengths, so that a thin bevel, which has large angles
 * but little area, does not tilt the flat faces beside it. `lengyel` adds dP/du as the 2x2 system gives
 * it (E. Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001), which weighs a
 * triangle by the inverse of its texture density. Both keep mirrored triangles apart, so that w is the
 * sign of the determinant.
 */
#include "tangent/frames.h"

#include <string.h>
#include "base/angle.h"
#include "topology/corners.h"

/* Below this share of the summed lengths a sum's direction is rounding noise: 2^-53 per addition and
 * term, with room for a million terms. */
static const double CANCELLED = 1e-10;

nt_dvec3 nt_unit_normal(const nmtan_mesh *mesh, size_t vertex)
{
	nt_dvec3 n = nt_dvec3_load(nt_normal(mesh, vertex));
	return nt_dvec3_normalise(&n) ? n : (nt_dvec3){0, 0, 0};
}

int nt_triangle_orientation(const nmtan_mesh *mesh, const uint32_t corners[3], bool stored)
{
	const float *t[3];
	for (int k = 0; k < 3; k++) {
		const size_t vertex = nt_vertex_of(mesh, corners[k]);
		t[k] = stored ? nt_stored_texcoord(mesh, vertex) : nt_texcoord(mesh, vertex);
	}
	return nt_orientation(t[0], t[1], t[2]);
}

/* The sign of a quad whose halves have the given, different, non-zero signs. */
static int larger_half(const nmtan_mesh *mesh, uint32_t corners[2][3], bool stored, const int signs[2])
{
	const float *t[6];
	for (int i = 0; i < 6; i++) {
		const size_t vertex = nt_vertex_of(mesh, corners[i / 3][i % 3]);
		t[i] = stored ? nt_stored_texcoord(mesh, vertex) : nt_texcoord(mesh, vertex);
	}
	return nt_compare_area(t[0], t[1], t[2], t[3], t[4], t[5]) >= 0 ? signs[0] : signs[1];
}

int nt_face_orientation(const nmtan_mesh *mesh, size_t face, size_t first, bool stored, bool *folded)
{
	uint32_t corners[2][3];
	const unsigned count = nt_face_triangles(mesh, face, first, corners);
	int signs[2] = {nt_triangle_orientation(mesh, corners[0], stored), 0};
	int sign = signs[0];
	bool differ = false;
	if (count == 2) {
		signs[1] = nt_triangle_orientation(mesh, corners[1], stored);
		differ = signs[0] * signs[1] < 0;
		sign = differ ? larger_half(mesh, corners, stored, signs) : signs[0] ? signs[0] : signs[1];
	}
	if (folded)
		*folded = differ;
	return sign || !stored || !mesh->stored_texcoords
		? sign : nt_face_orientation(mesh, face, first, false, NULL);
}

/* dP/du times the determinant's sign and magnitude; false where the determinant is zero or a value is
 * not finite. */
static bool solve_u(const nmtan_mesh *mesh, const uint32_t corners[3], nt_dvec3 *u, double *determinant)
{
	const size_t a = nt_vertex_of(mesh, corners[0]), b = nt_vertex_of(mesh, corners[1]),
		     c = nt_vertex_of(mesh, corners[2]);
	const float *ta = nt_texcoord(mesh, a), *tb = nt_texcoord(mesh, b), *tc = nt_texcoord(mesh, c);
	const int sign = nt_orientation(ta, tb, tc);
	const double bv = (double)tb[1] - ta[1], cv = (double)tc[1] - ta[1];
	const double bu = (double)tb[0] - ta[0], cu = (double)tc[0] - ta[0];
	const nt_dvec3 pa = nt_dvec3_load(nt_position(mesh, a));
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(nt_position(mesh, b)), pa);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(nt_position(mesh, c)), pa);
	*u = nt_dvec3_scale(sign, nt_dvec3_sub(nt_dvec3_scale(cv, d1), nt_dvec3_scale(bv, d2)));
	*determinant = fabs(bu * cv - bv * cu);
	return sign != 0 && isfinite(u->x + u->y + u->z);
}

/* Adds a triangle's direction u (unit but for NT_WEIGHT_NONE) at its corner k. */
static void add_corner(const nmtan_mesh *mesh, nt_weight weight, const uint32_t corners[3], int k,
	nt_dvec3 u, nt_frame_sum *sum)
{
	const size_t vertex = nt_vertex_of(mesh, corners[k]);
	const nt_dvec3 n = nt_unit_normal(mesh, vertex);
	nt_dvec3 direction = nt_dvec3_reject(n, u);
	double factor = 1.0;
	if (weight != NT_WEIGHT_NONE) {
		const nt_dvec3 p = nt_dvec3_load(nt_position(mesh, vertex));
		const size_t previous = nt_vertex_of(mesh, corners[(k + 2) % 3]);
		const size_t next = nt_vertex_of(mesh, corners[(k + 1) % 3]);
		const nt_dvec3 e1 = nt_dvec3_sub(nt_dvec3_load(nt_position(mesh, previous)), p);
		const nt_dvec3 e2 = nt_dvec3_sub(nt_dvec3_load(nt_position(mesh, next)), p);
		const nt_dvec3 f1 = nt_dvec3_reject(n, e1), f2 = nt_dvec3_reject(n, e2);
		const nt_dvec3 normal_part = nt_dvec3_cross(f1, f2);
		factor = nt_angle(sqrt(nt_dvec3_dot(normal_part, normal_part)), nt_dvec3_dot(f1, f2));
		if (weight == NT_WEIGHT_AREA)
			factor *= sqrt(nt_dvec3_dot(e1, e1)) * sqrt(nt_dvec3_dot(e2, e2));
		if (!nt_dvec3_normalise(&direction))
			return;
	}
	sum->u = nt_dvec3_add(sum->u, nt_dvec3_scale(factor, direction));
	sum->weights += factor * sqrt(nt_dvec3_dot(direction, direction));
}

void nt_sum_frames(const nmtan_mesh *mesh, nt_weight weight, const uint32_t *ids,
	nt_frame_sum (*sums)[2])
{
	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; first += nt_face_size(mesh, face++)) {
		const unsigned size = nt_face_size(mesh, face);
		bool wanted = false;
		for (size_t k = 0; k < size; k++)
			wanted = wanted || ids[first + k] != NT_NO_ID;
		if (!wanted)
			continue;
		const int orientation = nt_face_orientation(mesh, face, first, true, NULL);
		uint32_t corners[2][3];
		const unsigned count = nt_face_triangles(mesh, face, first, corners);
		for (unsigned i = 0; i < count; i++) {
			nt_dvec3 u;
			double determinant;
			if (!solve_u(mesh, corners[i], &u, &determinant))
				continue;
			if (weight == NT_WEIGHT_NONE)
				u = nt_dvec3_scale(1.0 / determinant, u);
			else if (!nt_dvec3_normalise(&u))
				continue;
			for (int k = 0; k < 3; k++)
				if (ids[corners[i][k]] != NT_NO_ID)
					add_corner(mesh, weight, corners[i], k, u,
						&sums[ids[corners[i][k]]][orientation > 0]);
		}
	}
}

bool nt_sum_tangent(const nt_frame_sum *sum, nt_dvec3 n, nt_dvec3 *tangent)
{
	const double length = sqrt(nt_dvec3_dot(sum->u, sum->u));
	if (!(length > CANCELLED * sum->weights))
		return false;
	*tangent = nt_dvec3_reject(n, sum->u);
	return nt_dvec3_normalise(tangent);
}

/* Writes a corner's result; zero where the sum has no direction, for repair to fill. */
static void write_corner(const nt_solve *solve, size_t corner, const nt_frame_sum *sum, float w)
{
	const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, corner));
	nt_dvec3 t = {0, 0, 0};
	if (!nt_sum_tangent(sum, n, &t))
		t = (nt_dvec3){0, 0, 0};
	const nt_dvec3 b = nt_dvec3_scale(w, nt_dvec3_cross(n, t));
	const float tangent[4] = {(float)t.x, (float)t.y, (float)t.z, w};
	memcpy(solve->tangents + 4 * corner, tangent, sizeof tangent);
	if (solve->bitangents) {
		const float bitangent[3] = {(float)b.x, (float)b.y, (float)b.z};
		memcpy(solve->bitangents + 3 * corner, bitangent, sizeof bitangent);
	}
	if (solve->magnitudes)
		solve->magnitudes[2 * corner] = solve->magnitudes[2 * corner + 1] = 1.0f;
}

/* Welds, sums, writes. A face without orientation takes the orientation that has a sum at its corners. */
static nmtan_status solve_by_sums(const nt_solve *solve, nt_weight weight)
{
	const nmtan_mesh *mesh = solve->mesh;
	uint32_t *ids = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *ids);
	if (!ids)
		return NMTAN_ERROR_MEMORY;
	size_t id_count;
	const nmtan_status status = nt_weld_corners(mesh, solve->corner_count, solve->scratch, ids,
		&id_count);
	if (status)
		return status;
	nt_frame_sum (*sums)[2] = nt_scratch_alloc(solve->scratch, id_count, sizeof *sums);
	if (!sums)
		return NMTAN_ERROR_MEMORY;
	memset(sums, 0, id_count * sizeof *sums);
	nt_sum_frames(mesh, weight, ids, sums);

	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		const unsigned size = nt_face_size(mesh, face);
		const int orientation = nt_face_orientation(mesh, face, first, true, NULL);
		for (size_t c = first; c < first + size; c++) {
			const int side = orientation ? orientation > 0 : sums[ids[c]][1].weights > 0.0;
			write_corner(solve, c, &sums[ids[c]][side], side ? 1.0f : -1.0f);
		}
		first += size;
	}
	return NMTAN_OK;
}

nmtan_status nt_area(const nt_solve *solve)
{
	return solve_by_sums(solve, NT_WEIGHT_AREA);
}

nmtan_status nt_lengyel(const nt_solve *solve)
{
	return solve_by_sums(solve, NT_WEIGHT_NONE);
}

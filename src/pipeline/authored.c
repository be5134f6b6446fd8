/* SPDX-License-Identifier: MIT */
/*
 * Authored tangents with --existing=repair: which of them stay, and what becomes of the others.
 *
 * With texture coordinates there is a fresh solve, and faces go one by one: either all corners of a face keep their
 * tangents or all get the new ones, because they are interpolated with each other.
 *
 * Without them nothing says where a tangent should point but the tangent itself. Each corner goes by itself: what is
 * valid keeps its bytes, what is not becomes the nearest unit vector across its normal. w stays where the corners of a
 * face agree on a sign, and is 1 where they do not. When a morph target turns the normal, the tangent turns with it.
 */
#include "pipeline/stages.h"

#include <math.h>
#include <string.h>
#include "base/dvec.h"
#include "gltf/morph_deltas.h"
#include "report/quads.h"
#include "topology/corners.h"

static size_t vertex_of(const nt_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : corner;
}

static size_t face_size(const nt_mesh *mesh, size_t face)
{
	return mesh->face_sizes ? mesh->face_sizes[face] : 3;
}

/* Finite, of unit length (to the Khronos validator's tolerance), off perpendicular by no more than a degree, as
 * --check has it: half a degree comes from rounding to 8 bits. n may be NULL. */
static bool is_valid(const float *t, const float *n)
{
	static const double sine = 0.017452406437283512;
	const nt_dvec3 tangent = nt_dvec3_load(t),
		       normal = n ? nt_dvec3_load(n) : (nt_dvec3){0, 0, 0};
	const double length = nt_dvec3_length(tangent);
	return fabs(length - 1.0) <= 0.00674 &&
	       !(fabs(nt_dvec3_dot(tangent, normal)) > sine * length * nt_dvec3_length(normal));
}

/* The sign that all corners of a face have for w; 0: they differ, or have none. */
static float common_sign(const nt_mesh *mesh, size_t first, size_t size)
{
	const float w = mesh->tangents[4 * vertex_of(mesh, first) + 3];
	for (size_t k = 1; k < size; k++)
		if (mesh->tangents[4 * vertex_of(mesh, first + k) + 3] != w)
			return 0.0f;
	return w == 1.0f || w == -1.0f ? w : 0.0f;
}

/* Whether the authored tangents can stay on a face: all valid, with one w, and that of the exact orientation of every
 * triangle that it is written as. */
static bool face_is_valid(const nt_mesh *mesh, const nmtan_mesh *view, size_t face, size_t first)
{
	const size_t size = face_size(mesh, face);
	const float w = common_sign(mesh, first, size);
	for (size_t k = 0; k < size; k++) {
		const size_t vertex = vertex_of(mesh, first + k);
		if (!is_valid(mesh->tangents + 4 * vertex, mesh->normals ? mesh->normals + 3 * vertex : NULL))
			return false;
	}
	uint32_t corners[2][3];
	const unsigned count = nt_written_triangles(view, face, first, corners);
	for (unsigned i = 0; i < count; i++) {
		const int sign = (mesh->solve_texcoords ? mesh->solve_sign : 1) *
				 nmtan_orientation(mesh->texcoords + 2 * vertex_of(mesh, corners[i][0]),
					 mesh->texcoords + 2 * vertex_of(mesh, corners[i][1]),
					 mesh->texcoords + 2 * vertex_of(mesh, corners[i][2]));
		/* half of a folded quad may have the quad's */
		if (sign != 0 && w != (float)sign && w != (float)nt_folded_orientation(mesh, mesh->halves, first / 3))
			return false;
	}
	return w != 0.0f;
}

/* A target that does not turn a tangent that was solved does not turn the authored one either. */
static void keep_unturned(const nt_mesh *mesh, size_t corner, const float *solved, const float *authored)
{
	for (size_t m = 0; m < mesh->morph_count; m++) {
		float *moved = mesh->morphs[m].corner_tangents ? mesh->morphs[m].corner_tangents + 4 * corner : NULL;
		if (moved && fabsf(moved[0] - solved[0]) <= NT_MORPH_LEAST &&
			fabsf(moved[1] - solved[1]) <= NT_MORPH_LEAST && fabsf(moved[2] - solved[2]) <= NT_MORPH_LEAST)
			memcpy(moved, authored, 3 * sizeof *moved);
	}
}

void nt_restore_authored(nt_mesh *mesh, float *corner_tangents)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	mesh->replaced_tangents = 0;
	for (size_t face = 0, first = 0; face < mesh->face_count;
		first += face_size(mesh, face++)) {
		const size_t size = face_size(mesh, face);
		const bool valid = face_is_valid(mesh, &view, face, first);
		for (size_t c = first; valid && c < first + size; c++) {
			const float *authored = mesh->tangents + 4 * vertex_of(mesh, c);
			keep_unturned(mesh, c, corner_tangents + 4 * c, authored);
			memcpy(corner_tangents + 4 * c, authored, 4 * sizeof(float));
		}
		mesh->replaced_tangents += valid ? 0 : size;
	}
}

static void store(nt_dvec3 t, float w, float *to)
{
	nt_dvec3_store(t, to);
	to[3] = w;
}

static nt_dvec3 unit_normal(const nmtan_mesh *view, size_t vertex)
{
	nt_dvec3 n = nt_dvec3_load(view->normals + 3 * vertex);
	return nt_dvec3_normalise(&n) ? n : (nt_dvec3){0, 0, 0};
}

/* The unit vector across n that is nearest to t, or any where t has no direction or that of n. */
static nt_dvec3 mend(const float *t, nt_dvec3 n)
{
	static const double least = 1e-3; /* the sine of 0.06 degrees */
	nt_dvec3 unit = nt_dvec3_load(t);
	if (!nt_dvec3_normalise(&unit))
		return nt_dvec3_perpendicular(n);
	nt_dvec3 across = nt_dvec3_reject(n, unit);
	const bool has_direction = nt_dvec3_length(across) > least && nt_dvec3_normalise(&across);
	return has_direction ? across : nt_dvec3_perpendicular(n);
}

void nt_mend_untextured(nt_mesh *mesh, const nmtan_mesh *view, float *tangents)
{
	static const float nothing[4] = {
		0, 0, 0, 0}; /* where other normals were made, there are no tangents left */
	mesh->replaced_tangents = 0;
	for (size_t face = 0, first = 0; face < mesh->face_count;
		first += face_size(mesh, face++)) {
		const size_t size = face_size(mesh, face);
		const float sign = mesh->tangents ? common_sign(mesh, first, size) : 0.0f;
		for (size_t c = first; c < first + size; c++) {
			const size_t vertex = vertex_of(mesh, c);
			const float *t = mesh->tangents ? mesh->tangents + 4 * vertex : nothing;
			float *to = tangents + 4 * c;
			if (is_valid(t, view->normals + 3 * vertex))
				memcpy(to, t, 3 * sizeof *to);
			else
				store(mend(t, unit_normal(view, vertex)), 0.0f, to);
			to[3] = sign != 0.0f ? sign : 1.0f;
			mesh->replaced_tangents += memcmp(to, t, 4 * sizeof *to) != 0;
		}
	}
}

/* t, which lies across the unit vector n, after the shortest turn that takes n to the unit vector m:
 * t - (m . t) / (1 + n . m) (n + m), which is t itself where m = -n. */
static nt_dvec3 turn(nt_dvec3 t, nt_dvec3 n, nt_dvec3 m)
{
	const double along = nt_dvec3_dot(m, t), both = 1.0 + nt_dvec3_dot(n, m);
	return both > 1e-12 ? nt_dvec3_sub(t, nt_dvec3_scale(along / both, nt_dvec3_add(n, m))) : t;
}

void nt_turn_untextured(
	const nt_mesh *mesh, const nmtan_mesh *base, const nmtan_mesh *moved, float *tangents)
{
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const size_t vertex = vertex_of(mesh, c);
		const float *t = mesh->corner_tangents + 4 * c;
		const nt_dvec3 n = unit_normal(base, vertex), m = unit_normal(moved, vertex);
		nt_dvec3 turned = turn(nt_dvec3_load(t), n, m);
		if (base->normals == moved->normals || !nt_dvec3_normalise(&turned))
			memcpy(tangents + 4 * c, t, 4 * sizeof *t);
		else
			store(turned, t[3], tangents + 4 * c);
	}
}

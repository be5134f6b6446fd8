/* SPDX-License-Identifier: MIT */
/*
 * Authored tangents with --existing=repair: which of them stay, and what becomes of the others.
 *
 * With texture coordinates there is a fresh solve, and faces go one by one: either all corners of a face keep their
 * tangents or all get the new ones, because they are interpolated with each other. If nearly all faces of a primitive
 * get new ones, so do others whose T runs against the solve's: reversed, but not beyond what averaging does. If w is to
 * stay inverted, it is read and written the other way.
 *
 * Without them nothing says where a tangent should point but the tangent itself. Each corner goes by itself: what is
 * valid keeps its bytes, what is not becomes the nearest unit vector across its normal. w stays where the corners of a
 * face agree on a sign, and is 1 where they do not. When a morph target turns the normal, the tangent turns with it.
 */
#include "pipeline/stages.h"

#include <math.h>
#include <string.h>
#include "base/vec.h"
#include "report/maker/maker.h"
#include "topology/corners.h"

/* Finite, of unit length (to the Khronos validator's tolerance), off perpendicular by no more than a degree, as
 * --check has it: half a degree comes from rounding to 8 bits. n may be NULL. margin: what storing it may do to a
 * component, so that it is valid then too. */
static bool is_valid(const float *t, const float *n, float margin)
{
	static const double sine = 0.017452406437283512;
	const nt_dvec3 tangent = nt_dvec3_load(t),
		       normal = n ? nt_dvec3_load(n) : (nt_dvec3){0, 0, 0};
	const double length = nt_dvec3_length(tangent);
	return fabs(length - 1.0) <= 0.00674 - (double)margin &&
	       !(fabs(nt_dvec3_dot(tangent, normal)) > (sine - (double)margin) * length * nt_dvec3_length(normal));
}

/* w as it was meant: Draco's grid may not have -1 and 1. */
static float sign_of(const nt_mesh *mesh, float w)
{
	return fabsf(fabsf(w) - 1) <= mesh->tangent_step ? copysignf(1, w) : w;
}

enum { MOST_CORNERS = 4 };

/* The sign that all corners of a face have for w; 0: they differ, or have none. */
static float common_sign(float tangents[][4], size_t size)
{
	const float w = tangents[0][3];
	for (size_t k = 1; k < size; k++)
		if (tangents[k][3] != w)
			return 0.0f;
	return w == 1.0f || w == -1.0f ? w : 0.0f;
}

/* Whether a corner's tangent can be drawn, whatever its neighbours have. */
static bool corner_is_valid(const nt_mesh *mesh, size_t corner, const float *tangent)
{
	const size_t vertex = nt_mesh_vertex(mesh, corner);
	return is_valid(tangent, mesh->normals ? mesh->normals + 3 * vertex : NULL, mesh->tangent_margin) &&
		fabsf(tangent[3]) == 1;
}

/* Whether tangents can stay on a face: all valid, with one w, and that of the exact orientation of every triangle that
 * it is written as, none of them reversed: what --check calls an error does not stay. */
static bool face_is_valid(const nt_mesh *mesh, const nmtan_mesh *view, size_t face, size_t first,
	float tangents[][4])
{
	const size_t size = nt_face_size(view, face);
	const float w = common_sign(tangents, size);
	for (size_t k = 0; k < size; k++)
		if (!corner_is_valid(mesh, first + k, tangents[k]))
			return false;
	uint32_t corners[2][3];
	const unsigned count = nt_written_triangles(view, face, first, corners);
	for (unsigned i = 0; i < count; i++) {
		const size_t v[3] = {nt_mesh_vertex(mesh, corners[i][0]), nt_mesh_vertex(mesh, corners[i][1]),
			nt_mesh_vertex(mesh, corners[i][2])};
		const float *const own[3] = {tangents[corners[i][0] - first], tangents[corners[i][1] - first],
			tangents[corners[i][2] - first]};
		const int sign = nt_uv_sign(mesh, v, 0);
		/* half of a folded quad may have the quad's */
		if (sign != 0 && (w == (float)sign ? nt_runs_backwards(mesh, v, own, sign, false)
						   : !nt_is_folded_sign(mesh, mesh->halves, first / 3, (int)w)))
			return false;
	}
	return w != 0.0f;
}

/* Treatment of a face; IS_OPPOSED: stays, but its T runs against the solve's at all corners. */
typedef enum face_fate { STAYS, IS_OPPOSED, IS_LEFT, IS_REPLACED } face_fate;

/* A face is replaced where that makes it better: not where the solve gives what is there, as far as storing it shows,
 * nor where it gives no valid one either and each corner is usable. A second run finds what the first one made.
 * Gives the authored tangents, and in how many w is not as it was meant. */
static face_fate fate_of(const nt_mesh *mesh, const nmtan_mesh *view, size_t face, size_t first, float solved[][4],
	float authored[][4], size_t *turned)
{
	const size_t size = nt_face_size(view, face);
	bool is_same = true, is_usable = true, is_opposed = true;
	*turned = 0;
	for (size_t k = 0; k < size; k++) {
		memcpy(authored[k], mesh->tangents + 4 * nt_mesh_vertex(mesh, first + k), sizeof authored[k]);
		const float w = sign_of(mesh, authored[k][3]);
		*turned += w != authored[k][3];
		authored[k][3] = mesh->keeps_inverted ? -w : w;
		is_opposed &= nt_dvec3_dot(nt_dvec3_load(authored[k]), nt_dvec3_load(solved[k])) < 0.0;
	}
	if (face_is_valid(mesh, view, face, first, authored))
		return is_opposed ? IS_OPPOSED : STAYS;
	for (size_t k = 0; k < size; k++) {
		for (size_t i = 0; i < 4; i++)
			is_same &= fabsf(authored[k][i] - solved[k][i]) <= (i < 3 ? mesh->tangent_step : 0);
		is_usable &= corner_is_valid(mesh, first + k, authored[k]);
	}
	return is_same || (is_usable && !face_is_valid(mesh, view, face, first, solved)) ? IS_LEFT : IS_REPLACED;
}

void nt_restore_authored(nt_mesh *mesh, float *corner_tangents, float *solved_tangents)
{
	enum { OTHERS_OF = 100 };
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	float (*tangents)[4] = (float (*)[4])corner_tangents, authored[MOST_CORNERS][4];
	size_t turned, replaced = 0, others = 0;
	/* if nearly all are replaced, the opposed go with them; a few faces tell that many stay */
	for (size_t face = 0, first = 0; face < mesh->face_count && others <= mesh->face_count / OTHERS_OF;
		first += nt_face_size(&view, face++))
		*(fate_of(mesh, &view, face, first, tangents + first, authored, &turned) == IS_REPLACED
			? &replaced : &others) += 1;
	mesh->replaced_tangents = mesh->left_tangents = 0;
	for (size_t face = 0, first = 0; face < mesh->face_count; first += nt_face_size(&view, face++)) {
		const size_t size = nt_face_size(&view, face);
		face_fate fate = fate_of(mesh, &view, face, first, tangents + first, authored, &turned);
		if (fate == IS_OPPOSED && others <= replaced / OTHERS_OF)
			fate = IS_REPLACED;
		mesh->replaced_tangents += fate == IS_REPLACED ? size : turned;
		mesh->left_tangents += fate == IS_LEFT ? size : 0;
		for (size_t k = 0; k < size; k++) {
			if (fate != IS_REPLACED)
				memcpy(tangents[first + k], authored[k], sizeof authored[k]);
			if (solved_tangents)
				solved_tangents[4 * (first + k) + 3] = fate == IS_REPLACED;
			tangents[first + k][3] *= mesh->keeps_inverted ? -1.0f : 1.0f;
		}
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
		first += nt_face_size(view, face++)) {
		const size_t size = nt_face_size(view, face);
		float authored[MOST_CORNERS][4] = {{0}};
		for (size_t k = 0; mesh->tangents && k < size; k++)
			memcpy(authored[k], mesh->tangents + 4 * nt_mesh_vertex(mesh, first + k), sizeof authored[k]);
		const float sign = common_sign(authored, size);
		for (size_t c = first; c < first + size; c++) {
			const size_t vertex = nt_mesh_vertex(mesh, c);
			const float *t = mesh->tangents ? mesh->tangents + 4 * vertex : nothing;
			float *to = tangents + 4 * c;
			if (is_valid(t, view->normals + 3 * vertex, mesh->tangent_margin))
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
		const size_t vertex = nt_mesh_vertex(mesh, c);
		const float *t = mesh->corner_tangents + 4 * c;
		const nt_dvec3 n = unit_normal(base, vertex), m = unit_normal(moved, vertex);
		nt_dvec3 turned = turn(nt_dvec3_load(t), n, m);
		if (base->normals == moved->normals || !nt_dvec3_normalise(&turned))
			memcpy(tangents + 4 * c, t, 4 * sizeof *t);
		else
			store(turned, t[3], tangents + 4 * c);
	}
}

/* SPDX-License-Identifier: MIT */
/*
 * Tangents that are there: which of them stay with --existing=repair, and whether w of those that nobody solves is
 * right.
 */
#include "pipeline/stages.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "base/vec.h"
#include "report/maker/maker.h"
#include "report/report.h"
#include "topology/corners.h"

/* ---- those that stay ---- */

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

/* ---- those that nobody solves ---- */

/* Triangles that say; of them those whose w differs, whose w is wrong, and whose T is reversed while w is right. */
enum { JUDGED, DIFFERS, BY_W, REVERSED, KINDS };

typedef struct sign_count {
	const nt_mesh *mesh;
	const nmtan_mesh *view; /* of it, with the texture coordinates as they are stored: w has to fit these */
	const uint8_t *halves;  /* NULL: quads are not asked */
	size_t counts[KINDS];   /* added to by any thread */
} sign_count;

static void count_triangle(const sign_count *c, size_t t, const uint32_t corners[3], size_t counts[KINDS])
{
	const nt_mesh *mesh = c->mesh;
	const size_t v[3] = {nt_mesh_vertex(mesh, corners[0]), nt_mesh_vertex(mesh, corners[1]),
		nt_mesh_vertex(mesh, corners[2])};
	const int sign = nt_w_sign(mesh, v);
	const int orientation = sign ? nt_uv_sign(mesh, v, nt_stored_v_offset(c->view)) : 0;
	if (orientation == 0)
		return;
	counts[JUDGED] += sign != NT_W_MIXED;
	if (orientation == sign)
		counts[REVERSED] += nt_runs_backwards(mesh, v, NULL, orientation, false);
	else if (!nt_is_folded_sign(mesh, c->halves, t, sign))
		counts[sign == NT_W_MIXED ? DIFFERS : BY_W]++;
}

static void count_range(void *context, size_t begin, size_t end, unsigned slot)
{
	sign_count *c = context;
	size_t counts[KINDS] = {0}, first = 3 * begin;
	(void)slot;
	for (size_t face = begin; face < end; first += nt_face_size(c->view, face++)) {
		uint32_t corners[2][3] = {{(uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2}};
		const unsigned count = c->mesh->face_sizes ? nt_written_triangles(c->view, face, first, corners) : 1;
		const size_t wrong = counts[BY_W];
		for (unsigned i = 0; i < count; i++)
			count_triangle(c, face, corners[i], counts);
		if (count == 2 && counts[BY_W] == wrong + 1 && nt_has_sign_of_quad(c->mesh, corners))
			counts[BY_W] = wrong;
	}
	for (int i = 0; i < KINDS; i++)
		__atomic_fetch_add(&c->counts[i], counts[i], __ATOMIC_RELAXED);
}

/* Returns how many have a wrong w. If there are quads, one range has all: no other knows its first corner. */
static size_t count_wrong(sign_count *c, unsigned threads)
{
	const size_t faces = c->mesh->face_count, grain = c->mesh->face_sizes ? faces + 1 : 1 << 16;
	memset(c->counts, 0, sizeof c->counts);
	nt_parallel_ranges(nt_thread_count(threads), faces, grain, count_range, c);
	return c->counts[BY_W] + c->counts[DIFFERS];
}

/* Counts without halves of folded quads that have the quad's sign, if these are what is wrong. */
static void judge(nt_mesh *mesh, float v_offset, nt_arena *arena, unsigned threads)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	sign_count c = {.mesh = mesh, .view = &view}, others = c;
	stored.v_offset = v_offset;
	const size_t wrong = count_wrong(&c, threads);
	uint8_t *halves = wrong && !mesh->face_sizes ? nt_arena_alloc(arena, mesh->face_count, 1) : NULL;
	if (halves)
		nt_pair_quads(mesh, false, halves);
	others.halves = halves;
	if (halves && 2 * count_wrong(&others, threads) <= wrong)
		c = others;
	mesh->kept.wrong = c.counts[BY_W] + c.counts[REVERSED];
	mesh->kept.mixed = c.counts[DIFFERS];
	mesh->kept.judged = c.counts[JUDGED];
}

typedef struct fault_count {
	const nt_mesh *mesh;
	size_t faulty; /* added to by any thread */
} fault_count;

static void count_faulty_range(void *context, size_t begin, size_t end, unsigned slot)
{
	fault_count *c = context;
	size_t faulty = 0;
	(void)slot;
	for (size_t v = begin; v < end; v++)
		faulty += nt_tangent_faults(c->mesh->tangents + 4 * v, c->mesh->normals + 3 * v) != 0;
	__atomic_fetch_add(&c->faulty, faulty, __ATOMIC_RELAXED);
}

/* Tangents that no renderer can use, of vertices that a triangle uses. */
static size_t count_faulty(const nt_mesh *mesh, nt_arena *arena, unsigned threads)
{
	enum { GRAIN = 1 << 16 };
	fault_count c = {.mesh = mesh};
	nt_parallel_ranges(nt_thread_count(threads), mesh->vertex_count, GRAIN, count_faulty_range, &c);
	uint8_t *met = c.faulty && mesh->indices ? nt_arena_alloc(arena, mesh->vertex_count, 1) : NULL;
	if (!met)
		return c.faulty;
	memset(met, 0, mesh->vertex_count);
	c.faulty = 0;
	for (size_t i = 0; i < mesh->corner_count; i++) {
		const size_t v = mesh->indices[i];
		c.faulty += !met[v] && nt_tangent_faults(mesh->tangents + 4 * v, mesh->normals + 3 * v);
		met[v] = 1;
	}
	return c.faulty;
}

void nt_look_at_kept(nt_scene *scene, nt_mesh *mesh, nt_format written, unsigned threads)
{
	if (mesh->tangents && mesh->texcoords && nt_mesh_needs_tangents(mesh, nt_format_is_gltf(written)))
		judge(mesh, nt_v_offset(scene->format, written), &scene->arena, threads);
	if (mesh->tangents && mesh->normals)
		mesh->kept.bad = count_faulty(mesh, &scene->arena, threads);
	if (mesh->kept.wrong || mesh->kept.mixed || !mesh->kept.judged)
		nt_judge_w(mesh);
	else
		mesh->signs = NT_SIGN_RIGHT;
}

void nt_tell_kept(nt_scene *scene, const bool *halved)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		const size_t wrong = mesh->kept.wrong, mixed = mesh->kept.mixed;
		char share[64], others[64], detail[256];
		if ((!wrong && !mixed) || mesh->pair)
			continue;
		snprintf(share, sizeof share, "%.3g %% of %zu", 100.0 * (double)wrong / (double)mesh->kept.judged,
			mesh->kept.judged);
		snprintf(others, sizeof others, ", and corners of %zu more have different w", mixed);
		snprintf(detail, sizeof detail, "%s%s%s", wrong ? share : "corners with different w",
			wrong && mixed ? others : "", nt_doubt_text(mesh->doubt));
		nt_finding_put(&scene->findings, (nt_finding){.code = NT_CODE_TAN_KEPT_SIGN,
			.count = wrong ? wrong : mixed, .detail = detail, .stays = halved && halved[i],
			.repair = mesh->doubt == NT_DOUBT_UNDECODABLE ? "--existing=replace" : NULL},
			nt_mesh_place(mesh, &(nt_place){0}));
	}
}

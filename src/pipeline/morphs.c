/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets. A client that finds TANGENT in a mesh computes none itself, so the targets need
 * theirs: the tangents of the mesh as one target alone moves it, solved like any mesh. All targets share
 * the base's vertices, so a vertex is split where the base or any target has different tangents.
 *
 * They share its w too, for targets have none. w is the orientation of the UVs, which no target changes; but
 * where one turns a triangle to the other side of its normals, B = cross(N, T) w turns round with it. Such
 * triangles are counted.
 *
 * Without texture coordinates there is nothing to solve: the tangents turn with their normals (authored.c). Half of
 * such a delta is half of the turn, so that nothing has to be looked at halfway.
 *
 * With them, tangents are off at weight 0.5. A client adds the delta of TANGENT times the weight, which is exact at the
 * ends. Between them dP/du of a triangle moves along a straight line from its old to its new value; the sum of two unit
 * vectors follows the angle, so that the two part where a target stretches what it turns, and the sum has no direction
 * where a target turns by 180 degrees. The right answer is a solve of the mesh as the target moves it at weight 0.5.
 * On one triangle what is right lies between the tangents of the two ends and the client's halfway, so the error is
 * at most half of what the target turns. Averaging over triangles can exceed that a little. Targets that turn no
 * tangent by more than the limit itself are therefore not solved again, which saves most of them the time.
 */
#include "pipeline/stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/angle.h"
#include "base/hash_index.h"
#include "base/vec.h"
#include "gltf/quantize.h"
#include "scene/values.h"

enum { KEY_BITS = 20 }; /* of a class number in each float of a key: floats are exact to 24 */

static size_t vertex_of(const nmtan_mesh *view, size_t corner)
{
	return view->indices ? view->indices[corner] : corner;
}

/* Which side of its winding the normals of a triangle are on: 1, -1, or 0 where that cannot be said. */
static int side_of(const nmtan_mesh *view, size_t triangle)
{
	const float *p[3], *n[3];
	for (size_t k = 0; k < 3; k++) {
		const size_t vertex = vertex_of(view, 3 * triangle + k);
		p[k] = view->positions + 3 * vertex;
		n[k] = view->normals + 3 * vertex;
	}
	double along = 0;
	for (size_t i = 0; i < 3; i++) {
		const size_t j = (i + 1) % 3, k = (i + 2) % 3;
		const double face = ((double)p[1][j] - p[0][j]) * ((double)p[2][k] - p[0][k]) -
			((double)p[1][k] - p[0][k]) * ((double)p[2][j] - p[0][j]);
		along += face * ((double)n[0][i] + n[1][i] + n[2][i]);
	}
	return along > 0 ? 1 : along < 0 ? -1 : 0;
}

size_t nt_morphs_count_turned(const nmtan_mesh *base, const nmtan_mesh *moved)
{
	size_t count = 0;
	for (size_t t = 0; t < base->face_count; t++)
		count += side_of(base, t) * side_of(moved, t) < 0;
	return count;
}

nt_status nt_morphs_restore(nt_mesh *mesh, nt_morph_work *work, bool targets)
{
	if (mesh->decision != NT_DECISION_REPAIR || !mesh->tangents || !mesh->texcoords)
		return NT_OK;
	if (targets && mesh->morph_count) {
		work->solved = nt_alloc(mesh->corner_count, 4 * sizeof(float));
		if (!work->solved)
			return NT_ERROR_MEMORY;
		memcpy(work->solved, mesh->corner_tangents, mesh->corner_count * 4 * sizeof(float));
	}
	nt_restore_authored(mesh, mesh->corner_tangents, work->solved);
	return NT_OK;
}

/* ---- classes of corners ---- */

/* Classes of scene/values.c, by corner, and rows of targets as they are there. */
typedef struct nt_corner_classes {
	uint32_t *of;     /* [corner_count]; the block of the following, which have room for as many */
	uint32_t *first;  /* [count] first corner of a class */
	uint32_t *parent; /* [count] the class that it was part of; itself: none */
	size_t count;
	uint32_t *words;
	size_t word_count, word_capacity;
} nt_corner_classes;

static uint32_t add_class(nt_corner_classes *classes, uint32_t corner, uint32_t parent)
{
	classes->first[classes->count] = corner;
	classes->parent[classes->count] = parent;
	classes->of[corner] = (uint32_t)classes->count;
	return (uint32_t)classes->count++;
}

/* Divides classes by the tangents of corners, of which so many numbers count: targets have no w of their own. */
static bool divide(nt_corner_classes *classes, size_t corner_count, const float *rows, size_t numbers)
{
	nt_hash_index others = {0}; /* classes that come of it */
	bool done = true;
	for (uint32_t c = 0; done && c < corner_count; c++) {
		const uint32_t before = classes->of[c];
		const float *row = rows + 4 * (size_t)c;
		if (memcmp(rows + 4 * (size_t)classes->first[before], row, numbers * sizeof *row) == 0)
			continue;
		const uint64_t hash = nt_hash_bytes(before, row, numbers * sizeof *row);
		uint32_t other;
		for (size_t at = NT_HASH_BEGIN; (other = nt_hash_index_next(&others, hash, &at)) != UINT32_MAX;)
			if (classes->parent[other] == before &&
				memcmp(rows + 4 * (size_t)classes->first[other], row, numbers * sizeof *row) == 0)
				break;
		if (other != UINT32_MAX)
			classes->of[c] = other;
		else
			done = nt_hash_index_add(&others, hash, add_class(classes, c, before));
	}
	nt_hash_index_free(&others);
	return done;
}

/* A class for each vertex that has corners, divided by the base: those that it makes have no parent. */
static bool begin(const nt_mesh *mesh, nt_morph_work *work)
{
	nt_corner_classes *classes = work->classes = nt_calloc(1, sizeof *classes);
	uint32_t *known = nt_alloc(mesh->vertex_count, sizeof *known);
	bool done = classes && known && (classes->of = nt_alloc(mesh->corner_count, 3 * sizeof *classes->of));
	if (done) {
		classes->first = classes->of + mesh->corner_count;
		classes->parent = classes->first + mesh->corner_count;
		memset(known, 0xFF, mesh->vertex_count * sizeof *known);
		for (uint32_t c = 0; c < mesh->corner_count; c++) {
			uint32_t *own = &known[nt_mesh_vertex(mesh, c)];
			if (*own == NT_NONE)
				*own = add_class(classes, c, (uint32_t)classes->count);
			classes->of[c] = *own;
		}
		done = divide(classes, mesh->corner_count, mesh->corner_tangents, 4);
		for (size_t k = 0; k < classes->count; k++)
			classes->parent[k] = (uint32_t)k;
	}
	free(known);
	return done;
}

/* Whether a class has a row: parents come before. */
static bool has_row(const nt_mesh *mesh, const nt_corner_classes *classes, const float *rows, size_t k)
{
	const uint32_t parent = classes->parent[k];
	const float *row = rows + 4 * (size_t)classes->first[k];
	const float *other = parent == k ? mesh->corner_tangents + 4 * (size_t)classes->first[k]
					 : rows + 4 * (size_t)classes->first[parent];
	return memcmp(row, other, 3 * sizeof *row) != 0;
}

static bool store_rows(const nt_mesh *mesh, nt_corner_classes *classes, nt_morph *morph, const float *tangents)
{
	size_t count = 0;
	for (size_t k = 0; k < classes->count; k++)
		count += has_row(mesh, classes, tangents, k);
	const bool listed = 4 * count < 3 * classes->count;
	morph->class_count = classes->count;
	morph->row_count = listed ? count : classes->count;
	morph->first_word = classes->word_count;
	if (!morph->row_count) /* of all targets, words may still be NULL */
		return true;
	if (!nt_grow((void **)&classes->words, &classes->word_capacity,
		classes->word_count + (listed ? 4 : 3) * morph->row_count, sizeof *classes->words))
		return false;
	uint32_t *number = classes->words + classes->word_count, *row = number + (listed ? count : 0);
	for (size_t k = 0; k < classes->count; k++) {
		if (listed && !has_row(mesh, classes, tangents, k))
			continue;
		if (listed)
			*number++ = (uint32_t)k;
		memcpy(row, tangents + 4 * (size_t)classes->first[k], 3 * sizeof *row);
		row += 3;
	}
	classes->word_count = (size_t)(row - classes->words);
	return true;
}

/* A target that does not turn a tangent that was solved does not turn the authored one either. */
static void keep_unturned(const nt_mesh *mesh, const float *solved, float *moved)
{
	const float *authored = mesh->corner_tangents;
	for (size_t c = 0; solved && c < mesh->corner_count; c++, moved += 4, solved += 4, authored += 4)
		if (solved[3] == 0 && fabsf(moved[0] - solved[0]) <= NT_MORPH_LEAST &&
			fabsf(moved[1] - solved[1]) <= NT_MORPH_LEAST && fabsf(moved[2] - solved[2]) <= NT_MORPH_LEAST)
			memcpy(moved, authored, 3 * sizeof *moved);
}

nt_status nt_morphs_classify(const nt_mesh *mesh, nt_morph_work *work, nt_morph *morph, float *rows)
{
	const bool begun = work->classes || begin(mesh, work);
	keep_unturned(mesh, work->solved, rows);
	return begun && divide(work->classes, mesh->corner_count, rows, 3) &&
		store_rows(mesh, work->classes, morph, rows) ? NT_OK : NT_ERROR_MEMORY;
}

/* ---- vertices ---- */

void nt_morphs_keys(const nt_mesh *mesh, const nt_morph_work *work, float *keys)
{
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const uint32_t k = work->classes->of[c];
		memcpy(keys + 4 * c, (float[]){(float)(k & ((1u << KEY_BITS) - 1)), (float)(k >> KEY_BITS), 0, 0},
			4 * sizeof *keys);
	}
}

nt_status nt_morphs_finish(nt_mesh *mesh, const nt_morph_work *work, size_t source_count, nt_arena *arena)
{
	const nt_split *split = &mesh->split;
	nt_corner_classes *classes = work->classes;
	const size_t count = mesh->vertex_count + source_count;
	uint32_t *class_of = nt_arena_alloc(arena, count, sizeof *class_of);
	uint32_t *parent = nt_arena_alloc(arena, classes->count, sizeof *parent), *words = classes->words;
	nt_morph_tangents *all = nt_arena_alloc(arena, 1, sizeof *all);
	classes->words = NULL;
	if (!nt_arena_adopt(arena, words) || !class_of || !parent || !all)
		return NT_ERROR_MEMORY;
	memset(class_of, 0xFF, count * sizeof *class_of);
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const size_t vertex = split->indices[c];
		memcpy(split->vertex_tangents + 4 * vertex, mesh->corner_tangents + 4 * c, 4 * sizeof(float));
		class_of[vertex] = classes->of[c];
	}
	memcpy(parent, classes->parent, classes->count * sizeof *parent);
	*all = (nt_morph_tangents){.class_of = class_of, .parent = parent, .class_count = classes->count,
		.words = words, .word_count = classes->word_count, .user_count = 1};
	mesh->morph_tangents = all;
	return NT_OK;
}

void nt_morphs_free(nt_morph_work *work)
{
	free(work->solved);
	if (work->classes) {
		free(work->classes->of);
		free(work->classes->words);
	}
	free(work->classes);
}

/* ---- halfway ---- */

/* The cosine of 5 degrees, from which on there is a finding. */
static const double LIMIT_COSINE = 0.99619469809174553;

/* Half a sum of two unit vectors that is shorter has lost its direction. */
static const double CANCELLED = 1.0 / 1024;

/* Twice the area of a triangle over the square of its longest edge at either end: what is below has collapsed on
 * its way (positions are rounded), and no direction is right there. */
static const double COLLAPSED = 1e-4;

/* The cosine of the angle between two vectors that are not zero. */
static double cosine_between(nt_dvec3 a, nt_dvec3 b)
{
	return nt_dvec3_dot(a, b) / sqrt(nt_dvec3_dot(a, a) * nt_dvec3_dot(b, b));
}

/* As they were solved. */
static const float *base_tangents(const nt_mesh *mesh, const nt_morph_work *work)
{
	return work->solved ? work->solved : mesh->corner_tangents;
}

bool nt_morphs_turn(const nt_mesh *mesh, const nt_morph_work *work, const float *rows)
{
	const float *base = base_tangents(mesh, work);
	for (size_t c = 0; c < mesh->corner_count; c++)
		if (cosine_between(nt_dvec3_load(base + 4 * c), nt_dvec3_load(rows + 4 * c)) < LIMIT_COSINE)
			return true;
	return false;
}

/* The middle of rows that a target moves; NULL: memory is exhausted. */
static float *middle_of(const float *a, const float *b, size_t count)
{
	float *middle = nt_alloc(count, 3 * sizeof *middle);
	for (size_t i = 0; middle && i < 3 * count; i++)
		middle[i] = (float)(((double)a[i] + b[i]) * 0.5);
	return middle;
}

bool nt_morphs_halfway(const nmtan_mesh *base, const nmtan_mesh *moved, float **positions, float **normals)
{
	const size_t count = base->vertex_count;
	if (moved->positions != base->positions)
		*positions = middle_of(base->positions, moved->positions, count);
	if (moved->normals != base->normals)
		*normals = middle_of(base->normals, moved->normals, count);
	for (size_t i = 0; *normals && i < count; i++) {
		nt_dvec3 n = nt_dvec3_load(*normals + 3 * i);
		nt_dvec3_normalise(&n);
		nt_dvec3_store(n, *normals + 3 * i);
	}
	return (*positions || moved->positions == base->positions) && (*normals || moved->normals == base->normals);
}

/* Twice the area of a triangle between two places, and the square of its longest edge there. */
static double measure(const nmtan_mesh *view, const float *from, const float *to, size_t triangle, double *longest)
{
	nt_dvec3 p[3];
	for (size_t k = 0; k < 3; k++) {
		const size_t v = vertex_of(view, 3 * triangle + k);
		p[k] = nt_dvec3_scale(0.5, nt_dvec3_add(nt_dvec3_load(from + 3 * v), nt_dvec3_load(to + 3 * v)));
	}
	*longest = 0;
	for (size_t k = 0; k < 3; k++) {
		const nt_dvec3 edge = nt_dvec3_sub(p[(k + 1) % 3], p[k]);
		*longest = fmax(*longest, nt_dvec3_dot(edge, edge));
	}
	return nt_dvec3_length(nt_dvec3_cross(nt_dvec3_sub(p[1], p[0]), nt_dvec3_sub(p[2], p[0])));
}

/* Whether the triangle itself has a direction at weight 0.5. */
static bool has_direction(const nmtan_mesh *base, const nmtan_mesh *moved, size_t triangle)
{
	const float *uv[3], *from = base->positions, *to = moved->positions;
	for (size_t k = 0; k < 3; k++)
		uv[k] = base->texcoords + 2 * vertex_of(base, 3 * triangle + k);
	double before, after, now;
	measure(base, from, from, triangle, &before);
	measure(base, to, to, triangle, &after);
	const double area = measure(base, from, to, triangle, &now);
	return area > COLLAPSED * fmax(before, after) && nmtan_orientation(uv[0], uv[1], uv[2]) != 0;
}

void nt_morphs_compare_halfway(const nt_mesh *mesh, const nt_morph_work *work, const nmtan_mesh *base,
	const nmtan_mesh *moved, const float *rows, const float *halfway, nt_morph *morph)
{
	static const double degrees = 57.29577951308232;
	const float *own = base_tangents(mesh, work);
	double least = 1;
	morph->halfway_triangles = 0;
	for (size_t t = 0; t < mesh->face_count; t++) {
		double worst = 1;
		bool cancelled = false;
		for (size_t c = 3 * t; c < 3 * t + 3; c++) {
			const nt_dvec3 client = nt_dvec3_scale(0.5, nt_dvec3_add(nt_dvec3_load(own + 4 * c),
				nt_dvec3_load(rows + 4 * c)));
			const bool lost = nt_dvec3_dot(client, client) < CANCELLED * CANCELLED;
			worst = fmin(worst, lost ? 0 : cosine_between(client, nt_dvec3_load(halfway + 4 * c)));
			cancelled |= lost;
		}
		if (worst < LIMIT_COSINE && (cancelled || has_direction(base, moved, t))) {
			morph->halfway_triangles++;
			least = fmin(least, worst);
		}
	}
	morph->halfway_degrees = nt_angle(sqrt(fmax(0, 1 - least * least)), least) * degrees;
}

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
 */
#include "pipeline/morphs.h"
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/hash_index.h"

enum { KEY_BITS = 20 }; /* of a corner number in each float of a key: floats are exact to 24 */

/* Which side of its winding the normals of a triangle are on: 1, -1, or 0 where that cannot be said. */
static int side_of(const nmtan_mesh *view, size_t triangle)
{
	const float *p[3], *n[3];
	for (size_t k = 0; k < 3; k++) {
		const size_t corner = 3 * triangle + k;
		const size_t vertex = view->indices ? view->indices[corner] : corner;
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

static nmtan_mesh move(const nmtan_mesh *base, const nt_morph *morph)
{
	nmtan_mesh moved = *base;
	if (morph->positions)
		moved.positions = morph->positions;
	if (morph->normals)
		moved.normals = morph->normals;
	return moved;
}

size_t nt_morphs_count_turned(const nmtan_mesh *base, const nt_morph *morph)
{
	const nmtan_mesh moved = move(base, morph);
	size_t count = 0;
	for (size_t t = 0; t < base->face_count; t++)
		count += side_of(base, t) * side_of(&moved, t) < 0;
	return count;
}

static nt_status measure_halfway(const nt_mesh *mesh, const nmtan_mesh *base, const nmtan_options *options,
	nt_morph *morph)
{
	if (!nt_morphs_turn(mesh, morph))
		return NT_OK;
	float *halfway;
	const nt_status status =
		nt_morphs_solve_halfway(base, mesh->halves, morph->positions, morph->normals, options, &halfway);
	if (!status)
		nt_morphs_compare_halfway(mesh, base, halfway, morph);
	free(halfway);
	return status;
}

nt_status nt_morphs_solve(nt_mesh *mesh, const nmtan_mesh *view, const nmtan_options *options)
{
	mesh->morph_turned = 0;
	for (size_t m = 0; m < mesh->morph_count; m++) {
		nt_morph *morph = &mesh->morphs[m];
		const nmtan_mesh moved = move(view, morph);
		morph->corner_tangents = nt_alloc(mesh->corner_count, 4 * sizeof(float));
		if (!morph->corner_tangents)
			return NT_ERROR_MEMORY;
		mesh->morph_turned += nt_morphs_count_turned(view, morph);
		nt_status status = NT_OK;
		if (!view->texcoords) {
			nt_turn_untextured(mesh, view, &moved, morph->corner_tangents);
		} else {
			const nmtan_output output = {.struct_bytes = sizeof output, .tangents = morph->corner_tangents};
			status = nt_status_of(nt_tangents_of_halves(&moved, mesh->halves, options, &output, NULL));
			if (!status)
				status = measure_halfway(mesh, view, options, morph);
		}
		if (!status && !nt_morphs_are_restored(mesh))
			status = nt_morphs_classify(mesh, morph);
		if (status)
			return status;
	}
	return NT_OK;
}

/* ---- classes of corners ---- */

/*
 * Corners of a vertex that have the same tangents in all targets so far are one class. A target divides classes
 * further, and keeps one tangent for each that there is then; a class that comes later has that of its parent, which it
 * was one with. So the tangents of all corners are in memory for one target at a time.
 */
typedef struct nt_corner_classes {
	uint32_t *of; /* [corner_count] */
	uint32_t *first, *parent; /* [count] its first corner, the class that it was part of; itself: a vertex */
	size_t count, first_capacity, parent_capacity;
} nt_corner_classes;

static void free_classes(nt_mesh *mesh)
{
	if (!mesh->corner_classes)
		return;
	free(mesh->corner_classes->of);
	free(mesh->corner_classes->first);
	free(mesh->corner_classes->parent);
	free(mesh->corner_classes);
	mesh->corner_classes = NULL;
}

static bool add_class(nt_corner_classes *classes, uint32_t corner, uint32_t parent)
{
	const size_t count = classes->count + 1;
	if (!nt_grow((void **)&classes->first, &classes->first_capacity, count, sizeof *classes->first) ||
		!nt_grow((void **)&classes->parent, &classes->parent_capacity, count, sizeof *classes->parent))
		return false;
	classes->first[classes->count] = corner;
	classes->parent[classes->count] = parent;
	classes->of[corner] = (uint32_t)classes->count++;
	return true;
}

/* A class for each vertex that has corners. */
static bool begin_classes(nt_mesh *mesh)
{
	nt_corner_classes *classes = mesh->corner_classes = nt_calloc(1, sizeof *classes);
	uint32_t *known = nt_alloc(mesh->vertex_count, sizeof *known);
	bool done = classes && known && (classes->of = nt_alloc(mesh->corner_count, sizeof *classes->of));
	if (done)
		memset(known, 0xFF, mesh->vertex_count * sizeof *known);
	for (uint32_t c = 0; done && c < mesh->corner_count; c++) {
		const uint32_t vertex = mesh->indices ? mesh->indices[c] : c;
		if (known[vertex] != NT_NONE) {
			classes->of[c] = known[vertex];
			continue;
		}
		known[vertex] = (uint32_t)classes->count;
		done = add_class(classes, c, known[vertex]);
	}
	free(known);
	return done;
}

/* Targets have no w of their own. */
static bool same_tangent(const nt_morph *morph, size_t a, size_t b)
{
	return memcmp(morph->corner_tangents + 4 * a, morph->corner_tangents + 4 * b, 3 * sizeof(float)) == 0;
}

nt_status nt_morphs_classify(nt_mesh *mesh, nt_morph *morph)
{
	if (!mesh->corner_classes && !begin_classes(mesh))
		return NT_ERROR_MEMORY;
	nt_corner_classes *classes = mesh->corner_classes;
	nt_hash_index others = {0}; /* classes that this target makes */
	bool done = true;
	for (uint32_t c = 0; done && c < mesh->corner_count; c++) {
		const uint32_t before = classes->of[c];
		if (same_tangent(morph, classes->first[before], c))
			continue;
		const uint64_t hash = nt_hash_bytes(before, morph->corner_tangents + 4 * (size_t)c, 3 * sizeof(float));
		uint32_t other;
		for (size_t at = NT_HASH_BEGIN; (other = nt_hash_index_next(&others, hash, &at)) != UINT32_MAX;)
			if (classes->parent[other] == before && same_tangent(morph, classes->first[other], c))
				break;
		if (other != UINT32_MAX)
			classes->of[c] = other;
		else
			done = add_class(classes, c, before) && nt_hash_index_add(&others, hash, classes->of[c]);
	}
	nt_hash_index_free(&others);
	morph->class_count = classes->count;
	morph->class_tangents = done ? nt_alloc(classes->count, 3 * sizeof(float)) : NULL;
	for (size_t k = 0; morph->class_tangents && k < classes->count; k++)
		memcpy(morph->class_tangents + 3 * k, morph->corner_tangents + 4 * (size_t)classes->first[k],
			3 * sizeof(float));
	free(morph->corner_tangents);
	morph->corner_tangents = NULL;
	return morph->class_tangents ? NT_OK : NT_ERROR_MEMORY;
}

static bool same_corner(const nt_mesh *mesh, size_t a, size_t b)
{
	return mesh->corner_classes->of[a] == mesh->corner_classes->of[b] &&
		memcmp(mesh->corner_tangents + 4 * a, mesh->corner_tangents + 4 * b, 4 * sizeof(float)) == 0;
}

/* ---- vertices ---- */

/* The first corner of its vertex with the same tangents, behind the very first; which may be itself. */
static nt_status find_other(const nt_mesh *mesh, uint32_t corner, nt_hash_index *others, uint32_t *first)
{
	const uint64_t hash = nt_hash_bytes(mesh->corner_classes->of[corner],
		mesh->corner_tangents + 4 * (size_t)corner, 4 * sizeof(float));
	for (size_t at = NT_HASH_BEGIN; (*first = nt_hash_index_next(others, hash, &at)) != UINT32_MAX;)
		if (same_corner(mesh, *first, corner))
			return NT_OK;
	*first = corner;
	return nt_hash_index_add(others, hash, corner) ? NT_OK : NT_ERROR_MEMORY;
}

nt_status nt_morphs_keys(nt_mesh *mesh, const nmtan_mesh *view, float *keys)
{
	/* authored tangents come back after all solves: targets whose corners wait for that */
	for (size_t m = 0; m < mesh->morph_count; m++)
		if (mesh->morphs[m].corner_tangents && nt_morphs_classify(mesh, &mesh->morphs[m]))
			return NT_ERROR_MEMORY;
	/* the first corner of each vertex; corners that differ from it by hash, one for each combination */
	uint32_t *head = nt_alloc(mesh->vertex_count, sizeof *head);
	if (!head)
		return NT_ERROR_MEMORY;
	nt_hash_index others = {0};
	nt_status status = NT_OK;
	memset(head, 0xFF, mesh->vertex_count * sizeof *head);
	for (uint32_t c = 0; !status && c < mesh->corner_count; c++) {
		const uint32_t vertex = view->indices ? view->indices[c] : c;
		uint32_t first = head[vertex];
		if (first == NT_NONE)
			head[vertex] = first = c;
		else if (!same_corner(mesh, first, c))
			status = find_other(mesh, c, &others, &first);
		float *key = keys + 4 * (size_t)c;
		key[0] = (float)(first & ((1u << KEY_BITS) - 1));
		key[1] = (float)(first >> KEY_BITS);
		key[2] = key[3] = 0;
	}
	free(head);
	nt_hash_index_free(&others);
	return status;
}

nt_status nt_morphs_finish(nt_mesh *mesh)
{
	nt_split *split = &mesh->split;
	for (size_t c = 0; c < mesh->corner_count; c++)
		memcpy(split->vertex_tangents + 4 * (size_t)split->indices[c],
			mesh->corner_tangents + 4 * c, 4 * sizeof(float));
	const size_t count = mesh->vertex_count + split->source_count;
	uint32_t *class_of = mesh->corner_classes->of;
	/* from the last one on: classes become those before them */
	for (size_t m = mesh->morph_count; m-- > 0;) {
		nt_morph *morph = &mesh->morphs[m];
		morph->vertex_tangents = nt_alloc(count, 3 * sizeof(float));
		if (!morph->vertex_tangents)
			return NT_ERROR_MEMORY;
		/* vertices without corners do not turn */
		for (size_t v = 0; v < count; v++)
			memcpy(morph->vertex_tangents + 3 * v, split->vertex_tangents + 4 * v,
				3 * sizeof(float));
		for (size_t c = 0; c < mesh->corner_count; c++) {
			while (class_of[c] >= morph->class_count)
				class_of[c] = mesh->corner_classes->parent[class_of[c]];
			memcpy(morph->vertex_tangents + 3 * (size_t)split->indices[c],
				morph->class_tangents + 3 * (size_t)class_of[c], 3 * sizeof(float));
		}
		free(morph->class_tangents);
		morph->class_tangents = NULL;
	}
	return NT_OK;
}

void nt_morphs_free(nt_mesh *mesh)
{
	for (size_t m = 0; m < mesh->morph_count; m++) {
		free(mesh->morphs[m].corner_tangents);
		free(mesh->morphs[m].class_tangents);
		mesh->morphs[m].corner_tangents = mesh->morphs[m].class_tangents = NULL;
	}
	free_classes(mesh);
}

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
		if (!view->texcoords) {
			nt_turn_untextured(mesh, view, &moved, morph->corner_tangents);
			continue;
		}
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = morph->corner_tangents};
		nt_status status = nt_status_of(nt_tangents_of_halves(&moved, mesh->halves, options, &output, NULL));
		if (!status)
			status = measure_halfway(mesh, view, options, morph);
		if (status)
			return status;
	}
	return NT_OK;
}

static bool same_corner(const nt_mesh *mesh, size_t a, size_t b)
{
	if (memcmp(mesh->corner_tangents + 4 * a, mesh->corner_tangents + 4 * b, 4 * sizeof(float)) != 0)
		return false;
	for (size_t m = 0; m < mesh->morph_count; m++) {
		const float *tangents = mesh->morphs[m].corner_tangents;
		/* targets have no w of their own */
		if (memcmp(tangents + 4 * a, tangents + 4 * b, 3 * sizeof(float)) != 0)
			return false;
	}
	return true;
}

static uint64_t hash_corner(const nt_mesh *mesh, uint32_t vertex, uint32_t corner)
{
	uint64_t hash = nt_hash_bytes(vertex, mesh->corner_tangents + 4 * (size_t)corner, 4 * sizeof(float));
	for (size_t m = 0; m < mesh->morph_count; m++)
		hash = nt_hash_bytes(hash, mesh->morphs[m].corner_tangents + 4 * (size_t)corner,
			3 * sizeof(float));
	return hash;
}

/* The first corner of its vertex with the same tangents, behind the very first; which may be itself. */
static nt_status find_other(const nt_mesh *mesh, const nmtan_mesh *view, uint32_t corner,
	nt_hash_index *others, uint32_t *first)
{
	const uint32_t vertex = view->indices ? view->indices[corner] : corner;
	const uint64_t hash = hash_corner(mesh, vertex, corner);
	for (size_t at = NT_HASH_BEGIN; (*first = nt_hash_index_next(others, hash, &at)) != UINT32_MAX;)
		if ((view->indices ? view->indices[*first] : *first) == vertex &&
			same_corner(mesh, *first, corner))
			return NT_OK;
	*first = corner;
	return nt_hash_index_add(others, hash, corner) ? NT_OK : NT_ERROR_MEMORY;
}

nt_status nt_morphs_keys(const nt_mesh *mesh, const nmtan_mesh *view, float *keys)
{
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
			status = find_other(mesh, view, c, &others, &first);
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
	for (size_t m = 0; m < mesh->morph_count; m++) {
		nt_morph *morph = &mesh->morphs[m];
		morph->vertex_tangents = nt_alloc(count, 3 * sizeof(float));
		if (!morph->vertex_tangents)
			return NT_ERROR_MEMORY;
		/* vertices without corners do not turn */
		for (size_t v = 0; v < count; v++)
			memcpy(morph->vertex_tangents + 3 * v, split->vertex_tangents + 4 * v,
				3 * sizeof(float));
		for (size_t c = 0; c < mesh->corner_count; c++)
			memcpy(morph->vertex_tangents + 3 * (size_t)split->indices[c],
				morph->corner_tangents + 4 * c, 3 * sizeof(float));
		free(morph->corner_tangents);
		morph->corner_tangents = NULL;
	}
	return NT_OK;
}

void nt_morphs_free(nt_mesh *mesh)
{
	for (size_t m = 0; m < mesh->morph_count; m++) {
		free(mesh->morphs[m].corner_tangents);
		mesh->morphs[m].corner_tangents = NULL;
	}
}

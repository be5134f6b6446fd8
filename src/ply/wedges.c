/* SPDX-License-Identifier: MIT */
/*
 * Corners with texture coordinates of their own become vertices: see wedges.h. Most corners of a
 * row agree, so the first pair is compared directly; only copies go through the hash table, which keeps
 * a fan of any size linear. Pairs are equal when their bits are.
 */
#include "ply/wedges.h"

#include <stdlib.h>

enum wedge_state { WEDGE_UNUSED, WEDGE_HAS, WEDGE_LACKS };

bool ply_wedges_init(ply_wedges *wedges, size_t row_count)
{
	*wedges = (ply_wedges){.row_count = row_count};
	wedges->row_uvs = nt_calloc(row_count, sizeof *wedges->row_uvs);
	wedges->row_states = nt_calloc(row_count, sizeof *wedges->row_states);
	return wedges->row_uvs && wedges->row_states;
}

void ply_wedges_free(ply_wedges *wedges)
{
	free(wedges->row_uvs);
	free(wedges->row_states);
	free(wedges->copy_uvs);
	free(wedges->copy_rows);
	free(wedges->copy_states);
	nt_hash_index_free(&wedges->index);
	*wedges = (ply_wedges){0};
}

static uint32_t append_copy(ply_wedges *w, uint64_t hash, uint32_t row, const float uv[2], uint8_t state)
{
	const size_t count = w->copy_count + 1;
	if (w->row_count + count >= NT_NONE ||
		!nt_grow((void **)&w->copy_uvs, &w->uv_capacity, count, sizeof *w->copy_uvs) ||
		!nt_grow((void **)&w->copy_rows, &w->row_capacity, count, sizeof *w->copy_rows) ||
		!nt_grow((void **)&w->copy_states, &w->state_capacity, count, 1) ||
		!nt_hash_index_add(&w->index, hash, (uint32_t)w->copy_count))
		return NT_NONE;
	const uint32_t copy = (uint32_t)w->copy_count++;
	memcpy(w->copy_uvs[copy], uv, sizeof w->copy_uvs[copy]);
	w->copy_rows[copy] = row;
	w->copy_states[copy] = state;
	return (uint32_t)(w->row_count + copy);
}

uint32_t ply_wedges_vertex(ply_wedges *w, uint32_t row, const float *uv)
{
	static const float none[2];
	const uint8_t state = uv ? WEDGE_HAS : WEDGE_LACKS;
	const float *pair = uv ? uv : none;
	w->any |= uv != NULL;
	w->any_lacks |= uv == NULL;
	if (w->row_states[row] == WEDGE_UNUSED) {
		w->row_states[row] = state;
		memcpy(w->row_uvs[row], pair, sizeof w->row_uvs[row]);
		return row;
	}
	if (w->row_states[row] == state && memcmp(w->row_uvs[row], pair, sizeof w->row_uvs[row]) == 0)
		return row;
	uint64_t bits;
	memcpy(&bits, pair, sizeof bits);
	const uint64_t hash = nt_hash_words(bits, row);
	size_t at = NT_HASH_BEGIN;
	for (uint32_t copy; (copy = nt_hash_index_next(&w->index, hash, &at)) != NT_NONE;)
		if (w->copy_rows[copy] == row && w->copy_states[copy] == state &&
			memcmp(w->copy_uvs[copy], pair, sizeof w->copy_uvs[copy]) == 0)
			return (uint32_t)(w->row_count + copy);
	return append_copy(w, hash, row, pair, state);
}

/* A copy of an array of rows with the copies' rows behind it. */
static bool grow_attribute(const ply_wedges *w, nt_arena *arena, float **array, size_t width)
{
	if (!*array)
		return true;
	float *grown = nt_arena_alloc(arena, w->row_count + w->copy_count, width * sizeof *grown);
	if (!grown)
		return false;
	memcpy(grown, *array, w->row_count * width * sizeof *grown);
	for (size_t i = 0; i < w->copy_count; i++)
		memcpy(grown + (w->row_count + i) * width, *array + w->copy_rows[i] * width,
			width * sizeof *grown);
	*array = grown;
	return true;
}

static bool set_lacks(const ply_wedges *w, nt_arena *arena, nt_mesh *mesh)
{
	const size_t count = w->row_count + w->copy_count;
	mesh->vertex_lacks = nt_arena_alloc(arena, count, 1);
	if (!mesh->vertex_lacks)
		return false;
	for (size_t i = 0; i < count; i++) {
		const uint8_t state =
			i < w->row_count ? w->row_states[i] : w->copy_states[i - w->row_count];
		mesh->vertex_lacks[i] = state == WEDGE_LACKS ? NT_LACKS_TEXCOORD : 0;
	}
	return true;
}

bool ply_wedges_apply(ply_wedges *w, nt_scene *scene, nt_mesh *mesh, ply_source *source)
{
	if (!w->any)
		return true;
	nt_arena *arena = &scene->arena;
	const size_t count = w->row_count + w->copy_count;
	if (w->copy_count && !(grow_attribute(w, arena, &mesh->positions, 3) &&
				     grow_attribute(w, arena, &mesh->normals, 3) &&
				     grow_attribute(w, arena, &mesh->colors, 4) &&
				     grow_attribute(w, arena, &mesh->tangents, 4)))
		return false;
	mesh->texcoords = nt_arena_alloc(arena, count, sizeof *w->row_uvs);
	if (!mesh->texcoords || (w->any_lacks && !set_lacks(w, arena, mesh)))
		return false;
	memcpy(mesh->texcoords, w->row_uvs, w->row_count * sizeof *w->row_uvs);
	if (w->copy_count)
		memcpy(mesh->texcoords + 2 * w->row_count, w->copy_uvs,
			w->copy_count * sizeof *w->copy_uvs);
	mesh->vertex_count = count;
	source->wedge_count = w->copy_count;
	source->wedge_rows = w->copy_rows;
	w->copy_rows = NULL;
	return nt_arena_adopt(arena, source->wedge_rows);
}

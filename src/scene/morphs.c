/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets, between the solve and the output. Targets are solved one after the other, but vertices are
 * split by all of them, so that the tangents of each target have to wait for the last one.
 *
 * Corners of a vertex that have the same tangents so far, the base's and those of the targets before, are one class. A
 * target divides classes further. A class that comes later was part of its parent: in the targets before it, it has the
 * parent's tangent. A target stores a row for each class whose tangent is not that of its parent, or, without one, not
 * that of the base; all rows, if that takes less. So what waits is about what a sparse accessor takes, and at most the
 * floats of the output.
 */
#include "scene/values.h"

#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

void nt_morph_find_rows(const nt_mesh *mesh, size_t m, size_t *at)
{
	const nt_morph_tangents *all = mesh->morph_tangents;
	const nt_morph *morph = &mesh->morphs[m];
	const bool listed = morph->row_count < morph->class_count;
	size_t next = 0, row = morph->first_word + (listed ? morph->row_count : 0);
	for (size_t k = 0; k < all->class_count; k++) {
		const bool own = next < morph->row_count && (!listed || all->words[morph->first_word + next] == k);
		at[k] = own ? row + 3 * next : all->parent[k] == k ? SIZE_MAX : at[all->parent[k]];
		next += own;
	}
}

nt_status nt_morph_read(const nt_mesh *mesh, size_t m, float *tangents)
{
	const nt_morph_tangents *all = mesh->morph_tangents;
	size_t *at = nt_alloc(all->class_count, sizeof *at);
	if (!at)
		return NT_ERROR_MEMORY;
	nt_morph_find_rows(mesh, m, at);
	for (size_t v = 0; v < mesh->vertex_count + mesh->split.source_count; v++)
		memcpy(tangents + 3 * v, nt_morph_row(mesh, at, v), 3 * sizeof *tangents);
	free(at);
	return NT_OK;
}

void nt_morph_drop(const nt_mesh *mesh, size_t m)
{
	enum { STEP = 1 << 18 }; /* words: a megabyte, which is worth a call */
	const nt_morph_tangents *all = mesh->morph_tangents;
	const size_t begin = mesh->morphs[m].first_word;
	const size_t end = m + 1 < mesh->morph_count ? mesh->morphs[m + 1].first_word : all->word_count;
	const size_t from = begin / STEP * STEP, to = end / STEP * STEP;
	if (from != to)
		nt_drop_pages(all->words + from, (to - from) * sizeof *all->words);
}

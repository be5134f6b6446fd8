/* SPDX-License-Identifier: MIT */
/*
 * Values on their way between a source and a scene: see values.h. Positions are origin.c's, polygons polygon.c's.
 */
#include "scene/values.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

/* ---- sRGB and linear light ---- */

/* A finite value beyond floats becomes the largest one of its sign. */
static float saturated(double c)
{
	return (float)(isfinite(c) ? fmin(fmax(c, -FLT_MAX), FLT_MAX) : c);
}

static float linear_of(double c)
{
	return saturated(c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
}

void nt_srgb_init(nt_srgb *srgb)
{
	for (int i = 0; i < 256; i++)
		srgb->linear[i] = linear_of((float)i / 255.0f);
}

float nt_linear_from_srgb(const nt_srgb *srgb, float value)
{
	const float scaled = value * 255.0f;
	if (scaled >= 0.0f && scaled <= 255.0f && (float)(int)(scaled + 0.5f) / 255.0f == value)
		return srgb->linear[(int)(scaled + 0.5f)];
	return linear_of(value);
}

float nt_srgb_from_linear(float value)
{
	const double c = value;
	return saturated(c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055);
}

int nt_srgb_byte(const nt_srgb *srgb, float linear)
{
	int low = 0, high = 255;
	while (low < high) {
		const int middle = (low + high) / 2;
		if (srgb->linear[middle] < linear)
			low = middle + 1;
		else
			high = middle;
	}
	return srgb->linear[low] == linear ? low : -1;
}

bool nt_color_mend(float color[4])
{
	if (isfinite(color[0]) && isfinite(color[1]) && isfinite(color[2]) && isfinite(color[3]))
		return false;
	color[0] = color[1] = color[2] = color[3] = 1;
	return true;
}

void nt_linearise(nt_scene *scene, nt_mesh *mesh, size_t count)
{
	nt_srgb srgb;
	nt_srgb_init(&srgb);
	size_t bad = 0, first = 0;
	for (size_t i = 0; i < count; i++) {
		float *color = mesh->colors + 4 * i;
		if (nt_color_mend(color) && !bad++)
			first = i;
		for (int k = 0; k < 3; k++)
			color[k] = nt_linear_from_srgb(&srgb, color[k]);
	}
	if (bad)
		nt_finding_add(&scene->findings, NT_CODE_COLORS_DOUBTFUL, nt_mesh_place(mesh, &(nt_place){0}), bad,
			"%zu not finite, the first of vertex %zu", bad, first);
}

/* ---- texture coordinates through a texture transform ---- */

/* KHR_texture_transform's text says counterclockwise and its code clockwise (v points down); viewers and the sample
 * model do what the text says, and with v up that is the usual rotation. */

nt_status nt_mesh_transform(nt_mesh *mesh, const nt_uv_transform *t, nt_arena *arena, nt_error *error)
{
	mesh->solve_texcoords = nt_arena_alloc(arena, mesh->vertex_count, 2 * sizeof(float));
	if (!mesh->solve_texcoords)
		return nt_fail_memory(error);
	/* turning keeps the orientation; only scales can reverse it */
	for (int k = 0; k < 2; k++) {
		const int sign = (t->scale[k] > 0) - (t->scale[k] < 0);
		mesh->solve_sign = k ? mesh->solve_sign * sign : sign;
	}
	const double c = cos(t->rotation), s = sin(t->rotation);
	for (size_t i = 0; i < mesh->vertex_count; i++) {
		const double u = t->scale[0] * mesh->texcoords[2 * i];
		const double v = t->scale[1] * mesh->texcoords[2 * i + 1];
		mesh->solve_texcoords[2 * i] = (float)(t->rotation != 0 ? c * u - s * v : u);
		mesh->solve_texcoords[2 * i + 1] = (float)(t->rotation != 0 ? s * u + c * v : v);
	}
	return NT_OK;
}

/* ---- tangents of morph targets, between the solve and the output ---- */

/*
 * Targets are solved one after the other, but vertices are split by all of them, so that the tangents of each target
 * have to wait for the last one.
 *
 * Corners of a vertex that have the same tangents so far, the base's and those of the targets before, are one class. A
 * target divides classes further. A class that comes later was part of its parent: in the targets before it, it has the
 * parent's tangent. A target stores a row for each class whose tangent is not that of its parent, or, without one, not
 * that of the base; all rows, if that takes less. So what waits is about what a sparse accessor takes, and at most the
 * floats of the output.
 */

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

/* SPDX-License-Identifier: MIT */
/*
 * Thumbnails of UV layouts: see thumb.h. The outlines are those of the page, with points on a raster of half pixels, so
 * that what is smaller than that takes no place.
 */
#include "report/pack/thumb.h"

#include <math.h>
#include "report/pack/outline.h"

enum { MOST_POINTS = 3000 };

typedef struct frame {
	const float *texcoords;
	bool v_down;
	double middle[2], scale; /* of the layout; raster steps per unit */
} frame;

static bool is_finite(const float *uv)
{
	return isfinite(uv[0]) && isfinite(uv[1]);
}

static frame fit(const nt_report_geometry *g, bool v_down)
{
	double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
	for (size_t c = 0; c < 3 * g->triangle_count; c++) {
		const float *uv = g->texcoords + 2 * (size_t)g->indices[c];
		for (int k = 0; k < 2 && is_finite(uv); k++) {
			low[k] = fmin(low[k], uv[k]);
			high[k] = fmax(high[k], uv[k]);
		}
	}
	const double width = high[0] - low[0], height = high[1] - low[1];
	const double across = width > 0.0 ? NT_THUMB_WIDTH / width : INFINITY;
	const double down = height > 0.0 ? NT_THUMB_HEIGHT / height : INFINITY;
	const double scale = fmin(across, down);
	return (frame){g->texcoords, v_down, {(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0},
		isfinite(scale) ? scale : 0.0};
}

static uint32_t next_varint(const unsigned char **at)
{
	uint32_t value = 0;
	for (unsigned shift = 0;; shift += 7) {
		const unsigned char byte = *(*at)++;
		value |= (uint32_t)(byte & 127) << shift;
		if (!(byte & 128))
			return value;
	}
}

static uint32_t next_difference(const unsigned char **at)
{
	const uint32_t code = next_varint(at);
	return code >> 1 ^ (0u - (code & 1));
}

/* Appends a loop unless fewer than three points are left of it; returns how many. */
static size_t put_loop(const frame *f, const unsigned char **at, uint32_t *vertex, nt_buffer *path)
{
	const size_t begin = path->size;
	size_t count = 0;
	long last[2] = {0, 0};
	for (uint32_t points = next_varint(at); points > 0; points--) {
		*vertex += next_difference(at);
		const float *uv = f->texcoords + 2 * (size_t)*vertex;
		if (!is_finite(uv))
			continue;
		const double x = (uv[0] - f->middle[0]) * f->scale, y = (uv[1] - f->middle[1]) * f->scale;
		const long point[2] = {lround(NT_THUMB_WIDTH / 2 + x),
			lround(NT_THUMB_HEIGHT / 2 + (f->v_down ? y : -y))};
		if (count && point[0] == last[0] && point[1] == last[1])
			continue;
		nt_buffer_format(path, "%s%ld %ld", count++ ? " " : "M", point[0], point[1]);
		last[0] = point[0];
		last[1] = point[1];
	}
	if (count >= 3) {
		nt_buffer_text(path, "z");
		return count;
	}
	path->size = begin;
	return 0;
}

nt_status nt_thumb(const nt_report_geometry *g, bool v_down, nt_buffer paths[2])
{
	if (!g->texcoords || !g->triangle_count)
		return NT_OK;
	const nt_outlined outlined = {g->vertex_count, g->triangle_count, g->indices, g->texcoords,
		g->orientation, g->islands};
	nt_buffer outlines = {0};
	const nt_status status = nt_outline_islands(&outlined, &outlines);
	if (status || outlines.failed) {
		nt_buffer_free(&outlines);
		return NT_ERROR_MEMORY;
	}
	const frame f = fit(g, v_down);
	const unsigned char *at = (const unsigned char *)outlines.data;
	uint32_t region = 0, vertex = 0;
	size_t points = 0;
	for (uint32_t regions = next_varint(&at); regions > 0 && points < MOST_POINTS; regions--) {
		region += next_difference(&at);
		for (uint32_t loops = next_varint(&at); loops > 0; loops--)
			points += put_loop(&f, &at, &vertex, &paths[region & 1]);
	}
	nt_buffer_free(&outlines);
	return paths[0].failed || paths[1].failed ? NT_ERROR_MEMORY : NT_OK;
}

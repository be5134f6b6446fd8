/* SPDX-License-Identifier: MIT */
/*
 * Height maps to normal maps: see image.h. Three rows of heights at a time.
 */
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include "base/memory.h"

static void read_row(const nt_pixels *p, uint32_t y, float *row)
{
	const size_t begin = (size_t)y * p->width;
	const float scale = 1.0f / (float)((1u << p->bits) - 1);
	for (size_t x = 0; x < p->width; x++)
		row[x] = scale * (float)(p->bits == 8 ? ((const uint8_t *)p->samples)[begin + x]
						      : ((const uint16_t *)p->samples)[begin + x]);
}

/* The row or column that is sampled one beyond `last`, or one before 0. */
static uint32_t step(uint32_t i, int by, uint32_t last, bool clamp)
{
	if (by < 0 ? i > 0 : i < last)
		return (uint32_t)((int64_t)i + by);
	return clamp ? i : by < 0 ? last : 0;
}

static void write_pixel(nt_pixels *p, size_t pixel, const double n[3])
{
	const double most = (1u << p->bits) - 1;
	for (int c = 0; c < 3; c++) {
		const unsigned value = (unsigned)floor((n[c] + 1) / 2 * most + 0.5);
		if (p->bits == 8)
			((uint8_t *)p->samples)[3 * pixel + c] = (uint8_t)value;
		else
			((uint16_t *)p->samples)[3 * pixel + c] = (uint16_t)value;
	}
}

nt_status nt_heights_to_normals(const nt_pixels *heights, double height, bool clamp, nt_pixels *normals,
	nt_error *error)
{
	const uint32_t width = heights->width, last = heights->height - 1;
	const double scale = height * width / 2;
	*normals = (nt_pixels){0};
	float *rows = nt_alloc((size_t)width * 3, sizeof *rows);
	nt_status status = rows ? nt_pixels_create(normals, width, heights->height, 3, heights->bits, error)
				: nt_fail_memory(error);
	if (status) {
		free(rows);
		return status;
	}
	float *above = rows, *here = rows + width, *below = rows + 2 * (size_t)width;
	read_row(heights, step(0, -1, last, clamp), above);
	read_row(heights, 0, here);
	for (uint32_t y = 0; y <= last; y++) {
		read_row(heights, step(y, 1, last, clamp), below);
		for (uint32_t x = 0; x < width; x++) {
			const float left = here[step(x, -1, width - 1, clamp)],
				right = here[step(x, 1, width - 1, clamp)];
			const double dx = scale * ((double)right - left), dy = scale * ((double)below[x] - above[x]);
			const double length = sqrt(dx * dx + dy * dy + 1);
			write_pixel(normals, (size_t)y * width + x,
				(const double[]){-dx / length, dy / length, 1 / length});
		}
		float *free_row = above;
		above = here;
		here = below;
		below = free_row;
	}
	free(rows);
	return NT_OK;
}

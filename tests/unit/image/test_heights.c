/* SPDX-License-Identifier: MIT */
/*
 * Heights to normals, by theory: planes are exact.
 */
#include "image/image.h"

#include <math.h>
#include "fail_alloc.h"
#include "test.h"

static nt_pixels make(uint32_t width, uint32_t height, unsigned channels, unsigned bits)
{
	nt_pixels p;
	nt_error error;
	assert_int_equal(nt_pixels_create(&p, width, height, channels, bits, &error), NT_OK);
	memset(p.samples, 0, nt_pixels_row_bytes(&p) * height);
	return p;
}

static nt_pixels convert(nt_pixels *heights, double height, bool clamp)
{
	nt_pixels normals;
	nt_error error;
	assert_int_equal(nt_heights_to_normals(heights, height, clamp, &normals, &error), NT_OK);
	assert_int_equal(normals.width, heights->width);
	assert_int_equal(normals.height, heights->height);
	assert_int_equal(normals.channels, 3);
	assert_int_equal(normals.bits, heights->bits);
	nt_pixels_free(heights);
	return normals;
}

static unsigned at(const nt_pixels *p, uint32_t x, uint32_t y, unsigned c)
{
	const size_t i = ((size_t)y * p->width + x) * 3 + c;
	return p->bits == 8 ? ((uint8_t *)p->samples)[i] : ((uint16_t *)p->samples)[i];
}

/* The colour of (-p, q, 1) normalized: slopes per pixel to the right and down. */
static void assert_slopes(const nt_pixels *normals, uint32_t x, uint32_t y, double p, double q)
{
	const double length = sqrt(p * p + q * q + 1), n[] = {-p / length, q / length, 1 / length};
	for (unsigned c = 0; c < 3; c++)
		assert_int_equal(at(normals, x, y, c), floor((n[c] + 1) / 2 * ((1u << normals->bits) - 1) + 0.5));
}

/* h = 3 x + 2 y of 255 (then of 65535), in an image of 40: s = 40 * height. */
TEST(plane_has_its_exact_normal)
{
	for (unsigned bits = 8; bits <= 16; bits += 8) {
		nt_pixels heights = make(40, 30, 1, bits);
		const unsigned unit = bits == 8 ? 1 : 257;
		for (uint32_t y = 0; y < 30; y++)
			for (uint32_t x = 0; x < 40; x++) {
				const unsigned h = (3 * x + 2 * y) * unit;
				if (bits == 8)
					((uint8_t *)heights.samples)[40 * y + x] = (uint8_t)h;
				else
					((uint16_t *)heights.samples)[40 * y + x] = (uint16_t)h;
			}
		nt_pixels normals = convert(&heights, 0.25, true);
		const double s = 0.25 * 40;
		for (uint32_t y = 1; y < 29; y++)
			for (uint32_t x = 1; x < 39; x++)
				assert_slopes(&normals, x, y, s * 3 / 255, s * 2 / 255);
		/* at a border that is clamped a difference is half as long */
		assert_slopes(&normals, 0, 5, s * 1.5 / 255, s * 2 / 255);
		assert_slopes(&normals, 39, 0, s * 1.5 / 255, s * 1 / 255);
		nt_pixels_free(&normals);
	}
}

/* One bright pixel in a corner is seen from the opposite borders, where the sampler repeats. */
TEST(borders_wrap_as_the_sampler_does)
{
	for (int clamp = 0; clamp <= 1; clamp++) {
		nt_pixels heights = make(8, 4, 1, 8);
		((uint8_t *)heights.samples)[0] = 255;
		nt_pixels normals = convert(&heights, 0.125, clamp);
		assert_slopes(&normals, 1, 0, -0.5, 0);
		assert_slopes(&normals, 0, 1, 0, -0.5);
		assert_slopes(&normals, 7, 0, clamp ? 0 : 0.5, 0);
		assert_slopes(&normals, 0, 3, 0, clamp ? 0 : 0.5);
		assert_slopes(&normals, 0, 0, clamp ? -0.5 : 0, clamp ? -0.5 : 0);
		nt_pixels_free(&normals);
	}
}

TEST(normals_without_memory_are_none)
{
	nt_pixels heights = make(4, 4, 1, 8), normals;
	nt_error error;
	for (size_t n = 0; n < 2; n++) {
		fail_allocations_from(n);
		assert_int_equal(nt_heights_to_normals(&heights, 1, false, &normals, &error), NT_ERROR_MEMORY);
		assert_true(stop_failing_allocations());
		assert_null(normals.samples);
	}
	nt_pixels_free(&heights);
}

/* SPDX-License-Identifier: MIT */
/*
 * Heights to normals, by theory: planes are exact, a hemisphere's normals are its radii, flat is (128, 128, 255).
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

TEST(flat_is_the_neutral_colour)
{
	nt_pixels heights = make(9, 7, 1, 8), wide = make(9, 7, 1, 16);
	memset(heights.samples, 77, 63);
	nt_pixels normals = convert(&heights, 0.5, false), wide_normals = convert(&wide, 0.5, true);
	for (uint32_t i = 0; i < 63; i++) {
		assert_int_equal(at(&normals, i % 9, i / 9, 0), 128);
		assert_int_equal(at(&normals, i % 9, i / 9, 1), 128);
		assert_int_equal(at(&normals, i % 9, i / 9, 2), 255);
		assert_int_equal(at(&wide_normals, i % 9, i / 9, 1), 32768);
		assert_int_equal(at(&wide_normals, i % 9, i / 9, 2), 65535);
	}
	nt_pixels_free(&normals);
	nt_pixels_free(&wide_normals);
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

/* A hemisphere of radius R lit from anywhere looks as its radii say: (dx, -dy, z) / R. Central differences of step 1
 * are wrong by f'''/6, at 0.8 R by 0.8 R^-2 / 0.6^5 / 2, which is 1e-3 for R = 60; 0.004 leaves room for the rounding
 * of colours to 16 bits and for the other direction. */
TEST(hemisphere_relit_is_the_hemisphere)
{
	enum { SIDE = 128, RADIUS = 60 };
	static const double lights[][3] = {{0, 0, 1}, {0.6, 0, 0.8}, {0, 0.6, 0.8}, {-0.48, -0.36, 0.8}};
	nt_pixels heights = make(SIDE, SIDE, 1, 16);
	for (int y = 0; y < SIDE; y++)
		for (int x = 0; x < SIDE; x++) {
			const double dx = x - SIDE / 2, dy = y - SIDE / 2,
				rest = 1 - (dx * dx + dy * dy) / RADIUS / RADIUS;
			((uint16_t *)heights.samples)[y * SIDE + x] =
				(uint16_t)(rest > 0 ? sqrt(rest) * 65535 + 0.5 : 0);
		}
	nt_pixels normals = convert(&heights, (double)RADIUS / SIDE, false);
	double worst = 0;
	for (int y = 0; y < SIDE; y++)
		for (int x = 0; x < SIDE; x++) {
			const double dx = (double)(x - SIDE / 2) / RADIUS, dy = (double)(y - SIDE / 2) / RADIUS;
			const double z = sqrt(fmax(0, 1 - dx * dx - dy * dy));
			if (dx * dx + dy * dy > 0.64)
				continue;
			for (int l = 0; l < 4; l++) {
				const double *light = lights[l];
				double seen = 0;
				for (unsigned c = 0; c < 3; c++)
					seen += (at(&normals, (uint32_t)x, (uint32_t)y, c) / 65535.0 * 2 - 1) *
						light[c];
				worst = fmax(worst, fabs(seen - (dx * light[0] - dy * light[1] + z * light[2])));
			}
		}
	assert_true(worst < 0.004);
	nt_pixels_free(&normals);
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

/* SPDX-License-Identifier: MIT */
/*
 * Channels from image to image, against the formulas of image/pack.h; tests/cli/test_materials.sh has whole images.
 */
#include "image/pack.h"

#include <math.h>
#include "test.h"

static nt_pixels make(uint32_t width, uint32_t height, unsigned channels, unsigned bits)
{
	nt_pixels p;
	nt_error error;
	assert_int_equal(nt_pixels_create(&p, width, height, channels, bits, &error), NT_OK);
	memset(p.samples, 0, nt_pixels_row_bytes(&p) * height);
	return p;
}

static nt_pixels make_row(unsigned channels, const uint8_t *samples, size_t count)
{
	nt_pixels p = make((uint32_t)(count / channels), 1, channels, 8);
	memcpy(p.samples, samples, count);
	return p;
}

/* The channel in `to` of 8 bits, from the first row of `from`. */
static void pack(const nt_pixels *from, nt_channel_map map, nt_pixels *to)
{
	nt_error error;
	assert_int_equal(nt_pack_channel(from, &map, false, to, 0, &error), NT_OK);
}

static const nt_channel_map luminance = {.channel = NT_CHANNEL_LUMINANCE, .gain = 1};

TEST(channels_are_taken)
{
	static const uint8_t rgba[] = {10, 20, 30, 40, 200, 200, 200, 255}, grey[] = {7, 250};
	static const uint8_t expected[][2] = {{10, 200}, {20, 200}, {30, 200}, {40, 255}, {19, 200}};
	nt_pixels color = make_row(4, rgba, sizeof rgba), narrow = make_row(1, grey, sizeof grey),
		to = make(2, 1, 1, 8);
	const uint8_t *out = to.samples;
	for (nt_channel c = NT_CHANNEL_RED; c <= NT_CHANNEL_LUMINANCE; c++) {
		pack(&color, (nt_channel_map){.channel = c, .gain = 1}, &to);
		assert_memory_equal(out, expected[c], 2); /* 0.2126 10 + 0.7152 20 + 0.0722 30 = 18.6 */
		pack(&narrow, (nt_channel_map){.channel = c, .gain = 1}, &to);
		assert_int_equal(out[0], c == NT_CHANNEL_ALPHA ? 255 : 7);
	}
	assert_int_equal(nt_channel_resolve(NT_CHANNEL_OPACITY, &color), NT_CHANNEL_ALPHA);
	((uint8_t *)color.samples)[3] = 255;
	assert_int_equal(nt_channel_resolve(NT_CHANNEL_OPACITY, &color), NT_CHANNEL_LUMINANCE);
	assert_int_equal(nt_channel_resolve(NT_CHANNEL_OPACITY, &narrow), NT_CHANNEL_LUMINANCE);
	nt_pixels_free(&color);
	nt_pixels_free(&narrow);
	nt_pixels_free(&to);
}

TEST(every_sample_becomes_its_number)
{
	nt_pixels from = make(256, 1, 1, 8), to = make(256, 1, 1, 8), wide = make(256, 1, 1, 16);
	for (unsigned v = 0; v < 256; v++)
		((uint8_t *)from.samples)[v] = (uint8_t)v;
	const uint8_t *out = to.samples;
	const uint16_t *wide_out = wide.samples;
	nt_channel_map map = luminance;
	pack(&from, map, &wide);
	for (unsigned v = 0; v < 256; v++)
		assert_int_equal(wide_out[v], 257 * v);
	map.base = 0.25f;
	map.gain = -2;
	pack(&from, map, &to);
	for (unsigned v = 0; v < 256; v++)
		assert_int_equal(out[v], floor(fmax(0.25 - 2.0 * v / 255, 0) * 255 + 0.5));
	map = luminance;
	map.exponent = 30;
	pack(&from, map, &to);
	for (unsigned v = 0; v < 256; v++)
		assert_int_equal(out[v], floor(pow(2 / (2 + 30.0 * v / 255), 0.25) * 255 + 0.5));
	assert_int_equal(out[255], 128); /* a half */
	map = luminance;
	map.srgb = true;
	pack(&from, map, &to);
	assert_int_equal(out[0], 0);
	assert_int_equal(out[55], 128); /* 0.2157 is 0.5019 */
	assert_int_equal(out[255], 255);
	nt_pixels_free(&from);
	nt_pixels_free(&to);
	nt_pixels_free(&wide);
}

TEST(other_sizes_are_bilinear)
{
	static const uint8_t two[] = {0, 100};
	nt_pixels from = make_row(1, two, 2), to = make(4, 1, 1, 8);
	const uint8_t *out = to.samples, repeated[] = {25, 25, 75, 75}, clamped[] = {0, 25, 75, 100};
	nt_error error;
	pack(&from, luminance, &to);
	assert_memory_equal(out, repeated, 4);
	assert_int_equal(nt_pack_channel(&from, &luminance, true, &to, 0, &error), NT_OK);
	assert_memory_equal(out, clamped, 4);
	nt_pixels_free(&from);
	nt_pixels_free(&to);
}

static nt_alpha_mode alpha_of(unsigned low, unsigned middle, unsigned high, unsigned opaque)
{
	nt_pixels p = make(low + middle + high + opaque, 1, 1, 8);
	uint8_t *samples = p.samples;
	memset(samples, 15, low); /* 15/255 is below 1/16 */
	memset(samples + low, 128, middle);
	memset(samples + low + middle, 240, high);
	memset(samples + low + middle + high, 255, opaque);
	const nt_alpha_mode mode = nt_alpha_of(&p);
	nt_pixels_free(&p);
	return mode;
}

TEST(alpha_has_a_mode)
{
	assert_int_equal(alpha_of(0, 0, 0, 100), NT_ALPHA_OPAQUE);
	assert_int_equal(alpha_of(50, 0, 0, 50), NT_ALPHA_MASK);
	assert_int_equal(alpha_of(50, 5, 5, 40), NT_ALPHA_MASK);
	assert_int_equal(alpha_of(50, 6, 4, 40), NT_ALPHA_BLEND);
	assert_int_equal(alpha_of(0, 0, 1, 99), NT_ALPHA_BLEND);
	assert_int_equal(alpha_of(0, 1, 0, 99), NT_ALPHA_BLEND);
}

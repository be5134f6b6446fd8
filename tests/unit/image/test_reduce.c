/* SPDX-License-Identifier: MIT */
/*
 * Small pictures of larger ones whose left half is dark and whose right half is bright.
 */
#include "image/image.h"

#include <stdlib.h>
#include "fail_alloc.h"
#include "test.h"

static nt_pixels make_halves(uint32_t width, uint32_t height, unsigned channels, unsigned bits)
{
	nt_pixels p;
	assert_int_equal(nt_pixels_create(&p, width, height, channels, bits, NULL), NT_OK);
	for (size_t i = 0; i < (size_t)width * height * channels; i++) {
		const unsigned value = i / channels % width < width / 2 ? 40 : 200;
		if (bits == 8)
			((uint8_t *)p.samples)[i] = (uint8_t)value;
		else
			((uint16_t *)p.samples)[i] = (uint16_t)(value * 257);
	}
	return p;
}

static void reduce(const unsigned char *bytes, size_t size, uint32_t most, nt_pixels *small)
{
	unsigned char *jpeg;
	size_t jpeg_size;
	nt_error error;
	assert_int_equal(nt_image_reduce(bytes, size, most, &jpeg, &jpeg_size, &error), NT_OK);
	assert_int_equal(nt_decode_jpeg(jpeg, jpeg_size, UINT32_MAX, small, &error), NT_OK);
	free(jpeg);
}

TEST(reduce_keeps_the_shape_and_the_halves)
{
	static const struct {
		uint32_t width, height, most, small[2];
		unsigned channels, bits;
	} rows[] = {{64, 32, 16, {16, 8}, 3, 8}, {64, 32, 64, {64, 32}, 3, 8}, {33, 90, 30, {11, 30}, 4, 8},
		{40, 40, 16, {16, 16}, 1, 16}, {300, 1, 16, {16, 1}, 3, 8}, {64, 32, 100, {64, 32}, 4, 16}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_pixels whole = make_halves(rows[i].width, rows[i].height, rows[i].channels, rows[i].bits), small;
		unsigned char *png;
		size_t size;
		assert_int_equal(nt_encode_png(&whole, &png, &size, NULL), NT_OK);
		reduce(png, size, rows[i].most, &small);
		assert_int_equal(small.width, rows[i].small[0]);
		assert_int_equal(small.height, rows[i].small[1]);
		assert_int_equal(small.channels, rows[i].channels < 3 ? 1 : 3);
		const uint8_t *samples = small.samples;
		assert_in_range(samples[0], 34, 46);
		assert_in_range(samples[small.channels * (small.width - 1)], 194, 206);
		free(png);
		nt_pixels_free(&whole);
		nt_pixels_free(&small);
	}
}

/* An eighth of a JPEG, a quarter or a half is decoded, then averaged: 400 x 300 to 90 x 67 by way of 100 x 75. */
TEST(reduce_decodes_no_more_of_a_jpeg_than_it_takes)
{
	nt_pixels whole = make_halves(400, 300, 3, 8), small;
	unsigned char *jpeg;
	size_t size;
	nt_error error;
	assert_int_equal(nt_encode_jpeg(&whole, 90, &jpeg, &size, &error), NT_OK);
	assert_int_equal(nt_decode_jpeg_small(jpeg, size, 90, &small, &error), NT_OK);
	assert_int_equal(small.width, 100);
	assert_int_equal(small.height, 75);
	nt_pixels_free(&small);
	reduce(jpeg, size, 90, &small);
	assert_int_equal(small.width, 90);
	assert_int_equal(small.height, 67);
	nt_pixels_free(&small);
	nt_pixels_free(&whole);
	free(jpeg);
}

TEST(reduce_refuses_what_is_no_image_and_lacks_memory)
{
	unsigned char *jpeg;
	size_t size, length;
	nt_error error;
	const unsigned char none[] = "no image";
	assert_int_equal(nt_image_reduce(none, sizeof none, 16, &jpeg, &size, &error), NT_ERROR_UNSUPPORTED);
	assert_null(jpeg);
	/* 8192 x 8193 */
	const unsigned char large[18 + 8192] = {[2] = 2, [13] = 0x20, [14] = 1, [15] = 0x20, [16] = 24};
	assert_int_equal(nt_image_reduce(large, sizeof large, 16, &jpeg, &size, &error), NT_ERROR_UNSUPPORTED);
	assert_string_equal(error.message, "an image of 8192 x 8193 pixels");
	nt_pixels whole = make_halves(64, 64, 3, 8);
	unsigned char *source;
	assert_int_equal(nt_encode_jpeg(&whole, 90, &source, &length, &error), NT_OK);
	nt_pixels_free(&whole);
	assert_int_equal(nt_image_reduce(source, length / 4, 16, &jpeg, &size, &error), NT_ERROR_INPUT);
	assert_null(jpeg);
	nt_status status = NT_ERROR_MEMORY;
	for (size_t n = 0; status; n++) {
		fail_allocations_from(n);
		status = nt_image_reduce(source, length, 16, &jpeg, &size, &error);
		const bool failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		assert_true(failed == !jpeg);
	}
	free(jpeg);
	free(source);
}

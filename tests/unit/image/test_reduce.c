/* SPDX-License-Identifier: MIT */
/*
 * Small pictures of larger ones whose quarters have a grey each.
 */
#include "image/image.h"

#include <stdlib.h>
#include "fail_alloc.h"
#include "test.h"

/* Its quarters: left and right, above and below. */
static const unsigned quarters[2][2] = {{40, 200}, {120, 80}};

static nt_pixels make_quarters(uint32_t width, uint32_t height, unsigned channels, unsigned bits)
{
	nt_pixels p;
	assert_int_equal(nt_pixels_create(&p, width, height, channels, bits, NULL), NT_OK);
	for (size_t i = 0; i < (size_t)width * height * channels; i++) {
		const size_t x = i / channels % width, y = i / channels / width;
		const unsigned value = quarters[y >= (height + 1) / 2][x >= width / 2];
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

TEST(reduce_keeps_the_shape_and_the_quarters)
{
	static const struct {
		uint32_t width, height, most, small[2];
		unsigned channels, bits;
	} rows[] = {{64, 32, 16, {16, 8}, 3, 8}, {64, 32, 64, {64, 32}, 3, 8}, {33, 90, 30, {11, 30}, 4, 8},
		{40, 40, 16, {16, 16}, 1, 16}, {300, 1, 16, {16, 1}, 3, 8}, {64, 32, 100, {64, 32}, 4, 16},
		{1, 300, 16, {1, 16}, 2, 8}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_pixels whole = make_quarters(rows[i].width, rows[i].height, rows[i].channels, rows[i].bits), small;
		unsigned char *png;
		size_t size;
		assert_int_equal(nt_encode_png(&whole, &png, &size, NULL), NT_OK);
		reduce(png, size, rows[i].most, &small);
		assert_int_equal(small.width, rows[i].small[0]);
		assert_int_equal(small.height, rows[i].small[1]);
		assert_int_equal(small.channels, rows[i].channels < 3 ? 1 : 3);
		for (size_t corner = 0; corner < 4; corner++) {
			const size_t x = corner % 2 * (small.width - 1), y = corner / 2 * (small.height - 1);
			const unsigned grey = quarters[y > 0][rows[i].width == 1 || x > 0];
			const uint8_t *samples = small.samples;
			assert_in_range(samples[(y * small.width + x) * small.channels], grey - 6, grey + 6);
		}
		free(png);
		nt_pixels_free(&whole);
		nt_pixels_free(&small);
	}
}

/* Means are rounded; a JPEG of one grey has it exactly. */
TEST(reduce_takes_the_mean)
{
	for (unsigned bright = 1; bright < 4; bright++) { /* of four pixels */
		nt_pixels whole, small;
		unsigned char *png;
		size_t size;
		assert_int_equal(nt_pixels_create(&whole, 32, 32, 1, 8, NULL), NT_OK);
		for (size_t i = 0; i < 32 * 32; i++)
			((uint8_t *)whole.samples)[i] = (uint8_t)(100 + (i % 2 + 2 * (i / 32 % 2) < bright));
		assert_int_equal(nt_encode_png(&whole, &png, &size, NULL), NT_OK);
		reduce(png, size, 16, &small);
		assert_int_equal(((uint8_t *)small.samples)[0], bright < 2 ? 100 : 101);
		free(png);
		nt_pixels_free(&whole);
		nt_pixels_free(&small);
	}
}

/* An eighth of a JPEG, a quarter or a half is decoded, then averaged: 400 x 300 to 90 x 67 by way of 100 x 75. */
TEST(reduce_decodes_no_more_of_a_jpeg_than_it_takes)
{
	nt_pixels whole = make_quarters(400, 300, 3, 8), small;
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
	static const struct {
		unsigned char more; /* than 8192 rows, of a TGA that is 8192 wide */
		size_t size;
		nt_status status;
	} rows[] = {{1, 8210, NT_ERROR_UNSUPPORTED}, {0, 8210, NT_ERROR_INPUT}, {0, 4000, NT_ERROR_UNSUPPORTED}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		const unsigned char large[8210] = {[2] = 2, [13] = 0x20, [14] = rows[i].more, [15] = 0x20, [16] = 24};
		assert_int_equal(nt_image_reduce(large, rows[i].size, 16, &jpeg, &size, &error), rows[i].status);
		assert_true(i != 0 || !strcmp(error.message, "an image of 8192 x 8193 pixels"));
	}
	nt_pixels whole = make_quarters(64, 64, 3, 8);
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

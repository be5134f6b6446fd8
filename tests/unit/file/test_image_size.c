/* SPDX-License-Identifier: MIT */
#include "file/image_size.h"
#include "test.h"

#include <string.h>

static const unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D',
	'R', 0, 0, 1, 2, 0, 0, 3, 4};

/* An APP0 of 4 bytes, a fill byte, a table (C4, which is no frame) of 2, then a progressive frame. */
static const unsigned char jpeg[] = {0xFF, 0xD8, 0xFF, 0xE0, 0, 4, 1, 2, 0xFF, 0xFF, 0xC4, 0, 2, 0xFF, 0xC2, 0,
	17, 8, 0x02, 0x58, 0x03, 0x20, 3};

static void sizes_stand_in_headers(void **state)
{
	(void)state;
	uint32_t pixels[2];
	assert_true(nt_image_size(png, sizeof png, pixels));
	assert_int_equal(pixels[0], 0x102);
	assert_int_equal(pixels[1], 0x304);
	assert_true(nt_image_size(jpeg, sizeof jpeg, pixels));
	assert_int_equal(pixels[0], 0x320);
	assert_int_equal(pixels[1], 0x258);
}

static void what_is_cut_short_or_empty_has_none(void **state)
{
	(void)state;
	uint32_t pixels[2];
	for (size_t size = 0; size < sizeof png; size++)
		assert_false(nt_image_size(png, size, pixels));
	for (size_t size = 0; size < sizeof jpeg - 1; size++) {
		assert_false(nt_image_size(jpeg, size, pixels));
		assert_int_equal(pixels[0] + pixels[1], 0);
	}
	unsigned char flat[sizeof png];
	memcpy(flat, png, sizeof png);
	memset(flat + 20, 0, 4);
	assert_false(nt_image_size(flat, sizeof flat, pixels));
	assert_false(nt_image_size((const unsigned char *)"GIF89a", 6, pixels));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sizes_stand_in_headers),
		cmocka_unit_test(what_is_cut_short_or_empty_has_none),
	};
	return cmocka_run_group_tests_name("file/image_size", tests, NULL, NULL);
}

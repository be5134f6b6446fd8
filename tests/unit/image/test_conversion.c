/* SPDX-License-Identifier: MIT */
/*
 * How one image is put together: what is the image as it is, what is made, and what becomes of damage and exhausted
 * memory.
 */
#include "image/conversion.h"

#include "fail_alloc.h"
#include "test.h"

enum { SIDE = 4, TGA_SIZE = 18 + 3 * SIDE * SIDE };

/* A TGA whose pixels are all of one colour. */
static nt_file make_tga(unsigned char bytes[TGA_SIZE], const unsigned char rgb[3])
{
	memset(bytes, 0, 18);
	bytes[2] = 2;
	bytes[12] = bytes[14] = SIDE;
	bytes[16] = 24;
	bytes[17] = 0x20;
	for (int i = 18; i < TGA_SIZE; i++)
		bytes[i] = rgb[2 - i % 3];
	return nt_file_of_bytes(bytes, TGA_SIZE);
}

static nt_conversion_channel take(uint32_t source, nt_channel channel)
{
	return (nt_conversion_channel){true, source, {.channel = channel, .gain = 1}};
}

/* The result of a conversion of two images, as pixels. */
static nt_pixels make(const nt_conversion *how, const nt_file *a, const nt_file *b, nt_converted *made)
{
	const nt_file *files[4];
	nt_pixels pixels = {0};
	nt_error error;
	nt_error_clear(&error);
	for (int k = 0; k < 4; k++)
		files[k] = how->channels[k].source == 0 ? a : b;
	assert_int_equal(nt_conversion_make(how, files, false, made, &error), NT_OK);
	if (made->bytes)
		assert_int_equal(nt_image_decode(made->bytes, made->size, &pixels, &error), NT_OK);
	free(made->bytes);
	return pixels;
}

TEST(conversions_that_are_an_image)
{
	nt_conversion how = {.packed = true, .channels = {take(3, NT_CHANNEL_RED), take(3, NT_CHANNEL_GREEN),
		take(3, NT_CHANNEL_BLUE)}};
	assert_true(nt_conversion_is_identity(&how));
	const nt_conversion same = how;
	assert_true(nt_conversion_equal(&how, &same));
	assert_true(nt_conversion_hash(&how) == nt_conversion_hash(&same));
	how.channels[1].map.gain = 0.5f;
	assert_false(nt_conversion_is_identity(&how));
	assert_false(nt_conversion_equal(&how, &same));
	how.channels[1] = take(3, NT_CHANNEL_RED);
	assert_false(nt_conversion_is_identity(&how));
	how.channels[1] = take(4, NT_CHANNEL_GREEN);
	assert_false(nt_conversion_is_identity(&how));
	how.channels[1].used = false;
	assert_true(nt_conversion_is_identity(&how));
}

TEST(channels_come_from_their_images)
{
	unsigned char first[TGA_SIZE], second[TGA_SIZE];
	const nt_file a = make_tga(first, (const unsigned char[]){10, 20, 30}),
		b = make_tga(second, (const unsigned char[]){40, 50, 60});
	const nt_conversion how = {.packed = true, .channels = {take(1, NT_CHANNEL_BLUE), take(0, NT_CHANNEL_GREEN),
		{.used = true, .source = UINT32_MAX}, take(1, NT_CHANNEL_RED)}};
	nt_converted made;
	nt_pixels p = make(&how, &a, &b, &made);
	const unsigned char expected[] = {60, 20, 255, 40};
	assert_int_equal(p.channels, 4);
	assert_memory_equal(p.samples, expected, 4);
	assert_int_equal(made.alpha, NT_ALPHA_BLEND);
	nt_pixels_free(&p);
}

TEST(what_is_grey_is_stored_as_grey)
{
	unsigned char bytes[TGA_SIZE];
	const nt_file a = make_tga(bytes, (const unsigned char[]){77, 77, 77});
	const nt_conversion how = {.packed = true, .channels = {{.source = UINT32_MAX}, take(0, NT_CHANNEL_LUMINANCE)}};
	nt_converted made;
	nt_pixels p = make(&how, &a, NULL, &made);
	assert_int_equal(p.channels, 1);
	assert_int_equal(*(unsigned char *)p.samples, 77);
	nt_pixels_free(&p);
}

TEST(a_damaged_image_makes_its_channels_white)
{
	unsigned char first[TGA_SIZE], second[TGA_SIZE];
	const nt_file a = make_tga(first, (const unsigned char[]){10, 20, 30});
	nt_file b = make_tga(second, (const unsigned char[]){40, 50, 60});
	b.size = 20;
	const nt_conversion how = {.packed = true, .channels = {take(0, NT_CHANNEL_BLUE), take(1, NT_CHANNEL_GREEN)}};
	nt_converted made;
	nt_pixels p = make(&how, &a, &b, &made);
	assert_int_equal(made.damaged, 2);
	const unsigned char expected[] = {30, 255, 255};
	assert_memory_equal(p.samples, expected, 3);
	nt_pixels_free(&p);
	const nt_conversion lost = {.packed = true, .channels = {take(1, NT_CHANNEL_BLUE)}};
	const nt_file *const files[4] = {&b};
	nt_error error;
	assert_int_equal(nt_conversion_make(&lost, files, false, &made, &error), NT_ERROR_INPUT);
	assert_null(made.bytes);
}

TEST(conversions_without_memory_are_an_error)
{
	unsigned char first[TGA_SIZE], second[TGA_SIZE];
	const nt_file a = make_tga(first, (const unsigned char[]){10, 20, 30}),
		b = make_tga(second, (const unsigned char[]){40, 50, 60});
	const nt_file *const files[4] = {&a, &a, &b, &b};
	const nt_conversion how = {.packed = true, .channels = {take(0, NT_CHANNEL_GREEN), take(0, NT_CHANNEL_RED),
		take(1, NT_CHANNEL_GREEN), take(1, NT_CHANNEL_LUMINANCE)}};
	for (size_t n = 0, failed = 1; failed; n++) {
		nt_converted made;
		nt_error error;
		fail_allocations_from(n);
		const nt_status status = nt_conversion_make(&how, files, false, &made, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		free(made.bytes);
	}
}

/* SPDX-License-Identifier: MIT */
/*
 * The images of an output: who shares what, and files that are not what they were. tests/cli/test_textures.sh has what
 * is made of them.
 */
#include "image/textures.h"

#include <unistd.h>
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

/* A TGA of 4 x 4 pixels of this colour. */
static void put_tga(const char *name, unsigned blue, unsigned green, unsigned red)
{
	unsigned char tga[18 + 48] = {[2] = 2, [12] = 4, [14] = 4, [16] = 24, [17] = 0x20};
	for (size_t i = 18; i < sizeof tga; i += 3) {
		tga[i] = (unsigned char)blue;
		tga[i + 1] = (unsigned char)green;
		tga[i + 2] = (unsigned char)red;
	}
	put_file(name, tga, sizeof tga);
}

static uint32_t request(nt_textures *textures, const char *name, nt_texture_kind kind, double height)
{
	static char document[300];
	snprintf(document, sizeof document, "%s", in_folder("m.mtl"));
	const nt_image_places places = {.document = document};
	const nt_texture_request what = {.kind = kind, .height = height, .clamp = height > 0.15,
		.channels = {{.name = name, .map = {.channel = NT_CHANNEL_LUMINANCE, .gain = 1}}}};
	uint32_t number;
	nt_error error;
	assert_int_equal(nt_textures_request(textures, &places, &what, &number, &error), NT_OK);
	return number;
}

static const nt_texture *result(const nt_textures *textures, uint32_t number)
{
	return nt_textures_at(textures, nt_textures_result(textures, number));
}

static nt_status make(nt_textures *textures, bool judged_only, nt_error *error)
{
	const nt_texture_rules rules = {.threads = 2, .judged_only = judged_only};
	return nt_textures_make(textures, &rules, error);
}

/* A normal map is the same at any height, a height map is not, but when nobody takes its pixels. */
TEST(equal_results_are_made_once)
{
	put_tga("grey.tga", 9, 9, 9);
	put_tga("n.tga", 255, 128, 128);
	for (int judged = 0; judged < 2; judged++) {
		nt_textures *t = nt_textures_create(NULL);
		nt_error error;
		const uint32_t n1 = request(t, "n.tga", NT_TEXTURE_NORMALS_OR_HEIGHTS, 0.1),
			       n2 = request(t, "./n.tga", NT_TEXTURE_NORMALS_OR_HEIGHTS, 0.2),
			       n3 = request(t, "n.tga", NT_TEXTURE_COLOR, 0),
			       h1 = request(t, "grey.tga", NT_TEXTURE_NORMALS_OR_HEIGHTS, 0.1),
			       h2 = request(t, "grey.tga", NT_TEXTURE_NORMALS_OR_HEIGHTS, 0.2),
			       h3 = request(t, "grey.tga", NT_TEXTURE_HEIGHTS, 0.2),
			       color = request(t, "grey.tga", NT_TEXTURE_COLOR, 0);
		assert_int_equal(make(t, judged, &error), NT_OK);
		assert_ptr_equal(result(t, n1), result(t, n2));
		assert_ptr_equal(result(t, n1), result(t, n3));
		assert_int_equal(result(t, h1) == result(t, h2), judged);
		assert_ptr_equal(result(t, h2), result(t, h3));
		assert_int_equal(nt_textures_count(t), 4 - judged);
		assert_true(result(t, h1)->from_heights);
		assert_false(result(t, color)->from_heights);
		assert_string_equal(result(t, h1)->name, "grey-normal.png");
		assert_string_equal(result(t, color)->name, "grey.png");
		assert_int_equal(result(t, n1)->type, NT_IMAGE_PNG);
		nt_textures_free(t);
	}
}

/* A grey TGA of noise, whose PNG is larger than 256 KB; where no file can be had, it stays in memory. */
TEST(large_results_are_in_a_file)
{
	enum { SIDE = 600, BYTES = 18 + SIDE * SIDE };
	static unsigned char tga[BYTES] = {[2] = 3, [12] = SIDE % 256, [13] = SIDE / 256, [14] = SIDE % 256,
		[15] = SIDE / 256, [16] = 8, [17] = 0x20};
	char here[300], nowhere[300];
	uint32_t noise = 1;
	for (size_t i = 18; i < BYTES; i++) {
		noise = noise * 1664525 + 1013904223;
		tga[i] = (unsigned char)(noise >> 24);
	}
	put_file("noise.tga", tga, BYTES);
	snprintf(here, sizeof here, "%s", in_folder("out.glb"));
	snprintf(nowhere, sizeof nowhere, "%s", in_folder("none/out.glb"));
	const char *const beside[] = {here, nowhere, NULL};
	for (size_t i = 0; i < 3; i++) {
		nt_textures *t = nt_textures_create(beside[i]);
		nt_error error;
		const uint32_t number = request(t, "noise.tga", NT_TEXTURE_COLOR, 0);
		assert_int_equal(make(t, false, &error), NT_OK);
		const nt_texture *texture = result(t, number);
		assert_true(texture->size > 256 * 1024);
		assert_int_equal(texture->mapped, i == 0);
		nt_texture_release_pages(texture);
		nt_pixels pixels;
		assert_int_equal(nt_image_decode(texture->bytes, texture->size, &pixels, &error), NT_OK);
		assert_memory_equal(pixels.samples, tga + 18, SIDE * SIDE);
		nt_pixels_free(&pixels);
		nt_textures_free(t);
	}
}

TEST(file_that_is_not_what_it_was_is_an_error)
{
	for (int how = 0; how < 4; how++) {
		put_tga("n.tga", 255, 128, 128);
		put_text_file("n.png", "\211PNG\r\n\032\n and more");
		put_tga("other.tga", 255, 128, 128);
		nt_textures *t = nt_textures_create(NULL);
		nt_error error;
		/* of a PNG only whether it is grey is looked at */
		if (how == 3)
			request(t, "n.png", NT_TEXTURE_NORMALS_OR_HEIGHTS, 0);
		else
			request(t, "n.tga", NT_TEXTURE_COLOR, 0);
		char other[300];
		snprintf(other, sizeof other, "%s", in_folder("other.tga"));
		const int done = how == 0 ? truncate(in_folder("n.tga"), 40)
			: how == 1 ? rename(other, in_folder("n.tga"))
			: how == 2 ? unlink(in_folder("n.tga")) : truncate(in_folder("n.png"), 10);
		assert_int_equal(done, 0);
		assert_int_equal(make(t, false, &error), how == 2 ? NT_ERROR_MISSING : NT_ERROR_IO);
		assert_true(how == 2 || strstr(error.message, "changed"));
		nt_textures_free(t);
	}
}

/* Requests an image by a name, while allocations fail. */
static void request_with_few_allocations(const char *name, nt_image_found found)
{
	const nt_image_places places = {.document = in_folder("m.mtl")};
	const nt_texture_request what = {.kind = NT_TEXTURE_NORMALS_OR_HEIGHTS, .height = 0.1,
		.channels = {{.name = name, .map = {.channel = NT_CHANNEL_LUMINANCE, .gain = 1}}}};
	const nt_texture_rules rules = {.threads = 1};
	for (size_t n = 0, rounds = 2; rounds; n++) { /* one fails alone, or all from there on */
		nt_textures *t = nt_textures_create(NULL);
		uint32_t number;
		nt_error error;
		(n % 2 ? fail_allocation : fail_allocations_from)(n / 2);
		nt_status status = nt_textures_request(t, &places, &what, &number, &error);
		if (!status)
			status = nt_textures_make(t, &rules, &error);
		const bool failed = stop_failing_allocations();
		rounds = failed ? 2 : rounds - 1;
		/* a folder is looked into twice where nobody could keep which it is */
		assert_true(status == NT_OK || (status == NT_ERROR_MEMORY && failed));
		if (!status)
			assert_int_equal(nt_textures_source(t, number, 0)->found, found);
		nt_textures_free(t);
	}
}

TEST(textures_without_memory_are_an_error)
{
	put_tga("grey.tga", 9, 9, 9);
	request_with_few_allocations("grey.tga", NT_IMAGE_FOUND);
	request_with_few_allocations("C:\\gone\\GREY.tga", NT_IMAGE_FOUND_ELSEWHERE);
	request_with_few_allocations("Grey.TGA", NT_IMAGE_FOUND_ELSEWHERE);
}

AROUND_ALL(make_folder, remove_folder)

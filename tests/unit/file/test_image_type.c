/* SPDX-License-Identifier: MIT */
#include "file/input.h"
#include "test.h"

static nt_image_type type_of(const char *bytes, size_t size)
{
	return nt_image_type_of_bytes((const unsigned char *)bytes, size);
}

TEST(type_is_told_by_signature)
{
	static const struct {
		const char *bytes;
		size_t size;
		nt_image_type type;
	} rows[] = {{"\x89PNG\r\n\x1a\n", 8, NT_IMAGE_PNG}, {"\x89PNG\r\n\x1a\n", 7, NT_IMAGE_OTHER},
		{"\xff\xd8\xff\xe0", 4, NT_IMAGE_JPEG}, {"\xabKTX 20\xbb\r\n\x1a\n", 12, NT_IMAGE_KTX2},
		{"\xabKTX 11\xbb\r\n\x1a\n", 12, NT_IMAGE_OTHER}, {"RIFF\0\0\0\0WEBP", 12, NT_IMAGE_WEBP},
		{"RIFF\0\0\0\0WAVE", 12, NT_IMAGE_OTHER}, {"BM\0\0", 4, NT_IMAGE_BMP}, {"II*\0", 4, NT_IMAGE_TIFF},
		{"MM\0*", 4, NT_IMAGE_TIFF}, {"#?RADIANCE\n", 11, NT_IMAGE_HDR}, {"8BPS", 4, NT_IMAGE_PSD},
		{"\x76\x2f\x31\x01", 4, NT_IMAGE_EXR}, {"", 0, NT_IMAGE_OTHER}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		assert_int_equal(type_of(rows[i].bytes, rows[i].size), rows[i].type);
}

TEST(type_of_a_tga_is_told_by_its_header)
{
	/* of 4 x 4 pixels of 24 bits; one byte and another are changed */
	static const struct {
		unsigned char at, value, and_at, and_value;
		nt_image_type type;
	} rows[] = {{2, 2, 2, 2, NT_IMAGE_TGA}, {2, 10, 2, 10, NT_IMAGE_TGA}, {2, 0, 2, 0, NT_IMAGE_OTHER},
		{2, 4, 2, 4, NT_IMAGE_OTHER}, {2, 18, 2, 18, NT_IMAGE_OTHER}, {2, 3, 16, 8, NT_IMAGE_TGA},
		{2, 11, 16, 16, NT_IMAGE_TGA}, {1, 1, 1, 1, NT_IMAGE_TGA}, {1, 2, 1, 2, NT_IMAGE_OTHER},
		/* with a colour map */
		{2, 1, 16, 8, NT_IMAGE_OTHER}, {2, 1, 1, 1, NT_IMAGE_OTHER}, {2, 9, 2, 9, NT_IMAGE_OTHER},
		/* width and height, bits of a pixel, order */
		{12, 0, 12, 0, NT_IMAGE_OTHER}, {14, 0, 14, 0, NT_IMAGE_OTHER}, {12, 0, 13, 1, NT_IMAGE_TGA},
		{14, 0, 15, 1, NT_IMAGE_TGA}, {16, 15, 16, 15, NT_IMAGE_TGA}, {16, 32, 16, 32, NT_IMAGE_TGA},
		{16, 25, 16, 25, NT_IMAGE_OTHER}, {17, 0x20, 17, 0x20, NT_IMAGE_TGA},
		{17, 0x40, 17, 0x40, NT_IMAGE_OTHER}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		char header[18] = {[2] = 2, [12] = 4, [14] = 4, [16] = 24};
		header[rows[i].at] = (char)rows[i].value;
		header[rows[i].and_at] = (char)rows[i].and_value;
		assert_int_equal(type_of(header, 18), rows[i].type);
		assert_int_equal(type_of(header, 17), NT_IMAGE_OTHER);
		/* with a map whose indices have 8, 15 or 16 bits */
		header[1] = 1, header[2] = 9;
		header[12] = header[14] = 4;
		header[17] = 0;
		assert_int_equal(type_of(header, 18), header[16] <= 16 ? NT_IMAGE_TGA : NT_IMAGE_OTHER);
	}
}

TEST(type_of_a_name_is_its_ending_in_any_case)
{
	static const struct {
		const char *name;
		nt_image_type type;
	} rows[] = {{"a.b/c.PNG", NT_IMAGE_PNG}, {"c.jpg", NT_IMAGE_JPEG}, {"c.Jpeg", NT_IMAGE_JPEG},
		{"c.ktx2", NT_IMAGE_KTX2}, {"c.ktx", NT_IMAGE_OTHER}, {"c.webp", NT_IMAGE_WEBP}, {"c.", NT_IMAGE_OTHER},
		{"c.tga", NT_IMAGE_TGA}, {"c.TIF", NT_IMAGE_TIFF}, {"c.xcf", NT_IMAGE_OTHER}, {"png", NT_IMAGE_OTHER}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		assert_int_equal(nt_image_type_of_name(rows[i].name), rows[i].type);
}

TEST(core_types_need_no_extension)
{
	assert_null(nt_image_extension(NT_IMAGE_PNG));
	assert_null(nt_image_extension(NT_IMAGE_JPEG));
	assert_string_equal(nt_image_extension(NT_IMAGE_KTX2), "KHR_texture_basisu");
	assert_string_equal(nt_image_extension(NT_IMAGE_WEBP), "EXT_texture_webp");
	assert_string_equal(nt_image_media_type(NT_IMAGE_JPEG), "image/jpeg");
	assert_null(nt_image_media_type(NT_IMAGE_OTHER));
	assert_true(nt_image_is_carried(NT_IMAGE_WEBP));
	assert_false(nt_image_is_carried(NT_IMAGE_TGA));
}

static const unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D',
	'R', 0, 0, 1, 2, 0, 0, 3, 4};

/* An APP0 of 4 bytes, a fill byte, a table (C4, which is no frame) of 2, then a progressive frame. */
static const unsigned char jpeg[] = {0xFF, 0xD8, 0xFF, 0xE0, 0, 4, 1, 2, 0xFF, 0xFF, 0xC4, 0, 2, 0xFF, 0xC2, 0,
	17, 8, 0x02, 0x58, 0x03, 0x20, 3};

TEST(sizes_stand_in_headers)
{
	uint32_t pixels[2];
	assert_true(nt_image_size(png, sizeof png, pixels));
	assert_int_equal(pixels[0], 0x102);
	assert_int_equal(pixels[1], 0x304);
	assert_true(nt_image_size(jpeg, sizeof jpeg, pixels));
	assert_int_equal(pixels[0], 0x320);
	assert_int_equal(pixels[1], 0x258);
}

/* 3 wide, 2 high */
TEST(sizes_of_all_formats)
{
	static const struct {
		const char *bytes;
		size_t size;
	} rows[] = {
#define ROW(text) {text, sizeof text - 1}
		ROW("\0\0\2\0\0\0\0\0\0\0\0\0\3\0\2\0\30\0"),
		ROW("BM    \0\0\0\0    \50\0\0\0\3\0\0\0\2\0\0\0"),
		ROW("BM    \0\0\0\0    \50\0\0\0\3\0\0\0\376\377\377\377"), /* from the top */
		ROW("BM    \0\0\0\0    \14\0\0\0\3\0\2\0\1\0\1\0"),
		ROW("8BPS\0\1\0\0\0\0\0\0\0\3\0\0\0\2\0\0\0\3\0\10"),
		ROW("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 3\n"),
		ROW("II*\0\10\0\0\0\2\0\0\1\3\0\1\0\0\0\3\0\0\0\1\1\4\0\1\0\0\0\2\0\0\0"),
		ROW("RIFF    WEBPVP8     \20\0\0\235\1\52\3\0\2\0"),
		ROW("RIFF    WEBPVP8L    \57\2\100\0\0"),
		ROW("RIFF    WEBPVP8X    \0\0\0\0\2\0\0\1\0\0"),
		ROW("MM\0*\0\0\0\10\0\2\1\0\0\3\0\0\0\1\0\3\0\0\1\1\0\4\0\0\0\1\0\0\0\2"),
	};
	uint32_t pixels[2];
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		assert_true(nt_image_size((const unsigned char *)rows[i].bytes, rows[i].size, pixels));
		assert_int_equal(pixels[0], 3);
		assert_int_equal(pixels[1], 2);
		/* in a block of its own, so that a sanitizer sees what is read behind it */
		for (size_t size = 0; size < rows[i].size; size++) {
			unsigned char *cut = malloc(size + !size);
			memcpy(cut, rows[i].bytes, size);
			nt_image_size(cut, size, pixels);
			free(cut);
		}
	}
}

TEST(what_is_cut_short_or_empty_has_none)
{
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

/* SPDX-License-Identifier: MIT */
/*
 * Version 1 of the vertex codec and the colour filter, as streams that were made by hand from the text of
 * KHR_meshopt_compression. test_meshopt FILE compares what is in FILE with what another decoder made of it: for each
 * view a line "MODE FILTER STRIDE COUNT PACKED_BYTES", the packed bytes, and the others. tests/support/meshopt.mjs
 * writes such files.
 */
#include "test.h"
#include "base/text.h"
#include "ext/meshopt.h"

enum { MOST = 4096 };

/* A stream of version 1 in a block of its size, so that a sanitizer sees what is read behind it. */
static nt_status decode(const unsigned char *packed, size_t size, size_t stride, size_t count, const char *filter,
	unsigned char *bytes)
{
	unsigned char *copy = malloc(size ? size : 1);
	nt_error error;
	const nt_meshopt_view view = {
		.mode = "ATTRIBUTES", .filter = filter, .stride = stride, .count = count, .packed_size = size};
	nt_status status = nt_meshopt_check(&view, stride * count, "", &error);
	memcpy(copy, packed, size);
	if (!status)
		status = nt_meshopt_unpack(&view, copy, bytes, "", &error);
	free(copy);
	return status;
}

/* 16 elements of 4 bytes. The first byte has the text's example of 4 bits: control mode 1, group mode 2. The second is
 * literal, the third zero, the fourth in 1 bit with one that is not 0: control mode 0, group mode 1. The tail is padded
 * to 24 bytes and ends with an element before the first and the channel's mode. */
static const unsigned char example[] = {0xA1, 1 | 3 << 2 | 2 << 4 | 0 << 6, 2, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9,
	0x21, 0x00, 0x34, 0xb5, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0x00, 0x80, 200, 0, 0, 0, 0, 0,
	0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 100, 10, 20, 30, 0};

TEST(bytes_follow_the_example_of_the_text)
{
	(void)state;
	static const int deltas[16] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
	unsigned char bytes[64];
	assert_int_equal(decode(example, sizeof example, 4, 16, "NONE", bytes), NT_OK);
	unsigned char first = 100;
	for (int i = 0; i < 16; i++) {
		first = (unsigned char)(first + deltas[i]);
		assert_int_equal(bytes[4 * i], first);
		assert_int_equal(bytes[4 * i + 1], i < 15 ? 11 : 10); /* 2 is +1, 1 is -1 */
		assert_int_equal(bytes[4 * i + 2], 20);
		assert_int_equal(bytes[4 * i + 3], i < 15 ? 30 : 130); /* 200 is +100 */
	}
}

/* All four bytes literal, two elements. 0x0102 is +129, 0x0101 is -129. */
TEST(channels_have_modes)
{
	(void)state;
	static const struct {
		unsigned char mode;
		unsigned char expected[8]; /* the bytes before them are 1, 0, 0xFF, 0x80 */
		bool refused;
	} cases[] = {
		{1, {0x82, 0, 0xFF + 0x81 - 256, 0x81, 1, 0, 0xFF, 0x80}, false},
		{2, {3, 1, 0xFD, 0x81, 2, 0, 0xFC, 0x80}, false},
		/* by 12 bits to the right: 0x01020102 becomes 0x10201020, 0x01010101 0x10101010 */
		{0xC2, {0x21, 0x10, 0xDF, 0x90, 0x31, 0, 0xCF, 0x80}, false},
		{3, {0}, true},
		{0x10, {0}, true},
		{0x11, {0}, true},
	};
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		const unsigned char packed[] = {0xA1, 0xFF, 2, 1, 1, 1, 2, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
			0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0xFF, 0x80, cases[i].mode};
		unsigned char bytes[8];
		assert_int_equal(decode(packed, sizeof packed, 4, 2, "NONE", bytes),
			cases[i].refused ? NT_ERROR_INPUT : NT_OK);
		if (!cases[i].refused)
			assert_memory_equal(bytes, cases[i].expected, 8);
	}
}

/* A stream that is cut, longer or damaged is refused or gives something; 17 elements need a second group. */
TEST(what_is_damaged_is_refused)
{
	(void)state;
	unsigned char bytes[128], damaged[sizeof example + 1] = {0};
	for (size_t size = 0; size < sizeof example; size++)
		assert_int_equal(decode(example, size, 4, 16, "NONE", bytes), NT_ERROR_INPUT);
	memcpy(damaged, example, sizeof example);
	assert_int_equal(decode(damaged, sizeof damaged, 4, 16, "NONE", bytes), NT_ERROR_INPUT);
	assert_int_equal(decode(example, sizeof example, 4, 17, "NONE", bytes), NT_ERROR_INPUT);
	for (size_t i = 0; i < 8 * sizeof example; i++) {
		memcpy(damaged, example, sizeof example);
		damaged[i / 8] ^= (unsigned char)(1u << i % 8);
		decode(damaged, sizeof example, 4, 16, "COLOR", bytes);
	}
}

/* All deltas of a block are zero: its control bytes are all there is of it. */
TEST(equal_elements_take_next_to_nothing)
{
	(void)state;
	enum { BLOCKS = 200 };
	static unsigned char packed[1 + 8 * BLOCKS + 40], bytes[8192 * BLOCKS];
	memset(packed, 0xAA, sizeof packed);
	packed[0] = 0xA1;
	memset(packed + sizeof packed - 40, 7, 32);
	memset(packed + sizeof packed - 8, 0, 8);
	assert_int_equal(decode(packed, sizeof packed, 32, 256 * BLOCKS, "NONE", bytes), NT_OK);
	assert_int_equal(bytes[0], 7);
	assert_int_equal(bytes[sizeof bytes - 1], 7);
	assert_int_equal(decode(packed, sizeof packed, 32, 256 * BLOCKS * 2, "NONE", bytes), NT_ERROR_INPUT);
}

/* In 4 bits (alpha in 3, below a 1): Y 7, Co 4, Cg -3 are R 14, G 4, B 6; 17 times as much of 255. Alpha 5 is 11. */
TEST(colours_are_turned_back)
{
	(void)state;
	const unsigned char packed[] = {
		0xA1, 0xAA, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 4, 0xFD, 8 | 5, 0};
	const unsigned char wide[] = {
		0xA1, 0xAA, 0xAA, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 0, 4, 0, 0xFD, 0xFF, 8 | 5, 0, 0, 0};
	const unsigned char expected[4] = {14 * 17, 4 * 17, 6 * 17, 11 * 17};
	unsigned char bytes[8];
	assert_int_equal(decode(packed, sizeof packed, 4, 1, "COLOR", bytes), NT_OK);
	assert_memory_equal(bytes, expected, 4);
	assert_int_equal(decode(wide, sizeof wide, 8, 1, "COLOR", bytes), NT_OK);
	for (int k = 0; k < 4; k++) /* 65535 is 15 times 4369 */
		assert_int_equal(bytes[2 * k] | bytes[2 * k + 1] << 8, expected[k] / 17 * 4369);
}

/* The largest component is 1, its number in the last two bits: of 0, 0, 0 and 0x7ffd it is the second. */
TEST(filters_want_their_strides)
{
	(void)state;
	const unsigned char turned[] = {
		0xA1, 0xAA, 0xAA, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFD, 0x7F, 0, 0};
	const unsigned char expected[8] = {[2] = 0xFF, [3] = 0x7F};
	static const struct {
		const char *filter;
		size_t stride;
	} refused[] = {{"QUATERNION", 4}, {"OCTAHEDRAL", 12}, {"COLOR", 12}, {"OTHER", 8}};
	unsigned char bytes[12];
	assert_int_equal(decode(turned, sizeof turned, 8, 1, "QUATERNION", bytes), NT_OK);
	assert_memory_equal(bytes, expected, 8);
	for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
		const size_t controls = refused[i].stride / 4;
		unsigned char packed[1 + 3 + 24] = {0xA1};
		memset(packed + 1, 0xAA, controls);
		assert_int_equal(decode(packed, 25 + controls, refused[i].stride, 1, refused[i].filter, bytes),
			NT_ERROR_UNSUPPORTED);
	}
}

/* Triangles may begin with another corner. */
TEST(lists_of_indices_come_back)
{
	(void)state;
	static const uint32_t indices[] = {0, 1, 2, 2, 1, 3, 70, 3, 1, 500, 70, 3};
	for (int k = 0; k < 4; k++) {
		const bool triangles = k % 2, narrow = k / 2;
		const nt_meshopt_view view = {triangles ? "TRIANGLES" : "INDICES", "NONE", narrow ? 2 : 4, 12, 0};
		uint32_t wide[12];
		uint16_t list[24];
		unsigned char *packed;
		nt_error error;
		memcpy(list, indices, sizeof indices);
		for (size_t i = 0; i < 12 && narrow; i++)
			list[i] = (uint16_t)indices[i];
		nt_meshopt_view back = view;
		size_t size;
		assert_int_equal(nt_meshopt_pack(&view, (unsigned char *)list, &packed, &size, &error), NT_OK);
		back.packed_size = size;
		memset(list, 0, sizeof list);
		assert_int_equal(nt_meshopt_unpack(&back, packed, (unsigned char *)list, "", &error), NT_OK);
		memcpy(wide, list, sizeof wide);
		for (size_t i = 0; i < 12 && narrow; i++)
			wide[i] = list[i];
		for (size_t t = 0; t < 12; t += 3) {
			const size_t turn = !triangles || wide[t] == indices[t] ? 0 : wide[t] == indices[t + 1] ? 1 : 2;
			for (size_t i = 0; i < 3; i++)
				assert_int_equal(wide[t + i], indices[t + (i + turn) % 3]);
		}
		free(packed);
	}
}

/* ---- what others make of views ---- */

/* The text lets filters differ by one in the last place of integers. */
static bool is_near(const nt_meshopt_view *v, const unsigned char *a, const unsigned char *b)
{
	const size_t size = (size_t)(v->stride * v->count), width = v->stride == 4 ? 1 : 2;
	if (strcmp(v->filter, "NONE") == 0 || strcmp(v->filter, "EXPONENTIAL") == 0)
		return memcmp(a, b, size) == 0;
	bool near = true;
	for (size_t i = 0; near && i < size; i += width) {
		const int x = width == 1 ? a[i] : a[i] | a[i + 1] << 8,
			  y = width == 1 ? b[i] : b[i] | b[i + 1] << 8;
		const int most = width == 1 ? 255 : 65535, apart = (x - y) & most;
		near = apart <= 1 || apart == most;
	}
	return near;
}

static int compare_views(int argument_count, char **arguments)
{
	(void)argument_count;
	FILE *f = fopen(arguments[1], "rb");
	char mode[32], filter[32];
	unsigned long long stride, count, packed;
	size_t views = 0, version_1 = 0, bad = 0;
	while (f && fscanf(f, "%31s %31s %llu %llu %llu", mode, filter, &stride, &count, &packed) == 5 &&
		fgetc(f) == '\n') {
		const nt_meshopt_view view = {mode, filter, stride, count, packed};
		const size_t size = (size_t)(stride * count);
		unsigned char *from = malloc(packed), *expected = malloc(size), *bytes = malloc(size);
		nt_error error = {0};
		const bool there = from && expected && bytes && fread(from, 1, packed, f) == packed &&
				   fread(expected, 1, size, f) == size;
		const bool good = there && nt_meshopt_check(&view, size, "", &error) == NT_OK &&
				  nt_meshopt_unpack(&view, from, bytes, "", &error) == NT_OK &&
				  is_near(&view, bytes, expected);
		if (!good)
			printf("view %zu: %s %s, %llu of %llu bytes: %s\n", views, mode, filter, count, stride,
				error.message);
		views++;
		version_1 += there && packed && from[0] == 0xA1;
		bad += !good;
		free(from);
		free(expected);
		free(bytes);
	}
	if (f)
		fclose(f);
	printf("%zu views, %zu of version 1, %zu differ\n", views, version_1, bad);
	return bad || !views;
}

WITH_ARGUMENTS(compare_views)

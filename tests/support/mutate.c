/* SPDX-License-Identifier: MIT */
/*
 * Damaged files: see mutate.h. Most of the damage is to text, because a wrong number in it leads into
 * geometry, where a wrong byte is mostly one wrong coordinate.
 */
#include "mutate.h"

#include <stdbool.h>
#include <string.h>

uint32_t mutate_random(uint32_t *seed, uint32_t limit)
{
	*seed = *seed * 1664525u + 1013904223u;
	return limit ? (uint32_t)((uint64_t)(*seed >> 4) * limit >> 28) : 0;
}

#define ONE_OF(list) (list)[mutate_random(seed, sizeof(list) / sizeof *(list))]

/* Bytes [begin, end) are replaced by others. Returns the new size. */
static size_t splice(char *file, size_t size, size_t begin, size_t end, const char *by)
{
	const size_t length = strlen(by);
	memmove(file + begin + length, file + end, size - end);
	memcpy(file + begin, by, length);
	return size - (end - begin) + length;
}

static bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

static bool is_number_character(char c)
{
	return is_digit(c) || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

/* Exchanges a number of the text [begin, end). */
static size_t mutate_number(char *file, size_t size, size_t begin, size_t end, bool json, uint32_t *seed)
{
	static const char *const numbers[] = {"0", "-1", "1", "2", "3", "4", "5", "6", "7", "12", "36", "255",
		"65535", "65536", "4294967295", "4294967296", "9007199254740993", "18446744073709551615",
		"18446744073709551616", "1e308", "0.5", "-0", "5121", "5123", "5125", "5126"};
	static const char *const values[] = {"null", "\"x\"", "[]", "{}"};
	static const char *const words[] = {"nan", "-inf", "1e-45", "3.5e38", "-2147483648", "", "//", "1/1/1"};
	size_t at = begin + mutate_random(seed, (uint32_t)(end - begin));
	while (at < end && !is_digit(file[at]))
		at++;
	size_t from = at, to = at;
	while (from > begin && is_number_character(file[from - 1]))
		from--;
	while (to < end && is_number_character(file[to]))
		to++;
	if (to == from)
		return size;
	const char *by = mutate_random(seed, 8) ? ONE_OF(numbers) : json ? ONE_OF(values) : ONE_OF(words);
	return splice(file, size, from, to, by);
}

/* Exchanges a string of the JSON. */
static size_t mutate_string(char *file, size_t size, size_t begin, size_t end, uint32_t *seed)
{
	static const char *const strings[] = {"\"\"", "\"../../../etc/passwd\"", "\"/etc/passwd\"",
		"\"C:\\\\x\"", "\"file:///etc/passwd\"", "\"a\\u0000b\"", "\"data:;base64,AAAA\"",
		"\"data:,x\"", "\"../canary.bin\"", "\"%2e%2e/canary.bin\"", "\"link/canary.bin\"", "\"x.gltf\"",
		"\"SCALAR\"", "\"VEC2\"", "\"VEC3\"", "\"MAT4\"", "\"POSITION\"", "\"TEXCOORD_0\"", "\"indices\"",
		"\"sparse\"", "\"bufferView\"", "\"byteOffset\"", "\"extensions\"", "\"byteStride\"",
		"[[[[[[[[]]]]]]]]", "7"};
	size_t at = begin + mutate_random(seed, (uint32_t)(end - begin));
	while (at < end && file[at] != '"')
		at++;
	size_t to = at + 1;
	while (to < end && file[to] != '"')
		to++;
	return to < end ? splice(file, size, at, to + 1, ONE_OF(strings)) : size;
}

static size_t load_u32(const char *file, size_t at)
{
	size_t value = 0;
	for (size_t i = 4; i-- > 0;)
		value = value << 8 | (unsigned char)file[at + i];
	return value;
}

static void store_u32(char *file, size_t at, size_t value)
{
	for (size_t i = 0; i < 4; i++)
		file[at + i] = (char)(value >> 8 * i);
}

/* A number or a string of the JSON; most of the time the lengths of a container follow, so that the
 * damage itself is met. */
static size_t mutate_json(char *file, size_t size, uint32_t *seed)
{
	const bool glb = size > 20 && memcmp(file, "glTF", 4) == 0;
	const size_t before = size, begin = glb ? 20 : 0;
	size_t length = glb ? load_u32(file, 12) : size;
	if (length > size - begin)
		length = size - begin;
	size = mutate_random(seed, 4) ? mutate_number(file, size, begin, begin + length, true, seed)
				      : mutate_string(file, size, begin, begin + length, seed);
	if (glb && size > 20 && mutate_random(seed, 16)) {
		store_u32(file, 8, size);
		store_u32(file, 12, length + size - before);
	}
	return size;
}

/* A number, or a whole word, of the text before the binary part; 0: the file has none. */
static size_t text_length(const char *file, size_t size)
{
	static const char end[] = "end_header";
	if (size < 3 || memcmp(file, "ply", 3) != 0)
		return memchr(file, '\0', size < 4096 ? size : 4096) ? 0 : size;
	for (size_t i = 0; i + sizeof end - 1 <= size; i++)
		if (memcmp(file + i, end, sizeof end - 1) == 0)
			return i + sizeof end - 1;
	return size;
}

static size_t mutate_word(char *file, size_t size, size_t length, uint32_t *seed)
{
	static const char *const words[] = {"f", "v", "vt", "vn", "usemtl", "list", "property", "element",
		"uchar", "char", "double", "int", "x", "nx", "s", "vertex_indices", "texcoord", "face", "vertex",
		"f -1 -2 -3\n", "\\\n", "#", "\n", "1/", "/1", "tristrips", "binary_big_endian"};
	const size_t begin = mutate_random(seed, (uint32_t)length);
	size_t end = begin;
	while (end < length && !strchr(" \t\r\n", file[end]))
		end++;
	return splice(file, size, begin, end, ONE_OF(words));
}

size_t mutate(char *file, size_t size, uint32_t *seed)
{
	const size_t begin = mutate_random(seed, (uint32_t)size);
	size_t end = begin + mutate_random(seed, 40);
	const bool json = file[0] == '{' || (size > 20 && memcmp(file, "glTF", 4) == 0);
	const size_t text = json ? 0 : text_length(file, size);
	switch (mutate_random(seed, 10)) {
	case 0: /* a byte anywhere */
		file[begin] = (char)mutate_random(seed, 256);
		return size;
	case 1: /* the end or a piece is missing */
		if (mutate_random(seed, 2) || end > size)
			end = size;
		return splice(file, size, begin, end, "");
	default:
		if (json)
			return mutate_json(file, size, seed);
		if (text == 0) { /* a byte; of the head, half of the time */
			const uint32_t range = (uint32_t)(size > 64 && mutate_random(seed, 2) ? 64 : size);
			file[mutate_random(seed, range)] = (char)mutate_random(seed, 256);
			return size;
		}
		return mutate_random(seed, 3) ? mutate_number(file, size, 0, text, false, seed)
					      : mutate_word(file, size, text, seed);
	}
}

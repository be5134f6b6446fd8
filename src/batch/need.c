/* SPDX-License-Identifier: MIT */
/*
 * Guesses of memory: see need.h. Upper estimates for ordinary files; soups of unshared triangles need up to 7x.
 * Measured with --verify and a report. By format, beside a megabyte:
 *
 *   OBJ        10 for each byte (ordinary files 1 to 7, corners that all differ 25)
 *   PLY        2 for each byte and 96 for each element that the header declares (50; 500)
 *   glTF, GLB  12 for each byte of JSON, 1 for each other byte, and 40 for each "count" in the JSON, which is that of
 *              accessors, wherever their bytes are (30; 105); 100 where there is or will be Draco (98; 207)
 *   Draco      256 for each byte (20 to 190)
 *
 * as "make bench-need" prints it. An OBJ's images that are converted are in need_images.c. Images that a report
 * examines, polygons of many corners, and instances that become one PLY are not seen.
 */
#include "batch/need.h"

#include <string.h>
#include <sys/stat.h>

#include "file/input.h"
#include "file/lookup.h"
#include "format/format.h"

/* Of any run, and of any byte of a format that has all its bytes in one file. */
enum { LEAST = 1 << 20, MOST_BYTE_COST = 256 };

/* sum + cost * count; UINT64_MAX where that overflows: counts come from the file. */
static uint64_t plus(uint64_t sum, uint64_t cost, uint64_t count)
{
	uint64_t product;
	return __builtin_mul_overflow(cost, count, &product) || __builtin_add_overflow(sum, product, &sum)
		? UINT64_MAX : sum;
}

/* A number after a key and what may stand between them; 0: none. */
static uint64_t number_after(const char *text, const char *end, const char *between)
{
	uint64_t number = 0;
	while (text < end && strchr(between, *text) && *text)
		text++;
	for (; text < end && *text >= '0' && *text <= '9'; text++)
		number = plus((uint64_t)(*text - '0'), 10, number);
	return number;
}

/* "element vertex 12" */
static uint64_t ply_need(const char *text, size_t size)
{
	static const char end_header[] = "end_header", element[] = "\nelement ";
	enum { MOST_HEADER = 1 << 16 };
	const size_t looked_at = size < MOST_HEADER ? size : MOST_HEADER;
	const char *header_end = memmem(text, looked_at, end_header, sizeof end_header - 1);
	const char *end = header_end ? header_end : text + looked_at, *at = text;
	uint64_t elements = 0;
	while ((at = memmem(at, (size_t)(end - at), element, sizeof element - 1))) {
		at += sizeof element - 1;
		const char *name_end = memchr(at, ' ', (size_t)(end - at));
		if (!name_end)
			break;
		elements = plus(elements, 1, number_after(name_end, end, " "));
		at = name_end;
	}
	return plus(2 * (uint64_t)size, 96, elements);
}

static uint64_t gltf_need(const char *text, size_t json_size, size_t size, const nt_settings *settings)
{
	static const char count[] = "\"count\"", draco[] = "KHR_draco_mesh_compression";
	const char *const end = text + json_size;
	const bool compressed = settings->draco == NT_DRACO_AS_SEQUENTIAL ||
		settings->draco == NT_DRACO_AS_EDGEBREAKER || memmem(text, json_size, draco, sizeof draco - 1);
	uint64_t counts = 0;
	for (const char *at = text; (at = memmem(at, (size_t)(end - at), count, sizeof count - 1));) {
		at += sizeof count - 1;
		counts = plus(counts, 1, number_after(at, end, ": \t\r\n"));
	}
	return plus(12 * (uint64_t)json_size + (size - json_size), compressed ? 100 : 40, counts);
}

static uint64_t need_of_bytes(const nt_file *file, const char *path, const nt_settings *settings)
{
	const char *text = (const char *)file->data;
	const nt_format_entry *entry = nt_format_of_input(file->data, file->size, path);
	switch (entry ? entry->format : NT_FORMAT_UNKNOWN) {
	case NT_FORMAT_OBJ:
		return plus(10 * (uint64_t)file->size, 1, nt_need_of_images(path, text, file->size, settings));
	case NT_FORMAT_PLY:
		return ply_need(text, file->size);
	case NT_FORMAT_GLTF:
		return gltf_need(text, file->size, file->size, settings);
	case NT_FORMAT_GLB: {
		/* the JSON is the first chunk */
		enum { HEAD = 20, LENGTH_AT = 12 };
		if (file->size < HEAD)
			return 0;
		const unsigned char *b = file->data + LENGTH_AT;
		const size_t length = b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
		const size_t rest = file->size - HEAD;
		return gltf_need(text + HEAD, length < rest ? length : rest, rest, settings);
	}
	default:
		return MOST_BYTE_COST * (uint64_t)file->size;
	}
}

uint64_t nt_need_of(const char *input, const nt_settings *settings, uint64_t enough)
{
	struct stat info;
	nt_file file;
	nt_error error; /* the run meets it again */
	if (strcmp(input, "-") == 0)
		return UINT64_MAX;
	if (stat(input, &info) != 0)
		return 0;
	if (!S_ISREG(info.st_mode))
		return UINT64_MAX;
	const nt_format_entry *named = nt_format_of_path(input);
	const bool whole = named && named->format != NT_FORMAT_GLTF && named->format != NT_FORMAT_OBJ;
	if (whole && LEAST + MOST_BYTE_COST * (uint64_t)info.st_size <= enough)
		return LEAST + MOST_BYTE_COST * (uint64_t)info.st_size;
	if (nt_file_open_untraced(&file, input, &error))
		return 0;
	const uint64_t need = plus(LEAST, 1, need_of_bytes(&file, input, settings));
	nt_file_close(&file);
	return need;
}

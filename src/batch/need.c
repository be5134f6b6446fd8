/* SPDX-License-Identifier: MIT */
/*
 * Guesses of memory: see need.h. Upper estimates, but for what says less of itself than it holds.
 * Measured with --verify and a report. By format, beside a megabyte:
 *
 *   OBJ        2 for each byte, 60 for each corner of a face, 140 for each vertex that these may be (30 to 65, with
 *              vertices that all differ 190), 2300 for each change of material or object
 *   PLY        2 for each byte and 140 for each element that the header declares (50; 135 if all triangles collapse,
 *              as --origin=keep makes them; 500)
 *   glTF, GLB  12 for each byte of JSON, 1 for each other byte, and 46 for each "count" in the JSON, which is that of
 *              accessors, wherever their bytes are (30; 105); 112 where there is or will be Draco (98; 207); and 20
 *              for each element of a morph target, however many share an accessor (13), 60 with --verify (48)
 *   Draco      1 for each byte, and by the header 120 for each triangle and 190 for each vertex (210 for one of each)
 *
 * as "make bench-need" prints it. --weld takes no more: a soup of 320 000 triangles 78 MB instead of 164, a grid the
 * same 44. Doubles of an origin are within what counts for vertices: a grid takes 81 MB instead of 59 as OBJ, where 228
 * are expected, 65 and 66 as PLY. An OBJ's images that are converted are in need_images.c. Images that a report
 * examines, polygons of many corners, and instances that become one PLY are not seen.
 */
#include "batch/need.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "file/input.h"
#include "file/lookup.h"
#include "format/format.h"

/* Bytes for any run, and for each byte of a format that has all its bytes in one file. */
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
	return plus(2 * (uint64_t)size, 140, elements);
}

/* ---- morph targets ---- */

/* A walk through JSON that nobody has checked: its strings and brackets. */
typedef struct walk {
	const char *at, *end;
	int depth; /* of brackets around `at` */
} walk;

/* Goes to the next key, or to the end of brackets below `depth`: false. */
static bool next_key(walk *w, int depth, const char **key, size_t *length)
{
	while (w->at < w->end && w->depth >= depth) {
		const char c = *w->at++;
		w->depth += (c == '{' || c == '[') - (c == '}' || c == ']');
		if (c != '"')
			continue;
		*key = w->at;
		while (w->at < w->end && *w->at != '"')
			w->at += 1 + (*w->at == '\\');
		*length = w->at < w->end ? (size_t)(w->at - *key) : 0;
		w->at += w->at < w->end;
		while (w->at < w->end && strchr(" \t\r\n", *w->at) && *w->at)
			w->at++;
		if (w->at < w->end && *w->at == ':')
			return true;
	}
	return false;
}

static bool is_key(const char *key, size_t length, const char *name)
{
	return length == strlen(name) && memcmp(key, name, length) == 0;
}

/* The elements that morph targets have, once for each target that has them: targets may share an accessor. */
static uint64_t target_elements(const char *text, const char *end)
{
	enum { ROOT = 1, ACCESSOR = 3 };
	uint64_t *counts = NULL, sum = 0;
	size_t count = 0, capacity = 0, length;
	const char *key;
	bool known = true;
	for (walk w = {text, end, 0}; known && next_key(&w, w.at == text ? 0 : ROOT, &key, &length);) {
		if (w.depth != ROOT || !is_key(key, length, "accessors"))
			continue;
		/* an accessor without a count is none, and its file is refused */
		while (known && next_key(&w, ROOT + 1 - (w.depth == ROOT), &key, &length)) {
			if (w.depth < ACCESSOR)
				break;
			known = w.depth != ACCESSOR || !is_key(key, length, "count") ||
				nt_grow((void **)&counts, &capacity, count + 1, sizeof *counts);
			if (known && w.depth == ACCESSOR && is_key(key, length, "count"))
				counts[count++] = number_after(w.at, end, ": \t\r\n");
		}
	}
	for (walk w = {text, end, 0}; known && next_key(&w, 0, &key, &length);) {
		if (!is_key(key, length, "targets"))
			continue;
		const int depth = w.depth;
		while (next_key(&w, depth, &key, &length) && w.depth > depth)
			if (is_key(key, length, "POSITION") || is_key(key, length, "NORMAL")) {
				const uint64_t index = number_after(w.at, end, ": \t\r\n");
				sum = plus(sum, 1, index < count ? counts[index] : 0);
			}
	}
	free(counts);
	return sum;
}

static uint64_t gltf_need(const char *text, size_t json_size, size_t size, const nt_settings *settings)
{
	const uint64_t target_cost = settings->verify ? 60 : 20;
	static const char count[] = "\"count\"", target[] = "\"targets\"", draco[] = "KHR_draco_mesh_compression";
	const char *const end = text + json_size;
	const bool compressed = settings->draco == NT_DRACO_AS_SEQUENTIAL ||
		settings->draco == NT_DRACO_AS_EDGEBREAKER || memmem(text, json_size, draco, sizeof draco - 1);
	uint64_t counts = 0;
	for (const char *at = text; (at = memmem(at, (size_t)(end - at), count, sizeof count - 1));) {
		at += sizeof count - 1;
		counts = plus(counts, 1, number_after(at, end, ": \t\r\n"));
	}
	const bool bakes = settings->morphs == NT_MORPH_BAKE && memmem(text, json_size, target, sizeof target - 1);
	const uint64_t need = plus(12 * (uint64_t)json_size + (size - json_size), compressed ? 112 : 46, counts);
	return plus(need, target_cost, bakes ? target_elements(text, end) : 0);
}

/* ---- OBJ ---- */

/* Beginnings of lines of an OBJ. */
typedef struct obj_counts {
	uint64_t corners, positions, texcoords, normals, changes;
} obj_counts;

static void count_line(obj_counts *counts, const char *line, const char *end)
{
	const char first = line < end ? *line : '\0', second = line + 1 < end ? line[1] : '\0';
	counts->positions += first == 'v' && second == ' ';
	counts->texcoords += first == 'v' && second == 't';
	counts->normals += first == 'v' && second == 'n';
	counts->changes += first == 'u' || first == 'o';
	for (const char *c = line; first == 'f' && c + 1 < end; c++)
		counts->corners += c[0] == ' ' && c[1] > ' ';
}

/* Whole lines of a part of the text. */
static void count_lines(obj_counts *counts, const char *text, size_t size)
{
	const char *end = text + size, *next;
	for (const char *line = text; (next = memchr(line, '\n', (size_t)(end - line))); line = next + 1)
		count_line(counts, line, next);
}

/* Counts as many parts of a large file as tell what is in it. */
static uint64_t obj_need(const char *text, size_t size)
{
	enum { PARTS = 64, PART = 1 << 16 };
	obj_counts counts = {0};
	const bool whole = size <= (size_t)PARTS * PART;
	for (size_t i = 0; i < PARTS && !whole; i++)
		count_lines(&counts, text + (size - PART) / (PARTS - 1) * i, PART);
	if (whole)
		count_lines(&counts, text, size);
	const double scale = whole ? 1.0 : (double)size / (PARTS * (double)PART);
	const double corners = scale * (double)counts.corners;
	double vertices = scale * (double)counts.positions;
	vertices *= counts.texcoords ? scale * (double)counts.texcoords : 1.0;
	vertices *= counts.normals ? scale * (double)counts.normals : 1.0;
	if (vertices > corners)
		vertices = corners;
	const double changes = scale * (double)counts.changes;
	return (uint64_t)(2.0 * (double)size + 60.0 * corners + 140.0 * vertices + 2300.0 * changes);
}

/* ---- Draco ---- */

/* A number of 7 bits a byte, the last of them below 128; 0 where it does not end. */
static uint64_t varint_at(const unsigned char **at, const unsigned char *end)
{
	uint64_t number = 0;
	for (unsigned shift = 0; *at < end && shift < 35; shift += 7) {
		const unsigned char byte = *(*at)++;
		number |= (uint64_t)(byte & 127) << shift;
		if (byte < 128)
			return number;
	}
	return 0;
}

/* By the header of a block of version 2.2 without metadata, which is what encoders have written since 2018: method 0 is
 * sequential (faces, points), 1 edgebreaker (a byte, vertices, faces). Counts other formats by their bytes. */
static uint64_t draco_need(const unsigned char *bytes, size_t size)
{
	enum { HEAD = 11, MAJOR = 5, MINOR = 6, TYPE = 7, METHOD = 8, FLAGS = 10, MESH = 1, METADATA = 128 };
	if (size < HEAD || memcmp(bytes, "DRACO", 5) != 0 || bytes[MAJOR] != 2 || bytes[MINOR] != 2 ||
		bytes[TYPE] != MESH || bytes[METHOD] > 1 || (bytes[FLAGS] & METADATA))
		return MOST_BYTE_COST * (uint64_t)size;
	const unsigned char *at = bytes + HEAD + bytes[METHOD], *end = bytes + size;
	const uint64_t first = varint_at(&at, end), second = varint_at(&at, end);
	const uint64_t faces = bytes[METHOD] ? second : first, vertices = bytes[METHOD] ? first : second;
	return size + 120 * faces + 190 * vertices;
}

/* Counts all blocks among the bytes of a GLB: its JSON may say less of them than they do. */
static uint64_t blocks_need(const unsigned char *bytes, size_t size)
{
	const unsigned char *end = bytes + size;
	uint64_t need = 0;
	for (const unsigned char *at = bytes; (at = memmem(at, (size_t)(end - at), "DRACO", 5)); at += 5) {
		enum { MOST_HEAD = 32 };
		const size_t left = (size_t)(end - at);
		need = plus(need, 1, draco_need(at, left < MOST_HEAD ? left : MOST_HEAD));
	}
	return need;
}

static uint64_t need_of_bytes(const nt_file *file, const char *path, const nt_settings *settings)
{
	const char *text = (const char *)file->data;
	const nt_format_entry *entry = nt_format_of_input(file->data, file->size, path);
	switch (entry ? entry->format : NT_FORMAT_UNKNOWN) {
	case NT_FORMAT_OBJ:
		return plus(obj_need(text, file->size), 1, nt_need_of_images(path, text, file->size, settings));
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
		const uint64_t said = gltf_need(text + HEAD, length < rest ? length : rest, rest, settings);
		const uint64_t blocks = length < rest ? blocks_need(file->data + HEAD + length, rest - length) : 0;
		return said > blocks ? said : blocks;
	}
	default:
		return draco_need(file->data, file->size);
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
	const bool whole = named && named->format != NT_FORMAT_GLTF && named->format != NT_FORMAT_OBJ &&
		named->format != NT_FORMAT_DRC;
	if (whole && LEAST + MOST_BYTE_COST * (uint64_t)info.st_size <= enough)
		return LEAST + MOST_BYTE_COST * (uint64_t)info.st_size;
	if (nt_file_open_untraced(&file, input, &error))
		return 0;
	const uint64_t need = plus(LEAST, 1, need_of_bytes(&file, input, settings));
	nt_file_close(&file);
	return need;
}

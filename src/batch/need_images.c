/* SPDX-License-Identifier: MIT */
/*
 * Memory that an OBJ's images take while they are converted: 6 bytes for each pixel of the largest ones, as many as are
 * converted at a time. The names are those of a glance: the material library that the head of the OBJ names, in its
 * folder, and the last word of lines that begin as maps do. Images that glTF carries as they are count where channels
 * or heights are made of them.
 */
#include "batch/need.h"

#include <string.h>
#include <strings.h>

#include "base/buffer.h"
#include "base/parallel.h"
#include "file/image_type.h"
#include "file/input.h"
#include "file/relative_path.h"

enum { HEAD_BYTES = 64 << 10, LIBRARY_BYTES = 1 << 20, MOST_MAPS = 1000, MOST_AT_ONCE = 16, PIXEL_BYTES = 6 };

/* The file that a word names below the folder of another; its path is appended to `name`. */
static bool open_beside(nt_file *file, nt_buffer *name, const char *path, const char *word, size_t length)
{
	nt_error ignored;
	const char *slash = strrchr(path, '/');
	const size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
	nt_buffer_append(name, path, folder);
	nt_buffer_append(name, word, length);
	for (size_t i = folder; i < name->size && !name->failed; i++)
		if (name->data[i] == '\\')
			name->data[i] = '/';
	if (!length || name->failed || nt_link_is_absolute(name->data + folder) || strstr(name->data + folder, ".."))
		return false;
	return nt_file_open_referred(file, name->data, &ignored) == NT_OK;
}

static bool begins(const char *at, const char *end, const char *word)
{
	return (size_t)(end - at) > strlen(word) && strncasecmp(at, word, strlen(word)) == 0;
}

/* Puts the pixels of an image among the most, in falling order. */
static void add_image(uint64_t most[MOST_AT_ONCE], const char *library, const char *word, size_t length, bool colors)
{
	nt_file file;
	nt_buffer path = {0};
	uint32_t sides[2];
	const bool opened = open_beside(&file, &path, library, word, length);
	nt_buffer_free(&path);
	if (!opened)
		return;
	nt_image_size(file.data, file.size, sides);
	uint64_t pixels = (uint64_t)sides[0] * sides[1];
	if (colors && nt_image_is_carried(nt_image_type_of_bytes(file.data, file.size)))
		pixels = 0;
	nt_file_close(&file);
	for (size_t i = 0; i < MOST_AT_ONCE; i++)
		if (pixels > most[i]) {
			const uint64_t less = most[i];
			most[i] = pixels;
			pixels = less;
		}
}

static void add_library(uint64_t most[MOST_AT_ONCE], const nt_file *file, const char *path)
{
	const char *at = (const char *)file->data,
		*const end = at + (file->size < LIBRARY_BYTES ? file->size : LIBRARY_BYTES);
	size_t maps = 0;
	while (at < end && maps < MOST_MAPS) {
		const char *line_end = memchr(at, '\n', (size_t)(end - at)), *stop = line_end ? line_end : end;
		while (at < stop && (*at == ' ' || *at == '\t'))
			at++;
		const char *last = stop;
		while (last > at && strchr(" \t\r", last[-1]))
			last--;
		const char *word = last;
		while (word > at && word[-1] != ' ' && word[-1] != '\t')
			word--;
		const bool colors = begins(at, stop, "map_K");
		if (colors || begins(at, stop, "map_") || begins(at, stop, "bump") || begins(at, stop, "norm")) {
			add_image(most, path, word, (size_t)(last - word), colors);
			maps++;
		}
		at = stop + 1;
	}
}

uint64_t nt_need_of_images(const char *input, const char *text, size_t size, const nt_settings *settings)
{
	static const char keyword[] = "mtllib ";
	const size_t looked_at = size < HEAD_BYTES ? size : HEAD_BYTES;
	const char *at = memmem(text, looked_at, keyword, sizeof keyword - 1);
	uint64_t most[MOST_AT_ONCE] = {0}, pixels = 0;
	nt_file library;
	if (!at || settings->images == NT_IMAGES_NONE || settings->output_format == NT_FORMAT_PLY)
		return 0;
	at += sizeof keyword - 1;
	nt_buffer path = {0};
	size_t length = 0;
	while (at + length < text + looked_at && at[length] != '\n' && at[length] != '\r')
		length++;
	if (open_beside(&library, &path, input, at, length)) {
		add_library(most, &library, path.data);
		nt_file_close(&library);
	}
	nt_buffer_free(&path);
	const unsigned threads = nt_thread_count(settings->threads);
	for (size_t i = 0; i < MOST_AT_ONCE && i < threads; i++)
		pixels += most[i];
	return PIXEL_BYTES * pixels;
}

/* SPDX-License-Identifier: MIT */
/*
 * Texts: UTF-8, and errors with a place. Messages are cut at the size of their field; nothing here
 * allocates, so that "out of memory" can always be said.
 */
#include "base/text.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- UTF-8 ---- */

size_t nt_utf8_length(const char *text, size_t size)
{
	const unsigned char *p = (const unsigned char *)text;
	if (p[0] < 0x80)
		return 1;
	const size_t length = p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
	if (p[0] < 0xc2 || p[0] > 0xf4 || length > size)
		return 0;
	for (size_t i = 1; i < length; i++)
		if ((p[i] & 0xc0) != 0x80)
			return 0;
	const bool overlong = (p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xf0 && p[1] < 0x90);
	const bool surrogate = p[0] == 0xed && p[1] > 0x9f;
	const bool beyond = p[0] == 0xf4 && p[1] > 0x8f;
	return overlong || surrogate || beyond ? 0 : length;
}

bool nt_utf8_is_unsafe(const char *text, size_t length)
{
	const unsigned char *p = (const unsigned char *)text;
	if (length < 2)
		return length == 0 || p[0] < 0x20 || p[0] == 0x7f;
	if (length == 2)
		return p[0] == 0xc2 && p[1] < 0xa0;
	const uint32_t code = length == 3 ? (p[0] & 0xfu) << 12 | (p[1] & 0x3fu) << 6 | (p[2] & 0x3fu) : 0;
	return (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) || code == 0xfffe ||
	       code == 0xffff;
}

size_t nt_utf8_cut(const char *text, size_t most)
{
	const size_t longest = 4;
	return nt_utf8_cut_of(text, strnlen(text, most + longest - 1), most);
}

size_t nt_utf8_cut_of(const char *text, size_t length, size_t most)
{
	for (size_t back = 1; length > most && back < 4 && back <= most; back++)
		if (nt_utf8_length(text + most - back, length - most + back) > back)
			return most - back;
	return length < most ? length : most;
}

void nt_utf8_keep_end(char *to, size_t room, const char *text)
{
	static const char dots[] = "...";
	const size_t length = strlen(text);
	const char *end = length < room ? text : text + length - room + sizeof dots;
	while (end > text && (*end & 0xc0) == 0x80)
		end++;
	snprintf(to, room, "%s%s", end > text ? dots : "", end);
}

void nt_utf8_format(char *to, size_t room, const char *format, va_list arguments)
{
	const int wanted = vsnprintf(to, room, format, arguments);
	if (wanted < 0 || (size_t)wanted < room)
		return;
	size_t begin = room - 1; /* of the last sequence */
	for (int back = 0; back < 3 && begin > 0 && (to[begin - 1] & 0xc0) == 0x80; back++)
		begin--;
	const unsigned char lead = begin > 0 ? (unsigned char)to[begin - 1] : 0;
	if (lead >= 0xc2 && lead <= 0xf4 && !nt_utf8_length(to + begin - 1, SIZE_MAX))
		to[begin - 1] = '\0';
}

void nt_utf8_mask(char *text)
{
	for (size_t length; *text; text += length) {
		length = nt_utf8_length(text, SIZE_MAX);
		const bool unsafe = nt_utf8_is_unsafe(text, length);
		length = length ? length : 1;
		if (unsafe)
			memset(text, '?', length);
	}
}

/* ---- errors ---- */

void nt_place_clear(nt_place *place)
{
	memset(place, 0, sizeof *place);
	place->offset = NT_NO_OFFSET;
}

nt_place_view nt_view_place(const nt_place *place)
{
	return (nt_place_view){place->file, place->pointer, place->object, place->line, place->offset};
}

void nt_error_clear(nt_error *error)
{
	error->status = NT_OK;
	error->message[0] = '\0';
	nt_place_clear(&error->place);
}

static void fill(nt_error *error, nt_status status, const char *format, va_list arguments)
{
	nt_error_clear(error);
	error->status = status;
	nt_utf8_format(error->message, sizeof error->message, format, arguments);
}

nt_status nt_fail(nt_error *error, nt_status status, const char *format, ...)
{
	if (error) {
		va_list arguments;
		va_start(arguments, format);
		fill(error, status, format, arguments);
		va_end(arguments);
	}
	return status;
}

nt_status nt_fail_line(nt_error *error, nt_status status, size_t line, const char *format, ...)
{
	if (error) {
		va_list arguments;
		va_start(arguments, format);
		fill(error, status, format, arguments);
		va_end(arguments);
		error->place.line = line;
	}
	return status;
}

nt_status nt_fail_offset(nt_error *error, nt_status status, uint64_t offset, const char *format,
	...)
{
	if (error) {
		va_list arguments;
		va_start(arguments, format);
		fill(error, status, format, arguments);
		va_end(arguments);
		error->place.offset = offset;
	}
	return status;
}

nt_status nt_fail_pointer(nt_error *error, nt_status status, const char *pointer,
	const char *format, ...)
{
	if (error) {
		va_list arguments;
		va_start(arguments, format);
		fill(error, status, format, arguments);
		va_end(arguments);
		snprintf(error->place.pointer, sizeof error->place.pointer, "%s", pointer);
	}
	return status;
}

nt_status nt_fail_file(nt_error *error, nt_status status, const char *file, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	fill(error, status, format, arguments);
	va_end(arguments);
	return nt_error_in_file(error, file);
}

nt_status nt_fail_memory(nt_error *error)
{
	return nt_fail(error, NT_ERROR_MEMORY, "out of memory");
}

nt_status nt_fail_memory_limit(uint64_t most_bytes, nt_error *error)
{
	static const char *const units[] = {"", "K", "M"};
	unsigned unit = 0;
	for (; unit < 2 && most_bytes && most_bytes % 1024 == 0; unit++)
		most_bytes /= 1024;
	return nt_fail(error, NT_ERROR_LIMIT, "--max-memory=%llu%s is not enough", (unsigned long long)most_bytes,
		units[unit]);
}

nt_status nt_error_in_file(nt_error *error, const char *file)
{
	if (!error->place.file[0])
		nt_utf8_keep_end(error->place.file, sizeof error->place.file, file);
	return error->status;
}

nt_status nt_error_in_output(nt_error *error, const char *file)
{
	return nt_error_in_file(error, strcmp(file, "-") == 0 ? "standard output" : file);
}

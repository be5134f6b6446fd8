/* SPDX-License-Identifier: MIT */
/*
 * Errors with a place: see text.h. Messages are cut at the size of their field; nothing here
 * allocates, so that "out of memory" can always be said.
 */
#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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

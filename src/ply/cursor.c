/* SPDX-License-Identifier: MIT */
/*
 * Moving through the body of a PLY file: rows that nobody wants are skipped, counts are checked against
 * what is left, errors get their place. A row of an ASCII body is a line; blank lines between rows do
 * not count.
 */
#include "ply/cursor.h"

#include <stdarg.h>
#include <stdio.h>

size_t ply_line_of(const ply_cursor *cursor, const unsigned char *at)
{
	size_t line = cursor->body_line;
	for (const unsigned char *p = cursor->body; p < at; p++)
		line += *p == '\n' || (*p == '\r' && !(p + 1 < cursor->end && p[1] == '\n'));
	return line;
}

nt_status ply_fail_at(const ply_cursor *cursor, const unsigned char *at, nt_error *error,
	const char *format, ...)
{
	char message[sizeof error->message];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(message, sizeof message, format, arguments);
	va_end(arguments);
	if (cursor->encoding == PLY_ASCII)
		return nt_fail_line(error, NT_ERROR_INPUT, ply_line_of(cursor, at), "%s", message);
	return nt_fail_offset(error, NT_ERROR_INPUT, (uint64_t)(at - cursor->begin), "%s", message);
}

nt_status ply_fail_end(const ply_cursor *cursor, const ply_element *element, size_t row, nt_error *error)
{
	return ply_fail_at(cursor, cursor->at, error, "the file ends where %s %zu of %zu was expected", element->name,
		row, element->count);
}

const char *ply_show(const ply_cursor *cursor, const unsigned char *at, char text[40])
{
	size_t length = 0;
	while (length < 30 && at + length < cursor->end && !ply_is_space(at[length]))
		length++;
	if (at == cursor->end)
		return strcpy(text, "the end of the file");
	if (length == 0)
		return strcpy(text, "the end of the line");
	text[0] = '"';
	for (size_t i = 0; i < length; i++)
		text[1 + i] = at[i] >= 0x20 && at[i] < 0x7f ? (char)at[i] : '?';
	text[1 + length] = '"';
	text[2 + length] = '\0';
	return text;
}

void ply_next_row(ply_cursor *cursor)
{
	while (cursor->at < cursor->end && ply_is_space(*cursor->at))
		cursor->at++;
}

nt_status ply_check_row_end(const ply_cursor *cursor, const ply_element *element, size_t row,
	nt_error *error)
{
	if (cursor->at == cursor->end || ply_is_line_end(*cursor->at))
		return NT_OK;
	char found[40];
	return ply_fail_at(cursor, cursor->at, error, "%s %zu: found %s, expected the end of the line",
		element->name, row, ply_show(cursor, cursor->at, found));
}

nt_status ply_check_count(const ply_cursor *cursor, const ply_element *element, nt_error *error)
{
	/* the shortest ASCII row: one character and one separator per property */
	const size_t left = (size_t)(cursor->end - cursor->at);
	const bool ascii = cursor->encoding == PLY_ASCII;
	const size_t row = ascii ? 2 * element->property_count : element->row_bytes;
	const size_t room = left + ascii; /* the last line may lack its end */
	if (row == 0 || element->count <= room / row)
		return NT_OK;
	return ply_fail_at(cursor, cursor->at, error,
		"%zu rows of element \"%s\" need at least %zu bytes each, the file has %zu bytes left",
		element->count, element->name, row, left);
}

nt_status ply_skip_binary_row(ply_cursor *cursor, const ply_element *element, size_t row,
	nt_error *error)
{
	const bool swap = ply_swaps(cursor->encoding);
	for (size_t i = 0; i < element->property_count; i++) {
		const ply_property *property = &element->properties[i];
		size_t bytes = ply_size(property->list ? property->count_type : property->type);
		if (bytes <= (size_t)(cursor->end - cursor->at) && property->list) {
			const int64_t count = ply_load_integer(cursor->at, property->count_type, swap);
			if (count < 0)
				return ply_fail_at(cursor, cursor->at, error,
					"list \"%s\" of %s %zu has the length %lld", property->name,
					element->name, row, (long long)count);
			bytes += (size_t)count * ply_size(property->type);
		}
		if (bytes > (size_t)(cursor->end - cursor->at))
			return ply_fail_at(cursor, cursor->at, error,
				"the file ends within property \"%s\" of %s %zu of %zu: %zu bytes "
				"needed, %zu left", property->name, element->name, row, element->count,
				bytes, (size_t)(cursor->end - cursor->at));
		cursor->at += bytes;
	}
	return NT_OK;
}

static nt_status skip_lines(ply_cursor *cursor, const ply_element *element, nt_error *error)
{
	for (size_t row = 0; row < element->count; row++) {
		ply_next_row(cursor);
		if (cursor->at == cursor->end)
			return ply_fail_end(cursor, element, row, error);
		while (cursor->at < cursor->end && !ply_is_line_end(*cursor->at))
			cursor->at++;
	}
	return NT_OK;
}

nt_status ply_skip_element(ply_cursor *cursor, const ply_element *element, nt_error *error)
{
	nt_status status = ply_check_count(cursor, element, error);
	if (status || element->property_count == 0)
		return status;
	if (cursor->encoding == PLY_ASCII)
		return skip_lines(cursor, element, error);
	if (!element->has_list) {
		cursor->at += element->count * element->row_bytes;
		return NT_OK;
	}
	for (size_t row = 0; !status && row < element->count; row++)
		status = ply_skip_binary_row(cursor, element, row, error);
	return status;
}

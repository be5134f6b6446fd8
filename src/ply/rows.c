/* SPDX-License-Identifier: MIT */
/*
 * The body of a PLY file: rows of elements are read into columns, a value after the other, of text or of bytes of
 * either order, each checked. Rows of one size, which nearly all files are made of, are read by runs.c, which stops at
 * the first row that is anything else, be it wrong or only unusual, and leaves it to this file, which alone knows
 * errors.
 *
 * Lists are measured against the file before room is made for them, so that memory stays in proportion to the file
 * whatever its counts say. A row of an ASCII body is a line; blank lines between rows do not count.
 */
#include "ply/parts.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- places ---- */

ply_cursor ply_begin_body(const nt_scene *scene, const ply_header *header, unsigned threads)
{
	const unsigned char *body = scene->bytes + header->body;
	return (ply_cursor){.begin = scene->bytes, .at = body, .end = scene->bytes + scene->byte_count, .body = body,
		.body_line = header->body_line, .encoding = header->encoding, .threads = threads};
}

nt_place ply_place(const ply_cursor *cursor, const unsigned char *at)
{
	nt_place place;
	nt_place_clear(&place);
	if (cursor->encoding != PLY_ASCII) {
		place.offset = (uint64_t)(at - cursor->begin);
		return place;
	}
	place.line = cursor->body_line;
	for (const unsigned char *p = cursor->body; p < at; p++)
		place.line += *p == '\n' || (*p == '\r' && !(p + 1 < cursor->end && p[1] == '\n'));
	return place;
}

nt_status ply_fail_at(const ply_cursor *cursor, const unsigned char *at, nt_error *error, const char *format, ...)
{
	char message[sizeof error->message];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(message, sizeof message, format, arguments);
	va_end(arguments);
	const nt_place place = ply_place(cursor, at);
	if (cursor->encoding == PLY_ASCII)
		return nt_fail_line(error, NT_ERROR_INPUT, place.line, "%s", message);
	return nt_fail_offset(error, NT_ERROR_INPUT, place.offset, "%s", message);
}

/* "vertex 7: found "x", expected a number for property "y""; name: NULL, nothing is named. */
static nt_status fail_found(const ply_rows *rows, const unsigned char *at, const char *expected, const char *name,
	nt_error *error)
{
	const unsigned char *const end = rows->cursor->end;
	char found[40] = "the end of the file";
	size_t length = 0;
	while (length < 30 && at + length < end && !ply_is_space(at[length]))
		length++;
	if (at < end)
		strcpy(found, "the end of the line");
	if (length > 0) {
		snprintf(found, sizeof found, "\"%.*s\"", (int)length, (const char *)at);
		for (size_t i = 1; i <= length; i++)
			found[i] = at[i - 1] >= 0x20 && at[i - 1] < 0x7f ? (char)at[i - 1] : '?';
		strcpy(found + length + 1, "\"");
	}
	return ply_fail_at(rows->cursor, at, error, "%s %zu: found %s, expected %s%s%s%s", rows->element->name,
		rows->row, found, expected, name ? " \"" : "", name ? name : "", name ? "\"" : "");
}

static nt_status fail_end(const ply_cursor *cursor, const ply_element *element, size_t row, nt_error *error)
{
	return ply_fail_at(cursor, cursor->at, error, "the file ends where %s %zu of %zu was expected", element->name,
		row, element->count);
}

/* ---- any row ---- */

static nt_status store_float(ply_rows *rows, size_t number, size_t to, float value, const unsigned char *at,
	nt_error *error)
{
	const ply_column *column = &rows->columns[number];
	const char *name = rows->element->properties[number].name;
	column->floats[to] = value / column->divisor;
	if (ply_is_finite(value) || column->other == PLY_ANY)
		return NT_OK;
	rows->unsound = true;
	if (column->other == PLY_MENDED)
		return NT_OK;
	if (rows->cursor->encoding == PLY_ASCII)
		return fail_found(rows, at, "a finite number for property", name, error);
	return ply_fail_at(rows->cursor, at, error, "%s %zu: property \"%s\" is not finite, expected a finite number",
		rows->element->name, rows->row, name);
}

static nt_status store_integer(ply_rows *rows, size_t number, size_t to, int64_t value, const unsigned char *at,
	nt_error *error)
{
	const ply_column *column = &rows->columns[number];
	const bool restart = column->restarts && (value == -1 || value == UINT32_MAX);
	const bool inside = (uint64_t)value < column->limit;
	column->integers[to] = inside ? (uint32_t)value : restart ? NT_NONE : (uint32_t)column->limit;
	if (inside || restart || column->use == PLY_CHOICES)
		return NT_OK;
	return ply_fail_at(rows->cursor, at, error,
		"%s %zu: vertex index %lld is out of range, the file has %zu vertices", rows->element->name, rows->row,
		(long long)value, column->limit);
}

/* Reads the value at *at, and moves behind it. */
static nt_status read_text_value(ply_rows *rows, size_t number, size_t to, const unsigned char **at, nt_error *error)
{
	const ply_column *column = &rows->columns[number];
	const ply_property *property = &rows->element->properties[number];
	const unsigned char *const end = rows->cursor->end, *begin = ply_skip_blanks(*at, end);
	float value;
	int64_t integer;
	switch (column->use) {
	case PLY_FLOATS:
		if ((*at = ply_read_float(begin, end, &value)) != NULL)
			return store_float(rows, number, to, value, begin, error);
		break;
	case PLY_INDICES:
	case PLY_CHOICES:
		if ((*at = ply_read_integer(begin, end, &integer)) != NULL)
			return store_integer(rows, number, to, integer, begin, error);
		break;
	case PLY_DOUBLES:
	case PLY_SKIPPED:
		*at = ply_skip_value(begin, end);
		if (column->use == PLY_DOUBLES)
			nt_read_double((const char *)begin, (const char *)*at, &column->doubles[to]);
		if (*at > begin)
			return NT_OK;
		break;
	}
	return fail_found(rows, begin, property->list ? "another value of list" : "a number for property",
		property->name, error);
}

/* Room for a list; both kinds of numbers have four bytes. */
static nt_status make_room(ply_column *column, size_t count, nt_error *error)
{
	return column->use == PLY_SKIPPED || nt_grow(&column->values, &column->capacity, count, sizeof(float)) ? NT_OK
		: nt_fail_memory(error);
}

static nt_status read_text_cell(ply_rows *rows, size_t number, nt_error *error)
{
	const ply_property *property = &rows->element->properties[number];
	ply_column *column = &rows->columns[number];
	ply_cell *cell = &rows->cells[number];
	const unsigned char *const end = rows->cursor->end, *at = ply_skip_blanks(rows->cursor->at, end);
	*cell = (ply_cell){.begin = at, .count = 1};
	nt_status status = NT_OK;
	if (!property->list) {
		status = read_text_value(rows, number, rows->row * column->stride, &at, error);
	} else {
		int64_t count;
		at = ply_read_integer(cell->begin, end, &count);
		if (!at)
			return fail_found(rows, cell->begin, "the length of list", property->name, error);
		if (count < 0 || (uint64_t)count > (uint64_t)(end - at) / 2 + 1)
			return ply_fail_at(rows->cursor, cell->begin, error,
				"%s %zu: the length of a list does not fit the file: %lld", rows->element->name,
				rows->row, (long long)count);
		cell->count = (size_t)count;
		status = make_room(column, cell->count, error);
		for (size_t k = 0; !status && k < cell->count; k++)
			status = read_text_value(rows, number, k, &at, error);
	}
	rows->cursor->at = cell->end = at;
	return status;
}

/* Measures a property of the row. */
static nt_status find_binary_cell(ply_rows *rows, size_t number, nt_error *error)
{
	ply_cursor *cursor = rows->cursor;
	const ply_property *property = &rows->element->properties[number];
	const unsigned char *const begin = cursor->at;
	const size_t left = (size_t)(cursor->end - begin);
	size_t bytes = ply_size(property->list ? property->count_type : property->type);
	int64_t count = 1;
	if (property->list && bytes <= left) {
		count = ply_load_integer(begin, property->count_type, ply_swaps(cursor->encoding));
		if (count < 0)
			return ply_fail_at(cursor, begin, error, "list \"%s\" of %s %zu has the length %lld",
				property->name, rows->element->name, rows->row, (long long)count);
		bytes += (size_t)count * ply_size(property->type);
	}
	if (bytes > left)
		return ply_fail_at(cursor, begin, error,
			"the file ends within property \"%s\" of %s %zu of %zu: %zu bytes needed, %zu left",
			property->name, rows->element->name, rows->row, rows->element->count, bytes, left);
	cursor->at = begin + bytes;
	rows->cells[number] = (ply_cell){begin, cursor->at, (size_t)count};
	return NT_OK;
}

/* Reads the values of a cell: at once, and if one is not sound, one after the other. */
static nt_status read_binary_cell(ply_rows *rows, size_t number, nt_error *error)
{
	const ply_property *property = &rows->element->properties[number];
	const ply_cell *cell = &rows->cells[number];
	ply_column *column = &rows->columns[number];
	const bool swap = ply_swaps(rows->cursor->encoding), floats = column->use == PLY_FLOATS;
	const size_t first = property->list ? 0 : rows->row * column->stride, size = ply_size(property->type);
	const ply_type type = property->type;
	const unsigned char *const begin = cell->begin + (property->list ? ply_size(property->count_type) : 0);
	nt_status status = property->list ? make_room(column, cell->count, error) : NT_OK;
	if (status)
		return status;
	bool sound = true;
	for (size_t k = 0; k < cell->count; k++) {
		const unsigned char *at = begin + k * size;
		if (floats) {
			const float value = (float)ply_load_double(at, type, swap) / column->divisor;
			column->floats[first + k] = value;
			sound &= ply_is_finite(value);
		} else if (column->use == PLY_DOUBLES) {
			column->doubles[first + k] = ply_load_double(at, type, swap);
		} else {
			const int64_t value = ply_load_integer(at, type, swap);
			column->integers[first + k] = (uint32_t)value;
			sound &= (uint64_t)value < column->limit;
		}
	}
	for (size_t k = 0; !status && !sound && k < cell->count; k++) {
		const unsigned char *at = begin + k * size;
		const float value = (float)ply_load_double(at, type, swap);
		status = floats ? store_float(rows, number, first + k, value, at, error)
			: store_integer(rows, number, first + k, ply_load_integer(at, type, swap), at, error);
	}
	return status;
}

static void skip_line(ply_cursor *cursor)
{
	while (cursor->at < cursor->end && !ply_is_line_end(*cursor->at))
		cursor->at++;
}

/* Values behind the last property of a face: MeshLab and trimesh read such files. Behind those of a vertex they
 * are an error, since a count that is too large takes the first face for a vertex. */
static nt_status end_text_row(ply_rows *rows, nt_error *error)
{
	ply_cursor *cursor = rows->cursor;
	cursor->at = ply_skip_blanks(cursor->at, cursor->end);
	if (cursor->at == cursor->end || ply_is_line_end(*cursor->at))
		return NT_OK;
	if (!rows->may_be_longer)
		return fail_found(rows, cursor->at, "the end of the line", NULL, error);
	if (rows->longer++ == 0)
		rows->first_longer = rows->begin;
	skip_line(cursor);
	return NT_OK;
}

nt_status ply_read_row(ply_rows *rows, nt_error *error)
{
	ply_cursor *cursor = rows->cursor;
	const bool text = cursor->encoding == PLY_ASCII;
	if (text)
		ply_next_row(cursor);
	rows->begin = cursor->at;
	nt_status status = cursor->at == cursor->end ? fail_end(cursor, rows->element, rows->row, error) : NT_OK;
	for (size_t i = 0; !status && i < rows->element->property_count; i++)
		status = text ? read_text_cell(rows, i, error) : find_binary_cell(rows, i, error);
	for (size_t i = 0; !status && !text && i < rows->element->property_count; i++)
		if (rows->columns[i].use != PLY_SKIPPED)
			status = read_binary_cell(rows, i, error);
	if (!status && text)
		status = end_text_row(rows, error);
	rows->row++;
	return status;
}

bool ply_cell_float(const ply_rows *rows, size_t property, float *value)
{
	const ply_cell *cell = &rows->cells[property];
	const ply_type type = rows->element->properties[property].type;
	if (rows->cursor->encoding == PLY_ASCII)
		return ply_read_float(cell->begin, cell->end, value) != NULL;
	*value = (float)ply_load_double(cell->begin, type, ply_swaps(rows->cursor->encoding));
	return true;
}

ply_cell ply_cell_value(const ply_rows *rows, size_t property, size_t k)
{
	const ply_property *own = &rows->element->properties[property];
	const ply_cell list = rows->cells[property];
	const bool text = rows->cursor->encoding == PLY_ASCII;
	const unsigned char *at = list.begin + ply_size(own->count_type) + k * ply_size(own->type);
	if (text) {
		at = ply_skip_blanks(ply_skip_value(list.begin, list.end), list.end);
		for (size_t i = 0; i < k; i++)
			at = ply_skip_blanks(ply_skip_value(at, list.end), list.end);
	}
	return (ply_cell){at, text ? ply_skip_value(at, list.end) : at + ply_size(own->type), 1};
}

int64_t ply_cell_integer(const ply_rows *rows, size_t property, size_t k)
{
	const ply_cell cell = ply_cell_value(rows, property, k);
	const ply_type type = rows->element->properties[property].type;
	int64_t value = 0;
	if (rows->cursor->encoding == PLY_ASCII)
		ply_read_integer(cell.begin, cell.end, &value);
	else
		value = ply_load_integer(cell.begin, type, ply_swaps(rows->cursor->encoding));
	return value;
}

nt_status ply_read_rows(ply_rows *rows, nt_error *error)
{
	nt_status status = NT_OK;
	while (!status && rows->row < rows->element->count)
		if (rows->element->has_list || !ply_take_rows(rows, NULL, 0))
			status = ply_read_row(rows, error);
	return status;
}

/* ---- elements ---- */

bool ply_begin_rows(ply_rows *rows, ply_cursor *cursor, const ply_element *element)
{
	const size_t count = element->property_count;
	*rows = (ply_rows){.cursor = cursor, .element = element, .columns = nt_calloc(count, sizeof *rows->columns),
		.cells = nt_alloc(count, sizeof *rows->cells), .slots = nt_alloc(count, sizeof *rows->slots)};
	return rows->columns && rows->cells && rows->slots;
}

void ply_free_rows(ply_rows *rows)
{
	for (size_t i = 0; rows->columns && i < rows->element->property_count; i++)
		if (rows->element->properties[i].list)
			free(rows->columns[i].values);
	free(rows->columns);
	free(rows->cells);
	free(rows->slots);
	*rows = (ply_rows){0};
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
		"%zu rows of element \"%s\" need at least %zu bytes each, the file has %zu bytes left", element->count,
		element->name, row, left);
}

nt_status ply_skip_element(ply_cursor *cursor, const ply_element *element, nt_error *error)
{
	nt_status status = ply_check_count(cursor, element, error);
	if (status || element->property_count == 0)
		return status;
	if (cursor->encoding == PLY_ASCII) {
		for (size_t row = 0; row < element->count; row++) {
			ply_next_row(cursor);
			if (cursor->at == cursor->end)
				return fail_end(cursor, element, row, error);
			skip_line(cursor);
		}
		return NT_OK;
	}
	if (!element->has_list) {
		cursor->at += element->count * element->row_bytes;
		return NT_OK;
	}
	ply_rows rows;
	status = ply_begin_rows(&rows, cursor, element) ? NT_OK : nt_fail_memory(error);
	while (!status && rows.row < element->count)
		status = ply_read_row(&rows, error);
	ply_free_rows(&rows);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * The rows of an element are read into columns, each value checked. ply_read_row reads any row, of text or of bytes,
 * and alone knows errors. Plain rows, which nearly all files are made of, are read quickly: lines of text, by several
 * threads if there are many; binary rows without lists column by column, in blocks that stay in the first-level cache;
 * binary rows with one list. All of these stop at a row that is anything else, be it wrong or only unusual, and leave
 * it to ply_read_row.
 *
 * Lists are measured against the file before room is made for them, so that memory stays in proportion to the file
 * whatever its counts say. A row of an ASCII body is a line; blank lines between rows do not count.
 */
#include "ply/parts.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "file/decimal.h"

enum {
	/* Bytes behind its begin that nt_read_decimal may touch: sign, 8 digits, point, 24 digits. */
	DECIMAL_MARGIN = 40,
	BLOCK_ROWS = 512,
	/* The size of pieces of text does not depend on the number of threads, and none of it shows in what is read. */
	PIECE_BYTES = 1 << 20,
	LEAST_PIECES = 4
};

/* ---- values of text ---- */

static inline const unsigned char *skip_blanks(const unsigned char *at, const unsigned char *end)
{
	while (at < end && ply_is_blank(*at))
		at++;
	return at;
}

static inline const unsigned char *skip_value(const unsigned char *at, const unsigned char *end)
{
	while (at < end && !ply_is_space(*at))
		at++;
	return at;
}

/* Reads the number at `at`; NULL: there is none, or something sticks to it. */
static inline const unsigned char *read_float(const unsigned char *at, const unsigned char *end, float *value)
{
	const void *const read = nt_read_float((const char *)at, (const char *)end, value);
	const unsigned char *const after = read;
	return after && (after == end || ply_is_space(*after)) ? after : NULL;
}

/* The same for an integer; one that does not fit is cut to a number that is out of every range. */
static inline const unsigned char *read_integer(const unsigned char *at, const unsigned char *end, int64_t *value)
{
	const bool negative = at < end && *at == '-';
	at += negative || (at < end && *at == '+');
	const unsigned char *const digits = at;
	int64_t sum = 0;
	for (; at < end && *at >= '0' && *at <= '9'; at++)
		sum = sum < INT64_MAX / 100 ? sum * 10 + (*at - '0') : sum;
	*value = negative ? -sum : sum;
	return at > digits && (at == end || ply_is_space(*at)) ? at : NULL;
}

/* ---- values of bytes ---- */

static inline uint16_t load16(const unsigned char *at, bool swap)
{
	uint16_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap16(bits) : bits;
}

static inline uint32_t load32(const unsigned char *at, bool swap)
{
	uint32_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap32(bits) : bits;
}

/* An integer of that type; of float types -1, which is out of every range. */
static inline int64_t load_integer(const unsigned char *at, ply_type type, bool swap)
{
	switch (type) {
	case PLY_INT8:
		return (int8_t)*at;
	case PLY_UINT8:
		return *at;
	case PLY_INT16:
		return (int16_t)load16(at, swap);
	case PLY_UINT16:
		return load16(at, swap);
	case PLY_INT32:
		return (int32_t)load32(at, swap);
	case PLY_UINT32:
		return load32(at, swap);
	default:
		return -1;
	}
}

static inline double load_double(const unsigned char *at, ply_type type, bool swap)
{
	if (type == PLY_FLOAT32) {
		const uint32_t bits = load32(at, swap);
		float value;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	if (type == PLY_FLOAT64) {
		uint64_t bits;
		double value;
		memcpy(&bits, at, sizeof bits);
		bits = swap ? __builtin_bswap64(bits) : bits;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	return (double)load_integer(at, type, swap);
}

static inline bool is_finite(float value)
{
	return fabsf(value) <= FLT_MAX;
}

/* ---- faults ---- */

static bool is_text(const ply_rows *rows)
{
	return rows->header->encoding == PLY_ASCII;
}

/* "vertex 7: found "x", expected a number for property "y""; name: NULL, nothing is named. */
static nt_status fail_found(const ply_rows *rows, const unsigned char *at, const char *expected, const char *name)
{
	char found[40] = "the end of the file";
	size_t length = 0;
	while (length < 30 && at + length < rows->end && !ply_is_space(at[length]))
		length++;
	if (at < rows->end)
		strcpy(found, "the end of the line");
	if (length > 0) {
		snprintf(found, sizeof found, "\"%.*s\"", (int)length, (const char *)at);
		for (size_t i = 1; i <= length; i++)
			found[i] = at[i - 1] >= 0x20 && at[i - 1] < 0x7f ? (char)at[i - 1] : '?';
		strcpy(found + length + 1, "\"");
	}
	return ply_fail_at(rows->header, at, rows->error, "%s %zu: found %s, expected %s%s%s%s", rows->element->name,
		rows->row, found, expected, name ? " \"" : "", name ? name : "", name ? "\"" : "");
}

static nt_status fail_end(const ply_rows *rows, size_t row)
{
	return ply_fail_at(rows->header, rows->at, rows->error,
		"the file ends where %s %zu of %zu was expected", rows->element->name, row, rows->element->count);
}

/* ---- one row ---- */

/* An index is out of range, or a float not finite. */
static nt_status fail_value(const ply_rows *rows, size_t number, const unsigned char *at, int64_t index)
{
	const char *name = rows->element->properties[number].name;
	if (rows->columns[number].use == PLY_INDICES)
		return ply_fail_at(rows->header, at, rows->error,
			"%s %zu: vertex index %lld is out of range, the file has %zu vertices", rows->element->name,
			rows->row, (long long)index, rows->columns[number].limit);
	return is_text(rows) ? fail_found(rows, at, "a finite number for property", name)
		: ply_fail_at(rows->header, at, rows->error,
			"%s %zu: property \"%s\" is not finite, expected a finite number", rows->element->name,
			rows->row, name);
}

/* Room for the row's list, behind the others. */
static nt_status begin_list(ply_rows *rows, ply_column *column, size_t count)
{
	if (column->use == PLY_SKIPPED)
		return NT_OK;
	if (rows->row == 0)
		column->size = count;
	if (!column->counts && count != column->size) {
		column->counts = nt_alloc(rows->element->count, sizeof *column->counts);
		for (size_t i = 0; column->counts && i < rows->row; i++)
			column->counts[i] = (uint32_t)column->size;
		if (!column->counts)
			return nt_fail_memory(rows->error);
	}
	if (column->counts)
		column->counts[rows->row] = (uint32_t)count;
	/* both kinds of numbers have four bytes; there is an array of an empty list, too */
	if (!nt_grow(&column->values, &column->capacity, column->used + count + !count, sizeof(float)))
		return nt_fail_memory(rows->error);
	return NT_OK;
}

/* Reads the value at *at, and moves behind it. */
static inline nt_status read_text_value(ply_rows *rows, size_t number, size_t to, const unsigned char **at)
{
	const ply_column *column = &rows->columns[number];
	const unsigned char *const begin = *at, *const end = rows->end, *after = NULL;
	float value = 0;
	int64_t integer = 0;
	if (column->use == PLY_FLOATS) {
		after = read_float(begin, end, &value);
	} else if (column->use == PLY_SKIPPED || column->use == PLY_DOUBLES) {
		after = skip_value(begin, end);
		after = after > begin ? after : NULL;
	} else {
		after = read_integer(begin, end, &integer);
	}
	if (!after)
		return fail_found(rows, begin, rows->element->properties[number].list ? "another value of list"
			: column->use == PLY_CHOICES ? "an integer for property" : "a number for property",
			rows->element->properties[number].name);
	*at = after;
	if (column->use == PLY_FLOATS) {
		column->floats[to] = value / column->divisor;
		rows->unsound |= column->other != PLY_ANY && !is_finite(value);
		return column->other != PLY_REFUSED || is_finite(value) ? NT_OK : fail_value(rows, number, begin, 0);
	}
	if (column->use == PLY_DOUBLES)
		nt_read_double((const char *)begin, (const char *)after, &column->doubles[to]);
	if (column->use == PLY_SKIPPED || column->use == PLY_DOUBLES)
		return NT_OK;
	const bool restart = column->restarts && (integer == -1 || integer == UINT32_MAX);
	const bool inside = (uint64_t)integer < column->limit;
	column->integers[to] = inside ? (uint32_t)integer : restart ? NT_NONE : (uint32_t)column->limit;
	return inside || restart || column->use == PLY_CHOICES ? NT_OK : fail_value(rows, number, begin, integer);
}

/* Values behind the last property of a face: MeshLab and trimesh read such files. Behind those of a vertex they
 * are an error, since a count that is too large takes the first face for a vertex. */
static nt_status end_longer_row(ply_rows *rows)
{
	if (!rows->may_be_longer)
		return fail_found(rows, rows->at, "the end of the line", NULL);
	rows->longer.first = rows->longer.count++ ? rows->longer.first : rows->row;
	while (rows->at < rows->end && !ply_is_line_end(*rows->at))
		rows->at++;
	return NT_OK;
}

static nt_status read_text_row(ply_rows *rows)
{
	const unsigned char *const end = rows->end;
	const size_t count = rows->element->property_count;
	ply_next_row(rows);
	const unsigned char *at = rows->at;
	nt_status status = at == end ? fail_end(rows, rows->row) : NT_OK;
	for (size_t i = 0; !status && i < count; i++) {
		const ply_property *property = &rows->element->properties[i];
		ply_cell *const cell = &rows->cells[i];
		size_t to = rows->row * rows->columns[i].stride;
		at = skip_blanks(at, end);
		cell->begin = at;
		if (property->list) {
			int64_t length;
			at = read_integer(cell->begin, end, &length);
			if (!at)
				return fail_found(rows, cell->begin, "the length of list", property->name);
			if (length < 0 || (uint64_t)length > (uint64_t)(end - at) / 2 + 1)
				return ply_fail_at(rows->header, cell->begin, rows->error,
					"%s %zu: the length of a list does not fit the file: %lld",
					rows->element->name, rows->row, (long long)length);
			cell->count = (size_t)length;
			to = rows->columns[i].used;
			status = begin_list(rows, &rows->columns[i], cell->count);
			for (size_t k = 0; !status && k < cell->count; k++) {
				at = skip_blanks(at, end);
				status = read_text_value(rows, i, to + k, &at);
			}
			rows->columns[i].used += cell->count;
		} else {
			cell->count = 1;
			status = read_text_value(rows, i, to, &at);
		}
		cell->end = at;
	}
	if (status)
		return status;
	rows->at = skip_blanks(at, end);
	if (rows->at < end && !ply_is_line_end(*rows->at))
		status = end_longer_row(rows);
	rows->row += !status;
	return status;
}

/* Integers `step` bytes apart; how many until one is not sound. Constant types give loops without a test. */
static inline __attribute__((always_inline)) size_t load_integers(const ply_column *column, ply_type type, bool swap,
	const unsigned char *at, size_t step, size_t count, uint32_t *to, size_t stride)
{
	const size_t limit = column->limit;
	size_t sound = 0;
	for (; sound < count; sound++, at += step, to += stride) {
		*to = (uint32_t)load_integer(at, type, swap);
		if (*to < limit)
			continue;
		if (column->use == PLY_CHOICES)
			*to = (uint32_t)limit;
		else if (!column->restarts || *to != NT_NONE)
			break;
	}
	return sound;
}

/* Values `step` bytes apart into every `stride`th place of a column from `to` on; how many until one is not sound. */
static size_t load_values(const ply_column *column, ply_type type, bool swap, const unsigned char *from, size_t step,
	size_t count, size_t to, size_t stride, bool *unsound)
{
	if (column->use == PLY_INDICES || column->use == PLY_CHOICES)
		return ply_size(type) == 4 && type != PLY_FLOAT32 && !swap
			? load_integers(column, PLY_UINT32, false, from, step, count, column->integers + to, stride)
			: load_integers(column, type, swap, from, step, count, column->integers + to, stride);
	if (column->use == PLY_DOUBLES) {
		for (size_t i = 0; i < count; i++)
			column->doubles[to + i * stride] = load_double(from + i * step, type, swap);
		return count;
	}
	float *const values = column->floats + to;
	if (type == PLY_FLOAT32 && column->divisor == 1.0f) {
		for (size_t i = 0; i < count; i++) {
			const uint32_t bits = load32(from + i * step, swap);
			memcpy(values + i * stride, &bits, sizeof bits);
		}
	} else {
		for (size_t i = 0; i < count; i++)
			values[i * stride] = (float)load_double(from + i * step, type, swap) / column->divisor;
	}
	unsigned bad = 0;
	for (size_t i = 0; column->other != PLY_ANY && i < count; i++)
		bad |= !is_finite(values[i * stride]);
	*unsound |= bad;
	size_t sound = bad && column->other == PLY_REFUSED ? 0 : count;
	while (sound < count && is_finite(values[sound * stride]))
		sound++;
	return sound;
}

/* Measures the properties of the row. */
static nt_status measure_binary_row(ply_rows *rows)
{
	const ply_element *element = rows->element;
	const bool swap = ply_swaps(rows->header->encoding);
	for (size_t i = 0; i < element->property_count; i++) {
		const ply_property *property = &element->properties[i];
		const unsigned char *const begin = rows->at;
		const size_t left = (size_t)(rows->end - begin);
		uint64_t bytes = ply_size(property->list ? property->count_type : property->type);
		int64_t count = 1;
		if (property->list && bytes <= left) {
			count = load_integer(begin, property->count_type, swap);
			if (count < 0)
				return ply_fail_at(rows->header, begin, rows->error,
					"list \"%s\" of %s %zu has the length %lld", property->name, element->name,
					rows->row, (long long)count);
			bytes += (uint64_t)count * ply_size(property->type);
		}
		if (bytes > left)
			return ply_fail_at(rows->header, begin, rows->error,
				"the file ends within property \"%s\" of %s %zu of %zu: %" PRIu64
				" bytes needed, %zu left", property->name, element->name, rows->row, element->count,
				bytes, left);
		rows->at = begin + bytes;
		rows->cells[i] = (ply_cell){begin, rows->at, (size_t)count};
	}
	return NT_OK;
}

static nt_status read_binary_row(ply_rows *rows)
{
	const bool swap = ply_swaps(rows->header->encoding);
	nt_status status = rows->at == rows->end ? fail_end(rows, rows->row) : measure_binary_row(rows);
	for (size_t i = 0; !status && i < rows->element->property_count; i++) {
		const ply_property *property = &rows->element->properties[i];
		ply_column *column = &rows->columns[i];
		const ply_cell *cell = &rows->cells[i];
		const size_t size = ply_size(property->type);
		const unsigned char *const at = cell->end - cell->count * size;
		const size_t to = property->list ? column->used : rows->row * column->stride;
		size_t sound = cell->count;
		if (property->list && (rows->row == 0 || column->counts || cell->count != column->size ||
				to + cell->count > column->capacity))
			status = begin_list(rows, column, cell->count);
		column->used += cell->count;
		if (!status && column->use != PLY_SKIPPED)
			sound = load_values(column, property->type, swap, at, size, cell->count, to, 1, &rows->unsound);
		if (sound < cell->count)
			status = fail_value(rows, i, at + sound * size,
				load_integer(at + sound * size, property->type, swap));
	}
	rows->row += !status;
	return status;
}

nt_status ply_read_row(ply_rows *rows)
{
	return is_text(rows) ? read_text_row(rows) : read_binary_row(rows);
}

bool ply_cell_float(const ply_rows *rows, size_t property, float *value)
{
	const ply_cell *cell = &rows->cells[property];
	const ply_type type = rows->element->properties[property].type;
	if (is_text(rows))
		return read_float(cell->begin, cell->end, value) != NULL;
	*value = (float)load_double(cell->begin, type, ply_swaps(rows->header->encoding));
	return true;
}

ply_cell ply_cell_value(const ply_rows *rows, size_t property, size_t k)
{
	const ply_property *own = &rows->element->properties[property];
	const ply_cell list = rows->cells[property];
	const unsigned char *at = list.begin + ply_size(own->count_type) + k * ply_size(own->type);
	if (!is_text(rows))
		return (ply_cell){at, at + ply_size(own->type), 1};
	at = skip_blanks(skip_value(list.begin, list.end), list.end);
	for (size_t i = 0; i < k; i++)
		at = skip_blanks(skip_value(at, list.end), list.end);
	return (ply_cell){at, skip_value(at, list.end), 1};
}

/* ---- plain rows ---- */

/* Elements that are read quickly have one list at most, of indices, and the values of their binary rows beside it are
 * skipped: vertices, and faces as most files have them. */
static bool is_plain(const ply_rows *rows)
{
	const ply_element *element = rows->element;
	size_t used = 0;
	for (size_t i = 0; i < element->property_count; i++)
		used += rows->columns[i].use != PLY_SKIPPED;
	const ply_column *list = element->list_count ? &rows->columns[element->last_list] : NULL;
	return !list || (element->list_count == 1 && list->use == PLY_INDICES && !list->restarts &&
		(is_text(rows) || used == 1));
}

/* Rows without lists: column by column. */
static void take_columns(ply_rows *rows)
{
	const ply_element *element = rows->element;
	const bool swap = ply_swaps(rows->header->encoding);
	const size_t room = (size_t)(rows->end - rows->at) / element->row_bytes, left = rows->stop - rows->row;
	size_t sound = 0, wanted = 0;
	for (size_t most = left < room ? left : room; most && sound == wanted; most -= sound) {
		const unsigned char *from = rows->at;
		sound = wanted = most < BLOCK_ROWS ? most : BLOCK_ROWS;
		for (size_t i = 0; i < element->property_count; i++) {
			const ply_column *column = &rows->columns[i];
			const ply_type type = element->properties[i].type;
			if (column->use != PLY_SKIPPED)
				sound = load_values(column, type, swap, from, element->row_bytes, sound,
					rows->row * column->stride, column->stride, &rows->unsound);
			from += ply_size(type);
		}
		rows->row += sound;
		rows->at += sound * element->row_bytes;
	}
}

/* Rows with one list and skipped values. Constant types give loops without a test. */
static inline __attribute__((always_inline)) nt_status take_lists_as(ply_rows *rows, ply_type count_type, ply_type type,
	bool swap)
{
	const size_t head = rows->element->properties[rows->element->last_list].offset;
	const size_t fixed = rows->element->row_bytes, lead = head + ply_size(count_type);
	ply_column *column = &rows->columns[rows->element->last_list];
	const unsigned char *at = rows->at;
	size_t row = rows->row, used = column->used;
	size_t usual = column->counts ? SIZE_MAX : column->size;
	nt_status status = NT_OK;
	while (row < rows->stop) {
		const size_t left = (size_t)(rows->end - at);
		const int64_t read = left < lead ? -1 : load_integer(at + head, count_type, swap);
		const size_t count = (size_t)read, to = used;
		if (read < 0 || fixed + (uint64_t)read * ply_size(type) > left)
			break;
		if (count != usual || to + count > column->capacity) {
			rows->row = row;
			column->used = used;
			status = begin_list(rows, column, count);
			usual = column->counts ? SIZE_MAX : usual;
			if (status)
				break;
		}
		if (load_integers(column, type, swap, at + lead, ply_size(type), count, column->integers + to, 1) <
			count)
			break;
		used = to + count;
		at += fixed + count * ply_size(type);
		row++;
	}
	rows->at = at;
	rows->row = row;
	column->used = used;
	return status;
}

static nt_status take_lists(ply_rows *rows)
{
	const ply_property *list = &rows->element->properties[rows->element->last_list];
	const bool swap = ply_swaps(rows->header->encoding);
	return list->count_type == PLY_UINT8 && ply_size(list->type) == 4 && !swap
		? take_lists_as(rows, PLY_UINT8, PLY_UINT32, false)
		: take_lists_as(rows, list->count_type, list->type, swap);
}

/* Lines of values with blanks around them, far enough from the end of the file, whose list has `size` values, which go
 * to `list`; how many there are from *position on, which moves behind them. */
static __attribute__((noinline)) size_t take_run(const ply_rows *rows, size_t first, size_t most, uint32_t *list,
	size_t size, const unsigned char **position)
{
	const ply_column *const last = rows->columns + rows->element->property_count;
	const char *const end = (const char *)rows->end, *at = (const char *)*position;
	size_t row = first;
	uint32_t none, *to = list ? list : &none;
	for (; row < first + most; row++, to += size) {
		for (const ply_column *column = rows->columns; column < last; column++) {
			if (end - at <= DECIMAL_MARGIN || *at == ' ') {
				while (at < end && *at == ' ')
					at++;
				if (end - at <= DECIMAL_MARGIN)
					return row - first;
			}
			if (column->use == PLY_FLOATS) {
				float value;
				at = nt_read_decimal(at, end, &value);
				if (!at || at == end || (!is_finite(value) && column->other != PLY_ANY))
					return row - first;
				column->floats[row * column->stride] =
					column->divisor == 1.0f ? value : value / column->divisor;
			} else if (column->use == PLY_INDICES) {
				if (*at++ != (char)('0' + size))
					return row - first;
				for (size_t k = 0; k < size; k++) {
					if (*at++ != ' ' || end - at <= DECIMAL_MARGIN)
						return row - first;
					const unsigned digits = nt_read_digits(at, &to[k]);
					if (digits == 0 || to[k] >= column->limit)
						return row - first;
					at += digits;
				}
			} else {
				const char *const begin = at;
				at = (const char *)skip_value((const unsigned char *)at, (const unsigned char *)end);
				if (column->use == PLY_DOUBLES)
					nt_read_double(begin, at, &column->doubles[row * column->stride]);
				if (at == begin || at == end || column->use == PLY_CHOICES)
					return row - first;
			}
			if (*at == ' ')
				at++;
			else if (column + 1 < last)
				return row - first;
		}
		while (at < end && *at == ' ')
			at++;
		at += end - at > 1 && *at == '\r';
		if (at == end || *at != '\n')
			break;
		*position = (const unsigned char *)++at;
	}
	return row - first;
}

/* Lines by this thread; `first`: the list is the first property. */
static nt_status take_lines(ply_rows *rows, ply_column *list, bool first)
{
	nt_status status = NT_OK;
	size_t taken = 1, size = 0;
	while (!status && taken && rows->row < rows->stop && rows->at < rows->end) {
		const size_t left = rows->stop - rows->row;
		if (list)
			size = first ? (size_t)(*rows->at - '0') : list->size;
		if (size > 9)
			break;
		if (list && !nt_grow(&list->values, &list->capacity, list->used + size * left, sizeof(float)))
			return nt_fail_memory(rows->error);
		taken = take_run(rows, rows->row, left, list ? list->integers + list->used : NULL, size, &rows->at);
		for (size_t i = 0; !status && i < taken; i++, rows->row++) {
			if (list && (list->counts || list->size != size))
				status = begin_list(rows, list, size);
			if (list)
				list->used += size;
		}
	}
	return status;
}

/* Many lines are cut into pieces for threads. If each row is a line, the lines before a piece say which row it begins
 * with. Whether all of them are rows, with lists as long as the first, shows itself when they are read. */
typedef struct piece {
	const unsigned char *begin, *end; /* the beginnings of lines */
	size_t first, rows;               /* the rows that it would have */
	size_t taken;
} piece;

typedef struct pieces {
	const ply_rows *rows;
	const ply_column *list; /* NULL: there is none */
	piece *all;
	size_t count;
} pieces;

/* Behind the line end that comes next, or the end of the input. */
static const unsigned char *next_line(const unsigned char *at, const unsigned char *end)
{
	const unsigned char *found = memchr(at, '\n', (size_t)(end - at));
	return found ? found + 1 : end;
}

static void count_lines(void *context, size_t item, unsigned thread)
{
	(void)thread;
	piece *const own = &((pieces *)context)->all[item];
	for (const unsigned char *at = own->begin; at < own->end; at = next_line(at, own->end))
		own->rows++;
}

/* Its end is then that of what was taken. */
static void take_piece(void *context, size_t item, unsigned thread)
{
	(void)thread;
	const pieces *p = context;
	piece *const own = &p->all[item];
	const size_t size = p->list ? p->list->size : 0;
	uint32_t *const list = p->list ? p->list->integers + p->list->used + (own->first - p->rows->row) * size : NULL;
	own->end = own->begin;
	own->taken = take_run(p->rows, own->first, own->rows, list, size, &own->end);
}

/* Also without memory for it. */
static void take_pieces(ply_rows *rows, ply_column *list)
{
	const size_t most = (size_t)(rows->end - rows->at) / PIECE_BYTES + 1, left = rows->stop - rows->row;
	pieces p = {.rows = rows, .list = list};
	if (rows->threads < 2 || most < LEAST_PIECES || (list && list->capacity < list->used + left * list->size) ||
		(list && list->size > 9))
		return;
	p.all = nt_alloc(most, sizeof *p.all);
	for (const unsigned char *at = rows->at; p.all && at < rows->end; at = p.all[p.count++].end) {
		const bool last = (size_t)(rows->end - at) <= PIECE_BYTES;
		p.all[p.count] = (piece){.begin = at, .end = last ? rows->end : next_line(at + PIECE_BYTES, rows->end)};
	}
	nt_parallel_items(rows->threads, p.count, count_lines, &p);
	for (size_t i = 0, before = 0; i < p.count; before += p.all[i++].rows) {
		p.all[i].first = rows->row + before;
		p.all[i].rows = p.all[i].rows < left - before ? p.all[i].rows : left - before;
	}
	nt_parallel_items(rows->threads, p.count, take_piece, &p);
	size_t taken = 0;
	for (size_t i = 0; i < p.count && p.all[i].rows; i++) {
		taken += p.all[i].taken;
		rows->at = p.all[i].end;
		if (p.all[i].taken < p.all[i].rows)
			break;
	}
	rows->row += taken;
	if (list)
		list->used += taken * list->size;
	free(p.all);
}

/* ---- all rows ---- */

/* Room for the indices of all rows, if they are as long as those of the first: most files are triangles, or quads. */
static nt_status reserve_indices(ply_rows *rows)
{
	for (size_t i = 0; i < rows->element->property_count; i++) {
		ply_column *column = &rows->columns[i];
		const size_t size = column->size < 4 ? column->size : 4;
		if (column->use == PLY_INDICES && !nt_grow(&column->values, &column->capacity,
			size * rows->element->count, sizeof(float)))
			return nt_fail_memory(rows->error);
	}
	return NT_OK;
}

nt_status ply_read_rows(ply_rows *rows)
{
	const ply_element *element = rows->element;
	const bool plain = is_plain(rows);
	ply_column *list = element->list_count ? &rows->columns[element->last_list] : NULL;
	nt_status status = NT_OK;
	while (!status && rows->row < rows->stop) {
		/* nobody but this one knows errors */
		status = ply_read_row(rows);
		const bool first = rows->row == 1;
		if (!status && first)
			status = reserve_indices(rows);
		if (status || !plain || rows->row == rows->stop)
			continue;
		if (is_text(rows)) {
			ply_next_row(rows);
			if (first)
				take_pieces(rows, list);
			status = take_lines(rows, list, element->last_list == 0);
		} else if (list) {
			status = take_lists(rows);
		} else {
			take_columns(rows);
		}
	}
	return status;
}

nt_status ply_skip_rows(ply_rows *rows)
{
	const ply_element *element = rows->element;
	if (element->property_count == 0)
		return NT_OK;
	for (size_t row = 0; is_text(rows) && row < element->count; row++) {
		ply_next_row(rows);
		if (rows->at == rows->end)
			return fail_end(rows, row);
		while (rows->at < rows->end && !ply_is_line_end(*rows->at))
			rows->at++;
	}
	if (!is_text(rows) && !element->list_count)
		rows->at += element->count * element->row_bytes;
	return is_text(rows) || !element->list_count ? NT_OK : ply_read_rows(rows);
}

nt_status ply_begin_rows(ply_rows *rows, const ply_header *header, const ply_element *element, const unsigned char *at,
	nt_error *error)
{
	const size_t count = element->property_count;
	*rows = (ply_rows){.header = header, .element = element, .error = error, .at = at, .stop = element->count,
		.end = header->bytes + header->size, .columns = nt_calloc(count, sizeof *rows->columns),
		.cells = nt_calloc(count, sizeof *rows->cells)};
	if (!rows->columns || !rows->cells)
		return nt_fail_memory(error);
	/* the shortest ASCII row: one character and one separator per property; the last line may lack its end */
	const size_t left = (size_t)(rows->end - at), row = is_text(rows) ? 2 * count : element->row_bytes;
	if (row == 0 || element->count <= (left + is_text(rows)) / row)
		return NT_OK;
	return ply_fail_at(header, at, error,
		"%zu rows of element \"%s\" need at least %zu bytes each, the file has %zu bytes left", element->count,
		element->name, row, left);
}

void ply_free_rows(ply_rows *rows)
{
	for (size_t i = 0; rows->columns && i < rows->element->property_count; i++) {
		free(rows->element->properties[i].list ? rows->columns[i].values : NULL);
		free(rows->columns[i].counts);
	}
	free(rows->columns);
	free(rows->cells);
	*rows = (ply_rows){0};
}

const unsigned char *ply_find_row(const ply_rows *of, size_t row)
{
	ply_rows rows;
	nt_status status = ply_begin_rows(&rows, of->header, of->element, of->header->bytes + of->element->rows.begin,
		of->error);
	rows.may_be_longer = true;
	while (!status && rows.row < row)
		status = ply_read_row(&rows);
	if (!status && is_text(&rows))
		ply_next_row(&rows);
	const unsigned char *const at = status ? NULL : rows.at;
	ply_free_rows(&rows);
	return at;
}

/* SPDX-License-Identifier: MIT */
/*
 * Rows of one size: vertices without lists, triangles or quads. Binary rows are decoded column by column in blocks that
 * stay in the first-level cache, lines of text by several threads. Both end with the first row that is anything else.
 */
#include "ply/parts.h"

#include <stdlib.h>
#include "base/parallel.h"

enum {
	BLOCK_ROWS = 512,
	/* The size of pieces of text does not depend on the number of threads, and none of it shows in what is read. */
	PIECE_BYTES = 1 << 20,
	LEAST_PIECES = 4
};

/* A row as a table of slots. */
typedef struct fixed_rows {
	const ply_cursor *cursor;
	const ply_slot *slots;
	size_t slot_count, row_bytes;
} fixed_rows;

/* The slots of rows whose list, if there is one, has `size` values; false: the element has rows of another kind.
 * indices: where those of the next row go. */
static bool find_slots(ply_rows *rows, uint32_t *indices, size_t size, fixed_rows *fixed)
{
	const ply_element *element = rows->element;
	size_t offset = 0;
	for (size_t i = 0; i < element->property_count; i++) {
		const ply_property *property = &element->properties[i];
		ply_slot *slot = &rows->slots[i];
		*slot = (ply_slot){.column = rows->columns[i], .property = property, .offset = offset};
		ply_column *column = &slot->column;
		if (property->list != (column->use == PLY_INDICES) || column->use == PLY_CHOICES || column->restarts)
			return false;
		if (property->list) {
			slot->size = column->stride = size;
			column->integers = indices;
			offset += ply_size(property->count_type) + size * ply_size(property->type);
		} else {
			const size_t first = rows->row * column->stride;
			if (column->use == PLY_DOUBLES)
				column->doubles += first;
			else if (column->use != PLY_SKIPPED)
				column->floats += first;
			offset += ply_size(property->type);
		}
	}
	*fixed = (fixed_rows){rows->cursor, rows->slots, element->property_count, offset};
	return true;
}

/* Lists of one length; the number of rows that have them, with sound indices. Constant sizes, types and orders give
 * loops without a test. */
static inline __attribute__((always_inline)) size_t load_lists(const ply_slot *slot, const unsigned char *at,
	size_t row_bytes, size_t count, size_t size, ply_type count_type, ply_type type, bool swap, uint32_t *to)
{
	const size_t head = ply_size(count_type), width = ply_size(type), limit = slot->column.limit;
	size_t sound = 0;
	for (; sound < count; sound++, at += row_bytes, to += size) {
		uint32_t largest = 0;
		if (ply_load_integer(at, count_type, swap) != (int64_t)size)
			break;
		for (size_t k = 0; k < size; k++) {
			to[k] = (uint32_t)ply_load_integer(at + head + k * width, type, swap);
			largest = to[k] > largest ? to[k] : largest;
		}
		if (largest >= limit)
			break;
	}
	return sound;
}

/* Values of a slot in a block of rows, of which `first` is the first; the number of rows that are plain and sound. */
static size_t load_slot(const fixed_rows *fixed, const ply_slot *slot, size_t first, size_t count, bool *unsound)
{
	const ply_column *column = &slot->column;
	const ply_type type = slot->property->type, head = slot->property->count_type;
	const size_t row_bytes = fixed->row_bytes, to = first * column->stride, stride = column->stride;
	const unsigned char *from = fixed->cursor->at + first * row_bytes + slot->offset;
	const bool swap = ply_swaps(fixed->cursor->encoding);
	if (column->use == PLY_SKIPPED)
		return count;
	if (slot->size) {
		uint32_t *const indices = column->integers + to;
		const bool usual = head == PLY_UINT8 && !swap && ply_size(type) == 4;
		if (usual && slot->size == 3)
			return load_lists(slot, from, row_bytes, count, 3, PLY_UINT8, PLY_UINT32, false, indices);
		if (usual && slot->size == 4)
			return load_lists(slot, from, row_bytes, count, 4, PLY_UINT8, PLY_UINT32, false, indices);
		return load_lists(slot, from, row_bytes, count, slot->size, head, type, swap, indices);
	}
	if (column->use == PLY_DOUBLES) {
		for (size_t i = 0; i < count; i++)
			column->doubles[to + i * stride] = ply_load_double(from + i * row_bytes, type, swap);
		return count;
	}
	float *const values = column->floats + to;
	if (type == PLY_FLOAT32 && column->divisor == 1.0f) {
		for (size_t i = 0; i < count; i++) {
			const uint32_t bits = ply_load32(from + i * row_bytes, swap);
			memcpy(values + i * stride, &bits, sizeof bits);
		}
	} else {
		for (size_t i = 0; i < count; i++)
			values[i * stride] = (float)ply_load_double(from + i * row_bytes, type, swap) / column->divisor;
	}
	unsigned bad = 0;
	for (size_t i = 0; column->other != PLY_ANY && i < count; i++)
		bad |= !ply_is_finite(values[i * stride]);
	if (!bad)
		return count;
	*unsound = true;
	size_t sound = 0;
	while (sound < count && (column->other == PLY_MENDED || ply_is_finite(values[sound * stride])))
		sound++;
	return sound;
}

static size_t take_binary(const fixed_rows *fixed, size_t rows, bool *unsound)
{
	const size_t room = (size_t)(fixed->cursor->end - fixed->cursor->at) / fixed->row_bytes;
	const size_t most = rows < room ? rows : room;
	size_t taken = 0, sound = 0, wanted = 0;
	for (; taken < most && sound == wanted; taken += sound) {
		sound = wanted = most - taken < BLOCK_ROWS ? most - taken : BLOCK_ROWS;
		for (size_t i = 0; i < fixed->slot_count; i++)
			sound = load_slot(fixed, &fixed->slots[i], taken, sound, unsound);
	}
	return taken;
}

/* A list of text; NULL: read it the general way. */
static const char *take_list(const ply_slot *slot, size_t row, const char *at, const char *end)
{
	uint32_t *const indices = slot->column.integers + row * slot->size;
	if (*at++ != (char)('0' + slot->size))
		return NULL;
	for (size_t k = 0; k < slot->size; k++) {
		if (*at++ != ' ' || end - at <= PLY_DECIMAL_MARGIN)
			return NULL;
		const unsigned digits = nt_read_digits(at, &indices[k]);
		if (digits == 0 || indices[k] >= slot->column.limit)
			return NULL;
		at += digits;
	}
	return at;
}

/* A value that is no float of a vertex. */
static const char *take_other(const ply_slot *slot, size_t row, const char *at, const char *end)
{
	if (slot->size)
		return take_list(slot, row, at, end);
	const char *const begin = at;
	at = (const char *)ply_skip_value((const unsigned char *)at, (const unsigned char *)end);
	if (slot->column.use == PLY_DOUBLES)
		nt_read_double(begin, at, &slot->column.doubles[row * slot->column.stride]);
	return at > begin && at < end ? at : NULL;
}

/* A line of values with single blanks between them, far enough from the end of the file; the place behind it, or NULL:
 * read it the general way. */
static inline const char *take_line(const fixed_rows *fixed, size_t row, const char *at, const char *end)
{
	for (size_t i = 0; i < fixed->slot_count; i++) {
		const ply_column *column = &fixed->slots[i].column;
		if (end - at <= PLY_DECIMAL_MARGIN)
			return NULL;
		if (column->use == PLY_FLOATS) {
			float value;
			at = nt_read_decimal(at, end, &value);
			if (!at || at == end || (column->other != PLY_ANY && !ply_is_finite(value)))
				return NULL;
			column->floats[row * column->stride] =
				column->divisor == 1.0f ? value : value / column->divisor;
		} else {
			at = take_other(&fixed->slots[i], row, at, end);
			if (!at)
				return NULL;
		}
		if (i + 1 < fixed->slot_count && *at++ != ' ')
			return NULL;
	}
	at += *at == '\r' && end - at > 1;
	return *at == '\n' ? at + 1 : NULL;
}

/* Lines from a position on, which moves behind them. */
static size_t take_lines(const fixed_rows *fixed, size_t first, size_t rows, const unsigned char **position)
{
	const char *const end = (const char *)fixed->cursor->end;
	size_t taken = 0;
	for (const char *next; taken < rows; taken++) {
		next = take_line(fixed, first + taken, (const char *)*position, end);
		if (!next)
			break;
		*position = (const unsigned char *)next;
	}
	return taken;
}

/* The text cut into pieces of whole lines. If each row is a line, the lines before a piece say which row it begins
 * with. Whether all of them are rows shows itself when they are read. */
typedef struct piece {
	const unsigned char *begin, *end; /* the beginnings of lines */
	size_t first, rows;               /* the rows that it would have */
	size_t taken;
	const unsigned char *stop;        /* behind the last row that was taken */
} piece;

typedef struct pieces {
	const fixed_rows *fixed;
	piece *list;
	size_t count;
} pieces;

/* Behind the line end that comes next, or the end of the input. */
static const unsigned char *next_line(const unsigned char *at, const unsigned char *end)
{
	const unsigned char *found = memchr(at, '\n', (size_t)(end - at));
	return found ? found + 1 : end;
}

static void count_lines(void *context, size_t item, unsigned slot)
{
	(void)slot;
	piece *const own = &((pieces *)context)->list[item];
	for (const unsigned char *at = own->begin; at < own->end; at = next_line(at, own->end))
		own->rows++;
}

static void take_piece(void *context, size_t item, unsigned slot)
{
	(void)slot;
	const pieces *p = context;
	piece *const own = &p->list[item];
	own->stop = own->begin;
	own->taken = take_lines(p->fixed, own->first, own->rows, &own->stop);
}

static size_t take_pieces(ply_cursor *cursor, size_t rows, pieces *p)
{
	for (const unsigned char *at = cursor->at; at < cursor->end; p->count++) {
		const bool last = (size_t)(cursor->end - at) <= PIECE_BYTES;
		piece *const new = &p->list[p->count];
		*new = (piece){.begin = at, .end = last ? cursor->end : next_line(at + PIECE_BYTES, cursor->end)};
		at = new->end;
	}
	nt_parallel_items(cursor->threads, p->count, count_lines, p);
	size_t used = 0, taken = 0;
	for (size_t first = 0; used < p->count && first < rows; first += p->list[used++].rows) {
		piece *const own = &p->list[used];
		own->first = first;
		own->rows = own->rows < rows - first ? own->rows : rows - first;
	}
	p->count = used;
	nt_parallel_items(cursor->threads, p->count, take_piece, p);
	bool whole = true;
	for (size_t i = 0; whole && i < p->count; i++) {
		taken += p->list[i].taken;
		cursor->at = p->list[i].stop;
		whole = p->list[i].taken == p->list[i].rows;
	}
	/* what comes is read again, by one thread: there may be as many such rows as lines */
	cursor->threads = whole ? cursor->threads : 1;
	return taken;
}

static size_t take_text(const fixed_rows *fixed, ply_cursor *cursor, size_t rows)
{
	const size_t most = (size_t)(cursor->end - cursor->at) / PIECE_BYTES + 1;
	pieces p = {.fixed = fixed};
	if (cursor->threads > 1 && most >= LEAST_PIECES)
		p.list = nt_alloc(most, sizeof *p.list);
	/* also without memory for them */
	const size_t taken = p.list ? take_pieces(cursor, rows, &p) : take_lines(fixed, 0, rows, &cursor->at);
	free(p.list);
	return taken;
}

size_t ply_take_rows(ply_rows *rows, uint32_t *indices, size_t size)
{
	ply_cursor *cursor = rows->cursor;
	const size_t left = rows->element->count - rows->row;
	fixed_rows fixed;
	size_t taken;
	if (!find_slots(rows, indices, size, &fixed))
		return 0;
	if (cursor->encoding == PLY_ASCII) {
		ply_next_row(cursor);
		taken = take_text(&fixed, cursor, left);
	} else {
		taken = take_binary(&fixed, left, &rows->unsound);
		cursor->at += taken * fixed.row_bytes;
	}
	rows->row += taken;
	return taken;
}

size_t ply_list_size(ply_rows *rows, size_t list)
{
	ply_cursor *cursor = rows->cursor;
	const ply_property *property = &rows->element->properties[list];
	const size_t begin = cursor->encoding == PLY_ASCII ? 0 : property->offset;
	if (cursor->encoding == PLY_ASCII)
		ply_next_row(cursor);
	if ((size_t)(cursor->end - cursor->at) < begin + 4)
		return 0;
	const unsigned char *at = cursor->at + begin;
	int64_t size = list == 0 && at[1] == ' ' ? *at - '0' : 0;
	if (cursor->encoding != PLY_ASCII)
		size = ply_load_integer(at, property->count_type, ply_swaps(cursor->encoding));
	return size == 3 || size == 4 ? (size_t)size : 0;
}

/* SPDX-License-Identifier: MIT */
/*
 * The rows of the vertex element become arrays of floats. A target says where the values of a property
 * go; properties without one are passed over. Binary rows of fixed size are decoded column by column in
 * blocks that stay in the first-level cache, so that the choice of a type is made once per block.
 *
 * A mesh must be finite, as in OBJ: there is no tangent at NaN and glTF cannot store it. Points are
 * passed through as they are, and so are tangents, which the caller may want to check.
 */
#include "ply/vertices.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "ply/pieces.h"
#include "scene/srgb.h"

/* Positions, normals, texture coordinates, colours, tangents. */
enum { MOST_TARGETS = 3 + 3 + 2 + 4 + 4, BLOCK_ROWS = 512 };

typedef struct target {
	int property;
	float *values;   /* of the first row */
	size_t stride;   /* in floats */
	float divisor;   /* integer colours: their largest value */
	bool finite;     /* other values are refused */
} target;

typedef struct reader {
	const ply_element *element;
	ply_cursor *cursor;
	nt_error *error;
	target targets[MOST_TARGETS];
	size_t target_count;
} reader;

static bool is_finite(float value)
{
	return fabsf(value) <= FLT_MAX;
}

/* Integer colours become 0 to 1, float ones are taken as they are. */
static float colour_divisor(const ply_element *element, int property)
{
	static const float largest[] = {[PLY_INT8] = 127.0f, [PLY_UINT8] = 255.0f,
		[PLY_INT16] = 32767.0f, [PLY_UINT16] = 65535.0f, [PLY_INT32] = 2147483647.0f,
		[PLY_UINT32] = 4294967295.0f, [PLY_FLOAT32] = 1.0f, [PLY_FLOAT64] = 1.0f};
	return largest[element->properties[property].type];
}

/* Allocates an array of `width` floats per row and makes it the target of as many properties. */
static bool add_attribute(reader *r, nt_arena *arena, const int *properties, size_t width,
	bool finite, float **array)
{
	*array = NULL;
	if (properties[0] == PLY_NO_PROPERTY)
		return true;
	*array = nt_arena_alloc(arena, r->element->count, width * sizeof **array);
	for (size_t i = 0; *array && i < width; i++)
		if (properties[i] != PLY_NO_PROPERTY)
			r->targets[r->target_count++] =
				(target){properties[i], *array + i, width, 1.0f, finite};
	return *array != NULL;
}

/* Targets from `first` on are colours. */
static void scale_colors(reader *r, size_t first)
{
	for (size_t i = first; i < r->target_count; i++)
		r->targets[i].divisor = colour_divisor(r->element, r->targets[i].property);
}

static void decode_floats(const unsigned char *from, size_t row_bytes, bool swap, size_t count,
	float *to, size_t stride)
{
	for (size_t i = 0; i < count; i++) {
		const uint32_t bits = ply_load32(from + i * row_bytes, swap);
		memcpy(to + i * stride, &bits, sizeof bits);
	}
}

static void decode_column(const reader *r, const target *t, const unsigned char *rows, size_t first,
	size_t count)
{
	const ply_property *property = &r->element->properties[t->property];
	const size_t row_bytes = r->element->row_bytes;
	const bool swap = ply_swaps(r->cursor->encoding);
	const unsigned char *from = rows + first * row_bytes + property->offset;
	float *to = t->values + first * t->stride;
	if (property->type == PLY_FLOAT32 && t->divisor == 1.0f) {
		decode_floats(from, row_bytes, swap, count, to, t->stride);
		return;
	}
	for (size_t i = 0; i < count; i++)
		to[i * t->stride] =
			ply_load_float(from + i * row_bytes, property->type, swap) / t->divisor;
}

static nt_status fail_not_finite(const reader *r, size_t row, const ply_property *property,
	const unsigned char *at)
{
	return ply_fail_at(r->cursor, at, r->error,
		"%s %zu: property \"%s\" is not finite, expected a finite number", r->element->name, row,
		property->name);
}

/* Looks over what a block has become, while it is in the cache. */
static nt_status check_column(const reader *r, const target *t, size_t first, size_t count)
{
	const float *values = t->values + first * t->stride;
	unsigned bad = 0;
	for (size_t i = 0; i < count; i++)
		bad |= !is_finite(values[i * t->stride]);
	if (!bad)
		return NT_OK;
	size_t row = 0;
	while (is_finite(values[row * t->stride]))
		row++;
	const ply_property *property = &r->element->properties[t->property];
	row += first;
	return fail_not_finite(r, row, property,
		r->cursor->at + row * r->element->row_bytes + property->offset);
}

static nt_status decode_fixed(const reader *r)
{
	const size_t count = r->element->count;
	nt_status status = NT_OK;
	for (size_t first = 0; !status && first < count; first += BLOCK_ROWS) {
		const size_t rows = count - first < BLOCK_ROWS ? count - first : BLOCK_ROWS;
		for (size_t i = 0; !status && i < r->target_count; i++) {
			decode_column(r, &r->targets[i], r->cursor->at, first, rows);
			if (r->targets[i].finite)
				status = check_column(r, &r->targets[i], first, rows);
		}
	}
	if (!status)
		r->cursor->at += count * r->element->row_bytes;
	return status;
}

/* The value of property `number` at `at` to the targets that want it. */
static nt_status decode_value(const reader *r, size_t row, size_t number, const unsigned char *at)
{
	const ply_property *property = &r->element->properties[number];
	const bool swap = ply_swaps(r->cursor->encoding);
	for (size_t k = 0; k < r->target_count; k++) {
		const target *t = &r->targets[k];
		if (t->property != (int)number)
			continue;
		const float value = ply_load_float(at, property->type, swap) / t->divisor;
		if (t->finite && !is_finite(value))
			return fail_not_finite(r, row, property, at);
		t->values[row * t->stride] = value;
	}
	return NT_OK;
}

/* Binary rows with lists: each is measured first, then its values are taken. */
static nt_status decode_listed(const reader *r)
{
	const ply_element *element = r->element;
	const bool swap = ply_swaps(r->cursor->encoding);
	nt_status status = NT_OK;
	for (size_t row = 0; !status && row < element->count; row++) {
		const unsigned char *at = r->cursor->at;
		status = ply_skip_binary_row(r->cursor, element, row, r->error);
		for (size_t i = 0; !status && i < element->property_count; i++) {
			const ply_property *property = &element->properties[i];
			if (property->list) {
				at += ply_size(property->count_type) + ply_size(property->type) *
					(size_t)ply_load_integer(at, property->count_type, swap);
				continue;
			}
			status = decode_value(r, row, i, at);
			at += ply_size(property->type);
		}
	}
	return status;
}

static nt_status fail_value(const reader *r, size_t row, const ply_property *property,
	const unsigned char *at, const char *expected)
{
	char found[40];
	return ply_fail_at(r->cursor, at, r->error, "%s %zu: found %s, expected %s \"%s\"",
		r->element->name, row, ply_show(r->cursor, at, found), expected, property->name);
}

/* Passes over the list at *at. */
static nt_status skip_list(const reader *r, size_t row, const ply_property *property,
	const unsigned char **at)
{
	int64_t count;
	const unsigned char *p = ply_read_integer(*at, r->cursor->end, &count);
	if (!p || count < 0)
		return fail_value(r, row, property, *at, "the length of list");
	for (int64_t i = 0; i < count; i++) {
		p = ply_skip_blanks(p, r->cursor->end);
		const unsigned char *after = ply_skip_value(p, r->cursor->end);
		if (after == p)
			return fail_value(r, row, property, p, "another value of list");
		p = after;
	}
	*at = p;
	return NT_OK;
}

/* One line. `by_property` has the target of each property or NULL. */
static nt_status read_line(const reader *r, size_t row, const target *const *by_property)
{
	const unsigned char *at = r->cursor->at;
	const unsigned char *const end = r->cursor->end;
	for (size_t i = 0; i < r->element->property_count; i++) {
		const ply_property *property = &r->element->properties[i];
		const target *t = by_property[i];
		at = ply_skip_blanks(at, end);
		if (property->list) {
			const nt_status status = skip_list(r, row, property, &at);
			if (status)
				return status;
			continue;
		}
		float value;
		const unsigned char *after = t ? ply_read_float(at, end, &value) : ply_skip_value(at, end);
		if (!after || after == at)
			return fail_value(r, row, property, at, "a number for property");
		if (t && t->finite && !is_finite(value))
			return fail_value(r, row, property, at, "a finite number for property");
		if (t)
			t->values[row * t->stride] = t->divisor == 1.0f ? value : value / t->divisor;
		at = after;
	}
	r->cursor->at = ply_skip_blanks(at, end);
	return NT_OK;
}

/* Where the number of a column goes. */
typedef struct column {
	float *to; /* NULL: nowhere */
	size_t stride;
	float divisor;
	bool finite;
} column;

/* One line of numbers with single blanks between them, far enough from the end of the file; the place
 * behind it, or NULL: read it the general way. */
static inline const char *read_plain_line(const char *at, const char *end, size_t row,
	const column *columns, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		if (end - at <= PLY_DECIMAL_MARGIN)
			return NULL;
		float value;
		at = nt_read_decimal(at, end, &value);
		if (!at || at == end)
			return NULL;
		const column *c = &columns[i];
		if (c->finite && !is_finite(value))
			return NULL;
		if (c->to)
			c->to[row * c->stride] = c->divisor == 1.0f ? value : value / c->divisor;
		if (i + 1 < count && *at++ != ' ')
			return NULL;
	}
	at += *at == '\r' && end - at > 1;
	return *at == '\n' ? at + 1 : NULL;
}

/* Plain lines from a row of the element on. */
typedef struct plain_lines {
	const column *columns;
	size_t column_count, row;
} plain_lines;

static size_t take_plain_lines(void *user, ply_cursor *cursor, size_t first, size_t rows)
{
	const plain_lines *lines = user;
	const char *at = (const char *)cursor->at;
	const char *const end = (const char *)cursor->end;
	size_t taken = 0;
	for (const char *next; taken < rows; at = next, taken++) {
		next = read_plain_line(at, end, lines->row + first + taken, lines->columns, lines->column_count);
		if (!next)
			break;
	}
	cursor->at = (const unsigned char *)at;
	return taken;
}

static nt_status read_any_line(const reader *r, size_t row, const target *const *by_property)
{
	ply_next_row(r->cursor);
	if (r->cursor->at == r->cursor->end)
		return ply_fail_at(r->cursor, r->cursor->at, r->error,
			"the file ends where %s %zu of %zu was expected", r->element->name, row,
			r->element->count);
	const nt_status status = read_line(r, row, by_property);
	return status ? status : ply_check_row_end(r->cursor, r->element, row, r->error);
}

/* Plain lines as long as there are any, then one in the general way, and so on. */
static nt_status read_lines_into(const reader *r, const target **by_property, column *columns)
{
	for (size_t i = 0; i < r->target_count; i++) {
		const target *t = &r->targets[i];
		by_property[t->property] = t;
		columns[t->property] = (column){t->values, t->stride, t->divisor, t->finite};
	}
	nt_status status = NT_OK;
	for (size_t row = 0; !status && row < r->element->count;) {
		if (!r->element->has_list) {
			ply_next_row(r->cursor);
			plain_lines lines = {columns, r->element->property_count, row};
			row += ply_take_pieces(r->cursor, r->element->count - row, take_plain_lines, &lines);
		}
		if (row < r->element->count)
			status = read_any_line(r, row++, by_property);
	}
	return status;
}

static nt_status read_lines(const reader *r)
{
	const size_t count = r->element->property_count;
	const target **by_property = nt_calloc(count, sizeof *by_property);
	column *columns = nt_calloc(count, sizeof *columns);
	const nt_status status = by_property && columns ? read_lines_into(r, by_property, columns)
							   : nt_fail_memory(r->error);
	free((void *)by_property);
	free(columns);
	return status;
}

nt_status ply_read_vertices(nt_scene *scene, nt_mesh *mesh, const ply_source *source,
	ply_cursor *cursor, nt_error *error)
{
	const ply_element *element = source->vertex;
	const ply_roles *roles = &source->roles;
	nt_status status = ply_check_count(cursor, element, error);
	if (status)
		return status;
	reader r = {.element = element, .cursor = cursor, .error = error};
	nt_arena *arena = &scene->arena;
	const bool finite = source->face || source->strips;
	if (!add_attribute(&r, arena, roles->position, 3, finite, &mesh->positions) ||
		!add_attribute(&r, arena, roles->normal, 3, finite, &mesh->normals) ||
		!add_attribute(&r, arena, roles->texcoord, 2, finite, &mesh->texcoords) ||
		!add_attribute(&r, arena, roles->tangent, 4, false, &mesh->tangents))
		return nt_fail_memory(error);
	const size_t first_color = r.target_count;
	if (!add_attribute(&r, arena, roles->color, 4, finite, &mesh->colors))
		return nt_fail_memory(error);
	scale_colors(&r, first_color);
	if (mesh->colors && roles->color[3] == PLY_NO_PROPERTY)
		for (size_t i = 0; i < element->count; i++)
			mesh->colors[4 * i + 3] = 1.0f;

	if (cursor->encoding == PLY_ASCII)
		status = read_lines(&r);
	else if (element->has_list)
		status = decode_listed(&r);
	else
		status = decode_fixed(&r);
	if (!status && mesh->colors)
		nt_linearise(mesh->colors, element->count);
	mesh->vertex_count = element->count;
	return status;
}

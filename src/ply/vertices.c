/* SPDX-License-Identifier: MIT */
/*
 * The rows of the vertex element become arrays of floats. A target says where the values of a property
 * go; properties without one are passed over. Binary rows of fixed size are decoded column by column in
 * blocks that stay in the first-level cache, so that the choice of a type is made once per block.
 *
 * Positions of a mesh must be finite, as in OBJ. Normals and texture coordinates that are not become zeros, with a
 * finding, and colours white, since glTF cannot store NaN. Points are passed through as they are, and so are tangents,
 * which the caller may want to check.
 */
#include "ply/source.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "scene/srgb.h"

/* Positions, normals, texture coordinates, colours, tangents. */
enum { MOST_TARGETS = 3 + 3 + 2 + 4 + 4, BLOCK_ROWS = 512 };

typedef enum finiteness { ANY, MENDED, REFUSED } finiteness;

typedef struct target {
	int property;
	float *values;   /* of the first row */
	double *exact;   /* the same as doubles; then there are no other values */
	size_t stride;   /* in floats */
	float divisor;   /* integer colours: their largest value */
	finiteness other; /* what becomes of other values */
} target;

typedef struct reader {
	const ply_element *element;
	ply_cursor *cursor;
	nt_error *error;
	target targets[MOST_TARGETS];
	size_t target_count;
	bool *unsound; /* set where values are to be mended */
} reader;

static bool is_finite(float value)
{
	return fabsf(value) <= FLT_MAX;
}

/* Allocates an array of `width` floats per row and makes it the target of as many properties. */
static bool add_attribute(reader *r, nt_arena *arena, const int *properties, size_t width,
	finiteness other, float **array)
{
	*array = NULL;
	if (properties[0] == PLY_NO_PROPERTY)
		return true;
	*array = nt_arena_alloc(arena, r->element->count, width * sizeof **array);
	for (size_t i = 0; *array && i < width; i++)
		if (properties[i] != PLY_NO_PROPERTY)
			r->targets[r->target_count++] =
				(target){properties[i], *array + i, NULL, width, 1.0f, other};
	return *array != NULL;
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
		for (size_t i = 0; i < count; i++) {
			const uint32_t bits = ply_load32(from + i * row_bytes, swap);
			memcpy(to + i * t->stride, &bits, sizeof bits);
		}
		return;
	}
	for (size_t i = 0; i < count; i++)
		to[i * t->stride] = ply_load_float(from + i * row_bytes, property->type, swap) / t->divisor;
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
	*r->unsound = true;
	if (t->other == MENDED)
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
			if (r->targets[i].other != ANY)
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
		if (t->exact) {
			t->exact[row * t->stride] = ply_load_double(at, property->type, swap);
			continue;
		}
		const float value = ply_load_float(at, property->type, swap) / t->divisor;
		if (t->other != ANY && !is_finite(value)) {
			if (t->other == REFUSED)
				return fail_not_finite(r, row, property, at);
			*r->unsound = true;
		}
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
			if (!property->list)
				status = decode_value(r, row, i, at);
			at += ply_value_bytes(property, at, swap);
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

/* One line. by_property: of properties that nobody wants the values are NULL. */
static nt_status read_line(const reader *r, size_t row, const target *by_property)
{
	const unsigned char *at = r->cursor->at;
	const unsigned char *const end = r->cursor->end;
	for (size_t i = 0; i < r->element->property_count; i++) {
		const ply_property *property = &r->element->properties[i];
		const target *t = &by_property[i];
		at = ply_skip_blanks(at, end);
		if (property->list) {
			const nt_status status = skip_list(r, row, property, &at);
			if (status)
				return status;
			continue;
		}
		float value;
		const unsigned char *after = t->values ? ply_read_float(at, end, &value) : ply_skip_value(at, end);
		if (t->exact)
			nt_read_double((const char *)at, (const char *)after, &t->exact[row * t->stride]);
		if (!after || after == at)
			return fail_value(r, row, property, at, "a number for property");
		if (t->other != ANY && !is_finite(value)) {
			if (t->other == REFUSED)
				return fail_value(r, row, property, at, "a finite number for property");
			*r->unsound = true;
		}
		if (t->values)
			t->values[row * t->stride] = t->divisor == 1.0f ? value : value / t->divisor;
		at = after;
	}
	r->cursor->at = ply_skip_blanks(at, end);
	return NT_OK;
}

/* One line of numbers with single blanks between them, far enough from the end of the file; the place
 * behind it, or NULL: read it the general way. */
static inline const char *read_plain_line(const char *at, const char *end, size_t row,
	const target *by_property, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		if (end - at <= PLY_DECIMAL_MARGIN)
			return NULL;
		float value;
		at = nt_read_decimal(at, end, &value);
		if (!at || at == end)
			return NULL;
		const target *t = &by_property[i];
		if (t->other != ANY && !is_finite(value))
			return NULL;
		if (t->values)
			t->values[row * t->stride] = t->divisor == 1.0f ? value : value / t->divisor;
		if (i + 1 < count && *at++ != ' ')
			return NULL;
	}
	at += *at == '\r' && end - at > 1;
	return *at == '\n' ? at + 1 : NULL;
}

/* Plain lines from a row of the element on. */
typedef struct plain_lines {
	const target *by_property;
	size_t property_count, row;
} plain_lines;

static size_t take_plain_lines(void *user, ply_cursor *cursor, size_t first, size_t rows)
{
	const plain_lines *lines = user;
	const char *at = (const char *)cursor->at;
	const char *const end = (const char *)cursor->end;
	size_t taken = 0;
	for (const char *next; taken < rows; at = next, taken++) {
		next = read_plain_line(at, end, lines->row + first + taken, lines->by_property, lines->property_count);
		if (!next)
			break;
	}
	cursor->at = (const unsigned char *)at;
	return taken;
}

/* Plain lines as long as there are any, then one in the general way, and so on. */
static nt_status read_lines(const reader *r)
{
	ply_cursor *cursor = r->cursor;
	const ply_element *element = r->element;
	target *by_property = nt_calloc(element->property_count, sizeof *by_property);
	if (!by_property)
		return nt_fail_memory(r->error);
	for (size_t i = 0; i < r->target_count; i++)
		by_property[r->targets[i].property] = r->targets[i];
	nt_status status = NT_OK;
	for (size_t row = 0; !status && row < element->count;) {
		if (!element->has_list && !r->targets[0].exact) {
			ply_next_row(cursor);
			plain_lines lines = {by_property, element->property_count, row};
			row += ply_take_pieces(cursor, element->count - row, take_plain_lines, &lines);
		}
		if (row == element->count)
			break;
		ply_next_row(cursor);
		status = cursor->at == cursor->end ? ply_fail_end(cursor, element, row, r->error)
						   : read_line(r, row, by_property);
		if (!status)
			status = ply_check_row_end(cursor, element, row++, r->error);
	}
	free(by_property);
	return status;
}

/* Rows of normals or texture coordinates that are not finite become zeros. */
static void mend_rows(nt_scene *scene, float *values, size_t width, size_t count, nt_code code)
{
	size_t bad = 0, first = 0;
	for (size_t row = 0; values && row < count; row++) {
		bool sound = true;
		for (size_t k = 0; k < width; k++)
			sound &= is_finite(values[row * width + k]);
		if (sound)
			continue;
		memset(values + row * width, 0, width * sizeof *values);
		first = bad++ ? first : row;
	}
	if (bad)
		nt_finding_add(&scene->findings, code, NULL, bad, "vertex %zu is the first", first);
}

bool ply_has_wide_positions(const ply_source *source)
{
	bool wide = false;
	for (size_t k = 0; k < 3; k++) {
		const ply_type type = source->vertex->properties[source->roles.position[k]].type;
		wide |= type == PLY_FLOAT64 || type == PLY_INT32 || type == PLY_UINT32;
	}
	return wide;
}

nt_status ply_read_exact_positions(const ply_source *source, ply_cursor *cursor, double *positions, nt_error *error)
{
	bool unsound = false;
	reader r = {.element = source->vertex, .cursor = cursor, .error = error, .unsound = &unsound,
		.target_count = 3};
	for (size_t k = 0; k < 3; k++)
		r.targets[k] = (target){.property = source->roles.position[k], .exact = positions + k, .stride = 3};
	return cursor->encoding == PLY_ASCII ? read_lines(&r) : decode_listed(&r);
}

nt_status ply_read_vertices(nt_scene *scene, nt_mesh *mesh, ply_source *source,
	ply_cursor *cursor, nt_error *error)
{
	const ply_element *element = source->vertex;
	const ply_roles *roles = &source->roles;
	source->vertex_begin = (size_t)(cursor->at - cursor->begin);
	nt_status status = ply_check_count(cursor, element, error);
	if (status)
		return status;
	bool unsound = false;
	reader r = {.element = element, .cursor = cursor, .error = error, .unsound = &unsound};
	nt_arena *arena = &scene->arena;
	const bool mesh_of_faces = source->face || source->strips;
	const finiteness other = mesh_of_faces ? MENDED : ANY;
	if (!add_attribute(&r, arena, roles->position, 3, mesh_of_faces ? REFUSED : ANY, &mesh->positions) ||
		!add_attribute(&r, arena, roles->normal, 3, other, &mesh->normals) ||
		!add_attribute(&r, arena, roles->texcoord, 2, other, &mesh->texcoords) ||
		!add_attribute(&r, arena, roles->tangent, 4, ANY, &mesh->tangents))
		return nt_fail_memory(error);
	const size_t first_color = r.target_count;
	if (!add_attribute(&r, arena, roles->color, 4, ANY, &mesh->colors))
		return nt_fail_memory(error);
	/* integer colours become 0 to 1, float ones are taken as they are */
	for (size_t i = first_color; i < r.target_count; i++)
		r.targets[i].divisor = (float)ply_one(element->properties[r.targets[i].property].type);
	if (mesh->colors && roles->color[3] == PLY_NO_PROPERTY)
		for (size_t i = 0; i < element->count; i++)
			mesh->colors[4 * i + 3] = 1.0f;

	if (cursor->encoding == PLY_ASCII)
		status = read_lines(&r);
	else if (element->has_list)
		status = decode_listed(&r);
	else
		status = decode_fixed(&r);
	if (!status && unsound) {
		mend_rows(scene, mesh->normals, 3, element->count, NT_CODE_MESH_NORMAL_ZERO);
		mend_rows(scene, mesh->texcoords, 2, element->count, NT_CODE_UV_NOT_FINITE);
	}
	if (!status && mesh->colors)
		nt_linearise(scene, mesh, element->count);
	mesh->vertex_count = element->count;
	return status;
}

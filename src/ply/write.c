/* SPDX-License-Identifier: MIT */
/*
 * Writing PLY. The vertices that are written are a table of columns: properties of the source whose bytes stay, and
 * values of the scene's meshes.
 *
 * From a PLY, the file is written as it was, with the tangents added. Encoding, comments, elements, properties and
 * their order stay; rows are copied as bytes, so that what nmtan does not know goes along. New vertices are appended
 * with the whole row of the vertex they are copies of. Faces are rewritten only if there are new vertices, and keep
 * their corner count and order; a larger polygon whose triangles disagree about the vertex of a corner is replaced by
 * those triangles. Per-face texture coordinates stay where they are: vertices that were told apart only by them become
 * one again if their tangents are equal.
 *
 * From any other scene one binary little endian mesh in world space is written: world.c has its values. Texture
 * coordinates are called s and t, as MeshLab, Blender and trimesh read them (MeshLab does not read u and v), and a
 * comment names the one image that a PLY can have: texture.c.
 */
#include "ply/ply.h"

#include <stdio.h>
#include <stdlib.h>
#include "base/buffer.h"
#include "base/vec.h"
#include "ply/parts.h"

enum { DRAIN_BYTES = 64 * 1024, MOST_VALUE = NT_FLOAT_TEXT + 1 };

/* A property of the vertices that are written: bytes of the source, if there are any and the value is the same. */
typedef struct column {
	int property; /* of the source; PLY_NO_PROPERTY: it is new */
	int value;    /* ply_value; -1: the source's bytes stay */
	ply_type type;
} column;

typedef struct writer {
	nt_scene *scene;
	const ply_source *source; /* NULL: the scene is not that of a PLY */
	nt_error *error;
	nt_buffer buffer;         /* what has not been written yet */
	nt_sink *sink;
	ply_encoding encoding;
	const char *newline;
	column *columns;
	size_t column_count, old_count; /* the source's come first */
	bool rows_stay;           /* all properties of the source keep their bytes */
	ply_type index_type;      /* of the faces written */

	/* of a PLY */
	const nt_mesh *mesh;
	ply_numbering n;
	ply_cursor cursor;
	ply_rows vertices, faces;
	size_t *row_offsets;      /* [row_count] where the row of a vertex begins */
	bool new_normals, new_tangents, new_bitangents;
} writer;

static const char *const value_names[PLY_VALUES] = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha",
	"s", "t", "tx", "ty", "tz", "tw", "bx", "by", "bz"};

/* ---- values ---- */

/* The low bytes of a number in the order of the encoding. */
static inline char *store_bits(const writer *w, uint64_t bits, size_t size, char *to)
{
	for (size_t i = 0; i < size; i++)
		to[w->encoding == PLY_BIG ? size - 1 - i : i] = (char)(bits >> 8 * i);
	return to + size;
}

/* A value that a property of that type holds; of an integer type 1 is its largest number, as of normals. */
static char *store_other_value(const writer *w, double value, ply_type type, char *to)
{
	uint64_t bits = 0;
	if (type < PLY_FLOAT32) {
		const double clamped = value < -1 ? -1 : value > 1 ? 1 : value;
		const int32_t number = (int32_t)rint(clamped * ply_one(type));
		if (w->encoding == PLY_ASCII)
			return to + snprintf(to, MOST_VALUE, "%d", (int)number);
		bits = (uint32_t)number;
	} else if (w->encoding == PLY_ASCII) {
		return nt_write_float(to, (float)value);
	} else {
		memcpy(&bits, &value, sizeof value);
	}
	return store_bits(w, bits, ply_size(type), to);
}

static inline char *store_value(const writer *w, double value, ply_type type, char *to)
{
	if (type != PLY_FLOAT32 || w->encoding == PLY_ASCII)
		return store_other_value(w, value, type, to);
	const float single = (float)value;
	uint32_t bits;
	memcpy(&bits, &single, sizeof bits);
	bits = ply_swaps(w->encoding) ? __builtin_bswap32(bits) : bits;
	memcpy(to, &bits, sizeof bits);
	return to + sizeof bits;
}

static inline char *store_integer(const writer *w, uint32_t value, ply_type type, char *to)
{
	char text[MOST_VALUE];
	size_t begin = sizeof text;
	if (w->encoding != PLY_ASCII)
		return store_bits(w, value, ply_size(type), to);
	do
		text[--begin] = (char)('0' + value % 10);
	while (value /= 10);
	memcpy(to, text + begin, sizeof text - begin);
	return to + sizeof text - begin;
}

/* A list of integers. */
static void put_list(writer *w, ply_type count_type, const uint32_t *values, size_t count, ply_type type)
{
	char bytes[512], *end = store_integer(w, (uint32_t)count, count_type, bytes);
	for (size_t k = 0; k < count; k++) {
		if ((size_t)(end - bytes) > sizeof bytes - MOST_VALUE) {
			nt_buffer_append(&w->buffer, bytes, (size_t)(end - bytes));
			end = bytes;
		}
		if (w->encoding == PLY_ASCII)
			*end++ = ' ';
		end = store_integer(w, values[k], type, end);
	}
	nt_buffer_append(&w->buffer, bytes, (size_t)(end - bytes));
}

static void put_cell(writer *w, const unsigned char *begin, const unsigned char *end)
{
	nt_buffer_append(&w->buffer, begin, (size_t)(end - begin));
}

/* Between the values of a row of text. */
static void put_gap(writer *w, bool first)
{
	if (w->encoding == PLY_ASCII && !first)
		nt_buffer_append(&w->buffer, " ", 1);
}

/* Writes the buffer and then these bytes. */
static nt_status put_bytes(writer *w, const void *bytes, size_t size)
{
	if (w->buffer.failed)
		return nt_fail_memory(w->error);
	const nt_status status = nt_sink_write(w->sink, w->buffer.data, w->buffer.size, w->error);
	w->buffer.size = 0;
	return status || size == 0 ? status : nt_sink_write(w->sink, bytes, size, w->error);
}

/* Writes the buffer if it has become long; reports what failed since the last row. */
static nt_status end_row(writer *w)
{
	if (w->encoding == PLY_ASCII)
		nt_buffer_text(&w->buffer, w->newline);
	if (w->buffer.failed)
		return nt_fail_memory(w->error);
	return w->buffer.size < DRAIN_BYTES ? NT_OK : put_bytes(w, NULL, 0);
}

/* The reader has checked the rows; checked again is that the mapped file has not shrunk or changed. */
static nt_status fail_changed(const writer *w)
{
	return w->error->status == NT_ERROR_MEMORY ? NT_ERROR_MEMORY
		: nt_fail(w->error, NT_ERROR_IO, "the file changed while it was read");
}

/* ---- columns ---- */

static void add_column(writer *w, int property, int value, ply_type type)
{
	w->columns[w->column_count++] = (column){property, value, type};
}

static void add_new_columns(writer *w, int first, int count, ply_type type)
{
	for (int i = first; i < first + count; i++)
		add_column(w, PLY_NO_PROPERTY, i, type);
}

/* Whether new values take the place and the type of properties that are there under their names: all of them, or none.
 * integers: their types may be signed integers, too. */
static bool fit_in_place(const ply_element *vertex, int first, int count, bool integers)
{
	bool fit = true;
	for (int i = first; i < first + count; i++) {
		const int found = ply_find_property(vertex, value_names[i]);
		const ply_property *property = found == PLY_NO_PROPERTY ? NULL : &vertex->properties[found];
		const ply_type type = property ? property->type : PLY_UINT8;
		const bool is_signed = type == PLY_INT8 || type == PLY_INT16 || type == PLY_INT32;
		fit = fit && property && !property->list && (type >= PLY_FLOAT32 || (integers && is_signed));
	}
	return fit;
}

/* The columns of a PLY. A name may be there more than once; a reader could take what stays for what is new, so that the
 * later ones go. */
static void find_old_columns(writer *w)
{
	const ply_element *vertex = w->source->vertex;
	const struct {
		bool written, integers;
		int first, count;
	} groups[] = {{w->new_normals, true, PLY_NX, 3}, {w->new_tangents, false, PLY_TX, 4},
		{w->new_bitangents, false, PLY_BX, 3}};
	bool placed[PLY_VALUES] = {false}, fit[3];
	for (size_t g = 0; g < 3; g++)
		fit[g] = fit_in_place(vertex, groups[g].first, groups[g].count, groups[g].integers);
	w->rows_stay = true;
	for (size_t i = 0; i < vertex->property_count; i++) {
		int value = -1;
		bool stays = true;
		for (size_t g = 0; g < 3; g++)
			for (int v = groups[g].first; groups[g].written && v < groups[g].first + groups[g].count; v++)
				if (strcmp(vertex->properties[i].name, value_names[v]) == 0) {
					value = v;
					stays = fit[g] && !placed[v];
					placed[v] = true;
				}
		if (stays)
			add_column(w, (int)i, value, vertex->properties[i].type);
		w->rows_stay &= value < 0;
	}
	w->old_count = w->column_count;
	for (size_t g = 0; g < 3; g++)
		if (groups[g].written && !fit[g])
			add_new_columns(w, groups[g].first, groups[g].count, PLY_FLOAT32);
}

static void put_new_properties(writer *w)
{
	for (size_t i = w->old_count; i < w->column_count; i++)
		nt_buffer_format(&w->buffer, "property %s %s%s", ply_type_name(w->columns[i].type),
			value_names[w->columns[i].value], w->newline);
}

/* One row of vertices; old: bytes of the whole row, if rows stay. */
static nt_status put_vertex(writer *w, ply_cell old, const double *values)
{
	char bytes[PLY_VALUES * MOST_VALUE], *end = bytes;
	size_t i = 0;
	if (w->rows_stay) {
		put_cell(w, old.begin, old.end);
		i = w->old_count;
	}
	for (; i < w->old_count; i++) {
		const column *c = &w->columns[i];
		const ply_cell *cell = &w->vertices.cells[c->property];
		float was;
		const bool same = c->value < 0 || (ply_cell_float(&w->vertices, (size_t)c->property, &was) &&
			memcmp(&was, &(float){(float)values[c->value]}, sizeof was) == 0);
		put_gap(w, i == 0);
		if (same) {
			put_cell(w, cell->begin, cell->end);
		} else {
			end = store_value(w, values[c->value], c->type, bytes);
			nt_buffer_append(&w->buffer, bytes, (size_t)(end - bytes));
			end = bytes;
		}
	}
	for (; i < w->column_count; i++) {
		if (w->encoding == PLY_ASCII)
			*end++ = ' ';
		end = store_value(w, values[w->columns[i].value], w->columns[i].type, end);
	}
	nt_buffer_append(&w->buffer, bytes, (size_t)(end - bytes));
	return end_row(w);
}

/* ---- faces ---- */

/* The faces of a mesh; base: the number of its first vertex, unless it is a PLY's. The first corner stays the first if
 * a face is turned round. */
static nt_status put_mesh_faces(writer *w, const nt_mesh *mesh, size_t base, bool mirrored)
{
	const uint32_t *indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	nt_status status = NT_OK;
	for (size_t f = 0, corner = 0; !status && f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		uint32_t vertices[4];
		for (size_t k = 0; k < size; k++) {
			const size_t c = corner + (mirrored && k > 0 ? size - k : k);
			vertices[k] = w->source ? ply_output_vertex(&w->n, c)
				: (uint32_t)(base + (indices ? indices[c] : c));
		}
		put_list(w, PLY_UINT8, vertices, size, w->index_type);
		status = end_row(w);
		corner += size;
	}
	return status;
}

/* The row of the source that was read last with other vertices; corners: the corners of the polygon that they are, if
 * it is a triangle of one; NULL: all. */
static nt_status put_face(writer *w, const uint32_t *vertices, size_t count, const uint32_t *corners)
{
	const ply_element *element = w->source->face;
	const size_t texcoords = (size_t)w->source->face_texcoords;
	for (size_t i = 0; i < element->property_count; i++) {
		const ply_property *property = &element->properties[i];
		const ply_cell all = w->faces.cells[i];
		const bool part = corners && i == texcoords && all.count;
		char length[MOST_VALUE];
		put_gap(w, i == 0);
		if ((int)i == w->source->face_indices)
			put_list(w, property->count_type, vertices, count, w->index_type);
		else if (!part)
			put_cell(w, all.begin, all.end);
		const char *end = part ? store_integer(w, 6, property->count_type, length) : length;
		nt_buffer_append(&w->buffer, length, (size_t)(end - length));
		for (size_t k = 0; part && k < 6; k++) {
			const ply_cell one = ply_cell_value(&w->faces, texcoords, 2 * corners[k / 2] + k % 2);
			put_gap(w, false);
			put_cell(w, one.begin, one.end);
		}
	}
	return end_row(w);
}

/* Puts the polygon in the next row, whose corners and cut begin there; moves both behind it. */
static nt_status put_polygon(writer *w, size_t *corner, size_t *cut, uint32_t **vertices, size_t *capacity)
{
	if (ply_read_row(&w->faces, w->error))
		return fail_changed(w);
	const size_t size = w->faces.cells[w->source->face_indices].count;
	const size_t corners = size < 3 ? 0 : size < 5 ? size : 3 * (size - 2);
	const uint32_t *own = w->source->cuts ? w->source->cuts + *cut : NULL;
	if (!nt_grow((void **)vertices, capacity, size, sizeof **vertices))
		return nt_fail_memory(w->error);
	if (corners > w->mesh->corner_count - *corner || (size > 4 && corners > w->source->cut_count - *cut))
		return fail_changed(w);
	nt_status status = NT_OK;
	if (size < 3) {
		/* no face of the mesh: its vertices stay */
		for (size_t k = 0; k < size; k++)
			(*vertices)[k] = (uint32_t)ply_cell_integer(&w->faces, (size_t)w->source->face_indices, k);
		status = put_face(w, *vertices, size, NULL);
	} else if (size > 4 && !ply_resolve_polygon(&w->n, *corner, size, own, *vertices)) {
		for (size_t t = 0; !status && t < corners; t += 3) {
			for (size_t k = 0; k < 3; k++)
				(*vertices)[k] = ply_output_vertex(&w->n, *corner + t + k);
			status = put_face(w, *vertices, 3, own + t);
		}
	} else {
		for (size_t k = 0; size < 5 && k < size; k++)
			(*vertices)[k] = ply_output_vertex(&w->n, *corner + k);
		status = put_face(w, *vertices, size, NULL);
	}
	*corner += corners;
	*cut += size > 4 ? corners : 0;
	return status;
}

/* ---- from a PLY ---- */

static bool faces_change(const writer *w)
{
	return w->n.appended_count > 0 || w->n.cut_polygons > 0;
}

static bool replaces_strips(const writer *w)
{
	return w->source->strips && faces_change(w);
}

/* The type of indices, wider if the vertices have become too many for the source's. */
static ply_type find_index_type(const writer *w)
{
	static const size_t largest[] = {[PLY_INT8] = INT8_MAX, [PLY_UINT8] = UINT8_MAX, [PLY_INT16] = INT16_MAX,
		[PLY_UINT16] = UINT16_MAX, [PLY_INT32] = INT32_MAX, [PLY_UINT32] = UINT32_MAX};
	const ply_element *element = w->source->face ? w->source->face : w->source->strips;
	const size_t count = w->n.row_count + w->n.appended_count;
	const ply_type type = element ? element->properties[w->source->face_indices].type : PLY_UINT32;
	return count == 0 || count - 1 <= largest[type] ? type : count - 1 > INT32_MAX ? PLY_UINT32 : PLY_INT32;
}

/* The line of an element, with its new count; false: its properties are to be left out. */
static bool put_element_line(writer *w, const ply_element *element, const char *line, size_t size)
{
	const ply_source *source = w->source;
	size_t count = element->count;
	if (replaces_strips(w) && element == source->strips) {
		nt_buffer_format(&w->buffer, "element face %zu%sproperty list uchar %s vertex_indices%s",
			w->mesh->face_count, w->newline, ply_type_name(w->index_type), w->newline);
		return false;
	}
	/* an empty element "face" beside strips would come twice */
	if (replaces_strips(w) && strcmp(element->name, "face") == 0)
		return false;
	if (element == source->vertex)
		count += w->n.appended_count;
	else if (element == source->face)
		count += w->n.added_faces;
	if (count != element->count)
		nt_buffer_format(&w->buffer, "element %s %zu%s", element->name, count, w->newline);
	else
		nt_buffer_append(&w->buffer, line, size);
	return true;
}

/* next: the first of the old columns that has not been met; they are in the order of properties. */
static void put_property_line(writer *w, const ply_element *element, size_t number, const char *line, size_t size,
	size_t *next)
{
	const ply_property *property = &element->properties[number];
	bool stays = element != w->source->vertex;
	if (!stays && *next < w->old_count && w->columns[*next].property == (int)number) {
		stays = true;
		++*next;
	}
	if (element == w->source->face && (int)number == w->source->face_indices && w->index_type != property->type)
		nt_buffer_format(&w->buffer, "property list %s %s %s%s", ply_type_name(property->count_type),
			ply_type_name(w->index_type), property->name, w->newline);
	else if (stays)
		nt_buffer_append(&w->buffer, line, size);
	if (element == w->source->vertex && number + 1 == element->property_count)
		put_new_properties(w);
}

/* Walks the lines of the source's header once more. */
static void put_old_header(writer *w)
{
	const ply_header *header = &w->source->header;
	const ply_element *element = header->elements;
	size_t property = 0, next = 0;
	bool stays = true;
	ply_line line;
	for (size_t begin = 0; begin < header->body; begin = line.next) {
		line = ply_header_line(header, w->scene->bytes, header->body, begin);
		const char *at = line.text;
		const ply_word word = ply_next_word(&at, line.text + line.length);
		const size_t size = line.next - begin;
		if (ply_word_is(word, "element")) {
			stays = put_element_line(w, element++, line.text, size);
			property = 0;
		} else if (ply_word_is(word, "property")) {
			if (stays)
				put_property_line(w, element - 1, property, line.text, size, &next);
			property++;
		} else {
			nt_buffer_append(&w->buffer, line.text, size);
		}
	}
}

/* The row at the cursor as that of a vertex. */
static nt_status put_old_vertex(writer *w, size_t vertex)
{
	const ply_element *element = w->source->vertex;
	const bool ascii = w->encoding == PLY_ASCII;
	if (ascii)
		ply_next_row(&w->cursor);
	ply_cell row = {.begin = w->cursor.at, .end = w->cursor.at};
	if (w->rows_stay && ascii) {
		while (row.end < w->cursor.end && !ply_is_line_end(*row.end))
			row.end++;
		w->cursor.at = row.end;
		while (row.end > row.begin && ply_is_blank(row.end[-1]))
			row.end--;
	} else if (w->rows_stay && !element->has_list) {
		w->cursor.at = row.end += element->row_bytes;
	} else {
		w->vertices.row = 0;
		if (ply_read_row(&w->vertices, w->error))
			return fail_changed(w);
		row.end = w->cursor.at;
	}
	const float *n = w->mesh->normals ? w->mesh->normals + 3 * ply_mesh_vertex(&w->n, vertex) : NULL;
	const float *t = w->new_tangents ? w->mesh->split.vertex_tangents + 4 * vertex : NULL;
	double values[PLY_VALUES];
	float b[3];
	if (w->new_bitangents)
		nt_bitangent(n, t, b);
	for (size_t i = 0; i < 3; i++) {
		values[PLY_NX + i] = w->new_normals ? n[i] : 0;
		values[PLY_BX + i] = w->new_bitangents ? b[i] : 0;
	}
	for (size_t i = 0; i < 4; i++)
		values[PLY_TX + i] = t ? t[i] : 0;
	return put_vertex(w, row, values);
}

static nt_status put_old_vertices(writer *w)
{
	nt_status status = NT_OK;
	for (size_t row = 0; !status && row < w->n.row_count; row++) {
		w->row_offsets[row] = (size_t)(w->cursor.at - w->cursor.begin);
		status = put_old_vertex(w, row);
	}
	const unsigned char *after = w->cursor.at;
	for (size_t i = 0; !status && i < w->n.appended_count; i++) {
		w->cursor.at = w->cursor.begin + w->row_offsets[ply_source_row(&w->n, w->n.appended[i])];
		status = put_old_vertex(w, w->n.appended[i]);
	}
	w->cursor.at = after;
	return status;
}

static nt_status put_old_faces(writer *w)
{
	size_t corner = 0, cut = 0, capacity = 0;
	uint32_t *vertices = NULL;
	nt_status status = NT_OK;
	while (!status && w->faces.row < w->source->face->count)
		status = put_polygon(w, &corner, &cut, &vertices, &capacity);
	free(vertices);
	return status;
}

/* An element as it is. */
static nt_status copy_element(writer *w, const ply_element *element)
{
	if (w->encoding == PLY_ASCII)
		ply_next_row(&w->cursor);
	const unsigned char *begin = w->cursor.at;
	nt_status status = NT_OK;
	if (element == w->source->face || element == w->source->strips)
		w->cursor.at = w->cursor.begin + w->source->face_end;
	else
		status = ply_skip_element(&w->cursor, element, w->error);
	if (status || begin >= w->cursor.at)
		return status;
	/* the reader may have stopped before or behind the end of the last line */
	const unsigned char *end = w->cursor.at;
	while (w->encoding == PLY_ASCII && ply_is_space(end[-1]))
		end--;
	status = put_bytes(w, begin, (size_t)(end - begin));
	return status ? status : end_row(w);
}

static nt_status put_old_body(writer *w)
{
	const ply_source *source = w->source;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < source->header.element_count; i++) {
		const ply_element *element = &source->header.elements[i];
		if (element == source->vertex) {
			status = put_old_vertices(w);
		} else if (element == source->face && faces_change(w)) {
			status = put_old_faces(w);
		} else if (element == source->strips && faces_change(w)) {
			w->cursor.at = w->cursor.begin + source->face_end;
			status = put_mesh_faces(w, w->mesh, 0, false);
		} else {
			status = copy_element(w, element);
		}
	}
	if (w->encoding == PLY_ASCII)
		ply_next_row(&w->cursor);
	return status ? status : put_bytes(w, w->cursor.at, (size_t)(w->cursor.end - w->cursor.at));
}

static nt_status write_changed(writer *w, bool bitangents)
{
	const ply_source *source = w->source;
	const ply_element *vertex = source->vertex;
	nt_place place;
	if (!ply_number_vertices(&w->n, w->mesh, source))
		return nt_fail_memory(w->error);
	w->columns = nt_alloc(vertex->property_count + PLY_VALUES, sizeof *w->columns);
	w->row_offsets = nt_alloc(w->n.row_count, sizeof *w->row_offsets);
	if (!w->columns || !w->row_offsets || !ply_begin_rows(&w->vertices, &w->cursor, vertex) ||
		(source->face && !ply_begin_rows(&w->faces, &w->cursor, source->face)))
		return nt_fail_memory(w->error);
	w->faces.may_be_longer = true;
	/* bitangents of other tangents must not stay */
	w->new_bitangents = w->new_tangents && w->mesh->normals &&
		(bitangents || ply_find_property(vertex, "bx") != PLY_NO_PROPERTY);
	find_old_columns(w);
	w->index_type = find_index_type(w);
	nt_mesh_place(w->mesh, &place);
	if (w->n.cut_polygons > 0)
		nt_finding_add(&w->scene->findings, NT_CODE_POLYGON_CUT, &place, w->n.cut_polygons, NULL);
	if (replaces_strips(w))
		nt_finding_add(&w->scene->findings, NT_CODE_POLYGON_CUT, &place, source->strips->count,
			"triangle strips");
	put_old_header(w);
	return put_old_body(w);
}

static nt_status write_source(writer *w, bool bitangents)
{
	const nt_mesh *mesh = w->scene->meshes;
	w->source = w->scene->source;
	w->mesh = mesh;
	w->encoding = w->source->header.encoding;
	w->newline = w->source->header.newline;
	w->cursor = ply_begin_body(w->scene, &w->source->header, 1);
	/* integers hold no unit vectors */
	w->new_normals = mesh->normals_made ||
		(mesh->scaled_normals && fit_in_place(w->source->vertex, PLY_NX, 3, false));
	w->new_tangents = mesh->split.vertex_tangents != NULL;
	if (!w->new_normals && !w->new_tangents)
		return put_bytes(w, w->scene->bytes, w->scene->byte_count);
	return write_changed(w, bitangents);
}

/* ---- from another scene ---- */

/* texture: the name of the image; NULL: none */
static void put_new_header(writer *w, const ply_world *world, const char *texture)
{
	nt_buffer *b = &w->buffer;
	add_new_columns(w, PLY_X, 3, world->doubles ? PLY_FLOAT64 : PLY_FLOAT32);
	if (world->normals)
		add_new_columns(w, PLY_NX, 3, PLY_FLOAT32);
	if (world->colors)
		add_new_columns(w, PLY_RED, 4, world->byte_colors ? PLY_UINT8 : PLY_FLOAT32);
	if (world->texcoords)
		add_new_columns(w, PLY_S, 2, PLY_FLOAT32);
	if (world->tangents)
		add_new_columns(w, PLY_TX, 4, PLY_FLOAT32);
	if (world->bitangents)
		add_new_columns(w, PLY_BX, 3, PLY_FLOAT32);
	nt_buffer_text(b, "ply\nformat binary_little_endian 1.0\ncomment nmtan " NMTAN_VERSION_STRING "\n");
	if (texture)
		nt_buffer_format(b, "comment TextureFile %s\n", texture);
	nt_buffer_format(b, "element vertex %zu\n", world->vertex_count);
	put_new_properties(w);
	nt_buffer_format(b, "element face %zu\nproperty list uchar %s vertex_indices\nend_header\n", world->face_count,
		world->vertex_count > INT32_MAX ? "uint" : "int");
}

static nt_status put_world(writer *w, const ply_world *world)
{
	const nt_scene *scene = w->scene;
	nt_status status = NT_OK;
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		const ply_placement placement = ply_find_placement(&scene->instances[i]);
		for (size_t v = 0; !status && v < ply_world_vertices(mesh); v++) {
			double values[PLY_VALUES];
			status = ply_world_vertex(world, &placement, mesh, v, values, w->error);
			if (!status)
				status = put_vertex(w, (ply_cell){0}, values);
		}
	}
	size_t base = 0;
	for (size_t i = 0; !status && i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		if (ply_world_vertices(mesh))
			status = put_mesh_faces(w, mesh, base, ply_find_placement(&scene->instances[i]).mirrored);
		base += ply_world_vertices(mesh);
	}
	return status;
}

static nt_status write_world(writer *w, const nt_write_options *options, nt_output *set)
{
	nt_buffer texture = {0};
	ply_world world;
	ply_find_world(&world, w->scene, options->bitangents);
	if (world.vertex_count > UINT32_MAX || world.face_count > UINT32_MAX)
		return nt_fail(w->error, NT_ERROR_TOO_LARGE,
			"the instances have %zu vertices and %zu faces together, more than PLY can number",
			world.vertex_count, world.face_count);
	w->encoding = PLY_LITTLE;
	w->newline = "\n";
	w->index_type = PLY_UINT32;
	w->columns = nt_alloc(PLY_VALUES, sizeof *w->columns);
	nt_status status = w->columns ? ply_settle_texture(&texture, w->scene, options, set, w->error)
		: nt_fail_memory(w->error);
	if (!status)
		put_new_header(w, &world, texture.size ? texture.data : NULL);
	nt_buffer_free(&texture);
	return status ? status : put_world(w, &world);
}

nt_status nt_ply_write(nt_scene *scene, const nt_write_options *options, nt_output *output, nt_error *error)
{
	writer w = {.scene = scene, .error = error};
	nt_status status = nt_output_add(output, options->path, NT_ROLE_MAIN, &w.sink, error);
	if (!status)
		status = scene->format == NT_FORMAT_PLY ? write_source(&w, options->bitangents)
			: write_world(&w, options, output);
	if (!status && scene->format == NT_FORMAT_PLY)
		ply_tell_left(scene, options);
	if (!status)
		status = put_bytes(&w, NULL, 0);
	nt_buffer_free(&w.buffer);
	ply_numbering_free(&w.n);
	ply_free_rows(&w.vertices);
	ply_free_rows(&w.faces);
	free(w.columns);
	free(w.row_offsets);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * PLY from a PLY: the file as it was, with the tangents added. Encoding, comments, elements, properties
 * and their order stay; rows are copied as bytes, so that what nmtan does not know goes along.
 *
 * New vertices are appended with the whole row of the vertex they are copies of. Faces are rewritten
 * only when there are new vertices, and keep their corner count and order; a larger polygon whose
 * triangles disagree about the vertex of a corner is replaced by those triangles. Per-face texture
 * coordinates stay where they are: vertices that were told apart only by them become one again where
 * their tangents are equal.
 */
#include "ply/encode.h"

#include <stdlib.h>
#include "base/vec.h"
#include "ply/vertex_map.h"

typedef struct plan {
	nt_scene *scene;
	const nt_mesh *mesh;
	const ply_source *source;
	ply_output *out;
	nt_error *error;
	ply_cursor cursor;

	ply_numbering n;

	bool new_normals, new_tangents, new_bitangents;
	int *instead;            /* [properties of vertex] which of the new values takes its place, KEPT or DROPPED */
	bool changes_any;
	const char *names[PLY_MOST_FLOATS]; /* of the new values */
	bool appended[PLY_MOST_FLOATS];     /* as new properties behind the others */
	size_t value_count;

	ply_type index_type;     /* of the faces written */
	ply_rows vertices, faces; /* of the source */
	size_t *row_offsets;     /* [row_count] where the row of a vertex begins */
} plan;

/* Changes of the header. */

enum { KEPT = -1, DROPPED = -2 };

/* New values take the place and the type of properties that are there under their names: all of them, or none.
 * integers: their types may be signed integers, too. A name may be there more than once; a reader could take what stays
 * for what is new. */
static void add_values(plan *p, const char *const *names, size_t count, bool integers)
{
	const ply_element *vertex = p->source->vertex;
	bool in_place = true;
	for (size_t i = 0; i < count; i++) {
		const int found = ply_find_property(vertex, names[i]);
		const ply_property *property = found == PLY_NO_PROPERTY ? NULL : &vertex->properties[found];
		in_place &= property && !property->list &&
			(property->type >= PLY_FLOAT32 || (integers && (property->type == PLY_INT8 ||
				property->type == PLY_INT16 || property->type == PLY_INT32)));
	}
	for (size_t i = 0; i < count; i++) {
		p->names[p->value_count] = names[i];
		p->appended[p->value_count] = !in_place;
		int instead = in_place ? (int)p->value_count : DROPPED;
		for (size_t k = 0; k < vertex->property_count; k++)
			if (strcmp(vertex->properties[k].name, names[i]) == 0) {
				p->instead[k] = instead;
				p->changes_any = true;
				instead = DROPPED;
			}
		p->value_count++;
	}
}

static nt_status plan_properties(plan *p, bool bitangents)
{
	static const char *const normals[] = {"nx", "ny", "nz"};
	static const char *const tangents[] = {"tx", "ty", "tz", "tw"};
	static const char *const bitangent_names[] = {"bx", "by", "bz"};
	const ply_element *vertex = p->source->vertex;
	p->instead = nt_alloc(vertex->property_count, sizeof *p->instead);
	p->row_offsets = nt_alloc(p->n.row_count, sizeof *p->row_offsets);
	if (!p->instead || !p->row_offsets || !ply_begin_rows(&p->vertices, &p->cursor, vertex) ||
		(p->source->face && !ply_begin_rows(&p->faces, &p->cursor, p->source->face)))
		return nt_fail_memory(p->error);
	for (size_t i = 0; i < vertex->property_count; i++)
		p->instead[i] = KEPT;
	/* bitangents of other tangents must not stay */
	p->new_bitangents = p->new_tangents && p->mesh->normals &&
		(bitangents || ply_find_property(vertex, "bx") != PLY_NO_PROPERTY);
	if (p->new_normals)
		add_values(p, normals, 3, true);
	if (p->new_tangents)
		add_values(p, tangents, 4, false);
	if (p->new_bitangents)
		add_values(p, bitangent_names, 3, false);
	return NT_OK;
}

static bool faces_change(const plan *p)
{
	return p->n.appended_count > 0 || p->n.cut_polygons > 0;
}

/* The type of indices, wider where the vertices have become too many for the source's. */
static void plan_index_type(plan *p, const ply_element *element)
{
	static const size_t largest[] = {[PLY_INT8] = INT8_MAX, [PLY_UINT8] = UINT8_MAX,
		[PLY_INT16] = INT16_MAX, [PLY_UINT16] = UINT16_MAX, [PLY_INT32] = INT32_MAX,
		[PLY_UINT32] = UINT32_MAX};
	p->index_type = element->properties[p->source->face_indices].type;
	const size_t count = p->n.row_count + p->n.appended_count;
	if (count > 0 && count - 1 > largest[p->index_type])
		p->index_type = count - 1 > INT32_MAX ? PLY_UINT32 : PLY_INT32;
}

static bool replaces_strips(const plan *p)
{
	return p->source->strips && faces_change(p);
}

/* The header. */

static void write_element_line(const plan *p, const char *name, size_t count)
{
	nt_buffer_format(&p->out->buffer, "element %s %zu%s", name, count, p->source->header.newline);
}

/* An element line: true when its properties are to be left out. */
static bool write_changed_element(const plan *p, const ply_element *element, const char *line, size_t size)
{
	const ply_source *source = p->source;
	if (replaces_strips(p) && element == source->strips) {
		write_element_line(p, "face", p->mesh->face_count);
		nt_buffer_format(&p->out->buffer, "property list uchar %s vertex_indices%s",
			ply_type_name(p->index_type), source->header.newline);
		return true;
	}
	/* an empty element "face" beside strips would come twice */
	if (replaces_strips(p) && strcmp(element->name, "face") == 0)
		return true;
	if (element == source->vertex && p->n.appended_count > 0)
		write_element_line(p, element->name, p->n.row_count + p->n.appended_count);
	else if (element == source->face && p->n.added_faces > 0)
		write_element_line(p, element->name, element->count + p->n.added_faces);
	else
		nt_buffer_append(&p->out->buffer, line, size);
	return false;
}

static void write_property(const plan *p, const ply_element *element, size_t number, const char *line,
	size_t size)
{
	const ply_property *property = &element->properties[number];
	const bool widened = element == p->source->face && (int)number == p->source->face_indices &&
		p->index_type != property->type;
	if (widened)
		nt_buffer_format(&p->out->buffer, "property list %s %s %s%s",
			ply_type_name(property->count_type), ply_type_name(p->index_type),
			property->name, p->source->header.newline);
	else if (element != p->source->vertex || p->instead[number] != DROPPED)
		nt_buffer_append(&p->out->buffer, line, size);
	if (element == p->source->vertex && number + 1 == element->property_count)
		for (size_t i = 0; i < p->value_count; i++)
			if (p->appended[i])
				nt_buffer_format(&p->out->buffer, "property float %s%s", p->names[i],
					p->source->header.newline);
}

/* Walks the lines of the source's header once more. */
static void write_header(const plan *p)
{
	const ply_header *header = &p->source->header;
	const unsigned char *bytes = p->scene->bytes;
	size_t element = 0, property = 0;
	bool leave_out = false;
	for (size_t begin = 0; begin < header->body;) {
		const ply_line line = ply_header_line(header, bytes, header->body, begin);
		const char *at = line.text, *word;
		const size_t length = ply_next_word(&at, line.text + line.length, &word);
		const size_t size = line.next - begin;
		if (length == 7 && memcmp(word, "element", 7) == 0) {
			leave_out = write_changed_element(p, &header->elements[element], line.text, size);
			element++;
			property = 0;
		} else if (length == 8 && memcmp(word, "property", 8) == 0) {
			if (!leave_out)
				write_property(p, &header->elements[element - 1], property, line.text, size);
			property++;
		} else {
			nt_buffer_append(&p->out->buffer, line.text, size);
		}
		begin = line.next;
	}
}

/* Rows. The reader has checked them; checked again is that the mapped file has not shrunk or changed. */

static nt_status fail_changed(const plan *p)
{
	if (p->error->status == NT_ERROR_MEMORY)
		return NT_ERROR_MEMORY;
	return nt_fail(p->error, NT_ERROR_IO, "the file changed while it was read");
}

static void write_span(const plan *p, const unsigned char *begin, const unsigned char *end)
{
	nt_buffer_append(&p->out->buffer, begin, (size_t)(end - begin));
}

/* Between the values of an ASCII row. */
static void write_gap(const plan *p, bool first)
{
	if (p->cursor.encoding == PLY_ASCII && !first)
		nt_buffer_append(&p->out->buffer, " ", 1);
}

static void end_row(const plan *p)
{
	if (p->cursor.encoding == PLY_ASCII)
		nt_buffer_text(&p->out->buffer, p->source->header.newline);
}

/* Vertices. */

/* The new values of a vertex, in the order of their names. */
static void find_values(const plan *p, size_t vertex, float values[PLY_MOST_FLOATS])
{
	const float *normals = p->mesh->normals;
	const float *n = normals ? normals + 3 * ply_mesh_vertex(&p->n, vertex) : NULL;
	size_t count = 0;
	if (p->new_normals) {
		memcpy(values, n, 3 * sizeof *values);
		count += 3;
	}
	if (p->new_tangents) {
		const float *t = p->mesh->split.vertex_tangents + 4 * vertex;
		memcpy(values + count, t, 4 * sizeof *values);
		count += 4;
		if (p->new_bitangents)
			nt_bitangent(n, t, values + count);
	}
}

/* A value of the row as it is, where the new one is the same number. */
static bool is_same(const plan *p, size_t property, float value)
{
	float old;
	return ply_cell_float(&p->vertices, property, &old) && memcmp(&old, &value, sizeof value) == 0;
}

/* The row at the cursor with new values in it; spans are set when there are any. */
static void write_row(const plan *p, const unsigned char *begin, const unsigned char *end, const float *values)
{
	if (!p->changes_any) {
		write_span(p, begin, end);
		return;
	}
	bool first = true;
	for (size_t i = 0; i < p->source->vertex->property_count; i++) {
		const ply_property *property = &p->source->vertex->properties[i];
		const int number = p->instead[i];
		if (number == DROPPED)
			continue;
		write_gap(p, first);
		if (number == KEPT || is_same(p, i, values[number]))
			write_span(p, p->vertices.cells[i].begin, p->vertices.cells[i].end);
		else
			ply_put_value(p->out, values[number], property->type);
		first = false;
	}
}

static nt_status write_vertex(plan *p, size_t vertex)
{
	const ply_element *element = p->source->vertex;
	const bool ascii = p->cursor.encoding == PLY_ASCII;
	if (ascii)
		ply_next_row(&p->cursor);
	const unsigned char *begin = p->cursor.at, *end;
	if (ascii && !p->changes_any) {
		end = begin;
		while (end < p->cursor.end && !ply_is_line_end(*end))
			end++;
		p->cursor.at = end;
		while (end > begin && ply_is_blank(end[-1]))
			end--;
	} else if (!ascii && !element->has_list && !p->changes_any) {
		p->cursor.at = end = begin + element->row_bytes;
	} else {
		p->vertices.row = 0;
		if (ply_read_row(&p->vertices, p->error))
			return fail_changed(p);
		end = p->vertices.cells[element->property_count - 1].end;
	}
	float values[PLY_MOST_FLOATS];
	find_values(p, vertex, values);
	write_row(p, begin, end, values);
	size_t appended = 0;
	for (size_t i = 0; i < p->value_count; i++)
		if (p->appended[i])
			values[appended++] = values[i];
	ply_put_floats(p->out, values, appended);
	end_row(p);
	return ply_drain(p->out, p->error);
}

static nt_status write_vertices(plan *p)
{
	nt_status status = NT_OK;
	for (size_t row = 0; !status && row < p->n.row_count; row++) {
		p->row_offsets[row] = (size_t)(p->cursor.at - p->cursor.begin);
		status = write_vertex(p, row);
	}
	const unsigned char *after = p->cursor.at;
	for (size_t i = 0; !status && i < p->n.appended_count; i++) {
		const size_t vertex = p->n.appended[i];
		p->cursor.at = p->cursor.begin + p->row_offsets[ply_source_row(&p->n, vertex)];
		status = write_vertex(p, vertex);
	}
	p->cursor.at = after;
	return status;
}

/* Faces. */

static void write_indices(const plan *p, const uint32_t *vertices, size_t count, ply_type count_type)
{
	ply_put_integer(p->out, (uint32_t)count, count_type);
	for (size_t k = 0; k < count; k++) {
		write_gap(p, false);
		ply_put_integer(p->out, vertices[k], p->index_type);
	}
}

/* A per-face list of texture coordinates, of which a triangle takes its corners' pairs. */
static void write_uv_part(const plan *p, const ply_property *property, const uint32_t *corners)
{
	ply_put_integer(p->out, 6, property->count_type);
	for (size_t k = 0; k < 6; k++) {
		const ply_cell one = ply_cell_value(&p->faces, (size_t)p->source->face_texcoords,
			2 * corners[k / 2] + k % 2);
		write_gap(p, false);
		write_span(p, one.begin, one.end);
	}
}

/* The current row with other vertices; corners: which corners of the polygon they are, NULL: all. */
static nt_status write_face(const plan *p, const uint32_t *vertices, size_t count, const uint32_t *corners)
{
	const ply_element *element = p->source->face;
	for (size_t i = 0; i < element->property_count; i++) {
		const ply_property *property = &element->properties[i];
		const ply_cell all = p->faces.cells[i];
		write_gap(p, i == 0);
		if ((int)i == p->source->face_indices)
			write_indices(p, vertices, count, property->count_type);
		else if (corners && (int)i == p->source->face_texcoords && all.count)
			write_uv_part(p, property, corners);
		else
			write_span(p, all.begin, all.end);
	}
	end_row(p);
	return ply_drain(p->out, p->error);
}

/* How far the mesh has been written. */
typedef struct face_progress {
	size_t corner, cut;
	uint32_t *vertices;
	size_t capacity;
} face_progress;

static nt_status write_triangles(const plan *p, const face_progress *done, size_t size)
{
	nt_status status = NT_OK;
	for (size_t t = 0; !status && t < size - 2; t++) {
		uint32_t vertices[3];
		for (size_t k = 0; k < 3; k++)
			vertices[k] = ply_output_vertex(&p->n, done->corner + 3 * t + k);
		status = write_face(p, vertices, 3, p->source->cuts + done->cut + 3 * t);
	}
	return status;
}

/* One polygon of the source. */
static nt_status write_polygon(plan *p, face_progress *done)
{
	const size_t indices = (size_t)p->source->face_indices;
	if (ply_read_row(&p->faces, p->error))
		return fail_changed(p);
	const size_t size = p->faces.cells[indices].count;
	if (!nt_grow((void **)&done->vertices, &done->capacity, size, sizeof *done->vertices))
		return nt_fail_memory(p->error);
	const size_t corners = size < 3 ? 0 : size < 5 ? size : 3 * (size - 2);
	if (corners > p->mesh->corner_count - done->corner ||
		(size > 4 && corners > p->source->cut_count - done->cut))
		return fail_changed(p);
	nt_status status;
	if (size < 3) {
		/* no face of the mesh: its vertices stay */
		status = write_face(p, p->faces.columns[indices].integers, size, NULL);
	} else if (size < 5) {
		for (size_t k = 0; k < size; k++)
			done->vertices[k] = ply_output_vertex(&p->n, done->corner + k);
		status = write_face(p, done->vertices, size, NULL);
	} else {
		const uint32_t *cut = p->source->cuts + done->cut;
		status = ply_resolve_polygon(&p->n, done->corner, size, cut, done->vertices)
				 ? write_face(p, done->vertices, size, NULL)
				 : write_triangles(p, done, size);
		done->cut += corners;
	}
	done->corner += corners;
	return status;
}

static nt_status write_strip_faces(plan *p)
{
	nt_status status = NT_OK;
	p->cursor.at = p->cursor.begin + p->source->face_end;
	for (size_t c = 0; !status && c < p->mesh->corner_count; c += 3) {
		const uint32_t vertices[3] = {ply_output_vertex(&p->n, c), ply_output_vertex(&p->n, c + 1),
			ply_output_vertex(&p->n, c + 2)};
		write_indices(p, vertices, 3, PLY_UINT8);
		end_row(p);
		status = ply_drain(p->out, p->error);
	}
	return status;
}

/* The file. */

static nt_status copy_element(plan *p, const ply_element *element)
{
	if (p->cursor.encoding == PLY_ASCII)
		ply_next_row(&p->cursor);
	const unsigned char *begin = p->cursor.at;
	nt_status status = NT_OK;
	if (element == p->source->face || element == p->source->strips)
		p->cursor.at = p->cursor.begin + p->source->face_end;
	else
		status = ply_skip_element(&p->cursor, element, p->error);
	if (status || begin >= p->cursor.at)
		return status;
	/* the reader may have stopped before or behind the end of the last line */
	const unsigned char *end = p->cursor.at;
	while (p->cursor.encoding == PLY_ASCII && ply_is_space(end[-1]))
		end--;
	status = ply_put_bytes(p->out, begin, (size_t)(end - begin), p->error);
	end_row(p);
	return status;
}

static nt_status write_body(plan *p)
{
	const ply_header *header = &p->source->header;
	nt_status status = NT_OK;
	face_progress done = {0};
	for (size_t i = 0; !status && i < header->element_count; i++) {
		const ply_element *element = &header->elements[i];
		if (element == p->source->vertex)
			status = write_vertices(p);
		else if (element == p->source->face && faces_change(p))
			for (size_t row = 0; !status && row < element->count; row++)
				status = write_polygon(p, &done);
		else if (element == p->source->strips && faces_change(p))
			status = write_strip_faces(p);
		else
			status = copy_element(p, element);
	}
	free(done.vertices);
	if (p->cursor.encoding == PLY_ASCII)
		ply_next_row(&p->cursor);
	if (!status)
		status = ply_put_bytes(p->out, p->cursor.at, (size_t)(p->cursor.end - p->cursor.at), p->error);
	return status;
}

static nt_status write_changed(plan *p, bool bitangents)
{
	const nt_status status = ply_number_vertices(&p->n, p->mesh, p->source)
					    ? plan_properties(p, bitangents)
					    : nt_fail_memory(p->error);
	if (status)
		return status;
	const ply_element *faces = p->source->face ? p->source->face : p->source->strips;
	if (faces)
		plan_index_type(p, faces);
	if (p->source->face) {
		p->faces.may_be_longer = true;
		p->faces.columns[p->source->face_indices] = (ply_column){.use = PLY_INDICES, .limit = p->n.row_count};
	}
	if (p->n.cut_polygons > 0)
		nt_finding_add(&p->scene->findings, NT_CODE_POLYGON_CUT, nt_mesh_place(p->mesh, &(nt_place){0}),
			p->n.cut_polygons, NULL);
	if (replaces_strips(p))
		nt_finding_add(&p->scene->findings, NT_CODE_POLYGON_CUT, nt_mesh_place(p->mesh, &(nt_place){0}),
			p->source->strips->count, "triangle strips");
	write_header(p);
	return write_body(p);
}

/* Whether the vertices' normals are floats, which hold unit vectors. */
static bool has_float_normals(const ply_element *vertex)
{
	static const char *const names[] = {"nx", "ny", "nz"};
	bool floats = true;
	for (size_t i = 0; i < 3; i++) {
		const int found = ply_find_property(vertex, names[i]);
		floats &= found != PLY_NO_PROPERTY && !vertex->properties[found].list &&
			vertex->properties[found].type >= PLY_FLOAT32;
	}
	return floats;
}

nt_status ply_write_source(nt_scene *scene, const nt_write_options *options, ply_output *out,
	nt_error *error)
{
	const ply_source *source = scene->source;
	const nt_mesh *mesh = scene->meshes;
	const ply_header *header = &source->header;
	plan p = {.scene = scene, .mesh = mesh, .source = source, .out = out, .error = error,
		.new_normals = mesh->normals_made || (mesh->scaled_normals && has_float_normals(source->vertex)),
		.new_tangents = mesh->split.vertex_tangents != NULL,
		.cursor = ply_begin_body(scene, header, 1)};
	out->encoding = header->encoding;
	if (!p.new_normals && !p.new_tangents)
		return ply_put_bytes(out, scene->bytes, scene->byte_count, error);
	const nt_status status = write_changed(&p, options->bitangents);
	ply_numbering_free(&p.n);
	free(p.instead);
	ply_free_rows(&p.vertices);
	ply_free_rows(&p.faces);
	free(p.row_offsets);
	return status;
}

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
#include "base/hash_index.h"
#include "base/vec.h"
#include "ext/linked.h"
#include "ply/parts.h"

enum { DRAIN_BYTES = 64 * 1024, MOST_VALUE = NT_FLOAT_TEXT + 1 };

/* The value that a property of the source becomes. */
enum { STAYS = -1, GOES = -2 };

typedef struct writer {
	nt_scene *scene;
	const ply_source *source; /* NULL: the scene is not that of a PLY */
	nt_error *error;
	nt_buffer buffer;         /* what has not been written yet */
	nt_sink *sink;
	ply_encoding encoding;
	const char *newline;
	struct {
		ply_value value;
		ply_type type;
	} added[PLY_VALUES];      /* properties that vertices get behind those of the source */
	size_t added_count;
	ply_type index_type;      /* of the faces written */

	/* of a PLY */
	const nt_mesh *mesh;
	const uint32_t *indices;  /* final vertex of each corner */
	uint32_t *numbers;        /* of final vertices behind the rows of the source: their number in the output */
	uint32_t *appended;       /* [appended_count] final vertex of each row behind those of the source */
	size_t appended_count;
	size_t cut_polygons, added_faces; /* polygons that become triangles, and how many faces that adds */
	uint32_t *polygon;        /* vertices of one */
	int *becomes;             /* [property_count of vertices] ply_value, STAYS or GOES */
	bool rows_stay;           /* all of them do */
	ply_rows vertices, faces;
	size_t *row_offsets;      /* [count of vertices] where the row of a vertex begins */
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

static void add_values(writer *w, int first, int count, ply_type type)
{
	for (int i = first; i < first + count; i++, w->added_count++) {
		w->added[w->added_count].value = (ply_value)i;
		w->added[w->added_count].type = type;
	}
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

/* Values of a group take the place of what has their names. A name may be there more than once; a reader could take
 * what stays for what is new, so that the later ones go. */
static void place_values(writer *w, int first, int count, bool integers)
{
	const ply_element *vertex = w->source->vertex;
	const bool fit = fit_in_place(vertex, first, count, integers);
	for (int v = first; v < first + count; v++) {
		bool open = fit;
		for (size_t i = 0; i < vertex->property_count; i++)
			if (strcmp(vertex->properties[i].name, value_names[v]) == 0) {
				w->becomes[i] = open ? v : GOES;
				w->rows_stay = open = false;
			}
	}
	if (!fit)
		add_values(w, first, count, PLY_FLOAT32);
}

static void put_new_properties(writer *w)
{
	for (size_t i = 0; i < w->added_count; i++)
		nt_buffer_format(&w->buffer, "property %s %s%s", ply_type_name(w->added[i].type),
			value_names[w->added[i].value], w->newline);
}

/* The values of the row of the source that was read last, in their new places. A value that is the same keeps its
 * bytes. */
static void put_properties(writer *w, const double *values)
{
	const ply_rows *rows = &w->vertices;
	bool first = true;
	for (size_t i = 0; i < rows->element->property_count; i++) {
		const int value = w->becomes[i];
		char bytes[MOST_VALUE];
		float was;
		if (value == GOES)
			continue;
		put_gap(w, first);
		first = false;
		if (value == STAYS || (ply_cell_float(rows, i, &was) &&
			memcmp(&was, &(float){(float)values[value]}, sizeof was) == 0))
			put_cell(w, rows->cells[i].begin, rows->cells[i].end);
		else
			nt_buffer_append(&w->buffer, bytes, (size_t)(store_value(w, values[value],
				rows->element->properties[i].type, bytes) - bytes));
	}
}

/* The end of a row of vertices: values that are added. */
static nt_status put_values(writer *w, const double *values)
{
	char bytes[PLY_VALUES * MOST_VALUE], *end = bytes;
	for (size_t i = 0; i < w->added_count; i++) {
		if (w->encoding == PLY_ASCII)
			*end++ = ' ';
		end = store_value(w, values[w->added[i].value], w->added[i].type, end);
	}
	nt_buffer_append(&w->buffer, bytes, (size_t)(end - bytes));
	return end_row(w);
}

/* ---- faces ---- */

/* The number of rows of the source, which keep their numbers. */
static size_t row_count(const writer *w)
{
	return w->source->vertex->count;
}

/* The vertex of the output at a corner of the mesh. */
static uint32_t output_vertex(const writer *w, size_t corner)
{
	const uint32_t v = w->indices[corner];
	return v < row_count(w) ? v : w->numbers[v - row_count(w)];
}

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
			vertices[k] = w->source ? output_vertex(w, c) : (uint32_t)(base + (indices ? indices[c] : c));
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

/* Finds the vertices of a cut polygon whose triangles begin at `corner`; false: the triangles disagree about one. */
static bool resolve_polygon(writer *w, size_t corner, size_t size, const uint32_t *cut)
{
	bool agrees = true;
	memset(w->polygon, 0xff, size * sizeof *w->polygon);
	for (size_t i = 0; i < 3 * (size - 2); i++) {
		const uint32_t vertex = output_vertex(w, corner + i);
		uint32_t *known = &w->polygon[cut[i]];
		agrees &= *known == NT_NONE || *known == vertex;
		*known = vertex;
	}
	for (size_t k = 0; k < size; k++)
		agrees &= w->polygon[k] != NT_NONE;
	return agrees;
}

/* Puts the polygon in the next row, whose corners and cut begin there; moves both behind it. */
static nt_status put_polygon(writer *w, size_t *corner, size_t *cut)
{
	ply_column *indices = &w->faces.columns[w->source->face_indices];
	const unsigned char *const row = w->faces.at;
	if (ply_read_row(&w->faces))
		return fail_changed(w);
	const size_t size = w->faces.cells[w->source->face_indices].count;
	const size_t corners = size < 3 ? 0 : size < 5 ? size : 3 * (size - 2);
	const uint32_t *own = w->source->cuts + *cut;
	if (corners > w->mesh->corner_count - *corner || (size > 4 && corners > w->source->cut_count - *cut))
		return fail_changed(w);
	nt_status status = NT_OK;
	if (size < 3) {
		/* no face of the mesh: its vertices stay */
		w->faces.at = row;
		*indices = (ply_column){.use = PLY_INDICES, .integers = w->polygon,
			.capacity = w->source->most_corners, .size = size, .limit = row_count(w)};
		status = ply_read_row(&w->faces) ? fail_changed(w) : put_face(w, w->polygon, size, NULL);
		*indices = (ply_column){.use = PLY_SKIPPED};
	} else if (size > 4 && !resolve_polygon(w, *corner, size, own)) {
		for (size_t t = 0; !status && t < corners; t += 3) {
			for (size_t k = 0; k < 3; k++)
				w->polygon[k] = output_vertex(w, *corner + t + k);
			status = put_face(w, w->polygon, 3, own + t);
		}
	} else {
		for (size_t k = 0; size < 5 && k < size; k++)
			w->polygon[k] = output_vertex(w, *corner + k);
		status = put_face(w, w->polygon, size, NULL);
	}
	*corner += corners;
	*cut += size > 4 ? corners : 0;
	return status;
}

/* ---- numbers of vertices ---- */

/* The vertex of the mesh, and the row of the source, that a final vertex has its attributes from. */
static size_t mesh_vertex(const writer *w, size_t vertex)
{
	const nt_mesh *mesh = w->mesh;
	return vertex < mesh->vertex_count ? vertex : mesh->split.sources[vertex - mesh->vertex_count];
}

static size_t source_row(const writer *w, size_t vertex)
{
	const nt_mesh *mesh = w->mesh;
	size_t v = mesh_vertex(w, vertex);
	if (v >= mesh->source_vertex_count)
		v = mesh->vertex_sources[v - mesh->source_vertex_count];
	return v < row_count(w) ? v : w->source->wedge_rows[v - row_count(w)];
}

/* Values by which vertices of one row may differ in the output. */
typedef struct distinction {
	size_t row;
	float tangent[4], normal[3], unused;
} distinction;

static distinction distinction_of(const writer *w, size_t vertex)
{
	const nt_mesh *mesh = w->mesh;
	distinction v = {.row = source_row(w, vertex)};
	if (mesh->split.vertex_tangents)
		memcpy(v.tangent, mesh->split.vertex_tangents + 4 * vertex, sizeof v.tangent);
	if (mesh->normals_made)
		memcpy(v.normal, mesh->normals + 3 * mesh_vertex(w, vertex), sizeof v.normal);
	return v;
}

/* Rows of the source keep their number. Vertices that were told apart by per-face texture coordinates alone become one
 * again if their normals and tangents are equal, since the coordinates stay with the faces. */
static bool number_vertices(writer *w)
{
	const nt_mesh *mesh = w->mesh;
	const size_t first = row_count(w), count = mesh->vertex_count + mesh->split.source_count - first;
	nt_key_set set = {0}; /* of appended vertices */
	w->indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	w->numbers = nt_alloc(count, sizeof *w->numbers);
	w->appended = nt_alloc(count, sizeof *w->appended);
	bool done = w->numbers && w->appended;
	for (size_t i = 0; done && i < count; i++) {
		uint32_t number = (uint32_t)w->appended_count;
		if (w->source->wedge_count > 0) {
			const distinction own = distinction_of(w, first + i), rows = distinction_of(w, own.row);
			const bool same = memcmp(&own, &rows, sizeof own) == 0;
			number = same ? 0 : nt_key_add(&set, &own, sizeof own);
			w->numbers[i] = (uint32_t)own.row;
			done = number != NT_NONE;
			if (same)
				continue;
		}
		if (number == w->appended_count)
			w->appended[w->appended_count++] = (uint32_t)(first + i);
		w->numbers[i] = (uint32_t)(first + number);
	}
	nt_key_set_free(&set);
	return done;
}

/* Counts the polygons that become triangles: the header needs the number of faces. */
static void count_cut_polygons(writer *w)
{
	const nt_mesh *mesh = w->mesh;
	const uint32_t *cut = w->source->cuts;
	for (size_t face = 0, corner = 0, end; mesh->face_polygon && face < mesh->face_count; face = end) {
		for (end = face + 1; end < mesh->face_count && mesh->face_polygon[end] == mesh->face_polygon[face];)
			end++;
		const size_t triangles = end - face;
		if (triangles == 1) {
			corner += mesh->face_sizes ? mesh->face_sizes[face] : 3;
			continue;
		}
		if (!resolve_polygon(w, corner, triangles + 2, cut)) {
			w->cut_polygons++;
			w->added_faces += triangles - 1;
		}
		corner += 3 * triangles;
		cut += 3 * triangles;
	}
}

/* ---- from a PLY ---- */

static bool faces_change(const writer *w)
{
	return w->appended_count > 0 || w->cut_polygons > 0;
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
	const size_t count = row_count(w) + w->appended_count;
	const ply_type type = element ? element->properties[w->source->face_indices].type : PLY_UINT32;
	return count == 0 || count - 1 <= largest[type] ? type : count - 1 > INT32_MAX ? PLY_UINT32 : PLY_INT32;
}

/* The source's header up to a line, from where the last one was met; `stays`: that one, too. */
static void put_header_line(writer *w, size_t *at, ply_span line, bool stays)
{
	const size_t end = stays ? line.end : line.begin;
	put_cell(w, w->source->header.bytes + *at, w->source->header.bytes + end);
	*at = line.end;
}

static void put_old_header(writer *w)
{
	const ply_source *source = w->source;
	const ply_header *header = &source->header;
	size_t at = 0;
	for (size_t e = 0; e < header->element_count; e++) {
		const ply_element *element = &header->elements[e];
		const bool strips = replaces_strips(w) && element == source->strips;
		/* an empty element "face" beside strips would come twice */
		const bool goes = strips || (replaces_strips(w) && strcmp(element->name, "face") == 0);
		const size_t added = element == source->vertex ? w->appended_count
			: element == source->face ? w->added_faces : 0;
		put_header_line(w, &at, element->text, !goes && !added);
		if (strips)
			nt_buffer_format(&w->buffer, "element face %zu%sproperty list uchar %s vertex_indices%s",
				w->mesh->face_count, w->newline, ply_type_name(w->index_type), w->newline);
		else if (added)
			nt_buffer_format(&w->buffer, "element %s %zu%s", element->name, element->count + added,
				w->newline);
		for (size_t i = 0; i < element->property_count; i++) {
			const ply_property *property = &element->properties[i];
			const bool retyped = element == source->face && (int)i == source->face_indices &&
				w->index_type != property->type;
			const bool stays = element == source->vertex ? w->becomes[i] != GOES : !goes && !retyped;
			put_header_line(w, &at, property->text, stays);
			if (retyped)
				nt_buffer_format(&w->buffer, "property list %s %s %s%s",
					ply_type_name(property->count_type), ply_type_name(w->index_type),
					property->name, w->newline);
		}
		if (element == source->vertex)
			put_new_properties(w);
	}
	put_header_line(w, &at, (ply_span){header->body, header->body}, true);
}

/* The row of the source at the reader's place as that of a final vertex. */
static nt_status put_old_vertex(writer *w, size_t vertex)
{
	ply_rows *rows = &w->vertices;
	const bool ascii = w->encoding == PLY_ASCII;
	if (ascii)
		ply_next_row(rows);
	ply_cell row = {.begin = rows->at};
	rows->row = 0;
	row.end = rows->at;
	while (w->rows_stay && ascii && row.end < rows->end && !ply_is_line_end(*row.end))
		row.end++;
	if (w->rows_stay && ascii)
		rows->at = row.end;
	else if (w->rows_stay && !rows->element->list_count)
		rows->at += rows->element->row_bytes;
	else if (ply_read_row(rows))
		return fail_changed(w);
	row.end = rows->at;
	while (ascii && row.end > row.begin && ply_is_blank(row.end[-1]))
		row.end--;
	const float *n = w->mesh->normals ? w->mesh->normals + 3 * mesh_vertex(w, vertex) : NULL;
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
	if (w->rows_stay)
		put_cell(w, row.begin, row.end);
	else
		put_properties(w, values);
	return put_values(w, values);
}

static nt_status put_old_vertices(writer *w)
{
	nt_status status = NT_OK;
	for (size_t row = 0; !status && row < row_count(w); row++) {
		w->row_offsets[row] = (size_t)(w->vertices.at - w->source->header.bytes);
		status = put_old_vertex(w, row);
	}
	for (size_t i = 0; !status && i < w->appended_count; i++) {
		w->vertices.at = w->source->header.bytes + w->row_offsets[source_row(w, w->appended[i])];
		status = put_old_vertex(w, w->appended[i]);
	}
	return status;
}

/* An element as it is. */
static nt_status copy_element(writer *w, const ply_element *element)
{
	const unsigned char *begin = w->source->header.bytes + element->rows.begin;
	const unsigned char *end = w->source->header.bytes + element->rows.end;
	/* the reader may have stopped before or behind the end of the last line */
	while (w->encoding == PLY_ASCII && begin < end && ply_is_space(*begin))
		begin++;
	while (w->encoding == PLY_ASCII && begin < end && ply_is_space(end[-1]))
		end--;
	const nt_status status = begin < end ? put_bytes(w, begin, (size_t)(end - begin)) : NT_OK;
	return status || begin >= end ? status : end_row(w);
}

static nt_status put_old_body(writer *w)
{
	const ply_source *source = w->source;
	const unsigned char *rest = source->header.bytes; /* behind the last element */
	const unsigned char *const end = source->header.bytes + source->header.size;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < source->header.element_count; i++) {
		const ply_element *element = &source->header.elements[i];
		size_t corner = 0, cut = 0;
		if (element == source->vertex)
			status = put_old_vertices(w);
		else if (element == source->strips && faces_change(w))
			status = put_mesh_faces(w, w->mesh, 0, false);
		else if (element != source->face || !faces_change(w))
			status = copy_element(w, element);
		for (size_t f = 0; !status && element == source->face && faces_change(w) && f < element->count; f++)
			status = put_polygon(w, &corner, &cut);
		rest = source->header.bytes + element->rows.end;
	}
	while (w->encoding == PLY_ASCII && rest < end && ply_is_space(*rest))
		rest++;
	return status ? status : put_bytes(w, rest, (size_t)(end - rest));
}

static nt_status write_changed(writer *w, bool bitangents)
{
	const ply_source *source = w->source;
	const ply_header *header = &source->header;
	const ply_element *vertex = source->vertex;
	nt_place place;
	w->becomes = nt_alloc(vertex->property_count, sizeof *w->becomes);
	w->row_offsets = nt_alloc(vertex->count, sizeof *w->row_offsets);
	w->polygon = nt_alloc(source->most_corners, sizeof *w->polygon);
	nt_status status = w->becomes && w->row_offsets && w->polygon && number_vertices(w) ? NT_OK
		: nt_fail_memory(w->error);
	if (!status)
		status = ply_begin_rows(&w->vertices, header, vertex, header->bytes + vertex->rows.begin, w->error);
	if (!status && source->face) {
		status = ply_begin_rows(&w->faces, header, source->face,
			header->bytes + source->face->rows.begin, w->error);
		w->faces.may_be_longer = true;
	}
	if (status)
		return status;
	count_cut_polygons(w);
	/* bitangents of other tangents must not stay */
	w->new_bitangents = w->new_tangents && w->mesh->normals &&
		(bitangents || ply_find_property(vertex, "bx") != PLY_NO_PROPERTY);
	w->rows_stay = true;
	for (size_t i = 0; i < vertex->property_count; i++)
		w->becomes[i] = STAYS;
	if (w->new_normals)
		place_values(w, PLY_NX, 3, true);
	if (w->new_tangents)
		place_values(w, PLY_TX, 4, false);
	if (w->new_bitangents)
		place_values(w, PLY_BX, 3, false);
	w->index_type = find_index_type(w);
	nt_mesh_place(w->mesh, &place);
	if (w->cut_polygons > 0)
		nt_finding_add(&w->scene->findings, NT_CODE_POLYGON_CUT, &place, w->cut_polygons, NULL);
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
	add_values(w, PLY_X, 3, world->doubles ? PLY_FLOAT64 : PLY_FLOAT32);
	if (world->normals)
		add_values(w, PLY_NX, 3, PLY_FLOAT32);
	if (world->colors)
		add_values(w, PLY_RED, 4, world->byte_colors ? PLY_UINT8 : PLY_FLOAT32);
	if (world->texcoords)
		add_values(w, PLY_S, 2, PLY_FLOAT32);
	if (world->tangents)
		add_values(w, PLY_TX, 4, PLY_FLOAT32);
	if (world->bitangents)
		add_values(w, PLY_BX, 3, PLY_FLOAT32);
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
				status = put_values(w, values);
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
	nt_status status = ply_settle_texture(&texture, w->scene, options, set, w->error);
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
	ply_free_rows(&w.vertices);
	ply_free_rows(&w.faces);
	free(w.becomes);
	free(w.numbers);
	free(w.appended);
	free(w.polygon);
	free(w.row_offsets);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * The rows of the face element become triangles and quads; larger polygons are cut into triangles, and
 * how they were cut is kept for the writer. Triangle strips (element tristrips, -1 starts a new one)
 * become triangles. Lists are measured against the file before room is made for them, so that memory
 * stays in proportion to the file whatever its counts say.
 */
#include "ply/source.h"

#include <math.h>
#include <stdlib.h>
#include "ply/wedges.h"
#include "scene/polygon.h"

typedef struct builder {
	nt_scene *scene;
	nt_mesh *mesh;
	ply_source *source;
	ply_cursor *cursor;
	nt_error *error;
	const ply_element *element;
	int indices_property, texcoords_property, texture_property;
	size_t row;
	bool swap;

	/* the mesh's arrays while they grow */
	uint32_t *indices, *polygons, *primitives;
	uint8_t *sizes;
	size_t index_count, face_count, polygon_count;
	size_t index_capacity, size_capacity, polygon_capacity, primitive_capacity;

	/* the current row */
	const unsigned char *row_begin;
	uint32_t *corners;
	float *uvs;
	size_t corner_count, uv_count, corner_capacity, uv_capacity;
	uint32_t texture;

	ply_run_layout runs;
	bool has_wedges;
	ply_wedges wedges;
	float (*points)[3];
	size_t point_capacity;
	size_t unsound; /* rows with a texcoord that is not finite */
	nt_place first_unsound;
	size_t skipped;
	nt_place first_skipped;
} builder;

static nt_place place_of_row(const builder *b)
{
	nt_place place;
	nt_place_clear(&place);
	if (b->cursor->encoding == PLY_ASCII)
		place.line = ply_line_of(b->cursor, b->row_begin);
	else
		place.offset = (uint64_t)(b->row_begin - b->cursor->begin);
	return place;
}

/* Faces. */

static bool make_room(builder *b, size_t faces, size_t corners)
{
	const size_t count = b->face_count + faces;
	return nt_grow((void **)&b->indices, &b->index_capacity, b->index_count + corners,
		       sizeof *b->indices) &&
	       (!b->sizes || nt_grow((void **)&b->sizes, &b->size_capacity, count, 1)) &&
	       (!b->polygons || nt_grow((void **)&b->polygons, &b->polygon_capacity, count,
					sizeof *b->polygons)) &&
	       (b->texture_property == PLY_NO_PROPERTY ||
		       nt_grow((void **)&b->primitives, &b->primitive_capacity, count,
			       sizeof *b->primitives));
}

/* The first quad ends "all are triangles", the first larger polygon "polygons are faces". */
static bool start_sizes(builder *b)
{
	if (b->sizes)
		return true;
	if (!nt_grow((void **)&b->sizes, &b->size_capacity, b->face_count + 1, 1))
		return false;
	memset(b->sizes, 3, b->face_count);
	return true;
}

static bool start_polygons(builder *b)
{
	if (b->polygons)
		return true;
	if (!nt_grow((void **)&b->polygons, &b->polygon_capacity, b->face_count + 1,
		    sizeof *b->polygons))
		return false;
	for (size_t i = 0; i < b->face_count; i++)
		b->polygons[i] = (uint32_t)i;
	return true;
}

static nt_status add_face(builder *b, const uint32_t *vertices, size_t size)
{
	if (b->face_count == NMTAN_MAX_FACES)
		return nt_fail(b->error, NT_ERROR_TOO_LARGE, "more than %zu faces", NMTAN_MAX_FACES);
	if (!make_room(b, 1, 4))
		return nt_fail_memory(b->error);
	memcpy(b->indices + b->index_count, vertices, size * sizeof *vertices);
	b->index_count += size;
	if (b->sizes)
		b->sizes[b->face_count] = (uint8_t)size;
	if (b->polygons)
		b->polygons[b->face_count] = (uint32_t)b->polygon_count;
	if (b->primitives)
		b->primitives[b->face_count] = b->texture;
	b->face_count++;
	return NT_OK;
}

/* Cuts the current polygon; the corner numbers of its triangles go to source->cuts. */
static nt_status cut_polygon(builder *b, const uint32_t **cut)
{
	const size_t count = b->corner_count;
	ply_cuts *cuts = &b->source->cuts;
	size_t needed;
	if (!nt_size_add(cuts->count, 3 * (count - 2), &needed) ||
		!nt_grow((void **)&cuts->corners, &cuts->capacity, needed, sizeof *cuts->corners) ||
		!nt_grow((void **)&b->points, &b->point_capacity, count, sizeof *b->points))
		return nt_fail_memory(b->error);
	for (size_t k = 0; k < count; k++) {
		const size_t row = b->has_wedges ? ply_wedges_row(&b->wedges, b->corners[k]) : b->corners[k];
		memcpy(b->points[k], b->mesh->positions + 3 * row, sizeof *b->points);
	}
	bool sound;
	uint32_t *corners = cuts->corners + cuts->count;
	if (nt_polygon_triangulate((const float(*)[3])b->points, count, corners, &sound))
		return nt_fail_memory(b->error);
	cuts->count = needed;
	if (!sound && !cuts->unsound++)
		cuts->first_unsound = place_of_row(b);
	*cut = corners;
	return NT_OK;
}

static nt_status add_large_polygon(builder *b)
{
	const uint32_t *cut = NULL;
	nt_status status = start_polygons(b) ? cut_polygon(b, &cut) : nt_fail_memory(b->error);
	for (size_t t = 0; !status && t < b->corner_count - 2; t++) {
		const uint32_t vertices[3] = {b->corners[cut[3 * t]], b->corners[cut[3 * t + 1]],
			b->corners[cut[3 * t + 2]]};
		status = add_face(b, vertices, 3);
	}
	return status;
}

static nt_status apply_wedges(builder *b)
{
	if (b->uv_count != 0 && b->uv_count != 2 * b->corner_count)
		return ply_fail_at(b->cursor, b->row_begin, b->error,
			"%s %zu: list \"texcoord\" has %zu values, expected %zu for %zu corners, or none",
			b->element->name, b->row, b->uv_count, 2 * b->corner_count, b->corner_count);
	for (size_t k = 0; k < b->corner_count; k++) {
		b->corners[k] = ply_wedges_vertex(&b->wedges, b->corners[k],
			b->uv_count ? b->uvs + 2 * k : NULL);
		if (b->corners[k] == NT_NONE)
			return nt_fail_memory(b->error);
	}
	return NT_OK;
}

/* The current polygon becomes faces. */
static nt_status add_polygon(builder *b)
{
	if (b->corner_count < 3) {
		if (b->skipped++ == 0)
			b->first_skipped = place_of_row(b);
		return NT_OK;
	}
	nt_status status = b->has_wedges ? apply_wedges(b) : NT_OK;
	if (status)
		return status;
	if (b->corner_count > 4)
		status = add_large_polygon(b);
	else if (b->corner_count == 4 && !start_sizes(b))
		status = nt_fail_memory(b->error);
	else
		status = add_face(b, b->corners, b->corner_count);
	b->polygon_count++;
	return status;
}

/* The current list is a run of strips. Triangles with a doubled corner join strips and are no faces. */
static nt_status add_strips(builder *b)
{
	nt_status status = NT_OK;
	size_t begin = 0;
	for (size_t i = 0; !status && i < b->corner_count; i++) {
		const uint32_t *c = b->corners + i;
		if (*c == NT_NONE)
			begin = i + 1;
		if (*c == NT_NONE || i < begin + 2 || c[0] == c[-1] || c[0] == c[-2] || c[-1] == c[-2])
			continue;
		const bool odd = (i - begin) & 1;
		const uint32_t vertices[3] = {c[odd ? -1 : -2], c[odd ? -2 : -1], c[0]};
		status = add_face(b, vertices, 3);
	}
	return status;
}

/* Rows. */

/* Checks a vertex index; -1 restarts strips. */
static nt_status take_index(builder *b, size_t k, int64_t index, const unsigned char *at)
{
	const bool restart = b->element == b->source->strips && (index == -1 || index == UINT32_MAX);
	if (!restart && (uint64_t)index >= b->source->vertex->count)
		return ply_fail_at(b->cursor, at, b->error,
			"%s %zu: vertex index %lld is out of range, the file has %zu vertices", b->element->name,
			b->row, (long long)index, b->source->vertex->count);
	b->corners[k] = restart ? NT_NONE : (uint32_t)index;
	return NT_OK;
}

static nt_status load_corners(builder *b, const unsigned char *at, size_t count, ply_type type)
{
	if (!nt_grow((void **)&b->corners, &b->corner_capacity, count, sizeof *b->corners))
		return nt_fail_memory(b->error);
	b->corner_count = count;
	const size_t size = ply_size(type);
	for (size_t k = 0; k < count; k++, at += size) {
		const nt_status status = take_index(b, k, ply_load_integer(at, type, b->swap), at);
		if (status)
			return status;
	}
	return NT_OK;
}

static nt_status load_uvs(builder *b, const unsigned char *at, size_t count, ply_type type)
{
	if (!nt_grow((void **)&b->uvs, &b->uv_capacity, count, sizeof *b->uvs))
		return nt_fail_memory(b->error);
	b->uv_count = count;
	for (size_t k = 0; k < count; k++)
		b->uvs[k] = ply_load_float(at + k * ply_size(type), type, b->swap);
	return NT_OK;
}

static void take_texture(builder *b, int64_t texture)
{
	const size_t count = b->source->header.texture_count;
	b->texture = (uint32_t)(texture >= 0 && (uint64_t)texture < count ? (size_t)texture : count);
}

static nt_status load_property(builder *b, int number, const unsigned char *at)
{
	const ply_property *property = &b->element->properties[number];
	if (number == b->texture_property)
		take_texture(b, property->type < PLY_FLOAT32
					? ply_load_integer(at, property->type, b->swap) : -1);
	if (!property->list)
		return NT_OK;
	const size_t count = (size_t)ply_load_integer(at, property->count_type, b->swap);
	const unsigned char *values = at + ply_size(property->count_type);
	if (number == b->indices_property)
		return load_corners(b, values, count, property->type);
	return number == b->texcoords_property ? load_uvs(b, values, count, property->type) : NT_OK;
}

/* A row is measured, then read. */
static nt_status load_row(builder *b)
{
	nt_status status = ply_skip_binary_row(b->cursor, b->element, b->row, b->error);
	const unsigned char *at = b->row_begin;
	for (size_t i = 0; !status && i < b->element->property_count; i++) {
		status = load_property(b, (int)i, at);
		at += ply_value_bytes(&b->element->properties[i], at, b->swap);
	}
	return status;
}

static nt_status fail_text(const builder *b, const unsigned char *at, const char *expected,
	const ply_property *property)
{
	char found[40];
	return ply_fail_at(b->cursor, at, b->error, "%s %zu: found %s, expected %s \"%s\"",
		b->element->name, b->row, ply_show(b->cursor, at, found), expected, property->name);
}

/* One value of a list or a scalar property at *at, which is moved behind it. */
static nt_status read_value(builder *b, int number, size_t k, const unsigned char **at)
{
	const ply_property *property = &b->element->properties[number];
	const unsigned char *const end = b->cursor->end;
	const unsigned char *begin = ply_skip_blanks(*at, end), *after;
	nt_status status = NT_OK;
	int64_t integer;
	if (number == b->indices_property) {
		after = ply_read_integer(begin, end, &integer);
		if (after)
			status = take_index(b, k, integer, begin);
	} else if (number == b->texcoords_property) {
		after = ply_read_float(begin, end, &b->uvs[k]);
	} else if (number == b->texture_property) {
		after = ply_read_integer(begin, end, &integer);
		if (after)
			take_texture(b, integer);
	} else {
		after = ply_skip_value(begin, end);
	}
	if (!after || after == begin)
		return fail_text(b, begin, property->list ? "another value of list"
							  : "a number for property", property);
	*at = after;
	return status;
}

static nt_status read_list(builder *b, int number, const unsigned char **at)
{
	const ply_property *property = &b->element->properties[number];
	const unsigned char *begin = ply_skip_blanks(*at, b->cursor->end);
	int64_t count;
	const unsigned char *after = ply_read_integer(begin, b->cursor->end, &count);
	if (!after)
		return fail_text(b, begin, "the length of list", property);
	if (count < 0 || (uint64_t)count > (uint64_t)(b->cursor->end - after) / 2 + 1)
		return ply_fail_at(b->cursor, begin, b->error,
			"%s %zu: the length of a list does not fit the file: %lld", b->element->name, b->row,
			(long long)count);
	const size_t length = (size_t)count;
	if (number == b->indices_property) {
		b->corner_count = length;
		if (!nt_grow((void **)&b->corners, &b->corner_capacity, length, sizeof *b->corners))
			return nt_fail_memory(b->error);
	} else if (number == b->texcoords_property) {
		b->uv_count = length;
		if (!nt_grow((void **)&b->uvs, &b->uv_capacity, length, sizeof *b->uvs))
			return nt_fail_memory(b->error);
	}
	*at = after;
	nt_status status = NT_OK;
	for (size_t k = 0; !status && k < length; k++)
		status = read_value(b, number, k, at);
	return status;
}

static nt_status read_row(builder *b)
{
	const unsigned char *at = b->row_begin;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < b->element->property_count; i++)
		status = b->element->properties[i].list ? read_list(b, (int)i, &at)
							: read_value(b, (int)i, 0, &at);
	if (status)
		return status;
	b->cursor->at = ply_skip_blanks(at, b->cursor->end);
	return ply_check_row_end(b->cursor, b->element, b->row, b->error);
}

/* Reads as many plain faces as there are at the cursor: b->row moves behind them. */
static nt_status take_run(builder *b)
{
	const size_t size = ply_run_size(&b->runs, b->cursor);
	if (size == 0)
		return NT_OK;
	const size_t left = b->element->count - b->row, room = NMTAN_MAX_FACES - b->face_count;
	const size_t rows = left < room ? left : room;
	if ((size == 4 && !start_sizes(b)) || !make_room(b, rows, size * rows + 4))
		return nt_fail_memory(b->error);
	const size_t taken = ply_take_run(&b->runs, b->cursor, rows, size, b->source->vertex->count,
		b->indices + b->index_count);
	if (b->sizes)
		memset(b->sizes + b->face_count, (int)size, taken);
	for (size_t i = 0; b->polygons && i < taken; i++)
		b->polygons[b->face_count + i] = (uint32_t)(b->polygon_count + i);
	b->index_count += size * taken;
	b->face_count += taken;
	b->polygon_count += taken;
	b->row += taken;
	return NT_OK;
}

/* Texture coordinates of the row that are not finite become 0. */
static void mend_uvs(builder *b)
{
	bool sound = true;
	for (size_t k = 0; k < b->uv_count; k++) {
		sound &= isfinite(b->uvs[k]) != 0;
		b->uvs[k] = isfinite(b->uvs[k]) ? b->uvs[k] : 0.0f;
	}
	if (!sound && !b->unsound++)
		b->first_unsound = place_of_row(b);
}

static nt_status read_any_row(builder *b)
{
	const bool ascii = b->cursor->encoding == PLY_ASCII;
	b->row_begin = b->cursor->at;
	if (b->cursor->at == b->cursor->end)
		return ply_fail_end(b->cursor, b->element, b->row, b->error);
	nt_status status = ascii ? read_row(b) : load_row(b);
	if (!status)
		mend_uvs(b);
	if (!status)
		status = b->element == b->source->strips ? add_strips(b) : add_polygon(b);
	b->row++;
	return status;
}

static nt_status read_rows(builder *b)
{
	nt_status status = NT_OK;
	while (!status && b->row < b->element->count) {
		if (b->cursor->encoding == PLY_ASCII)
			ply_next_row(b->cursor);
		const size_t before = b->row;
		status = take_run(b);
		if (!status && b->row == before)
			status = read_any_row(b);
	}
	return status;
}

/* Results. */

/* Primitives of textures that no face uses are left out. */
static nt_status make_primitives(builder *b)
{
	nt_mesh *mesh = b->mesh;
	const size_t textures = b->source->header.texture_count;
	const size_t most = b->primitives ? textures + 1 : 1;
	mesh->primitives = nt_arena_alloc(&b->scene->arena, most, sizeof *mesh->primitives);
	uint32_t *numbers = nt_calloc(most, sizeof *numbers);
	if (!mesh->primitives || !numbers) {
		free(numbers);
		return nt_fail_memory(b->error);
	}
	if (!b->primitives) {
		mesh->primitives[0] = (nt_primitive){.material = textures ? 0 : NT_NONE, .face_count = b->face_count};
		mesh->primitive_count = 1;
	}
	for (size_t f = 0; b->primitives && f < b->face_count; f++)
		numbers[b->primitives[f]]++;
	for (size_t i = 0; b->primitives && i < most; i++) {
		if (!numbers[i])
			continue;
		const uint32_t material = i < textures ? (uint32_t)i : NT_NONE;
		mesh->primitives[mesh->primitive_count] =
			(nt_primitive){.material = material, .face_count = numbers[i]};
		numbers[i] = (uint32_t)mesh->primitive_count++;
	}
	for (size_t f = 0; b->primitives && f < b->face_count; f++)
		b->primitives[f] = numbers[b->primitives[f]];
	free(numbers);
	return NT_OK;
}

static nt_status finish(builder *b)
{
	nt_mesh *mesh = b->mesh;
	nt_status status = make_primitives(b);
	if (!status && b->has_wedges && !ply_wedges_apply(&b->wedges, b->scene, mesh, b->source))
		status = nt_fail_memory(b->error);
	mesh->face_count = b->face_count;
	mesh->corner_count = b->index_count;
	mesh->indices = b->indices;
	mesh->face_sizes = b->sizes;
	mesh->face_polygon = b->polygons;
	mesh->face_primitive = mesh->primitive_count > 1 ? b->primitives : NULL;
	if (b->unsound)
		nt_finding_add(&b->scene->findings, NT_CODE_UV_NOT_FINITE, &b->first_unsound, b->unsound, "faces");
	if (b->skipped)
		nt_finding_add(&b->scene->findings, NT_CODE_STATEMENT_IGNORED, &b->first_skipped,
			b->skipped, "faces of fewer than three corners");
	return status;
}

static nt_status prepare(builder *b)
{
	const ply_element *element = b->element;
	const nt_status status = ply_check_count(b->cursor, element, b->error);
	if (status)
		return status;
	b->has_wedges = b->texcoords_property != PLY_NO_PROPERTY;
	if (b->has_wedges && !ply_wedges_init(&b->wedges, b->source->vertex->count))
		return nt_fail_memory(b->error);
	if (!b->has_wedges && b->texture_property == PLY_NO_PROPERTY && element != b->source->strips)
		b->runs = ply_find_run_layout(element, b->indices_property, b->cursor->encoding);
	/* most files are triangles; the count has been checked against the file */
	return nt_grow((void **)&b->indices, &b->index_capacity, 3 * element->count + 4,
		       sizeof *b->indices)
		       ? NT_OK
		       : nt_fail_memory(b->error);
}

nt_status ply_read_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_cursor *cursor,
	nt_error *error)
{
	const bool strips = source->strips != NULL;
	builder b = {.scene = scene, .mesh = mesh, .source = source, .cursor = cursor, .error = error,
		.element = strips ? source->strips : source->face,
		.indices_property = source->face_indices,
		.texcoords_property = source->face_texcoords,
		.texture_property = PLY_NO_PROPERTY,
		.swap = ply_swaps(cursor->encoding)};
	if (!strips && source->header.texture_count > 0)
		b.texture_property = ply_find_property(b.element, "texnumber");
	if (b.texture_property >= 0 && b.element->properties[b.texture_property].list)
		b.texture_property = PLY_NO_PROPERTY;

	nt_status status = prepare(&b);
	if (!status)
		status = read_rows(&b);
	if (!status)
		status = finish(&b);
	/* the arrays belong to the arena from now on, after an error too */
	void *const blocks[] = {b.indices, b.sizes, b.polygons, b.primitives};
	for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
		if (!nt_arena_adopt(&scene->arena, blocks[i]) && !status)
			status = nt_fail_memory(error);
	ply_wedges_free(&b.wedges);
	free(b.corners);
	free(b.uvs);
	free(b.points);
	return status;
}

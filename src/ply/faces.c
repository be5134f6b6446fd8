/* SPDX-License-Identifier: MIT */
/*
 * The rows of the face element are read into columns: the corners of polygons, their sizes, their textures. Triangles
 * and quads of the file are then faces of the mesh as they stand; larger polygons are cut into triangles, and how they
 * were cut is kept for the writer. Triangle strips (element tristrips, -1 starts a new one) become triangles when they
 * are read.
 *
 * Texture coordinates may belong to corners (MeshLab's per-wedge ones): a vertex is then a row of the file with one
 * pair of coordinates. The first pair of a row keeps the row's number, further ones are appended in the order they
 * come. Most corners of a row agree, so the first pair is compared directly; only copies go through a hash table, which
 * keeps a fan of any size linear. Pairs are equal if their bits are.
 */
#include "ply/parts.h"

#include <math.h>
#include <stdlib.h>
#include "base/hash_index.h"
#include "scene/polygon.h"

typedef enum wedge_state { WEDGE_UNUSED, WEDGE_HAS, WEDGE_LACKS } wedge_state;

typedef struct wedge {
	float uv[2];
	uint32_t row;
	wedge_state state;
} wedge;

typedef struct wedges {
	wedge *rows;   /* [row_count] the first one of each row */
	wedge *copies; /* of vertices row_count and so on */
	size_t row_count, copy_count, copy_capacity;
	nt_hash_index index;  /* of copies */
	bool any, any_lacks;  /* some corner has, some has no coordinates */
} wedges;

typedef struct builder {
	nt_mesh *mesh;
	ply_source *source;
	ply_polygons *polygons;
	nt_error *error;
	ply_rows rows;
	const ply_column *indices, *texcoords; /* NULL: no coordinates by corner */
	bool uniform;                          /* rows may be triangles and quads and nothing else */
	wedges wedges;
	size_t unsound, skipped; /* rows with a coordinate that is not finite, of fewer than three corners */
	nt_place first_unsound, first_skipped;
} builder;

/* ---- wedges ---- */

/* The vertex for a row with coordinates; uv NULL: with none. NT_NONE: memory or vertex numbers are exhausted. */
static uint32_t wedge_vertex(wedges *w, uint32_t row, const float *uv)
{
	wedge new = {.row = row, .state = uv ? WEDGE_HAS : WEDGE_LACKS};
	memcpy(new.uv, uv ? uv : new.uv, sizeof new.uv);
	w->any |= uv != NULL;
	w->any_lacks |= uv == NULL;
	if (w->rows[row].state == WEDGE_UNUSED)
		w->rows[row] = new;
	if (memcmp(&w->rows[row], &new, sizeof new) == 0)
		return row;
	uint64_t bits;
	memcpy(&bits, new.uv, sizeof bits);
	const uint64_t hash = nt_hash_words(bits, row);
	size_t at = NT_HASH_BEGIN;
	for (uint32_t copy; (copy = nt_hash_index_next(&w->index, hash, &at)) != NT_NONE;)
		if (memcmp(&w->copies[copy], &new, sizeof new) == 0)
			return (uint32_t)(w->row_count + copy);
	if (w->row_count + w->copy_count + 1 >= NT_NONE ||
		!nt_grow((void **)&w->copies, &w->copy_capacity, w->copy_count + 1, sizeof new) ||
		!nt_hash_index_add(&w->index, hash, (uint32_t)w->copy_count))
		return NT_NONE;
	w->copies[w->copy_count] = new;
	return (uint32_t)(w->row_count + w->copy_count++);
}

static nt_status take_wedges(builder *b, uint32_t *corners, size_t size)
{
	const size_t count = b->rows.cells[b->source->face_texcoords].count;
	if (count != 0 && count != 2 * size)
		return ply_fail_at(b->rows.cursor, b->rows.begin, b->error,
			"%s %zu: list \"texcoord\" has %zu values, expected %zu for %zu corners, or none",
			b->rows.element->name, b->rows.row - 1, count, 2 * size, size);
	for (size_t k = 0; k < size; k++) {
		corners[k] = wedge_vertex(&b->wedges, corners[k], count ? b->texcoords->floats + 2 * k : NULL);
		if (corners[k] == NT_NONE)
			return nt_fail_memory(b->error);
	}
	return NT_OK;
}

/* A copy of an array of rows with the copies' rows behind it. */
static bool append_copies(const wedges *w, nt_arena *arena, float **array, size_t width)
{
	if (!*array || !w->copy_count)
		return true;
	float *grown = nt_arena_alloc(arena, w->row_count + w->copy_count, width * sizeof *grown);
	if (!grown)
		return false;
	memcpy(grown, *array, w->row_count * width * sizeof *grown);
	for (size_t i = 0; i < w->copy_count; i++)
		memcpy(grown + (w->row_count + i) * width, *array + w->copies[i].row * width, width * sizeof *grown);
	*array = grown;
	return true;
}

/* Gives the mesh its texture coordinates, and its copies all other attributes. Nothing happens if no corner had
 * coordinates. */
static bool apply_wedges(const wedges *w, nt_arena *arena, nt_mesh *mesh, ply_source *source)
{
	const size_t count = w->row_count + w->copy_count;
	if (!w->any)
		return true;
	if (!append_copies(w, arena, &mesh->positions, 3) || !append_copies(w, arena, &mesh->normals, 3) ||
		!append_copies(w, arena, &mesh->colors, 4) || !append_copies(w, arena, &mesh->tangents, 4))
		return false;
	mesh->texcoords = nt_arena_alloc(arena, count, 2 * sizeof *mesh->texcoords);
	mesh->vertex_lacks = w->any_lacks ? nt_arena_alloc(arena, count, 1) : NULL;
	source->wedge_rows = nt_arena_alloc(arena, w->copy_count, sizeof *source->wedge_rows);
	if (!mesh->texcoords || !source->wedge_rows || (w->any_lacks && !mesh->vertex_lacks))
		return false;
	for (size_t v = 0; v < count; v++) {
		const wedge *own = v < w->row_count ? &w->rows[v] : &w->copies[v - w->row_count];
		memcpy(mesh->texcoords + 2 * v, own->uv, sizeof own->uv);
		if (mesh->vertex_lacks)
			mesh->vertex_lacks[v] = own->state == WEDGE_LACKS ? NT_LACKS_TEXCOORD : 0;
		if (v >= w->row_count)
			source->wedge_rows[v - w->row_count] = own->row;
	}
	mesh->vertex_count = count;
	source->wedge_count = w->copy_count;
	return true;
}

/* ---- rows ---- */

static bool make_room(ply_polygons *p, size_t polygons, size_t corners)
{
	return nt_grow((void **)&p->corners, &p->corner_capacity, p->corner_count + corners, sizeof *p->corners) &&
		(!p->sizes || nt_grow((void **)&p->sizes, &p->size_capacity, p->count + polygons, 1));
}

/* Notes polygons of one size, whose corners are there. The first one that is no triangle ends "all are triangles". */
static bool add_polygons(ply_polygons *p, size_t count, size_t size, const unsigned char *row)
{
	if (size != 3 && !p->sizes) {
		if (!nt_grow((void **)&p->sizes, &p->size_capacity, p->count + count, 1))
			return false;
		memset(p->sizes, 3, p->count);
	}
	if (size > 4) {
		if (!nt_grow((void **)&p->large, &p->large_capacity, p->large_count + 1, sizeof *p->large))
			return false;
		p->large[p->large_count++] = (ply_large_face){size, row};
	}
	if (p->sizes)
		memset(p->sizes + p->count, size > 4 ? 0 : (int)size, count);
	p->has_quads |= size == 4;
	p->count += count;
	p->corner_count += count * size;
	return true;
}

/* Texture coordinates of the row that are not finite become 0. */
static void mend_texcoords(builder *b)
{
	const size_t count = b->rows.cells[b->source->face_texcoords].count;
	for (size_t k = 0; k < count; k++)
		b->texcoords->floats[k] = isfinite(b->texcoords->floats[k]) ? b->texcoords->floats[k] : 0.0f;
	if (!b->unsound++)
		b->first_unsound = ply_place(b->rows.cursor, b->rows.begin);
	b->rows.unsound = false;
}

/* The row that was read is a polygon. */
static nt_status take_polygon(builder *b)
{
	ply_polygons *p = b->polygons;
	const size_t size = b->rows.cells[b->source->face_indices].count;
	if (size < 3) {
		if (b->skipped++ == 0)
			b->first_skipped = ply_place(b->rows.cursor, b->rows.begin);
		return NT_OK;
	}
	if (!make_room(p, 1, size))
		return nt_fail_memory(b->error);
	uint32_t *corners = p->corners + p->corner_count;
	memcpy(corners, b->indices->integers, size * sizeof *corners);
	const nt_status status = b->texcoords ? take_wedges(b, corners, size) : NT_OK;
	if (p->textures)
		p->textures[p->count] = p->textures[b->rows.row - 1];
	return status || add_polygons(p, 1, size, b->rows.begin) ? status : nt_fail_memory(b->error);
}

/* The row that was read is a run of strips. Triangles with a doubled corner join strips and are no faces. */
static nt_status take_strips(builder *b)
{
	ply_polygons *p = b->polygons;
	const size_t count = b->rows.cells[b->source->face_indices].count;
	size_t begin = 0;
	if (!make_room(p, count, 3 * count))
		return nt_fail_memory(b->error);
	for (size_t i = 0; i < count; i++) {
		const uint32_t *c = b->indices->integers + i;
		if (*c == NT_NONE)
			begin = i + 1;
		if (*c == NT_NONE || i < begin + 2 || c[0] == c[-1] || c[0] == c[-2] || c[-1] == c[-2])
			continue;
		const bool odd = (i - begin) & 1;
		const uint32_t vertices[3] = {c[odd ? -1 : -2], c[odd ? -2 : -1], c[0]};
		memcpy(p->corners + p->corner_count, vertices, sizeof vertices);
		add_polygons(p, 1, 3, b->rows.begin);
	}
	return NT_OK;
}

static nt_status read_rows(builder *b)
{
	ply_polygons *p = b->polygons;
	const bool strips = b->source->strips != NULL;
	nt_status status = NT_OK;
	while (!status && b->rows.row < b->rows.element->count) {
		const size_t left = b->rows.element->count - b->rows.row;
		const size_t size = b->uniform ? ply_list_size(&b->rows, (size_t)b->source->face_indices) : 0;
		if (size && !make_room(p, left, size * left))
			return nt_fail_memory(b->error);
		const size_t taken = size ? ply_take_rows(&b->rows, p->corners + p->corner_count, size) : 0;
		if (taken && !add_polygons(p, taken, size, NULL))
			return nt_fail_memory(b->error);
		if (taken)
			continue;
		status = ply_read_row(&b->rows, b->error);
		if (!status && b->rows.unsound)
			mend_texcoords(b);
		if (!status)
			status = strips ? take_strips(b) : take_polygon(b);
	}
	return status;
}

/* Says what the columns of rows are used for. */
static nt_status prepare(builder *b, nt_arena *arena)
{
	const ply_element *element = b->rows.element;
	const ply_source *source = b->source;
	size_t lists = 0;
	for (size_t i = 0; i < element->property_count; i++)
		lists += element->properties[i].list;
	b->uniform = lists == 1 && !source->strips;
	b->rows.may_be_longer = true;
	ply_column *indices = &b->rows.columns[source->face_indices];
	*indices = (ply_column){.use = PLY_INDICES, .limit = source->vertex->count, .restarts = source->strips != NULL};
	b->indices = indices;
	if (source->face_texcoords != PLY_NO_PROPERTY) {
		ply_column *texcoords = &b->rows.columns[source->face_texcoords];
		*texcoords = (ply_column){.use = PLY_FLOATS, .divisor = 1, .other = PLY_MENDED};
		b->texcoords = texcoords;
		b->wedges.row_count = source->vertex->count;
		b->wedges.rows = nt_calloc(b->wedges.row_count, sizeof *b->wedges.rows);
		if (!b->wedges.rows)
			return nt_fail_memory(b->error);
		for (size_t i = 0; i < b->wedges.row_count; i++)
			b->wedges.rows[i].row = (uint32_t)i;
	}
	const int texture = source->header.texture_count && !source->strips ? ply_find_property(element, "texnumber")
		: PLY_NO_PROPERTY;
	if (texture != PLY_NO_PROPERTY && !element->properties[texture].list) {
		b->polygons->textures = nt_arena_alloc(arena, element->count, sizeof *b->polygons->textures);
		b->rows.columns[texture] = (ply_column){.use = PLY_CHOICES, .integers = b->polygons->textures,
			.stride = 1, .limit = source->header.texture_count};
		b->uniform = false;
		if (!b->polygons->textures)
			return nt_fail_memory(b->error);
	}
	/* most files are triangles; the count has been checked against the file */
	return make_room(b->polygons, element->count, 3 * element->count + 4) ? NT_OK : nt_fail_memory(b->error);
}

nt_status ply_read_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_polygons *polygons, ply_cursor *cursor,
	nt_error *error)
{
	const ply_element *element = source->strips ? source->strips : source->face;
	builder b = {.mesh = mesh, .source = source, .polygons = polygons, .error = error};
	nt_status status = ply_check_count(cursor, element, error);
	if (!status)
		status = ply_begin_rows(&b.rows, cursor, element) ? prepare(&b, &scene->arena) : nt_fail_memory(error);
	if (!status)
		status = read_rows(&b);
	if (!status && b.texcoords && !apply_wedges(&b.wedges, &scene->arena, mesh, source))
		status = nt_fail_memory(error);
	if (!status && b.unsound)
		nt_finding_add(&scene->findings, NT_CODE_UV_NOT_FINITE, &b.first_unsound, b.unsound, "faces");
	if (!status && b.skipped)
		nt_scene_leave_out(scene, b.first_skipped.line, b.skipped, "faces of fewer than three corners (%zu)",
			b.skipped);
	if (!status && b.rows.longer) {
		const nt_place first = ply_place(cursor, b.rows.first_longer);
		nt_scene_leave_out(scene, first.line, b.rows.longer,
			"values of faces beyond those that the header names (%zu)", b.rows.longer);
	}
	ply_free_rows(&b.rows);
	free(b.wedges.rows);
	free(b.wedges.copies);
	nt_hash_index_free(&b.wedges.index);
	return status;
}

/* ---- faces of polygons ---- */

void ply_free_polygons(ply_polygons *p)
{
	free(p->corners);
	free(p->sizes);
	free(p->large);
	*p = (ply_polygons){0};
}

/* Primitives of textures that no face uses are left out. The numbers of textures become those of primitives. */
static nt_status make_primitives(nt_scene *scene, nt_mesh *mesh, size_t textures, nt_error *error)
{
	uint32_t *numbers = mesh->face_primitive;
	const size_t most = numbers ? textures + 1 : 1;
	mesh->primitives = nt_arena_alloc(&scene->arena, most, sizeof *mesh->primitives);
	uint32_t *counts = nt_calloc(most, sizeof *counts);
	if (!mesh->primitives || !counts) {
		free(counts);
		return nt_fail_memory(error);
	}
	if (!numbers) {
		mesh->primitives[0] =
			(nt_primitive){.material = textures ? 0 : NT_NONE, .face_count = mesh->face_count};
		mesh->primitive_count = 1;
	}
	for (size_t f = 0; numbers && f < mesh->face_count; f++)
		counts[numbers[f]]++;
	for (size_t i = 0; numbers && i < most; i++) {
		if (!counts[i])
			continue;
		mesh->primitives[mesh->primitive_count] =
			(nt_primitive){.material = i < textures ? (uint32_t)i : NT_NONE, .face_count = counts[i]};
		counts[i] = (uint32_t)mesh->primitive_count++;
	}
	for (size_t f = 0; numbers && f < mesh->face_count; f++)
		numbers[f] = counts[numbers[f]];
	mesh->face_primitive = mesh->primitive_count > 1 ? numbers : NULL;
	free(counts);
	return NT_OK;
}

/* Cuts a polygon: the corner numbers of its triangles go to `cut`. */
static nt_status cut_polygon(const nt_mesh *mesh, const uint32_t *vertices, size_t size, uint32_t *cut, bool *sound,
	nt_error *error)
{
	float (*points)[3] = nt_alloc(size, sizeof *points);
	for (size_t k = 0; points && k < size; k++)
		memcpy(points[k], mesh->positions + 3 * (size_t)vertices[k], sizeof *points);
	const bool done = points && !nt_polygon_triangulate((const float(*)[3])points, size, cut, sound);
	free(points);
	return done ? NT_OK : nt_fail_memory(error);
}

/* Arrays of faces that are not the polygons themselves. */
static nt_status start_faces(nt_arena *arena, nt_mesh *mesh, ply_source *source, const ply_polygons *p, nt_error *error)
{
	for (size_t i = 0; i < p->large_count; i++)
		source->cut_count += 3 * (p->large[i].size - 2);
	size_t large_corners = 0;
	for (size_t i = 0; i < p->large_count; i++)
		large_corners += p->large[i].size;
	mesh->face_count = p->count - p->large_count + source->cut_count / 3;
	mesh->corner_count = p->corner_count - large_corners + source->cut_count;
	if (mesh->face_count > NMTAN_MAX_FACES)
		return nt_fail(error, NT_ERROR_TOO_LARGE, "more than %zu faces", NMTAN_MAX_FACES);
	if (!p->large_count)
		return NT_OK;
	mesh->indices = nt_arena_alloc(arena, mesh->corner_count, sizeof *mesh->indices);
	mesh->face_polygon = nt_arena_alloc(arena, mesh->face_count, sizeof *mesh->face_polygon);
	mesh->face_sizes = p->has_quads ? nt_arena_alloc(arena, mesh->face_count, 1) : NULL;
	mesh->face_primitive = p->textures ? nt_arena_alloc(arena, mesh->face_count, sizeof *p->textures) : NULL;
	source->cuts = nt_arena_alloc(arena, source->cut_count, sizeof *source->cuts);
	return mesh->indices && mesh->face_polygon && source->cuts && (mesh->face_sizes || !p->has_quads) &&
			(mesh->face_primitive || !p->textures) ? NT_OK : nt_fail_memory(error);
}

nt_status ply_make_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_polygons *p, size_t *unsound,
	const unsigned char **first, nt_error *error)
{
	const bool again = mesh->face_count > 0;
	nt_status status = again ? NT_OK : start_faces(&scene->arena, mesh, source, p, error);
	size_t face = 0, large = 0, cuts = 0;
	const uint32_t *from = p->corners;
	uint32_t *to = mesh->indices;
	*unsound = 0;
	for (size_t i = 0; !status && p->large_count && i < p->count; i++) {
		const size_t size = p->sizes[i] ? p->sizes[i] : p->large[large].size;
		uint32_t *const cut = source->cuts + cuts;
		const size_t faces = size > 4 ? size - 2 : 1;
		bool sound = true;
		if (size > 4)
			status = cut_polygon(mesh, from, size, cut, &sound, error);
		for (size_t k = 0; !status && k < (size > 4 ? 3 * faces : size); k++)
			*to++ = from[size > 4 ? cut[k] : k];
		for (size_t f = face; f < face + faces; f++) {
			mesh->face_polygon[f] = (uint32_t)i;
			if (mesh->face_sizes)
				mesh->face_sizes[f] = size == 4 ? 4 : 3;
			if (mesh->face_primitive && !again)
				mesh->face_primitive[f] = p->textures[i];
		}
		if (!sound && !(*unsound)++ && !again)
			*first = p->large[large].row;
		from += size;
		face += faces;
		cuts += size > 4 ? 3 * faces : 0;
		large += size > 4;
	}
	if (again || status)
		return status;
	if (!p->large_count) {
		mesh->indices = p->corners;
		mesh->face_sizes = p->sizes;
		mesh->face_primitive = p->textures;
		p->corners = NULL;
		p->sizes = NULL;
		/* both belong to the arena, after an error too */
		const bool kept = nt_arena_adopt(&scene->arena, mesh->indices);
		if (!nt_arena_adopt(&scene->arena, mesh->face_sizes) || !kept)
			return nt_fail_memory(error);
	}
	return make_primitives(scene, mesh, source->header.texture_count, error);
}

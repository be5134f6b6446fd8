/* SPDX-License-Identifier: MIT */
/*
 * Meshes from faces, vertices and spans. Triangles and quads are handed on as they stand: a mesh
 * without larger polygons points into the arrays of the whole file. Larger ones become triangles; all
 * faces made of one polygon carry its number.
 */
#include "obj/parts.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/parallel.h"
#include "scene/values.h"

enum { GRAIN = 1 << 14 }; /* rows per thread that are worth one */

/* Shared data of making meshes. Attribute arrays are for the vertices of all meshes. */
typedef struct builder {
	obj_file *file;
	nt_error *error;
	float *positions, *normals, *texcoords, *colors;
	uint8_t *lacks;
	nt_srgb srgb;
	size_t span;              /* of the next face */
	size_t polygon;           /* the next one of five corners and more */
	obj_primitives primitives; /* of the current mesh */

	uint32_t *triangles; /* of one polygon */
	size_t triangle_capacity;

	atomic_uint largest;      /* bits of the largest coordinate */
} builder;

/* ---- vertices ---- */

static void copy_row(const obj_file *file, int kind, uint32_t row, float *to)
{
	const size_t width = obj_widths[kind];
	if (row == OBJ_ABSENT) {
		memset(to, 0, width * sizeof *to);
	} else {
		const obj_rows *rows = &obj_find_row(file, kind, row)->rows[kind];
		memcpy(to, rows->data + (row - rows->first) * width, width * sizeof *to);
	}
}

static void copy_color(const builder *b, uint32_t row, float *to)
{
	const obj_file *file = b->file;
	const obj_chunk *chunk = obj_find_row(file, OBJ_V, row);
	static const float white[4] = {1, 1, 1, 1};
	const float *from =
		chunk->colors ? chunk->colors + 4 * (row - chunk->rows[OBJ_V].first) : white;
	for (int k = 0; k < 3; k++)
		to[k] = nt_linear_from_srgb(&b->srgb, fminf(fmaxf(from[k], 0), 1));
	to[3] = fminf(fmaxf(from[3], 0), 1);
}

static void gather(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	builder *b = context;
	const obj_file *file = b->file;
	for (size_t i = begin; i < end; i++) {
		const obj_vertex *x = &file->vertices[i];
		copy_row(file, OBJ_V, x->v, b->positions + 3 * i);
		if (b->texcoords)
			copy_row(file, OBJ_VT, x->t, b->texcoords + 2 * i);
		if (b->normals)
			copy_row(file, OBJ_VN, x->n, b->normals + 3 * i);
		if (b->colors)
			copy_color(b, x->v, b->colors + 4 * i);
		b->lacks[i] = (uint8_t)((x->n == OBJ_ABSENT ? NT_LACKS_NORMAL : 0) |
			(x->t == OBJ_ABSENT ? NT_LACKS_TEXCOORD : 0));
	}
	/* bits of floats above 0 are in the order of the floats */
	unsigned bits, before = atomic_load(&b->largest);
	const float largest = nt_largest_of(b->positions + 3 * begin, 3 * (end - begin), 0);
	memcpy(&bits, &largest, sizeof bits);
	while (bits > before && !atomic_compare_exchange_weak(&b->largest, &before, bits))
		;
}

static nt_status gather_vertices(builder *b)
{
	obj_file *file = b->file;
	nt_arena *arena = &file->scene->arena;
	const size_t count = file->vertex_count;
	b->positions = nt_arena_alloc(arena, count, 3 * sizeof(float));
	b->lacks = nt_arena_alloc(arena, count, 1);
	if (!b->positions || !b->lacks)
		return nt_fail_memory(b->error);
	if (file->row_counts[OBJ_VT] && !(b->texcoords = nt_arena_alloc(arena, count, 2 * sizeof(float))))
		return nt_fail_memory(b->error);
	if (file->row_counts[OBJ_VN] && !(b->normals = nt_arena_alloc(arena, count, 3 * sizeof(float))))
		return nt_fail_memory(b->error);
	if (file->has_colors && !(b->colors = nt_arena_alloc(arena, count, 4 * sizeof(float))))
		return nt_fail_memory(b->error);
	nt_parallel_ranges(file->threads, count, GRAIN, gather, b);
	float largest;
	const unsigned bits = atomic_load(&b->largest);
	memcpy(&largest, &bits, sizeof largest);
	return obj_settle_origin(file, largest, b->positions, b->error);
}

/* Gives the mesh its part of the arrays that it has anything in. */
static void set_vertices(const builder *b, nt_mesh *mesh, size_t first)
{
	unsigned any = 0, all = ~0u; /* of what lacks */
	for (size_t i = first; i < first + mesh->vertex_count; i++) {
		any |= b->lacks[i];
		all &= b->lacks[i];
	}
	mesh->has_positions = true;
	mesh->has_normals = !(all & NT_LACKS_NORMAL);
	mesh->has_texcoords = !(all & NT_LACKS_TEXCOORD);
	mesh->positions = b->positions + 3 * first;
	mesh->exact_positions = b->file->exact_positions ? b->file->exact_positions + 3 * first : NULL;
	mesh->normals = mesh->has_normals ? b->normals + 3 * first : NULL;
	mesh->texcoords = mesh->has_texcoords ? b->texcoords + 2 * first : NULL;
	mesh->colors = b->colors ? b->colors + 4 * first : NULL;
	/* An attribute that the whole mesh does not have is missing in no vertex. */
	const unsigned partly = any & ~all;
	if (!partly)
		return;
	mesh->vertex_lacks = b->lacks + first;
	for (size_t i = first; i < first + mesh->vertex_count; i++)
		b->lacks[i] &= (uint8_t)partly;
}

/* ---- faces ---- */

/* Counts of a mesh's faces. */
typedef struct face_counts {
	size_t quads, polygons;     /* polygons: of five corners and more */
	size_t faces, corners;      /* when polygons have become triangles */
} face_counts;

static face_counts count_faces(const builder *b, size_t begin, size_t end, size_t corner_count)
{
	const uint8_t *sizes = b->file->face_sizes;
	face_counts n = {0, 0, end - begin, corner_count};
	for (size_t f = begin; f < end; f++) {
		n.quads += sizes[f] == 4;
		n.polygons += sizes[f] == OBJ_POLYGON;
	}
	for (size_t i = 0; i < n.polygons; i++) {
		const size_t size = b->file->polygons[b->polygon + i].size;
		n.faces += size - 3;
		n.corners += 3 * (size - 2) - size;
	}
	return n;
}

/* Replaces a polygon of the file by triangles: writes 3 * (size - 2) vertices. */
static nt_status triangulate(builder *b, nt_mesh *mesh, const obj_polygon *polygon,
	const uint32_t *corners, uint32_t *to)
{
	const size_t size = polygon->size;
	bool sound;
	if (!nt_grow((void **)&b->triangles, &b->triangle_capacity, size, 3 * sizeof *b->triangles) ||
		nt_polygon_triangulate((const float(*)[3])mesh->positions, corners, size, b->triangles, &sound))
		return nt_fail_memory(b->error);
	for (size_t i = 0; i < 3 * (size - 2); i++)
		to[i] = corners[b->triangles[i]];
	if (!sound) {
		nt_finding_list *findings = &b->file->scene->findings;
		nt_place place;
		nt_mesh_place(mesh, &place);
		place.line = polygon->line;
		nt_finding_add(findings, NT_CODE_POLYGON_DEGENERATE, &place, 1, NULL);
	}
	return NT_OK;
}

static void fill(uint32_t *to, size_t count, uint32_t value)
{
	for (size_t i = 0; to && i < count; i++)
		to[i] = value;
}

/* Walks through the spans of the mesh: primitives, smoothing groups, and if polygons have to be replaced, its faces one
 * by one. */
static nt_status write_spans(builder *b, nt_mesh *mesh, size_t begin, size_t end, const uint32_t *source)
{
	const obj_file *file = b->file;
	size_t face = 0, corner = 0; /* of the mesh, after triangulation */
	for (size_t f = begin; f < end; b->span++) {
		const obj_span *span = &file->spans[b->span];
		const bool last = b->span + 1 == file->span_count || span[1].face >= end;
		const size_t stop = last ? end : span[1].face, first = face;
		if (!mesh->face_polygon) {
			face += stop - f;
			f = stop;
		}
		for (; f < stop; f++) {
			size_t size = file->face_sizes[f], count = 1;
			uint32_t *to = mesh->indices + corner;
			if (size == OBJ_POLYGON) {
				const obj_polygon *polygon = &file->polygons[b->polygon++];
				size = polygon->size;
				count = size - 2;
				corner += 3 * count;
				const nt_status status = triangulate(b, mesh, polygon, source, to);
				if (status)
					return status;
			} else {
				memcpy(to, source, size * sizeof *to);
				corner += size;
			}
			fill(mesh->face_polygon + face, count, (uint32_t)(f - begin));
			if (mesh->face_sizes)
				memset(mesh->face_sizes + face, size == 4 ? 4 : 3, count);
			source += size;
			face += count;
		}
		const uint32_t primitive = obj_add_primitive(&b->primitives, span->material, span->group, face - first);
		if (primitive == NT_NONE)
			return nt_fail_memory(b->error);
		fill(mesh->face_primitive ? mesh->face_primitive + first : NULL, face - first, primitive);
		fill(mesh->face_smoothing ? mesh->face_smoothing + first : NULL, face - first, span->smoothing);
	}
	return NT_OK;
}

/* ---- primitives ---- */

/* The first ones are looked at one by one: few meshes have more. */
enum { FEW_PRIMITIVES = 8 };

uint32_t obj_add_primitive(obj_primitives *list, uint32_t material, uint32_t group, size_t faces)
{
	const uint64_t hash = nt_hash_words(material, group);
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i = 0; i != NT_NONE && i < list->count;) {
		nt_primitive *known = &list->items[i];
		if (known->material == material && known->group == group) {
			known->face_count += faces;
			return i;
		}
		i = i + 1 < FEW_PRIMITIVES ? i + 1 : nt_hash_index_next(&list->index, hash, &at);
	}
	if (!nt_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items) ||
		(list->count >= FEW_PRIMITIVES && !nt_hash_index_add(&list->index, hash, (uint32_t)list->count)))
		return NT_NONE;
	list->items[list->count] = (nt_primitive){.material = material, .group = group, .face_count = faces};
	return (uint32_t)list->count++;
}

static int compare_words(const void *a, const void *b)
{
	const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
	return (x > y) - (x < y);
}

bool obj_set_primitives(nt_mesh *mesh, obj_primitives *list, nt_arena *arena)
{
	const size_t count = list->count;
	bool sorted = true;
	for (size_t i = 1; i < count; i++)
		sorted &= list->items[i - 1].group <= list->items[i].group;
	mesh->primitives = nt_arena_alloc(arena, count, sizeof *mesh->primitives);
	uint64_t *order = sorted ? NULL : nt_alloc(count, sizeof *order); /* groups, and numbers below */
	uint32_t *numbers = sorted ? NULL : nt_alloc(count, sizeof *numbers);
	const bool done = mesh->primitives && (sorted || (order && numbers));
	for (size_t i = 0; done && !sorted && i < count; i++)
		order[i] = (uint64_t)list->items[i].group << 32 | i;
	if (done && !sorted)
		qsort(order, count, sizeof *order, compare_words);
	for (size_t i = 0; done && i < count; i++) {
		const uint32_t from = sorted ? (uint32_t)i : (uint32_t)order[i];
		mesh->primitives[i] = list->items[from];
		if (!sorted)
			numbers[from] = (uint32_t)i;
	}
	for (size_t f = 0; done && !sorted && f < mesh->face_count; f++)
		mesh->face_primitive[f] = numbers[mesh->face_primitive[f]];
	mesh->primitive_count = count;
	mesh->face_primitive = count > 1 ? mesh->face_primitive : NULL;
	list->count = 0;
	nt_hash_index_free(&list->index);
	free(order);
	free(numbers);
	return done;
}

/* Indices, sizes, polygons, primitives and smoothing groups. */
static nt_status set_faces(builder *b, nt_mesh *mesh, size_t m)
{
	obj_file *file = b->file;
	nt_arena *arena = &file->scene->arena;
	const size_t begin = file->meshes[m].face, end = file->meshes[m + 1].face;
	uint32_t *const source = file->corner_vertices + file->meshes[m].corner;
	const face_counts n =
		count_faces(b, begin, end, file->meshes[m + 1].corner - file->meshes[m].corner);
	if (n.faces > NMTAN_MAX_FACES)
		return nt_fail_line(b->error, NT_ERROR_TOO_LARGE, mesh->line,
			"object of %zu faces, at most %zu can be solved together", n.faces, NMTAN_MAX_FACES);
	mesh->face_count = n.faces;
	mesh->corner_count = n.corners;
	mesh->indices = source;
	mesh->face_sizes = n.quads ? file->face_sizes + begin : NULL;
	if (n.polygons) {
		mesh->indices = nt_arena_alloc(arena, n.corners, sizeof *mesh->indices);
		mesh->face_polygon = nt_arena_alloc(arena, n.faces, sizeof *mesh->face_polygon);
		if (n.quads)
			mesh->face_sizes = nt_arena_alloc(arena, n.faces, 1);
		if (!mesh->indices || !mesh->face_polygon || (n.quads && !mesh->face_sizes))
			return nt_fail_memory(b->error);
	}
	const bool one_span = b->span + 1 == file->span_count || file->spans[b->span + 1].face >= end;
	bool lacking = !mesh->normals;
	for (size_t i = 0; file->uses_smoothing && mesh->vertex_lacks && i < mesh->vertex_count && !lacking; i++)
		lacking = mesh->vertex_lacks[i] & NT_LACKS_NORMAL;
	const bool smooths = file->uses_smoothing && lacking;
	if (smooths)
		mesh->face_smoothing = nt_arena_alloc(arena, n.faces, sizeof *mesh->face_smoothing);
	if (!one_span)
		mesh->face_primitive = nt_arena_alloc(arena, n.faces, sizeof *mesh->face_primitive);
	if ((smooths && !mesh->face_smoothing) || (!one_span && !mesh->face_primitive))
		return nt_fail_memory(b->error);
	const nt_status status = write_spans(b, mesh, begin, end, source);
	if (status)
		return status;
	if (!obj_set_primitives(mesh, &b->primitives, arena))
		return nt_fail_memory(b->error);
	if (file->group_count > 1) {
		mesh->groups = file->groups;
		/* a mesh of one group has its name */
		if (mesh->primitives[0].group == mesh->primitives[mesh->primitive_count - 1].group)
			mesh->name = mesh->groups[mesh->primitives[0].group];
	}
	return NT_OK;
}

/* ---- meshes ---- */

/* Demands of its materials: slots, how normal maps are sampled. If several differ, they are mirrored alike (see
 * spans.c), which is all that tangents know of. */
static nt_status set_slots(const obj_file *file, nt_mesh *mesh, nt_error *error)
{
	nt_scene *scene = file->scene;
	nt_uv_transform transform = {.scale = {1, 1}};
	bool clamps = false, repeats = false;
	for (size_t i = 0, maps = 0; i < mesh->primitive_count; i++) {
		const uint32_t material = mesh->primitives[i].material;
		if (material == NT_NONE)
			continue;
		const nt_map *map = &scene->materials[material].normal_map;
		if (scene->materials[material].anisotropy != 0)
			mesh->slots |= NT_SLOT_ANISOTROPY;
		if (!map->name)
			continue;
		mesh->slots |= NT_SLOT_NORMAL;
		clamps |= map->placement.clamp;
		repeats |= !map->placement.clamp;
		for (int axis = 0; axis < 2; axis++) {
			const double scale = map->placement.moved ? map->placement.scale[axis] : 1;
			const double common = maps ? transform.scale[axis] : scale;
			transform.scale[axis] = scale == common ? scale : scale < 0 ? -1 : 1;
		}
		maps++;
	}
	for (int axis = 0; axis < 2; axis++)
		mesh->wrap[axis] = clamps && !repeats ? NT_WRAP_CLAMP : NT_WRAP_REPEAT;
	const bool scaled = transform.scale[0] != 1 || transform.scale[1] != 1;
	return mesh->texcoords && scaled && file->options->transform == NT_TRANSFORM_BAKE
		? nt_mesh_transform(mesh, &transform, &scene->arena, error) : NT_OK;
}

static nt_status make_mesh(builder *b, size_t m)
{
	obj_file *file = b->file;
	nt_mesh *mesh = &file->scene->meshes[m];
	*mesh = (nt_mesh){
		.gltf_mesh = NT_NONE,
		.gltf_primitive = NT_NONE,
		.triangles = true,
		.reachable = true,
		.vertex_count = file->meshes[m + 1].vertex - file->meshes[m].vertex,
	};
	const obj_event *object = file->meshes[m].object;
	mesh->source_vertex_count = mesh->vertex_count;
	mesh->name = object ? obj_utf8_text(&file->scene->arena, object->text, object->length) : "";
	mesh->file = file->scene->path;
	mesh->line = file->meshes[m].line;
	if (!mesh->name)
		return nt_fail_memory(b->error);
	set_vertices(b, mesh, file->meshes[m].vertex);
	nt_status status = set_faces(b, mesh, m);
	if (!status)
		status = set_slots(file, mesh, b->error);
	if (status)
		return status;
	nt_instance *instance = &file->scene->instances[m];
	instance->mesh = (uint32_t)m;
	nt_origin_matrix(file->scene, instance->matrix);
	return NT_OK;
}

nt_status obj_make_meshes(obj_file *file, nt_error *error)
{
	nt_scene *scene = file->scene;
	builder b = {.file = file, .error = error};
	nt_srgb_init(&b.srgb);
	scene->meshes = nt_arena_alloc(&scene->arena, file->mesh_count, sizeof *scene->meshes);
	scene->instances = nt_arena_alloc(&scene->arena, file->mesh_count, sizeof *scene->instances);
	nt_status status = NT_OK;
	if (!scene->meshes || !scene->instances)
		status = nt_fail_memory(error);
	if (!status)
		status = gather_vertices(&b);
	for (size_t m = 0; m < file->mesh_count && !status; m++) {
		status = make_mesh(&b, m);
		if (!status)
			scene->mesh_count = scene->instance_count = m + 1;
	}
	free(b.primitives.items);
	nt_hash_index_free(&b.primitives.index);
	free(b.triangles);
	return status;
}

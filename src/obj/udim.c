/* SPDX-License-Identifier: MIT */
/*
 * UDIM: an image for each tile of texture space, numbered 1001 + the tile along u (0 to 9) + 10 times the one along v.
 * A glTF texture has one image, so that a material whose maps have <UDIM> in their names becomes one for each tile that
 * faces lie in. Texture coordinates stay: images repeat; but islands in different tiles share no texels, which the mesh
 * says by its wrap. A name with a number alone is taken at its word; if faces in several tiles show its image, that is
 * a finding.
 */
#include "obj/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char mark[] = "<UDIM>";
enum { FIRST_TILE = 1001, TILES_ALONG_U = 10, TILES = 1000, NO_TILE = TILES };

/* The place of a tile's number in a name, behind a dot or underscore and before a dot; NULL: nowhere. */
static const char *find_number(const char *name)
{
	for (const char *p = name; name && *p; p++)
		if ((*p == '.' || *p == '_') && p[1] == '1' && strspn(p + 1, "0123456789") == 4 && p[5] == '.')
			return p + 1;
	return NULL;
}

/* A material as it was. */
typedef struct template {
	const nt_map *marked;   /* a map with a mark in its name; NULL: none */
	const nt_map *numbered; /* else one with a number, which counts if there is no mark */
	uint32_t first, last;   /* then: tiles of its faces; NO_TILE: none yet */
	size_t outside;         /* faces that are in no tile */
} template;

typedef struct tiler {
	nt_scene *scene;
	nt_error *error;
	template *templates;      /* [scene->material_count] */
	nt_material *materials;   /* of the result: the first of a template takes its place */
	struct made {
		uint32_t from, tile;
	} *made;                  /* [count] templates of materials, and their tiles */
	size_t count, capacity, made_capacity;
	nt_hash_index index;      /* of made */
	obj_primitives primitives; /* of the current mesh */
} tiler;

static const nt_map *find_map(const nt_material *m, bool marked)
{
	for (int i = 0; i < NT_MATERIAL_MAPS; i++) {
		const char *name = m->maps[i].name;
		if (name && (marked ? strstr(name, mark) : find_number(name)) != NULL)
			return &m->maps[i];
	}
	return NULL;
}

/* The tile of a face, from 0 on: that of its centre. One that is in none has the first, and is counted in *outside. */
static uint32_t tile_of(const nt_mesh *mesh, size_t corner, size_t size, size_t *outside)
{
	double sum[2] = {0, 0};
	for (size_t k = 0; k < size; k++)
		for (int axis = 0; axis < 2; axis++)
			sum[axis] += mesh->texcoords[2 * (size_t)mesh->indices[corner + k] + axis];
	const double u = floor(sum[0] / (double)size), v = floor(sum[1] / (double)size);
	const bool inside = u >= 0 && u < TILES_ALONG_U && v >= 0 && v < TILES / TILES_ALONG_U;
	*outside += !inside;
	return inside ? (uint32_t)u + TILES_ALONG_U * (uint32_t)v : 0;
}

/* name with the tile's number for each mark. */
static char *name_of_tile(nt_arena *arena, const char *name, uint32_t tile)
{
	char *made = nt_arena_text(arena, name, strlen(name)), *to = made;
	for (const char *here; made && (here = strstr(name, mark)); name = here + sizeof mark - 1)
		to += sprintf(to, "%.*s%u", (int)(here - name), name, FIRST_TILE + tile);
	if (made)
		strcpy(to, name);
	return made;
}

static bool make_material(tiler *t, nt_material *m, const nt_material *from, uint32_t tile)
{
	nt_arena *arena = &t->scene->arena;
	char suffix[8];
	snprintf(suffix, sizeof suffix, ".%u", FIRST_TILE + tile);
	*m = *from;
	char *name = nt_arena_alloc(arena, strlen(from->name) + sizeof suffix, 1);
	if (!name)
		return false;
	m->name = strcat(strcpy(name, from->name), suffix);
	for (int i = 0; i < NT_MATERIAL_MAPS; i++) {
		nt_map *map = &m->maps[i];
		if (!map->name || !strstr(map->name, mark))
			continue;
		map->placement.clamp = false;
		map->name = name_of_tile(arena, map->name, tile);
		if (!map->name)
			return false;
	}
	return true;
}

/* The material of a template in a tile; NT_NONE: out of memory. */
static uint32_t material_of(tiler *t, uint32_t from, uint32_t tile)
{
	const uint64_t hash = nt_hash_words(from, tile);
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i; (i = nt_hash_index_next(&t->index, hash, &at)) != NT_NONE;)
		if (t->made[i].from == from && t->made[i].tile == tile)
			return i;
	const bool first = t->made[from].tile == NO_TILE;
	const uint32_t number = first ? from : (uint32_t)t->count;
	if (!nt_grow((void **)&t->made, &t->made_capacity, (size_t)number + 1, sizeof *t->made) ||
		!nt_grow((void **)&t->materials, &t->capacity, (size_t)number + 1, sizeof *t->materials) ||
		!nt_hash_index_add(&t->index, hash, number) ||
		!make_material(t, &t->materials[number], &t->scene->materials[from], tile))
		return NT_NONE;
	t->made[number] = (struct made){from, tile};
	t->count += !first;
	return number;
}

/* The material of a face of `size` corners from `corner` on; NT_NONE: out of memory. */
static uint32_t material_of_face(tiler *t, const nt_mesh *mesh, uint32_t material, size_t corner, size_t size)
{
	template *from = &t->templates[material];
	if (!from->marked && !from->numbered)
		return material;
	const uint32_t tile = tile_of(mesh, corner, size, &from->outside);
	if (from->marked)
		return material_of(t, material, tile);
	if (from->first == NO_TILE || tile < from->first)
		from->first = tile;
	if (from->last == NO_TILE || tile > from->last)
		from->last = tile;
	return material;
}

/* Each face goes to the primitive of its material and tile; primitives in the order of their first faces. */
static nt_status split_mesh(tiler *t, nt_mesh *mesh)
{
	bool any = false, tiled = false;
	for (size_t i = 0; i < mesh->primitive_count; i++) {
		const uint32_t material = mesh->primitives[i].material;
		tiled |= material != NT_NONE && t->templates[material].marked;
		any |= material != NT_NONE && (t->templates[material].marked || t->templates[material].numbered);
	}
	if (!any || !mesh->texcoords)
		return NT_OK;
	for (int axis = 0; axis < 2 && tiled; axis++)
		mesh->wrap[axis] = NT_WRAP_TILES;
	nt_arena *arena = &t->scene->arena;
	uint32_t *const numbers = mesh->face_primitive ? mesh->face_primitive
		: nt_arena_alloc(arena, mesh->face_count, sizeof *numbers);
	bool done = numbers != NULL;
	for (size_t f = 0, corner = 0; done && f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		const nt_primitive *old = &mesh->primitives[mesh->face_primitive ? numbers[f] : 0];
		const bool plain = old->material == NT_NONE;
		const uint32_t material = plain ? NT_NONE : material_of_face(t, mesh, old->material, corner, size);
		done = plain || material != NT_NONE;
		if (done)
			numbers[f] = obj_add_primitive(&t->primitives, material, old->group, 1);
		done = done && numbers[f] != NT_NONE;
		corner += size;
	}
	mesh->face_primitive = numbers;
	return done && obj_set_primitives(mesh, &t->primitives, arena) ? NT_OK : nt_fail_memory(t->error);
}

static void report_outside(const tiler *t, size_t i)
{
	const nt_map *map = t->templates[i].marked;
	const size_t count = t->templates[i].outside;
	if (!map || !count)
		return;
	const nt_place place = nt_line_place(t->scene->materials[i].library, map->line);
	nt_finding_add(&t->scene->findings, NT_CODE_MATERIAL_DOUBTFUL, &place, 1,
		"MTL: %.*s has no tile for %zu %s tile %d: u is not in 0 to %d, or v is below 0",
		NT_CUT(120, map->name), count,
		count == 1 ? "face, which shows" : "faces, which show", FIRST_TILE, TILES_ALONG_U);
}

static void report_numbered(const tiler *t, size_t i)
{
	const template *from = &t->templates[i];
	if (from->first == from->last)
		return;
	const nt_place place = nt_line_place(t->scene->materials[i].library, from->numbered->line);
	nt_finding_add(&t->scene->findings, NT_CODE_MATERIAL_DOUBTFUL, &place, 1,
		"MTL: %.*s is the image of one tile, and faces in the tiles %d to %d show it; for an image each, "
		"write <UDIM> in place of %.*s",
		NT_CUT(120, from->numbered->name), (int)(FIRST_TILE + from->first), (int)(FIRST_TILE + from->last),
		NT_CUT(4, find_number(from->numbered->name)));
}

nt_status obj_split_tiles(nt_scene *scene, nt_error *error)
{
	const size_t count = scene->material_count;
	tiler t = {.scene = scene, .error = error, .count = count};
	bool any = false;
	t.templates = nt_calloc(count, sizeof *t.templates);
	nt_status status = t.templates ? NT_OK : NT_ERROR_MEMORY;
	for (size_t i = 0; i < count && !status; i++) {
		const nt_map *marked = find_map(&scene->materials[i], true);
		t.templates[i] = (template){.marked = marked,
			.numbered = marked ? NULL : find_map(&scene->materials[i], false),
			.first = NO_TILE,
			.last = NO_TILE};
		any |= t.templates[i].marked || t.templates[i].numbered;
	}
	if (any && (!nt_grow((void **)&t.materials, &t.capacity, count, sizeof *t.materials) ||
			   !nt_grow((void **)&t.made, &t.made_capacity, count, sizeof *t.made)))
		status = NT_ERROR_MEMORY;
	for (size_t i = 0; i < count && any && !status; i++) {
		t.materials[i] = scene->materials[i];
		t.made[i] = (struct made){(uint32_t)i, NO_TILE};
	}
	for (size_t m = 0; m < scene->mesh_count && any && !status; m++)
		status = split_mesh(&t, &scene->meshes[m]);
	nt_material *made = any && !status ? nt_arena_alloc(&scene->arena, t.count, sizeof *made) : NULL;
	if (made) {
		for (size_t i = 0; i < count; i++)
			report_numbered(&t, i);
		for (size_t i = 0; i < count; i++)
			report_outside(&t, i);
		scene->materials = memcpy(made, t.materials, t.count * sizeof *made);
		scene->material_count = t.count;
	}
	free(t.templates);
	free(t.materials);
	free(t.made);
	free(t.primitives.items);
	nt_hash_index_free(&t.primitives.index);
	nt_hash_index_free(&t.index);
	return status || (any && !made) ? nt_fail_memory(error) : NT_OK;
}

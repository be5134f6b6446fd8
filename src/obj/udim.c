/* SPDX-License-Identifier: MIT */
/*
 * UDIM: an image for each tile of texture space, numbered 1001 + the tile along u (0 to 9) + 10 times the one along v.
 * A glTF texture has one image, so that a material whose maps have <UDIM> in their names becomes one for each tile that
 * faces lie in. Texture coordinates stay: images repeat. A name with a number alone is taken at its word; if faces in
 * several tiles show its image, that is a finding.
 */
#include "obj/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/name_table.h"

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

typedef struct tiler {
	nt_scene *scene;
	nt_error *error;
	const nt_material *templates; /* the materials as they were */
	size_t template_count;
	nt_material *materials;
	size_t count, capacity;
	nt_name_table numbers;    /* of pairs of template and tile */
	uint32_t *numbered;       /* [numbers.count] their materials */
	size_t numbered_capacity;
	uint16_t *first, *last;   /* [template_count] tiles of materials with a number in a name; NO_TILE: none yet */
	size_t *outside;          /* [template_count] faces that are in no tile */
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
	char *made = nt_arena_text(arena, name, strlen(name)), *to = made, number[8];
	snprintf(number, sizeof number, "%u", FIRST_TILE + tile);
	while (made && *name) {
		const bool here = strncmp(name, mark, sizeof mark - 1) == 0;
		const char *from = here ? number : name;
		const size_t length = here ? strlen(number) : 1;
		memcpy(to, from, length);
		to += length;
		name += here ? sizeof mark - 1 : 1;
	}
	if (made)
		*to = '\0';
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

/* The number of a pair in a table, which has it afterwards, with its own copy; UINT32_MAX: out of memory. */
static uint32_t number_of(nt_name_table *table, nt_arena *arena, uint32_t a, uint32_t b)
{
	const uint32_t key[2] = {a, b};
	const uint32_t known = nt_name_find(table, (const char *)key, sizeof key);
	if (known != UINT32_MAX)
		return known;
	uint32_t *copy = nt_arena_alloc(arena, 1, sizeof key);
	return copy ? nt_name_add(table, memcpy(copy, key, sizeof key), sizeof key) : UINT32_MAX;
}

/* The material of a template in a tile; NT_NONE: out of memory. The first of a template takes its place. */
static uint32_t material_of(tiler *t, uint32_t from, uint32_t tile)
{
	const size_t before = t->numbers.count;
	const uint32_t pair = number_of(&t->numbers, &t->scene->arena, from, tile);
	if (pair == UINT32_MAX || t->numbers.count == before)
		return pair == UINT32_MAX ? NT_NONE : t->numbered[pair];
	const bool first = find_map(&t->materials[from], true) != NULL;
	const size_t number = first ? from : t->count;
	if (!nt_grow((void **)&t->numbered, &t->numbered_capacity, t->numbers.count, sizeof *t->numbered) ||
		!nt_grow((void **)&t->materials, &t->capacity, number + 1, sizeof *t->materials) ||
		!make_material(t, &t->materials[number], &t->templates[from], tile))
		return NT_NONE;
	t->count += !first;
	return t->numbered[pair] = (uint32_t)number;
}

/* Which tiles a material with a number in a name has. */
static void note_tile(tiler *t, uint32_t material, uint32_t tile)
{
	if (t->first[material] == NO_TILE || tile < t->first[material])
		t->first[material] = (uint16_t)tile;
	if (t->last[material] == NO_TILE || tile > t->last[material])
		t->last[material] = (uint16_t)tile;
}

/* Each face goes to the primitive of its material and tile; primitives in the order of their first faces. */
static nt_status split_mesh(tiler *t, nt_mesh *mesh)
{
	bool any = false;
	for (size_t i = 0; i < mesh->primitive_count; i++) {
		const uint32_t material = mesh->primitives[i].material;
		any |= material != NT_NONE && (find_map(&t->templates[material], true) ||
			find_map(&t->templates[material], false));
	}
	if (!any || !mesh->texcoords)
		return NT_OK;
	nt_arena *arena = &t->scene->arena;
	nt_name_table primitives = {0};
	nt_primitive *list = NULL;
	size_t capacity = 0, corner = 0;
	uint32_t *const numbers = mesh->face_primitive ? mesh->face_primitive
		: nt_arena_alloc(arena, mesh->face_count, sizeof *numbers);
	bool done = numbers != NULL;
	for (size_t f = 0; done && f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		const uint32_t old = mesh->face_primitive ? numbers[f] : 0;
		uint32_t material = mesh->primitives[old].material, tile = NO_TILE;
		if (material != NT_NONE && find_map(&t->templates[material], true)) {
			tile = tile_of(mesh, corner, size, &t->outside[material]);
			material = material_of(t, material, tile);
			done = material != NT_NONE;
		} else if (material != NT_NONE && find_map(&t->templates[material], false)) {
			note_tile(t, material, tile_of(mesh, corner, size, &t->outside[material]));
		}
		const size_t before = primitives.count;
		numbers[f] = number_of(&primitives, arena, old, tile);
		done = done && numbers[f] != UINT32_MAX &&
			nt_grow((void **)&list, &capacity, primitives.count, sizeof *list);
		if (done && primitives.count > before)
			list[numbers[f]] =
				(nt_primitive){.material = material, .group = mesh->primitives[old].group};
		if (done)
			list[numbers[f]].face_count++;
		corner += size;
	}
	nt_primitive *made = done ? nt_arena_alloc(arena, primitives.count, sizeof *made) : NULL;
	if (made) {
		mesh->primitives = memcpy(made, list, primitives.count * sizeof *made);
		mesh->primitive_count = primitives.count;
		mesh->face_primitive = primitives.count > 1 ? numbers : NULL;
		done = obj_sort_groups(mesh);
	}
	nt_name_table_free(&primitives);
	free(list);
	return made && done ? NT_OK : nt_fail_memory(t->error);
}

static void report_outside(const tiler *t)
{
	for (size_t i = 0; i < t->template_count; i++) {
		const nt_material *m = &t->templates[i];
		const nt_map *map = find_map(m, true);
		if (!map || !t->outside[i])
			continue;
		const nt_place place = nt_line_place(m->library, map->line);
		nt_finding_add(&t->scene->findings, NT_CODE_MATERIAL_DOUBTFUL, &place, 1,
			"MTL: %.120s has no tile for %zu %s tile %d: u is not in 0 to %d, or v is below 0",
			map->name, t->outside[i], t->outside[i] == 1 ? "face, which shows" : "faces, which show",
			FIRST_TILE, TILES_ALONG_U);
	}
}

static void report_numbered(const tiler *t)
{
	for (size_t i = 0; i < t->template_count; i++) {
		const nt_material *m = &t->templates[i];
		const nt_map *map = find_map(m, false);
		if (!map || t->first[i] == t->last[i])
			continue;
		const nt_place place = nt_line_place(m->library, map->line);
		nt_finding_add(&t->scene->findings, NT_CODE_MATERIAL_DOUBTFUL, &place, 1,
			"MTL: %.120s is the image of one tile, and faces in the tiles %d to %d show it; for an image "
			"each, write <UDIM> in place of %.4s",
			map->name, FIRST_TILE + t->first[i], FIRST_TILE + t->last[i], find_number(map->name));
	}
}

nt_status obj_split_tiles(nt_scene *scene, nt_error *error)
{
	bool any = false;
	for (size_t i = 0; i < scene->material_count && !any; i++)
		any = find_map(&scene->materials[i], true) || find_map(&scene->materials[i], false);
	if (!any)
		return NT_OK;
	tiler t = {.scene = scene, .error = error, .templates = scene->materials,
		.template_count = scene->material_count, .count = scene->material_count};
	const size_t bytes = t.template_count * sizeof *t.first;
	t.first = malloc(bytes);
	t.last = malloc(bytes);
	t.outside = nt_calloc(t.template_count, sizeof *t.outside);
	nt_status status = NT_ERROR_MEMORY;
	if (t.first && t.last && t.outside &&
		nt_grow((void **)&t.materials, &t.capacity, t.count, sizeof *t.materials)) {
		status = NT_OK;
		memcpy(t.materials, t.templates, t.count * sizeof *t.materials);
		for (size_t i = 0; i < t.template_count; i++)
			t.first[i] = t.last[i] = NO_TILE;
	}
	for (size_t m = 0; m < scene->mesh_count && !status; m++)
		status = split_mesh(&t, &scene->meshes[m]);
	nt_material *made = status ? NULL : nt_arena_alloc(&scene->arena, t.count, sizeof *made);
	if (made) {
		report_numbered(&t);
		report_outside(&t);
		scene->materials = memcpy(made, t.materials, t.count * sizeof *made);
		scene->material_count = t.count;
	}
	nt_name_table_free(&t.numbers);
	free(t.materials);
	free(t.numbered);
	free(t.first);
	free(t.last);
	free(t.outside);
	return made ? NT_OK : status ? status : nt_fail_memory(error);
}

/* SPDX-License-Identifier: MIT */
/*
 * The statements between faces, in the order of the file: where meshes begin, which material, group and
 * smoothing group a stretch of faces has; then the materials themselves, and what was ignored.
 *
 * Groups (`g`) count where there is no `o`: 3ds Max and others write nothing else. All of them are one mesh, since
 * halves of a surface are often groups; a writer makes a mesh of each.
 *
 * Materials get their numbers by the first face that has them, and become part of the scene then;
 * those that no face has do not. A name that no library defines still becomes a material of that
 * name, so that its faces stay apart and can be given one later.
 */
#include "obj/parts.h"

#include <stdlib.h>
#include "base/hash_index.h"

/* Materials that no library defines are named one by one up to this many. */
enum { NAMED_UNKNOWN_MOST = 100 };

typedef struct state {
	obj_file *file;
	nt_error *error;
	nt_name_table names;     /* of materials that faces have, in order */

	/* State of the faces at this point. */
	const obj_event *object; /* NULL: none yet */
	size_t object_line;
	const obj_event *material;
	size_t material_line;
	nt_name_table groups;    /* in the order of use */
	uint32_t group;          /* 0: none, else its number there and 1 */
	bool has_objects;        /* then groups say nothing */
	uint32_t smoothing;
	bool object_is_new;      /* the next face begins a mesh */
	size_t face, corner;     /* where the stretch that is under way began */
} state;

/* ---- spans ---- */

/* The number of the current material; *number is NT_NONE where there is none. */
static bool number_material(state *s, uint32_t *number)
{
	*number = NT_NONE;
	if (!s->material || s->material->length == 0)
		return true;
	*number = nt_name_add(&s->names, s->material->text, s->material->length);
	return *number != UINT32_MAX;
}

/* The faces up to here have what was said before them. */
static bool end_stretch(state *s, size_t face, size_t corner)
{
	obj_file *file = s->file;
	if (face > s->face) {
		obj_span span = {.face = s->face, .corner = s->corner, .material_line = s->material_line,
			.group = s->group, .smoothing = s->smoothing, .begins_object = s->object_is_new,
			.object = s->object, .line = s->object_line};
		if (!number_material(s, &span.material) ||
			!nt_grow((void **)&file->spans, &file->span_capacity, file->span_count + 1, sizeof span))
			return false;
		file->spans[file->span_count++] = span;
		s->object_is_new = false;
	}
	s->face = face;
	s->corner = corner;
	return true;
}

static bool read_event(state *s, const obj_chunk *chunk, const obj_event *event)
{
	if (event->kind == OBJ_LIBRARY || (event->kind == OBJ_GROUP && s->has_objects))
		return true;
	if (!end_stretch(s, chunk->first_face + event->face, chunk->first_corner + event->corner))
		return false;
	const size_t line = chunk->first_line + event->line + 1;
	if (event->kind == OBJ_OBJECT) {
		s->object = event;
		s->object_line = line;
		s->object_is_new = true;
	} else if (event->kind == OBJ_MATERIAL) {
		s->material = event;
		s->material_line = line;
	} else if (event->kind == OBJ_GROUP) {
		s->group = event->length ? nt_name_add(&s->groups, event->text, event->length) + 1 : 0;
		return s->group || !event->length;
	} else {
		s->smoothing = event->group;
		s->file->uses_smoothing = true;
	}
	return true;
}

/* ---- groups ---- */

static nt_status name_groups(state *s)
{
	obj_file *file = s->file;
	file->groups = nt_arena_alloc(&file->scene->arena, s->groups.count + 1, sizeof *file->groups);
	if (!file->groups)
		return nt_fail_memory(s->error);
	file->groups[file->group_count++] = "";
	for (size_t i = 0; i < s->groups.count; i++) {
		const nt_name *name = &s->groups.names[i];
		file->groups[file->group_count] = obj_utf8_text(&file->scene->arena, name->text, name->length);
		if (!file->groups[file->group_count++])
			return nt_fail_memory(s->error);
	}
	return NT_OK;
}

/* ---- materials ---- */

/* Reads every library once. */
static nt_status read_libraries(state *s, const nt_read_options *options, nt_mtl *mtl)
{
	obj_file *file = s->file;
	nt_name_table seen = {0};
	nt_status status = NT_OK;
	for (size_t c = 0; c < file->chunk_count && !status; c++) {
		const obj_chunk *chunk = &file->chunks[c];
		for (size_t i = 0; i < chunk->event_count && !status; i++) {
			const obj_event *event = &chunk->events[i];
			const size_t before = seen.count;
			if (event->kind != OBJ_LIBRARY)
				continue;
			if (nt_name_add(&seen, event->text, event->length) == UINT32_MAX)
				status = nt_fail_memory(s->error);
			else if (seen.count > before)
				status = nt_mtl_read(file->scene, event->text, event->length,
					chunk->first_line + event->line + 1, options, mtl, s->error);
		}
	}
	nt_name_table_free(&seen);
	return status;
}

/* Gives a material of the scene its definition; the first one counts. */
static void define(nt_scene *scene, uint32_t number, const nt_mtl_definition *d)
{
	nt_material *material = &scene->materials[number];
	const nt_place place = nt_line_place(d->material.library, d->material.line);
	if (material->library) {
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"MTL: newmtl of a name that was defined before: %.*s", NT_CUT(120, d->material.name));
		return;
	}
	*material = d->material;
}

/* Libraries of which no usemtl takes anything: all faces get the first material, as obj2gltf does. */
static nt_status take_first(obj_file *file, const nt_mtl *mtl, nt_error *error)
{
	nt_scene *scene = file->scene;
	scene->materials = nt_arena_alloc(&scene->arena, 1, sizeof *scene->materials);
	if (!scene->materials)
		return nt_fail_memory(error);
	scene->material_count = 1;
	*scene->materials = mtl->definitions[0].material;
	for (size_t i = 0; i < file->span_count; i++)
		file->spans[i].material = 0;
	const nt_place place = nt_line_place(scene->materials->library, scene->materials->line);
	nt_finding_add(&scene->findings, NT_CODE_MATERIAL_FIRST, &place, 1, "%.*s, the first of %zu",
		NT_CUT(120, scene->materials->name), mtl->count);
	return NT_OK;
}

static nt_status make_materials(state *s, const nt_mtl *mtl)
{
	nt_scene *scene = s->file->scene;
	if (!s->names.count && mtl->count)
		return take_first(s->file, mtl, s->error);
	scene->materials = nt_arena_alloc(&scene->arena, s->names.count, sizeof *scene->materials);
	if (!scene->materials)
		return nt_fail_memory(s->error);
	for (size_t i = 0; i < s->names.count; i++) {
		const nt_name *name = &s->names.names[i];
		scene->materials[i] =
			nt_material_default(obj_utf8_text(&scene->arena, name->text, name->length));
		if (!scene->materials[i].name)
			return nt_fail_memory(s->error);
	}
	scene->material_count = s->names.count;
	for (size_t i = 0; i < mtl->count; i++) {
		const nt_mtl_definition *d = &mtl->definitions[i];
		const uint32_t number = nt_name_find(&s->names, d->raw_name, d->raw_length);
		if (number != UINT32_MAX)
			define(scene, number, d);
	}
	/* A missing library is reported already, and explains the unknown names. */
	uint32_t next = 0, unknown = 0;
	for (const obj_span *span = s->file->spans; next < s->names.count && !mtl->incomplete; span++) {
		if (span->material != next)
			continue;
		const nt_material *material = &scene->materials[next++];
		const nt_place place = nt_line_place(scene->path, span->material_line);
		if (material->library)
			continue;
		const char *name = unknown++ < NAMED_UNKNOWN_MOST ? material->name : "and others";
		nt_finding_add(&scene->findings, NT_CODE_MATERIAL_UNKNOWN, &place, 1, "%.*s", NT_CUT(200, name));
	}
	return NT_OK;
}

/* ---- meshes ---- */

/* How a material's normal map is mirrored, as bits for u and v: tangents follow it as it is sampled. */
static unsigned mirrored_axes(const nt_scene *scene, uint32_t material)
{
	const nt_map *map = material == NT_NONE ? NULL : &scene->materials[material].normal_map;
	return !map || !map->name || !map->placement.moved ? 0
		: (map->placement.scale[0] < 0 ? 1u : 0) | (map->placement.scale[1] < 0 ? 2u : 0);
}

/* One mesh for each object that has faces. A mesh has one sign, so that another one begins where the mirroring changes.
 * Tangents have nothing in common there: they point the opposite way along u, or have the other w. */
static nt_status make_meshes(obj_file *file, nt_error *error)
{
	file->meshes = nt_alloc(file->span_count + 1, sizeof *file->meshes);
	if (!file->meshes)
		return nt_fail_memory(error);
	for (const obj_span *span = file->spans; span < file->spans + file->span_count; span++)
		if (span->begins_object ||
			mirrored_axes(file->scene, span->material) != mirrored_axes(file->scene, span[-1].material))
			file->meshes[file->mesh_count++] =
				(obj_mesh){span->object, span->line, span->face, span->corner, 0};
	file->meshes[file->mesh_count] = (obj_mesh){.face = file->face_count, .corner = file->corner_count};
	return NT_OK;
}

/* ---- what was ignored ---- */

/* The first chunk that has a statement of that kind, NULL for none. */
static const obj_chunk *count_ignored(const obj_file *file, size_t which, obj_count *all)
{
	return obj_count_all(file, offsetof(obj_chunk, ignored) + which * sizeof *all, all);
}

static void report_ignored(const obj_file *file)
{
	nt_scene *scene = file->scene;
	for (size_t which = 0; which < OBJ_WORD_COUNT; which++) {
		obj_count all;
		const obj_chunk *first = count_ignored(file, which, &all);
		const obj_keyword *keyword = &obj_keywords[which];
		if (!first)
			continue;
		const nt_place place = nt_line_place(scene->path, all.line);
		if (keyword->left_out)
			nt_scene_leave_out(scene, all.line, all.count, "%s (%zu)", keyword->left_out, all.count);
		else if (which == OBJ_UNKNOWN)
			nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, all.count,
				"OBJ: %s, the first is %.*s", keyword->word,
				NT_CUT_OF(64, first->unknown_length, first->unknown));
		else
			nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, all.count, "OBJ: %s",
				keyword->word);
	}
}

/* A file without faces has nothing to put tangents on: points and lines are sound, nothing at all is no OBJ. */
static nt_status fail_empty(const obj_file *file, nt_error *error)
{
	obj_count all;
	const obj_chunk *small = count_ignored(file, OBJ_SMALL_FACE, &all);
	if (small)
		return nt_fail_line(error, NT_ERROR_INPUT, all.line,
			"found a face of %zu corners and no larger one in the file, expected at least 3",
			small->small_size);
	return nt_fail(error, file->row_counts[OBJ_V] ? NT_ERROR_UNSUPPORTED : NT_ERROR_INPUT,
		"found no faces, expected a mesh");
}

nt_status obj_read_events(obj_file *file, const nt_read_options *options, nt_error *error)
{
	state s = {.file = file, .error = error, .object_is_new = true};
	nt_mtl mtl = {0};
	if (file->face_count == 0)
		return fail_empty(file, error);
	bool read = true;
	for (size_t c = 0; c < file->chunk_count && !s.has_objects; c++)
		for (size_t i = 0; i < file->chunks[c].event_count && !s.has_objects; i++)
			s.has_objects = file->chunks[c].events[i].kind == OBJ_OBJECT;
	for (size_t c = 0; c < file->chunk_count; c++)
		for (size_t i = 0; i < file->chunks[c].event_count && read; i++)
			read = read_event(&s, &file->chunks[c], &file->chunks[c].events[i]);
	read = read && end_stretch(&s, file->face_count, file->corner_count);
	nt_status status = read ? NT_OK : nt_fail_memory(error);
	if (!status)
		status = read_libraries(&s, options, &mtl);
	if (!status)
		status = make_materials(&s, &mtl);
	if (!status)
		status = name_groups(&s);
	if (!status)
		status = make_meshes(file, error);
	if (!status)
		report_ignored(file);
	nt_mtl_free(&mtl);
	nt_name_table_free(&s.names);
	nt_name_table_free(&s.groups);
	return status;
}

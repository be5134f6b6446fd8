/* SPDX-License-Identifier: MIT */
/*
 * glTF and GLB as a scene: every primitive is a mesh of its own, since glTF defines tangents per
 * primitive. Opening describes the meshes from the JSON alone; load.c brings the geometry of one.
 *
 * Opening looks at meshes, their materials and who shows them. It checks that the files of all buffers are there, and
 * makes one buffer of those that are one file. A load tells what is wrong with the accessors of its primitive; but a
 * TANGENT that cannot be read is noted here. Cameras, skins and animations are counted for what writers leave out, and
 * no more.
 */
#include "gltf/load.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "base/text.h"
#include "file/input.h"
#include "file/path.h"
#include "gltf/document.h"

/* How many elements an accessor claims; where that cannot be said, enough for a triangle, so that loading
 * meets the fault and says it. */
static uint64_t claimed_count(const nt_gltf *document, const nt_json_value *reference)
{
	uint64_t index, count = 3;
	if (nt_json_get_uint64(reference, &index) && index < UINT32_MAX)
		nt_json_find_uint64(nt_gltf_accessor_json(document, index), "count", &count);
	return count;
}

/* Morph targets that move positions or normals, and those of them that leave tangents as they are. */
static void count_targets(const nt_json_value *primitive, nt_mesh *mesh)
{
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	mesh->moving_targets = mesh->targets_without_tangents = 0;
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		const nt_json_value *target = nt_json_at(targets, i);
		if (!nt_json_find(target, "POSITION") && !nt_json_find(target, "NORMAL"))
			continue;
		mesh->moving_targets++;
		mesh->targets_without_tangents += !nt_json_find(target, "TANGENT");
	}
}

/* Whether an edit needs nothing of a primitive with indices but its tangents, once it is solved: the indices form whole
 * triangles (others stay as they are), it has normals, no block of Draco and no targets, and no texture transform has
 * to be looked at. */
static bool is_disposable(const nt_json_value *primitive, const nt_mesh *mesh, uint64_t mode, uint64_t corners)
{
	return mode == NT_GLTF_TRIANGLES && corners % 3 == 0 && mesh->has_normals &&
		!mesh->texcoords_transformed && !nt_json_find(primitive, "targets") && !mesh->compressed;
}

/* Whether there are tangents, and whether they can be read. If not, nobody stops for what a solve may replace. */
static nt_status describe_tangents(nt_scene *scene, nt_gltf *document, const nt_json_value *attributes,
	uint64_t position_count, nt_mesh *mesh, nt_error *out_of_memory)
{
	const nt_json_value *reference = nt_json_find(attributes, "TANGENT");
	mesh->has_tangents = reference != NULL;
	if (!reference)
		return NT_OK;
	uint64_t index = UINT64_MAX;
	const nt_gltf_accessor *accessor;
	nt_error error;
	if (nt_gltf_read_arrays(document, out_of_memory))
		return NT_ERROR_MEMORY;
	nt_error_clear(&error);
	nt_json_get_uint64(reference, &index);
	if (index >= UINT32_MAX)
		nt_fail(&error, NT_ERROR_INPUT, "%s, expected an accessor's number", nt_json_type_text(reference));
	else if (!nt_gltf_get_accessor(document, index, "", &accessor, &error) && accessor->components != 4)
		nt_fail(&error, NT_ERROR_INPUT, "accessor %u has %u components, expected 4", accessor->index,
			accessor->components);
	else if (!error.status && accessor->count != position_count)
		nt_fail(&error, NT_ERROR_INPUT, "accessor %u has %llu elements, POSITION has %llu", accessor->index,
			(unsigned long long)accessor->count, (unsigned long long)position_count);
	mesh->tangents_fault = error.status ? nt_arena_text(&scene->arena, error.message, strlen(error.message)) : NULL;
	return error.status && !mesh->tangents_fault ? nt_fail_memory(out_of_memory) : NT_OK;
}

static nt_status describe_primitive(nt_scene *scene, nt_gltf *document,
	const nt_json_value *primitive, nt_mesh *mesh, const nt_read_options *options, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	nt_gltf_mesh_pointer(pointer, mesh);
	if (nt_json_type_of(primitive) != NT_JSON_OBJECT)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "%s, expected an object",
			nt_json_type_text(primitive));
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	if (attributes && nt_json_type_of(attributes) != NT_JSON_OBJECT)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"\"attributes\" is %s, expected an object", nt_json_type_text(attributes));
	/* a mode that glTF lacks is explained by an extension (EXT_primitive_voxels), and is none of triangles */
	enum { LAST_MODE = 6 };
	const bool explained = nt_json_count(nt_json_find(primitive, "extensions")) > 0;
	uint64_t mode;
	nt_status status = nt_gltf_uint(primitive, pointer, "mode", explained ? UINT32_MAX : LAST_MODE,
		NT_GLTF_TRIANGLES, &mode, error);
	if (!status)
		status = nt_gltf_describe_materials(scene, mesh, primitive, pointer, options, error);
	if (status)
		return status;
	mesh->triangles = mode >= NT_GLTF_TRIANGLES && mode <= LAST_MODE;
	const nt_json_value *positions = nt_json_find(attributes, "POSITION"),
		*indices = nt_json_find(primitive, "indices");
	const uint64_t corners = positions ? claimed_count(document, indices ? indices : positions) : 0;
	mesh->has_positions = positions != NULL;
	mesh->has_normals = nt_json_find(attributes, "NORMAL") != NULL;
	status = describe_tangents(scene, document, attributes,
			positions ? claimed_count(document, positions) : 0, mesh, error);
	if (status)
		return status;
	mesh->compressed = nt_gltf_draco_of(primitive) != NULL;
	mesh->has_polygons = mode == NT_GLTF_TRIANGLES && !mesh->compressed &&
		nt_json_find(nt_json_find(primitive, "extensions"), "FB_ngon_encoding");
	count_targets(primitive, mesh);
	/* to tell empty primitives; loading counts again */
	mesh->face_count = corners < 3 ? 0 : (size_t)(mode == NT_GLTF_TRIANGLES ? corners / 3 : corners - 2);
	mesh->plan.disposable = indices && is_disposable(primitive, mesh, mode, corners);
	mesh->primitive_count = 1;
	mesh->primitives = nt_arena_alloc(&scene->arena, 1, sizeof *mesh->primitives);
	if (!mesh->primitives)
		return nt_fail_memory(error);
	mesh->primitives[0] = (nt_primitive){.material = NT_NONE, .face_count = mesh->face_count};
	return NT_OK;
}

/* The meshes of the document. */
typedef struct placing {
	nt_scene *scene;
	uint32_t *first; /* [mesh_count + 1] the first primitive of each in scene->meshes */
	size_t mesh_count;
	size_t capacity; /* of scene->instances */
	nt_error *error;
} placing;

static nt_status count_primitives(placing *all, const nt_gltf *document)
{
	nt_scene *scene = all->scene;
	const nt_json_value *meshes = nt_gltf_root_member(document, "meshes");
	if (meshes && nt_json_type_of(meshes) != NT_JSON_ARRAY)
		return nt_fail_pointer(all->error, NT_ERROR_INPUT, "/meshes", "%s, expected an array",
			nt_json_type_text(meshes));
	all->mesh_count = nt_json_count(meshes);
	all->first = nt_arena_alloc(&scene->arena, all->mesh_count + 1, sizeof *all->first);
	if (!all->first)
		return nt_fail_memory(all->error);
	all->first[0] = 0;
	for (size_t i = 0; i < all->mesh_count; i++) {
		const nt_json_value *primitives = nt_json_find(nt_json_at(meshes, i), "primitives");
		if (nt_json_type_of(primitives) != NT_JSON_ARRAY) {
			char pointer[NT_GLTF_POINTER];
			nt_gltf_pointer(pointer, "meshes", i);
			return nt_fail_pointer(all->error, NT_ERROR_INPUT, pointer,
				"\"primitives\" is %s, expected an array", nt_json_type_text(primitives));
		}
		all->first[i + 1] = all->first[i] + (uint32_t)nt_json_count(primitives);
	}
	scene->meshes = nt_arena_alloc(&scene->arena, all->first[all->mesh_count], sizeof *scene->meshes);
	scene->mesh_count = scene->meshes ? all->first[all->mesh_count] : 0;
	return scene->meshes ? NT_OK : nt_fail_memory(all->error);
}

static nt_status describe_meshes(const placing *all, nt_gltf *document, const nt_read_options *options)
{
	nt_scene *scene = all->scene;
	nt_mesh *mesh = scene->meshes;
	for (size_t i = 0; i < all->mesh_count; i++) {
		const nt_json_value *json = nt_json_at(nt_gltf_root_member(document, "meshes"), i);
		const nt_json_value *primitives = nt_json_find(json, "primitives");
		size_t length = 0;
		const char *name = nt_json_find_string(json, "name", &length);
		name = nt_arena_text(&scene->arena, name ? name : "", name ? length : 0);
		if (!name)
			return nt_fail_memory(all->error);
		for (size_t k = 0; k < nt_json_count(primitives); k++, mesh++) {
			memset(mesh, 0, sizeof *mesh);
			mesh->name = name;
			mesh->gltf_mesh = (uint32_t)i;
			mesh->gltf_primitive = (uint32_t)k;
			mesh->has_siblings = nt_json_count(primitives) > 1;
			const nt_status status = describe_primitive(scene, document,
				nt_json_at(primitives, k), mesh, options, all->error);
			if (status)
				return status;
		}
	}
	return NT_OK;
}

static nt_status mark_shown(void *context, uint64_t mesh, const double matrix[16])
{
	const placing *all = context;
	(void)matrix;
	if (mesh < all->mesh_count)
		for (uint32_t i = all->first[mesh]; i < all->first[mesh + 1]; i++)
			all->scene->meshes[i].reachable = true;
	return NT_OK;
}

static nt_status place_mesh(void *context, uint64_t mesh, const double matrix[16])
{
	placing *world = context;
	if (mesh >= world->mesh_count)
		return NT_OK;
	nt_scene *scene = world->scene;
	for (uint32_t i = world->first[mesh]; i < world->first[mesh + 1]; i++) {
		if (scene->instance_count == world->capacity) {
			const size_t wanted = world->capacity ? world->capacity * 2 : 16;
			nt_instance *grown = nt_arena_alloc(&scene->arena, wanted, sizeof *grown);
			if (!grown)
				return nt_fail_memory(world->error);
			if (scene->instance_count)
				memcpy(grown, scene->instances, scene->instance_count * sizeof *grown);
			scene->instances = grown;
			world->capacity = wanted;
		}
		nt_instance *instance = &scene->instances[scene->instance_count++];
		instance->mesh = i;
		memcpy(instance->matrix, matrix, sizeof instance->matrix);
	}
	return NT_OK;
}

/* Whether the file of a buffer can be opened; a name that is refused is nobody's file. *info: the file, st_nlink 0 if
 * there is none. */
static nt_status look_for_file(nt_gltf *document, size_t index, struct stat *info, bool *missing, nt_error *failure)
{
	size_t length = 0;
	const nt_json_value *json = nt_json_at(nt_gltf_root_member(document, "buffers"), index);
	const char *uri = nt_json_find_string(json, "uri", &length), *path;
	*missing = false;
	info->st_nlink = 0;
	if (!uri || nt_uri_is_data(uri, length))
		return NT_OK;
	nt_status status = nt_gltf_resolve(document, uri, length, &path, failure);
	if (!status && document->allow_outside)
		status = nt_lookup(path, info, failure);
	if (!status && (access(path, R_OK) != 0 || stat(path, info) != 0))
		status = nt_fail(failure, NT_ERROR_IO, "cannot open \"%.*s\": %s", NT_CUT(120, uri), strerror(errno));
	*missing = status == NT_ERROR_MISSING || status == NT_ERROR_IO;
	if (status)
		info->st_nlink = 0;
	return status == NT_ERROR_MEMORY ? status : NT_OK;
}

/* Gives what refers to a buffer the buffer's new number. */
static void renumber(nt_gltf *document, nt_json_value *object, const uint32_t *numbers, size_t count)
{
	uint64_t buffer;
	nt_json_value *reference = nt_json_find(object, "buffer");
	if (nt_json_get_uint64(reference, &buffer) && buffer < count)
		nt_json_set_uint64(document->json, reference, numbers[buffer]);
}

/* Lets a buffer stand for another one of its file: the longer length counts that the file has, but for padding that may
 * be missing. */
static void stand_for(nt_gltf *document, nt_json_value *buffer, const nt_json_value *other, const struct stat *file)
{
	uint64_t old, new;
	size_t text;
	const char *uri = nt_json_find_string(other, "uri", &text), *path;
	const uint64_t most = (uint64_t)file->st_size + 3;
	nt_json_value *length = nt_json_find(buffer, "byteLength");
	if (nt_json_get_uint64(length, &old) && nt_json_find_uint64(other, "byteLength", &new) && new <= most &&
		(new > old || old > most))
		nt_json_set_uint64(document->json, length, new);
	if (nt_gltf_resolve(document, uri, text, &path, NULL) == NT_OK)
		nt_trace_note(NT_TRACE_READ, path, NULL, file);
}

/* Whether an extension may hold the number of a buffer: a vendor's one. KHR_ and EXT_ ones do in views alone. */
static bool may_refer(const nt_gltf *document)
{
	const nt_json_value *used = nt_gltf_root_member(document, "extensionsUsed");
	bool may = false;
	for (size_t i = 0; !may && i < nt_json_count(used); i++) {
		const char *name = nt_json_get_string(nt_json_at(used, i), NULL);
		may = !name || (strncmp(name, "KHR_", 4) != 0 && strncmp(name, "EXT_", 4) != 0);
	}
	return may;
}

/* Makes one buffer of those that name one file, by whatever name: each would be opened, and once it is edited,
 * written. Views refer to buffers, and extensions of theirs do; if others may, all stay. files: [buffer_count], which
 * become those of the buffers that are left. */
static nt_status merge_buffers(nt_gltf *document, struct stat *files, nt_error *error)
{
	const size_t count = document->buffer_count;
	nt_json *json = document->json;
	nt_json_value *buffers = nt_gltf_root_member(document, "buffers");
	nt_json_value *views = nt_gltf_root_member(document, "bufferViews");
	nt_hash_index known = {0};
	uint32_t kept = 0, *numbers = nt_alloc(count, sizeof *numbers);
	bool failed = !numbers, stays = false;
	for (size_t i = 0; i < count && !failed && !stays; i++) {
		const nt_file_id id = nt_file_id_of(&files[i]);
		const uint64_t hash = nt_hash_bytes(0, &id, sizeof id);
		size_t at = NT_HASH_BEGIN;
		/* a name, extras or an extension of its own would be lost */
		const bool plain = files[i].st_nlink && nt_json_count(nt_json_at(buffers, i)) == 2;
		uint32_t first = plain ? nt_hash_index_next(&known, hash, &at) : UINT32_MAX;
		while (first != UINT32_MAX && !nt_same_file(&files[first], &files[i]))
			first = nt_hash_index_next(&known, hash, &at);
		stays = first != UINT32_MAX && kept == i && may_refer(document);
		if (first != UINT32_MAX && !stays) {
			stand_for(document, nt_json_at(buffers, first), nt_json_at(buffers, i), &files[i]);
			numbers[i] = first;
			continue;
		}
		if (kept < i)
			nt_json_set_copy(json, nt_json_at(buffers, kept), nt_json_at(buffers, i));
		files[kept] = files[i];
		document->buffers[kept].number = i;
		failed = files[i].st_nlink && !nt_hash_index_add(&known, hash, kept);
		numbers[i] = kept++;
	}
	kept = stays ? (uint32_t)count : kept;
	for (size_t i = count; i-- > kept && !failed;)
		nt_json_remove_at(json, buffers, i);
	for (size_t i = 0; i < nt_json_count(views) && kept < count && !failed; i++) {
		nt_json_value *view = nt_json_at(views, i), *extensions = nt_json_find(view, "extensions");
		renumber(document, view, numbers, count);
		for (size_t k = 0; k < nt_json_count(extensions); k++)
			renumber(document, nt_json_at(extensions, k), numbers, count);
	}
	if (!failed)
		document->buffer_count = kept;
	free(numbers);
	nt_hash_index_free(&known);
	return failed || nt_json_failed(json) ? nt_fail_memory(error) : NT_OK;
}

/* Refuses a document without all of its files, whether a run needs them or not: its output would be as broken. The
 * fallback of EXT_meshopt_compression has no URI. An output that is read back names what its source names, which may
 * be files that nobody needs and that nobody looked for. */
static nt_status look_for_buffers(nt_scene *scene, nt_gltf *document, nt_error *error)
{
	enum { NAMED = 3 };
	size_t count = 0;
	nt_place first = {.offset = NT_NO_OFFSET};
	nt_buffer names = {0};
	nt_status status = NT_OK;
	struct stat *files = nt_alloc(document->buffer_count, sizeof *files);
	if (!files)
		return nt_fail_memory(error);
	for (size_t i = 0; i < document->buffer_count && !status; i++) {
		nt_error failure;
		bool missing;
		nt_place place;
		status = look_for_file(document, i, &files[i], &missing, &failure);
		if (status || !missing)
			continue;
		nt_place_clear(&place);
		snprintf(place.pointer, sizeof place.pointer, "/buffers/%zu", i);
		nt_finding_add(&scene->findings, NT_CODE_BUFFER_MISSING, &place, 1, "%.*s",
			NT_CUT(240, failure.message));
		const nt_json_value *json = nt_json_at(nt_gltf_root_member(document, "buffers"), i);
		first = count ? first : place;
		if (count++ < NAMED)
			nt_buffer_format(&names, "%s\"%.*s\"", count > 1 ? ", " : "",
				NT_CUT(80, nt_json_find_string(json, "uri", NULL)));
	}
	if (status || names.failed)
		status = nt_fail_memory(error);
	else if (count)
		status = nt_fail(error, NT_ERROR_MISSING, "%s cannot be opened: %s%s",
			count == 1 ? "a buffer" : "buffers", names.data, count > NAMED ? " and others" : "");
	if (count && status == NT_ERROR_MISSING)
		error->place = first;
	nt_buffer_free(&names);
	if (!status && document->buffer_count > 1)
		status = merge_buffers(document, files, error);
	free(files);
	return status;
}

/* Attributes that a PLY has no place for; of sets of texture coordinates all but the one that is used. */
static void count_left_attributes(const nt_json_value *attributes, uint32_t used, size_t *sets, size_t *others)
{
	char name[32];
	nt_gltf_put_number(nt_gltf_put_text(name, "TEXCOORD_"), used);
	const char *const kept[] = {name, "POSITION", "NORMAL", "TANGENT", "COLOR_0"};
	for (size_t i = 0; i < nt_json_count(attributes); i++) {
		size_t length, k = 0;
		const char *key = nt_json_key(attributes, i, &length);
		while (k < 5 && (length != strlen(kept[k]) || memcmp(key, kept[k], length) != 0))
			k++;
		if (k == 5)
			++*(length > 9 && memcmp(key, "TEXCOORD_", 9) == 0 ? sets : others);
	}
}

static size_t count_extras(const nt_gltf *document, const char *array)
{
	size_t count = 0;
	const nt_json_value *items = nt_gltf_root_member(document, array);
	for (size_t i = 0; i < nt_json_count(items); i++)
		count += nt_json_find(nt_json_at(items, i), "extras") != NULL;
	return count;
}

/* Lists what one mesh in the world has no place for; the writer says so. */
static void list_left_out(nt_scene *scene, const nt_gltf *document)
{
	size_t targets = 0, sets = 0, others = 0, unshown = 0, drawn = 0;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
		targets += nt_json_count(nt_json_find(primitive, "targets"));
		count_left_attributes(nt_json_find(primitive, "attributes"), mesh->texcoord_set, &sets, &others);
		drawn += !mesh->triangles;
		unshown += mesh->triangles && !mesh->reachable;
	}
	const nt_json_value *lights = nt_json_find(nt_gltf_root_member(document, "extensions"), "KHR_lights_punctual");
	const struct {
		const char *what;
		size_t count;
	} parts[] = {
		{"materials", nt_json_count(nt_gltf_root_member(document, "materials"))},
		{"primitives of points or lines", drawn},
		{"primitives that no scene shows", unshown},
		{"further sets of texture coordinates", sets},
		{"other attributes", others},
		{"morph targets", targets},
		{"skins", nt_json_count(nt_gltf_root_member(document, "skins"))},
		{"animations", nt_json_count(nt_gltf_root_member(document, "animations"))},
		{"cameras", nt_json_count(nt_gltf_root_member(document, "cameras"))},
		{"lights", nt_json_count(nt_json_find(lights, "lights"))},
		{"extras", count_extras(document, "nodes") + count_extras(document, "meshes") +
			count_extras(document, "materials")},
	};
	scene->left_out_textures = nt_json_count(nt_gltf_root_member(document, "textures"));
	for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
		if (parts[i].count)
			nt_scene_leave_out(scene, 0, parts[i].count, "%s (%zu)", parts[i].what, parts[i].count);
}

static uint64_t count_read(const void *source)
{
	return nt_gltf_bytes_read(source);
}

nt_status nt_gltf_open(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	nt_gltf *document;
	nt_status status = nt_gltf_create(&document, scene, options->outside == NT_OUTSIDE_YES, error);
	if (status)
		return status;
	document->keeps_transforms = options->transform == NT_TRANSFORM_KEEP;
	scene->source = document;
	scene->free_source = nt_gltf_free;
	scene->read_of_source = count_read;
	scene->format = document->is_glb ? NT_FORMAT_GLB : NT_FORMAT_GLTF;
	const char *generator =
		nt_json_find_string(nt_gltf_root_member(document, "asset"), "generator", NULL);
	scene->solves_quads = generator && strstr(generator, "Blender");
	if (scene->file) /* the JSON has a copy of its text */
		nt_file_release(scene->file, document->glb.json.offset, document->is_glb ?
			document->glb.json.size : scene->byte_count);

	/* The meshes, and which of them a scene shows: all, if there is none. */
	placing all = {.scene = scene, .error = error};
	status = count_primitives(&all, document);
	if (!status && !scene->written)
		status = look_for_buffers(scene, document, error);
	if (!status)
		status = nt_gltf_separate_draco(document, error);
	if (!status)
		status = describe_meshes(&all, document, options);
	const bool has_scenes = nt_gltf_root_member(document, "scenes") != NULL;
	for (size_t i = 0; !status && !has_scenes && i < scene->mesh_count; i++)
		scene->meshes[i].reachable = true;
	if (!status && has_scenes)
		status = nt_gltf_walk(document, false, mark_shown, &all, error);

	/* Their places, if the output is one mesh in the world, and for a report, which shows lengths there. */
	if (!status && (options->world || options->report))
		status = nt_gltf_walk(document, true, place_mesh, &all, error);
	if (!status && options->world)
		list_left_out(scene, document);
	return status;
}

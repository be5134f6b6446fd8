/* SPDX-License-Identifier: MIT */
/*
 * Primitives with the same geometry, so that it is loaded and solved once.
 *
 * Everything that load() reads of a primitive is written down as numbers: the accessors of what a solve
 * takes, with accessors over the same bytes counted as one, the mode, the compressed block and the
 * texture transform. Primitives with equal numbers have equal geometry; a table of keys finds them in linear
 * time. Primitives that are not known to be equal count as different.
 */

#include <stdio.h>
#include <stdlib.h>
#include "base/buffer.h"
#include "base/name_table.h"
#include "gltf/materials.h"
#include "gltf/pointer.h"
#include "gltf/vertex_pools.h"

/* Numbers that are no accessors. */
#define MISSING UINT64_MAX
#define FAULTY (UINT64_MAX - 1) /* loading will say why; it is like nothing else */

typedef struct same_job {
	const nt_scene *scene;
	nt_gltf *document;
	const nt_read_options *options;
	nt_buffer key;       /* of the mesh at hand */
} same_job;

/* Whether the mesh is going to be loaded: to be solved, or only to be checked, or for others. */
static bool is_wanted(const nt_mesh *mesh, const nt_read_options *options)
{
	return nt_mesh_is_wanted(mesh) ||
		((options->report || options->across) && mesh->triangles && mesh->has_positions);
}

/* ---- keys ---- */

static void put_number(same_job *job, uint64_t number)
{
	nt_buffer_append(&job->key, &number, sizeof number);
}

/* The accessor that a member names; a faulty one is followed by the mesh's own number. */
static void put_accessor(same_job *job, const nt_mesh *mesh, const nt_json_value *object, const char *name)
{
	const nt_json_value *reference = nt_json_find(object, name);
	const uint32_t accessor = nt_gltf_reference(job->document, object, name);
	if (!reference) {
		put_number(job, MISSING);
	} else if (accessor != NT_NONE) {
		put_number(job, nt_gltf_same(job->document, accessor));
	} else {
		put_number(job, FAULTY);
		put_number(job, (uint64_t)(mesh - job->scene->meshes));
	}
}

/* The compressed block, and which of its attributes an attribute is. */
static void put_draco(same_job *job, const nt_json_value *primitive, const char *const *names, size_t count)
{
	const nt_json_value *extension = nt_json_find(nt_json_find(primitive, "extensions"),
		"KHR_draco_mesh_compression");
	const nt_json_value *ids = nt_json_find(extension, "attributes");
	uint64_t number = MISSING;
	nt_json_get_uint64(nt_json_find(extension, "bufferView"), &number);
	put_number(job, number);
	for (size_t i = 0; extension && i < count; i++) {
		number = MISSING;
		nt_json_get_uint64(nt_json_find(ids, names[i]), &number);
		put_number(job, number);
	}
}

static nt_status put_transform(same_job *job, const nt_mesh *mesh, const nt_json_value *primitive, nt_error *error)
{
	nt_gltf_shading shading = {.has_set = false};
	const nt_status status = !mesh->texcoords_transformed ? NT_OK : nt_gltf_find_slots(job->document, primitive,
		nt_gltf_of_mesh(mesh).pointer, &shading, error);
	const nt_gltf_transform *t = &shading.transform;
	const bool applies = nt_gltf_turns(&shading, mesh->texcoord_set);
	put_number(job, applies);
	if (applies) {
		nt_buffer_append(&job->key, &t->uv.rotation, sizeof t->uv.rotation);
		nt_buffer_append(&job->key, t->uv.scale, sizeof t->uv.scale);
	}
	return status;
}

static nt_status put_key(same_job *job, const nt_mesh *mesh, nt_error *error)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(job->document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	char texcoords[32];
	snprintf(texcoords, sizeof texcoords, "TEXCOORD_%u", mesh->texcoord_set);
	const char *const names[] = {"POSITION", "NORMAL", texcoords, "TANGENT", "COLOR_0"};
	const size_t count = sizeof names / sizeof *names - !job->options->world;
	uint64_t mode = 4;
	nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
	put_number(job, mesh->decision);
	put_number(job, mesh->keeps_inverted);
	put_number(job, mode);
	put_number(job, mesh->has_polygons);
	for (size_t i = 0; i < count; i++)
		put_accessor(job, mesh, attributes, names[i]);
	put_accessor(job, mesh, primitive, "indices");
	put_draco(job, primitive, names, count);
	const nt_status status = put_transform(job, mesh, primitive, error);
	if (status)
		return status;
	const bool bakes = !job->options->world && job->options->morphs == NT_MORPH_BAKE;
	const nt_json_value *targets = bakes ? nt_json_find(primitive, "targets") : NULL;
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		put_accessor(job, mesh, nt_json_at(targets, i), "POSITION");
		put_accessor(job, mesh, nt_json_at(targets, i), "NORMAL");
	}
	return job->key.failed ? nt_fail_memory(error) : NT_OK;
}

/* ---- finding equal ones ---- */

/* The accessor of a mesh's positions; NT_NONE: none that is there. */
static uint32_t positions_of(const same_job *job, const nt_mesh *mesh)
{
	const uint32_t accessor = nt_gltf_reference(job->document, nt_json_find(nt_gltf_primitive_of(job->document,
		mesh), "attributes"), "POSITION");
	return accessor != NT_NONE ? nt_gltf_same(job->document, accessor) : NT_NONE;
}

/* Fills positions, [mesh_count], of meshes that share theirs; NT_NONE: others, of which nothing more has to be known.
 * users: [accessor_count] zeros. Returns how many share. */
static size_t find_sharing(const same_job *job, uint32_t *positions, uint32_t *users)
{
	const nt_scene *scene = job->scene;
	size_t count = 0;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		positions[i] = is_wanted(&scene->meshes[i], job->options)
			? positions_of(job, &scene->meshes[i]) : NT_NONE;
		if (positions[i] != NT_NONE)
			users[positions[i]]++;
	}
	for (size_t i = 0; i < scene->mesh_count; i++) {
		if (positions[i] != NT_NONE && users[positions[i]] == 1)
			positions[i] = NT_NONE;
		count += positions[i] != NT_NONE;
	}
	return count;
}

/* first: by the number of its key, the first mesh that has it: as many as share positions. */
static nt_status find_all(same_job *job, nt_scene *scene, const uint32_t *positions, uint32_t *first, nt_error *error)
{
	nt_name_table keys = {0};
	nt_arena arena = {0};
	nt_status status = NT_OK;
	for (uint32_t i = 0; !status && i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (positions[i] == NT_NONE)
			continue;
		job->key.size = 0;
		status = put_key(job, mesh, error);
		const size_t known = keys.count;
		const char *text = status ? NULL : nt_arena_text(&arena, job->key.data, job->key.size);
		const uint32_t number = text ? nt_name_add(&keys, text, job->key.size) : NT_NONE;
		if (!status && number == NT_NONE)
			status = nt_fail_memory(error);
		if (!status && number == known)
			first[number] = i;
		else if (!status)
			mesh->plan.same_as = &scene->meshes[first[number]];
	}
	nt_name_table_free(&keys);
	nt_arena_free(&arena);
	return status;
}

static nt_status find_among(same_job *job, nt_scene *scene, nt_error *error)
{
	uint32_t *positions = nt_alloc(scene->mesh_count, sizeof *positions);
	uint32_t *users = nt_calloc(job->document->accessor_count, sizeof *users);
	const bool ready = positions && users;
	const size_t count = ready ? find_sharing(job, positions, users) : 0;
	free(users);
	uint32_t *first = ready ? nt_alloc(count, sizeof *first) : NULL;
	const nt_status status = first ? find_all(job, scene, positions, first, error) : nt_fail_memory(error);
	nt_buffer_free(&job->key);
	free(positions);
	free(first);
	return status;
}

nt_status nt_gltf_find_same(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	size_t wanted = 0;
	for (size_t i = 0; i < scene->mesh_count; i++)
		wanted += is_wanted(&scene->meshes[i], options);
	if (wanted < 2)
		return NT_OK;
	nt_gltf *document = scene->source;
	same_job job = {.scene = scene, .document = document, .options = options};
	return find_among(&job, scene, error);
}

/* SPDX-License-Identifier: MIT */
/*
 * Primitives with the same geometry, so that it is loaded and solved once.
 *
 * Everything that load() reads of a primitive is written down as numbers: the accessors of what a solve
 * takes, with accessors over the same bytes counted as one, the mode, the compressed block and the
 * texture transform. Primitives with equal numbers have equal geometry; a hash table finds them in linear
 * time. What is not known to be equal is not.
 */
#include "gltf/same_geometry.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/materials.h"
#include "gltf/primitive.h"

/* Numbers that are no accessors. */
#define MISSING UINT64_MAX
#define FAULTY (UINT64_MAX - 1) /* loading will say why; it is like nothing else */

typedef struct same_job {
	const nt_scene *scene;
	nt_gltf *document;
	const nt_read_options *options;
	uint32_t *first_alias; /* [accessor_count] */
	size_t accessor_count;
	nt_buffer keys;      /* of all meshes, one behind the other */
	size_t *begin;       /* [mesh_count + 1] where a mesh's key begins */
	uint32_t *table;     /* [table_size] numbers of meshes; at most half full */
	size_t table_size;
} same_job;

/* Whether the mesh is going to be loaded: to be solved, or only to be checked. */
static bool is_wanted(const nt_mesh *mesh, const nt_read_options *options)
{
	return mesh->decision == NT_DECISION_SOLVE || mesh->decision == NT_DECISION_REPAIR ||
		(options->report && mesh->triangles && mesh->has_positions);
}

/* ---- keys ---- */

static void put_number(same_job *job, uint64_t number)
{
	nt_buffer_append(&job->keys, &number, sizeof number);
}

/* The accessor that a member names; a faulty one is followed by the mesh's own number. */
static void put_accessor(same_job *job, const nt_mesh *mesh, const nt_json_value *object, const char *name)
{
	const nt_json_value *reference = nt_json_find(object, name);
	uint64_t accessor;
	if (!reference) {
		put_number(job, MISSING);
	} else if (nt_json_get_uint64(reference, &accessor) && accessor < job->accessor_count) {
		put_number(job, job->first_alias[accessor]);
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

static void put_transform(same_job *job, const nt_mesh *mesh, const nt_gltf_shading *shading)
{
	const nt_gltf_transform *t = &shading->transform;
	const bool applies = shading->has_set && shading->set == mesh->texcoord_set && t->exists;
	put_number(job, applies);
	if (!applies)
		return;
	nt_buffer_append(&job->keys, &t->rotation, sizeof t->rotation);
	nt_buffer_append(&job->keys, t->scale, sizeof t->scale);
}

static void put_targets(same_job *job, const nt_mesh *mesh, const nt_json_value *primitive)
{
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		put_accessor(job, mesh, nt_json_at(targets, i), "POSITION");
		put_accessor(job, mesh, nt_json_at(targets, i), "NORMAL");
	}
}

static nt_status put_key(same_job *job, const nt_mesh *mesh, nt_error *error)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(job->document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	nt_gltf_shading shading;
	const nt_status status = nt_gltf_find_slots(job->document, primitive, mesh->place.pointer,
		&shading, error);
	if (status)
		return status;
	char texcoords[32];
	snprintf(texcoords, sizeof texcoords, "TEXCOORD_%u", mesh->texcoord_set);
	const char *const names[] = {"POSITION", "NORMAL", texcoords, "TANGENT", "COLOR_0"};
	const size_t count = sizeof names / sizeof *names - !job->options->world;
	uint64_t mode = 4;
	nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
	put_number(job, mesh->decision);
	put_number(job, mode);
	for (size_t i = 0; i < count; i++)
		put_accessor(job, mesh, attributes, names[i]);
	put_accessor(job, mesh, primitive, "indices");
	put_draco(job, primitive, names, count);
	put_transform(job, mesh, &shading);
	if (!job->options->world && job->options->morphs == NT_MORPH_BAKE)
		put_targets(job, mesh, primitive);
	return job->keys.failed ? nt_fail_memory(error) : NT_OK;
}

/* ---- finding equal ones ---- */

static bool same_key(const same_job *job, size_t a, size_t b)
{
	const size_t size = job->begin[a + 1] - job->begin[a];
	return size == job->begin[b + 1] - job->begin[b] &&
		memcmp(job->keys.data + job->begin[a], job->keys.data + job->begin[b], size) == 0;
}

static uint64_t hash_key(const same_job *job, size_t mesh)
{
	uint64_t hash = 0x9e3779b97f4a7c15u;
	for (size_t at = job->begin[mesh]; at < job->begin[mesh + 1]; at += sizeof hash) {
		uint64_t word;
		memcpy(&word, job->keys.data + at, sizeof word);
		hash = (hash ^ word) * 0xff51afd7ed558ccdu;
		hash ^= hash >> 32;
	}
	return hash;
}

/* The first mesh with the same key, which may be this one. */
static uint32_t find_first(same_job *job, uint32_t mesh)
{
	size_t at = hash_key(job, mesh) & (job->table_size - 1);
	while (job->table[at] != NT_NONE && !same_key(job, job->table[at], mesh))
		at = (at + 1) & (job->table_size - 1);
	if (job->table[at] == NT_NONE)
		job->table[at] = mesh;
	return job->table[at];
}

static nt_status find_all(same_job *job, nt_scene *scene, nt_error *error)
{
	nt_status status = NT_OK;
	for (uint32_t i = 0; !status && i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		job->begin[i] = job->begin[i + 1] = job->keys.size;
		/* what is solved with others has a result of its own */
		if (!is_wanted(mesh, job->options) || mesh->join)
			continue;
		status = put_key(job, mesh, error);
		job->begin[i + 1] = job->keys.size;
		const uint32_t first = status ? i : find_first(job, i);
		if (first != i)
			mesh->same_as = &scene->meshes[first];
	}
	return status;
}

nt_status nt_gltf_find_same(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	size_t wanted = 0;
	for (size_t i = 0; i < scene->mesh_count; i++)
		wanted += is_wanted(&scene->meshes[i], options);
	if (wanted < 2)
		return NT_OK;
	same_job job = {.scene = scene, .document = scene->source, .options = options, .table_size = 4};
	job.accessor_count = nt_json_count(nt_gltf_root_member(job.document, "accessors"));
	while (job.table_size < 2 * wanted)
		job.table_size *= 2;
	job.first_alias = nt_alloc(job.accessor_count, sizeof *job.first_alias);
	job.begin = nt_alloc(scene->mesh_count + 1, sizeof *job.begin);
	job.table = nt_alloc(job.table_size, sizeof *job.table);
	nt_status status = NT_ERROR_MEMORY;
	if (!job.first_alias || !job.begin || !job.table ||
		!nt_gltf_find_first_aliases(job.document, job.first_alias, job.accessor_count)) {
		nt_fail_memory(error);
	} else {
		memset(job.table, 0xFF, job.table_size * sizeof *job.table);
		status = find_all(&job, scene, error);
	}
	nt_buffer_free(&job.keys);
	free(job.first_alias);
	free(job.begin);
	free(job.table);
	return status;
}

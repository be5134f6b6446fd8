/* SPDX-License-Identifier: MIT */
/*
 * Finds primitives that are the same. A key has all that decides, as numbers: accessors, those over the same bytes
 * counted as one, and the texture transform. Primitives with equal keys have equal geometry; a table of keys finds them
 * in linear time. Primitives that are not known to be equal count as different.
 *
 * Three ask: which primitives have the geometry of an earlier one, so that it is loaded and solved once (here), which
 * users of a pool have one TANGENT (vertex_pools.c), and which joins are those of another mesh (joins.c).
 */
#include <stdlib.h>
#include "gltf/document.h"
#include "gltf/load.h"
#include "gltf/vertex_pools.h"
#include "scene/values.h"

/* ---- keys ---- */

void nt_key_put(nt_key_table *table, uint64_t number)
{
	nt_buffer_append(&table->key, &number, sizeof number);
}

uint32_t nt_key_number(nt_key_table *table)
{
	const nt_buffer *key = &table->key;
	const char *text = key->failed ? NULL : nt_arena_text(&table->texts, key->data, key->size);
	const uint32_t number = text ? nt_name_add(&table->names, text, key->size) : NT_NONE;
	table->key.size = 0;
	return number;
}

void nt_key_table_free(nt_key_table *table)
{
	nt_buffer_free(&table->key);
	nt_arena_free(&table->texts);
	nt_name_table_free(&table->names);
}

/* The accessor that a member names. A faulty one, whose load will say why, is like nothing else: it is followed by the
 * mesh's own place. */
static void put_accessor(nt_key_table *table, const nt_gltf *document, const nt_mesh *mesh, const nt_json_value *object,
	const char *name)
{
	const uint32_t accessor = nt_gltf_reference(document, object, name);
	const bool faulty = accessor == NT_NONE && nt_json_find(object, name);
	nt_key_put(table, accessor != NT_NONE ? nt_gltf_same(document, accessor) : UINT64_MAX - faulty);
	if (faulty)
		nt_key_put(table, (uint64_t)mesh->gltf_mesh << 32 | mesh->gltf_primitive);
}

void nt_geometry_key(nt_key_table *table, const nt_gltf *document, const nt_mesh *mesh, bool bakes)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes"),
		*targets = bakes && mesh->moving_targets ? nt_json_find(primitive, "targets") : NULL;
	char texcoords[32];
	nt_gltf_put_number(nt_gltf_put_text(texcoords, "TEXCOORD_"), mesh->texcoord_set);
	put_accessor(table, document, mesh, attributes, "POSITION");
	put_accessor(table, document, mesh, attributes, "NORMAL");
	put_accessor(table, document, mesh, attributes, texcoords);
	nt_key_put(table, nt_json_count(targets));
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		put_accessor(table, document, mesh, nt_json_at(targets, i), "POSITION");
		put_accessor(table, document, mesh, nt_json_at(targets, i), "NORMAL");
	}
	nt_key_put(table, mesh->transform != NULL);
	if (mesh->transform) {
		nt_buffer_append(&table->key, &mesh->transform->rotation, sizeof mesh->transform->rotation);
		nt_buffer_append(&table->key, mesh->transform->scale, sizeof mesh->transform->scale);
	}
}

/* ---- the same as an earlier one ---- */

/* Whether the mesh is going to be loaded: to be solved, or only to be checked, or for others. */
static bool is_wanted(const nt_mesh *mesh, const nt_read_options *options)
{
	return nt_mesh_is_wanted(mesh) ||
		((options->report || options->across) && mesh->triangles && mesh->has_positions);
}

/* The block, and which of its attributes has which name. In another order they are taken for others, which costs a
 * load. */
static void put_block(nt_key_table *table, const nt_json_value *primitive)
{
	const nt_json_value *extension = nt_gltf_draco_of(primitive);
	const nt_json_value *ids = nt_json_find(extension, "attributes");
	uint64_t number = UINT64_MAX;
	nt_json_find_uint64(extension, "bufferView", &number);
	nt_key_put(table, number);
	nt_key_put(table, nt_json_count(ids));
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		size_t length;
		const char *name = nt_json_key(ids, i, &length);
		number = UINT64_MAX;
		nt_json_get_uint64(nt_json_at(ids, i), &number);
		nt_key_put(table, number);
		nt_key_put(table, name ? length : 0);
		if (name)
			nt_buffer_append(&table->key, name, length);
	}
}

/* Everything that a load reads of a primitive, and what decides what becomes of it. */
static void put_all(nt_key_table *table, const nt_gltf *document, const nt_mesh *mesh, const nt_read_options *options)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	nt_key_put(table, mesh->decision);
	nt_key_put(table, mesh->keeps_inverted);
	nt_key_put(table, nt_gltf_mode(primitive));
	nt_key_put(table, mesh->has_polygons);
	put_accessor(table, document, mesh, attributes, "TANGENT");
	if (options->world)
		put_accessor(table, document, mesh, attributes, "COLOR_0");
	put_accessor(table, document, mesh, primitive, "indices");
	put_block(table, primitive);
	nt_geometry_key(table, document, mesh, !options->world && options->morphs == NT_MORPH_BAKE);
}

/* Fills positions, [mesh_count], the accessor of meshes that share theirs; NT_NONE: others, of which nothing more has
 * to be known. users: [accessor_count] zeros. Returns how many share. */
static size_t find_sharing(const nt_scene *scene, const nt_read_options *options, uint32_t *positions, uint32_t *users)
{
	const nt_gltf *document = scene->source;
	size_t count = 0;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		const uint32_t accessor = !is_wanted(mesh, options) ? NT_NONE : nt_gltf_reference(document,
			nt_json_find(nt_gltf_primitive_of(document, mesh), "attributes"), "POSITION");
		positions[i] = accessor != NT_NONE ? nt_gltf_same(document, accessor) : NT_NONE;
		if (accessor != NT_NONE)
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
static bool find_all(nt_scene *scene, const nt_read_options *options, const uint32_t *positions, uint32_t *first)
{
	nt_key_table keys = {0};
	uint32_t number = 0;
	for (uint32_t i = 0; number != NT_NONE && i < scene->mesh_count; i++) {
		const size_t known = keys.names.count;
		if (positions[i] == NT_NONE)
			continue;
		put_all(&keys, scene->source, &scene->meshes[i], options);
		number = nt_key_number(&keys);
		if (number == known)
			first[number] = i;
		else if (number != NT_NONE)
			scene->meshes[i].plan.same_as = &scene->meshes[first[number]];
	}
	nt_key_table_free(&keys);
	return number != NT_NONE;
}

nt_status nt_gltf_find_same(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	const nt_gltf *document = scene->source;
	size_t wanted = 0;
	for (size_t i = 0; i < scene->mesh_count; i++)
		wanted += is_wanted(&scene->meshes[i], options);
	if (wanted < 2)
		return NT_OK;
	uint32_t *positions = nt_alloc(scene->mesh_count, sizeof *positions);
	uint32_t *users = nt_calloc(document->accessor_count, sizeof *users);
	const bool ready = positions && users;
	const size_t count = ready ? find_sharing(scene, options, positions, users) : 0;
	free(users);
	uint32_t *first = ready ? nt_alloc(count, sizeof *first) : NULL;
	const bool found = first && find_all(scene, options, positions, first);
	free(positions);
	free(first);
	return found ? NT_OK : nt_fail_memory(error);
}

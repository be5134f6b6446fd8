/* SPDX-License-Identifier: MIT */
/*
 * Primitives whose results together would be far larger than the file: those that draw the same vertices with
 * different triangles. A megabyte can hold a thousand windows of one list of indices, each of which has tangents for
 * every vertex. They are loaded and solved some at a time, while gltf/edit/merge_splits.c puts the results together,
 * in which they are indices and no more.
 *
 * Only the plain case is late: triangles with normals, uncompressed, without morph targets and texture transforms, so
 * that all that must be known of a primitive before it is solved stands in the JSON. And only where primitives have
 * more corners together than the file has bytes, which cannot be where they share nothing.
 */
#include "gltf/late.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/accessor.h"
#include "gltf/draco.h"
#include "gltf/materials.h"
#include "gltf/pointer.h"
#include "gltf/primitive.h"
#include "gltf/view.h"

typedef struct search {
	nt_scene *scene;
	nt_gltf *document;
	size_t accessor_count;
	uint32_t *first_alias; /* [accessor_count] */
	uint32_t *users;       /* [accessor_count] by first alias: meshes that have it as POSITION and are solved */
} search;

static bool has_compression(const nt_scene *scene)
{
	const nt_gltf *document = scene->source;
	const nt_json_value *views = nt_gltf_root_member(document, "bufferViews");
	for (size_t i = 0; i < nt_json_count(views); i++)
		if (nt_gltf_compression_of(nt_json_at(views, i), NULL))
			return true;
	for (size_t i = 0; i < scene->mesh_count; i++)
		if (nt_gltf_draco_of(nt_gltf_primitive_of(document, &scene->meshes[i])))
			return true;
	return false;
}

/* The accessor of a member; NT_NONE: none, or a faulty one. */
static uint32_t accessor_of(const search *s, const nt_json_value *object, const char *name)
{
	uint64_t accessor;
	return nt_json_get_uint64(nt_json_find(object, name), &accessor) && accessor < s->accessor_count ?
		(uint32_t)accessor : NT_NONE;
}

/* By first alias; NT_NONE: none. */
static uint32_t positions_of(const search *s, const nt_mesh *mesh)
{
	const uint32_t accessor = accessor_of(s, nt_json_find(nt_gltf_primitive_of(s->document, mesh), "attributes"),
		"POSITION");
	return accessor == NT_NONE ? NT_NONE : s->first_alias[accessor];
}

static bool is_solved_once(const nt_mesh *mesh)
{
	return nt_mesh_is_wanted(mesh) && !mesh->same_as;
}

/* Whether what must be known before the solve is in the JSON: see above. Whole triangles, since a list may end with
 * indices that form none, and these stay. */
static bool is_plain(const search *s, const nt_mesh *mesh)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(s->document, mesh);
	uint64_t mode = NT_GLTF_TRIANGLES;
	nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
	nt_gltf_shading shading;
	nt_gltf_accessor indices;
	const uint32_t number = accessor_of(s, primitive, "indices");
	return mode == NT_GLTF_TRIANGLES && mesh->has_normals && !nt_json_find(primitive, "targets") &&
		number != NT_NONE &&
		nt_gltf_get_accessor(s->document, number, nt_gltf_of_mesh(mesh).pointer, &indices, NULL) == NT_OK &&
		indices.count % 3 == 0 &&
		nt_gltf_find_slots(s->document, primitive, nt_gltf_of_mesh(mesh).pointer, &shading, NULL) == NT_OK &&
		!shading.transform.turns;
}

static bool is_late(const search *s, const nt_mesh *mesh)
{
	if (!is_solved_once(mesh))
		return mesh->same_as && nt_mesh_is_wanted(mesh) && mesh->same_as->late;
	const uint32_t positions = positions_of(s, mesh);
	return positions != NT_NONE && s->users[positions] > 1 && is_plain(s, mesh);
}

static nt_status mark_all(const search *s, nt_error *error)
{
	const nt_scene *scene = s->scene;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		nt_gltf_accessor positions;
		mesh->late = is_late(s, mesh);
		if (!mesh->late)
			continue;
		status = nt_gltf_get_accessor(s->document, positions_of(s, mesh), nt_gltf_of_mesh(mesh).pointer,
			&positions, error);
		if (!status)
			mesh->vertex_count = mesh->source_vertex_count = (size_t)positions.count;
	}
	return status;
}

nt_status nt_gltf_find_late(nt_scene *scene, nt_error *error)
{
	size_t corners = 0;
	for (size_t i = 0; i < scene->mesh_count; i++)
		corners += is_solved_once(&scene->meshes[i]) ? 3 * scene->meshes[i].face_count : 0;
	if (corners <= scene->byte_count || has_compression(scene))
		return NT_OK;
	search s = {.scene = scene, .document = scene->source};
	s.accessor_count = nt_json_count(nt_gltf_root_member(s.document, "accessors"));
	s.first_alias = nt_alloc(s.accessor_count, sizeof *s.first_alias);
	s.users = nt_calloc(s.accessor_count, sizeof *s.users);
	const bool ready = s.first_alias && s.users &&
		nt_gltf_find_first_aliases(s.document, s.first_alias, s.accessor_count);
	for (size_t i = 0; ready && i < scene->mesh_count; i++)
		if (is_solved_once(&scene->meshes[i]) && positions_of(&s, &scene->meshes[i]) != NT_NONE)
			s.users[positions_of(&s, &scene->meshes[i])]++;
	const nt_status status = ready ? mark_all(&s, error) : nt_fail_memory(error);
	free(s.first_alias);
	free(s.users);
	return status;
}

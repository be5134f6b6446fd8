/* SPDX-License-Identifier: MIT */
/*
 * An unknown extension cannot follow when vertices are copied; but the user can be told.
 * An extension is taken to refer to vertices where a number in it is that of an accessor with as many elements as there
 * were vertices, which is none of the primitive's own attributes: those grow with it. The number may be another thing,
 * a mode, say: the finding is a warning to look.
 */
#include "gltf/extensions/extensions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/buffer.h"
#include "gltf/pointer.h"
#include "gltf/primitive.h"

/* Extensions that need nothing, or that are looked after elsewhere. */
static const char *const harmless[] = {"KHR_draco_mesh_compression", "KHR_materials_variants",
	"CESIUM_primitive_outline", "EXT_mesh_features", "EXT_mesh_manifold", "EXT_structural_metadata"};

typedef struct search {
	nt_scene *scene;
	const nt_gltf *document;
	const nt_mesh *mesh;
	const nt_json_value *primitive;
	size_t old_count;
	nt_buffer pointer; /* of the value that is looked at */
	bool *own;         /* [accessor_count] attributes of the primitive; NULL: not yet known */
	bool failed;       /* they cannot be, for lack of memory */
} search;

static bool is_in(const char *const *names, size_t count, const char *name)
{
	for (size_t i = 0; i < count; i++)
		if (strcmp(names[i], name) == 0)
			return true;
	return false;
}

static nt_status mark_attribute(void *context, nt_json_value *attributes, const char *name, uint32_t accessor)
{
	(void)attributes;
	(void)name;
	search *s = context;
	s->own[accessor] = true;
	return NT_OK;
}

/* Whether an accessor grows with the primitive. All that do are marked when the first one is asked for. */
static bool is_attribute(search *s, uint64_t accessor, size_t accessor_count)
{
	if (!s->own) {
		s->own = nt_calloc(accessor_count, sizeof *s->own);
		s->failed = !s->own;
		if (s->own)
			nt_gltf_visit_attributes(s->primitive, accessor_count, mark_attribute, s);
	}
	return s->failed || s->own[accessor];
}

static bool is_per_vertex(search *s, const nt_json_value *value)
{
	uint64_t accessor, count;
	const nt_json_value *accessors = nt_gltf_root_member(s->document, "accessors");
	return nt_json_get_uint64(value, &accessor) && accessor < nt_json_count(accessors) &&
		nt_json_get_uint64(nt_json_find(nt_json_at(accessors, accessor), "count"), &count) &&
		count == s->old_count && !is_attribute(s, accessor, nt_json_count(accessors));
}

/* Goes on with a member or an element, whose name becomes part of the pointer; returns its length before. */
static size_t enter(search *s, const nt_json_value *parent, size_t index)
{
	const size_t before = s->pointer.size;
	if (nt_json_type_of(parent) == NT_JSON_OBJECT) {
		size_t length;
		const char *key = nt_json_key(parent, index, &length);
		nt_buffer_format(&s->pointer, "/%.*s", (int)(length < 100 ? length : 100), key);
	} else {
		nt_buffer_format(&s->pointer, "/%zu", index);
	}
	return before;
}

/* Whether a value within the extension is such a number; the pointer is its then. */
static bool find_number(search *s, const nt_json_value *value)
{
	const nt_json_type type = nt_json_type_of(value);
	if (type != NT_JSON_OBJECT && type != NT_JSON_ARRAY)
		return is_per_vertex(s, value);
	for (size_t i = 0; i < nt_json_count(value); i++) {
		const size_t before = enter(s, value, i);
		if (find_number(s, nt_json_at(value, i)))
			return true;
		s->pointer.size = before;
	}
	return false;
}

static void look_at(search *s, const nt_json_value *extensions, const char *owner)
{
	for (size_t i = 0; i < nt_json_count(extensions); i++) {
		size_t length;
		const char *name = nt_json_key(extensions, i, &length);
		s->pointer.size = 0;
		nt_buffer_format(&s->pointer, "%s/extensions", owner);
		enter(s, extensions, i);
		if (!name || is_in(harmless, sizeof harmless / sizeof *harmless, name))
			continue;
		if (!find_number(s, nt_json_at(extensions, i)))
			continue;
		if (s->pointer.failed)
			return;
		nt_place place;
		nt_mesh_place(s->mesh, &place);
		snprintf(place.pointer, sizeof place.pointer, "%.*s", (int)s->pointer.size, s->pointer.data);
		nt_finding_add(&s->scene->findings, NT_CODE_EXTENSION_STALE, &place, 1, "%.*s",
			(int)(length < 100 ? length : 100), name);
	}
}

nt_status nt_extension_references(nt_scene *scene, const nt_mesh *mesh, size_t old_count, bool with_mesh)
{
	search s = {.scene = scene, .document = scene->source, .mesh = mesh, .old_count = old_count};
	s.primitive = nt_gltf_primitive_of(s.document, mesh);
	look_at(&s, nt_json_find(s.primitive, "extensions"), nt_gltf_of_mesh(mesh).pointer);
	if (with_mesh) {
		char owner[NT_GLTF_POINTER];
		snprintf(owner, sizeof owner, "/meshes/%u", mesh->gltf_mesh);
		look_at(&s, nt_json_find(nt_json_at(nt_gltf_root_member(s.document, "meshes"), mesh->gltf_mesh),
			"extensions"), owner);
	}
	const bool failed = s.pointer.failed || s.failed;
	nt_buffer_free(&s.pointer);
	free(s.own);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

void nt_extension_scenes(nt_scene *scene)
{
	static const char name[] = "FB_geometry_metadata";
	const nt_gltf *document = scene->source;
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	for (size_t i = 0; i < nt_json_count(scenes); i++) {
		if (!nt_json_find(nt_json_find(nt_json_at(scenes, i), "extensions"), name))
			continue;
		nt_place place;
		nt_place_clear(&place);
		snprintf(place.file, sizeof place.file, "%s", document->path);
		snprintf(place.pointer, sizeof place.pointer, "/scenes/%zu/extensions/%s", i, name);
		nt_finding_add(&scene->findings, NT_CODE_EXTENSION_STALE, &place, 1, "vertexCount of %s", name);
	}
}

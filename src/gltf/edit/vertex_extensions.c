/* SPDX-License-Identifier: MIT */
/*
 * Extensions of primitives and meshes that refer to vertices. None follows when vertices are copied: the copies get the
 * attributes of their vertex, and what an extension says of vertices by their numbers is left as it is, and told. Only
 * FB_ngon_encoding, a mark that says which triangles are one polygon, goes where it would not say the same any more.
 *
 * An extension that the table does not have is taken to refer to vertices if a number in it is that of an accessor with
 * as many elements as there were vertices, which is none of the primitive's own attributes: those grow with it. The
 * number may be another thing, a mode, say: the finding is a warning to look.
 */
#include "gltf/edit/pool_edit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/text.h"
#include "gltf/document.h"

static const char features_name[] = "EXT_mesh_features";

typedef enum meaning {
	UNKNOWN,
	NOTHING,  /* it does not refer to vertices, or is looked after elsewhere */
	INDICES,  /* has indices like those of the primitives */
	NUMBERS,  /* vertices are meant by their numbers, unless an attribute says otherwise */
	POLYGONS
} meaning;

static const struct {
	const char *name;
	meaning meaning;
} extensions_known[] = {
	{"CESIUM_primitive_outline", INDICES},
	{features_name, NUMBERS},
	{"EXT_mesh_manifold", INDICES},
	{"EXT_mesh_primitive_restart", INDICES},
	{"EXT_structural_metadata", NOTHING},
	{NT_GLTF_POLYGONS, POLYGONS},
	{"KHR_draco_mesh_compression", NOTHING},
	{"KHR_materials_variants", NOTHING},
};

static meaning meaning_of(const char *name)
{
	for (size_t i = 0; i < sizeof extensions_known / sizeof *extensions_known; i++)
		if (strcmp(extensions_known[i].name, name) == 0)
			return extensions_known[i].meaning;
	return UNKNOWN;
}

bool nt_vertices_are_ids(const nt_json_value *primitive)
{
	const nt_json_value *ids = nt_json_find(nt_json_find(nt_json_find(primitive, "extensions"), features_name),
		"featureIds");
	for (size_t i = 0; i < nt_json_count(ids); i++)
		if (!nt_json_find(nt_json_at(ids, i), "attribute") && !nt_json_find(nt_json_at(ids, i), "texture"))
			return true;
	return false;
}

/* ---- unknown ones ---- */

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

/* Whether an accessor grows with the primitive. All that do are marked when the first one is asked for. */
static bool is_attribute(search *s, uint64_t accessor)
{
	if (!s->own) {
		s->own = nt_calloc(s->document->accessor_count, sizeof *s->own);
		s->failed = !s->own;
		for (nt_gltf_use u = {0}; s->own && nt_gltf_next_use(s->document, s->primitive, &u);)
			s->own[u.accessor] = true;
	}
	return s->failed || s->own[accessor];
}

static bool is_per_vertex(search *s, const nt_json_value *value)
{
	uint64_t accessor, count;
	return nt_json_get_uint64(value, &accessor) && accessor < s->document->accessor_count &&
		nt_json_find_uint64(nt_gltf_accessor_json(s->document, accessor), "count", &count) &&
		count == s->old_count && !is_attribute(s, accessor);
}

/* Goes on with a member or an element, whose name becomes part of the pointer; returns its length before. */
static size_t enter(search *s, const nt_json_value *parent, size_t index)
{
	const size_t before = s->pointer.size;
	size_t length;
	const char *key = nt_json_key(parent, index, &length);
	if (key)
		nt_buffer_format(&s->pointer, "/%.*s", NT_CUT_OF(100, length, key));
	else
		nt_buffer_format(&s->pointer, "/%zu", index);
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

/* ---- one mesh ---- */

/* The first extension from *at on that does not hold if indices have changed, or vertices were copied; the pointer of
 * the search is that of it then. NULL: none. */
static const char *next_stale(search *s, const nt_json_value *extensions, const char *owner, bool changed, bool copied,
	size_t *at)
{
	while (*at < nt_json_count(extensions)) {
		const size_t i = (*at)++;
		const char *name = nt_json_key(extensions, i, NULL);
		if (!name)
			return NULL;
		s->pointer.size = 0;
		nt_buffer_format(&s->pointer, "%s/extensions", owner);
		enter(s, extensions, i);
		const meaning m = meaning_of(name);
		if ((m == INDICES && changed) || (m == NUMBERS && copied && nt_vertices_are_ids(s->primitive)) ||
			(m == UNKNOWN && find_number(s, nt_json_at(extensions, i))))
			return name;
	}
	return NULL;
}

static void tell(search *s, const nt_json_value *extensions, const char *owner, bool changed, bool copied)
{
	const char *name;
	for (size_t at = 0; (name = next_stale(s, extensions, owner, changed, copied, &at)) && !s->pointer.failed;) {
		nt_place place;
		nt_mesh_place(s->mesh, &place);
		snprintf(place.pointer, sizeof place.pointer, "%.*s", (int)s->pointer.size, s->pointer.data);
		nt_finding_add(&s->scene->findings, NT_CODE_EXTENSION_STALE, &place, 1, "%.*s", NT_CUT(100, name));
	}
}

static search begin_search(nt_scene *scene, const nt_mesh *mesh, size_t old_count)
{
	return (search){.scene = scene, .document = scene->source, .mesh = mesh, .old_count = old_count,
		.primitive = nt_gltf_primitive_of(scene->source, mesh)};
}

static nt_status end_search(search *s)
{
	const bool failed = s->pointer.failed || s->failed;
	nt_buffer_free(&s->pointer);
	free(s->own);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

static const nt_json_value *mesh_extensions(const nt_gltf *document, const nt_mesh *mesh)
{
	return nt_json_find(nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh), "extensions");
}

nt_status nt_vertices_find_meaning(nt_scene *scene, const nt_mesh *mesh, size_t old_count, const char **result)
{
	search s = begin_search(scene, mesh, old_count);
	const nt_json_value *const lists[] = {nt_json_find(s.primitive, "extensions"),
		mesh_extensions(s.document, mesh)};
	*result = nt_json_find(lists[0], NT_GLTF_POLYGONS) ? NT_GLTF_POLYGONS : NULL;
	for (size_t k = 0; k < 2; k++) {
		const char *name;
		for (size_t at = 0; !*result && (name = next_stale(&s, lists[k], "", true, true, &at));)
			*result = meaning_of(name) == UNKNOWN ? "an extension refers to its vertices" : name;
	}
	return end_search(&s);
}

/* ---- polygons ---- */

/* Whether triangles that follow each other have one first vertex where they had, and nowhere else. */
static bool keeps_polygons(const nt_pool_vertices *vertices, size_t user)
{
	const uint32_t *indices = vertices->users[user].numbers;
	const size_t count = nt_pool_mesh(vertices->pool, user)->corner_count;
	for (size_t c = 3; indices && c < count; c += 3)
		if (indices[c] != indices[c - 3] &&
			nt_vertex_source(vertices, indices[c]) == nt_vertex_source(vertices, indices[c - 3]))
			return false;
	return true;
}

static void drop_polygons(nt_scene *scene, nt_buffer_edits *edits, nt_json_value *primitive, const nt_mesh *mesh)
{
	nt_gltf_drop_extension(edits->document->json, primitive, NT_GLTF_POLYGONS);
	edits->polygons_dropped = true;
	nt_finding_add(&scene->findings, NT_CODE_POLYGONS_DROPPED, nt_mesh_place(mesh, &(nt_place){0}), 1, "%s",
		NT_GLTF_POLYGONS);
}

/* ---- the whole ---- */

/* The end of the users that are primitives of the same glTF mesh as `first`; *changed: whether one of them has other
 * indices. */
static size_t end_of_mesh(const nt_pool_vertices *vertices, size_t first, bool *changed)
{
	const nt_vertex_pool *pool = vertices->pool;
	size_t end = first;
	for (; end < pool->user_count &&
		nt_pool_mesh(pool, end)->gltf_mesh == nt_pool_mesh(pool, first)->gltf_mesh; end++)
		*changed |= vertices->users[end].changed;
	return end;
}

nt_status nt_vertices_tell(nt_buffer_edits *edits, nt_scene *scene, const nt_pool_vertices *vertices, bool compressed,
	nt_error *error)
{
	const nt_vertex_pool *pool = vertices->pool;
	const bool copied = nt_vertices_differ(vertices);
	nt_status status = NT_OK;
	if (!copied && !compressed)
		return NT_OK;
	edits->vertices_copied |= copied;
	for (size_t i = 0, end = 0; !status && i < pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		nt_json_value *primitive = nt_pool_primitive(pool, i);
		search s = begin_search(scene, mesh, vertices->old_count);
		if (nt_json_find(nt_json_find(primitive, "extensions"), NT_GLTF_POLYGONS) &&
			nt_pool_is_solved(pool, i) && (compressed || !keeps_polygons(vertices, i)))
			drop_polygons(scene, edits, primitive, mesh);
		tell(&s, nt_json_find(primitive, "extensions"), nt_gltf_of_mesh(mesh).pointer,
			compressed || vertices->users[i].changed, copied);
		if (i == end) {
			bool changed = compressed;
			char owner[NT_GLTF_POINTER];
			end = end_of_mesh(vertices, i, &changed);
			nt_gltf_pointer(owner, "meshes", mesh->gltf_mesh);
			tell(&s, mesh_extensions(s.document, mesh), owner, changed, copied);
		}
		status = end_search(&s);
	}
	return status ? nt_fail_memory(error) : NT_OK;
}

void nt_vertices_tell_scenes(nt_scene *scene)
{
	static const char name[] = "FB_geometry_metadata";
	const nt_gltf *document = scene->source;
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	for (size_t i = 0; i < nt_json_count(scenes); i++) {
		if (!nt_json_find(nt_json_find(nt_json_at(scenes, i), "extensions"), name))
			continue;
		nt_place place = nt_line_place(document->path, 0);
		snprintf(place.pointer, sizeof place.pointer, "/scenes/%zu/extensions/%s", i, name);
		nt_finding_add(&scene->findings, NT_CODE_EXTENSION_STALE, &place, 1, "vertexCount of %s", name);
	}
}

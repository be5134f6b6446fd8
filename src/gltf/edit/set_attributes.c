/* SPDX-License-Identifier: MIT */
/*
 * Attributes that a tangent set gets, and the accessors of that name that are there already: which of them are to be
 * written anew, and where.
 *
 * An accessor that only the meshes of one set use so keeps its number; one that several sets use goes to the last of
 * them. Elements of the same type are replaced in place, and so are interleaved ones that become smaller. If the type
 * is another one, or the accessor was sparse, had no bytes or was compressed by Draco, the old bytes are taken out and
 * the accessor gets a new place. An accessor that others use too stays, and a new accessor is appended. Unused bytes
 * remain in one case: interleaved elements that become larger leave their slots, since without these the attributes
 * beside them would need another stride.
 */
#include "gltf/bytes/bytes.h"
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "base/vec.h"
#include "gltf/document.h"

/* The accessor that a user has by that name; NT_NONE: none. */
static uint32_t accessor_of(const nt_gltf *document, const nt_vertex_pool *pool, size_t user, const char *name)
{
	return nt_gltf_reference(document, nt_json_find(nt_pool_primitive(pool, user), "attributes"), name);
}

/* Whether `known` meshes of a set are all that use an accessor, but for those that have got another one. */
static bool is_own(const nt_buffer_edits *edits, uint32_t accessor, size_t known, uint32_t components)
{
	const nt_gltf_users *users = &edits->document->users[accessor];
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(edits->document, accessor);
	return a && a->components == components && !users->foreign && !users->idle &&
		edits->accessors[accessor].replaced + known == users->attributes;
}

/* Whether the new elements go where the old ones are. */
static bool fits_in_place(nt_buffer_edits *edits, uint32_t accessor, const nt_tangent_filter *filter)
{
	const nt_precision precision = filter->precision;
	const nt_gltf_packing packing = nt_packing_of_accessor(edits, accessor);
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(edits->document, accessor);
	if (a->view == NT_NONE || a->sparse ||
		strcmp(packing.extension ? packing.view.filter : "NONE", filter->filter) != 0)
		return false;
	if (a->component_type == nt_precision_component_type(precision) &&
		(a->component_type == NT_GLTF_FLOAT || a->normalized))
		return true;
	const nt_segment *segment = nt_segment_of(edits, a->view, a->offset);
	return a->stride > a->element_bytes && nt_precision_bytes(precision) <= a->element_bytes && segment &&
		segment->users > 1;
}

static int compare_numbers(const void *a, const void *b)
{
	const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
	return (x > y) - (x < y);
}

/* The accessors that a set's meshes have by that name, by `same`, in ascending order, each as often as it is used. */
static nt_status list_accessors(const nt_gltf *document, const nt_vertex_pool *pool, uint32_t set, const char *name,
	nt_arena *arena, uint32_t **list, size_t *count, nt_error *error)
{
	size_t users = 0;
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i])
		users++;
	*list = nt_arena_alloc(arena, users, sizeof **list);
	if (!*list)
		return nt_fail_memory(error);
	*count = 0;
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t accessor = accessor_of(document, pool, i, name);
		if (accessor != NT_NONE)
			(*list)[(*count)++] = nt_gltf_same(document, accessor);
	}
	qsort(*list, *count, sizeof **list, compare_numbers);
	return NT_OK;
}

/* An accessor leaves its bytes, with all over the same. */
static void leave(nt_buffer_edits *edits, uint32_t accessor)
{
	nt_edits_leave_accessor(edits, accessor);
	for (uint32_t k = nt_gltf_same(edits->document, accessor); k != NT_NONE;
		k = edits->document->accessors[k].next)
		edits->accessors[k].seen = true;
}

nt_status nt_set_attribute_settle(nt_buffer_edits *edits, const nt_vertex_pool *pool, uint32_t set, nt_arena *arena,
	nt_set_attribute *attribute, nt_override_list *overrides, nt_error *error)
{
	const nt_gltf *document = edits->document;
	const nt_stored_tangents *values = &attribute->values;
	uint32_t *list;
	size_t count = 0;
	nt_status status = list_accessors(document, pool, set, attribute->name, arena, &list, &count, error);
	attribute->own = list; /* what is kept overtakes nothing that is still to be read */
	attribute->own_count = 0;
	attribute->in_place = true;
	for (size_t i = 0, end; !status && i < count; i = end) {
		for (end = i + 1; end < count && list[end] == list[i];)
			end++;
		if (is_own(edits, list[i], end - i, attribute->components)) {
			attribute->in_place &= fits_in_place(edits, list[i], &values->filter);
			attribute->own[attribute->own_count++] = list[i];
		} else {
			edits->accessors[list[i]].replaced += (uint32_t)(end - i);
		}
	}
	attribute->in_place &= attribute->own_count > 0;
	for (size_t i = 0; !status && i < attribute->own_count; i++)
		if (attribute->in_place)
			status = nt_override_add(edits, overrides, (nt_gltf_override){attribute->own[i], values->values,
				values->stored, (uint32_t)values->element_bytes}, error);
		else
			leave(edits, attribute->own[i]);
	return status;
}

void nt_gltf_drop_elements(nt_buffer_edits *edits, uint32_t accessor)
{
	static const char *const gone[] = {"bufferView", "byteOffset", "sparse"};
	nt_gltf *document = edits->document;
	leave(edits, accessor);
	for (uint32_t k = nt_gltf_same(document, accessor); k != NT_NONE; k = document->accessors[k].next)
		for (size_t i = 0; i < sizeof gone / sizeof *gone; i++)
			nt_json_remove(document->json, nt_gltf_accessor_json(document, k), gone[i]);
}

/* ---- writing ---- */

uint32_t nt_gltf_new_accessor(nt_json *json, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized)
{
	nt_json_value *accessors = nt_json_put(json, nt_json_root(json), "accessors");
	const uint32_t number = (uint32_t)nt_json_count(accessors);
	nt_json_value *object = nt_json_append(json, accessors);
	if (view != NT_NONE)
		nt_json_put_uint64(json, object, "bufferView", view);
	nt_json_put_uint64(json, object, "componentType", component_type);
	if (normalized)
		nt_json_set_bool(json, nt_json_put(json, object, "normalized"), true);
	nt_json_put_uint64(json, object, "count", count);
	nt_json_set_string(json, nt_json_put(json, object, "type"), type, strlen(type));
	return number;
}

/* The type that is stored. */
static void set_type(nt_json *json, nt_json_value *accessor, nt_precision precision)
{
	const uint32_t type = nt_precision_component_type(precision);
	nt_json_put_uint64(json, accessor, "componentType", type);
	if (type == NT_GLTF_FLOAT)
		nt_json_remove(json, accessor, "normalized");
	else
		nt_json_set_bool(json, nt_json_put(json, accessor, "normalized"), true);
}

/* In place, an accessor of the type that is stored stays as it is. Elsewhere it refers to `count` new elements. */
static void describe(nt_gltf *document, uint32_t accessor, const nt_set_attribute *attribute, uint32_t view,
	uint64_t offset, size_t count)
{
	nt_json *json = document->json;
	nt_json_value *object = nt_gltf_accessor_json(document, accessor);
	const nt_precision precision = attribute->values.filter.precision;
	if (attribute->in_place) {
		if (document->accessors[accessor].component_type != nt_precision_component_type(precision))
			set_type(json, object, precision);
		return;
	}
	nt_gltf_place_accessor(json, object, view, offset);
	nt_json_put_uint64(json, object, "count", count);
	set_type(json, object, precision);
	nt_json_remove(json, object, "min");
	nt_json_remove(json, object, "max");
}

nt_status nt_set_attribute_write(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	uint32_t set, const nt_set_attribute *attribute, nt_error *error)
{
	nt_gltf *document = edits->document;
	nt_json *json = document->json;
	const nt_vertex_pool *pool = vertices->pool;
	const nt_stored_tangents *values = &attribute->values;
	const size_t count = vertices->new_count, element_bytes = values->element_bytes;
	const uint32_t type = nt_precision_component_type(values->filter.precision);
	uint32_t view = NT_NONE, accessor = attribute->own_count ? attribute->own[0] : NT_NONE;
	uint64_t offset = 0;
	nt_status status = NT_OK;
	if (!attribute->in_place) {
		nt_gltf_packing packing = values->packing;
		packing.view.filter = values->filter.filter;
		packing.view.stride = element_bytes;
		/* a view of several accessors has to say how far apart elements are */
		const bool several = attribute->own_count > 1 ||
			(accessor != NT_NONE && document->accessors[accessor].next != NT_NONE);
		status = nt_packed_add(edits, buffer, &packing, values->stored, count * element_bytes,
			NT_GLTF_ARRAY_BUFFER, several ? (uint32_t)element_bytes : 0, &view, &offset, error);
	}
	if (!status && accessor == NT_NONE) {
		accessor = nt_gltf_new_accessor(json, view, type, attribute->components == 3 ? "VEC3" : "VEC4", count,
			type != NT_GLTF_FLOAT);
		if (offset)
			nt_gltf_place_accessor(json, nt_gltf_accessor_json(document, accessor), view, offset);
	}
	for (size_t i = 0; !status && i < attribute->own_count; i++)
		for (uint32_t k = attribute->own[i]; k != NT_NONE; k = document->accessors[k].next)
			describe(document, k, attribute, view, offset, count);

	/* Meshes that have none of these accessors get the first one. */
	for (uint32_t i = pool->sets.first[set]; !status && i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t old = accessor_of(document, pool, i, attribute->name);
		const uint32_t same = old == NT_NONE ? NT_NONE : nt_gltf_same(document, old);
		if (old == NT_NONE ||
			!bsearch(&same, attribute->own, attribute->own_count, sizeof same, compare_numbers))
			nt_json_put_uint64(json, nt_json_find(nt_pool_primitive(pool, i), "attributes"),
				attribute->name, accessor);
	}
	return status;
}

nt_status nt_gltf_bitangents(const nt_pool_vertices *vertices, uint32_t set, nt_arena *arena, float **result,
	nt_error *error)
{
	const nt_pool_set *of = &vertices->sets[set];
	const nt_mesh *mesh = nt_pool_set_mesh(vertices->pool, set);
	const float *loaded = of->source_normals ? of->source_normals : mesh->normals;
	float *out = nt_arena_alloc(arena, vertices->new_count, 3 * sizeof *out);
	*result = out;
	if (!out)
		return nt_fail_memory(error);
	for (size_t v = 0; v < vertices->new_count; v++)
		nt_bitangent(of->normals ? of->normals + 3 * v : loaded + 3 * nt_vertex_source(vertices, v),
			of->tangents + 4 * v, out + 3 * v);
	return NT_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * Plain primitives that an explicit --draco asks to compress.
 *
 * All attributes go into the block; floats that have a meaning we know are quantized, all other values stay
 * exact. If the order of vertices matters to somebody (morph targets, attributes that Draco cannot have,
 * extensions of the primitive), the sequential method keeps it. A primitive is left plain where that would
 * not do: accessors that somebody else uses too, sparse or compressed ones, strips.
 *
 * The elements leave the buffers. Views keep their numbers: one takes the block, others that are empty then
 * share bytes with it.
 */
#include "gltf/edit/pool_edit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

/* ---- what can be compressed ---- */

static bool begins_with(const char *text, const char *start)
{
	return strncmp(text, start, strlen(start)) == 0;
}

/* Whether the elements of an accessor lie in the file as they are. */
static bool lies_plain(const nt_gltf_recoding *r, const nt_gltf_accessor *accessor)
{
	if (!accessor || accessor->view == NT_NONE || accessor->sparse || accessor->decoded)
		return false;
	const nt_gltf_view *view = nt_gltf_view_of(r->document, accessor);
	return !view->compressed && !nt_gltf_is_of_view(view->buffer);
}

/* Matrices are no attributes of Draco's. */
static bool is_vector(const nt_gltf_recoding *r, uint32_t accessor)
{
	const char *type = nt_json_find_string(nt_gltf_accessor_json(r->document, accessor), "type", NULL);
	return type && !begins_with(type, "MAT");
}

bool nt_gltf_draco_owns_indices(const nt_gltf_recoding *r, uint64_t accessor)
{
	if (accessor >= r->document->accessor_count)
		return false;
	const nt_gltf_users *users = nt_gltf_users_of(r->document, (uint32_t)accessor);
	return !users->attributes && users->indices == r->vertices->pool->user_count;
}

static bool indices_are_own(const nt_gltf_recoding *r)
{
	const uint32_t index = nt_gltf_reference(r->document, r->primitive, "indices");
	return !nt_json_find(r->primitive, "indices") ||
		(lies_plain(r, nt_gltf_sound_accessor(r->document, index)) && nt_gltf_draco_owns_indices(r, index));
}

/* ---- gathering ---- */

void nt_gltf_draco_add(nt_gltf_recoding *r, const char *name, nt_draco_attribute attribute)
{
	r->names[r->attribute_count] = name;
	r->attributes[r->attribute_count++] = attribute;
}

static bool is_in_block(const nt_gltf_recoding *r, const nt_gltf_use *use)
{
	for (size_t i = 0; !use->object && i < r->attribute_count; i++)
		if (strcmp(r->names[i], use->name) == 0)
			return true;
	return false;
}

static nt_status gather_attribute(nt_gltf_recoding *r, const char *name, uint64_t index, nt_error *error)
{
	const nt_gltf_accessor *accessor = nt_gltf_sound_accessor(r->document, index);
	if (!lies_plain(r, accessor) || accessor->count != r->vertices->old_count)
		r->obstacle = "an attribute is sparse or compressed";
	else if (r->document->users[accessor->same].foreign)
		r->obstacle = "something else uses its attributes";
	if (r->obstacle)
		return NT_OK;
	if (!is_vector(r, accessor->index)) {
		r->outside = true;
		return NT_OK;
	}
	const bool is_float = accessor->component_type == NT_GLTF_FLOAT;
	/* ours takes its place */
	if (strcmp(name, "TANGENT") == 0 && !(is_float && accessor->components == 4))
		r->obstacle = "it has tangents that are no floats";
	nt_draco_attribute attribute = {.unique_id = (uint32_t)r->attribute_count,
		.kind = nt_gltf_draco_kind(name), .component_type = (int)accessor->component_type,
		.components = (int)accessor->components, .normalized = accessor->normalized,
		.quantization = nt_gltf_draco_grid(r->document, accessor->index,
			is_float ? nt_gltf_draco_bits_of(r->options->draco_bits, name) : 0),
		.stride_bytes = accessor->stride, .copied = r->vertices->sources, .own_count = r->vertices->own_count};
	const unsigned char *elements = NULL;
	const nt_status status = nt_gltf_elements(r->document, accessor, &elements, error);
	attribute.data = elements;
	if (!status)
		nt_gltf_draco_add(r, name, attribute);
	return status;
}

/* Whether an accessor of the block is used a second time, in it or beside it. */
static bool has_doubles(const nt_gltf_recoding *r)
{
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	for (size_t i = 0; i < r->attribute_count; i++) {
		const uint32_t index = nt_gltf_reference(r->document, attributes, r->names[i]);
		size_t uses = 0;
		for (nt_gltf_use u = {0}; index != NT_NONE && nt_gltf_next_use(r->document, r->primitive, &u);)
			uses += nt_gltf_same(r->document, u.accessor) == nt_gltf_same(r->document, index);
		if (uses != 1)
			return true;
	}
	return false;
}

nt_status nt_gltf_draco_gather_plain(nt_gltf_recoding *r, nt_error *error)
{
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	const size_t count = nt_json_count(attributes);
	if (nt_gltf_mode(r->primitive) != NT_GLTF_TRIANGLES)
		r->obstacle = "it is a strip or a fan";
	else if (!indices_are_own(r))
		r->obstacle = "its indices are shared, sparse or compressed";
	if (r->obstacle)
		return NT_OK;
	r->attributes = nt_arena_alloc(r->arena, count + NT_GLTF_OWN_ATTRIBUTES, sizeof *r->attributes);
	r->names = nt_arena_alloc(r->arena, count + NT_GLTF_OWN_ATTRIBUTES, sizeof *r->names);
	if (!r->attributes || !r->names)
		return nt_fail_memory(error);
	nt_status status = NT_OK;
	for (size_t i = 0; !status && !r->obstacle && i < count; i++) {
		uint64_t index = UINT64_MAX;
		nt_json_get_uint64(nt_json_at(attributes, i), &index);
		status = gather_attribute(r, nt_json_key(attributes, i, NULL), index, error);
	}
	if (status || r->obstacle)
		return status;
	if (has_doubles(r))
		r->obstacle = "two of its attributes are one accessor";
	for (nt_gltf_use u = {0}; nt_gltf_next_use(r->document, r->primitive, &u);)
		r->outside |= !is_in_block(r, &u);
	/* an extension that we do not know may number the vertices */
	for (size_t m = 0; m < r->vertices->pool->user_count; m++) {
		const nt_json_value *extensions = nt_json_find(nt_pool_primitive(r->vertices->pool, m),
			"extensions");
		if (extensions && nt_json_type_of(extensions) != NT_JSON_OBJECT)
			r->obstacle = "its extensions are no object";
		for (size_t i = 0; !r->obstacle && i < nt_json_count(extensions); i++)
			r->outside |= strcmp(nt_json_key(extensions, i, NULL), "KHR_materials_variants") != 0;
	}
	return NT_OK;
}

/* ---- taking out ---- */

/* An accessor loses its view, but not its elements: what reads the output back will ask for them. */
static void detach(const nt_gltf_recoding *r, uint64_t index)
{
	nt_gltf_accessor *accessor = &r->document->accessors[index];
	const unsigned char *elements = NULL;
	nt_error ignored;
	nt_json_value *json = nt_gltf_accessor_json(r->document, index);
	nt_edits_leave_accessor(r->edits, (uint32_t)index);
	nt_json_remove(r->json, json, "bufferView");
	nt_json_remove(r->json, json, "byteOffset");
	if (nt_gltf_elements(r->document, accessor, &elements, &ignored) == NT_OK)
		accessor->decoded = elements;
	accessor->view = NT_NONE;
}

static void put_extension(nt_gltf_recoding *r)
{
	nt_json *json = r->json;
	nt_json_value *extensions = nt_json_put(json, r->primitive, "extensions");
	r->extension = nt_json_put(json, extensions, "KHR_draco_mesh_compression");
	nt_json_put_uint64(json, r->extension, "bufferView", 0);
	nt_json_set_object(json, nt_json_put(json, r->extension, "attributes"));
	nt_gltf_list_extension(r->document, "extensionsUsed", "KHR_draco_mesh_compression");
	nt_gltf_list_extension(r->document, "extensionsRequired", "KHR_draco_mesh_compression");
}

void nt_gltf_draco_take_out(nt_gltf_recoding *r)
{
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	uint64_t index;
	for (size_t i = 0; i < r->attribute_count; i++)
		if (nt_json_find_uint64(attributes, r->names[i], &index))
			detach(r, index);
	if (nt_json_find_uint64(r->primitive, "indices", &index))
		detach(r, index);
	put_extension(r);
}

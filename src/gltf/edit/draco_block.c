/* SPDX-License-Identifier: MIT */
/*
 * A Draco block: what goes into it, and the view and JSON that it gets.
 */
#include "gltf/edit/draco.h"

#include <string.h>
#include "gltf/document.h"
#include "gltf/edit/pool_edit.h"

/* ---- what goes into it ---- */

bool nt_gltf_draco_owns_indices(const nt_gltf_recoding *r, uint64_t accessor)
{
	if (accessor >= r->document->accessor_count)
		return false;
	const nt_gltf_users *users = nt_gltf_users_of(r->document, (uint32_t)accessor);
	return !users->attributes && users->indices == r->vertices->pool->user_count;
}

void nt_gltf_draco_add(nt_gltf_recoding *r, const char *name, nt_draco_attribute attribute)
{
	r->names[r->attribute_count] = name;
	r->attributes[r->attribute_count++] = attribute;
}

/* An attribute of ours: takes the place and the id of one of that name, else it gets an id that is free. */
static void put_floats(nt_gltf_recoding *r, const char *name, nt_draco_kind kind, int components,
	const float *elements, nt_draco_quantization grid)
{
	nt_draco_attribute attribute = {.kind = kind,
		.component_type = NT_GLTF_FLOAT, .components = components,
		.quantization = grid, .data = elements};
	for (size_t i = 0; i < r->attribute_count; i++) {
		const uint32_t id = r->attributes[i].unique_id;
		if (strcmp(r->names[i], name) == 0) {
			attribute.unique_id = id;
			r->attributes[i] = attribute;
			return;
		}
		attribute.unique_id = id >= attribute.unique_id ? id + 1 : attribute.unique_id;
	}
	nt_gltf_draco_add(r, name, attribute);
}

nt_status nt_gltf_draco_gather_block(nt_gltf_recoding *r, nt_error *error)
{
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	r->attributes = nt_arena_alloc(r->arena, nt_json_count(ids) + NT_GLTF_OWN_ATTRIBUTES,
		sizeof *r->attributes);
	r->names = nt_arena_alloc(r->arena, nt_json_count(ids) + NT_GLTF_OWN_ATTRIBUTES,
		sizeof *r->names);
	if (!r->attributes || !r->names)
		return nt_fail_memory(error);
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		uint64_t id = 0;
		nt_json_get_uint64(nt_json_at(ids, i), &id);
		nt_draco_attribute attribute = *nt_draco_find(r->source, (uint32_t)id);
		attribute.quantization.explicit_box = attribute.quantization.bits > 0;
		attribute.copied = r->vertices->sources;
		attribute.own_count = r->vertices->own_count;
		nt_gltf_draco_add(r, nt_json_key(ids, i, NULL), attribute);
	}
	return NT_OK;
}

void nt_gltf_draco_add_own(nt_gltf_recoding *r)
{
	const nt_pool_vertices *vertices = r->vertices;
	const int *bits = r->options->draco_bits;
	if (vertices->sets[0].normals)
		put_floats(r, "NORMAL", NT_DRACO_NORMAL, 3, vertices->sets[0].normals,
			(nt_draco_quantization){.bits = nt_gltf_draco_bits(bits, NT_DRACO_BITS_NORMAL)});
	put_floats(r, "TANGENT", NT_DRACO_GENERIC, 4, vertices->sets[0].tangents,
		nt_gltf_draco_tangent_grid(nt_gltf_draco_tangents_of(r->document, r->primitive), bits));
	if (r->options->bitangents)
		put_floats(r, "_BITANGENT", NT_DRACO_GENERIC, 3, NULL,
			(nt_draco_quantization){.bits = nt_gltf_draco_bits(bits, NT_DRACO_BITS_TANGENT)});
}

/* ---- in the document ---- */

/* All elements of the accessor are in the block. */
static void set_count(nt_gltf *document, uint64_t accessor, size_t count)
{
	nt_json_value *json = nt_gltf_accessor_json(document, accessor);
	nt_json_remove(document->json, json, "sparse");
	nt_json_put_uint64(document->json, json, "count", count);
}

void nt_gltf_draco_describe(nt_gltf_recoding *r)
{
	nt_json *json = r->json;
	const nt_draco_block *block = &r->block;
	nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	for (size_t i = 0; i < r->attribute_count; i++) {
		const nt_draco_attribute *a = &r->attributes[i];
		uint64_t accessor;
		if (nt_json_find_uint64(attributes, r->names[i], &accessor)) {
			set_count(r->document, accessor, block->point_count);
			nt_gltf_state_bounds(json, nt_gltf_accessor_json(r->document, accessor),
				(size_t)a->components, block->bounds[i]);
		} else {
			nt_json_put_uint64(json, attributes, r->names[i],
				nt_gltf_new_accessor(json, NT_NONE, NT_GLTF_FLOAT,
					a->components == 3 ? "VEC3" : "VEC4", block->point_count, false));
		}
		nt_json_put_uint64(json, nt_json_put(json, r->extension, "attributes"), r->names[i], a->unique_id);
	}
	uint64_t indices, type = 0;
	if (!nt_json_find_uint64(r->primitive, "indices", &indices)) {
		indices = nt_gltf_new_accessor(json, NT_NONE, NT_GLTF_UINT, "SCALAR", 0, false);
		nt_json_put_uint64(json, r->primitive, "indices", indices);
		r->extension = nt_gltf_draco_of(r->primitive); /* members have moved */
	}
	set_count(r->document, indices, block->face_count * 3);
	nt_json_value *accessor = nt_gltf_accessor_json(r->document, indices);
	nt_json_find_uint64(accessor, "componentType", &type);
	const uint32_t wide = nt_gltf_index_type(block->point_count, (uint32_t)type);
	if (wide != type)
		nt_json_put_uint64(json, accessor, "componentType", wide);
	nt_json_remove(json, accessor, "min");
	nt_json_remove(json, accessor, "max");
}

bool nt_gltf_draco_release(nt_gltf *document, uint64_t view, size_t count)
{
	document->view_users[view].blocks -= (uint32_t)count;
	return document->view_users[view].blocks == 0;
}

nt_status nt_gltf_draco_store(nt_gltf_recoding *r, uint32_t buffer, nt_error *error)
{
	unsigned char *bytes = r->block.bytes;
	r->block.bytes = NULL;
	if (!nt_arena_adopt(&r->edits->arena, bytes))
		return nt_fail_memory(error);
	nt_gltf_view view;
	nt_status status = r->source ? nt_gltf_get_view(r->document, r->view, "", &view, error) : NT_OK;
	if (status)
		return status;
	if (r->source && nt_gltf_draco_release(r->document, r->view, r->vertices->pool->user_count) &&
		nt_byte_users_count(&r->edits->users, view.buffer, view.offset + NT_DRACO_HEAD,
			view.offset + view.length) == 1)
		return nt_edits_replace(r->edits, view.buffer, view.offset, view.length, bytes, r->block.size, error);
	uint32_t number;
	status = nt_edits_add_view(r->edits, buffer, bytes, r->block.size, 0, 0, &number, error);
	nt_json_put_uint64(r->json, r->extension, "bufferView", number);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * Indices of primitives whose vertices were split. The accessor keeps its number and, while the numbers
 * still fit, its component type (the largest value of a type is reserved). Strips and fans whose
 * triangles changed become lists; primitives without indices get some.
 */
#include "gltf/edit/indices.h"

#include <stdio.h>
#include <string.h>
#include "base/largest.h"
#include "gltf/accessor.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/primitive.h"
#include "gltf/view.h"

/* New indices of one primitive, encoded. */
typedef struct encoded {
	const unsigned char *bytes;
	size_t size, count;
	uint32_t type, width;
} encoded;

/* The narrowest type that is not below `least` and holds the numbers. */
static uint32_t choose_type(uint32_t highest, uint32_t least)
{
	if (least == NT_GLTF_UBYTE && highest < 0xFF)
		return NT_GLTF_UBYTE;
	return least != NT_GLTF_UINT && highest < 0xFFFF ? NT_GLTF_USHORT : NT_GLTF_UINT;
}

static void store_index(unsigned char *bytes, uint32_t value, uint32_t width)
{
	for (uint32_t i = 0; i < width; i++)
		bytes[i] = (unsigned char)(value >> 8 * i);
}

/* Indices that form no triangle, at the end of a list, stay. */
static size_t tail_of(const nt_mesh *mesh, uint64_t mode, uint64_t old_count)
{
	const size_t tail = (size_t)(old_count - mesh->corner_count);
	return mode == NT_GLTF_TRIANGLES && old_count > mesh->corner_count && tail < 3 &&
			mesh->indices ? tail : 0;
}

static nt_status encode(nt_gltf_patcher *p, const nt_mesh *mesh, const uint32_t *indices, size_t tail,
	uint32_t least, encoded *out)
{
	uint32_t highest = nt_largest(indices, mesh->corner_count, 1);
	out->count = mesh->corner_count + tail;
	for (size_t c = mesh->corner_count; c < out->count; c++)
		highest = mesh->indices[c] > highest ? mesh->indices[c] : highest;
	out->type = choose_type(highest, least);
	out->width = nt_gltf_component_bytes(out->type);
	out->size = out->count * out->width;
	/* they live as long as the scene: nothing to be encoded */
	if (out->width == sizeof *indices && tail == 0 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) {
		out->bytes = (const unsigned char *)indices;
		return NT_OK;
	}
	unsigned char *bytes = nt_arena_alloc(p->arena, out->count, out->width);
	if (!bytes)
		return nt_fail_memory(p->error);
	for (size_t c = 0; c < out->count; c++)
		store_index(bytes + c * out->width,
			c < mesh->corner_count ? indices[c] : mesh->indices[c], out->width);
	out->bytes = bytes;
	return NT_OK;
}

/* A new accessor over a new view. */
static nt_status add_indices(nt_gltf_patcher *p, uint32_t buffer, const encoded *new,
	uint32_t *accessor)
{
	uint32_t view;
	const nt_status status = nt_edits_add_view(&p->edits, buffer, new->bytes, new->size,
		NT_GLTF_ELEMENT_ARRAY_BUFFER, 0, &view, p->error);
	if (!status)
		*accessor = nt_gltf_new_accessor(p, view, new->type, "SCALAR", new->count, false);
	return status;
}

/* Rewrites the accessor, all of whose users agree, where its bytes are its own; *done tells. */
static nt_status replace_indices(nt_gltf_patcher *p, const nt_gltf_accessor *old, const encoded *new,
	bool *done)
{
	*done = false;
	const uint32_t canonical = p->sharing.canonical[old->index];
	const uint32_t old_width = nt_gltf_component_bytes(old->component_type);
	if (old->view == NT_NONE || old->sparse_count || old->stride != old_width)
		return NT_OK;
	nt_gltf_view view;
	nt_status status = nt_gltf_get_view(p->document, old->view, "", &view, p->error);
	if (status)
		return status;
	/* A wider type wants its own alignment: zeros before it, if the view allows. */
	const uint64_t begin = view.offset + old->offset, size = old->count * old_width;
	const size_t pad = (size_t)((new->width - begin % new->width) % new->width);
	if (view.offset % new->width || pad >= size || view.compression)
		return NT_OK;
	const uint32_t mark = NT_NONE;
	const uint32_t kept = p->own[canonical];
	p->own[canonical] = mark;
	const bool foreign =
		nt_byte_users_foreign(&p->edits.users, view.buffer, begin, begin + size, p->own, mark);
	p->own[canonical] = kept;
	if (foreign)
		return NT_OK;
	const unsigned char *bytes = new->bytes;
	if (pad) {
		unsigned char *padded = nt_arena_alloc(p->arena, new->size + pad, 1);
		if (!padded)
			return nt_fail_memory(p->error);
		memset(padded, 0, pad);
		memcpy(padded + pad, new->bytes, new->size);
		bytes = padded;
	}
	nt_json_value *json = nt_json_at(nt_gltf_root_member(p->document, "accessors"), old->index);
	if (pad)
		nt_json_set_uint64(p->json, nt_json_put(p->json, json, "byteOffset"), old->offset + pad);
	if (new->type != old->component_type)
		nt_json_set_uint64(p->json, nt_json_put(p->json, json, "componentType"), new->type);
	if (new->count != old->count)
		nt_json_set_uint64(p->json, nt_json_put(p->json, json, "count"), new->count);
	nt_json_remove(p->json, json, "min");
	nt_json_remove(p->json, json, "max");
	*done = true;
	return nt_edits_replace(&p->edits, view.buffer, begin, size, bytes, new->size + pad, p->error);
}

/* Indices that were compressed get a view; the accessor stays. */
static nt_status give_view(nt_gltf_patcher *p, uint32_t buffer, const nt_gltf_accessor *old,
	const encoded *new, bool *done)
{
	*done = true;
	uint32_t view;
	const nt_status status = nt_edits_add_view(&p->edits, buffer, new->bytes, new->size,
		NT_GLTF_ELEMENT_ARRAY_BUFFER, 0, &view, p->error);
	nt_json_value *json = nt_json_at(nt_gltf_root_member(p->document, "accessors"), old->index);
	nt_json_set_uint64(p->json, nt_json_put(p->json, json, "bufferView"), view);
	nt_json_remove(p->json, json, "byteOffset");
	nt_json_set_uint64(p->json, nt_json_put(p->json, json, "componentType"), new->type);
	nt_json_set_uint64(p->json, nt_json_put(p->json, json, "count"), new->count);
	nt_json_remove(p->json, json, "min");
	nt_json_remove(p->json, json, "max");
	return status;
}

/* A member's new indices, to be found by members with the same ones. */
typedef struct written {
	uint32_t index;        /* the accessor of the source; NT_NONE: there was none */
	uint32_t old_accessor; /* that, canonical */
	uint32_t accessor;     /* the one in the output; NT_NONE: not yet */
} written;

static bool equal_indices(const nt_gltf_patcher *p, const nt_gltf_cluster *component, size_t a, size_t b)
{
	const nt_mesh *x = &p->scene->meshes[component->members[a]];
	const nt_mesh *y = &p->scene->meshes[component->members[b]];
	const uint32_t *of_x = component->rows.indices[a], *of_y = component->rows.indices[b];
	return x->corner_count == y->corner_count &&
		(of_x == of_y || memcmp(of_x, of_y, x->corner_count * sizeof *of_x) == 0);
}

/* Whether everybody who uses a member's indices will have the same new ones. */
static bool all_users_agree(const nt_gltf_patcher *p, const nt_gltf_cluster *component, size_t member,
	const written *log)
{
	if (log[member].index == NT_NONE)
		return false;
	const uint32_t users = p->sharing.index_users[log[member].old_accessor];
	uint32_t agreeing = 1;
	for (size_t i = 0; users > 1 && i < component->member_count; i++)
		agreeing += i != member && component->rows.changed[i] && log[i].index == log[member].index &&
			equal_indices(p, component, i, member);
	return agreeing == users;
}

static nt_status patch_member(nt_gltf_patcher *p, const nt_gltf_cluster *component, size_t member,
	written *log)
{
	const nt_mesh *mesh = &p->scene->meshes[component->members[member]];
	nt_json_value *primitive = nt_gltf_primitive_of(p->document, mesh);
	const uint32_t index = log[member].index;
	uint64_t mode = NT_GLTF_TRIANGLES, type;
	nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
	nt_gltf_accessor old = {.count = mesh->source_vertex_count, .component_type = NT_GLTF_UBYTE};
	nt_status status = NT_OK;
	if (index != NT_NONE)
		status = nt_gltf_get_accessor(p->document, index, mesh->place.pointer, &old, p->error);
	if (status)
		return status;
	/* What Draco gave has 32 bits; the accessor may say less. */
	if (old.decoded && nt_json_get_uint64(nt_json_find(nt_json_at(
		nt_gltf_root_member(p->document, "accessors"), index), "componentType"), &type))
		old.component_type = (uint32_t)type;
	if (index == NT_NONE)
		old.component_type = NT_GLTF_USHORT; /* the narrowest that all hardware likes */

	uint32_t accessor = NT_NONE;
	for (size_t i = 0; i < member && accessor == NT_NONE; i++)
		if (component->rows.changed[i] && log[i].accessor != NT_NONE &&
			log[i].old_accessor == log[member].old_accessor &&
			equal_indices(p, component, i, member))
			accessor = log[i].accessor;
	if (accessor == NT_NONE) {
		encoded new = {0};
		bool done = false;
		const bool own = all_users_agree(p, component, member, log);
		status = encode(p, mesh, component->rows.indices[member],
			tail_of(mesh, mode, old.count), old.component_type, &new);
		if (!status && own && old.decoded)
			status = give_view(p, component->buffer, &old, &new, &done);
		else if (!status && own)
			status = replace_indices(p, &old, &new, &done);
		accessor = index;
		if (!status && !done)
			status = add_indices(p, component->buffer, &new, &accessor);
	}
	if (status)
		return status;
	log[member].accessor = accessor;
	if (accessor != index)
		nt_json_set_uint64(p->json, nt_json_put(p->json, primitive, "indices"), accessor);
	if (mode != NT_GLTF_TRIANGLES)
		nt_json_set_uint64(p->json, nt_json_put(p->json, primitive, "mode"), NT_GLTF_TRIANGLES);
	return NT_OK;
}

nt_status nt_gltf_patch_indices(nt_gltf_patcher *p, const nt_gltf_cluster *component)
{
	written *log = nt_arena_alloc(p->arena, component->member_count, sizeof *log);
	if (!log)
		return nt_fail_memory(p->error);
	nt_status status = NT_OK;
	for (size_t i = 0; i < component->member_count; i++) {
		const nt_json_value *primitive = nt_gltf_primitive_of(p->document,
			&p->scene->meshes[component->members[i]]);
		uint64_t index;
		log[i] = (written){NT_NONE, NT_NONE, NT_NONE};
		if (component->rows.changed[i] &&
			nt_json_get_uint64(nt_json_find(primitive, "indices"), &index) &&
			index < p->sharing.accessor_count) {
			log[i].index = (uint32_t)index;
			log[i].old_accessor = p->sharing.canonical[index];
		}
	}
	for (size_t i = 0; !status && i < component->member_count; i++)
		if (component->rows.changed[i])
			status = patch_member(p, component, i, log);
	return status;
}

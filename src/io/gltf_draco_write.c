/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents; with an explicit --draco, plain ones that shall be compressed.
 *
 * The block is encoded again with the copied rows and TANGENT among the attributes. Attributes keep the
 * source's quantization, origin and range, so that they decode to the values they had. Where attributes
 * lie outside of the block (morph targets, joints in some files) or faces are degenerate, order matters
 * and the sequential method is taken. Where compressing again would lose something (the encoder drops
 * vertices that no face uses, and rows outside of the block would no longer fit), where primitives share
 * accessors but not all else, or where it is not wanted, the primitive is written plain.
 */
#include "io/gltf_draco_block.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/gltf_new_accessors.h"
#include "io/gltf_view.h"

bool nt_gltf_has_draco(const nt_gltf_patcher *p, const nt_gltf_cluster *component)
{
	for (size_t i = 0; i < component->member_count; i++)
		if (component->rows.group_of[i] != NT_NONE &&
			nt_gltf_draco_of(nt_gltf_primitive_of(p->document,
				&p->scene->meshes[component->members[i]])))
			return true;
	return false;
}

void nt_gltf_drop_draco(nt_gltf_patcher *p)
{
	if (!p->document->draco_blocks)
		return;
	for (size_t i = 0; i < p->scene->mesh_count; i++)
		if (nt_gltf_draco_of(nt_gltf_primitive_of(p->document, &p->scene->meshes[i])))
			return;
	nt_gltf_remove_extension(p->document, "extensionsRequired", "KHR_draco_mesh_compression");
	nt_gltf_remove_extension(p->document, "extensionsUsed", "KHR_draco_mesh_compression");
}

/* So many primitives do not refer to a block any more. Whether nobody does. */
static bool release_block(nt_gltf_patcher *p, uint64_t view, size_t count)
{
	p->sharing.block_users[view] -= (uint32_t)count;
	return p->sharing.block_users[view] == 0;
}

/* ---- plain ---- */

/* Takes the extension off a primitive, and its block out of the buffer. The view takes some of the rows. */
static nt_status make_plain(nt_gltf_patcher *p, nt_gltf_cluster *component, size_t member)
{
	nt_json_value *primitive = nt_gltf_primitive_of(p->document,
		&p->scene->meshes[component->members[member]]);
	nt_json_value *extensions = nt_json_find(primitive, "extensions");
	uint64_t index;
	nt_gltf_view view;
	nt_status status = NT_OK;
	if (nt_json_get_uint64(nt_json_find(nt_gltf_draco_of(primitive), "bufferView"), &index) &&
		nt_gltf_get_view(p->document, index, "", &view, NULL) == NT_OK &&
		release_block(p, index, 1))
		status = nt_layout_vacate(&p->layout, (uint32_t)index, 0, view.length, p->error);
	nt_json_remove(p->json, extensions, "KHR_draco_mesh_compression");
	if (nt_json_count(extensions) == 0)
		nt_json_remove(p->json, primitive, "extensions");
	component->rows.changed[member] = true;
	return status;
}

static nt_status make_all_plain(nt_gltf_patcher *p, nt_gltf_cluster *component)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < component->member_count; i++)
		if (component->rows.group_of[i] != NT_NONE &&
			nt_gltf_draco_of(nt_gltf_primitive_of(p->document,
				&p->scene->meshes[component->members[i]])))
			status = make_plain(p, component, i);
	return status;
}

/* ---- compressed again ---- */

static nt_status note_outside(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor)
{
	nt_gltf_recoding *r = context;
	(void)accessor;
	const bool base = attributes == nt_json_find(r->primitive, "attributes");
	if (!base || !nt_json_find(nt_json_find(r->extension, "attributes"), name))
		r->outside = true;
	return NT_OK;
}

/* Whether every compressed accessor is used by the component alone and has no uncompressed twin. */
static bool accessors_are_own(const nt_gltf_recoding *r)
{
	const nt_gltf_patcher *p = r->patcher;
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	const nt_json_value *accessors = nt_gltf_root_member(p->document, "accessors");
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		uint64_t accessor;
		if (!nt_json_get_uint64(nt_json_find(attributes, nt_json_key(ids, i, NULL)), &accessor) ||
			p->sharing.foreign[p->sharing.canonical[accessor]] ||
			nt_json_find(nt_json_at(accessors, (size_t)accessor), "bufferView"))
			return false;
	}
	uint64_t indices;
	return nt_json_get_uint64(nt_json_find(r->primitive, "indices"), &indices) &&
		p->sharing.index_users[p->sharing.canonical[indices]] == r->component->member_count &&
		!nt_json_find(nt_json_at(accessors, (size_t)indices), "bufferView");
}

/* Rows of a decoded attribute with their copies. */
static nt_status copy_attribute(nt_gltf_recoding *r, const nt_draco_attribute *from, const void **rows)
{
	nt_gltf_patcher *p = r->patcher;
	const nt_gltf_rows *all = &r->component->rows;
	const size_t width = nt_draco_component_size(from->component_type) * (size_t)from->components;
	unsigned char *out = nt_arena_alloc(p->arena, all->new_count, width);
	if (!out)
		return nt_fail_memory(p->error);
	memcpy(out, from->data, all->old_count * width);
	for (size_t row = all->old_count; row < all->new_count; row++)
		memcpy(out + row * width,
			(const unsigned char *)from->data + all->sources[row - all->old_count] * width, width);
	*rows = out;
	return NT_OK;
}

int nt_gltf_draco_bits(const nt_write_options *options, nt_draco_bits which)
{
	static const int defaults[NT_DRACO_BITS_COUNT] = {14, 12, 12, 12};
	return options->draco_bits[which] ? options->draco_bits[which] : defaults[which];
}

void nt_gltf_draco_add(nt_gltf_recoding *r, const char *name, nt_draco_attribute attribute)
{
	r->names[r->attribute_count] = name;
	r->attributes[r->attribute_count++] = attribute;
}

static uint32_t free_id(const nt_gltf_recoding *r)
{
	uint32_t id = 0;
	for (size_t i = 0; i < r->attribute_count; i++)
		if (r->attributes[i].unique_id >= id)
			id = r->attributes[i].unique_id + 1;
	return id;
}

/* An attribute of ours: takes the place of one of that name. */
static void put_floats(nt_gltf_recoding *r, const char *name, nt_draco_kind kind, int components,
	const float *rows, int bits)
{
	const nt_draco_attribute attribute = {.unique_id = free_id(r), .kind = kind,
		.component_type = NT_GLTF_FLOAT, .components = components,
		.quantization = {.bits = bits}, .data = rows};
	for (size_t i = 0; i < r->attribute_count; i++)
		if (strcmp(r->names[i], name) == 0) {
			const uint32_t id = r->attributes[i].unique_id;
			r->attributes[i] = attribute;
			r->attributes[i].unique_id = id;
			return;
		}
	nt_gltf_draco_add(r, name, attribute);
}

/* What the source's block has, as it is. */
static nt_status gather_block(nt_gltf_recoding *r)
{
	nt_gltf_patcher *p = r->patcher;
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	r->attributes = nt_arena_alloc(p->arena, nt_json_count(ids) + NT_GLTF_OWN_ATTRIBUTES,
		sizeof *r->attributes);
	r->names = nt_arena_alloc(p->arena, nt_json_count(ids) + NT_GLTF_OWN_ATTRIBUTES,
		sizeof *r->names);
	if (!r->attributes || !r->names)
		return nt_fail_memory(p->error);
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < nt_json_count(ids); i++) {
		uint64_t id = 0;
		nt_json_get_uint64(nt_json_at(ids, i), &id);
		nt_draco_attribute copy = *nt_draco_find(r->source, (uint32_t)id);
		copy.quantization.explicit_box = copy.quantization.bits > 0;
		copy.stride_bytes = 0;
		status = copy_attribute(r, nt_draco_find(r->source, (uint32_t)id), &copy.data);
		nt_gltf_draco_add(r, nt_json_key(ids, i, NULL), copy);
	}
	return status;
}

/* What nmtan made. */
static nt_status add_own_attributes(nt_gltf_recoding *r)
{
	nt_gltf_patcher *p = r->patcher;
	const nt_gltf_rows *rows = &r->component->rows;
	const int bits = nt_gltf_draco_bits(p->options, NT_DRACO_BITS_TANGENT);
	nt_status status = NT_OK;
	if (rows->normals[0])
		put_floats(r, "NORMAL", NT_DRACO_NORMAL, 3, rows->normals[0],
			nt_gltf_draco_bits(p->options, NT_DRACO_BITS_NORMAL));
	put_floats(r, "TANGENT", NT_DRACO_GENERIC, 4, rows->tangents[0], bits);
	if (p->options->bitangents) {
		float *bitangents;
		status = nt_gltf_bitangents(p, r->component, 0, &bitangents);
		if (!status)
			put_floats(r, "_BITANGENT", NT_DRACO_GENERIC, 3, bitangents, bits);
	}
	return status;
}

/* Whether edgebreaker would drop a face: two corners at one position. */
static bool has_degenerate_face(const nt_gltf_recoding *r)
{
	const uint32_t *indices = r->component->rows.indices[0];
	for (size_t c = 0; c + 2 < r->mesh->corner_count; c += 3)
		for (size_t k = 0; k < 3; k++) {
			const size_t a = indices[c + k], b = indices[c + (k + 1) % 3];
			const nt_gltf_rows *rows = &r->component->rows;
			const size_t x = a < rows->old_count ? a : rows->sources[a - rows->old_count];
			const size_t y = b < rows->old_count ? b : rows->sources[b - rows->old_count];
			if (memcmp(r->mesh->positions + 3 * x, r->mesh->positions + 3 * y,
				3 * sizeof(float)) == 0)
				return true;
		}
	return false;
}

/* Whether rows outside of the block still fit the points in it. */
static bool order_is_kept(const nt_gltf_recoding *r, const nt_draco_block *block)
{
	if (block->point_count != r->component->rows.new_count || !block->sources)
		return false;
	for (size_t i = 0; i < block->point_count; i++)
		if (block->sources[i] != i)
			return false;
	return true;
}

static void set_count(nt_gltf_patcher *p, uint64_t accessor, size_t count)
{
	nt_json_value *json =
		nt_json_at(nt_gltf_root_member(p->document, "accessors"), (size_t)accessor);
	nt_json_set_uint64(p->json, nt_json_put(p->json, json, "count"), count);
}

/* The JSON of the primitive follows what a decoder will see; new accessors have no view, their rows are in the
 * block. */
static void describe_block(nt_gltf_recoding *r, const nt_draco_block *block)
{
	nt_gltf_patcher *p = r->patcher;
	nt_json *json = p->json;
	nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	for (size_t i = 0; i < r->attribute_count; i++) {
		const nt_draco_attribute *a = &r->attributes[i];
		uint64_t accessor;
		if (nt_json_get_uint64(nt_json_find(attributes, r->names[i]), &accessor))
			set_count(p, accessor, block->point_count);
		else
			nt_json_set_uint64(json, nt_json_put(json, attributes, r->names[i]),
				nt_gltf_new_accessor(p, NT_NONE, NT_GLTF_FLOAT,
					a->components == 3 ? "VEC3" : "VEC4", block->point_count, false));
		nt_json_set_uint64(json, nt_json_put(json, nt_json_put(json, r->extension, "attributes"),
			r->names[i]), a->unique_id);
	}
	uint64_t indices, type = 0;
	if (!nt_json_get_uint64(nt_json_find(r->primitive, "indices"), &indices)) {
		indices = nt_gltf_new_accessor(p, NT_NONE, NT_GLTF_UINT, "SCALAR", 0, false);
		nt_json_set_uint64(json, nt_json_put(json, r->primitive, "indices"), indices);
		r->extension = nt_gltf_draco_of(r->primitive); /* members have moved */
	}
	set_count(p, indices, block->face_count * 3);
	nt_json_value *accessor =
		nt_json_at(nt_gltf_root_member(p->document, "accessors"), (size_t)indices);
	nt_json_get_uint64(nt_json_find(accessor, "componentType"), &type);
	const size_t limit = type == NT_GLTF_UBYTE ? 0xFF : type == NT_GLTF_USHORT ? 0xFFFF : SIZE_MAX;
	if (block->point_count > limit)
		nt_json_set_uint64(json, nt_json_put(json, accessor, "componentType"),
			block->point_count > 0xFFFF ? NT_GLTF_UINT : NT_GLTF_USHORT);
	nt_json_remove(json, accessor, "min");
	nt_json_remove(json, accessor, "max");
}

static nt_status store_block(nt_gltf_recoding *r, const nt_draco_block *block)
{
	nt_gltf_patcher *p = r->patcher;
	unsigned char *bytes = nt_arena_alloc(p->arena, block->size, 1);
	if (!bytes)
		return nt_fail_memory(p->error);
	memcpy(bytes, block->bytes, block->size);
	nt_gltf_view view;
	nt_status status = r->source ?
		nt_gltf_get_view(p->document, r->view, "", &view, p->error) : NT_OK;
	if (status)
		return status;
	if (r->source && release_block(p, r->view, r->component->member_count) &&
		nt_layout_users(&p->layout, view.buffer, view.offset, view.offset + view.length) == 1)
		return nt_layout_edit(&p->layout, view.buffer, view.offset, view.length, bytes,
			block->size, p->error);
	uint32_t number;
	status = nt_layout_add_view(&p->layout, r->component->buffer, bytes, block->size, 0, 0, &number,
		p->error);
	nt_json_set_uint64(p->json, nt_json_put(p->json, r->extension, "bufferView"), number);
	return status;
}

static nt_status encode(const nt_gltf_recoding *r, nt_draco_method method, nt_draco_block *block)
{
	const nt_draco_mesh mesh = {
		.method = method,
		.point_count = r->component->rows.new_count,
		.face_count = r->mesh->corner_count / 3,
		.indices = r->component->rows.indices[0],
		.attributes = r->attributes,
		.attribute_count = r->attribute_count,
	};
	nt_error ignored;
	return nt_draco_encode(&mesh, block, &ignored);
}

static nt_draco_method wanted_method(const nt_gltf_recoding *r)
{
	if (r->outside || has_degenerate_face(r) || r->patcher->options->draco == NT_DRACO_AS_SEQUENTIAL)
		return NT_DRACO_SEQUENTIAL;
	return r->patcher->options->draco == NT_DRACO_AS_EDGEBREAKER ? NT_DRACO_EDGEBREAKER :
								       r->source->method;
}

/* Encodes; *done false where the result would not do. */
static nt_status recode(nt_gltf_recoding *r, bool *done)
{
	nt_gltf_patcher *p = r->patcher;
	nt_status status = r->source ? gather_block(r) : NT_OK;
	if (!status)
		status = add_own_attributes(r);
	if (status)
		return status;
	/* Edgebreaker does not give every mesh back; the other method has nothing to lose. */
	const nt_draco_method method = wanted_method(r);
	nt_draco_block block = {0};
	status = encode(r, method, &block);
	if (status && status != NT_ERROR_MEMORY && method != NT_DRACO_SEQUENTIAL)
		status = encode(r, NT_DRACO_SEQUENTIAL, &block);
	if (status == NT_ERROR_MEMORY)
		return nt_fail_memory(p->error);
	if (status || (r->outside && !order_is_kept(r, &block))) {
		r->obstacle = status ? "Draco does not give it back"
				     : "no face uses some of its vertices, whose order matters";
		nt_draco_block_free(&block);
		return NT_OK; /* plain, then */
	}
	*done = true;
	status = r->source ? NT_OK : nt_gltf_draco_take_out(r, &block);
	if (!status && r->outside && r->component->rows.new_count > r->component->rows.old_count)
		status = nt_gltf_grow_attributes(p, r->component, NULL, 0, false);
	if (!status) {
		describe_block(r, &block);
		status = store_block(r, &block);
	}
	if (!status)
		status = nt_gltf_add_morphs(p, r->component, 0);
	nt_draco_block_free(&block);
	return status;
}

static nt_json_value *member_primitive(const nt_gltf_patcher *p, const nt_gltf_cluster *component,
	size_t member)
{
	return nt_gltf_primitive_of(p->document, &p->scene->meshes[component->members[member]]);
}

/* Whether the component is one primitive, perhaps several times: with the same geometry and the same
 * accessors, so that one block serves them all. */
static bool is_one_primitive(const nt_gltf_patcher *p, const nt_gltf_cluster *component)
{
	const nt_json_value *first = member_primitive(p, component, 0);
	for (size_t i = 1; i < component->member_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[component->members[i]];
		const nt_json_value *other = member_primitive(p, component, i);
		if (mesh->same_as != &p->scene->meshes[component->members[0]] ||
			!nt_json_equal(nt_gltf_draco_of(first), nt_gltf_draco_of(other)))
			return false;
		static const char *const members[] = {"attributes", "targets", "indices"};
		for (size_t k = 0; k < 3; k++)
			if (!nt_json_equal(nt_json_find(first, members[k]), nt_json_find(other, members[k])))
				return false;
	}
	return true;
}

/* The other members refer to what the first one now does. */
static void share_block(nt_gltf_recoding *r)
{
	nt_json *json = r->patcher->json;
	static const char *const members[] = {"attributes", "targets", "indices"};
	for (size_t i = 1; i < r->component->member_count; i++) {
		nt_json_value *other = member_primitive(r->patcher, r->component, i);
		for (size_t k = 0; k < 3; k++)
			if (nt_json_find(r->primitive, members[k]))
				nt_json_set_copy(json, nt_json_put(json, other, members[k]),
					nt_json_find(r->primitive, members[k]));
		nt_json_set_copy(json, nt_json_put(json, nt_json_put(json, other, "extensions"),
			"KHR_draco_mesh_compression"), nt_gltf_draco_of(r->primitive));
	}
}

/* What the user asked for and does not get. */
static void report_members(const nt_gltf_recoding *r, bool compressed)
{
	const nt_gltf_patcher *p = r->patcher;
	nt_finding_list *findings = &p->scene->findings;
	for (size_t i = 0; i < r->component->member_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[r->component->members[i]];
		if (r->component->rows.group_of[i] == NT_NONE)
			continue;
		const bool wanted = p->options->draco > NT_DRACO_OFF ||
			nt_gltf_draco_of(member_primitive(p, r->component, i));
		if (!compressed && wanted)
			nt_finding_add(findings, NT_CODE_DRACO_PLAIN, &mesh->place, 1, "%s", r->obstacle);
		else if (compressed && p->options->precision != NT_PRECISION_FLOAT)
			nt_finding_add(findings, NT_CODE_DRACO_PRECISION, &mesh->place, 1, "%d bits",
				nt_gltf_draco_bits(p->options, NT_DRACO_BITS_TANGENT));
	}
}

nt_status nt_gltf_patch_draco(nt_gltf_patcher *p, nt_gltf_cluster *component, bool *done)
{
	*done = false;
	if (p->options->draco == NT_DRACO_OFF)
		return make_all_plain(p, component);
	nt_gltf_recoding r = {.patcher = p, .component = component,
		.mesh = &p->scene->meshes[component->members[0]]};
	r.primitive = nt_gltf_primitive_of(p->document, r.mesh);
	r.extension = nt_gltf_draco_of(r.primitive);
	nt_status status = NT_OK;
	if (!is_one_primitive(p, component)) {
		r.obstacle = "it shares vertices with other primitives";
	} else if (!r.extension) {
		status = nt_gltf_draco_gather_plain(&r);
	} else if (!accessors_are_own(&r) ||
		!nt_json_get_uint64(nt_json_find(r.extension, "bufferView"), &r.view)) {
		r.obstacle = "something else uses its accessors";
	} else {
		r.source = nt_gltf_draco_block(p->document, r.view);
		nt_gltf_visit_attributes(r.primitive, p->sharing.accessor_count, note_outside, &r);
	}
	if (!status && !r.obstacle)
		status = recode(&r, done);
	if (status)
		return status;
	if (*done)
		share_block(&r);
	report_members(&r, *done);
	return *done ? NT_OK : make_all_plain(p, component);
}

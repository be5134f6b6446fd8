/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents; with an explicit --draco, plain ones that shall be compressed.
 *
 * The block is encoded again with the copied vertices and TANGENT among the attributes. Attributes keep the
 * source's quantization, origin and range, so that they decode to the values they had. If attributes lie outside of
 * the block (morph targets, joints in some files) or faces are degenerate, order matters and the sequential method is
 * taken. If compressing again would lose something (the encoder drops vertices that no face uses, and elements
 * outside of the block would no longer fit), where primitives share accessors but not all else, or where it is not
 * wanted, the primitive is written plain.
 */
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/quantize.h"

/* Whether a user has tangents to be written and is compressed. */
static bool is_compressed(const nt_vertex_pool *pool, size_t user)
{
	return nt_pool_is_solved(pool, user) && nt_gltf_draco_of(nt_pool_primitive(pool, user));
}

bool nt_gltf_has_draco(const nt_vertex_pool *pool)
{
	for (size_t i = 0; i < pool->user_count; i++)
		if (is_compressed(pool, i))
			return true;
	return false;
}

/* ---- plain ---- */

/* So many primitives do not refer to a block any more. Whether nobody does. */
static bool release_block(nt_gltf *document, uint64_t view, size_t count)
{
	document->view_users[view].blocks -= (uint32_t)count;
	return document->view_users[view].blocks == 0;
}

/* Takes the extension off a primitive, and its block out of the buffer. The view takes some of the elements. */
static void make_plain(nt_buffer_edits *edits, nt_json_value *primitive)
{
	nt_gltf *document = edits->document;
	uint64_t index;
	if (nt_json_find_uint64(nt_gltf_draco_of(primitive), "bufferView", &index) && index < edits->view_count &&
		release_block(document, index, 1))
		nt_edits_leave(edits, (uint32_t)index, 0);
	nt_gltf_drop_extension(document->json, primitive, "KHR_draco_mesh_compression");
}

void nt_gltf_draco_make_plain(nt_buffer_edits *edits, nt_pool_vertices *vertices)
{
	for (size_t i = 0; i < vertices->pool->user_count; i++) {
		if (!is_compressed(vertices->pool, i))
			continue;
		make_plain(edits, nt_pool_primitive(vertices->pool, i));
		vertices->users[i].changed = true;
	}
}

/* ---- a block ---- */

/* An attribute of ours: takes the place of one of that name, and its id if no other has it, else one that is free. */
static void put_floats(nt_gltf_recoding *r, const char *name, nt_draco_kind kind, int components,
	const float *elements, nt_draco_quantization grid)
{
	nt_draco_attribute attribute = {.kind = kind,
		.component_type = NT_GLTF_FLOAT, .components = components,
		.quantization = grid, .data = elements};
	const size_t count = r->attribute_count;
	size_t place = 0, same_id = 0;
	while (place < count && strcmp(r->names[place], name) != 0)
		place++;
	for (size_t i = 0; i < count; i++) {
		const uint32_t id = r->attributes[i].unique_id;
		same_id += place < count && id == r->attributes[place].unique_id;
		attribute.unique_id = id >= attribute.unique_id ? id + 1 : attribute.unique_id;
	}
	if (same_id == 1)
		attribute.unique_id = r->attributes[place].unique_id;
	if (place < count)
		r->attributes[place] = attribute;
	else
		nt_gltf_draco_add(r, name, attribute);
}

/* The attributes of the primitive's block, as they are. */
static nt_status gather_block(nt_gltf_recoding *r, nt_error *error)
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

/* Attributes that nmtan made: NORMAL where it did, TANGENT, _BITANGENT where asked for. */
static nt_status add_own(nt_gltf_recoding *r, nt_error *error)
{
	const nt_pool_vertices *vertices = r->vertices;
	const int *bits = r->options->draco_bits;
	float *bitangents;
	if (vertices->sets[0].normals)
		put_floats(r, "NORMAL", NT_DRACO_NORMAL, 3, vertices->sets[0].normals,
			(nt_draco_quantization){.bits = nt_gltf_draco_bits(bits, NT_DRACO_BITS_NORMAL)});
	put_floats(r, "TANGENT", NT_DRACO_GENERIC, 4, vertices->sets[0].tangents,
		nt_gltf_draco_tangent_grid(nt_gltf_draco_tangents_of(r->document, r->primitive), bits));
	if (!r->options->bitangents)
		return NT_OK;
	const nt_status status = nt_gltf_bitangents(vertices, 0, r->arena, &bitangents, error);
	if (!status)
		put_floats(r, "_BITANGENT", NT_DRACO_GENERIC, 3, bitangents,
			(nt_draco_quantization){.bits = nt_gltf_draco_bits(bits, NT_DRACO_BITS_TANGENT)});
	return status;
}

/* ---- its JSON ---- */

/* Directions are VEC3, tangents VEC4. */
static const char *type_name(const nt_draco_attribute *a)
{
	return a->components == 3 ? "VEC3" : "VEC4";
}

/* All elements of the accessor are in the block. */
static void set_count(nt_gltf *document, uint64_t accessor, size_t count)
{
	nt_json_value *json = nt_gltf_accessor_json(document, accessor);
	nt_json_remove(document->json, json, "sparse");
	nt_json_put_uint64(document->json, json, "count", count);
}

/* Floats of ours may take the place of integers, and of other vectors. */
static void set_type(nt_gltf *document, uint64_t accessor, const nt_draco_attribute *a)
{
	const nt_gltf_accessor *was = nt_gltf_sound_accessor(document, accessor);
	nt_json_value *json = nt_gltf_accessor_json(document, accessor);
	if (was && was->component_type == (uint32_t)a->component_type && was->components == (uint32_t)a->components)
		return;
	nt_json_put_uint64(document->json, json, "componentType", (uint64_t)a->component_type);
	nt_json_set_string(document->json, nt_json_put(document->json, json, "type"), type_name(a), 4);
	nt_json_remove(document->json, json, "normalized");
}

/* The JSON of the primitive follows what a decoder will see; new accessors have no view, their elements are in the
 * block. */
static void describe(nt_gltf_recoding *r)
{
	nt_json *json = r->json;
	const nt_draco_block *block = &r->block;
	nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	for (size_t i = 0; i < r->attribute_count; i++) {
		const nt_draco_attribute *a = &r->attributes[i];
		uint64_t accessor;
		if (nt_json_find_uint64(attributes, r->names[i], &accessor)) {
			set_count(r->document, accessor, block->point_count);
			set_type(r->document, accessor, a);
			nt_gltf_state_bounds(json, nt_gltf_accessor_json(r->document, accessor),
				(size_t)a->components, block->bounds[i]);
		} else {
			nt_json_put_uint64(json, attributes, r->names[i],
				nt_gltf_new_accessor(json, NT_NONE, NT_GLTF_FLOAT,
					type_name(a), block->point_count, false));
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

/* Puts the block where the primitive's was, else into a new view of `buffer`. */
static nt_status store_block(nt_gltf_recoding *r, uint32_t buffer, nt_error *error)
{
	unsigned char *bytes = r->block.bytes;
	r->block.bytes = NULL;
	if (!nt_arena_adopt(&r->edits->arena, bytes))
		return nt_fail_memory(error);
	const nt_gltf_view *view = r->source ? nt_gltf_sound_view(r->document, r->view) : NULL;
	nt_segment *segment = view ? nt_segment_at(r->edits, view->buffer, view->offset) : NULL;
	if (segment && release_block(r->document, r->view, r->vertices->pool->user_count) &&
		nt_segment_is(segment, view->offset, view->length)) {
		nt_segment_edit(r->edits, segment, (nt_segment_change){.bytes = bytes, .size = r->block.size});
		return NT_OK;
	}
	uint32_t number;
	const nt_status status = nt_edits_add_view(r->edits, buffer, bytes, r->block.size, 0, 0, &number, error);
	nt_json_put_uint64(r->json, r->extension, "bufferView", number);
	return status;
}

/* ---- compressed again ---- */

/* Whether something of a compressed primitive is not in its block. */
static bool has_outside(const nt_gltf_recoding *r)
{
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	for (nt_gltf_use u = {0}; nt_gltf_next_use(r->document, r->primitive, &u);)
		if (u.object || !nt_json_find(ids, u.name))
			return true;
	return nt_vertices_are_ids(r->primitive);
}

/* Whether every compressed accessor is used by the pool alone and has no uncompressed twin. */
static bool accessors_are_own(const nt_gltf_recoding *r)
{
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	const nt_json_value *accessors = nt_gltf_root_member(r->document, "accessors");
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		const char *name = nt_json_key(ids, i, NULL);
		const uint32_t accessor = name ? nt_gltf_reference(r->document, attributes, name) : NT_NONE;
		if (accessor == NT_NONE || nt_gltf_users_of(r->document, accessor)->foreign ||
			nt_json_find(nt_json_at(accessors, accessor), "bufferView"))
			return false;
	}
	const uint32_t indices = nt_gltf_reference(r->document, r->primitive, "indices");
	return nt_gltf_draco_owns_indices(r, indices) &&
		!nt_json_find(nt_json_at(accessors, indices), "bufferView");
}

/* Targets add to what a decoder has of the tangents. They keep the order of the vertices. */
static nt_status quantize_tangents(const nt_gltf_recoding *r, float *least, nt_error *error)
{
	nt_pool_vertices *vertices = r->vertices;
	const nt_draco_attribute *tangents = r->attributes;
	float *quantized = nt_arena_alloc(&r->edits->arena, vertices->new_count, 4 * sizeof *quantized);
	if (!quantized)
		return nt_fail_memory(error);
	while (tangents->data != vertices->sets[0].tangents)
		tangents++;
	const nt_draco_mesh mesh = {.method = NT_DRACO_SEQUENTIAL, .point_count = vertices->new_count,
		.face_count = r->mesh->face_count, .indices = vertices->users[0].numbers, .attributes = tangents,
		.attribute_count = 1};
	*least = nt_morph_least_of_bits(tangents->quantization.bits);
	vertices->sets[0].tangents = quantized;
	return nt_draco_quantize(&mesh, &quantized, error);
}

/* Attributes in the block leave the buffers, others grow beside it. */
static nt_status store(nt_gltf_recoding *r, uint32_t buffer, nt_morph_cost *cost, nt_error *error)
{
	float least = 0;
	nt_status status = NT_OK;
	if (!r->source)
		nt_gltf_draco_take_out(r);
	if (r->mesh->morph_count)
		status = quantize_tangents(r, &least, error);
	if (!status)
		status = nt_gltf_add_morphs(r->edits, buffer, r->vertices, 0, least, cost, error);
	if (!status && nt_vertices_differ(r->vertices)) /* of what is not in the block */
		status = nt_append_vertices(r->edits, buffer, r->vertices, &(nt_override_list){0}, false, error);
	if (status)
		return status;
	r->primitive = nt_pool_primitive(r->vertices->pool, 0); /* members have moved */
	r->extension = nt_gltf_draco_of(r->primitive);
	describe(r);
	return store_block(r, buffer, error);
}

/* Whether the pool is one primitive, perhaps several times: with the same geometry and the same
 * accessors, so that one block serves them all. */
static bool is_one_primitive(const nt_vertex_pool *pool)
{
	const nt_json_value *first = nt_pool_primitive(pool, 0);
	for (size_t i = 1; i < pool->user_count; i++) {
		const nt_json_value *other = nt_pool_primitive(pool, i);
		if (nt_pool_mesh(pool, i)->plan.same_as != nt_pool_mesh(pool, 0) ||
			!nt_json_equal(nt_gltf_draco_of(first), nt_gltf_draco_of(other)))
			return false;
		static const char *const members[] = {"attributes", "targets", "indices"};
		for (size_t k = 0; k < 3; k++)
			if (!nt_json_equal(nt_json_find(first, members[k]), nt_json_find(other, members[k])))
				return false;
	}
	return true;
}

/* The other users refer to what the first one now does. */
static void share_block(const nt_gltf_recoding *r)
{
	static const char *const members[] = {"attributes", "targets", "indices"};
	for (size_t i = 1; i < r->vertices->pool->user_count; i++) {
		nt_json_value *other = nt_pool_primitive(r->vertices->pool, i);
		for (size_t k = 0; k < 3; k++)
			if (nt_json_find(r->primitive, members[k]))
				nt_json_set_copy(r->json, nt_json_put(r->json, other, members[k]),
					nt_json_find(r->primitive, members[k]));
		nt_json_set_copy(r->json, nt_json_put(r->json, nt_json_put(r->json, other, "extensions"),
			"KHR_draco_mesh_compression"), nt_gltf_draco_of(r->primitive));
	}
}

static void tell_sequential(const nt_gltf_recoding *r, nt_finding_list *findings, const nt_place *place)
{
	if (r->faces_without_area)
		nt_finding_add(findings, NT_CODE_DRACO_SEQUENTIAL, place, 1,
			"edgebreaker would drop %zu of its faces, which have no area in the block's grid",
			r->faces_without_area);
	else
		nt_finding_add(findings, NT_CODE_DRACO_SEQUENTIAL, place, 1, "%s", r->outside
			? "attributes that are not in the block need its order" : "edgebreaker does not give it back");
}

/* A finding for compression that the user asked for and does not get. */
static void report_users(const nt_gltf_recoding *r, nt_finding_list *findings, bool compressed)
{
	const nt_vertex_pool *pool = r->vertices->pool;
	for (size_t i = 0; i < pool->user_count; i++) {
		if (!nt_pool_is_solved(pool, i))
			continue;
		const nt_place *place = nt_mesh_place(nt_pool_mesh(pool, i), &(nt_place){0});
		const bool wanted = r->options->draco > NT_DRACO_OFF || is_compressed(pool, i);
		if (!compressed && wanted)
			nt_finding_add(findings, NT_CODE_DRACO_PLAIN, place, 1, "%s", r->obstacle);
		if (compressed && r->sequential_instead)
			tell_sequential(r, findings, place);
	}
}

nt_status nt_gltf_draco_begin(nt_gltf_recoding *r, nt_gltf *document, nt_pool_vertices *vertices,
	const nt_write_options *options, nt_arena *arena, nt_error *error)
{
	*r = (nt_gltf_recoding){.document = document, .json = document->json, .arena = arena, .options = options,
		.vertices = vertices, .mesh = nt_pool_mesh(vertices->pool, 0),
		.primitive = nt_pool_primitive(vertices->pool, 0)};
	r->extension = nt_gltf_draco_of(r->primitive);
	nt_status status = NT_OK;
	if (!is_one_primitive(vertices->pool)) {
		r->obstacle = "it shares vertices with other primitives";
	} else if (!r->extension) {
		status = nt_gltf_draco_gather_plain(r, error);
	} else if (!accessors_are_own(r) ||
		!nt_json_find_uint64(r->extension, "bufferView", &r->view)) {
		r->obstacle = "something else uses its accessors";
	} else {
		r->outside = has_outside(r);
	}
	return status;
}

nt_status nt_gltf_draco_look_up(nt_gltf_recoding *r, nt_buffer_edits *edits, nt_pool_vertices *vertices,
	const nt_write_options *options, nt_arena *arena, nt_error *error)
{
	nt_status status = nt_gltf_draco_begin(r, edits->document, vertices, options, arena, error);
	r->edits = edits;
	if (status || r->obstacle)
		return status;
	if (options->precision != NT_PRECISION_AUTO)
		return nt_fail_pointer(error, NT_ERROR_USAGE, nt_mesh_place(r->mesh, &(nt_place){0})->pointer,
			"--precision does not reach tangents that Draco compresses: --draco-bits says how many bits "
			"they get, --draco=off writes them plain");
	if (r->extension) {
		r->source = nt_gltf_draco_block(r->document, r->view);
		status = gather_block(r, error);
	}
	return status ? status : add_own(r, error);
}

nt_status nt_gltf_write_draco(nt_gltf_recoding *r, uint32_t buffer, nt_scene *scene, bool *done,
	nt_error *error)
{
	r->primitive = nt_pool_primitive(r->vertices->pool, 0);
	r->extension = nt_gltf_draco_of(r->primitive);
	nt_status status = r->encoded || r->obstacle ? NT_OK : nt_gltf_draco_encode(r, error);
	*done = !status && !r->obstacle;
	if (*done && r->block.point_count != r->vertices->new_count) {
		scene->packed.before += r->vertices->new_count;
		scene->packed.after += r->block.point_count;
	}
	if (*done)
		scene->packed.dropped += r->mesh->corner_count / 3 - r->block.face_count;
	if (*done)
		status = store(r, buffer, &scene->morph_cost, error);
	nt_draco_block_free(&r->block);
	if (status)
		return status;
	if (*done)
		share_block(r);
	report_users(r, &scene->findings, *done);
	if (!*done)
		nt_gltf_draco_make_plain(r->edits, r->vertices);
	return NT_OK;
}

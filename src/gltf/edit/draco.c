/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents; with an explicit --draco, plain ones that shall be compressed.
 *
 * The block is encoded again with the copied vertices and TANGENT among the attributes. Attributes keep the
 * source's quantization, origin and range, so that they decode to the values they had. Where attributes
 * lie outside of the block (morph targets, joints in some files) or faces are degenerate, order matters
 * and the sequential method is taken. Where compressing again would lose something (the encoder drops
 * vertices that no face uses, and elements outside of the block would no longer fit), where primitives share
 * accessors but not all else, or where it is not wanted, the primitive is written plain.
 */
#include "gltf/edit/draco.h"

#include <string.h>
#include "gltf/edit/append.h"
#include "gltf/edit/draco_gather.h"
#include "gltf/edit/extensions.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/primitive.h"
#include "gltf/view.h"

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

void nt_gltf_drop_draco(const nt_scene *scene)
{
	nt_gltf *document = scene->source;
	if (!document->draco_blocks)
		return;
	for (size_t i = 0; i < scene->mesh_count; i++)
		if (nt_gltf_draco_of(nt_gltf_primitive_of(document, &scene->meshes[i])))
			return;
	nt_gltf_remove_extension(document, "extensionsRequired", "KHR_draco_mesh_compression");
	nt_gltf_remove_extension(document, "extensionsUsed", "KHR_draco_mesh_compression");
}

/* ---- plain ---- */

/* Takes the extension off a primitive, and its block out of the buffer. The view takes some of the elements. */
static nt_status make_plain(nt_buffer_edits *edits, nt_vertex_pools *pools, nt_json_value *primitive, nt_error *error)
{
	nt_gltf *document = edits->document;
	nt_json_value *extensions = nt_json_find(primitive, "extensions");
	uint64_t index;
	nt_gltf_view view;
	nt_status status = NT_OK;
	if (nt_json_get_uint64(nt_json_find(nt_gltf_draco_of(primitive), "bufferView"), &index) &&
		nt_gltf_get_view(document, index, "", &view, NULL) == NT_OK &&
		nt_gltf_draco_release(pools, index, 1))
		status = nt_edits_release(edits, (uint32_t)index, 0, view.length, error);
	nt_json_remove(document->json, extensions, "KHR_draco_mesh_compression");
	if (nt_json_count(extensions) == 0)
		nt_json_remove(document->json, primitive, "extensions");
	return status;
}

/* Their indices are to be written then. */
static nt_status make_all_plain(nt_buffer_edits *edits, nt_vertex_pools *pools, nt_pool_vertices *vertices,
	nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < vertices->pool->user_count; i++) {
		if (!is_compressed(vertices->pool, i))
			continue;
		status = make_plain(edits, pools, nt_pool_primitive(vertices->pool, i), error);
		vertices->changed[i] = true;
	}
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

/* Whether every compressed accessor is used by the pool alone and has no uncompressed twin. */
static bool accessors_are_own(const nt_gltf_recoding *r)
{
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	const nt_json_value *accessors = nt_gltf_root_member(r->document, "accessors");
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		uint64_t accessor;
		const char *name = nt_json_key(ids, i, NULL);
		if (!name || !nt_json_get_uint64(nt_json_find(attributes, name), &accessor) ||
			r->pools->foreign[r->pools->first_alias[accessor]] ||
			nt_json_find(nt_json_at(accessors, (size_t)accessor), "bufferView"))
			return false;
	}
	uint64_t indices;
	return nt_json_get_uint64(nt_json_find(r->primitive, "indices"), &indices) &&
		r->pools->index_users[r->pools->first_alias[indices]] == r->vertices->pool->user_count &&
		!nt_json_find(nt_json_at(accessors, (size_t)indices), "bufferView");
}

/* Whether edgebreaker would drop a face: two corners at one position. */
static bool has_degenerate_face(const nt_gltf_recoding *r)
{
	const uint32_t *indices = r->vertices->indices[0];
	for (size_t c = 0; c + 2 < r->mesh->corner_count; c += 3)
		for (size_t k = 0; k < 3; k++) {
			const size_t a = indices[c + k], b = indices[c + (k + 1) % 3];
			if (memcmp(r->mesh->positions + 3 * nt_vertex_source(r->vertices, a),
				r->mesh->positions + 3 * nt_vertex_source(r->vertices, b), 3 * sizeof(float)) == 0)
				return true;
		}
	return false;
}

/* Whether elements outside of the block still fit the points in it. */
static bool order_is_kept(const nt_gltf_recoding *r, const nt_draco_block *block)
{
	if (block->point_count != r->vertices->new_count || !block->sources)
		return false;
	for (size_t i = 0; i < block->point_count; i++)
		if (block->sources[i] != i)
			return false;
	return true;
}

static nt_draco_method wanted_method(const nt_gltf_recoding *r)
{
	if (r->outside || has_degenerate_face(r) || r->options->draco == NT_DRACO_AS_SEQUENTIAL)
		return NT_DRACO_SEQUENTIAL;
	return r->options->draco == NT_DRACO_AS_EDGEBREAKER ? NT_DRACO_EDGEBREAKER :
								       r->source->method;
}

/* Whether it is not the mesh that keeps Draco from encoding. */
static bool is_beside_mesh(nt_status status)
{
	return status == NT_ERROR_MEMORY || status == NT_ERROR_MODULE || status == NT_ERROR_IO;
}

/* Encodes; *done false where the result would not do. */
static nt_status recode(nt_gltf_recoding *r, bool *done)
{
	nt_status status = r->source ? nt_gltf_draco_gather_block(r) : NT_OK;
	if (!status)
		status = nt_gltf_draco_add_own(r);
	if (status)
		return status;
	/* Edgebreaker does not give every mesh back; the other method has nothing to lose. */
	const nt_draco_method method = wanted_method(r);
	nt_draco_block block = {0};
	nt_error failure;
	status = nt_gltf_draco_encode(r, method, &block, &failure);
	if (status && !is_beside_mesh(status) && method != NT_DRACO_SEQUENTIAL)
		status = nt_gltf_draco_encode(r, NT_DRACO_SEQUENTIAL, &block, &failure);
	if (is_beside_mesh(status)) {
		*r->error = failure;
		return status;
	}
	if (status || (r->outside && !order_is_kept(r, &block))) {
		r->obstacle = status ? "Draco does not give it back"
				     : "no face uses some of its vertices, whose order matters";
		nt_draco_block_free(&block);
		return NT_OK; /* plain, then */
	}
	*done = true;
	status = r->source ? NT_OK : nt_gltf_draco_take_out(r, &block);
	if (!status && r->outside && r->vertices->new_count > r->vertices->old_count)
		status = nt_append_vertices(r->edits, r->buffer, r->pools, r->vertices, NULL, 0, false, r->error);
	if (!status) {
		nt_gltf_draco_describe(r, &block);
		status = nt_gltf_draco_store(r, &block);
	}
	if (!status)
		status = nt_gltf_add_morphs(r->edits, r->buffer, r->vertices, 0, r->error);
	nt_draco_block_free(&block);
	return status;
}

/* Whether the pool is one primitive, perhaps several times: with the same geometry and the same
 * accessors, so that one block serves them all. */
static bool is_one_primitive(const nt_vertex_pool *pool)
{
	const nt_json_value *first = nt_pool_primitive(pool, 0);
	for (size_t i = 1; i < pool->user_count; i++) {
		const nt_json_value *other = nt_pool_primitive(pool, i);
		if (nt_pool_mesh(pool, i)->same_as != nt_pool_mesh(pool, 0) ||
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

/* What the user asked for and does not get. */
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
		else if (compressed && r->options->precision != NT_PRECISION_FLOAT)
			nt_finding_add(findings, NT_CODE_DRACO_PRECISION, place, 1, "%d bits",
				nt_gltf_draco_bits(r->options, NT_DRACO_BITS_TANGENT));
	}
}

nt_status nt_gltf_write_draco(nt_buffer_edits *edits, uint32_t buffer, nt_vertex_pools *pools,
	nt_pool_vertices *vertices, const nt_write_options *options, nt_finding_list *findings, bool *done,
	nt_error *error)
{
	*done = false;
	if (options->draco == NT_DRACO_OFF)
		return make_all_plain(edits, pools, vertices, error);
	nt_gltf_recoding r = {.edits = edits, .document = edits->document, .json = edits->document->json,
		.arena = &edits->arena, .options = options, .pools = pools, .vertices = vertices, .buffer = buffer,
		.error = error, .mesh = nt_pool_mesh(vertices->pool, 0),
		.primitive = nt_pool_primitive(vertices->pool, 0)};
	r.extension = nt_gltf_draco_of(r.primitive);
	nt_status status = NT_OK;
	if (!is_one_primitive(vertices->pool)) {
		r.obstacle = "it shares vertices with other primitives";
	} else if (!r.extension) {
		status = nt_gltf_draco_gather_plain(&r);
	} else if (!accessors_are_own(&r) ||
		!nt_json_get_uint64(nt_json_find(r.extension, "bufferView"), &r.view)) {
		r.obstacle = "something else uses its accessors";
	} else {
		r.source = nt_gltf_draco_block(r.document, r.view);
		nt_gltf_visit_attributes(r.primitive, pools->accessor_count, note_outside, &r);
	}
	if (!status && !r.obstacle)
		status = recode(&r, done);
	if (status)
		return status;
	if (*done)
		share_block(&r);
	report_users(&r, findings, *done);
	return *done ? NT_OK : make_all_plain(edits, pools, vertices, error);
}

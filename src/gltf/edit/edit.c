/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: the source document with tangents put in, and nothing else changed. Pool by pool: splits are
 * merged, vertices appended, indices follow, TANGENT comes; then offsets are moved and the document is written.
 * What no solved primitive uses is not read.
 *
 * The solve is made on (u, -v), so its w is glTF's as it stands.
 */
#include "gltf/edit/edit.h"

#include <string.h>
#include "gltf/accessor.h"
#include "gltf/edit/append.h"
#include "gltf/edit/draco.h"
#include "gltf/edit/extensions.h"
#include "gltf/edit/indices.h"
#include "gltf/edit/merge_splits.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/edit/old_tangents.h"
#include "gltf/edit/vertex_extensions.h"
#include "gltf/edit/write.h"
#include "gltf/extensions/geometry_metadata.h"
#include "gltf/quantize.h"
#include "gltf/view.h"

/* What every pool's edit needs. */
typedef struct editing {
	nt_scene *scene;
	const nt_write_options *options;
	nt_vertex_pools *pools;
	nt_buffer_edits *edits;
	nt_arena *of_pool; /* what is needed while one pool is edited */
	nt_error *error;
} editing;

/* ---- values ---- */

/* Rounds the tangents of all sets, so that what is derived from them fits what readers will see. */
static nt_status round_tangents(const editing *e, nt_pool_vertices *vertices)
{
	const nt_precision precision = e->options->precision;
	const size_t count = vertices->new_count;
	for (uint32_t set = 0; precision != NT_PRECISION_FLOAT && set < vertices->pool->sets.count; set++) {
		nt_rounding cost = {0};
		if (vertices->borrowed) {
			float *own = nt_arena_alloc(&e->edits->arena, count, 4 * sizeof *own);
			if (!own)
				return nt_fail_memory(e->error);
			vertices->tangents[set] = memcpy(own, vertices->tangents[set], count * 4 * sizeof *own);
		}
		nt_precision_round(precision, vertices->tangents[set], count, &cost);
		nt_precision_report(e->scene, precision, &cost, 
			nt_mesh_place(nt_pool_set_mesh(vertices->pool, set), &(nt_place){0}));
	}
	return NT_OK;
}

/* Tangents as they are stored. */
static nt_status stored_tangents(const editing *e, const nt_pool_vertices *vertices, uint32_t set,
	const unsigned char **bytes)
{
	const nt_precision precision = e->options->precision;
	*bytes = (const unsigned char *)vertices->tangents[set];
	if (precision == NT_PRECISION_FLOAT)
		return NT_OK;
	unsigned char *out = nt_arena_alloc(&e->edits->arena, vertices->new_count, nt_precision_bytes(precision));
	if (!out)
		return nt_fail_memory(e->error);
	nt_precision_encode(precision, vertices->tangents[set], vertices->new_count, out);
	*bytes = out;
	return NT_OK;
}

/* ---- one tangent set ---- */

/* Tangents in new bytes: for the accessors that the set's meshes had, or for a new one. */
static nt_status add_tangents(const editing *e, uint32_t buffer, const nt_pool_vertices *vertices, uint32_t set,
	const nt_gltf_old_tangents *old)
{
	nt_gltf *document = e->edits->document;
	const nt_precision precision = e->options->precision;
	const size_t count = vertices->new_count, element_bytes = nt_precision_bytes(precision);
	const unsigned char *bytes;
	uint32_t view, accessor;
	nt_status status = stored_tangents(e, vertices, set, &bytes);
	if (!status && old->count) {
		status = nt_edits_add_view(e->edits, buffer, bytes, count * element_bytes, NT_GLTF_ARRAY_BUFFER, 0,
			&view, e->error);
		if (!status)
			nt_gltf_move_tangents(document, old, precision, view, count);
	} else if (!status) {
		status = nt_gltf_add_attribute(e->edits, buffer, bytes, count, element_bytes,
			nt_precision_component_type(precision), "VEC4", &accessor, e->error);
		if (!status)
			nt_gltf_set_attribute(document->json, vertices->pool, set, "TANGENT", accessor);
	}
	return status;
}

/* Meshes of the set that had no tangents take those of the others. */
static void complete_tangents(const editing *e, const nt_vertex_pool *pool, uint32_t set,
	const nt_gltf_old_tangents *old)
{
	nt_json *json = e->edits->document->json;
	for (uint32_t i = pool->sets.first[set]; old->count && i != NT_NONE; i = pool->sets.next[i])
		if (nt_gltf_tangent_of(e->pools, pool, i) == NT_NONE)
			nt_json_set_uint64(json, nt_json_put(json, nt_json_find(nt_pool_primitive(pool, i),
				"attributes"), "TANGENT"), old->accessors[0]);
}

/* An attribute of floats, VEC3, for the whole set. */
static nt_status add_vectors(const editing *e, uint32_t buffer, const nt_pool_vertices *vertices, uint32_t set,
	const char *name, const float *vectors)
{
	uint32_t accessor;
	const nt_status status = nt_gltf_add_floats(e->edits, buffer, vectors, vertices->new_count, 3, &accessor,
		e->error);
	if (!status)
		nt_gltf_set_attribute(e->edits->document->json, vertices->pool, set, name, accessor);
	return status;
}

/* NORMAL where it was made, TANGENT where it is not already in place, _BITANGENT where asked for. */
static nt_status add_set(const editing *e, uint32_t buffer, const nt_pool_vertices *vertices, uint32_t set,
	const nt_gltf_old_tangents *old)
{
	nt_status status = NT_OK;
	float *bitangents = NULL;
	if (vertices->normals[set])
		status = add_vectors(e, buffer, vertices, set, "NORMAL", vertices->normals[set]);
	if (!status && !old->in_place)
		status = add_tangents(e, buffer, vertices, set, old);
	if (!status && old->in_place)
		nt_gltf_retype_tangents(e->edits->document, old, e->options->precision);
	if (!status)
		complete_tangents(e, vertices->pool, set, old);
	if (!status)
		status = nt_gltf_add_morphs(e->edits, buffer, vertices, set, e->error);
	if (!status && e->options->bitangents)
		status = nt_gltf_bitangents(vertices, set, &e->edits->arena, &bitangents, e->error);
	if (!status && bitangents)
		status = add_vectors(e, buffer, vertices, set, "_BITANGENT", bitangents);
	return status;
}

/* ---- one pool ---- */

/* New views of the pool go where its positions are. */
static nt_status choose_buffer(const editing *e, const nt_vertex_pool *pool, uint32_t *buffer)
{
	nt_gltf *document = e->edits->document;
	const nt_json_value *attributes = nt_json_find(nt_pool_primitive(pool, pool->sets.first[0]), "attributes");
	uint64_t index;
	nt_gltf_accessor accessor;
	nt_gltf_view view = {.buffer = NT_NONE};
	if (nt_json_get_uint64(nt_json_find(attributes, "POSITION"), &index) &&
		nt_gltf_get_accessor(document, index, "", &accessor, NULL) == NT_OK && accessor.view != NT_NONE)
		nt_gltf_get_view(document, accessor.view, "", &view, NULL);
	return nt_edits_choose_buffer(e->edits, view.buffer, buffer, e->error);
}

/* What becomes of the TANGENT accessors that are there: new values for those that stay in place; the others
 * lose their bytes. old: [set]; overrides: room for every user. */
static nt_status settle_old_tangents(const editing *e, const nt_pool_vertices *vertices, nt_gltf_old_tangents *old,
	nt_gltf_override *overrides, size_t *count)
{
	const nt_vertex_pool *pool = vertices->pool;
	const nt_precision precision = e->options->precision;
	nt_status status = NT_OK;
	*count = 0;
	for (uint32_t set = 0; !status && set < pool->sets.count; set++) {
		const unsigned char *values = NULL;
		status = nt_gltf_find_tangents(e->edits, e->pools, pool, set, precision, &old[set], e->error);
		if (!status)
			status = old[set].in_place ? stored_tangents(e, vertices, set, &values) :
						     nt_gltf_release_tangents(e->edits, &old[set], e->error);
		for (size_t i = 0; !status && i < old[set].count; i++)
			overrides[(*count)++] = (nt_gltf_override){.accessor = old[set].accessors[i],
				.values = values, .width = (uint32_t)nt_precision_bytes(precision)};
	}
	return status;
}

/* Accessors of the source grow, and get new ones beside them. decoded_too: they were compressed by Draco. */
static nt_status edit_plain(const editing *e, uint32_t buffer, nt_pool_vertices *vertices, bool decoded_too)
{
	const nt_vertex_pool *pool = vertices->pool;
	nt_status status = round_tangents(e, vertices);
	if (status)
		return status;

	/* Tangents that are there keep their accessor, and their place where that will do. */
	nt_gltf_override *overrides = nt_arena_alloc(e->of_pool, pool->user_count, sizeof *overrides);
	nt_gltf_old_tangents *old = nt_arena_alloc(e->of_pool, pool->sets.count, sizeof *old);
	if (!overrides || !old)
		return nt_fail_memory(e->error);
	size_t override_count;
	status = settle_old_tangents(e, vertices, old, overrides, &override_count);

	/* The copied vertices, the indices that use them, and what is new. */
	if (!status && (decoded_too || override_count || vertices->new_count > vertices->old_count))
		status = nt_append_vertices(e->edits, buffer, e->pools, vertices, overrides, override_count,
			decoded_too, e->error);
	if (!status)
		status = nt_gltf_write_indices(e->edits, buffer, e->pools, vertices, e->error);
	for (uint32_t set = 0; !status && set < pool->sets.count; set++)
		status = add_set(e, buffer, vertices, set, &old[set]);
	return status;
}

/* *plain becomes true where it is not compressed. */
static nt_status edit_pool(const editing *e, const nt_vertex_pool *pool, bool *plain)
{
	/* One vertex for each tangent that a vertex has. */
	nt_pool_vertices vertices;
	uint32_t buffer = 0;
	nt_status status = nt_merge_splits(&vertices, pool, &e->edits->arena, e->error);
	if (!status)
		status = choose_buffer(e, pool, &buffer);

	/* Compressed primitives are compressed again, or become plain ones here. */
	const bool compressed = nt_gltf_has_draco(pool);
	bool done = false;
	if (!status && (compressed || e->options->draco > NT_DRACO_OFF))
		status = nt_gltf_write_draco(e->edits, buffer, e->pools, &vertices, e->options, &e->scene->findings,
			&done, e->error);
	if (!status)
		status = nt_gltf_follow_vertices(e->edits, buffer, e->scene, &vertices, done, e->error);
	if (status || done)
		return status;
	*plain = true;
	return edit_plain(e, buffer, &vertices, compressed);
}

/* ---- the whole ---- */

/* --morph=drop: before anything asks who uses which accessor. The accessors keep their numbers. */
static void drop_target_tangents(const nt_scene *scene)
{
	const nt_gltf *document = scene->source;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		if (!nt_gltf_is_solved(mesh))
			continue;
		nt_json_value *targets = nt_json_find(nt_gltf_primitive_of(document, mesh), "targets");
		for (size_t t = 0; t < nt_json_count(targets); t++)
			nt_json_remove(document->json, nt_json_at(targets, t), "TANGENT");
	}
}

/* All pools with a solved user. */
static nt_status edit_pools(const editing *e)
{
	nt_gltf *document = e->edits->document;
	bool plain = false;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < e->pools->count; i++) {
		nt_vertex_pool pool;
		nt_arena_clear(e->of_pool);
		status = nt_vertex_pools_get(e->pools, i, e->of_pool, &pool, e->error);
		if (!status && pool.sets.count)
			status = edit_pool(e, &pool, &plain);
	}
	nt_gltf_drop_draco(e->scene);
	if (!status && plain && e->options->precision != NT_PRECISION_FLOAT) {
		nt_gltf_list_extension(document, "extensionsUsed", NT_GLTF_QUANTIZATION);
		nt_gltf_list_extension(document, "extensionsRequired", NT_GLTF_QUANTIZATION);
	}
	return status;
}

nt_status nt_gltf_edit(nt_scene *scene, const nt_write_options *options, nt_output *output, nt_error *error)
{
	/* Nothing to be done: the input as it is. */
	bool written = false;
	nt_status status = NT_OK;
	if (!nt_gltf_has_solved(scene))
		status = nt_gltf_copy_unchanged(scene, options, output, &written, error);
	if (status || written)
		return status;

	/* Who shares what, and which bytes may change. */
	if (options->morphs == NT_MORPH_DROP)
		drop_target_tangents(scene);
	nt_arena arena = {0}, of_pool = {0};
	nt_vertex_pools pools;
	nt_buffer_edits edits = {0};
	nt_geometry_total *totals = NULL;
	status = nt_vertex_pools_find(&pools, scene, &arena, error);
	if (!status)
		status = nt_edits_create(&edits, &pools, error);
	if (!status && nt_geometry_totals(scene->source, &arena, &totals))
		status = nt_fail_memory(error);

	/* The edits, and with them the document. */
	const editing e = {.scene = scene, .options = options, .pools = &pools, .edits = &edits,
		.of_pool = &of_pool, .error = error};
	if (!status)
		status = edit_pools(&e);
	nt_arena_free(&of_pool);
	if (!status && nt_geometry_metadata_follow(scene, totals, &arena))
		status = nt_fail_memory(error);
	if (!status)
		status = nt_gltf_write_document(scene, &edits, options, output, error);
	nt_edits_free(&edits);
	nt_arena_free(&arena);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: the source document with tangents put in, and nothing else changed. Pool by pool: splits are
 * merged, vertices appended, indices follow, TANGENT comes; then offsets are moved and the document is written.
 * What no solved primitive uses is not read. Only Draco takes long: its blocks are encoded on all threads, of a
 * window of pools before the first of them is edited.
 *
 * The solve is made on (u, -v), so its w is glTF's as it stands.
 */
#include "gltf/edit/edit.h"

#include <string.h>
#include "base/parallel.h"
#include "gltf/accessor.h"
#include "gltf/document.h"
#include "gltf/edit/append.h"
#include "gltf/edit/draco.h"
#include "gltf/edit/draco_block.h"
#include "gltf/edit/merge_splits.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/edit/old_tangents.h"
#include "gltf/edit/manifold.h"
#include "gltf/edit/relocate.h"
#include "gltf/extensions/geometry_metadata.h"
#include "gltf/morph_deltas.h"
#include "gltf/quantize.h"
#include "gltf/view.h"

/* What every pool's edit needs. */
typedef struct editing {
	nt_scene *scene;
	const nt_write_options *options;
	nt_vertex_pools *pools;
	nt_buffer_edits *edits;
	nt_arena *of_window; /* what is needed while the pools of one window are edited */
	nt_error *error;
} editing;

/* Pools that are prepared together: enough for many threads, few enough for their descriptions to be small. */
enum { WINDOW = 1024 };

/* One of them. */
typedef struct pool_edit {
	size_t number;
	nt_vertex_pool pool;
	bool stays;                /* as it is */
	bool for_draco;            /* what follows is there */
	nt_pool_vertices vertices;
	nt_gltf_recoding recoding;
} pool_edit;

/* ---- what stays ---- */

/* Whether a primitive stays as it is: with --existing=repair, where no tangent was invalid and nothing else is asked
 * for. A Draco block that was encoded again would hold its triangles in another order. */
static bool stays(const nt_scene *scene, const nt_write_options *options, const nt_mesh *mesh)
{
	if (!nt_gltf_is_solved(mesh))
		return true;
	return mesh->decision == NT_DECISION_REPAIR && !mesh->normals_made && !mesh->replaced_tangents &&
		!mesh->morph_count && options->morphs != NT_MORPH_DROP && !options->bitangents &&
		options->precision == NT_PRECISION_FLOAT && (options->draco == NT_DRACO_KEEP ||
		(options->draco == NT_DRACO_OFF && !nt_gltf_draco_of(nt_gltf_primitive_of(scene->source, mesh))));
}

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
			vertices->sets[set].tangents =
				memcpy(own, vertices->sets[set].tangents, count * 4 * sizeof *own);
		}
		nt_precision_round(precision, vertices->sets[set].tangents, count, &cost);
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
	*bytes = (const unsigned char *)vertices->sets[set].tangents;
	if (precision == NT_PRECISION_FLOAT)
		return NT_OK;
	unsigned char *out = nt_arena_alloc(&e->edits->arena, vertices->new_count, nt_precision_bytes(precision));
	if (!out)
		return nt_fail_memory(e->error);
	nt_precision_encode(precision, vertices->sets[set].tangents, vertices->new_count, out);
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
	if (vertices->sets[set].normals)
		status = add_vectors(e, buffer, vertices, set, "NORMAL", vertices->sets[set].normals);
	if (!status && !old->in_place)
		status = add_tangents(e, buffer, vertices, set, old);
	if (!status && old->in_place)
		nt_gltf_retype_tangents(e->edits->document, old, e->options->precision);
	if (!status)
		complete_tangents(e, vertices->pool, set, old);
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
		status = nt_gltf_find_tangents(e->edits, e->pools, pool, set, precision, e->of_window,
			&old[set], e->error);
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
	size_t most = pool->user_count;
	for (uint32_t set = 0; set < pool->sets.count; set++)
		most += nt_pool_set_mesh(pool, set)->morph_count;
	nt_gltf_override *overrides = nt_arena_alloc(e->of_window, most, sizeof *overrides);
	nt_gltf_old_tangents *old = nt_arena_alloc(e->of_window, pool->sets.count, sizeof *old);
	if (!overrides || !old)
		return nt_fail_memory(e->error);
	size_t override_count;
	status = settle_old_tangents(e, vertices, old, overrides, &override_count);
	for (uint32_t set = 0; !status && set < pool->sets.count; set++)
		status = nt_gltf_add_morphs(e->edits, buffer, e->pools, vertices, set,
			nt_morph_least(e->options->precision), overrides, &override_count, &e->scene->morph_cost,
			e->error);

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

/* The pool, and where Draco has to do with it what its block will hold. Changes nothing in the document. */
static nt_status prepare_pool(const editing *e, size_t number, pool_edit *p)
{
	*p = (pool_edit){.number = number};
	nt_status status = nt_vertex_pools_get(e->pools, number, e->of_window, &p->pool, e->error);
	p->stays = !status;
	for (size_t i = 0; p->stays && i < p->pool.user_count; i++)
		p->stays = stays(e->scene, e->options, nt_pool_mesh(&p->pool, i));
	if (status || p->stays || e->options->draco == NT_DRACO_OFF ||
		(e->options->draco == NT_DRACO_KEEP && !nt_gltf_has_draco(&p->pool)))
		return status;
	p->for_draco = true;
	status = nt_pool_vertices_get(e->pools, number, &p->pool, e->of_window, &p->vertices, e->error);
	return status ? status : nt_gltf_draco_look_up(&p->recoding, e->edits, e->pools, &p->vertices, e->options,
		e->of_window, e->error);
}

/* *plain becomes true where it is not compressed. */
static nt_status edit_pool(const editing *e, pool_edit *p, bool *plain)
{
	/* One vertex for each tangent that a vertex has. */
	uint32_t buffer = 0;
	nt_status status = p->for_draco ? NT_OK :
		nt_pool_vertices_get(e->pools, p->number, &p->pool, e->of_window, &p->vertices, e->error);
	if (!status)
		status = choose_buffer(e, &p->pool, &buffer);

	/* Compressed primitives are compressed again, or become plain ones here. */
	const bool compressed = nt_gltf_has_draco(&p->pool);
	bool done = false;
	if (!status && p->for_draco)
		status = nt_gltf_write_draco(&p->recoding, buffer, e->scene, &done, e->error);
	else if (!status && compressed)
		status = nt_gltf_draco_make_plain(e->edits, e->pools, &p->vertices, e->error);
	if (!status)
		status = nt_gltf_follow_vertices(e->edits, buffer, e->scene, &p->vertices, done, e->error);
	if (status || done)
		return status;
	*plain = true;
	return edit_plain(e, buffer, &p->vertices, compressed);
}

/* ---- the whole ---- */

/* Some pools from `first` on, which becomes the first of the next window. An error is that of the first pool that has
 * one. list: room for as many as the window. */
static nt_status edit_window(const editing *e, pool_edit *window, nt_gltf_recoding **list, size_t *first, bool *plain)
{
	nt_status status = NT_OK, unprepared = NT_OK;
	size_t count = 0, block_count = 0;
	nt_arena_clear(e->of_window);
	while (!unprepared && count < WINDOW && *first + count < e->pools->count) {
		unprepared = prepare_pool(e, *first + count, &window[count]);
		count += !unprepared;
	}
	for (size_t i = 0; i < count; i++)
		if (window[i].for_draco && !window[i].recoding.obstacle)
			list[block_count++] = &window[i].recoding;
	nt_gltf_draco_encode_all(list, block_count, nt_thread_count(e->options->threads));
	for (size_t i = 0; !status && i < count; i++)
		if (!window[i].stays)
			status = edit_pool(e, &window[i], plain);
	for (size_t i = 0; i < count; i++)
		nt_draco_block_free(&window[i].recoding.block);
	*first += count;
	return status ? status : unprepared;
}

/* All pools with a solved user. */
static nt_status edit_pools(const editing *e)
{
	nt_gltf *document = e->edits->document;
	const size_t size = e->pools->count < WINDOW ? e->pools->count : WINDOW;
	pool_edit *window = nt_arena_alloc(&e->edits->arena, size, sizeof *window);
	nt_gltf_recoding **list = nt_arena_alloc(&e->edits->arena, size, sizeof *list);
	bool plain = false;
	nt_status status = window && list ? NT_OK : nt_fail_memory(e->error);
	for (size_t first = 0; !status && first < e->pools->count;)
		status = edit_window(e, window, list, &first, &plain);
	nt_gltf_drop_draco(e->scene);
	nt_gltf_drop_polygons(e->edits);
	if (!status && plain && e->options->precision != NT_PRECISION_FLOAT) {
		nt_gltf_list_extension(document, "extensionsUsed", NT_GLTF_QUANTIZATION);
		nt_gltf_list_extension(document, "extensionsRequired", NT_GLTF_QUANTIZATION);
	}
	return status;
}

nt_status nt_gltf_edit(nt_scene *scene, const nt_write_options *options, nt_output *output, nt_error *error)
{
	/* Nothing to be done: the input as it is. */
	bool written = false, all_stay = true;
	nt_status status = NT_OK;
	for (size_t i = 0; all_stay && i < scene->mesh_count; i++)
		all_stay = stays(scene, options, &scene->meshes[i]);
	if (all_stay)
		status = nt_gltf_copy_unchanged(scene, options, output, &written, error);
	if (status || written)
		return status;

	/* Which bytes may change, and what refers to nothing. */
	nt_gltf *document = scene->source;
	nt_arena arena = {0}, of_window = {0};
	nt_buffer_edits edits = {0};
	nt_geometry_total *totals = NULL;
	nt_gltf_find_dangling(document);
	if (!document->pools)
		status = nt_vertex_pools_find(scene, &(nt_read_options){.morphs = options->morphs}, error);
	if (!status)
		status = nt_edits_create(&edits, document->pools, error);
	if (!status && nt_geometry_totals(scene->source, &arena, &totals))
		status = nt_fail_memory(error);

	/* The edits, and with them the document. */
	const editing e = {.scene = scene, .options = options, .pools = document->pools, .edits = &edits,
		.of_window = &of_window, .error = error};
	if (!status)
		status = edit_pools(&e);
	nt_arena_free(&of_window);
	if (!status && nt_geometry_metadata_follow(scene, totals, &arena))
		status = nt_fail_memory(error);
	if (!status)
		status = nt_gltf_write_document(scene, &edits, options, output, error);
	nt_edits_free(&edits);
	nt_arena_free(&arena);
	return status;
}

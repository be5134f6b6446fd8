/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: the source document with tangents put in, and nothing else changed but what options ask for (new
 * normals, equal vertices welded, tangents dropped). Pool by pool: vertices are appended, indices follow, TANGENT
 * comes; then save.c writes the document. A pool with one mesh takes the split of that, one with several the merge of
 * theirs. Accessors that no solved primitive uses are not read. Only Draco takes long: its blocks are encoded on all
 * threads, of a window of pools before the first of them is edited.
 *
 * The solve is made on (u, -v), so its w is glTF's as it stands.
 */
#include "gltf/edit/edit.h"

#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "gltf/bytes/bytes.h"
#include "gltf/document.h"
#include "gltf/edit/pool_edit.h"
#include "gltf/quantize.h"

/* Data for every pool's edit. */
typedef struct editing {
	nt_scene *scene;
	const nt_write_options *options;
	nt_vertex_pools *pools;
	nt_buffer_edits *edits;
	nt_arena *of_window; /* what is needed while the pools of one window are edited */
	bool *quantized;     /* becomes true where tangents are stored as integers */
	nt_error *error;
} editing;

/* Pools that are prepared together: enough for many threads, few enough for their descriptions to be small. */
enum { WINDOW = 1024 };

/* One of them. */
typedef struct pool_edit {
	size_t number;
	nt_vertex_pool pool;
	bool stays;                /* as it is, but for welding */
	bool for_draco;            /* what follows is there */
	nt_pool_vertices vertices;
	nt_weld_result welded;     /* what welding has counted */
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
		options->precision <= NT_PRECISION_FLOAT && (options->draco == NT_DRACO_KEEP ||
		(options->draco == NT_DRACO_OFF && !nt_gltf_draco_of(nt_gltf_primitive_of(scene->source, mesh))));
}

/* Whether a set gets NORMAL and no TANGENT. */
static bool is_shaded_only(const nt_vertex_pool *pool, uint32_t set)
{
	return nt_pool_set_mesh(pool, set)->decision == NT_DECISION_NORMALS;
}

/* ---- values ---- */

/* Rounds the tangents of a set, so that what is derived from them fits what readers will see. */
static nt_status store_tangents(const editing *e, nt_pool_vertices *vertices, uint32_t set, nt_stored_tangents *to)
{
	const size_t count = vertices->new_count;
	nt_arena *arena = &e->edits->arena;
	nt_rounding cost = {0};
	nt_status status = nt_packed_tangents(e->edits,
		nt_json_find(nt_pool_primitive(vertices->pool, vertices->pool->sets.first[set]), "attributes"),
		e->options->precision, &to->packing, &to->filter, e->error);
	const nt_precision precision = to->filter.precision;
	const bool filtered = strcmp(to->filter.filter, "NONE") != 0;
	if (is_shaded_only(vertices->pool, set))
		return status;
	to->element_bytes = nt_precision_bytes(precision);
	to->values = to->stored = (const unsigned char *)vertices->sets[set].tangents;
	if (status || (precision == NT_PRECISION_FLOAT && !filtered))
		return status;
	float *tangents = vertices->sets[set].tangents;
	if (vertices->borrowed) {
		tangents = nt_arena_alloc(arena, count, 4 * sizeof *tangents);
		if (tangents)
			memcpy(tangents, vertices->sets[set].tangents, count * 4 * sizeof *tangents);
	}
	unsigned char *stored = nt_arena_alloc(arena, count, to->element_bytes);
	unsigned char *values = filtered ? nt_arena_alloc(arena, count, to->element_bytes) : stored;
	if (!tangents || !stored || !values)
		return nt_fail_memory(e->error);
	status = nt_tangents_store(&to->filter, tangents, count, stored, values, &cost, e->error);
	if (!status)
		nt_precision_report(e->scene, precision, &cost,
			nt_mesh_place(nt_pool_set_mesh(vertices->pool, set), &(nt_place){0}));
	vertices->sets[set].tangents = tangents;
	to->values = values;
	to->stored = stored;
	*e->quantized |= precision > NT_PRECISION_FLOAT;
	return status;
}

/* ---- one tangent set ---- */

/* The attributes of a set, in the order in which they are written. */
enum { NORMALS, TANGENTS, BITANGENTS, SET_ATTRIBUTES };

/* Floats without a filter; NULL: the set does not get them. */
static nt_set_attribute vectors(const char *name, const nt_stored_tangents *beside, const float *values)
{
	return (nt_set_attribute){.name = name, .components = 3,
		.values = {.packing = beside->packing, .filter = {.precision = NT_PRECISION_FLOAT, .filter = "NONE"},
			.values = (const unsigned char *)values, .stored = (const unsigned char *)values,
			.element_bytes = 3 * sizeof *values}};
}

/* NORMAL where it was made, TANGENT, _BITANGENT where asked for: [SET_ATTRIBUTES], and which accessors take them. */
static nt_status settle_set(const editing *e, const nt_pool_vertices *vertices, uint32_t set,
	const nt_stored_tangents *tangents, nt_set_attribute *attributes, nt_override_list *overrides)
{
	const bool shaded_only = is_shaded_only(vertices->pool, set);
	float *bitangents = NULL;
	nt_status status = NT_OK;
	if (!shaded_only && e->options->bitangents)
		status = nt_gltf_bitangents(vertices, set, &e->edits->arena, &bitangents, e->error);
	attributes[NORMALS] = vectors("NORMAL", tangents, vertices->sets[set].normals);
	attributes[TANGENTS] = (nt_set_attribute){.name = "TANGENT", .components = 4, .values = *tangents};
	attributes[BITANGENTS] = vectors("_BITANGENT", tangents, bitangents);
	if (shaded_only)
		attributes[TANGENTS].values.stored = NULL;
	for (size_t i = 0; !status && i < SET_ATTRIBUTES; i++)
		if (attributes[i].values.stored)
			status = nt_set_attribute_settle(e->edits, vertices->pool, set, &attributes[i], overrides,
				e->error);
	return status;
}

/* ---- one pool ---- */

/* New views of the pool go where its positions are. */
static nt_status choose_buffer(const editing *e, const nt_vertex_pool *pool, uint32_t *buffer)
{
	nt_gltf *document = e->edits->document;
	const size_t user = pool->sets.count ? pool->sets.first[0] : 0;
	const nt_gltf_accessor *positions = nt_gltf_named(document, nt_json_find(nt_pool_primitive(pool, user),
		"attributes"), "POSITION");
	return nt_edits_choose_buffer(e->edits, positions && positions->view != NT_NONE ?
		nt_gltf_view_of(document, positions)->buffer : NT_NONE, buffer, e->error);
}

/* Equal vertices become one, unless they were welded for Draco. */
static nt_status weld(const editing *e, nt_pool_vertices *vertices, nt_stored_tangents *stored)
{
	return e->options->weld && !vertices->seen_equal ? nt_pool_weld(e->edits, e->scene, vertices, stored,
		e->options->bitangents, e->of_window, e->error) : NT_OK;
}

/* Accessors of the source grow, and get new ones beside them. decoded_too: they were compressed by Draco. */
static nt_status edit_plain(const editing *e, uint32_t buffer, nt_pool_vertices *vertices, bool decoded_too)
{
	const nt_vertex_pool *pool = vertices->pool;
	nt_status status = NT_OK;
	nt_stored_tangents *new = nt_arena_alloc(e->of_window, pool->sets.count, sizeof *new);
	if (new) /* a set without TANGENT keeps no values */
		memset(new, 0, pool->sets.count * sizeof *new);
	for (uint32_t set = 0; new && !status && set < pool->sets.count; set++)
		status = store_tangents(e, vertices, set, &new[set]);
	if (new && !status)
		status = weld(e, vertices, new);
	if (new && !status)
		status = nt_vertices_tell(e->edits, e->scene, vertices, false, e->error);
	if (!new || status)
		return status ? status : nt_fail_memory(e->error);

	/* Attributes that are there keep their accessor, and their place where that will do. */
	nt_override_list overrides = {0};
	nt_set_attribute(*attributes)[SET_ATTRIBUTES] = nt_arena_alloc(e->of_window, pool->sets.count,
		sizeof *attributes);
	if (!attributes)
		return nt_fail_memory(e->error);
	for (uint32_t set = 0; !status && set < pool->sets.count; set++)
		status = settle_set(e, vertices, set, &new[set], attributes[set], &overrides);
	for (uint32_t set = 0; !status && set < pool->sets.count; set++)
		status = nt_gltf_add_morphs(e->edits, buffer, vertices, set, nt_tangent_filter_least(&new[set].filter),
			&e->scene->morph_cost, e->error);

	/* The copied vertices, the indices that use them, and what is new. */
	if (!status && (decoded_too || overrides.count || nt_vertices_differ(vertices)))
		status = nt_append_vertices(e->edits, buffer, vertices, &overrides, decoded_too, e->error);
	free(overrides.items);
	if (!status)
		status = nt_gltf_write_indices(e->edits, buffer, vertices, e->error);
	for (uint32_t set = 0; !status && set < pool->sets.count; set++)
		for (size_t i = 0; !status && i < SET_ATTRIBUTES; i++)
			if (attributes[set][i].values.stored)
				status = nt_set_attribute_write(e->edits, buffer, vertices, set, &attributes[set][i],
					e->error);
	return status;
}

static void add_counts(nt_vertex_counts *to, size_t vertices, size_t normal_copies, size_t tangent_copies)
{
	to->vertices += vertices;
	to->normal_copies += normal_copies;
	to->tangent_copies += tangent_copies;
}

/* Notes how many vertices the meshes of a pool have counted each, and how many there are before welding, which counts
 * for itself. vertices: NULL: the pool stays as it is. */
static void count_shared(nt_scene *scene, const nt_vertex_pools *pools, size_t number, const nt_pool_vertices *vertices)
{
	nt_vertex_counts all = {0};
	size_t users = 0, before = 0;
	for (size_t i = pools->first[number]; i < pools->first[number + 1]; i++) {
		const nt_mesh *mesh = &scene->meshes[pools->order[i]];
		if (!nt_gltf_is_solved(mesh) || mesh->decision == NT_DECISION_NORMALS)
			continue;
		users++;
		before = mesh->unused_vertices + mesh->source_vertex_count;
		add_counts(&all, before, mesh->vertex_count - mesh->source_vertex_count, mesh->split.source_count);
	}
	if (users < 2)
		return;
	add_counts(&scene->shared.counted, all.vertices, all.normal_copies, all.tangent_copies);
	add_counts(&scene->shared.actual, before, vertices ? vertices->normal_copies : 0,
		vertices ? vertices->new_count - vertices->old_count - vertices->normal_copies : 0);
}

/* The pool, and where Draco has to do with it what its block will hold. Changes nothing in the document. */
static nt_status prepare_pool(const editing *e, size_t number, pool_edit *p)
{
	*p = (pool_edit){.number = number};
	nt_status status = nt_vertex_pools_get(e->pools, number, e->of_window, &p->pool, e->error);
	p->stays = !status;
	for (size_t i = 0; p->stays && i < p->pool.user_count; i++)
		p->stays = stays(e->scene, e->options, nt_pool_mesh(&p->pool, i));
	if (!status && p->stays)
		count_shared(e->scene, e->pools, number, NULL);
	if (status || p->stays || e->options->draco == NT_DRACO_OFF || is_shaded_only(&p->pool, 0) ||
		(e->options->draco == NT_DRACO_KEEP && !nt_gltf_has_draco(&p->pool)))
		return status;
	p->for_draco = true;
	status = nt_pool_vertices_get(e->pools, number, &p->pool, e->of_window, &p->vertices, e->error);
	const nt_weld_result before = e->scene->welded;
	if (!status)
		count_shared(e->scene, e->pools, number, &p->vertices);
	if (!status)
		status = weld(e, &p->vertices, NULL);
	p->welded = (nt_weld_result){e->scene->welded.before - before.before, e->scene->welded.after - before.after};
	return status ? status : nt_gltf_draco_look_up(&p->recoding, e->edits, &p->vertices, e->options,
		e->of_window, e->error);
}

static nt_status edit_pool(const editing *e, pool_edit *p)
{
	/* One vertex for each tangent that a vertex has. */
	uint32_t buffer = 0;
	nt_status status = p->for_draco ? NT_OK :
		nt_pool_vertices_get(e->pools, p->number, &p->pool, e->of_window, &p->vertices, e->error);
	if (!status && !p->for_draco)
		count_shared(e->scene, e->pools, p->number, &p->vertices);
	if (!status)
		status = choose_buffer(e, &p->pool, &buffer);

	/* Compressed primitives are compressed again, or become plain ones here. */
	const bool compressed = nt_gltf_has_draco(&p->pool);
	bool done = false;
	if (!status && p->for_draco)
		status = nt_gltf_write_draco(&p->recoding, buffer, e->scene, &done, e->error);
	else if (!status)
		nt_gltf_draco_make_plain(e->edits, &p->vertices);
	if (!status && done)
		status = nt_vertices_tell(e->edits, e->scene, &p->vertices, done, e->error);
	/* plain tangents may be rounded, which makes others equal: vertices are welded again, as they were */
	if (!status && !done && !compressed && p->welded.before) {
		e->scene->welded.before -= p->welded.before;
		e->scene->welded.after -= p->welded.after;
		status = nt_pool_vertices_get(e->pools, p->number, &p->pool, e->of_window, &p->vertices, e->error);
	}
	return status || done ? status : edit_plain(e, buffer, &p->vertices, compressed);
}

/* A pool without new tangents is welded. */
static nt_status edit_staying(const editing *e, pool_edit *p)
{
	uint32_t buffer = 0;
	bool can = false;
	nt_status status = nt_pool_vertices_plain(e->pools, &p->pool, e->of_window, &p->vertices, &can, e->error);
	if (!status && can)
		status = choose_buffer(e, &p->pool, &buffer);
	return status || !can ? status : edit_plain(e, buffer, &p->vertices, false);
}

/* ---- the whole ---- */

/* Some pools from `first` on, which becomes the first of the next window. An error is that of the first pool that has
 * one. list: room for as many as the window. */
static nt_status edit_window(const editing *e, pool_edit *window, nt_gltf_recoding **list, size_t *first)
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
			status = edit_pool(e, &window[i]);
		else if (e->options->weld)
			status = edit_staying(e, &window[i]);
	for (size_t i = 0; i < count; i++)
		nt_draco_block_free(&window[i].recoding.block);
	*first += count;
	return status ? status : unprepared;
}

/* All pools, window by window. */
static nt_status edit_pools(const editing *e)
{
	nt_gltf *document = e->edits->document;
	const size_t size = e->pools->count < WINDOW ? e->pools->count : WINDOW;
	pool_edit *window = nt_arena_alloc(&e->edits->arena, size, sizeof *window);
	nt_gltf_recoding **list = nt_arena_alloc(&e->edits->arena, size, sizeof *list);
	nt_status status = window && list ? NT_OK : nt_fail_memory(e->error);
	for (size_t first = 0; !status && first < e->pools->count;)
		status = edit_window(e, window, list, &first);
	if (document->draco_blocks)
		nt_gltf_unlist_unused(document, "KHR_draco_mesh_compression");
	if (e->edits->polygons_dropped)
		nt_gltf_unlist_unused(document, NT_GLTF_POLYGONS);
	if (!status && *e->quantized) {
		nt_gltf_list_extension(document, "extensionsUsed", NT_GLTF_QUANTIZATION);
		nt_gltf_list_extension(document, "extensionsRequired", NT_GLTF_QUANTIZATION);
	}
	return status;
}

/* The number of TANGENT is noted as gone. */
static void drop_attribute(const editing *e, nt_json_value *attributes, uint32_t *gone)
{
	const uint32_t accessor = nt_gltf_reference(e->edits->document, attributes, "TANGENT");
	if (accessor != NT_NONE)
		gone[nt_gltf_same(e->edits->document, accessor)]++;
	nt_json_remove(e->edits->document->json, attributes, "TANGENT");
}

/* --existing=drop: TANGENT of primitives and of their targets goes, and with it what its accessors have if nothing
 * else uses them. A Draco block keeps its bytes, unnamed. */
static nt_status drop_unused(const editing *e)
{
	nt_gltf *document = e->edits->document;
	uint32_t *gone = nt_calloc(document->accessor_count, sizeof *gone); /* [accessor] uses */
	if (!gone)
		return nt_fail_memory(e->error);
	for (size_t i = 0; i < e->scene->mesh_count; i++) {
		if (e->scene->meshes[i].decision != NT_SKIP_DROPPED)
			continue;
		nt_json_value *primitive = nt_gltf_primitive_of(document, &e->scene->meshes[i]);
		nt_json_value *targets = nt_json_find(primitive, "targets");
		nt_json_remove(document->json, nt_json_find(nt_gltf_draco_of(primitive), "attributes"), "TANGENT");
		drop_attribute(e, nt_json_find(primitive, "attributes"), gone);
		for (size_t t = 0; t < nt_json_count(targets); t++)
			drop_attribute(e, nt_json_at(targets, t), gone);
	}
	for (uint32_t i = 0; i < document->accessor_count; i++)
		if (gone[i] && !document->users[i].foreign && !document->users[i].idle &&
			gone[i] == document->users[i].attributes)
			nt_gltf_drop_elements(e->edits, i);
	free(gone);
	return NT_OK;
}

nt_status nt_gltf_edit(nt_scene *scene, const nt_write_options *options, nt_output *output, nt_error *error)
{
	/* Nothing to be done: the input as it is. */
	nt_gltf *document = scene->source;
	bool written = false, all_stay = !options->turned || !options->turned->count;
	nt_status status = NT_OK;
	for (size_t i = 0; all_stay && i < scene->mesh_count; i++)
		all_stay = stays(scene, options, &scene->meshes[i]) &&
			scene->meshes[i].decision != NT_SKIP_DROPPED;
	if (all_stay && !options->weld)
		status = nt_gltf_copy_unchanged(scene, options, output, &written, error);
	for (size_t p = 0; written && document->pools && p < document->pools->count; p++)
		count_shared(scene, document->pools, p, NULL);
	if (status || written)
		return status;

	/* Which bytes may change. */
	nt_arena of_window = {0};
	nt_buffer_edits edits = {0};
	if (!document->pools)
		status = nt_vertex_pools_find(scene, options, error);
	if (!status)
		status = nt_edits_create(&edits, document->pools, options->meshopt == NT_MESHOPT_KEEP,
			options->weld, error);

	/* The edits, and with them the document. */
	bool quantized = false;
	const editing e = {.scene = scene, .options = options, .pools = document->pools, .edits = &edits,
		.of_window = &of_window, .quantized = &quantized, .error = error};
	if (!status)
		status = edit_pools(&e);
	if (!status)
		status = drop_unused(&e);
	nt_arena_free(&of_window);
	if (edits.vertices_copied)
		nt_vertices_tell_scenes(scene);
	if (!status && all_stay && scene->welded.after == scene->welded.before)
		status = nt_gltf_copy_unchanged(scene, options, output, &written, error);
	if (!status && !written)
		status = nt_gltf_write_document(scene, &edits, options, output, error);
	nt_edits_free(&edits);
	return status;
}

/* SPDX-License-Identifier: MIT */
/*
 * --weld: vertices of a pool that are equal in everything become one, and all of its primitives get indices.
 *
 * It comes last, after splits were merged and tangents rounded as they will be stored: so what is equal is what a
 * reader would find equal. For a soup this is what a solve of the welded mesh gives, since MikkTSpace welds corners
 * itself; vertices whose corners have different tangents stay apart. The first of equal vertices stands for them, in
 * their order; elements are moved, never changed, so that each corner has the bits that it had.
 *
 * If triangles were not split, indices are only renumbered: strips and lines stay such. A pool is left alone if its
 * vertices have meaning by their numbers: extensions that refer to them, accessors that something else than attributes
 * uses, Draco blocks that this run does not encode.
 */
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/document.h"
#include "gltf/load.h"
#include "scene/values.h"

/* Something that vertices have. */
typedef struct column {
	const unsigned char *bytes;
	size_t stride, width;
	bool of_source; /* by the vertex of the source, else by the vertex itself */
} column;

typedef struct welding {
	nt_buffer_edits *edits;
	nt_pool_vertices *vertices;
	nt_arena *scratch;
	bool bitangents;
	column *columns;
	size_t count, capacity;
	const char *obstacle; /* why the pool stays; NULL: nothing does */

	size_t morph; /* of the user whose attributes are looked at: the next one that is solved */
	nt_error *error;
} welding;

/* ---- what forbids it ---- */

static nt_status find_obstacle(welding *w, nt_scene *scene)
{
	const nt_vertex_pool *pool = w->vertices->pool;
	const nt_gltf_accessor *positions = nt_gltf_named(w->edits->document,
		nt_json_find(nt_pool_primitive(pool, 0), "attributes"), "POSITION");
	if (positions && positions->view == NT_NONE && !positions->decoded && !positions->packed &&
		positions->count > NT_GLTF_UNBACKED)
		w->obstacle = "no bufferView has its positions";
	nt_status status = NT_OK;
	for (size_t i = 0; !status && !w->obstacle && i < pool->user_count; i++) {
		status = nt_vertices_find_meaning(scene, nt_pool_mesh(pool, i), w->vertices->old_count, &w->obstacle);
		if (!w->obstacle && !nt_pool_is_solved(pool, i) && nt_gltf_draco_of(nt_pool_primitive(pool, i)))
			w->obstacle = "Draco compresses it, and this run does not compress it again";
	}
	return status ? nt_fail_memory(w->error) : NT_OK;
}

/* Faults of the document leave the pool as it is; whoever needs what is faulty says so. */
static nt_status leave_faulty(welding *w, nt_status status)
{
	if (!status || status == NT_ERROR_MEMORY || status == NT_ERROR_IO || status == NT_ERROR_MISSING)
		return status;
	w->obstacle = "it cannot be read";
	nt_error_clear(w->error);
	return NT_OK;
}

/* ---- what vertices have ---- */

static bool add_column(welding *w, column added)
{
	if (!nt_grow((void **)&w->columns, &w->capacity, w->count + 1, sizeof *w->columns))
		return false;
	w->columns[w->count++] = added;
	return true;
}

/* Whether the output does not have what a user of the pool has there: new elements take its place, or it goes. */
static bool is_replaced(welding *w, size_t user, const nt_gltf_use *use)
{
	const nt_mesh *mesh = nt_pool_mesh(w->vertices->pool, user);
	const bool tangent = strcmp(use->name, "TANGENT") == 0;
	if (!nt_pool_is_solved(w->vertices->pool, user))
		return tangent && mesh->decision == NT_SKIP_DROPPED;
	if (!use->object)
		return tangent || (mesh->normals_made && strcmp(use->name, "NORMAL") == 0) ||
			(w->bitangents && strcmp(use->name, "_BITANGENT") == 0);
	/* targets come in their order, and so do those that are solved */
	const size_t target = use->object - 1;
	while (w->morph < mesh->morph_count && mesh->morphs[w->morph].target < target)
		w->morph++;
	return tangent && w->morph < mesh->morph_count && mesh->morphs[w->morph].target == target;
}

static nt_status add_attribute(welding *w, uint32_t index)
{
	uint32_t *known = &w->edits->accessors[nt_gltf_same(w->edits->document, index)].welded;
	if (*known == w->edits->weld_count || w->obstacle)
		return NT_OK;
	*known = w->edits->weld_count;
	const nt_gltf_accessor *a;
	column c = {.of_source = true};
	nt_status status = nt_gltf_get_accessor(w->edits->document, index, "/accessors", &a, w->error);
	/* first, as an accessor without a bufferView may claim any number */
	if (!status && a->count != w->vertices->old_count)
		w->obstacle = "its attributes differ in their number of elements";
	else if (!status && nt_gltf_users_of(w->edits->document, index)->foreign)
		w->obstacle = "something else uses its attributes";
	else if (!status)
		status = nt_gltf_whole_elements(w->edits->document, a, w->scratch, &c.bytes, &c.stride, w->error);
	if (status)
		return leave_faulty(w, status);
	c.width = a->element_bytes;
	/* without a view all elements are zero */
	return w->obstacle || !c.bytes || add_column(w, c) ? NT_OK : nt_fail_memory(w->error);
}

static nt_status list_columns(welding *w, const nt_stored_tangents *stored)
{
	const nt_vertex_pool *pool = w->vertices->pool;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && !w->obstacle && i < pool->user_count; i++) {
		const nt_json_value *primitive = nt_pool_primitive(pool, i);
		w->morph = 0;
		for (nt_gltf_use u = {0}; !status && nt_gltf_next_use(w->edits->document, primitive, &u);) {
			if (nt_gltf_users_of(w->edits->document, u.accessor)->idle)
				w->obstacle = "an accessor that no primitive uses has its bytes";
			if (!is_replaced(w, i, &u))
				status = add_attribute(w, u.accessor);
		}
	}
	bool added = true;
	for (size_t s = 0; !status && s < pool->sets.count; s++) {
		const nt_pool_set *set = &w->vertices->sets[s];
		const column tangents = stored
			? (column){stored[s].values, stored[s].element_bytes, stored[s].element_bytes, false}
			: (column){(const unsigned char *)set->tangents, 4 * sizeof(float), 4 * sizeof(float), false};
		if (tangents.bytes)
			added = added && add_column(w, tangents);
		if (set->normals)
			added = added && add_column(w, (column){(const unsigned char *)set->normals, 3 * sizeof(float),
				3 * sizeof(float), false});
	}
	return status || added ? status : nt_fail_memory(w->error);
}

/* ---- which are equal ---- */

static const unsigned char *element(const welding *w, const column *c, size_t vertex)
{
	return c->bytes + c->stride * (c->of_source ? nt_vertex_source(w->vertices, vertex) : vertex);
}

static bool are_equal(const welding *w, size_t a, size_t b)
{
	for (size_t i = 0; i < w->count; i++)
		if (memcmp(element(w, &w->columns[i], a), element(w, &w->columns[i], b), w->columns[i].width) != 0)
			return false;
	return true;
}

/* remap: [new_count] receives numbers of those that the columns say are equal; kept: [new_count] the first ones, of
 * which the number is returned; 0: memory is exhausted. */
static size_t find_equal(const welding *w, uint32_t *remap, uint32_t *kept)
{
	nt_hash_index known = {0};
	size_t count = 0;
	bool added = true;
	for (size_t v = 0; added && v < w->vertices->new_count; v++) {
		uint64_t hash = 0;
		for (size_t i = 0; i < w->count; i++)
			hash = nt_hash_bytes(hash, element(w, &w->columns[i], v), w->columns[i].width);
		uint32_t number;
		for (size_t at = NT_HASH_BEGIN; (number = nt_hash_index_next(&known, hash, &at)) != UINT32_MAX;)
			if (are_equal(w, kept[number], v))
				break;
		if (number == UINT32_MAX) {
			number = (uint32_t)count;
			kept[count++] = (uint32_t)v;
			added = nt_hash_index_add(&known, hash, number);
		}
		remap[v] = number;
	}
	nt_hash_index_free(&known);
	return added ? count : 0;
}

/* Divides groups of vertices by what a target makes of them. parent: room for as many as vertices. Returns the number
 * of groups, 0: memory is exhausted. */
static size_t divide(const welding *w, const float *tangents, uint32_t *group, uint32_t *first, uint32_t *parent,
	size_t count)
{
	nt_hash_index others = {0}; /* groups that come of it */
	bool done = true;
	for (size_t v = 0; done && v < w->vertices->new_count; v++) {
		const uint32_t before = group[v];
		const float *row = tangents + 3 * v;
		if (memcmp(row, tangents + 3 * (size_t)first[before], 3 * sizeof *row) == 0)
			continue;
		const uint64_t hash = nt_hash_bytes(before, row, 3 * sizeof *row);
		uint32_t other;
		for (size_t at = NT_HASH_BEGIN; (other = nt_hash_index_next(&others, hash, &at)) != UINT32_MAX;)
			if (parent[other] == before &&
				memcmp(row, tangents + 3 * (size_t)first[other], 3 * sizeof *row) == 0)
				break;
		if (other == UINT32_MAX) {
			other = (uint32_t)count++;
			first[other] = (uint32_t)v;
			parent[other] = before;
			done = nt_hash_index_add(&others, hash, other);
		}
		group[v] = other;
	}
	nt_hash_index_free(&others);
	return done ? count : 0;
}

/* The same by all targets, of which one is unpacked at a time, until no two vertices are equal; arrays as
 * find_equal() has them. */
static size_t divide_by_targets(const welding *w, uint32_t *remap, uint32_t *kept, size_t count)
{
	nt_pool_vertices *vertices = w->vertices;
	nt_arena target = {0};
	uint32_t *parent = nt_alloc(vertices->new_count, sizeof *parent), *number = parent;
	if (!parent)
		count = 0;
	for (uint32_t s = 0; s < vertices->pool->sets.count; s++)
		for (size_t m = 0; count && count < vertices->new_count && m < vertices->sets[s].morph_count; m++) {
			nt_arena_clear(&target);
			const float *tangents = nt_pool_read_target(vertices, s, m, &target);
			count = tangents ? divide(w, tangents, remap, kept, parent, count) : 0;
		}
	/* in the order of the first of each */
	for (size_t v = 0, next = 0; count && v < vertices->new_count; v++) {
		const uint32_t group = remap[v];
		if (kept[group] == v)
			number[group] = (uint32_t)next++;
		remap[v] = number[group];
	}
	for (size_t v = 0, next = 0; count && v < vertices->new_count; v++)
		if (remap[v] == next)
			kept[next++] = (uint32_t)v;
	nt_arena_free(&target);
	free(parent);
	return count;
}

/* ---- the welded vertices ---- */

/* Elements of those that stay. */
static void *gather(nt_arena *arena, const void *from, size_t width, const uint32_t *kept, size_t count)
{
	unsigned char *to = nt_arena_alloc(arena, count, width);
	for (size_t i = 0; to && i < count; i++)
		memcpy(to + i * width, (const unsigned char *)from + kept[i] * width, width);
	return to;
}

static bool gather_set(nt_arena *arena, nt_pool_set *set, nt_stored_tangents *stored, const uint32_t *kept,
	size_t count)
{
	set->tangents = gather(arena, set->tangents, 4 * sizeof(float), kept, count);
	bool done = set->tangents;
	if (set->normals)
		done &= (set->normals = gather(arena, set->normals, 3 * sizeof(float), kept, count)) != NULL;
	if (set->givers)
		done &= (set->givers = gather(arena, set->givers, sizeof *kept, kept, count)) != NULL;
	if (set->given)
		done &= (set->given = gather(arena, set->given, sizeof *kept, kept, count)) != NULL;
	else if (set->morph_count && (done &= (set->given = nt_arena_alloc(arena, count, sizeof *kept)) != NULL))
		memcpy(set->given, kept, count * sizeof *kept);
	if (!stored || !stored->values)
		return done;
	const bool filtered = stored->stored != stored->values;
	stored->values = gather(arena, stored->values, stored->element_bytes, kept, count);
	stored->stored = filtered ? gather(arena, stored->stored, stored->element_bytes, kept, count) : stored->values;
	return done && stored->values && stored->stored;
}

/* The indices of a user as they are: of the source, or triangles that were split. renumbered: they only change numbers;
 * a Draco block has triangles. */
static nt_status indices_of(welding *w, size_t user, const uint32_t **indices, size_t *count, bool *renumbered)
{
	const nt_pool_vertices *vertices = w->vertices;
	const nt_json_value *primitive = nt_pool_primitive(vertices->pool, user);
	const uint32_t number = nt_gltf_reference(w->edits->document, primitive, "indices");
	const nt_gltf_accessor *a;
	const nt_user_indices *split = &vertices->users[user];
	*renumbered = !split->numbers || !(split->changed || nt_gltf_draco_of(primitive));
	if (!*renumbered) {
		*indices = split->numbers;
		*count = split->count;
		return NT_OK;
	}
	if (nt_json_find(primitive, "indices")) {
		uint32_t *read;
		nt_status status = nt_gltf_get_accessor(w->edits->document, number,
			nt_gltf_of_mesh(nt_pool_mesh(vertices->pool, user)).pointer, &a, w->error);
		if (!status)
			status = nt_gltf_indices(w->edits->document, a, vertices->old_count, w->scratch, &read,
				w->error);
		*indices = status ? NULL : read;
		*count = status ? 0 : (size_t)a->count;
		return status;
	}
	uint32_t *all = nt_arena_alloc(w->scratch, vertices->old_count, sizeof *all);
	for (size_t i = 0; all && i < vertices->old_count; i++)
		all[i] = (uint32_t)i;
	*indices = all;
	*count = vertices->old_count;
	return all ? NT_OK : nt_fail_memory(w->error);
}

/* to: [user_count] */
static nt_status renumber(welding *w, const uint32_t *remap, nt_user_indices *to)
{
	const size_t user_count = w->vertices->pool->user_count;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && !w->obstacle && i < user_count; i++) {
		const uint32_t *old = NULL;
		to[i] = (nt_user_indices){.changed = true};
		status = leave_faulty(w, indices_of(w, i, &old, &to[i].count, &to[i].renumbered));
		if (status || w->obstacle)
			break;
		to[i].numbers = nt_arena_alloc(&w->edits->arena, to[i].count, sizeof *to[i].numbers);
		if (!to[i].numbers)
			status = nt_fail_memory(w->error);
		for (size_t c = 0; !status && c < to[i].count; c++)
			to[i].numbers[c] = remap[old[c]];
	}
	return status;
}

/* Nothing is changed if there turns out to be an obstacle. */
static nt_status take_welded(welding *w, nt_stored_tangents *stored, const uint32_t *remap, const uint32_t *kept,
	size_t count)
{
	nt_pool_vertices *vertices = w->vertices;
	nt_arena *arena = &w->edits->arena;
	const size_t user_count = vertices->pool->user_count;
	nt_pool_vertices to = {.pool = vertices->pool, .old_count = vertices->old_count, .new_count = count,
		.seen_equal = true,
		.sources = nt_arena_alloc(arena, count, sizeof *to.sources), .sets = vertices->sets,
		.users = nt_arena_alloc(arena, user_count, sizeof *to.users)};
	bool done = to.sources && to.users;
	const nt_status status = done ? renumber(w, remap, to.users) : NT_ERROR_MEMORY;
	if (w->obstacle || (status && status != NT_ERROR_MEMORY))
		return status;
	for (size_t s = 0; done && s < vertices->pool->sets.count; s++)
		done = gather_set(arena, &vertices->sets[s], stored ? &stored[s] : NULL, kept, count);
	if (!done)
		return nt_fail_memory(w->error);
	for (size_t i = 0; i < count; i++)
		to.sources[i] = (uint32_t)nt_vertex_source(vertices, kept[i]);
	*vertices = to;
	return status;
}

/* ---- one pool ---- */

/* Points are drawn as often as they are there, and share nothing. */
static bool draws_points_alone(const nt_vertex_pool *pool)
{
	for (size_t i = 0; i < pool->user_count; i++)
		if (nt_gltf_mode(nt_pool_primitive(pool, i)) != NT_GLTF_POINTS)
			return false;
	return true;
}

nt_status nt_pool_weld(nt_buffer_edits *edits, nt_scene *scene, nt_pool_vertices *vertices,
	nt_stored_tangents *stored, bool bitangents, nt_arena *scratch, nt_error *error)
{
	welding w = {.edits = edits, .vertices = vertices, .scratch = scratch,
		.bitangents = bitangents, .error = error};
	const size_t before = vertices->new_count;
	vertices->seen_equal = true;
	edits->weld_count++;
	if (draws_points_alone(vertices->pool))
		return NT_OK;
	nt_status status = find_obstacle(&w, scene);
	if (!status && !w.obstacle)
		status = list_columns(&w, stored);
	if (!status && !w.obstacle) {
		uint32_t *remap = nt_alloc(before, sizeof *remap), *kept = nt_alloc(before, sizeof *kept);
		size_t count = remap && kept ? find_equal(&w, remap, kept) : 0;
		if (count)
			count = divide_by_targets(&w, remap, kept, count);
		if (!count && before)
			status = nt_fail_memory(error);
		else if (count < before)
			status = take_welded(&w, stored, remap, kept, count);
		scene->welded.before += w.obstacle ? 0 : before;
		scene->welded.after += w.obstacle ? 0 : count;
		free(remap);
		free(kept);
	}
	if (!status && w.obstacle)
		nt_finding_add(&scene->findings, NT_CODE_WELD_LEFT, nt_mesh_place(nt_pool_mesh(vertices->pool, 0),
			&(nt_place){0}), vertices->pool->user_count, "%s", w.obstacle);
	free(w.columns);
	return status;
}

nt_status nt_pool_vertices_plain(const nt_vertex_pools *pools, nt_vertex_pool *pool, nt_arena *tables,
	nt_pool_vertices *vertices, bool *can, nt_error *error)
{
	const nt_gltf_accessor *a = nt_gltf_named(pools->scene->source, nt_json_find(nt_pool_primitive(pool, 0),
		"attributes"), "POSITION");
	*can = a && a->count < NT_NONE;
	const size_t count = a ? (size_t)a->count : 0;
	*vertices = (nt_pool_vertices){.pool = pool, .old_count = count, .new_count = count, .own_count = count,
		.users = nt_arena_alloc(tables, pool->user_count, sizeof *vertices->users)};
	pool->sets.count = 0;
	if (!vertices->users)
		return nt_fail_memory(error);
	for (size_t i = 0; i < pool->user_count; i++) {
		pool->sets.of[i] = NT_NONE;
		vertices->users[i] = (nt_user_indices){.numbers = NULL};
	}
	return NT_OK;
}

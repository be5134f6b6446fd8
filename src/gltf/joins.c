/* SPDX-License-Identifier: MIT */
/*
 * Which primitives are one surface to a baker: those of one glTF mesh that use the same texture coordinates in the
 * same way. Two things say so: the number of the set that tangents follow, and the texture transform; together they are
 * a primitive's kind. Each kind of which a primitive gets tangents is a join, if it has further primitives.
 *
 * Primitives that get no tangents contribute their triangles all the same: those with tangents of their own to the
 * join of their kind, those whose materials ask for nothing, which have no kind, to every join whose set they have.
 * They take part as copies, since they may be wanted with another set than they name, and turned by another
 * material's transform. A primitive without normals is shaded flat and has nothing to weld; it contributes where
 * normals are made for it.
 *
 * Repeated parts count once. Primitives with the same geometry (geometry_key.c) lie on each other: the
 * first contributes, and the others have its result, so that a small file that names the same triangles a thousand
 * times costs what one that names them once does, and a surface with two materials on it is no other surface. A join
 * whose parts are those of an earlier one, in another mesh, has that one's result.
 */
#include "gltf/vertex_pools.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/materials.h"
#include "gltf/document.h"

/* Primitives without a kind take part in the joins of so many kinds of a mesh, so that a file with a transform for
 * every primitive costs linear time and memory. Meshes that people make have one or two kinds. */
enum { MOST_KINDS = 8 };

static const uint32_t NO_KIND = UINT32_MAX;

typedef struct kind {
	uint64_t set;
	double rotation, scale[2];
} kind;

/* A join that is only to be compared costs at most so many times what is solved anyway, or so many triangles. */
enum { MOST_TIMES = 4, ALWAYS = 65536 };

/* The primitives of one kind of a mesh, each geometry once: a join, or one primitive by itself. */
typedef struct unit {
	nt_mesh **parts; /* [part_count] */
	size_t part_count;
} unit;

/* All of them. */
typedef struct search {
	nt_scene *scene;
	bool solved, kept;     /* see vertex_pools.h */
	size_t solved_faces;   /* of what is solved without joins */
	nt_key_table keys;     /* of units that differ: a kind and the geometry of its parts */
	unit *units;           /* [keys.names.count] */
	size_t unit_capacity;
	uint32_t *unit_of;     /* [mesh_count] of the first mesh with a geometry: the last unit that has it */
	uint32_t *part_of;     /* [mesh_count] and which part of that one it is */
	uint32_t unit_count;
} search;

/* The primitives of one glTF mesh. */
typedef struct group {
	nt_scene *scene;
	nt_gltf *document;
	bool kept;             /* see vertex_pools.h */
	uint32_t begin, end;   /* in scene->meshes */
	uint32_t *kind_of;     /* [end - begin] or NO_KIND */
	kind *kinds;           /* [kind_count]; room for end - begin */
	uint32_t *wanted;      /* [kind_count] the first of them that gets tangents, or NT_NONE */
	uint32_t *first, *last; /* [kind_count] its primitives are a list in their order */
	uint32_t *next;        /* [end - begin] the next of its kind or NT_NONE */
	size_t kind_count;
	nt_hash_index known;   /* kinds by hash */
} group;

/* Whether the tangents of a primitive are asked for, and a solve can give them. */
static bool is_wanted(const nt_mesh *mesh, bool kept)
{
	return mesh->has_texcoords && (nt_mesh_gets_tangents(mesh) ||
		(kept && mesh->decision == NT_SKIP_HAS_TANGENTS && mesh->has_positions && mesh->has_normals));
}

/* ---- kinds ---- */

static nt_status read_kind(const group *g, const nt_mesh *mesh, kind *k, nt_error *error)
{
	nt_gltf_shading shading;
	const nt_status status = nt_gltf_find_slots(g->document, nt_gltf_primitive_of(g->document, mesh),
		nt_gltf_of_mesh(mesh).pointer, &shading, error);
	if (status)
		return status;
	const bool applies = nt_gltf_turns(&shading, mesh->texcoord_set);
	/* adding 0 makes 0 of -0 */
	const nt_uv_transform *uv = &shading.transform.uv;
	*k = (kind){mesh->texcoord_set, applies ? uv->rotation + 0.0 : 0,
		{applies ? uv->scale[0] + 0.0 : 1, applies ? uv->scale[1] + 0.0 : 1}};
	return NT_OK;
}

/* The number of a kind, which may be new; NO_KIND when memory is exhausted. */
static uint32_t number_of(group *g, const kind *k)
{
	const uint64_t hash = nt_hash_bytes(0, k, sizeof *k);
	uint32_t number;
	for (size_t at = NT_HASH_BEGIN; (number = nt_hash_index_next(&g->known, hash, &at)) != UINT32_MAX;)
		if (memcmp(&g->kinds[number], k, sizeof *k) == 0)
			return number;
	number = (uint32_t)g->kind_count;
	if (!nt_hash_index_add(&g->known, hash, number))
		return NO_KIND;
	g->kinds[number] = *k;
	g->wanted[number] = g->first[number] = g->last[number] = NT_NONE;
	g->kind_count++;
	return number;
}

static void append_to_kind(group *g, uint32_t mesh, uint32_t number)
{
	g->kind_of[mesh - g->begin] = number;
	if (g->first[number] == NT_NONE)
		g->first[number] = mesh;
	else
		g->next[g->last[number] - g->begin] = mesh;
	g->last[number] = mesh;
	if (is_wanted(&g->scene->meshes[mesh], g->kept) && g->wanted[number] == NT_NONE)
		g->wanted[number] = mesh;
}

static nt_status find_kinds(group *g, nt_error *error)
{
	for (uint32_t i = g->begin; i < g->end; i++) {
		const nt_mesh *mesh = &g->scene->meshes[i];
		g->kind_of[i - g->begin] = NO_KIND;
		g->next[i - g->begin] = NT_NONE;
		if (!mesh->slots && !is_wanted(mesh, g->kept))
			continue;
		kind k;
		const nt_status status = read_kind(g, mesh, &k, error);
		if (status)
			return status;
		const uint32_t number = number_of(g, &k);
		if (number == NO_KIND)
			return nt_fail_memory(error);
		append_to_kind(g, i, number);
	}
	return NT_OK;
}

/* ---- joins ---- */

/* Whether a primitive has what a solve with this set takes. */
static bool contributes(const group *g, const nt_mesh *mesh, uint64_t set)
{
	if (is_wanted(mesh, g->kept))
		return true;
	char name[40];
	snprintf(name, sizeof name, "TEXCOORD_%llu", (unsigned long long)set);
	return mesh->triangles && mesh->face_count > 0 && mesh->has_positions && mesh->has_normals &&
		nt_json_find(nt_json_find(nt_gltf_primitive_of(g->document, mesh), "attributes"), name);
}

static bool belongs(const group *g, uint32_t mesh, uint32_t number)
{
	const uint32_t own = g->kind_of[mesh - g->begin];
	return (own == number || (own == NO_KIND && number < MOST_KINDS)) &&
		contributes(g, &g->scene->meshes[mesh], g->kinds[number].set);
}

/* Goes through the primitives that may belong to a kind: all, or those of the kind. */
static uint32_t first_candidate(const group *g, uint32_t number)
{
	return number < MOST_KINDS ? g->begin : g->first[number];
}

static uint32_t next_candidate(const group *g, uint32_t mesh, uint32_t number)
{
	return number < MOST_KINDS ? mesh + 1 : g->next[mesh - g->begin];
}

/* The mesh that stands for a primitive in a join: itself, or a copy. */
static nt_mesh *part_of(const group *g, uint32_t mesh, uint32_t number)
{
	nt_mesh *own = &g->scene->meshes[mesh];
	if (is_wanted(own, g->kept))
		return own;
	nt_mesh *copy = nt_arena_alloc(&g->scene->arena, 1, sizeof *copy);
	if (!copy)
		return NULL;
	const kind *k = &g->kinds[number];
	const bool turns = k->rotation != 0 || k->scale[0] != 1 || k->scale[1] != 1;
	*copy = *own;
	/* where the primitive itself is loaded, for a report, and in the same way, that will do */
	const bool alike = own->texcoord_set == k->set && (!turns || g->kind_of[mesh - g->begin] == number);
	copy->plan.same_as = alike ? own : NULL;
	copy->texcoord_set = (uint32_t)k->set;
	copy->plan.transform_of = &g->scene->meshes[g->wanted[number]];
	return copy;
}

/* Which targets move a part of the join. */
static bool find_targets(const group *g, nt_join *join)
{
	for (size_t i = 0; i < join->part_count; i++) {
		const size_t count = nt_json_count(nt_json_find(
			nt_gltf_primitive_of(g->document, join->parts[i]), "targets"));
		join->target_count = count > join->target_count ? count : join->target_count;
	}
	join->moves = nt_arena_alloc(&g->scene->arena, join->target_count, sizeof *join->moves);
	if (!join->moves)
		return false;
	memset(join->moves, 0, join->target_count * sizeof *join->moves);
	for (size_t i = 0; i < join->part_count; i++) {
		const nt_json_value *targets =
			nt_json_find(nt_gltf_primitive_of(g->document, join->parts[i]), "targets");
		for (size_t t = 0; t < nt_json_count(targets); t++)
			join->moves[t] |= nt_json_find(nt_json_at(targets, t), "POSITION") ||
				nt_json_find(nt_json_at(targets, t), "NORMAL");
	}
	return true;
}

/* ---- units ---- */

/* The mesh that stands for all with the geometry that a primitive contributes; itself, where it contributes it with
 * other texture coordinates than its own. */
static uint32_t geometry_of(const group *g, uint32_t mesh, uint32_t number)
{
	const nt_mesh *own = &g->scene->meshes[mesh];
	const nt_mesh *same_as = own->texcoord_set == g->kinds[number].set ? own->plan.same_as : NULL;
	return same_as ? (uint32_t)(same_as - g->scene->meshes) : mesh;
}

/* The parts of a kind, and the unit's key. u->parts: room for all candidates. */
static bool find_parts(search *s, const group *g, uint32_t number, unit *u)
{
	nt_buffer_append(&s->keys.key, &g->kinds[number], sizeof g->kinds[number]);
	s->unit_count++;
	for (uint32_t i = first_candidate(g, number); i < g->end; i = next_candidate(g, i, number)) {
		if (!belongs(g, i, number))
			continue;
		const uint32_t geometry = geometry_of(g, i, number);
		if (s->unit_of[geometry] == s->unit_count)
			continue;
		s->unit_of[geometry] = s->unit_count;
		s->part_of[geometry] = (uint32_t)u->part_count;
		nt_key_put(&s->keys, geometry);
		u->parts[u->part_count] = part_of(g, i, number);
		if (!u->parts[u->part_count++])
			return false;
	}
	return !s->keys.key.failed;
}

/* The number of the first unit with the same key, which may be this one. NT_NONE: memory is exhausted. */
static uint32_t add_unit(search *s, const unit *u)
{
	const size_t known = s->keys.names.count;
	const uint32_t number = nt_key_number(&s->keys);
	if (number == NT_NONE ||
		!nt_grow((void **)&s->units, &s->unit_capacity, s->keys.names.count, sizeof *s->units))
		return NT_NONE;
	if (number == known)
		s->units[number] = *u;
	return number;
}

/* Decides which primitive takes whose result, now that the groups of a solve are known. */
static void share_results(const search *s, const group *g, uint32_t number, const unit *first)
{
	for (uint32_t i = first_candidate(g, number); i < g->end; i = next_candidate(g, i, number)) {
		nt_mesh *mesh = &g->scene->meshes[i];
		if (!belongs(g, i, number) || !is_wanted(mesh, g->kept))
			continue;
		const nt_mesh *giver = first->parts[s->part_of[geometry_of(g, i, number)]];
		mesh->plan.same_as = giver == mesh ? NULL : giver;
	}
}

static bool costs_too_much(const search *s, const unit *u)
{
	size_t faces = 0;
	for (size_t i = 0; i < u->part_count; i++)
		faces += u->parts[i]->face_count;
	return !s->solved && faces > MOST_TIMES * s->solved_faces + ALWAYS;
}

/* The unit of one kind becomes a join, if it has several parts and is the first of its like. */
static nt_status add_kind(search *s, const group *g, uint32_t number, nt_error *error)
{
	size_t count = 0;
	for (uint32_t i = first_candidate(g, number); i < g->end; i = next_candidate(g, i, number))
		count += belongs(g, i, number);
	unit u = {.parts = nt_arena_alloc(&g->scene->arena, count, sizeof *u.parts)};
	if (!u.parts || !find_parts(s, g, number, &u))
		return nt_fail_memory(error);
	const size_t known = s->keys.names.count;
	const uint32_t first = add_unit(s, &u);
	if (first == NT_NONE)
		return nt_fail_memory(error);
	if (s->solved)
		share_results(s, g, number, &s->units[first]);
	if (first < known || u.part_count < 2 || costs_too_much(s, &u))
		return NT_OK;
	nt_join *join = &g->scene->joins[g->scene->join_count++];
	*join = (nt_join){.parts = u.parts, .part_count = u.part_count, .first = &g->scene->meshes[g->wanted[number]]};
	return find_targets(g, join) ? NT_OK : nt_fail_memory(error);
}

/* The joins of one glTF mesh, behind those that the scene has. */
static nt_status join_group(search *s, group *g, nt_error *error)
{
	const size_t count = g->end - g->begin;
	g->kind_of = nt_alloc(count, sizeof *g->kind_of);
	g->next = nt_alloc(count, sizeof *g->next);
	g->kinds = nt_alloc(count, sizeof *g->kinds);
	g->wanted = nt_alloc(count, sizeof *g->wanted);
	g->first = nt_alloc(count, sizeof *g->first);
	g->last = nt_alloc(count, sizeof *g->last);
	nt_status status = NT_OK;
	if (!g->kind_of || !g->next || !g->kinds || !g->wanted || !g->first || !g->last)
		status = nt_fail_memory(error);
	if (!status)
		status = find_kinds(g, error);
	for (uint32_t k = 0; !status && k < g->kind_count; k++)
		if (g->wanted[k] != NT_NONE)
			status = add_kind(s, g, k, error);
	free(g->kind_of);
	free(g->next);
	free(g->kinds);
	free(g->wanted);
	free(g->first);
	free(g->last);
	nt_hash_index_free(&g->known);
	return status;
}

static nt_status join_all(search *s, nt_error *error)
{
	nt_scene *scene = s->scene;
	const uint32_t mesh_count = (uint32_t)scene->mesh_count;
	nt_status status = NT_OK;
	for (uint32_t begin = 0, end; !status && begin < mesh_count; begin = end) {
		bool any = false;
		for (end = begin; end < mesh_count &&
			scene->meshes[end].gltf_mesh == scene->meshes[begin].gltf_mesh; end++)
			any |= is_wanted(&scene->meshes[end], s->kept);
		group g = {.scene = scene, .document = scene->source, .kept = s->kept, .begin = begin, .end = end};
		/* primitives by themselves are looked at for whose result they have */
		if (any && (s->solved || end - begin > 1))
			status = join_group(s, &g, error);
	}
	return status;
}

nt_status nt_gltf_find_joins(nt_scene *scene, bool solved, bool kept, nt_error *error)
{
	search s = {.scene = scene, .solved = solved, .kept = kept,
		.unit_of = nt_calloc(scene->mesh_count, sizeof *s.unit_of),
		.part_of = nt_alloc(scene->mesh_count, sizeof *s.part_of)};
	size_t wanted = 0;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		wanted += is_wanted(mesh, kept);
		s.solved_faces += nt_mesh_gets_tangents(mesh) && !mesh->plan.same_as ? mesh->face_count : 0;
	}
	/* a join has one wanted primitive at least */
	scene->join_count = 0;
	scene->joins = nt_arena_alloc(&scene->arena, wanted, sizeof *scene->joins);
	const bool ready = s.unit_of && s.part_of && scene->joins;
	const nt_status status = ready ? join_all(&s, error) : nt_fail_memory(error);
	free(s.unit_of);
	free(s.part_of);
	free(s.units);
	nt_key_table_free(&s.keys);
	return status;
}

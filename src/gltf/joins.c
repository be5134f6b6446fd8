/* SPDX-License-Identifier: MIT */
/*
 * Which primitives are one surface to a baker: those of one glTF mesh that use the same texture coordinates in the
 * same way. Two things say so: the number of the set that tangents follow, and the texture transform; together they are
 * a primitive's kind. Each kind of which a primitive gets tangents is a join, if it has further primitives.
 *
 * Primitives that get no tangents contribute their triangles all the same: those with tangents of their own to the
 * join of their kind, those whose materials ask for nothing, which have no kind, to every join whose set they have.
 * They are loaded apart, as copies, since they may be wanted with another set than they name, and turned by another
 * material's transform. A primitive without normals is shaded flat and has nothing to weld; it contributes where normals
 * are made for it.
 */
#include "gltf/joins.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/materials.h"
#include "gltf/primitive.h"

/* Primitives without a kind take part in the joins of so many kinds of a mesh, so that a file with a transform for
 * every primitive costs linear time and memory. Meshes that people make have one or two kinds. */
enum { MOST_KINDS = 8 };

static const uint32_t NO_KIND = UINT32_MAX;

typedef struct kind {
	uint64_t set;
	double rotation, scale[2];
} kind;

/* The primitives of one glTF mesh. */
typedef struct group {
	nt_scene *scene;
	nt_gltf *document;
	bool kept;             /* see joins.h */
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
	return mesh->has_texcoords && (nt_mesh_is_wanted(mesh) ||
		(kept && mesh->decision == NT_SKIP_HAS_TANGENTS && mesh->has_positions && mesh->has_normals));
}

/* ---- kinds ---- */

static nt_status read_kind(const group *g, const nt_mesh *mesh, kind *k, nt_error *error)
{
	nt_gltf_shading shading;
	const nt_status status = nt_gltf_find_slots(g->document, nt_gltf_primitive_of(g->document, mesh),
		mesh->place.pointer, &shading, error);
	if (status)
		return status;
	const bool applies = shading.has_set && shading.set == mesh->texcoord_set && shading.transform.exists;
	/* adding 0 makes 0 of -0 */
	*k = (kind){mesh->texcoord_set, applies ? shading.transform.rotation + 0.0 : 0,
		{applies ? shading.transform.scale[0] + 0.0 : 1, applies ? shading.transform.scale[1] + 0.0 : 1}};
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

/* What stands for a primitive in a join: itself, or a copy that is loaded for it. */
static nt_mesh *part_of(const group *g, uint32_t mesh, uint32_t number)
{
	nt_mesh *own = &g->scene->meshes[mesh];
	if (is_wanted(own, g->kept))
		return own;
	nt_mesh *copy = nt_arena_alloc(&g->scene->arena, 1, sizeof *copy);
	if (!copy)
		return NULL;
	*copy = *own;
	copy->texcoord_set = (uint32_t)g->kinds[number].set;
	copy->transform_of = &g->scene->meshes[g->wanted[number]];
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

/* The join of one kind; with one part it is none. */
static bool make_join(const group *g, uint32_t number, nt_join *join)
{
	*join = (nt_join){0};
	size_t count = 0;
	for (uint32_t i = first_candidate(g, number); i < g->end; i = next_candidate(g, i, number))
		count += belongs(g, i, number);
	if (count < 2)
		return true;
	join->parts = nt_arena_alloc(&g->scene->arena, count, sizeof *join->parts);
	if (!join->parts)
		return false;
	join->first = &g->scene->meshes[g->wanted[number]];
	for (uint32_t i = first_candidate(g, number); i < g->end; i = next_candidate(g, i, number))
		if (belongs(g, i, number) && !(join->parts[join->part_count++] = part_of(g, i, number)))
			return false;
	return find_targets(g, join);
}

/* The joins of one glTF mesh, behind those that the scene has. */
static nt_status join_group(group *g, nt_error *error)
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
	for (uint32_t k = 0; !status && k < g->kind_count; k++) {
		nt_join *join = &g->scene->joins[g->scene->join_count];
		if (g->wanted[k] == NT_NONE)
			continue;
		if (!make_join(g, k, join))
			status = nt_fail_memory(error);
		g->scene->join_count += join->part_count > 0;
	}
	free(g->kind_of);
	free(g->next);
	free(g->kinds);
	free(g->wanted);
	free(g->first);
	free(g->last);
	nt_hash_index_free(&g->known);
	return status;
}

nt_status nt_gltf_find_joins(nt_scene *scene, bool kept, nt_error *error)
{
	const uint32_t mesh_count = (uint32_t)scene->mesh_count;
	size_t wanted = 0;
	for (uint32_t i = 0; i < mesh_count; i++)
		wanted += is_wanted(&scene->meshes[i], kept);
	/* a join has one wanted primitive at least */
	scene->join_count = 0;
	scene->joins = nt_arena_alloc(&scene->arena, wanted, sizeof *scene->joins);
	if (!scene->joins)
		return nt_fail_memory(error);
	nt_status status = NT_OK;
	for (uint32_t begin = 0, end; !status && begin < mesh_count; begin = end) {
		bool any = false;
		for (end = begin; end < mesh_count &&
			scene->meshes[end].gltf_mesh == scene->meshes[begin].gltf_mesh; end++)
			any |= is_wanted(&scene->meshes[end], kept);
		group g = {.scene = scene, .document = scene->source, .kept = kept, .begin = begin, .end = end};
		if (any && end - begin > 1)
			status = join_group(&g, error);
	}
	return status;
}

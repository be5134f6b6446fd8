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

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "scene/values.h"

/* Primitives without a kind take part in the joins of so many kinds of a mesh, so that a file with a transform for
 * every primitive costs linear time and memory. Meshes that people make have one or two kinds. */
enum { MOST_KINDS = 8 };

/* Primitives of a mesh that belong together. */
typedef struct kind {
	uint64_t set;
	double rotation, scale[2];
	/* so far they are the kind, from here on its primitives: */
	uint32_t first;
	uint32_t wanted; /* the first of them that gets tangents; NT_NONE: none */
} kind;

/* A join that is only to be compared costs at most so many times what is solved anyway, or so many triangles. */
enum { MOST_TIMES = 4, ALWAYS = 65536 };

/* The primitives of one kind of a mesh, each geometry once: a join, or one primitive by itself. */
typedef struct unit {
	nt_mesh **parts; /* [part_count] */
	size_t part_count;
} unit;

typedef struct search {
	nt_scene *scene;
	bool solved, kept;     /* see vertex_pools.h */
	size_t solved_faces;   /* of what is solved without joins */
	/* the primitives of the glTF mesh that is looked at */
	uint32_t begin, end;   /* in scene->meshes */
	kind *kinds;           /* [kind_count]; room for [mesh_count] */
	size_t kind_count;
	uint32_t *kind_of;     /* [mesh_count] NT_NONE: none */
	uint32_t *next;        /* [mesh_count] the next of its kind; NT_NONE: none */
	/* the units of all */
	nt_key_table keys;     /* of units that differ: a kind and the geometry of its parts */
	unit *units;           /* [keys.names.count] */
	size_t unit_capacity;
	uint32_t *unit_of;     /* [mesh_count] of the first mesh with a geometry: the last unit that has it */
	uint32_t *part_of;     /* [mesh_count] and which part of that one it is */
	uint32_t unit_count;
} search;

/* Whether the tangents of a primitive are asked for, and a solve can give them. */
static bool is_wanted(const search *s, const nt_mesh *mesh)
{
	return mesh->has_texcoords && (nt_mesh_gets_tangents(mesh) ||
		(s->kept && mesh->decision == NT_SKIP_HAS_TANGENTS && mesh->has_positions && mesh->has_normals));
}

/* ---- kinds ---- */

static bool find_kinds(search *s)
{
	nt_key_table known = {0};
	uint32_t number = 0;
	s->kind_count = 0;
	for (uint32_t i = s->begin; i < s->end && number != NT_NONE; i++) {
		const nt_mesh *mesh = &s->scene->meshes[i];
		const nt_uv_transform *uv = mesh->transform;
		s->kind_of[i] = NT_NONE;
		if (!mesh->slots && !is_wanted(s, mesh))
			continue;
		/* adding 0 makes 0 of -0 */
		const kind k = {mesh->texcoord_set, uv ? uv->rotation + 0.0 : 0,
			{uv ? uv->scale[0] + 0.0 : 1, uv ? uv->scale[1] + 0.0 : 1}, NT_NONE, NT_NONE};
		nt_buffer_append(&known.key, &k, offsetof(kind, first));
		number = s->kind_of[i] = nt_key_number(&known);
		if (number == s->kind_count)
			s->kinds[s->kind_count++] = k;
	}
	nt_key_table_free(&known);
	for (uint32_t i = s->end; number != NT_NONE && i-- > s->begin;) {
		kind *k = s->kind_of[i] != NT_NONE ? &s->kinds[s->kind_of[i]] : NULL;
		if (!k)
			continue;
		s->next[i] = k->first;
		k->first = i;
		if (is_wanted(s, &s->scene->meshes[i]))
			k->wanted = i;
	}
	return number != NT_NONE;
}

/* ---- joins ---- */

/* Whether a primitive has what a solve with this set takes. */
static bool contributes(const search *s, const nt_mesh *mesh, uint64_t set)
{
	if (is_wanted(s, mesh))
		return true;
	char name[40];
	nt_gltf_put_number(nt_gltf_put_text(name, "TEXCOORD_"), set);
	return mesh->triangles && mesh->face_count > 0 && mesh->has_positions && mesh->has_normals &&
		nt_json_find(nt_json_find(nt_gltf_primitive_of(s->scene->source, mesh), "attributes"), name);
}

/* The first primitive from `mesh` on that belongs to a kind, `end` if there is none. The first kinds have
 * those that have none, too. */
static uint32_t find_member(const search *s, uint32_t mesh, uint32_t number)
{
	while (mesh < s->end) {
		const uint32_t own = s->kind_of[mesh];
		if ((own == number || (own == NT_NONE && number < MOST_KINDS)) &&
			contributes(s, &s->scene->meshes[mesh], s->kinds[number].set))
			break;
		mesh = number < MOST_KINDS ? mesh + 1 : s->next[mesh];
	}
	return mesh < s->end ? mesh : s->end;
}

static uint32_t first_member(const search *s, uint32_t number)
{
	return find_member(s, number < MOST_KINDS ? s->begin : s->kinds[number].first, number);
}

static uint32_t next_member(const search *s, uint32_t mesh, uint32_t number)
{
	return find_member(s, number < MOST_KINDS ? mesh + 1 : s->next[mesh], number);
}

/* The mesh that stands for a primitive in a join: itself, or a copy. */
static nt_mesh *part_of(const search *s, uint32_t mesh, uint32_t number)
{
	nt_mesh *own = &s->scene->meshes[mesh];
	if (is_wanted(s, own))
		return own;
	nt_mesh *copy = nt_arena_alloc(&s->scene->arena, 1, sizeof *copy);
	if (!copy)
		return NULL;
	const kind *k = &s->kinds[number];
	const bool turns = k->rotation != 0 || k->scale[0] != 1 || k->scale[1] != 1;
	*copy = *own;
	copy->transform = s->scene->meshes[k->wanted].transform;
	/* where the primitive itself is loaded, for a report, and in the same way, that will do */
	const bool alike = own->texcoord_set == k->set && (!turns || s->kind_of[mesh] == number);
	copy->plan.same_as = alike ? own : NULL;
	copy->texcoord_set = (uint32_t)k->set;
	copy->plan.copied = true;
	return copy;
}

/* Which targets move a part of the join. */
static bool find_targets(const search *s, nt_join *join)
{
	for (size_t i = 0; i < join->part_count; i++) {
		const size_t count = nt_json_count(nt_json_find(
			nt_gltf_primitive_of(s->scene->source, join->parts[i]), "targets"));
		join->target_count = count > join->target_count ? count : join->target_count;
	}
	join->moves = nt_arena_alloc(&s->scene->arena, join->target_count, sizeof *join->moves);
	if (!join->moves)
		return false;
	memset(join->moves, 0, join->target_count * sizeof *join->moves);
	for (size_t i = 0; i < join->part_count; i++) {
		const nt_json_value *targets =
			nt_json_find(nt_gltf_primitive_of(s->scene->source, join->parts[i]), "targets");
		for (size_t t = 0; t < nt_json_count(targets); t++)
			join->moves[t] |= nt_json_find(nt_json_at(targets, t), "POSITION") ||
				nt_json_find(nt_json_at(targets, t), "NORMAL");
	}
	return true;
}

/* ---- units ---- */

/* The mesh that stands for all with the geometry that a primitive contributes; itself, where it contributes it with
 * other texture coordinates than its own. */
static uint32_t geometry_of(const search *s, uint32_t mesh, uint32_t number)
{
	const nt_mesh *own = &s->scene->meshes[mesh];
	const nt_mesh *same_as = own->texcoord_set == s->kinds[number].set ? own->plan.same_as : NULL;
	return same_as ? (uint32_t)(same_as - s->scene->meshes) : mesh;
}

/* The parts of a kind, and the unit's key. u->parts: room for all members. */
static bool find_parts(search *s, uint32_t number, unit *u)
{
	nt_buffer_append(&s->keys.key, &s->kinds[number], offsetof(kind, first));
	s->unit_count++;
	for (uint32_t i = first_member(s, number); i < s->end; i = next_member(s, i, number)) {
		const uint32_t geometry = geometry_of(s, i, number);
		if (s->unit_of[geometry] == s->unit_count)
			continue;
		s->unit_of[geometry] = s->unit_count;
		s->part_of[geometry] = (uint32_t)u->part_count;
		nt_key_put(&s->keys, geometry);
		u->parts[u->part_count] = part_of(s, i, number);
		if (!u->parts[u->part_count++])
			return false;
	}
	return true;
}

/* Decides which primitive takes whose result, now that the groups of a solve are known. */
static void share_results(const search *s, uint32_t number, const unit *first)
{
	for (uint32_t i = first_member(s, number); i < s->end; i = next_member(s, i, number)) {
		nt_mesh *mesh = &s->scene->meshes[i];
		if (!is_wanted(s, mesh))
			continue;
		const nt_mesh *giver = first->parts[s->part_of[geometry_of(s, i, number)]];
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

/* The unit of one kind becomes a join, if it has several parts and is the first of its like. False: out of memory. */
static bool add_kind(search *s, uint32_t number)
{
	size_t count = 0;
	for (uint32_t i = first_member(s, number); i < s->end; i = next_member(s, i, number))
		count++;
	unit u = {.parts = nt_arena_alloc(&s->scene->arena, count, sizeof *u.parts)};
	if (!u.parts || !find_parts(s, number, &u))
		return false;
	const size_t known = s->keys.names.count;
	const uint32_t first = nt_key_number(&s->keys);
	if (first == NT_NONE ||
		!nt_grow((void **)&s->units, &s->unit_capacity, s->keys.names.count, sizeof *s->units))
		return false;
	if (first == known)
		s->units[first] = u;
	if (s->solved)
		share_results(s, number, &s->units[first]);
	if (first < known || u.part_count < 2 || costs_too_much(s, &u))
		return true;
	nt_join *join = &s->scene->joins[s->scene->join_count++];
	*join = (nt_join){.parts = u.parts, .part_count = u.part_count,
		.first = &s->scene->meshes[s->kinds[number].wanted]};
	return find_targets(s, join);
}

static bool join_all(search *s)
{
	const nt_scene *scene = s->scene;
	bool room = true;
	for (s->begin = 0; room && s->begin < scene->mesh_count; s->begin = s->end) {
		bool any = false;
		for (s->end = s->begin; s->end < scene->mesh_count &&
			scene->meshes[s->end].gltf_mesh == scene->meshes[s->begin].gltf_mesh; s->end++)
			any |= is_wanted(s, &scene->meshes[s->end]);
		/* primitives by themselves are looked at for whose result they have */
		if (!any || (!s->solved && s->end - s->begin < 2))
			continue;
		room = find_kinds(s);
		for (uint32_t k = 0; room && k < s->kind_count; k++)
			room = s->kinds[k].wanted == NT_NONE || add_kind(s, k);
	}
	return room;
}

nt_status nt_gltf_find_joins(nt_scene *scene, bool solved, bool kept, nt_error *error)
{
	const size_t count = scene->mesh_count;
	search s = {.scene = scene, .solved = solved, .kept = kept, .kinds = nt_alloc(count, sizeof *s.kinds),
		.kind_of = nt_alloc(count, sizeof *s.kind_of), .next = nt_alloc(count, sizeof *s.next),
		.unit_of = nt_calloc(count, sizeof *s.unit_of), .part_of = nt_alloc(count, sizeof *s.part_of)};
	size_t wanted = 0;
	for (size_t i = 0; i < count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		wanted += is_wanted(&s, mesh);
		s.solved_faces += nt_mesh_gets_tangents(mesh) && !mesh->plan.same_as ? mesh->face_count : 0;
	}
	/* a join has one wanted primitive at least */
	scene->join_count = 0;
	scene->joins = nt_arena_alloc(&scene->arena, wanted, sizeof *scene->joins);
	const bool found = s.kinds && s.kind_of && s.next && s.unit_of && s.part_of && scene->joins && join_all(&s);
	free(s.kinds);
	free(s.kind_of);
	free(s.next);
	free(s.unit_of);
	free(s.part_of);
	free(s.units);
	nt_key_table_free(&s.keys);
	return found ? NT_OK : nt_fail_memory(error);
}

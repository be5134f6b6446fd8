/* SPDX-License-Identifier: MIT */
/*
 * Groups of a component: primitives whose tangents are the same, because all that decides them is.
 */
#include "io/gltf_share.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"

/* The three accessors that decide a tangent; meshes with the same ones form a group, if texture
 * transforms are the same too. */
typedef struct group_key {
	uint32_t positions, normals, texcoords;
	uint32_t targets;    /* a hash of what the morph targets move */
	uint64_t directions; /* a hash of what a texture transform makes of the texture coordinates; 0: there is none */
} group_key;

static uint32_t canonical_of(const nt_gltf_sharing *sharing, const nt_json_value *attributes,
	const char *name)
{
	uint64_t accessor;
	if (!nt_json_get_uint64(nt_json_find(attributes, name), &accessor) ||
		accessor >= sharing->accessor_count)
		return NT_NONE;
	return sharing->canonical[accessor];
}

static group_key key_of(const nt_gltf *document, const nt_gltf_sharing *sharing, const nt_mesh *mesh)
{
	char name[32];
	snprintf(name, sizeof name, "TEXCOORD_%u", mesh->texcoord_set);
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	uint32_t hash = (uint32_t)mesh->morph_count;
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		const nt_json_value *target = nt_json_at(targets, i);
		hash = (hash ^ canonical_of(sharing, target, "POSITION")) * 16777619u;
		hash = (hash ^ canonical_of(sharing, target, "NORMAL")) * 16777619u;
	}
	const uint64_t directions = !mesh->solve_texcoords ? 0 :
		nt_hash_bytes(1, mesh->solve_texcoords, mesh->vertex_count * 2 * sizeof *mesh->solve_texcoords);
	return (group_key){canonical_of(sharing, attributes, "POSITION"),
		canonical_of(sharing, attributes, "NORMAL"), canonical_of(sharing, attributes, name),
		hash, directions};
}

/* Whether texture transforms do the same to two meshes over the same texture coordinates. Where they do not, hardly a
 * tangent agrees: a TANGENT for each is less than a copy of every row. */
static bool same_directions(const nt_mesh *a, const nt_mesh *b)
{
	const float *x = a->solve_texcoords, *y = b->solve_texcoords;
	if (x == y)
		return true;
	return x && y && a->vertex_count == b->vertex_count &&
		memcmp(x, y, a->vertex_count * 2 * sizeof *x) == 0;
}

/* What is known of the groups while they are found: thousands may share one accessor of positions, so they
 * stand in a table by the hash of their key. */
typedef struct grouping {
	group_key *keys;    /* [group] */
	uint32_t *last;     /* [group] its last member yet */
	uint32_t *table;    /* [table_size] groups or NT_NONE; at most half full */
	size_t table_size;  /* a power of two */
} grouping;

static size_t slot_of(const group_key *key, size_t table_size)
{
	return (size_t)(nt_hash_bytes(0, key, sizeof *key) >> 32) & (table_size - 1);
}

/* Appends a member to its group, which may be a new one. */
static void join_group(grouping *g, nt_gltf_rows *rows, const nt_scene *scene, const uint32_t *members,
	uint32_t member, const group_key *key)
{
	const nt_mesh *mesh = &scene->meshes[members[member]];
	size_t slot = slot_of(key, g->table_size);
	for (; g->table[slot] != NT_NONE; slot = (slot + 1) & (g->table_size - 1)) {
		const uint32_t group = g->table[slot];
		if (memcmp(&g->keys[group], key, sizeof *key) != 0 ||
			!same_directions(&scene->meshes[members[rows->group_first[group]]], mesh))
			continue;
		rows->next_of[g->last[group]] = member;
		g->last[group] = member;
		rows->group_of[member] = group;
		return;
	}
	const uint32_t group = (uint32_t)rows->group_count++;
	g->table[slot] = group;
	g->keys[group] = *key;
	g->last[group] = rows->group_first[group] = member;
	rows->group_of[member] = group;
}

bool nt_gltf_find_groups(nt_gltf_rows *rows, const nt_gltf *document, const nt_scene *scene,
	const nt_gltf_sharing *sharing, const uint32_t *members, size_t member_count)
{
	grouping g = {.table_size = 2};
	while (g.table_size < 2 * member_count)
		g.table_size *= 2;
	g.keys = nt_alloc(member_count, sizeof *g.keys);
	g.last = nt_alloc(member_count, sizeof *g.last);
	g.table = nt_alloc(g.table_size, sizeof *g.table);
	const bool room = g.keys && g.last && g.table;
	if (room)
		memset(g.table, 0xff, g.table_size * sizeof *g.table);
	rows->group_count = 0;
	for (uint32_t i = 0; room && i < member_count; i++) {
		const nt_mesh *mesh = &scene->meshes[members[i]];
		rows->group_of[i] = rows->next_of[i] = NT_NONE;
		if (!nt_gltf_is_solved(mesh))
			continue;
		const group_key key = key_of(document, sharing, mesh);
		join_group(&g, rows, scene, members, i, &key);
	}
	free(g.keys);
	free(g.last);
	free(g.table);
	return room;
}

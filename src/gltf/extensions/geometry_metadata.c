/* SPDX-License-Identifier: MIT */
/*
 * FB_geometry_metadata says of a scene how many vertices and primitives (what a mode draws: points, lines, triangles)
 * its nodes have. Both are counted from the JSON, before an edit and after it. Numbers that were right become the new
 * ones; others come from another way of counting and stay. The bounds do not change with copies of vertices.
 *
 * Subtrees are added up once for each node, children first and without recursion, so that the cost is that of reading
 * the nodes, whatever scenes share. A node in a loop counts as empty where the loop closes.
 */
#include "gltf/extensions/geometry_metadata.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char name[] = "FB_geometry_metadata";

static nt_json_value *metadata_of(const nt_json_value *scene)
{
	return nt_json_find(nt_json_find(scene, "extensions"), name);
}

/* ---- meshes ---- */

static uint64_t accessor_count(const nt_json_value *accessors, const nt_json_value *index)
{
	uint64_t number, count = 0;
	if (nt_json_get_uint64(index, &number) && number < nt_json_count(accessors))
		nt_json_get_uint64(nt_json_find(nt_json_at(accessors, (size_t)number), "count"), &count);
	return count;
}

/* How many points, lines or triangles so many indices are. */
static uint64_t drawn(uint64_t mode, uint64_t count)
{
	switch (mode) {
	case 0: /* points */
		return count;
	case 1: /* lines */
		return count / 2;
	case 2: /* a loop */
		return count > 1 ? count : 0;
	case 3: /* a strip of lines */
		return count > 1 ? count - 1 : 0;
	case 4: /* triangles */
		return count / 3;
	default: /* their strips and fans */
		return count > 2 ? count - 2 : 0;
	}
}

static nt_geometry_total total_of_mesh(const nt_gltf *document, const nt_json_value *mesh)
{
	const nt_json_value *accessors = nt_gltf_root_member(document, "accessors");
	const nt_json_value *primitives = nt_json_find(mesh, "primitives");
	nt_geometry_total sum = {0};
	for (size_t i = 0; i < nt_json_count(primitives); i++) {
		const nt_json_value *primitive = nt_json_at(primitives, i),
			*indices = nt_json_find(primitive, "indices");
		const uint64_t vertices = accessor_count(accessors,
			nt_json_find(nt_json_find(primitive, "attributes"), "POSITION"));
		uint64_t mode = 4;
		nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
		sum.vertices += vertices;
		sum.primitives += drawn(mode, indices ? accessor_count(accessors, indices) : vertices);
	}
	return sum;
}

/* ---- nodes ---- */

/* A node whose children are being added up. */
typedef struct visit {
	size_t node, next; /* child */
	const nt_json_value *children;
} visit;

typedef struct adding {
	const nt_json_value *nodes;
	size_t node_count;
	bool *seen;                /* [node_count] */
	nt_geometry_total *totals; /* [node_count] with all below, once the node is left */
	visit *stack;
	size_t depth, capacity;
} adding;

static void add(nt_geometry_total *to, nt_geometry_total more)
{
	to->vertices += more.vertices;
	to->primitives += more.primitives;
}

/* The number of a node in a list; the count of nodes: none. */
static size_t node_at(const adding *a, const nt_json_value *list, size_t index)
{
	uint64_t node;
	return nt_json_get_uint64(nt_json_at(list, index), &node) && node < a->node_count
		? (size_t)node : a->node_count;
}

static bool enter(adding *a, size_t node, const nt_geometry_total *meshes, size_t mesh_count)
{
	uint64_t mesh;
	if (!nt_grow((void **)&a->stack, &a->capacity, a->depth + 1, sizeof *a->stack))
		return false;
	a->stack[a->depth++] = (visit){node, 0, nt_json_find(nt_json_at(a->nodes, node), "children")};
	a->seen[node] = true;
	if (nt_json_get_uint64(nt_json_find(nt_json_at(a->nodes, node), "mesh"), &mesh) && mesh < mesh_count)
		a->totals[node] = meshes[mesh];
	return true;
}

/* Adds up what is below a node, and it. */
static bool add_up(adding *a, size_t root, const nt_geometry_total *meshes, size_t mesh_count)
{
	bool entered = a->seen[root] || enter(a, root, meshes, mesh_count);
	while (entered && a->depth) {
		visit *here = &a->stack[a->depth - 1];
		const nt_json_value *children = here->children;
		if (here->next == nt_json_count(children)) {
			a->depth--;
			continue;
		}
		const size_t child = node_at(a, children, here->next);
		if (child < a->node_count && !a->seen[child]) {
			entered = enter(a, child, meshes, mesh_count);
			continue; /* and come back to it, seen */
		}
		if (child < a->node_count)
			add(&a->totals[here->node], a->totals[child]);
		here->next++;
	}
	return entered;
}

static bool add_up_scenes(adding *a, const nt_json_value *scenes, const nt_geometry_total *meshes, size_t mesh_count,
	nt_geometry_total *totals)
{
	bool done = true;
	for (size_t s = 0; s < nt_json_count(scenes); s++) {
		const nt_json_value *roots = nt_json_find(nt_json_at(scenes, s), "nodes");
		totals[s] = (nt_geometry_total){0};
		for (size_t i = 0; done && i < nt_json_count(roots); i++) {
			const size_t root = node_at(a, roots, i);
			if (root == a->node_count)
				continue;
			done = add_up(a, root, meshes, mesh_count);
			add(&totals[s], a->totals[root]);
		}
	}
	return done;
}

static bool any_has_metadata(const nt_json_value *scenes)
{
	for (size_t i = 0; i < nt_json_count(scenes); i++)
		if (metadata_of(nt_json_at(scenes, i)))
			return true;
	return false;
}

nt_status nt_geometry_totals(const nt_gltf *document, nt_arena *arena, nt_geometry_total **totals)
{
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	const nt_json_value *meshes = nt_gltf_root_member(document, "meshes");
	const size_t mesh_count = nt_json_count(meshes);
	*totals = NULL;
	if (!any_has_metadata(scenes))
		return NT_OK;
	adding a = {.nodes = nt_gltf_root_member(document, "nodes")};
	a.node_count = nt_json_count(a.nodes);
	a.seen = nt_calloc(a.node_count, sizeof *a.seen);
	a.totals = nt_calloc(a.node_count, sizeof *a.totals);
	nt_geometry_total *of_meshes = nt_alloc(mesh_count, sizeof *of_meshes);
	nt_geometry_total *of_scenes = nt_arena_alloc(arena, nt_json_count(scenes), sizeof *of_scenes);
	nt_status status = NT_ERROR_MEMORY;
	if (a.seen && a.totals && of_meshes && of_scenes) {
		for (size_t i = 0; i < mesh_count; i++)
			of_meshes[i] = total_of_mesh(document, nt_json_at(meshes, i));
		if (add_up_scenes(&a, scenes, of_meshes, mesh_count, of_scenes)) {
			*totals = of_scenes;
			status = NT_OK;
		}
	}
	free(a.seen);
	free(a.totals);
	free(a.stack);
	free(of_meshes);
	return status;
}

/* ---- the extension ---- */

/* Sets a number that was right. Returns whether it is now. */
static bool follow(nt_json *json, nt_json_value *metadata, const char *key, uint64_t before, uint64_t now)
{
	nt_json_value *number = nt_json_find(metadata, key);
	uint64_t stated;
	if (before == now || !number)
		return true;
	if (!nt_json_get_uint64(number, &stated) || stated != before)
		return false;
	nt_json_set_uint64(json, number, now);
	return true;
}

nt_status nt_geometry_metadata_follow(nt_scene *scene, const nt_geometry_total *before, nt_arena *arena)
{
	const nt_gltf *document = scene->source;
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	nt_geometry_total *now;
	if (!before)
		return NT_OK;
	const nt_status status = nt_geometry_totals(document, arena, &now);
	for (size_t i = 0; !status && i < nt_json_count(scenes); i++) {
		nt_json_value *metadata = metadata_of(nt_json_at(scenes, i));
		const bool vertices =
			follow(document->json, metadata, "vertexCount", before[i].vertices, now[i].vertices);
		const bool primitives = follow(document->json, metadata, "primitiveCount", before[i].primitives,
			now[i].primitives);
		if (vertices && primitives)
			continue;
		nt_place place;
		nt_place_clear(&place);
		snprintf(place.file, sizeof place.file, "%s", document->path);
		snprintf(place.pointer, sizeof place.pointer, "/scenes/%zu/extensions/%s", i, name);
		nt_finding_add(&scene->findings, NT_CODE_EXTENSION_STALE, &place, 1,
			"%s, whose counts are not those of the scene's nodes,", name);
	}
	return status;
}

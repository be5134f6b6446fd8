/* SPDX-License-Identifier: MIT */
/*
 * Nodes: which meshes a scene shows, and where in the world they stand. Nodes form trees in a sound
 * document; here every node is visited once, on an explicit stack, so that loops and shared children end
 * and depth costs no call stack. Faulty nodes and references are passed over: whether they matter is for
 * viewers to say, not for a tool that writes tangents.
 */
#include "gltf/document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct visit {
	uint32_t node;
	double matrix[16]; /* of the parent */
} visit;

typedef struct node_walk {
	const nt_json_value *nodes;
	size_t node_count;
	bool *seen; /* [node_count] */
	visit *stack;
	size_t stack_count, stack_capacity;
	bool failed;
} node_walk;

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static bool start_walk(node_walk *walk, const nt_gltf *document)
{
	memset(walk, 0, sizeof *walk);
	walk->nodes = nt_gltf_root_member(document, "nodes");
	walk->node_count = nt_json_count(walk->nodes);
	walk->seen = nt_calloc(walk->node_count, sizeof *walk->seen);
	return walk->seen != NULL;
}

static void end_walk(node_walk *walk)
{
	free(walk->seen);
	free(walk->stack);
}

static void push_node(node_walk *walk, const nt_json_value *index, const double matrix[16])
{
	uint64_t node;
	if (!nt_json_get_uint64(index, &node) || node >= walk->node_count || walk->seen[node])
		return;
	if (!nt_grow((void **)&walk->stack, &walk->stack_capacity, walk->stack_count + 1,
		sizeof *walk->stack)) {
		walk->failed = true;
		return;
	}
	walk->seen[node] = true;
	visit *next = &walk->stack[walk->stack_count++];
	next->node = (uint32_t)node;
	memcpy(next->matrix, matrix, sizeof next->matrix);
}

/* Pushes in reverse, so that the first is visited first. */
static void push_nodes(node_walk *walk, const nt_json_value *list, const double matrix[16])
{
	if (nt_json_type_of(list) != NT_JSON_ARRAY)
		return;
	for (size_t i = nt_json_count(list); i-- > 0;)
		push_node(walk, nt_json_at(list, i), matrix);
}

/* ---- reachability ---- */

/* Node numbers that extensions hold under customary names: MSFT_lod's "ids", "node", "nodes". */
static void push_extension_nodes(node_walk *walk, const nt_json_value *object)
{
	static const char *const names[] = {"ids", "nodes", "node"};
	const nt_json_value *extensions = nt_json_find(object, "extensions");
	for (size_t i = 0; i < nt_json_count(extensions); i++) {
		const nt_json_value *extension = nt_json_at(extensions, i);
		for (size_t k = 0; k < 3; k++) {
			const nt_json_value *value = nt_json_find(extension, names[k]);
			push_nodes(walk, value, identity);
			push_node(walk, value, identity);
		}
	}
}

nt_status nt_gltf_reach(const nt_gltf *document, bool *reached, size_t mesh_count, nt_error *error)
{
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	if (!scenes) {
		for (size_t i = 0; i < mesh_count; i++)
			reached[i] = true;
		return NT_OK;
	}
	node_walk walk;
	if (!start_walk(&walk, document))
		return nt_fail_memory(error);
	push_extension_nodes(&walk, nt_json_root(document->json));
	for (size_t i = 0; i < nt_json_count(scenes); i++) {
		const nt_json_value *scene = nt_json_at(scenes, i);
		push_nodes(&walk, nt_json_find(scene, "nodes"), identity);
		push_extension_nodes(&walk, scene);
	}
	while (walk.stack_count && !walk.failed) {
		const nt_json_value *node = nt_json_at(walk.nodes, walk.stack[--walk.stack_count].node);
		uint64_t mesh;
		if (nt_json_find_uint64(node, "mesh", &mesh) && mesh < mesh_count)
			reached[mesh] = true;
		push_nodes(&walk, nt_json_find(node, "children"), identity);
		push_extension_nodes(&walk, node);
	}
	const bool failed = walk.failed;
	end_walk(&walk);
	return failed ? nt_fail_memory(error) : NT_OK;
}

/* ---- the world ---- */

/* Numbers of an array; false unless there are exactly `count` finite ones. */
static bool read_numbers(const nt_json_value *array, double *numbers, size_t count)
{
	if (nt_json_type_of(array) != NT_JSON_ARRAY || nt_json_count(array) != count)
		return false;
	for (size_t i = 0; i < count; i++)
		if (!nt_json_get_double(nt_json_at(array, i), &numbers[i]) || !isfinite(numbers[i]))
			return false;
	return true;
}

/* product = a b, column-major. */
static void multiply(const double a[16], const double b[16], double product[16])
{
	for (int column = 0; column < 4; column++)
		for (int row = 0; row < 4; row++) {
			double sum = 0;
			for (int k = 0; k < 4; k++)
				sum += a[k * 4 + row] * b[column * 4 + k];
			product[column * 4 + row] = sum;
		}
}

/* matrix, or translation * rotation * scale. */
static void local_matrix(const nt_json_value *node, double matrix[16])
{
	if (read_numbers(nt_json_find(node, "matrix"), matrix, 16))
		return;
	double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1}, read[4];
	if (read_numbers(nt_json_find(node, "translation"), read, 3))
		memcpy(t, read, sizeof t);
	if (read_numbers(nt_json_find(node, "rotation"), read, 4))
		memcpy(q, read, sizeof q);
	if (read_numbers(nt_json_find(node, "scale"), read, 3))
		memcpy(s, read, sizeof s);
	const double x = q[0], y = q[1], z = q[2], w = q[3];
	const double rotation[3][3] = {
		{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
		{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
		{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
	}; /* [column][row] */
	memcpy(matrix, identity, sizeof identity);
	for (int column = 0; column < 3; column++)
		for (int row = 0; row < 3; row++)
			matrix[column * 4 + row] = rotation[column][row] * s[column];
	memcpy(matrix + 12, t, sizeof t);
}

/* Roots of a document without scenes: nodes that are nobody's child. */
static void push_roots(node_walk *walk)
{
	bool *child = nt_calloc(walk->node_count, sizeof *child);
	if (!child) {
		walk->failed = true;
		return;
	}
	for (size_t i = 0; i < walk->node_count; i++) {
		const nt_json_value *children = nt_json_find(nt_json_at(walk->nodes, i), "children");
		for (size_t k = 0; k < nt_json_count(children); k++) {
			uint64_t node;
			if (nt_json_get_uint64(nt_json_at(children, k), &node) && node < walk->node_count)
				child[node] = true;
		}
	}
	for (size_t i = walk->node_count; i-- > 0 && !walk->failed;) {
		if (child[i])
			continue;
		if (!nt_grow((void **)&walk->stack, &walk->stack_capacity, walk->stack_count + 1,
			sizeof *walk->stack)) {
			walk->failed = true;
			break;
		}
		walk->seen[i] = true;
		visit *next = &walk->stack[walk->stack_count++];
		next->node = (uint32_t)i;
		memcpy(next->matrix, identity, sizeof next->matrix);
	}
	free(child);
}

nt_status nt_gltf_walk_world(const nt_gltf *document,
	nt_status (*place)(void *context, uint64_t mesh, const double matrix[16]), void *context,
	nt_error *error)
{
	node_walk walk;
	if (!start_walk(&walk, document))
		return nt_fail_memory(error);
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	uint64_t scene = 0;
	nt_json_get_uint64(nt_gltf_root_member(document, "scene"), &scene);
	if (nt_json_count(scenes) == 0)
		push_roots(&walk);
	else
		push_nodes(&walk, nt_json_find(nt_json_at(scenes, (size_t)scene), "nodes"), identity);
	nt_status status = NT_OK;
	while (!status && walk.stack_count && !walk.failed) {
		const visit here = walk.stack[--walk.stack_count];
		const nt_json_value *node = nt_json_at(walk.nodes, here.node);
		double local[16], world[16];
		local_matrix(node, local);
		multiply(here.matrix, local, world);
		uint64_t mesh;
		if (nt_json_find_uint64(node, "mesh", &mesh))
			status = place(context, mesh, world);
		push_nodes(&walk, nt_json_find(node, "children"), world);
	}
	const bool failed = walk.failed;
	end_walk(&walk);
	return failed ? nt_fail_memory(error) : status;
}

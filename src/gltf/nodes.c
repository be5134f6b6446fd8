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

/* A node that was not visited. */
static void push_number(node_walk *walk, uint64_t node, const double matrix[16])
{
	if (node >= walk->node_count || walk->seen[node])
		return;
	walk->failed |= !nt_grow((void **)&walk->stack, &walk->stack_capacity, walk->stack_count + 1,
		sizeof *walk->stack);
	if (walk->failed)
		return;
	walk->seen[node] = true;
	visit *next = &walk->stack[walk->stack_count++];
	next->node = (uint32_t)node;
	memcpy(next->matrix, matrix, sizeof next->matrix);
}

static void push_node(node_walk *walk, const nt_json_value *index, const double matrix[16])
{
	uint64_t node;
	if (nt_json_get_uint64(index, &node))
		push_number(walk, node, matrix);
}

/* Pushes in reverse, so that the first is visited first. */
static void push_nodes(node_walk *walk, const nt_json_value *list, const double matrix[16])
{
	if (nt_json_type_of(list) != NT_JSON_ARRAY)
		return;
	for (size_t i = nt_json_count(list); i-- > 0;)
		push_node(walk, nt_json_at(list, i), matrix);
}

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

/* Roots of a document without scenes: nodes that are nobody's child. */
static void push_roots(node_walk *walk)
{
	bool *child = nt_calloc(walk->node_count, sizeof *child);
	walk->failed |= !child;
	for (size_t i = 0; child && i < walk->node_count; i++) {
		const nt_json_value *children = nt_json_find(nt_json_at(walk->nodes, i), "children");
		for (size_t k = 0; k < nt_json_count(children); k++) {
			uint64_t node;
			if (nt_json_get_uint64(nt_json_at(children, k), &node) && node < walk->node_count)
				child[node] = true;
		}
	}
	for (size_t i = walk->node_count; child && i-- > 0;)
		if (!child[i])
			push_number(walk, i, identity);
	free(child);
}

/* ---- where they stand ---- */

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

/* The default scene, or the roots. */
static void push_world(node_walk *walk, const nt_gltf *document)
{
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	uint64_t scene = 0;
	nt_json_get_uint64(nt_gltf_root_member(document, "scene"), &scene);
	if (nt_json_count(scenes) == 0)
		push_roots(walk);
	else
		push_nodes(walk, nt_json_find(nt_json_at(scenes, (size_t)scene), "nodes"), identity);
}

/* All scenes, and what extensions name beside them. */
static void push_all(node_walk *walk, const nt_gltf *document)
{
	const nt_json_value *scenes = nt_gltf_root_member(document, "scenes");
	push_extension_nodes(walk, nt_json_root(document->json));
	for (size_t i = 0; i < nt_json_count(scenes); i++) {
		push_nodes(walk, nt_json_find(nt_json_at(scenes, i), "nodes"), identity);
		push_extension_nodes(walk, nt_json_at(scenes, i));
	}
}

nt_status nt_gltf_walk(const nt_gltf *document, bool world, nt_gltf_place_mesh place, void *context, nt_error *error)
{
	node_walk walk = {.nodes = nt_gltf_root_member(document, "nodes")};
	walk.node_count = nt_json_count(walk.nodes);
	walk.seen = nt_calloc(walk.node_count, sizeof *walk.seen);
	walk.failed = !walk.seen;
	if (!walk.failed && world)
		push_world(&walk, document);
	else if (!walk.failed)
		push_all(&walk, document);
	nt_status status = NT_OK;
	while (!status && walk.stack_count && !walk.failed) {
		visit here = walk.stack[--walk.stack_count];
		const nt_json_value *node = nt_json_at(walk.nodes, here.node);
		if (world) {
			double local[16], parent[16];
			memcpy(parent, here.matrix, sizeof parent);
			local_matrix(node, local);
			multiply(parent, local, here.matrix);
		}
		uint64_t mesh;
		if (nt_json_find_uint64(node, "mesh", &mesh))
			status = place(context, mesh, here.matrix);
		push_nodes(&walk, nt_json_find(node, "children"), here.matrix);
		if (!world)
			push_extension_nodes(&walk, node);
	}
	free(walk.seen);
	free(walk.stack);
	return walk.failed ? nt_fail_memory(error) : status;
}

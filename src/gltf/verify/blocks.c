/* SPDX-License-Identifier: MIT */
/*
 * Blocks of Draco, read back, and compared with what the source has and with the tangents that were to be written. Each
 * value has to lie within half a step of the grid that was asked for, or that the source has; what is not quantized has
 * to be the same. Sequential blocks are compared corner by corner. Edgebreaker has put the faces into another order:
 * Draco's own arithmetic moves the source's values to their grid (which is compared by vertex), and the set of faces
 * with these has to be that of the block, bit for bit.
 */
#include "gltf/verify/verify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/vec.h"
#include "gltf/load.h"

/* A mesh that was to be encoded, in the source's order of vertices, copies behind them, and what was decoded. */
typedef struct comparison {
	nt_gltf *source;
	const nt_mesh *mesh;
	const nt_json_value *primitive; /* of the source */
	const nt_write_options *options;
	nt_arena *arena;
	nt_draco_mesh wanted;
	nt_draco_attribute *attributes, *found; /* in the same order */
	const char **names;
	uint32_t *copied;
	size_t own_count; /* vertices of the source */
	bool *used;	  /* by faces */
	uint64_t *positions; /* hashes of the source's: edgebreaker drops faces with two corners at one */
} comparison;

static size_t width_of(const nt_draco_attribute *a)
{
	return nt_component_size(a->component_type) * (size_t)a->components;
}

/* The bytes of a point. */
static const unsigned char *value_of(const nt_draco_attribute *a, size_t point)
{
	const size_t own = a->copied && point >= a->own_count ? a->copied[point - a->own_count]
							      : point;
	return (const unsigned char *)a->data +
	       own * (a->stride_bytes ? a->stride_bytes : width_of(a));
}

/* ---- what was to be encoded ---- */

/* The number of a vertex; those that made normals appended, and then those of the split, stand behind the source's. */
static uint32_t point_of(const comparison *c, uint32_t vertex)
{
	const size_t count = c->mesh->source_vertex_count;
	return vertex < count ? nt_mesh_pool_vertex(c->mesh, vertex) : (uint32_t)(c->own_count + vertex - count);
}

/* The vertex of the source that a vertex is, or is a copy of. */
static uint32_t source_of(const nt_mesh *mesh, uint32_t vertex)
{
	if (vertex >= mesh->vertex_count)
		vertex = mesh->split.sources[vertex - mesh->vertex_count];
	while (vertex >= mesh->source_vertex_count)
		vertex = mesh->vertex_sources[vertex - mesh->source_vertex_count];
	return vertex;
}

/* Faces, and the vertices that copies are of. */
static nt_status find_faces(comparison *c, nt_error *error)
{
	const nt_mesh *mesh = c->mesh;
	const uint32_t *vertices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	const size_t copy_count = mesh->vertex_count - mesh->source_vertex_count + mesh->split.source_count;
	const size_t point_count = c->own_count + copy_count;
	uint32_t *indices = nt_arena_alloc(c->arena, mesh->corner_count, sizeof *indices);
	c->copied = nt_arena_alloc(c->arena, copy_count, sizeof *c->copied);
	c->used = nt_arena_alloc(c->arena, point_count, sizeof *c->used);
	if (!indices || !c->copied || !c->used)
		return nt_fail_memory(error);
	memset(c->used, 0, point_count);
	for (size_t i = 0; i < mesh->corner_count; i++) {
		indices[i] = point_of(c, vertices ? vertices[i] : (uint32_t)i);
		c->used[indices[i]] = true;
	}
	for (size_t i = 0; i < copy_count; i++)
		c->copied[i] = point_of(c, source_of(mesh, (uint32_t)(mesh->source_vertex_count + i)));
	c->wanted = (nt_draco_mesh){.method = NT_DRACO_SEQUENTIAL,
		.point_count = point_count,
		.face_count = mesh->corner_count / 3,
		.indices = indices};
	return NT_OK;
}

/* Values that the scene has: tangents, and what is made of them and of normals. NULL: out of memory. */
static float *own_values(const comparison *c, const char *name, size_t components)
{
	const nt_mesh *mesh = c->mesh;
	const size_t count = mesh->vertex_count + mesh->split.source_count;
	float *values = nt_arena_alloc(
		c->arena, c->wanted.point_count, components * sizeof *values);
	if (values)
		memset(values, 0, c->wanted.point_count * components * sizeof *values);
	for (size_t v = 0; values && v < count; v++) {
		float *value = values + components * point_of(c, (uint32_t)v);
		const float *tangent = mesh->split.vertex_tangents + 4 * v;
		const float *normal =
			mesh->normals +
			3 * (v < mesh->vertex_count ? v
						    : mesh->split.sources[v - mesh->vertex_count]);
		if (strcmp(name, "_BITANGENT") == 0)
			nt_bitangent(normal, tangent, value);
		else
			memcpy(value, *name == 'T' ? tangent : normal, components * sizeof *value);
	}
	return values;
}

static bool is_own(const comparison *c, const char *name)
{
	return strcmp(name, "TANGENT") == 0 ||
	       (strcmp(name, "NORMAL") == 0 && c->mesh->normals_made) ||
	       (strcmp(name, "_BITANGENT") == 0 && c->options->bitangents);
}

/* An attribute of the source, on the grid that it has or that was asked for. False: the source has none of the name. */
static bool find_in_source(const comparison *c, const char *name, nt_draco_attribute *wanted)
{
	const nt_gltf_accessor *a = nt_gltf_named(
		c->source, nt_json_find(c->primitive, "attributes"), name);
	const unsigned char *elements = NULL;
	nt_error ignored;
	if (!a || a->count < c->own_count || nt_gltf_elements(c->source, a, &elements, &ignored) ||
		!elements)
		return false;
	if (a->packed) {
		*wanted = *a->packed;
		wanted->quantization.explicit_box = wanted->quantization.bits > 0;
	} else {
		const bool is_float = a->component_type == NT_GLTF_FLOAT;
		*wanted = (nt_draco_attribute){.kind = nt_gltf_draco_kind(name),
			.component_type = (int)a->component_type,
			.components = (int)a->components,
			.normalized = a->normalized,
			.quantization = nt_gltf_draco_grid(c->source, a->index,
				is_float ? nt_gltf_draco_bits_of(c->options->draco_bits, name)
					 : 0)};
	}
	wanted->data = elements;
	wanted->stride_bytes = a->stride;
	wanted->copied = c->copied;
	wanted->own_count = c->own_count;
	return true;
}

/* An attribute that nmtan made. False: out of memory. */
static bool make_own(const comparison *c, const char *name, nt_draco_attribute *wanted)
{
	const bool tangents = *name == 'T', normals = *name == 'N';
	const int *bits = c->options->draco_bits;
	*wanted = (nt_draco_attribute){.kind = normals ? NT_DRACO_NORMAL : NT_DRACO_GENERIC,
		.component_type = NT_GLTF_FLOAT,
		.components = tangents ? 4 : 3,
		.quantization =
			tangents
				? nt_gltf_draco_tangent_grid(
					  nt_gltf_draco_tangents_of(c->source, c->primitive), bits)
				: (nt_draco_quantization){.bits = nt_gltf_draco_bits(bits,
								  normals ? NT_DRACO_BITS_NORMAL
									  : NT_DRACO_BITS_TANGENT)},
		.data = own_values(c, name, tangents ? 4 : 3)};
	return wanted->data != NULL;
}

/* Pairs what the block has with what it should have. *bad: the name of an attribute that differs; NULL: none does. */
static nt_status pair_attributes(comparison *c, const nt_json_value *ids,
	const nt_draco_mesh *block, const char **bad, nt_error *error)
{
	const size_t count = nt_json_count(ids);
	c->attributes = nt_arena_alloc(c->arena, count, sizeof *c->attributes);
	c->found = nt_arena_alloc(c->arena, count, sizeof *c->found);
	c->names = nt_arena_alloc(c->arena, count, sizeof *c->names);
	if (!c->attributes || !c->found || !c->names)
		return nt_fail_memory(error);
	for (size_t i = 0; i < count; i++) {
		const char *name = c->names[i] = nt_json_key(ids, i, NULL);
		uint64_t id = UINT64_MAX;
		nt_json_get_uint64(nt_json_at(ids, i), &id);
		const nt_draco_attribute *found = id < UINT32_MAX
							  ? nt_draco_find(block, (uint32_t)id)
							  : NULL;
		nt_draco_attribute *wanted = &c->attributes[i];
		if (!is_own(c, name) ? !find_in_source(c, name, wanted)
				     : !make_own(c, name, wanted)) {
			*bad = name;
			return is_own(c, name) ? nt_fail_memory(error) : NT_OK;
		}
		if (!found || found->component_type != wanted->component_type ||
			found->components != wanted->components) {
			*bad = name;
			return NT_OK;
		}
		c->found[i] = *found;
		wanted->unique_id = (uint32_t)i;
	}
	c->wanted.attributes = c->attributes;
	c->wanted.attribute_count = count;
	return NT_OK;
}

/* ---- what a decoder should have ---- */

/* Half a step of a box's grid, and what float arithmetic adds. */
static double half_step(const comparison *c, const nt_draco_attribute *a)
{
	float range = a->quantization.explicit_box ? a->quantization.range : 0, largest = 0;
	for (size_t k = 0; k < (size_t)a->components; k++) {
		float least = INFINITY, most = -INFINITY, x;
		for (size_t p = 0; p < c->wanted.point_count; p++) {
			if (!c->used[p])
				continue;
			memcpy(&x, value_of(a, p) + k * sizeof x, sizeof x);
			least = x < least ? x : least;
			most = x > most ? x : most;
		}
		largest = fmaxf(largest, fmaxf(fabsf(least), fabsf(most)));
		range = a->quantization.explicit_box ? range : fmaxf(range, most - least);
	}
	const double steps = (double)(((uint64_t)1 << a->quantization.bits) - 1);
	return 0.5 * (range > 0 ? range : 1) / steps + 2e-6 * fmaxf(largest, range);
}

static bool is_octahedral(const nt_draco_attribute *a)
{
	return a->kind == NT_DRACO_NORMAL && a->components == 3;
}

/* How far a component may be from what it was made of; 0: not at all. Directions lie on the grid of an octahedron,
 * whose points are 2 / (2^bits - 2) apart in two axes and up to twice that in the third; the octahedron is nowhere
 * nearer to the origin than 1 / sqrt(3). */
static double tolerance_of(const comparison *c, const nt_draco_attribute *a)
{
	const int bits = a->quantization.bits;
	if (!bits)
		return 0;
	return is_octahedral(a) ? 0.5 * 2 / (ldexp(1, bits) - 2) * sqrt(6) * sqrt(3) + 2e-6 : half_step(c, a);
}

/* Whether a value is near enough to that of a point. */
static bool is_near(const nt_draco_attribute *a, size_t point, const void *value, double tolerance)
{
	const size_t width = width_of(a);
	float from[4], to[4];
	double scale = 1;
	if (memcmp(value_of(a, point), value, width) == 0)
		return true;
	if (a->component_type != NT_GLTF_FLOAT)
		return false;
	memcpy(from, value_of(a, point), width);
	memcpy(to, value, width);
	if (is_octahedral(a) && a->quantization.bits) {
		const double x = from[0], y = from[1], z = from[2], length = sqrt(x * x + y * y + z * z);
		if (!(length > 1e-5)) /* no direction */
			return true;
		scale = 1 / length;
	}
	for (int k = 0; k < a->components; k++)
		if (!(fabs(from[k] * scale - to[k]) <= tolerance))
			return false;
	return true;
}

/* Moves what is quantized to its grid. */
static nt_status quantize(comparison *c, const char **bad, nt_error *error)
{
	float **values = nt_arena_alloc(c->arena, c->wanted.attribute_count, sizeof *values);
	if (!values)
		return nt_fail_memory(error);
	for (size_t i = 0; i < c->wanted.attribute_count; i++) {
		const nt_draco_attribute *a = &c->attributes[i];
		values[i] = NULL;
		if (a->quantization.bits)
			values[i] = nt_arena_alloc(c->arena, c->wanted.point_count, width_of(a));
		if (a->quantization.bits && !values[i])
			return nt_fail_memory(error);
	}
	nt_status status = nt_draco_quantize(&c->wanted, values, error);
	for (size_t i = 0; !status && !*bad && i < c->wanted.attribute_count; i++) {
		nt_draco_attribute *a = &c->attributes[i];
		if (!values[i])
			continue;
		const double tolerance = tolerance_of(c, a);
		for (size_t p = 0; !*bad && p < c->wanted.point_count; p++)
			if (c->used[p] && !is_near(a, p, values[i] + p * (size_t)a->components, tolerance))
				*bad = c->names[i];
		a->data = values[i];
		a->stride_bytes = 0;
		a->copied = NULL;
	}
	return status;
}

/* ---- comparing ---- */

/* A number for what each point has of some attributes; unless `exact` the same for -0 and +0, which Draco may merge. */
static uint64_t *hash_points(nt_arena *arena, const nt_draco_attribute *attributes, size_t count, size_t point_count,
	bool exact)
{
	uint64_t *hashes = nt_arena_alloc(arena, point_count, sizeof *hashes);
	for (size_t p = 0; hashes && p < point_count; p++) {
		hashes[p] = 0;
		for (size_t i = 0; i < count; i++) {
			float value[4];
			memcpy(value, value_of(&attributes[i], p), width_of(&attributes[i]));
			const bool floats = attributes[i].component_type == NT_GLTF_FLOAT;
			for (int k = 0; floats && !exact && k < attributes[i].components; k++)
				value[k] += 0.0f;
			hashes[p] = nt_hash_bytes(hashes[p], value, width_of(&attributes[i]));
		}
	}
	return hashes;
}

/* A number for the set of faces, each beginning at any of its corners. positions: faces with two corners at one are
 * left out; NULL: none is. */
static uint64_t hash_faces(
	const nt_draco_mesh *mesh, const uint64_t *hashes, const uint64_t *positions)
{
	uint64_t sum = 0;
	for (size_t f = 0; f < mesh->face_count; f++) {
		const uint32_t *v = mesh->indices + 3 * f;
		if (positions &&
			(positions[v[0]] == positions[v[1]] || positions[v[1]] == positions[v[2]] ||
				positions[v[2]] == positions[v[0]]))
			continue;
		const uint64_t a = hashes[v[0]], b = hashes[v[1]], c = hashes[v[2]];
		sum += nt_hash_words(
			nt_hash_words(a, b) + nt_hash_words(b, c) + nt_hash_words(c, a), 0);
	}
	return sum;
}

/* Sequential keeps corners where they are. */
static nt_status compare_corners(const comparison *c, const nt_draco_mesh *block, const char **bad, nt_error *error)
{
	const size_t corner_count = 3 * block->face_count, count = c->wanted.attribute_count;
	uint32_t *point_for = nt_arena_alloc(c->arena, c->wanted.point_count, sizeof *point_for);
	double *tolerances = nt_arena_alloc(c->arena, count, sizeof *tolerances);
	if (!point_for || !tolerances)
		return nt_fail_memory(error);
	memset(point_for, 0xff, c->wanted.point_count * sizeof *point_for);
	for (size_t k = 0; k < count; k++)
		tolerances[k] = tolerance_of(c, &c->attributes[k]);
	if (c->wanted.face_count != block->face_count)
		*bad = "its faces";
	for (size_t i = 0; !*bad && i < corner_count; i++) {
		const uint32_t wanted = c->wanted.indices[i], found = block->indices[i];
		for (size_t k = 0; point_for[wanted] != found && !*bad && k < count; k++)
			if (!is_near(&c->attributes[k], wanted, value_of(&c->found[k], found), tolerances[k]))
				*bad = c->names[k];
		point_for[wanted] = found;
	}
	return NT_OK;
}

/* Whether the faces of edgebreaker have the same, of `count` attributes from the first. */
static nt_status compare_sets(const comparison *c, const nt_draco_mesh *block, size_t first, size_t count, bool *same,
	nt_error *error)
{
	const uint64_t *wanted = hash_points(c->arena, c->attributes + first, count, c->wanted.point_count, false);
	const uint64_t *found = hash_points(c->arena, c->found + first, count, block->point_count, false);
	if (!wanted || !found)
		return nt_fail_memory(error);
	*same = hash_faces(&c->wanted, wanted, c->positions) == hash_faces(block, found, NULL);
	return NT_OK;
}

/* Edgebreaker puts faces into another order, and splits and joins points. */
static nt_status compare_faces(comparison *c, const nt_draco_mesh *block, const char **bad, nt_error *error)
{
	const size_t count = c->wanted.attribute_count;
	bool same = true;
	for (size_t i = 0; i < count; i++)
		if (strcmp(c->names[i], "POSITION") == 0)
			c->positions = hash_points(c->arena, &c->attributes[i], 1, c->wanted.point_count, true);
	nt_status status = c->positions ? quantize(c, bad, error) : nt_fail_memory(error);
	if (!status && !*bad)
		status = compare_sets(c, block, 0, count, &same, error);
	const bool differs = !same;
	for (size_t i = 0; differs && !status && !*bad && i < count; i++) {
		status = compare_sets(c, block, i, 1, &same, error);
		*bad = same ? NULL : c->names[i];
	}
	if (differs && !*bad)
		*bad = "its faces";
	return status;
}

nt_status nt_verify_block(nt_gltf *source, const nt_mesh *mesh, const nt_write_options *options,
	const nt_gltf *found, const nt_json_value *primitive, nt_arena *arena, const char **bad,
	nt_error *error)
{
	const nt_json_value *extension = nt_gltf_draco_of(primitive),
			    *ids = nt_json_find(extension, "attributes");
	comparison c = {.source = source,
		.mesh = mesh,
		.primitive = nt_gltf_primitive_of(source, mesh),
		.options = options,
		.arena = arena};
	uint64_t view = UINT64_MAX;
	nt_json_find_uint64(extension, "bufferView", &view);
	const nt_draco_mesh *block = nt_gltf_draco_block(found, view);
	const nt_gltf_accessor *positions = nt_gltf_named(
		source, nt_json_find(c.primitive, "attributes"), "POSITION");
	*bad = "its faces";
	if (!block || !positions)
		return NT_OK;
	c.own_count = (size_t)positions->count;
	nt_status status = find_faces(&c, error);
	*bad = NULL;
	if (!status)
		status = pair_attributes(&c, ids, block, bad, error);
	if (!status && !*bad)
		status = block->method == NT_DRACO_SEQUENTIAL ? compare_corners(&c, block, bad, error)
			: compare_faces(&c, block, bad, error);
	return status;
}

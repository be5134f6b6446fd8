/* SPDX-License-Identifier: MIT */
/*
 * Morph targets of one glTF primitive: which of them move it, the mesh as each of them moves it, where that is
 * asked for, and their deltas of tangents in few bytes.
 */
#include "gltf/load.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/quantize.h"

/* ---- what moves it ---- */

/* Displacements stay where the file has them. */

void nt_gltf_normalise(float *n)
{
	const double x = n[0], y = n[1], z = n[2], length = x * x + y * y + z * z;
	if (!(length > 0))
		return;
	const double scale = 1 / __builtin_sqrt(length);
	n[0] = (float)(x * scale);
	n[1] = (float)(y * scale);
	n[2] = (float)(z * scale);
}

nt_status nt_gltf_own_normals(nt_scene *scene, nt_mesh *mesh, nt_error *error)
{
	float *own = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->vertex_count, 3 * sizeof *own);
	if (!own)
		return nt_fail_memory(error);
	mesh->normals = memcpy(own, mesh->normals, mesh->vertex_count * 3 * sizeof *own);
	return NT_OK;
}

/* The displacement of an attribute: elements of the pool's vertices. */
typedef struct nt_displacement {
	const nt_gltf_accessor *accessor;
	const unsigned char *elements; /* NULL: zeros */
	const uint32_t *replaced;      /* [accessor->sparse->count] numbers that ascend, */
	const unsigned char *values;   /* and their elements */
} nt_displacement;

/* *delta: NULL where the target does not move the attribute. */
static nt_status find_delta(nt_scene *scene, const nt_mesh *mesh, const nt_json_value *target, const char *name,
	const char *pointer, const nt_displacement **delta, nt_error *error)
{
	nt_gltf *document = scene->source;
	const size_t pool_count = mesh->vertex_count + mesh->unused_vertices;
	nt_arena *arena = nt_mesh_arena(scene, mesh);
	if (!nt_json_find(target, name))
		return NT_OK;
	uint64_t index;
	nt_displacement found = {.elements = NULL};
	nt_status status =
		nt_gltf_uint(target, pointer, name, UINT32_MAX - 1, NT_GLTF_REQUIRED, &index, error);
	if (!status)
		status = nt_gltf_get_accessor(document, index, pointer, &found.accessor, error);
	if (status)
		return status;
	if (found.accessor->components != 3 || found.accessor->count != pool_count)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%s: accessor %llu has %llu elements of %u components, expected %zu of 3", name,
			(unsigned long long)index, (unsigned long long)found.accessor->count,
			found.accessor->components, pool_count);
	status = nt_gltf_elements(document, found.accessor, &found.elements, error);
	if (!status && found.accessor->sparse)
		status = nt_gltf_sparse(document, found.accessor, arena, &found.replaced, &found.values, error);
	nt_displacement *kept = status ? NULL : nt_arena_alloc(arena, 1, sizeof *kept);
	if (kept)
		*kept = found;
	*delta = kept;
	return status || kept ? status : nt_fail_memory(error);
}

static void read_delta(const nt_gltf_accessor *accessor, const unsigned char *element, float *delta)
{
	if (accessor->component_type == NT_GLTF_FLOAT)
		memcpy(delta, element, 3 * sizeof *delta);
	else
		for (size_t k = 0; k < 3; k++)
			delta[k] = nt_component_value(element + k * accessor->component_bytes,
				(int)accessor->component_type, accessor->normalized);
}

/* Base and delta, malloc'ed. NULL: memory is exhausted. */
static float *add_delta(const nt_mesh *mesh, const nt_displacement *d, const float *base)
{
	const nt_gltf_accessor *a = d->accessor;
	const size_t own_count = mesh->source_vertex_count;
	const uint64_t replaced_count = a->sparse ? a->sparse->count : 0;
	float *sums = nt_calloc(mesh->vertex_count, 3 * sizeof *sums);
	if (!sums)
		return NULL;
	for (size_t v = 0, at = 0; v < own_count; v++) {
		const size_t row = nt_mesh_pool_vertex(mesh, (uint32_t)v);
		while (at < replaced_count && d->replaced[at] < row)
			at++;
		if (at < replaced_count && d->replaced[at] == row)
			read_delta(a, d->values + at * a->element_bytes, sums + 3 * v);
		else if (d->elements)
			read_delta(a, d->elements + row * a->stride, sums + 3 * v);
	}
	for (size_t v = own_count; v < mesh->vertex_count; v++)
		memcpy(sums + 3 * v, sums + 3 * (size_t)mesh->vertex_sources[v - own_count], 3 * sizeof *sums);
	for (size_t i = 0; i < 3 * mesh->vertex_count; i++)
		sums[i] = base[i] + sums[i];
	return sums;
}

/* Sums of unit normals are not unit. If nothing was added to a normal that is used as it is, the sum is used so, too:
 * the tangents there are the base's, bit for bit. */
static void normalise_moved(bool integers, const float *base, float *moved, size_t count)
{
	static const double unit = 1.0 / 2048; /* pipeline/normals.c */
	for (size_t i = 0; i < count; i++) {
		const float *b = base + 3 * i;
		const double squared = (double)b[0] * b[0] + (double)b[1] * b[1] + (double)b[2] * b[2];
		if (integers || fabs(squared - 1) > unit ||
			memcmp(b, moved + 3 * i, 3 * sizeof *b) != 0)
			nt_gltf_normalise(moved + 3 * i);
	}
}

nt_status nt_gltf_move(const nt_mesh *mesh, const nt_morph *morph, float **positions, float **normals)
{
	const float *base = mesh->stored_normals ? mesh->stored_normals : mesh->normals;
	*positions = morph->positions ? add_delta(mesh, morph->positions, mesh->positions) : NULL;
	*normals = morph->normals ? add_delta(mesh, morph->normals, base) : NULL;
	if ((morph->positions && !*positions) || (morph->normals && !*normals))
		return NT_ERROR_MEMORY;
	if (*normals)
		normalise_moved(mesh->stored_normals, base, *normals, mesh->vertex_count);
	return NT_OK;
}

/* The name of a target, as most exporters write it: the specification suggests extras.targetNames. */
static const char *name_of_target(nt_scene *scene, const nt_gltf *document, const nt_mesh *mesh, size_t target)
{
	const nt_json_value *json = nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	size_t length = 0;
	const char *name = nt_json_get_string(nt_json_at(nt_json_find(nt_json_find(json, "extras"),
		"targetNames"), target), &length);
	return nt_arena_text(nt_mesh_arena(scene, mesh), name ? name : "", name ? length : 0);
}

nt_status nt_gltf_load_targets(nt_scene *scene, nt_mesh *mesh, const nt_gltf_accessor *normals, nt_error *error)
{
	const nt_gltf *document = scene->source;
	const nt_json_value *targets = nt_json_find(nt_gltf_primitive_of(document, mesh), "targets");
	const size_t count = nt_json_count(targets);
	bool turns = false;
	mesh->morph_count = 0;
	if (count == 0)
		return NT_OK;
	mesh->morphs = nt_arena_alloc(nt_mesh_arena(scene, mesh), count, sizeof *mesh->morphs);
	if (!mesh->morphs)
		return nt_fail_memory(error);
	for (size_t i = 0; i < count; i++) {
		char pointer[NT_GLTF_POINTER];
		nt_gltf_put_number(nt_gltf_put_text(nt_gltf_mesh_pointer(pointer, mesh), "/targets/"), i);
		nt_morph morph = {.target = (uint32_t)i, .name = name_of_target(scene, document, mesh, i)};
		if (!morph.name)
			return nt_fail_memory(error);
		const nt_json_value *target = nt_json_at(targets, i);
		nt_status status = find_delta(scene, mesh, target, "POSITION", pointer, &morph.positions,
			error);
		if (!status && mesh->normals)
			status = find_delta(scene, mesh, target, "NORMAL", pointer, &morph.normals, error);
		if (status)
			return status;
		turns |= morph.normals != NULL;
		/* one that moves a neighbour turns tangents at the border */
		const nt_join *join = mesh->plan.join;
		if (morph.positions || morph.normals || (join && i < join->target_count && join->moves[i]))
			mesh->morphs[mesh->morph_count++] = morph;
	}
	if (!turns || normals->component_type == NT_GLTF_FLOAT)
		return NT_OK;
	mesh->stored_normals = mesh->normals;
	return nt_gltf_own_normals(scene, mesh, error);
}

/* ---- deltas of tangents ---- */

/* Most targets move a small part of a mesh. If they move nothing, a solve gives the base's tangents again but for the
 * rounding of floats, and what is stored of these may be integers: a delta that is not above either is zero, and a
 * sparse accessor has the others. If the normals of the target are integers, its tangents are integers of that type;
 * these end at 1, and a tangent that turns round takes a delta of 2. */

/* Bytes that a sparse accessor takes in JSON beyond a dense one with its view. */
enum { SPARSE_JSON = 64 };

/* nt_precision_round() takes one of the integers on either side. */
float nt_morph_least(nt_precision precision)
{
	return precision == NT_PRECISION_BYTE ? 1.0f / 127.0f :
	       precision == NT_PRECISION_SHORT ? 1.0f / 32767.0f : NT_MORPH_LEAST;
}

/* Half a step: the box of unit vectors is 2 wide at most. */
float nt_morph_least_of_bits(int bits)
{
	return 1.0f / (float)((1u << bits) - 1) + NT_MORPH_LEAST;
}

/* The integer that is decoded to 1; 0: floats. */
static float most_of(uint32_t type)
{
	return type == NT_GLTF_BYTE ? 127.0f : type == NT_GLTF_SHORT ? 32767.0f : 0.0f;
}

size_t nt_morph_deltas(const float *moved, const float *base, size_t count, float least, uint32_t *type, float *deltas)
{
	float largest = 0;
	for (size_t v = 0; v < count; v++) {
		float *delta = deltas + 3 * v, reach = 0;
		for (size_t k = 0; k < 3; k++) {
			delta[k] = nt_morph_delta(moved[3 * v + k], base[4 * v + k]);
			reach = fmaxf(reach, fabsf(delta[k]));
		}
		if (reach <= least)
			memset(delta, 0, 3 * sizeof *delta);
		largest = fmaxf(largest, reach);
	}
	if (largest > 1)
		*type = NT_GLTF_FLOAT;
	const float most = most_of(*type);
	size_t moved_count = 0;
	for (size_t v = 0; v < count; v++) {
		float *delta = deltas + 3 * v;
		for (size_t k = 0; most > 0 && k < 3; k++)
			delta[k] = rintf(delta[k] * most) / most + 0.0f;
		moved_count += delta[0] != 0 || delta[1] != 0 || delta[2] != 0;
	}
	return moved_count;
}

nt_morph_storage nt_morph_choose_storage(uint32_t type, size_t count, size_t moved_count)
{
	const size_t element = 3 * nt_gltf_component_bytes(type);
	nt_morph_storage s = {.type = type, .stride = (element + 3) / 4 * 4,
		.element_count = moved_count ? moved_count : 1, .index_type = nt_gltf_index_type(count, NT_GLTF_UBYTE)};
	s.value_offset = (s.element_count * nt_gltf_component_bytes(s.index_type) + 3) / 4 * 4;
	s.size = s.value_offset + s.element_count * element;
	s.sparse = s.size + SPARSE_JSON < count * s.stride;
	if (!s.sparse)
		s.size = count * s.stride;
	return s;
}

static void store_element(const float *delta, uint32_t type, unsigned char *bytes)
{
	const float most = most_of(type);
	for (size_t k = 0; k < 3; k++) {
		const int16_t value = (int16_t)lrintf(delta[k] * most);
		const int8_t small = (int8_t)value;
		if (type == NT_GLTF_FLOAT)
			memcpy(bytes + 4 * k, &delta[k], 4);
		else if (type == NT_GLTF_SHORT)
			memcpy(bytes + 2 * k, &value, 2);
		else
			memcpy(bytes + k, &small, 1);
	}
}

void nt_morph_store(const nt_morph_storage *s, const float *deltas, size_t count, unsigned char *bytes)
{
	const size_t element = 3 * nt_gltf_component_bytes(s->type);
	const uint32_t index_bytes = nt_gltf_component_bytes(s->index_type);
	size_t stored = 0;
	for (size_t v = 0; v < count; v++) {
		const float *delta = deltas + 3 * v;
		const uint32_t number = (uint32_t)v;
		if (!s->sparse) {
			store_element(delta, s->type, bytes + v * s->stride);
		} else if (delta[0] != 0 || delta[1] != 0 || delta[2] != 0) {
			nt_gltf_store_indices(&number, 1, index_bytes, bytes + stored * index_bytes);
			store_element(delta, s->type, bytes + s->value_offset + stored++ * element);
		}
	}
}

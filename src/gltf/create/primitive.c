/* SPDX-License-Identifier: MIT */
/*
 * Primitives of a new document: triangles over vertices, ready to be written attribute by attribute. That of a mesh
 * with one material refers to the mesh's own arrays; of a mesh with several each gets the vertices it uses, in the
 * order of first use. Planning makes at most one array of indices per mesh; attributes are gathered while they are
 * written, through a buffer that stays in the cache, and go straight from the mesh where nothing has to be changed. So
 * writing costs about what copying to the file costs.
 */
#include "gltf/create/model.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/vec.h"
#include "gltf/document.h"

enum { BLOCK_ROWS = 4096 };

static const unsigned char quad_corners[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};

/* ---- planning ---- */

/* Vertex of each corner after the split; NULL: the corner itself. */
static const uint32_t *corner_vertices(const nt_mesh *mesh)
{
	return mesh->split.indices ? mesh->split.indices : mesh->indices;
}

static size_t vertex_count_after_split(const nt_mesh *mesh)
{
	return mesh->vertex_count + mesh->split.source_count;
}

/* A mesh with one primitive that is drawn as it is. */
static nt_new_primitive whole_primitive(const nt_mesh *mesh)
{
	const uint32_t *indices = corner_vertices(mesh);
	return (nt_new_primitive){
		.mesh = mesh,
		.material = mesh->primitive_count ? mesh->primitives[0].material : NT_NONE,
		.group = mesh->primitive_count ? mesh->primitives[0].group : 0,
		.vertex_count = indices ? vertex_count_after_split(mesh) : mesh->corner_count,
		.index_count = indices ? mesh->corner_count : 0,
		.indices = indices,
	};
}

/* The corners of all triangles, those of each primitive together and in the order of the faces.
 * first[p] says where primitive p begins and has room for primitive_count + 1. */
static uint32_t *sort_triangles(const nt_mesh *mesh, nt_arena *arena, size_t *first)
{
	const size_t primitives = mesh->primitive_count ? mesh->primitive_count : 1;
	const uint32_t *of_face = primitives > 1 ? mesh->face_primitive : NULL;
	uint32_t *sorted = nt_arena_alloc(arena, 3 * nt_mesh_triangle_count(mesh), sizeof *sorted);
	if (!sorted)
		return NULL;
	memset(first, 0, (primitives + 1) * sizeof *first);
	for (size_t f = 0; f < mesh->face_count; f++)
		first[(of_face ? of_face[f] : 0) + 1] += mesh->face_sizes && mesh->face_sizes[f] == 4 ? 6 : 3;
	for (size_t p = 0; p < primitives; p++)
		first[p + 1] += first[p];

	const uint32_t *vertices = corner_vertices(mesh);
	size_t corner = 0;
	for (size_t f = 0; f < mesh->face_count; f++) {
		const bool quad = mesh->face_sizes && mesh->face_sizes[f] == 4;
		const int diagonal = quad && mesh->face_diagonals ? mesh->face_diagonals[f] : 0;
		const size_t count = quad ? 6 : 3;
		uint32_t *to = sorted + first[of_face ? of_face[f] : 0];
		for (size_t k = 0; k < count; k++) {
			const size_t c = corner + quad_corners[diagonal][k];
			to[k] = vertices ? vertices[c] : (uint32_t)c;
		}
		first[of_face ? of_face[f] : 0] += count;
		corner += quad ? 4 : 3;
	}
	/* filling moved each beginning to its end, which is the next one's beginning */
	memmove(first + 1, first, primitives * sizeof *first);
	first[0] = 0;
	return sorted;
}

/* Gives the primitive the vertices that its indices use, in the order of first use. `numbers` is NT_NONE
 * for all vertices, before and after. */
static bool compact(nt_new_primitive *primitive, uint32_t *indices, uint32_t *numbers, nt_arena *arena)
{
	size_t count = 0;
	for (size_t i = 0; i < primitive->index_count; i++)
		if (numbers[indices[i]] == NT_NONE)
			numbers[indices[i]] = (uint32_t)count++;
	uint32_t *vertices = nt_arena_alloc(arena, count, sizeof *vertices);
	if (!vertices)
		return false;
	for (size_t i = 0; i < primitive->index_count; i++) {
		const uint32_t number = numbers[indices[i]];
		vertices[number] = indices[i];
		indices[i] = number;
	}
	for (size_t i = 0; i < count; i++)
		numbers[vertices[i]] = NT_NONE;
	primitive->vertex_count = count;
	primitive->vertices = vertices;
	return true;
}

/* One for each of the mesh's primitives that has faces. */
static bool divide(const nt_mesh *mesh, nt_arena *arena, nt_new_primitives *made, const size_t *first,
	uint32_t *sorted)
{
	const size_t vertices = vertex_count_after_split(mesh);
	uint32_t *numbers = nt_alloc(vertices, sizeof *numbers);
	if (!numbers)
		return false;
	memset(numbers, 0xff, vertices * sizeof *numbers);
	bool done = true;
	for (size_t p = 0; p < mesh->primitive_count && done; p++) {
		if (first[p] == first[p + 1])
			continue;
		nt_new_primitive *primitive = &made->items[made->count++];
		*primitive = (nt_new_primitive){.mesh = mesh,
			.material = mesh->primitives[p].material,
			.group = mesh->primitives[p].group,
			.index_count = first[p + 1] - first[p],
			.indices = sorted + first[p]};
		done = compact(primitive, sorted + first[p], numbers, arena);
	}
	free(numbers);
	return done;
}

nt_status nt_new_primitives_make(const nt_mesh *mesh, nt_arena *arena, nt_new_primitives *made, nt_error *error)
{
	*made = (nt_new_primitives){0};
	if (mesh->face_count == 0)
		return NT_OK;
	if (vertex_count_after_split(mesh) > UINT32_MAX)
		return nt_fail(error, NT_ERROR_TOO_LARGE,
			"the mesh has %zu vertices, glTF can number 4294967295",
			vertex_count_after_split(mesh));
	if (mesh->face_sizes && mesh->split.vertex_tangents && !mesh->face_diagonals)
		return nt_fail(error, NT_ERROR_INTERNAL, "solved quads come without their diagonals");

	const size_t primitives = mesh->primitive_count ? mesh->primitive_count : 1;
	made->items = nt_arena_alloc(arena, primitives, sizeof *made->items);
	if (!made->items)
		return nt_fail_memory(error);
	if (primitives == 1) {
		made->items[0] = whole_primitive(mesh);
		made->count = 1;
		if (!mesh->face_sizes)
			return NT_OK;
	}
	size_t *first = nt_arena_alloc(arena, primitives + 1, sizeof *first);
	uint32_t *sorted = first ? sort_triangles(mesh, arena, first) : NULL;
	if (!sorted)
		return nt_fail_memory(error);
	if (primitives == 1) {
		made->items[0].vertex_count = vertex_count_after_split(mesh);
		made->items[0].indices = sorted;
		made->items[0].index_count = first[1];
		return NT_OK;
	}
	return divide(mesh, arena, made, first, sorted) ? NT_OK : nt_fail_memory(error);
}

/* ---- what a primitive has ---- */

static const struct {
	const char *name;
	int width;
} attribute_table[NT_ATTRIBUTE_COUNT] = {
	[NT_ATTRIBUTE_POSITION] = {"POSITION", 3},
	[NT_ATTRIBUTE_NORMAL] = {"NORMAL", 3},
	[NT_ATTRIBUTE_TANGENT] = {"TANGENT", 4},
	[NT_ATTRIBUTE_TEXCOORD] = {"TEXCOORD_0", 2},
	[NT_ATTRIBUTE_COLOR] = {"COLOR_0", 4},
	[NT_ATTRIBUTE_BITANGENT] = {"_BITANGENT", 3},
};

const char *nt_attribute_name(nt_attribute attribute)
{
	return attribute_table[attribute].name;
}

int nt_attribute_width(nt_attribute attribute)
{
	return attribute_table[attribute].width;
}

/* Tangents by vertex after the split: solved, or authored ones that were kept. */
static const float *vertex_tangents(const nt_mesh *mesh)
{
	return mesh->split.vertex_tangents ? mesh->split.vertex_tangents : mesh->tangents;
}

/* The mesh's array for an attribute; all but tangents have a row for the vertices before the split only. */
static const float *attribute_rows(const nt_mesh *mesh, nt_attribute attribute)
{
	switch (attribute) {
	case NT_ATTRIBUTE_POSITION:
		return mesh->positions;
	case NT_ATTRIBUTE_NORMAL:
		return mesh->normals;
	case NT_ATTRIBUTE_TEXCOORD:
		return mesh->texcoords;
	case NT_ATTRIBUTE_COLOR:
		return mesh->colors;
	default:
		return mesh->normals ? vertex_tangents(mesh) : NULL;
	}
}

bool nt_new_primitive_has(const nt_new_primitive *primitive, nt_attribute attribute)
{
	return attribute_rows(primitive->mesh, attribute) != NULL;
}

uint32_t nt_new_primitive_index_type(const nt_new_primitive *primitive)
{
	return nt_gltf_index_type(primitive->vertex_count, NT_GLTF_USHORT);
}

/* The vertex before the split whose attributes a vertex of the primitive has. */
static size_t source_vertex(const nt_new_primitive *primitive, size_t row)
{
	const size_t vertex = primitive->vertices ? primitive->vertices[row] : row;
	const nt_mesh *mesh = primitive->mesh;
	return vertex < mesh->vertex_count ? vertex : mesh->split.sources[vertex - mesh->vertex_count];
}

void nt_new_primitive_bounds(const nt_new_primitive *primitive, float min[3], float max[3])
{
	float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
	/* without a list the copies follow the vertices they are copies of */
	const size_t count = primitive->vertices || primitive->vertex_count < primitive->mesh->vertex_count
		? primitive->vertex_count : primitive->mesh->vertex_count;
	for (size_t i = 0; i < count; i++) {
		const float *p =
			primitive->mesh->positions + 3 * (primitive->vertices ? source_vertex(primitive, i) : i);
		for (int k = 0; k < 3; k++) {
			low[k] = p[k] < low[k] ? p[k] : low[k];
			high[k] = p[k] > high[k] ? p[k] : high[k];
		}
	}
	for (int k = 0; k < 3; k++) {
		/* JSON has no infinity; all NaN leaves the initial values the wrong way round */
		const bool none = low[k] > high[k];
		min[k] = none ? 0 : fmaxf(low[k], -FLT_MAX);
		max[k] = none ? 0 : fminf(high[k], FLT_MAX);
		min[k] = fminf(min[k], FLT_MAX);
		max[k] = fmaxf(max[k], -FLT_MAX);
	}
}

/* ---- writing ---- */

/* glTF asks for unit normals and the validator allows 0.00674; what is off by more than a tenth of that is
 * normalised. Shorter than any direction, or not finite: along z, so that the file stays valid. */
static bool is_unit(const float n[3])
{
	const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
	return fabsf(square - 1) <= 1e-3f;
}

static bool all_unit(const float *normals, size_t count)
{
	bool unit = true;
	for (size_t i = 0; i < count; i++)
		unit &= is_unit(normals + 3 * i);
	return unit;
}

/* Rows [begin, begin + count) of an attribute's array, as the mesh has them. */
static void gather(const nt_new_primitive *primitive, nt_attribute attribute, size_t begin, size_t count,
	float *out)
{
	const nt_mesh *mesh = primitive->mesh;
	const size_t width = attribute == NT_ATTRIBUTE_BITANGENT ? 4 : (size_t)attribute_table[attribute].width;
	const float *rows = attribute_rows(mesh, attribute);
	const bool split_rows = attribute == NT_ATTRIBUTE_TANGENT || attribute == NT_ATTRIBUTE_BITANGENT;
	const size_t stored = split_rows ? vertex_count_after_split(mesh) : mesh->vertex_count;
	if (!primitive->vertices && begin + count <= stored) {
		memcpy(out, rows + width * begin, width * count * sizeof *out);
		return;
	}
	for (size_t i = 0; i < count; i++) {
		const size_t row = begin + i;
		const size_t from = !split_rows ? source_vertex(primitive, row)
			: primitive->vertices ? primitive->vertices[row] : row;
		memcpy(out + width * i, rows + width * from, width * sizeof *out);
	}
}

static void make_units(float *normals, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if (!is_unit(normals + 3 * i)) {
			float *n = normals + 3 * i;
			const double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
			const bool usable = length > 0 && isfinite(length);
			for (int k = 0; k < 3; k++)
				n[k] = usable ? (float)(n[k] / length) : k == 2;
		}
}

nt_status nt_new_primitive_write_attribute(const nt_new_primitive *primitive, nt_attribute attribute,
	nt_precision precision, nt_rounding *cost, const nt_byte_target *to, nt_error *error)
{
	const nt_mesh *mesh = primitive->mesh;
	const bool rounds = attribute == NT_ATTRIBUTE_TANGENT && precision > NT_PRECISION_FLOAT;
	const size_t row_bytes = rounds ? nt_precision_bytes(precision)
					: (size_t)attribute_table[attribute].width * sizeof(float);
	size_t begin = 0;
	const bool as_it_is = attribute == NT_ATTRIBUTE_POSITION || attribute == NT_ATTRIBUTE_COLOR ||
		(attribute == NT_ATTRIBUTE_TANGENT && !rounds) ||
		(attribute == NT_ATTRIBUTE_NORMAL && all_unit(mesh->normals, mesh->vertex_count));
	if (as_it_is && !primitive->vertices) {
		const size_t stored = attribute == NT_ATTRIBUTE_TANGENT ? vertex_count_after_split(mesh)
								  : mesh->vertex_count;
		begin = primitive->vertex_count < stored ? primitive->vertex_count : stored;
		const nt_status status =
			nt_target_put(to, attribute_rows(mesh, attribute), begin * row_bytes, error);
		if (status != NT_OK)
			return status;
	}
	float block[4 * BLOCK_ROWS], normals[3 * BLOCK_ROWS];
	unsigned char integers[8 * BLOCK_ROWS];
	while (begin < primitive->vertex_count) {
		const size_t left = primitive->vertex_count - begin;
		const size_t count = left < BLOCK_ROWS ? left : BLOCK_ROWS;
		gather(primitive, attribute, begin, count, block);
		if (attribute == NT_ATTRIBUTE_TEXCOORD)
			for (size_t i = 0; i < count; i++)
				block[2 * i + 1] = 1 - block[2 * i + 1];
		if (attribute == NT_ATTRIBUTE_NORMAL)
			make_units(block, count);
		if (attribute == NT_ATTRIBUTE_BITANGENT) {
			gather(primitive, NT_ATTRIBUTE_NORMAL, begin, count, normals);
			make_units(normals, count);
			/* B = cross(N, T) * w in place of the tangents: row i of it ends before row i of them */
			for (size_t i = 0; i < count; i++)
				nt_bitangent(normals + 3 * i, block + 4 * i, block + 3 * i);
		}
		if (rounds) {
			nt_precision_round(precision, block, count, cost);
			nt_precision_encode(precision, block, count, integers);
		}
		const nt_status status = nt_target_put(to, rounds ? (const void *)integers : block, count * row_bytes,
			error);
		if (status != NT_OK)
			return status;
		begin += count;
	}
	return NT_OK;
}

nt_status nt_new_primitive_write_indices(const nt_new_primitive *primitive, const nt_byte_target *to, nt_error *error)
{
	if (nt_new_primitive_index_type(primitive) == NT_GLTF_UINT)
		return nt_target_put(to, primitive->indices, primitive->index_count * sizeof *primitive->indices,
			error);
	uint16_t block[4 * BLOCK_ROWS];
	size_t begin = 0;
	while (begin < primitive->index_count) {
		const size_t left = primitive->index_count - begin;
		const size_t count = left < 4 * BLOCK_ROWS ? left : 4 * BLOCK_ROWS;
		for (size_t i = 0; i < count; i++)
			block[i] = (uint16_t)primitive->indices[begin + i];
		const nt_status status = nt_target_put(to, block, count * sizeof *block, error);
		if (status != NT_OK)
			return status;
		begin += count;
	}
	return NT_OK;
}

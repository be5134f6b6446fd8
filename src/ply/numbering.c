/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a PLY that is written from a PLY: rows of the source keep their number. Vertices that were told apart
 * by per-face texture coordinates alone become one again if their normals and tangents are equal, since the coordinates
 * stay with the faces.
 */
#include "ply/parts.h"

#include <stdlib.h>
#include "base/hash_index.h"

size_t ply_mesh_vertex(const ply_numbering *n, size_t vertex)
{
	const nt_mesh *mesh = n->mesh;
	return vertex < mesh->vertex_count ? vertex : mesh->split.sources[vertex - mesh->vertex_count];
}

size_t ply_source_row(const ply_numbering *n, size_t vertex)
{
	const nt_mesh *mesh = n->mesh;
	size_t v = ply_mesh_vertex(n, vertex);
	if (v >= mesh->source_vertex_count)
		v = mesh->vertex_sources[v - mesh->source_vertex_count];
	return v < n->row_count ? v : n->source->wedge_rows[v - n->row_count];
}

/* Values by which vertices of one row may differ in the output. */
typedef struct values {
	size_t row;
	float tangent[4], normal[3], unused;
} values;

static values values_of(const ply_numbering *n, size_t vertex)
{
	const nt_mesh *mesh = n->mesh;
	values v = {.row = ply_source_row(n, vertex)};
	if (mesh->split.vertex_tangents)
		memcpy(v.tangent, mesh->split.vertex_tangents + 4 * vertex, sizeof v.tangent);
	if (mesh->normals_made)
		memcpy(v.normal, mesh->normals + 3 * ply_mesh_vertex(n, vertex), sizeof v.normal);
	return v;
}

/* Numbers vertices so that those of one row with equal values are one. */
static bool merge_wedges(ply_numbering *n)
{
	nt_hash_index index = {0}; /* of appended vertices */
	bool done = true;
	for (size_t i = n->row_count; done && i < n->final_count; i++) {
		const values own = values_of(n, i), first = values_of(n, own.row);
		uint32_t number = memcmp(&own, &first, sizeof own) == 0 ? (uint32_t)own.row : NT_NONE;
		const uint64_t hash = nt_hash_bytes(0, &own, sizeof own);
		size_t at = NT_HASH_BEGIN;
		for (uint32_t k; number == NT_NONE && (k = nt_hash_index_next(&index, hash, &at)) != NT_NONE;) {
			const values other = values_of(n, n->appended[k]);
			if (memcmp(&own, &other, sizeof own) == 0)
				number = (uint32_t)(n->row_count + k);
		}
		if (number == NT_NONE) {
			number = (uint32_t)(n->row_count + n->appended_count);
			done = nt_hash_index_add(&index, hash, (uint32_t)n->appended_count);
			n->appended[n->appended_count++] = (uint32_t)i;
		}
		n->numbers[i - n->row_count] = number;
	}
	nt_hash_index_free(&index);
	return done;
}

static bool number_vertices(ply_numbering *n)
{
	const nt_mesh *mesh = n->mesh;
	n->final_count = mesh->vertex_count + mesh->split.source_count;
	n->indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	const size_t count = n->final_count - n->row_count;
	n->numbers = nt_alloc(count, sizeof *n->numbers);
	n->appended = nt_alloc(count, sizeof *n->appended);
	if (!n->numbers || !n->appended)
		return false;
	if (n->source->wedge_count > 0)
		return merge_wedges(n);
	for (size_t i = 0; i < count; i++) {
		n->numbers[i] = (uint32_t)(n->row_count + i);
		n->appended[i] = (uint32_t)(n->row_count + i);
	}
	n->appended_count = count;
	return true;
}

uint32_t ply_output_vertex(const ply_numbering *n, size_t corner)
{
	const uint32_t v = n->indices[corner];
	return v < n->row_count ? v : n->numbers[v - n->row_count];
}

bool ply_resolve_polygon(const ply_numbering *n, size_t corner, size_t size, const uint32_t *cut,
	uint32_t *vertices)
{
	bool agrees = true;
	for (size_t k = 0; k < size; k++)
		vertices[k] = NT_NONE;
	for (size_t i = 0; i < 3 * (size - 2); i++) {
		const uint32_t vertex = ply_output_vertex(n, corner + i);
		uint32_t *known = &vertices[cut[i]];
		agrees &= *known == NT_NONE || *known == vertex;
		*known = vertex;
	}
	for (size_t k = 0; k < size; k++)
		agrees &= vertices[k] != NT_NONE;
	return agrees;
}

/* Counts the polygons that become triangles: the header needs the number of faces. */
static bool count_cut_polygons(ply_numbering *n)
{
	const nt_mesh *mesh = n->mesh;
	uint32_t *vertices = NULL;
	size_t capacity = 0, cut = 0;
	for (size_t face = 0, corner = 0; mesh->face_polygon && face < mesh->face_count;) {
		size_t end = face + 1;
		while (end < mesh->face_count && mesh->face_polygon[end] == mesh->face_polygon[face])
			end++;
		const size_t triangles = end - face;
		if (triangles == 1) {
			corner += mesh->face_sizes ? mesh->face_sizes[face] : 3;
		} else {
			if (!nt_grow((void **)&vertices, &capacity, triangles + 2, sizeof *vertices)) {
				free(vertices);
				return false;
			}
			if (!ply_resolve_polygon(n, corner, triangles + 2, n->source->cuts + cut, vertices)) {
				n->cut_polygons++;
				n->added_faces += triangles - 1;
			}
			corner += 3 * triangles;
			cut += 3 * triangles;
		}
		face = end;
	}
	free(vertices);
	return true;
}

bool ply_number_vertices(ply_numbering *n, const nt_mesh *mesh, const ply_source *source)
{
	*n = (ply_numbering){.mesh = mesh, .source = source, .row_count = source->vertex->count};
	return number_vertices(n) && count_cut_polygons(n);
}

void ply_numbering_free(ply_numbering *n)
{
	free(n->numbers);
	free(n->appended);
}

/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a PLY that is written from a PLY: rows of the source keep their number. Vertices that were told apart
 * by per-face texture coordinates alone become one again if their normals and tangents are equal, since the coordinates
 * stay with the faces.
 */
#include "ply/parts.h"

#include <stdlib.h>

enum { MOST_CHAIN = 64 };

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

static bool same_values(const ply_numbering *n, size_t a, size_t b)
{
	const nt_mesh *mesh = n->mesh;
	const float *tangents = mesh->split.vertex_tangents;
	if (tangents && memcmp(tangents + 4 * a, tangents + 4 * b, 4 * sizeof *tangents) != 0)
		return false;
	if (!mesh->normals_made)
		return true;
	const float *na = mesh->normals + 3 * ply_mesh_vertex(n, a);
	const float *nb = mesh->normals + 3 * ply_mesh_vertex(n, b);
	return memcmp(na, nb, 3 * sizeof *na) == 0;
}

/* The output vertices of each row, as chains from the newest to the row itself. */
typedef struct row_chains {
	uint32_t *last;     /* [row_count] newest output vertex */
	uint32_t *previous; /* [appended_count] */
} row_chains;

/* The output vertex of that row with the values of v; NT_NONE: none. If a row has very many copies, the search stops
 * after a while: the output is then larger, never wrong. */
static uint32_t find_equal(const ply_numbering *n, const row_chains *chains, size_t row, size_t v)
{
	uint32_t other = chains->last[row];
	for (int steps = 0; other >= n->row_count && steps < MOST_CHAIN; steps++) {
		if (same_values(n, n->appended[other - n->row_count], v))
			return other;
		other = chains->previous[other - n->row_count];
	}
	return other < n->row_count && same_values(n, other, v) ? other : NT_NONE;
}

static void merge_into(ply_numbering *n, row_chains *chains)
{
	for (size_t row = 0; row < n->row_count; row++)
		chains->last[row] = (uint32_t)row;
	for (size_t v = n->row_count; v < n->final_count; v++) {
		const size_t row = ply_source_row(n, v);
		uint32_t number = find_equal(n, chains, row, v);
		if (number == NT_NONE) {
			number = (uint32_t)(n->row_count + n->appended_count);
			chains->previous[n->appended_count] = chains->last[row];
			chains->last[row] = number;
			n->appended[n->appended_count++] = (uint32_t)v;
		}
		n->numbers[v - n->row_count] = number;
	}
}

static bool merge_wedges(ply_numbering *n)
{
	row_chains chains = {
		.last = nt_alloc(n->row_count, sizeof *chains.last),
		.previous = nt_alloc(n->final_count - n->row_count, sizeof *chains.previous),
	};
	const bool sound = chains.last && chains.previous;
	if (sound)
		merge_into(n, &chains);
	free(chains.last);
	free(chains.previous);
	return sound;
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

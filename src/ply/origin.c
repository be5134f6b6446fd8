/* SPDX-License-Identifier: MIT */
/*
 * Positions that float cannot hold: the rule is that of scene/origin.h. It is asked when all floats and faces have been
 * read, and only if the properties are doubles or integers of 32 bits, or the user names an origin. Then the rows of
 * vertices are read again, as doubles, and polygons cut again, since the first cut was made by floats.
 */
#include <stdlib.h>
#include "ply/source.h"
#include "scene/origin.h"
#include "scene/polygon.h"

size_t ply_sample_edges(const nt_mesh *mesh, const double *exact, size_t most, double *lengths)
{
	const size_t step = mesh->face_count / most + 1;
	size_t count = 0, corner = 0;
	for (size_t f = 0; f < mesh->face_count; f += step) {
		const size_t k = count % 3, from = corner + (k < 2 ? k : 0), to = corner + (k < 2 ? k + 1 : 2);
		const size_t a = mesh->indices ? mesh->indices[from] : from;
		const size_t b = mesh->indices ? mesh->indices[to] : to;
		double square = 0;
		for (size_t i = 0; i < 3; i++) {
			const double d = exact ? exact[3 * a + i] - exact[3 * b + i]
				: (double)mesh->positions[3 * a + i] - (double)mesh->positions[3 * b + i];
			square += d * d;
		}
		lengths[count] = sqrt(square);
		count += square > 0 || !exact;
		for (size_t i = f; i < f + step && i < mesh->face_count && mesh->face_sizes; i++)
			corner += mesh->face_sizes[i];
		corner += mesh->face_sizes ? 0 : 3 * step;
	}
	return count;
}

/* Positions of rows, of copies that texture coordinates of faces made, and the polygons that were cut by floats. */
static bool read_exact(const nt_mesh *mesh, const ply_source *source, ply_cursor *cursor, double *exact)
{
	const size_t rows = source->vertex->count;
	nt_error unused;
	if (ply_has_wide_positions(source)) {
		cursor->at = cursor->begin + source->vertex_begin;
		if (ply_read_exact_positions(source, cursor, exact, &unused))
			return false;
	} else {
		for (size_t i = 0; i < 3 * rows; i++)
			exact[i] = mesh->positions[i];
	}
	for (size_t i = 0; i < source->wedge_count; i++)
		memcpy(exact + 3 * (rows + i), exact + 3 * (size_t)source->wedge_rows[i], 3 * sizeof *exact);
	return true;
}

/* Cuts the polygon whose `size` - 2 triangles begin at a corner of the mesh, and in `cut`, once more. */
static bool cut_again(nt_mesh *mesh, size_t corner, size_t size, uint32_t *cut, bool *sound)
{
	uint32_t *vertices = nt_alloc(size, sizeof *vertices);
	float (*points)[3] = nt_alloc(size, sizeof *points);
	bool done = vertices && points;
	if (done) {
		for (size_t i = 0; i < 3 * (size - 2); i++)
			vertices[cut[i]] = mesh->indices[corner + i];
		for (size_t k = 0; k < size; k++)
			memcpy(points[k], mesh->positions + 3 * (size_t)vertices[k], sizeof *points);
		done = !nt_polygon_triangulate((const float(*)[3])points, size, cut, sound);
		for (size_t i = 0; done && i < 3 * (size - 2); i++)
			mesh->indices[corner + i] = vertices[cut[i]];
	}
	free(vertices);
	free(points);
	return done;
}

static bool cut_all_again(nt_mesh *mesh, ply_cuts *cuts)
{
	size_t corner = 0, cut = 0;
	bool done = true;
	cuts->unsound = 0;
	for (size_t f = 0; f < mesh->face_count && cut < cuts->count && done;) {
		size_t end = f + 1;
		while (end < mesh->face_count && mesh->face_polygon[end] == mesh->face_polygon[f])
			end++;
		if (end - f > 1) {
			bool sound;
			done = cut_again(mesh, corner, end - f + 2, cuts->corners + cut, &sound);
			cuts->unsound += done && !sound;
			cut += 3 * (end - f);
		}
		corner += end - f > 1 || !mesh->face_sizes ? 3 * (end - f) : mesh->face_sizes[f];
		f = end;
	}
	return done;
}

nt_status ply_settle_origin(nt_scene *scene, nt_mesh *mesh, ply_source *source, const nt_origin *wished,
	ply_cursor *cursor, nt_error *error)
{
	if (!mesh->face_count || (!ply_has_wide_positions(source) && !nt_origin_is_given(wished)))
		return NT_OK;
	double *lengths = nt_alloc(NT_ORIGIN_SAMPLED, sizeof *lengths), *exact = NULL;
	bool done = lengths != NULL;
	const float largest = nt_largest_of(mesh->positions, 3 * mesh->vertex_count, 0);
	const size_t tried = done ? ply_sample_edges(mesh, NULL, NT_ORIGIN_TRIED, lengths) : 0;
	if (done && (nt_origin_is_given(wished) ||
			    nt_origin_is_suspected(largest, lengths, tried, NT_ORIGIN_DOUBT))) {
		exact = nt_calloc(mesh->vertex_count, 3 * sizeof *exact);
		done = exact && read_exact(mesh, source, cursor, exact);
		if (done)
			nt_origin_settle(scene, wished, &(nt_exact){exact, mesh->vertex_count, lengths,
				ply_sample_edges(mesh, exact, NT_ORIGIN_SAMPLED, lengths)}, mesh->positions);
		if (done && nt_scene_has_origin(scene))
			done = cut_all_again(mesh, &source->cuts);
		nt_origin_matrix(scene, scene->instances->matrix);
	}
	free(lengths);
	free(exact);
	return done ? NT_OK : nt_fail_memory(error);
}

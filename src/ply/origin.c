/* SPDX-License-Identifier: MIT */
/*
 * Positions that float cannot hold: the rule is that of scene/origin.h. It is asked when all floats and faces have been
 * read, and only if the properties are doubles or integers of 32 bits, or the user names an origin. Then the rows of
 * vertices are read again, into columns of doubles.
 */
#include "ply/parts.h"

#include <stdlib.h>
#include "scene/origin.h"

size_t ply_sample_edges(const nt_mesh *mesh, const double *exact, size_t most, double *lengths)
{
	const size_t step = mesh->face_count / most + 1;
	size_t count = 0, corner = 0;
	for (size_t f = 0; f < mesh->face_count; f += step) {
		const size_t k = count % 3, from = corner + (k < 2 ? k : 0), to = corner + (k < 2 ? k + 1 : 2);
		const size_t a = mesh->indices ? mesh->indices[from] : from;
		const size_t b = mesh->indices ? mesh->indices[to] : to;
		lengths[count] = nt_edge_length(mesh->positions, exact, a, b);
		count += lengths[count] > 0 || !exact;
		for (size_t i = f; i < f + step && i < mesh->face_count && mesh->face_sizes; i++)
			corner += mesh->face_sizes[i];
		corner += mesh->face_sizes ? 0 : 3 * step;
	}
	return count;
}

/* Whether positions are of a type that float does not hold. */
static bool has_wide_positions(const ply_source *source)
{
	bool wide = false;
	for (size_t k = 0; k < 3; k++) {
		const ply_type type = source->vertex->properties[source->roles.position[k]].type;
		wide |= type == PLY_FLOAT64 || type == PLY_INT32 || type == PLY_UINT32;
	}
	return wide;
}

/* Positions of rows, and of copies that texture coordinates of faces made. */
static bool read_exact(const nt_mesh *mesh, const ply_source *source, ply_cursor *cursor, double *exact)
{
	const size_t count = source->vertex->count;
	nt_error unused;
	ply_rows rows;
	cursor->at = cursor->begin + source->vertex_begin;
	bool done = ply_begin_rows(&rows, cursor, source->vertex);
	for (size_t k = 0; done && k < 3; k++)
		rows.columns[source->roles.position[k]] =
			(ply_column){.use = PLY_DOUBLES, .doubles = exact + k, .stride = 3};
	if (!has_wide_positions(source))
		for (size_t i = 0; i < 3 * count; i++)
			exact[i] = mesh->positions[i];
	else
		done = done && !ply_read_rows(&rows, &unused);
	for (size_t i = 0; i < source->wedge_count; i++)
		memcpy(exact + 3 * (count + i), exact + 3 * (size_t)source->wedge_rows[i], 3 * sizeof *exact);
	ply_free_rows(&rows);
	return done;
}

nt_status ply_settle_origin(nt_scene *scene, nt_mesh *mesh, const ply_source *source, const nt_origin *wished,
	ply_cursor *cursor, nt_error *error)
{
	if (!mesh->face_count || (!has_wide_positions(source) && !nt_origin_is_given(wished)))
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
			nt_origin_settle(scene, wished, &(nt_exact){.positions = exact,
				.vertex_count = mesh->vertex_count, .edges = lengths, .edge_count =
				ply_sample_edges(mesh, exact, NT_ORIGIN_SAMPLED, lengths), .stored = wished->to_ply,
				.needless = wished->to_ply && wished->keeps && mesh->normals && mesh->tangents},
				mesh->positions);
		nt_origin_matrix(scene, scene->instances->matrix);
	}
	free(lengths);
	free(exact);
	return done ? NT_OK : nt_fail_memory(error);
}

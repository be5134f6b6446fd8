/* SPDX-License-Identifier: MIT */
#include "report/quads.h"

#include <math.h>
#include <string.h>
#include "topology/orientation.h"

static uint32_t vertex_of(const nt_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : (uint32_t)corner;
}

static bool are_rows_equal(const float *rows, size_t floats, uint32_t a, uint32_t b)
{
	for (size_t i = 0; rows && i < floats; i++)
		if (!(rows[floats * a + i] == rows[floats * b + i]))
			return false;
	return true;
}

static bool are_equal(const nt_mesh *mesh, size_t corner, size_t other)
{
	const uint32_t a = vertex_of(mesh, corner), b = vertex_of(mesh, other);
	return a == b || (are_rows_equal(mesh->positions, 3, a, b) && are_rows_equal(mesh->normals, 3, a, b) &&
		are_rows_equal(mesh->texcoords, 2, a, b));
}

/* The form of the quad that triangle t and the next one make. */
static enum nt_half form_of(const nt_mesh *mesh, size_t t)
{
	const size_t first = 3 * t, second = first + 3;
	if (are_equal(mesh, first, second) && are_equal(mesh, first + 2, second + 1))
		return NT_HALF_ABC;
	if (are_equal(mesh, first + 1, second) && are_equal(mesh, first + 2, second + 2))
		return NT_HALF_ABD;
	return NT_HALF_NONE;
}

/* The first vertex of a triangle, as the file has it. */
static uint32_t first_of(const nt_mesh *mesh, size_t t)
{
	const uint32_t vertex = vertex_of(mesh, 3 * t);
	return mesh->vertex_sources && vertex >= mesh->source_vertex_count
		? mesh->vertex_sources[vertex - mesh->source_vertex_count] : vertex;
}

/* Triangles from t on that FB_ngon_encoding has as one polygon. */
static size_t polygon_size(const nt_mesh *mesh, size_t t)
{
	size_t end = t + 1;
	while (end < mesh->face_count && first_of(mesh, end) == first_of(mesh, t))
		end++;
	return end - t;
}

size_t nt_pair_quads(const nt_mesh *mesh, bool polygons, uint8_t *halves)
{
	size_t quads = 0;
	memset(halves, NT_HALF_NONE, mesh->face_count);
	for (size_t t = 0, step; t < mesh->face_count; t += step) {
		step = polygons ? polygon_size(mesh, t) : 1;
		if (t + 1 == mesh->face_count || (polygons && step != 2))
			continue;
		halves[t] = (uint8_t)form_of(mesh, t);
		if (halves[t] == NT_HALF_NONE)
			continue;
		halves[t + 1] = NT_HALF_SECOND;
		quads++;
		step = 2;
	}
	return quads;
}

/* `magnitude`: the sum of the products behind the area. */
static int orientation_of(const nt_mesh *mesh, size_t t, const float *uv, double *area, double *magnitude)
{
	const float *a = uv + 2 * (size_t)vertex_of(mesh, 3 * t), *b = uv + 2 * (size_t)vertex_of(mesh, 3 * t + 1),
		    *c = uv + 2 * (size_t)vertex_of(mesh, 3 * t + 2);
	const double left = ((double)b[0] - a[0]) * ((double)c[1] - a[1]);
	const double right = ((double)b[1] - a[1]) * ((double)c[0] - a[0]);
	*area = fabs(left - right);
	*magnitude = fabs(left) + fabs(right);
	return nt_orientation(a, b, c);
}

int nt_folded_orientation(const nt_mesh *mesh, const uint8_t *halves, size_t t)
{
	if (!halves || halves[t] == NT_HALF_NONE)
		return 0;
	const size_t first = halves[t] == NT_HALF_SECOND ? t - 1 : t;
	const float *uv = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords;
	double areas[2], magnitudes[2];
	const int one = orientation_of(mesh, first, uv, &areas[0], &magnitudes[0]);
	const int other = orientation_of(mesh, first + 1, uv, &areas[1], &magnitudes[1]);
	if (one * other >= 0)
		return 0;
	/* four roundings of each, as MikkTSpace makes them; it may also cut the quad along the other diagonal */
	if (fabs(areas[0] - areas[1]) <= 0x1p-22 * (magnitudes[0] + magnitudes[1]))
		return NT_FOLDED_EITHER;
	return areas[0] > areas[1] ? one : other;
}

bool nt_is_folded_sign(const nt_mesh *mesh, const uint8_t *halves, size_t t, int sign)
{
	const int folded = nt_folded_orientation(mesh, halves, t);
	return folded && (folded == sign || folded == NT_FOLDED_EITHER);
}

/* SPDX-License-Identifier: MIT */
#include "report/maker/maker.h"

#include <math.h>
#include <string.h>
#include "topology/corners.h"

static bool are_rows_equal(const float *rows, size_t floats, uint32_t a, uint32_t b)
{
	for (size_t i = 0; rows && i < floats; i++)
		if (!(rows[floats * a + i] == rows[floats * b + i]))
			return false;
	return true;
}

static bool are_equal(const nt_mesh *mesh, size_t corner, size_t other)
{
	const uint32_t a = nt_mesh_vertex(mesh, corner), b = nt_mesh_vertex(mesh, other);
	return a == b || (are_rows_equal(mesh->positions, 3, a, b) && are_rows_equal(mesh->normals, 3, a, b) &&
		are_rows_equal(mesh->texcoords, 2, a, b));
}

/* How programs write a quad that they cut along either diagonal: as it stands (Blender, assimp); with two corners of
 * each half exchanged, since they mirror the model (the last two: glTFast; the outer ones: UnityGLTF, Godot); from its
 * last corner (glTFast, of quads; 3ds Max, and what cuts ears). */
static const uint8_t orders[][2] = {{NT_HALF_ABC_ACD, NT_HALF_ABD_BCD}, {NT_HALF_ACD_ABC, NT_HALF_ABD_DBC},
	{NT_HALF_CDA_BCA, NT_HALF_BDA_BCD}, {NT_HALF_ACD_CAB, NT_HALF_NONE}, {NT_HALF_ABC_CDA, NT_HALF_NONE}};

/* Whether triangle t and the next one make a quad of this form. */
static bool has_form(const nt_mesh *mesh, size_t t, uint8_t form)
{
	const uint8_t(*corners)[3] = nt_half_corners[form];
	for (size_t i = 0; i < 3; i++)
		for (size_t k = 0; k < 3; k++)
			if (corners[0][i] == corners[1][k] && !are_equal(mesh, 3 * t + i, 3 * t + 3 + k))
				return false;
	return form != NT_HALF_NONE;
}

/* The first vertex of a triangle, as the file has it. */
static uint32_t first_of(const nt_mesh *mesh, size_t t)
{
	const uint32_t vertex = nt_mesh_vertex(mesh, 3 * t);
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

/* Pairs the first `count` triangles. */
static size_t pair_first(const nt_mesh *mesh, size_t count, bool polygons, const uint8_t order[2], uint8_t *halves)
{
	size_t quads = 0;
	memset(halves, NT_HALF_NONE, count);
	for (size_t t = 0, step; t < count; t += step) {
		step = polygons ? polygon_size(mesh, t) : 1;
		if (t + 1 >= count || (polygons && step != 2))
			continue;
		halves[t] = has_form(mesh, t, order[0]) ? order[0] : has_form(mesh, t, order[1]) ? order[1]
			: NT_HALF_NONE;
		if (halves[t] == NT_HALF_NONE)
			continue;
		halves[t + 1] = NT_HALF_SECOND;
		quads++;
		step = 2;
	}
	return quads;
}

size_t nt_pair_quads(const nt_mesh *mesh, bool polygons, uint8_t *halves)
{
	enum { SAMPLE = 4096 }; /* a program has one order */
	const size_t sample = mesh->face_count < SAMPLE ? mesh->face_count : SAMPLE;
	size_t best = 0, most = 0;
	for (size_t i = 0; i < sizeof orders / sizeof *orders && !polygons && 20 * most < 9 * sample; i++) {
		const size_t quads = pair_first(mesh, sample, false, orders[i], halves);
		best = quads > most ? i : best;
		most = quads > most ? quads : most;
	}
	return pair_first(mesh, mesh->face_count, polygons, orders[best], halves);
}

/* Twice the area; `magnitude`: the sum of the products behind it. */
static double measure(const float *const uv[3], double *magnitude)
{
	const double left = ((double)uv[1][0] - uv[0][0]) * ((double)uv[2][1] - uv[0][1]);
	const double right = ((double)uv[1][1] - uv[0][1]) * ((double)uv[2][0] - uv[0][0]);
	*magnitude = fabs(left) + fabs(right);
	return fabs(left - right);
}

int nt_orientation_of_halves(const float *const uv[2][3])
{
	double magnitudes[2];
	const int one = nt_orientation(uv[0][0], uv[0][1], uv[0][2]);
	const int other = nt_orientation(uv[1][0], uv[1][1], uv[1][2]);
	if (one * other >= 0)
		return 0;
	const double areas[2] = {measure(uv[0], &magnitudes[0]), measure(uv[1], &magnitudes[1])};
	/* four roundings of each, as MikkTSpace makes them; it may also cut the quad along the other diagonal */
	if (fabs(areas[0] - areas[1]) <= 0x1p-22 * (magnitudes[0] + magnitudes[1]))
		return NT_FOLDED_EITHER;
	return areas[0] > areas[1] ? one : other;
}

int nt_folded_orientation(const nt_mesh *mesh, const uint8_t *halves, size_t t)
{
	if (!halves || halves[t] == NT_HALF_NONE)
		return 0;
	const size_t first = 3 * (halves[t] == NT_HALF_SECOND ? t - 1 : t);
	const float *texcoords = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords, *uv[2][3];
	for (size_t k = 0; k < 6; k++)
		uv[k / 3][k % 3] = texcoords + 2 * (size_t)nt_mesh_vertex(mesh, first + k);
	return nt_orientation_of_halves(uv);
}

bool nt_is_folded_sign(const nt_mesh *mesh, const uint8_t *halves, size_t t, int sign)
{
	const int folded = nt_folded_orientation(mesh, halves, t);
	return folded && (folded == sign || folded == NT_FOLDED_EITHER);
}

bool nt_has_sign_of_quad(const nt_mesh *mesh, const uint32_t corners[2][3])
{
	const float *uv[2][3], w = mesh->tangents[4 * nt_mesh_vertex(mesh, corners[0][0]) + 3];
	for (size_t k = 0; k < 6; k++)
		uv[k / 3][k % 3] = mesh->texcoords + 2 * nt_mesh_vertex(mesh, corners[k / 3][k % 3]);
	const int sign = nt_orientation_of_halves(uv);
	return sign == NT_FOLDED_EITHER || (sign && (sign > 0) == (w > 0.0f));
}

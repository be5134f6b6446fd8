/* SPDX-License-Identifier: MIT */
/*
 * See across.h: the lanes of nt_unit_normal() and nt_dvec3_perpendicular(), and of the part of a tangent across a
 * normal. One at a time takes 70 ns, since each step waits for the one before; in lanes it is 8.
 */
#include "tangent/across.h"

#include <math.h>
#include "tangent/usable.h"
#include "tangent/weigh.h"
#include "topology/corners.h"

enum { LANES = NT_ACROSS_LANES };

typedef double lane_vectors[3][LANES];

/* Normals in lanes, made unit vectors, or zero where they are not finite. Squares of finite floats do not overflow. */
static void make_unit(lane_vectors n)
{
	for (int i = 0; i < LANES; i++) {
		const double squared = n[0][i] * n[0][i] + n[1][i] * n[1][i] + n[2][i] * n[2][i],
			scale = nt_rsqrt(squared);
		for (int c = 0; c < 3; c++)
			n[c][i] = isfinite(squared) ? scale * n[c][i] : 0.0;
	}
}

/* nt_dvec3_normalise() of what is finite and not zero. */
static void normalise(lane_vectors t)
{
	for (int i = 0; i < LANES; i++) {
		const double largest = nt_dvec3_largest((nt_dvec3){t[0][i], t[1][i], t[2][i]});
		const nt_dvec3 scaled = {t[0][i] / largest, t[1][i] / largest, t[2][i] / largest};
		const double scale = 1.0 / sqrt(nt_dvec3_dot(scaled, scaled));
		t[0][i] = scale * scaled.x, t[1][i] = scale * scaled.y, t[2][i] = scale * scaled.z;
	}
}

/* The rows (T, w) of the lanes. */
static void store_rows(lane_vectors t, const float w[LANES], float rows[LANES][4])
{
	for (int i = 0; i < LANES; i++) {
		for (int c = 0; c < 3; c++)
			rows[i][c] = (float)t[c][i];
		rows[i][3] = w[i];
	}
}

static void load_normal(const nmtan_mesh *mesh, size_t vertex, lane_vectors n, size_t lane)
{
	const float *from = nt_normal(mesh, vertex);
	n[0][lane] = from[0], n[1][lane] = from[1], n[2][lane] = from[2];
}

void nt_perpendiculars(const nmtan_mesh *mesh, size_t first, const uint32_t *vertices, size_t count,
	float across[NT_ACROSS_LANES][4])
{
	lane_vectors n = {{0}}, t;
	float w[LANES];
	for (size_t i = 0; i < count; i++)
		load_normal(mesh, vertices ? vertices[i] : first + i, n, i);
	make_unit(n);
	for (int i = 0; i < LANES; i++) {
		const double sign = n[2][i] < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + n[2][i]);
		t[0][i] = 1.0 + sign * n[0][i] * n[0][i] * a;
		t[1][i] = sign * n[0][i] * n[1][i] * a;
		t[2][i] = -sign * n[0][i];
		w[i] = 1.0f;
	}
	normalise(t);
	store_rows(t, w, across);
}

void nt_borrow_tangents(const nmtan_mesh *mesh, const float *tangents, const nt_beside *corners, size_t count,
	float across[NT_ACROSS_LANES][4])
{
	lane_vectors n = {{0}}, t = {{0}};
	float w[LANES] = {0};
	for (size_t i = 0; i < count; i++) {
		const float *from = tangents + 4 * corners[i].from;
		load_normal(mesh, nt_vertex_of(mesh, corners[i].corner), n, i);
		t[0][i] = from[0], t[1][i] = from[1], t[2][i] = from[2], w[i] = from[3];
	}
	make_unit(n);
	for (int i = 0; i < LANES; i++) {
		const double along = n[0][i] * t[0][i] + n[1][i] * t[1][i] + n[2][i] * t[2][i];
		for (int c = 0; c < 3; c++)
			t[c][i] = t[c][i] - along * n[c][i];
		const double squared = t[0][i] * t[0][i] + t[1][i] * t[1][i] + t[2][i] * t[2][i];
		w[i] = squared > NT_PARALLEL_SINE_SQUARED ? w[i] : 0.0f;
	}
	normalise(t);
	store_rows(t, w, across);
}

/* SPDX-License-Identifier: MIT */
/*
 * The third pass: single corners for complex.c, 16 at a time. They are read from the mesh, because the welded
 * rows lay in the output, which is written by now. Here every value reaches the output, the extreme ones too:
 * all of steps 4 and 8 is done as the definition does it, and each corner has its triangle's frame made anew,
 * so that there is nothing to keep. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_CORNERS_H
#define NT_TANGENT_FAST_CORNERS_H

#include "base/vec.h"
#include "tangent/fast/lanes.h"
#include "topology/corners.h"

/* 16 single corners by component. */
typedef struct single_lanes {
	_Alignas(64) float p[3][3][NT_LANES]; /* corner of the triangle, component */
	float t[3][2][NT_LANES];
	float n[3][NT_LANES];                 /* of the corner in question */
	int k[NT_LANES];                      /* which of the three it is */
	int any[NT_LANES];
	float u[4][NT_LANES], v[4][NT_LANES]; /* as in nt_corner, each with its magnitude behind */
	float angle[NT_LANES];
	uint32_t kind[NT_LANES];
} single_lanes;

/* The lanes behind the last corner repeat it. */
static void load_singles(const nt_fast *fast, const uint32_t *corners, size_t count, single_lanes *s)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	for (size_t lane = 0; lane < NT_LANES; lane++) {
		const uint32_t corner = corners[lane < count ? lane : count - 1];
		const size_t t = corner >> 2;
		const unsigned k = corner & 3;
		for (unsigned j = 0; j < 3; j++) {
			const size_t vertex = nt_vertex_of(mesh, nt_triangle_corner(&fast->triangles, t, j));
			const float *p = nt_position(mesh, vertex), *uv = nt_texcoord(mesh, vertex);
			s->p[j][0][lane] = p[0], s->p[j][1][lane] = p[1], s->p[j][2][lane] = p[2];
			s->t[j][0][lane] = uv[0], s->t[j][1][lane] = uv[1];
		}
		const float *n = nt_normal(mesh, nt_vertex_of(mesh, nt_triangle_corner(&fast->triangles, t, k)));
		s->n[0][lane] = n[0], s->n[1][lane] = n[1], s->n[2][lane] = n[2];
		s->k[lane] = (int)k;
		s->any[lane] = (fast->flags[t] & NT_TRIANGLE_ANY) != 0;
	}
}

/* v without its part along the unit normal n, normalised where it is not zero. */
static inline __attribute__((always_inline)) void project3(const float n[3], float v[3])
{
	const float along = nt_dot3(n, v);
#pragma GCC unroll 3
	for (int c = 0; c < 3; c++)
		v[c] = v[c] - along * n[c];
	const int not_zero = (fabsf(v[0]) > FLT_MIN) | (fabsf(v[1]) > FLT_MIN) | (fabsf(v[2]) > FLT_MIN);
	const float r = 1.0f / sqrtf(nt_dot3(v, v));
#pragma GCC unroll 3
	for (int c = 0; c < 3; c++)
		v[c] = not_zero ? r * v[c] : v[c];
}

/* Directions and magnitudes: step 4, and step 8 but for the angle. */
static void solve_single_frames(single_lanes *restrict s)
{
	for (int i = 0; i < NT_LANES; i++) {
		const float t21x = s->t[1][0][i] - s->t[0][0][i], t21y = s->t[1][1][i] - s->t[0][1][i];
		const float t31x = s->t[2][0][i] - s->t[0][0][i], t31y = s->t[2][1][i] - s->t[0][1][i];
		const float area = t21x * t31y - t21y * t31x, size = fabsf(area), sign = area > 0.0f ? 1.0f : -1.0f;
		float os[3], ot[3];
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			const float d1 = s->p[1][c][i] - s->p[0][c][i], d2 = s->p[2][c][i] - s->p[0][c][i];
			os[c] = t31y * d1 - t21y * d2;
			ot[c] = -t31x * d1 + t21x * d2;
		}
		const float ls = sqrtf(nt_dot3(os, os)), lt = sqrtf(nt_dot3(ot, ot));
		const float rs = sign / ls, rt = sign / lt;
		const float n[3] = {s->n[0][i], s->n[1][i], s->n[2][i]};
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			os[c] = ls > FLT_MIN ? rs * os[c] : 0.0f;
			ot[c] = lt > FLT_MIN ? rt * ot[c] : 0.0f;
		}
		project3(n, os);
		project3(n, ot);

#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			s->u[c][i] = os[c];
			s->v[c][i] = ot[c];
		}
		s->u[3][i] = ls / size;
		s->v[3][i] = lt / size;
		const float least = 1.0f - 1e-5f, most = 1.0f + 1e-5f, uu = nt_dot3(os, os), vv = nt_dot3(ot, ot);
		const int unit = (uu > least) & (uu < most) & (vv > least) & (vv < most);
		s->kind[i] = s->any[i] ? NT_CORNER_ANY : unit ? NT_CORNER_UNIT : NT_CORNER_EXTREME;
	}
}

/* The angles between the edges, seen along the normal. In a loop of their own: see lanes.h. */
static void solve_single_angles(single_lanes *restrict s)
{
	for (int i = 0; i < NT_LANES; i++) {
		const int k = s->k[i];
		const float n[3] = {s->n[0][i], s->n[1][i], s->n[2][i]};
		float e[3], f[3];
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			const float p0 = s->p[0][c][i], p1 = s->p[1][c][i], p2 = s->p[2][c][i];
			const float at = k == 0 ? p0 : k == 1 ? p1 : p2;
			e[c] = (k == 0 ? p2 : k == 1 ? p0 : p1) - at;
			f[c] = (k == 0 ? p1 : k == 1 ? p2 : p0) - at;
		}
		project3(n, e);
		project3(n, f);
		float cosine = nt_dot3(e, f);
		cosine = cosine > 1.0f ? 1.0f : cosine;
		cosine = cosine < -1.0f ? -1.0f : cosine;
		s->angle[i] = cosine;
	}
	for (int i = 0; i < NT_LANES; i++)
		s->angle[i] = nt_acos(s->angle[i]);
}

static void corners(const nt_fast *fast, const uint32_t *list, size_t count, nt_corner *solved)
{
	single_lanes s;
	float u[4 * NT_LANES], v[4 * NT_LANES]; /* rows in turned places */
	for (size_t first = 0; first < count; first += NT_LANES, solved += NT_LANES) {
		load_singles(fast, list + first, count - first, &s);
		solve_single_frames(&s);
		solve_single_angles(&s);
		interleave(s.u, NT_LANES, u);
		interleave(s.v, NT_LANES, v);
		for (size_t i = 0; i < NT_LANES; i++) {
			memcpy(solved[i].u, u + 4 * turned_place(i), 4 * sizeof *u);
			memcpy(solved[i].v, v + 4 * turned_place(i), 4 * sizeof *v);
			solved[i].angle = s.angle[i];
			solved[i].kind = s.kind[i];
		}
	}
}

#endif

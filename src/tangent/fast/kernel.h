/* SPDX-License-Identifier: MIT */
/*
 * The passes that need lanes, as plain loops over 32 triangles or 16 vertices: accumulate.h, settle.h, and here the
 * third, single corners for complex.c. kernel_*.c include this file once for each instruction set, with NT_KERNEL
 * naming the table of its passes.
 *
 * Each corner comes with the three rows of its triangle, which complex_solve.c has loaded again because the welded ones
 * are overwritten by now. Its triangle's frame is made anew, so that there is nothing to keep. Every value reaches the
 * output, the extreme ones too: all of steps 4 and 8 is done as the definition does it.
 */
#include "base/vec.h"
#include "tangent/fast/accumulate.h"
#include "tangent/fast/complex.h"
#include "tangent/fast/lanes.h"
#include "tangent/fast/settle.h"

/* 16 single corners by component. */
typedef struct single_lanes {
	lanes_in in;
	float n[3][NT_LANES]; /* of the corner in question */
	uint32_t k[NT_LANES]; /* which of the three it is */
	uint32_t any[NT_LANES];
	float u[4][NT_LANES], v[4][NT_LANES]; /* as in nt_corner, each with its magnitude behind */
	float angle[NT_LANES];
	uint32_t kind[NT_LANES];
} single_lanes;

/* Which of three values, by the corner. */
static inline NT_ALWAYS_INLINE float choose(uint32_t k, float first, float second, float third)
{
	return k == 0 ? first : k == 1 ? second : third;
}

#define THREE(i) 3 * (i), 3 * (i) + 1, 3 * (i) + 2
static const uint32_t in_order[3 * NT_LANES] = {THREE(0), THREE(1), THREE(2), THREE(3), THREE(4), THREE(5), THREE(6),
	THREE(7), THREE(8), THREE(9), THREE(10), THREE(11), THREE(12), THREE(13), THREE(14), THREE(15)};

/* The lanes behind the last corner repeat it. */
static void load_singles(const nt_weld_row *rows, const uint32_t *corners, size_t count, single_lanes *NT_RESTRICT s)
{
	gather_lanes(rows, in_order, count < NT_LANES ? count : NT_LANES, NT_LANES, s->in.row[0][0], NT_TRIANGLES);
	for (size_t lane = 0; lane < NT_LANES; lane++) {
		const uint32_t corner = corners[lane < count ? lane : count - 1];
		s->k[lane] = corner & 3;
		s->any[lane] = corner & NT_COMPLEX_ANY;
	}
	/* without going by single floats: 325 cycles for 16 corners, not 350 */
	for (int i = 0; i < NT_LANES; i++)
		NT_UNROLL(3)
		for (int c = 0; c < 3; c++)
			s->n[c][i] =
				choose(s->k[i], s->in.row[0][3 + c][i], s->in.row[1][3 + c][i], s->in.row[2][3 + c][i]);
}

/* v without its part along the unit normal n, normalised where it is not zero. */
static inline NT_ALWAYS_INLINE void project3(const float n[3], float v[3])
{
	const float along = nt_dot3(n, v);
	NT_UNROLL(3)
	for (int c = 0; c < 3; c++)
		v[c] = v[c] - along * n[c];
	const int not_zero = (fabsf(v[0]) > FLT_MIN) | (fabsf(v[1]) > FLT_MIN) | (fabsf(v[2]) > FLT_MIN);
	const float r = 1.0f / sqrtf(nt_dot3(v, v));
	NT_UNROLL(3)
	for (int c = 0; c < 3; c++)
		v[c] = not_zero ? r * v[c] : v[c];
}

/* Directions and magnitudes: step 4, and step 8 but for the angle. */
static void solve_single_frames(single_lanes *NT_RESTRICT s)
{
	for (int i = 0; i < NT_LANES; i++) {
		const float t21x = s->in.row[1][6][i] - s->in.row[0][6][i],
			t21y = s->in.row[1][7][i] - s->in.row[0][7][i];
		const float t31x = s->in.row[2][6][i] - s->in.row[0][6][i],
			t31y = s->in.row[2][7][i] - s->in.row[0][7][i];
		const float area = t21x * t31y - t21y * t31x, size = fabsf(area), sign = area > 0.0f ? 1.0f : -1.0f;
		float os[3], ot[3];
		NT_UNROLL(3)
		for (int c = 0; c < 3; c++) {
			const float d1 = s->in.row[1][c][i] - s->in.row[0][c][i],
				d2 = s->in.row[2][c][i] - s->in.row[0][c][i];
			os[c] = t31y * d1 - t21y * d2;
			ot[c] = -t31x * d1 + t21x * d2;
		}
		const float ls = sqrtf(nt_dot3(os, os)), lt = sqrtf(nt_dot3(ot, ot));
		const float rs = sign / ls, rt = sign / lt;
		const float n[3] = {s->n[0][i], s->n[1][i], s->n[2][i]};
		NT_UNROLL(3)
		for (int c = 0; c < 3; c++) {
			os[c] = ls > FLT_MIN ? rs * os[c] : 0.0f;
			ot[c] = lt > FLT_MIN ? rt * ot[c] : 0.0f;
		}
		project3(n, os);
		project3(n, ot);

		NT_UNROLL(3)
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
static void solve_single_angles(single_lanes *NT_RESTRICT s)
{
	for (int i = 0; i < NT_LANES; i++) {
		const uint32_t k = s->k[i];
		const float n[3] = {s->n[0][i], s->n[1][i], s->n[2][i]};
		float e[3], f[3];
		NT_UNROLL(3)
		for (int c = 0; c < 3; c++) {
			const float p0 = s->in.row[0][c][i], p1 = s->in.row[1][c][i], p2 = s->in.row[2][c][i];
			const float at = choose(k, p0, p1, p2);
			e[c] = choose(k, p2, p0, p1) - at;
			f[c] = choose(k, p1, p2, p0) - at;
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

static void kernel_corners(const nt_weld_row *rows, const uint32_t *list, size_t count, nt_corner *solved)
{
	single_lanes s;
	float u[4 * NT_LANES], v[4 * NT_LANES]; /* rows in turned places */
	for (size_t first = 0; first < count; first += NT_LANES, solved += NT_LANES) {
		load_singles(rows + 3 * first, list + first, count - first, &s);
		solve_single_frames(&s);
		solve_single_angles(&s);
		interleave(s.u[0], NT_LANES, NT_LANES, u);
		interleave(s.v[0], NT_LANES, NT_LANES, v);
		for (size_t i = 0; i < NT_LANES; i++) {
			memcpy(solved[i].u, u + 4 * turned_place(i), 4 * sizeof *u);
			memcpy(solved[i].v, v + 4 * turned_place(i), 4 * sizeof *v);
			solved[i].angle = s.angle[i];
			solved[i].kind = s.kind[i];
		}
	}
}

const nt_kernels NT_KERNEL = {kernel_accumulate, kernel_settle, kernel_corners};

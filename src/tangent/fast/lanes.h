/* SPDX-License-Identifier: MIT */
/*
 * 16 triangles at a time, as plain loops of which the compiler makes vectors: frame (spec page, step 4) and the
 * three corners' weighted u directions (step 8). The arithmetic is that of the scalar definition,
 * operation by operation, wherever a value reaches the output. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_LANES_H
#define NT_TANGENT_FAST_LANES_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "tangent/acos.h"
#include "tangent/fast/parts.h"
#include "tangent/usable.h"
#include "tangent/fast/lane_sets.h"

/* Two unit vectors whose components along one axis are both above H, or both below -H, have a dot product
 * of at least 2 H^2 - 1 = -0.9998, well away from the -1 at which step 7 parts them: rounding moves it by 1e-6.
 * The smaller H is, the fewer vertices fail the test. */
#define HALF_SPACE 0.01f

/* Lengths in here are normalised without loss: their squares neither overflow nor lose bits. Across a normal of unit
 * length a unit vector becomes shorter. So v need not be divided by its length before the test above; across long
 * normals, where it is below 4, H is a quarter and the product still above 1.25e-5 - 1. */
#define LEAST_SQUARE 1e-30f
#define MOST_SQUARE 16.0f

/* Half a unit in the last place of 1: the relative error of a rounded float operation. */
#define HALF_ULP 0x1p-24f

/* Ratios that a float quotient can hold with room to spare. */
#define LEAST_RATIO 1e-30f
#define MOST_RATIO 1e30f

/* 16 triangles by component. */
typedef struct lanes_in {
	_Alignas(64) float row[3][8][NT_LANES]; /* corner, float of its nt_weld_row */
} lanes_in;

typedef struct lanes_out {
	_Alignas(64) float edge[3][3][NT_LANES];     /* of edge k, from corner k to the next */
	nt_frames frames;
	float mag_u[NT_LANES], mag_v[NT_LANES];
	float sum[3][4][NT_LANES];      /* corner, float of its nt_record */
	float extra[3][8][NT_LANES];    /* corner, float of its nt_record_more */
	float cosine[3][NT_LANES];      /* of a corner's angle */
	float add[3][4 * NT_LANES];     /* corner, one nt_record after the other, in turned places */
	float more[3][2][4 * NT_LANES]; /* the same, halves of nt_record_more */
	float area[NT_LANES];
	int orient[NT_LANES];     /* area > 0 */
	int frameless[NT_LANES];  /* no UV area at all: certainly "any" */
	int certain[NT_LANES];    /* the area's sign is exact, and stays when v is stored */
	int sound[NT_LANES];      /* every length and ratio is well inside float's range: certainly not "any" */
	int degenerate[NT_LANES];
} lanes_out;

/* A state with that bit where `there`: one masked operation, or two without masks. */
static inline __attribute__((always_inline)) uint32_t set_where(uint32_t state, bool there, uint32_t bit)
{
#if WIDTH == 16
	return there ? state | bit : state;
#else
	return state | (there ? bit : 0);
#endif
}

/* A state with the bits of NT_STATE_U, times `first`, of a vector: each component may be beyond h or -h. */
static inline __attribute__((always_inline)) uint32_t half_spaces(uint32_t state, float x, float y, float z, float h,
	uint32_t first)
{
	state = set_where(state, x > h, first);
	state = set_where(state, x < -h, first << 1);
	state = set_where(state, y > h, first << 2);
	state = set_where(state, y < -h, first << 3);
	state = set_where(state, z > h, first << 4);
	return set_where(state, z < -h, first << 5);
}

/* The frames of lanes [0, count), and what is known of the triangles. */
static inline __attribute__((always_inline)) void solve_frames(const lanes_in *restrict in,
	lanes_out *restrict out, float offset, bool more, int count)
{
	const float slack = offset != 0.0f ? 3 * HALF_ULP : 0.0f;
	for (int i = 0; i < count; i++) {
		float p[3][3], t[3][2];
#pragma GCC unroll 3
		for (int k = 0; k < 3; k++) {
			p[k][0] = in->row[k][0][i], p[k][1] = in->row[k][1][i], p[k][2] = in->row[k][2][i];
			t[k][0] = in->row[k][6][i], t[k][1] = in->row[k][7][i];
		}
		float d1[3], d2[3];
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			d1[c] = p[1][c] - p[0][c], d2[c] = p[2][c] - p[0][c];
			out->edge[0][c][i] = d1[c];
			out->edge[1][c][i] = p[2][c] - p[1][c];
			out->edge[2][c][i] = p[0][c] - p[2][c];
		}
		const int same01 = (p[0][0] == p[1][0]) & (p[0][1] == p[1][1]) & (p[0][2] == p[1][2]);
		const int same12 = (p[1][0] == p[2][0]) & (p[1][1] == p[2][1]) & (p[1][2] == p[2][2]);
		const int same20 = (p[2][0] == p[0][0]) & (p[2][1] == p[0][1]) & (p[2][2] == p[0][2]);

		const float t21x = t[1][0] - t[0][0], t21y = t[1][1] - t[0][1];
		const float t31x = t[2][0] - t[0][0], t31y = t[2][1] - t[0][1];
		const float area = t21x * t31y - t21y * t31x;
		float os[3], ot[3];
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			os[c] = t31y * d1[c] - t21y * d2[c];
			ot[c] = -t31x * d1[c] + t21x * d2[c];
		}
		const float ls = sqrtf(os[0] * os[0] + os[1] * os[1] + os[2] * os[2]);
		const float lt = sqrtf(ot[0] * ot[0] + ot[1] * ot[1] + ot[2] * ot[2]);
		const float size = fabsf(area), sign = area > 0.0f ? 1.0f : -1.0f;
		const float rs = sign / ls, rt = sign / lt;
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++)
			out->frames.u[c][i] = rs * os[c], out->frames.v[c][i] = rt * ot[c];
		if (more)
			out->mag_u[i] = ls / size, out->mag_v[i] = lt / size;
		/* 3 u (|p| + |r|) bounds the rounding of the area, u = 2^-24, and the difference is rounded once
		 * more; storing moves each v by u |v + offset| at most, an edge by twice that */
		const float bound = 8 * HALF_ULP * (fabsf(t21x * t31y) + fabsf(t21y * t31x)) +
				    slack * (fabsf(t[0][1]) + fabsf(t[1][1]) + fabsf(t[2][1]) + fabsf(offset)) *
					    (fabsf(t21x) + fabsf(t31x));
		out->certain[i] = size > bound;
		out->area[i] = area;
		out->orient[i] = area > 0.0f;
		out->degenerate[i] = same01 | same12 | same20;
		out->frameless[i] = !(size > FLT_MIN);
		out->sound[i] = (size > FLT_MIN) & (ls > FLT_MIN) & (lt > FLT_MIN) &
				(ls > LEAST_RATIO * size) & (lt > LEAST_RATIO * size) &
				(ls < MOST_RATIO * size) & (lt < MOST_RATIO * size);
	}
}

static inline __attribute__((always_inline)) int is_zero(float x, float y, float z)
{
	return (x == 0.0f) & (y == 0.0f) & (z == 0.0f);
}

/* Corners in lanes, by component. */
typedef struct corner_lanes {
	const float (*n)[NT_LANES];                     /* normal */
	const float (*u)[NT_LANES], (*v)[NT_LANES];     /* directions of the triangle's frame */
	const float (*from)[NT_LANES], (*to)[NT_LANES]; /* edges: from the corner before, to the next one */
	float (*sum)[NT_LANES], *cosine, (*extra)[NT_LANES]; /* as in lanes_out */
} corner_lanes;

/* Each corner's unit directions, the cosine of its angle, and the bits of what holds for it; `along`: directions and
 * edges along the normal, of which nothing is left but zero, are sound as well. */
static inline __attribute__((always_inline)) void solve_corners(corner_lanes a, bool along, bool more, int count)
{
	for (int i = 0; i < count; i++) {
		const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
		const float os[3] = {a.u[0][i], a.u[1][i], a.u[2][i]};
		const float ot[3] = {a.v[0][i], a.v[1][i], a.v[2][i]};
		/* u and v: the directions without their part along n */
		const float nu = n[0] * os[0] + n[1] * os[1] + n[2] * os[2];
		const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
		float ux = os[0] - nu * n[0], uy = os[1] - nu * n[1], uz = os[2] - nu * n[2];
		const float vx = ot[0] - nv * n[0], vy = ot[1] - nv * n[1], vz = ot[2] - nv * n[2];
		const int no_u = along && is_zero(ux, uy, uz), no_v = along && is_zero(vx, vy, vz);
		const float uu = no_u ? 1.0f : ux * ux + uy * uy + uz * uz, vv = no_v ? 1.0f : vx * vx + vy * vy + vz * vz;
		const float ur = 1.0f / sqrtf(uu);
		ux = ur * ux, uy = ur * uy, uz = ur * uz;

		/* the angle between the edges, seen along n; e runs towards the corner, which its length mends */
		const float e[3] = {a.from[0][i], a.from[1][i], a.from[2][i]};
		const float f[3] = {a.to[0][i], a.to[1][i], a.to[2][i]};
		const float ne = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
		const float nf = n[0] * f[0] + n[1] * f[1] + n[2] * f[2];
		float ex = e[0] - ne * n[0], ey = e[1] - ne * n[1], ez = e[2] - ne * n[2];
		float fx = f[0] - nf * n[0], fy = f[1] - nf * n[1], fz = f[2] - nf * n[2];
		const float er = along && is_zero(ex, ey, ez) ? 1.0f : -1.0f / sqrtf(ex * ex + ey * ey + ez * ez);
		const float fr = along && is_zero(fx, fy, fz) ? 1.0f : 1.0f / sqrtf(fx * fx + fy * fy + fz * fz);
		ex = er * ex, ey = er * ey, ez = er * ez;
		fx = fr * fx, fy = fr * fy, fz = fr * fz;
		const float dot = ex * fx + ey * fy + ez * fz;
		const float c = dot > 1.0f ? 1.0f : dot;

		/* with these squares the definition normalises as well; NaN in either of them is kept; the
		 * product of an edge without length is NaN. v is as long as it is: see MOST_SQUARE */
		const float least = uu < vv ? uu : vv, most = vv > uu ? vv : uu;
		const int sound = (least > LEAST_SQUARE) & (most < MOST_SQUARE) & (fabsf(dot) < 2.0f);
		uint32_t state = NT_STATE_BASE | NT_STATE_NO_ANY | NT_STATE_LOCAL;
		state = half_spaces(state, ux, uy, uz, HALF_SPACE, 1);
		state = half_spaces(state, vx, vy, vz, HALF_SPACE, NT_STATE_V / NT_STATE_U);
		if (along) {
			state = set_where(state, no_u, NT_STATE_U);
			state = set_where(state, no_v, NT_STATE_V);
		}
		state = set_where(state, sound, NT_STATE_SOUND);

		a.sum[0][i] = ux;
		a.sum[1][i] = uy;
		a.sum[2][i] = uz;
		memcpy(&a.sum[3][i], &state, sizeof state);
		a.cosine[i] = c < -1.0f ? -1.0f : c;
		if (more) {
			const float vr = 1.0f / sqrtf(vv);
			a.extra[0][i] = vr * vx;
			a.extra[1][i] = vr * vy;
			a.extra[2][i] = vr * vz;
		}
	}
}

/* Directions are weighted by the angle. */
static inline __attribute__((always_inline)) void weigh_corners(corner_lanes a, const float *mag_u, const float *mag_v,
	bool more, int count)
{
	for (int i = 0; i < count; i++) {
		const float w = nt_acos(a.cosine[i]);
		a.sum[0][i] *= w;
		a.sum[1][i] *= w;
		a.sum[2][i] *= w;
		if (more) {
			a.extra[0][i] *= w;
			a.extra[1][i] *= w;
			a.extra[2][i] *= w;
			a.extra[3][i] = w;
			a.extra[4][i] = w * mag_u[i];
			a.extra[5][i] = w * mag_v[i];
			a.extra[6][i] = 0.0f;
			a.extra[7][i] = 0.0f;
		}
	}
}

/* Corner k of 16 triangles. */
static inline __attribute__((always_inline)) corner_lanes corner_of(const lanes_in *in, lanes_out *out, int k)
{
	return (corner_lanes){.n = in->row[k] + 3, .u = out->frames.u, .v = out->frames.v, .from = out->edge[(k + 2) % 3],
		.to = out->edge[k], .sum = out->sum[k], .cosine = out->cosine[k], .extra = out->extra[k]};
}

static inline __attribute__((always_inline)) void solve_three(const lanes_in *restrict in, lanes_out *restrict out,
	bool along, bool more, int count)
{
#pragma GCC unroll 3
	for (int k = 0; k < 3; k++)
		solve_corners(corner_of(in, out, k), along, more, count);
#pragma GCC unroll 3
	for (int k = 0; k < 3; k++)
		weigh_corners(corner_of(in, out, k), out->mag_u, out->mag_v, more, count);
}

/* Lanes [0, count). One loop for each idea: in a single one there are more values under way than
 * registers, and square roots wait for each other. */
static inline __attribute__((always_inline)) void solve_lanes(const lanes_in *restrict in,
	lanes_out *restrict out, float offset, bool more, int count)
{
	solve_frames(in, out, offset, more, count);
	solve_three(in, out, false, more, count);
}

/* Whether a corner of a sound triangle is not: directions or edges may lie along normals. */
static inline __attribute__((always_inline)) bool has_extremes(const lanes_out *out, size_t count)
{
	lanes extreme = {0};
	for (size_t i = 0; i < count; i += WIDTH) {
		const lanes states = load_lanes(out->sum[0][3] + i) & load_lanes(out->sum[1][3] + i) & load_lanes(out->sum[2][3] + i);
		extreme |= load_lanes(out->sound + i) & ~load_lanes(out->degenerate + i) & ~(states / NT_STATE_SOUND);
	}
	return any_lane(extreme);
}

/* Corners once more, which is rare. */
static void __attribute__((noinline)) solve_along(const lanes_in *in, lanes_out *out, size_t lane_count)
{
	solve_three(in, out, true, false, (int)lane_count);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k], lane_count, out->add[k]);
}

static void __attribute__((noinline)) solve_lanes_plain(const lanes_in *restrict in, lanes_out *restrict out, float offset,
	size_t count)
{
	const size_t lane_count = whole_lanes(count);
	solve_lanes(in, out, offset, false, (int)lane_count);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k], lane_count, out->add[k]);
	if (NT_SHORT_WAYS && has_extremes(out, lane_count))
		solve_along(in, out, lane_count);
}

#if WIDTH > 4
/* Four lanes from each of four places. */
static inline __attribute__((always_inline)) void spread(const float *a, const float *b, const float *c, const float *d,
	float to[NT_LANES])
{
	const float *const from[NT_LANES / 4] = {a, b, c, d};
	for (size_t i = 0; i < NT_LANES / 4; i += WIDTH / 4) {
		const lanes parts = load_parts(from + i);
		memcpy(to + 4 * i, &parts, sizeof parts);
	}
}

/* Four triangles: lane 4 k + i has corner k of triangle i, and all four parts have the frames. The last part repeats
 * the first one. */
static void __attribute__((noinline)) solve_four(const lanes_in *restrict in, lanes_out *restrict out, float offset)
{
	lanes_in frames;
	_Alignas(64) float n[3][NT_LANES], from[3][NT_LANES], to[3][NT_LANES], add[4 * NT_LANES];
#pragma GCC unroll 8
	for (int c = 0; c < 8; c++)
#pragma GCC unroll 3
		for (int k = 0; k < 3; k++)
			spread(in->row[k][c], in->row[k][c], in->row[k][c], in->row[k][c], frames.row[k][c]);
	solve_frames(&frames, out, offset, false, NT_LANES);
#pragma GCC unroll 3
	for (int c = 0; c < 3; c++) {
		const float *const e[3] = {out->edge[0][c], out->edge[1][c], out->edge[2][c]};
		spread(in->row[0][3 + c], in->row[1][3 + c], in->row[2][3 + c], in->row[0][3 + c], n[c]);
		spread(e[2], e[0], e[1], e[2], from[c]);
		spread(e[0], e[1], e[2], e[0], to[c]);
	}
	const corner_lanes corners = {.n = n, .u = out->frames.u, .v = out->frames.v, .from = from, .to = to, .sum = out->sum[0],
		.cosine = out->cosine[0]};
	solve_corners(corners, false, false, NT_LANES);
	weigh_corners(corners, NULL, NULL, false, NT_LANES);
	interleave(out->sum[0], NT_LANES, add);
	for (size_t k = 0; k < 3; k++)
		for (size_t i = 0; i < 4; i++)
			memcpy(out->add[k] + 4 * turned_place(i), add + 4 * turned_place(4 * k + i), 4 * sizeof *add);
}
#endif

/* As many lanes as `count` triangles take: see lanes_of(). */
static inline void solve_few(const lanes_in *in, lanes_out *out, float offset, size_t count)
{
#if WIDTH > 4
	if (count <= 4) {
		solve_four(in, out, offset);
		return;
	}
#endif
	solve_lanes_plain(in, out, offset, count);
}

static void __attribute__((noinline)) solve_lanes_more(const lanes_in *in, lanes_out *out, float offset)
{
	solve_lanes(in, out, offset, true, NT_LANES);
	for (int k = 0; k < 3; k++) {
		interleave(out->sum[k], NT_LANES, out->add[k]);
		interleave(out->extra[k], NT_LANES, out->more[k][0]);
		interleave(out->extra[k] + 4, NT_LANES, out->more[k][1]);
	}
}

/* Whether a triangle whose values are out of the ordinary has a frame: the definition's own test. */
static bool has_frame(const lanes_in *in, int i, float area)
{
	const float t21x = in->row[1][6][i] - in->row[0][6][i], t21y = in->row[1][7][i] - in->row[0][7][i];
	const float t31x = in->row[2][6][i] - in->row[0][6][i], t31y = in->row[2][7][i] - in->row[0][7][i];
	float s[3], t[3];
	for (int c = 0; c < 3; c++) {
		const float d1 = in->row[1][c][i] - in->row[0][c][i], d2 = in->row[2][c][i] - in->row[0][c][i];
		s[c] = t31y * d1 - t21y * d2;
		t[c] = -t31x * d1 + t21x * d2;
	}
	const float ls = sqrtf(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
	const float lt = sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
	return fabsf(ls / fabsf(area)) > FLT_MIN && fabsf(lt / fabsf(area)) > FLT_MIN;
}

/* Both halves of a quad take the orientation of one of them: step 4. */
static void orient_quads(uint8_t *flags, size_t count, const float *area)
{
	for (size_t i = 0; i + 1 < count; i++) {
		uint8_t *a = &flags[i], *b = &flags[i + 1];
		if (!(*b & NT_TRIANGLE_SECOND) || ((*a | *b) & NT_TRIANGLE_DEGENERATE) ||
			!((*a ^ *b) & NT_TRIANGLE_ORIENT))
			continue;
		*a |= NT_TRIANGLE_UNCERTAIN, *b |= NT_TRIANGLE_UNCERTAIN; /* folded */
		if ((*b & NT_TRIANGLE_ANY) || fabsf(area[i]) >= fabsf(area[i + 1]))
			*b ^= NT_TRIANGLE_ORIENT;
		else
			*a ^= NT_TRIANGLE_ORIENT;
	}
}

/* Triangles whose UV area is exactly 0 whatever is rounded, as stored too, for two texture coordinates are the same or
 * all lie along an axis. Where there is another reason they stay uncertain. */
static void __attribute__((noinline)) clear_flat(const lanes_in *in, uint8_t *flags, size_t count)
{
	const float (*a)[NT_LANES] = in->row[0] + 6, (*b)[NT_LANES] = in->row[1] + 6, (*c)[NT_LANES] = in->row[2] + 6;
	for (size_t i = 0; i < count; i++) {
		const int ab_u = a[0][i] == b[0][i], ac_u = a[0][i] == c[0][i], bc_u = b[0][i] == c[0][i];
		const int ab_v = a[1][i] == b[1][i], ac_v = a[1][i] == c[1][i], bc_v = b[1][i] == c[1][i];
		const int flat = (ab_u & ab_v) | (ac_u & ac_v) | (bc_u & bc_v) | (ab_u & ac_u) | (ab_v & ac_v);
		flags[i] &= (uint8_t)~(flat ? NT_TRIANGLE_UNCERTAIN : 0);
	}
}

/* Flags of the lanes; true where all of them are ordinary triangles with a frame. */
static bool __attribute__((noinline)) classify_lanes(const nt_fast *fast, size_t first, size_t count, const lanes_in *in,
	const lanes_out *out)
{
	uint8_t *flags = fast->flags + first;
	int odd = 0, special = 0;
	for (size_t i = 0; i < count; i++) {
		odd |= !(out->sound[i] | out->frameless[i]);
		special |= out->degenerate[i] | !out->sound[i];
	}
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) | (out->orient[i] ? NT_TRIANGLE_ORIENT : 0) |
				     (out->frameless[i] ? NT_TRIANGLE_ANY : 0) |
				     (out->degenerate[i] ? NT_TRIANGLE_DEGENERATE : 0) |
				     ((out->certain[i] & !out->frameless[i]) ? 0 : NT_TRIANGLE_UNCERTAIN));
	for (size_t i = 0; odd && i < count; i++)
		if (!out->sound[i] && !out->frameless[i] && !has_frame(in, (int)i, out->area[i]))
			flags[i] |= NT_TRIANGLE_ANY | NT_TRIANGLE_UNCERTAIN;
	if (NT_SHORT_WAYS && special)
		clear_flat(in, flags, count);
	if (fast->triangles.cuts)
		orient_quads(flags, count, out->area);
	return !special;
}

#endif

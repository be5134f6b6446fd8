/* SPDX-License-Identifier: MIT */
/*
 * 16 triangles at a time, as plain loops of which the compiler makes vectors: frame (spec page, step 4) and the
 * three corners' weighted u directions (step 8). The arithmetic is that of the scalar definition,
 * operation by operation, wherever a value reaches the output. Included by kernel.h.
 */
#ifndef NT_TANGENT_KERNEL_LANES_H
#define NT_TANGENT_KERNEL_LANES_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "tangent/acos.h"
#include "tangent/fast.h"
#include "tangent/judge.h"

/* Two unit vectors whose components along one axis are both above H, or both below -H, have a dot product
 * of at least 2 H^2 - 1 = -0.98, far from the -1 at which step 7 parts them. Any H well above rounding
 * will do; the smaller it is, the fewer vertices fail the test. */
#define HALF_SPACE 0.1f

/* Lengths in here are normalised without loss: their squares neither overflow nor lose bits. */
#define LEAST_LENGTH 1e-15f
#define MOST_LENGTH 1e15f

/* Half a unit in the last place of 1: the relative error of a rounded float operation. */
#define HALF_ULP 0x1p-24f

/* Ratios that a float quotient can hold with room to spare. */
#define LEAST_RATIO 1e-30f
#define MOST_RATIO 1e30f

/* A bit of nt_record.state as the float that sets it: NT_STATE_BASE is 2.0f, whose last place is 2^-22. */
#define STATE_BIT(bit) ((float)(bit) * 0x1p-22f)

/* 16 triangles by component. */
typedef struct lanes_in {
	float row[3][8][NT_LANES]; /* corner, float of its nt_weld_row */
} lanes_in;

typedef struct lanes_out {
	float sum[3][4][NT_LANES];   /* corner, float of its nt_record */
	float extra[3][8][NT_LANES]; /* corner, float of its nt_record_more */
	float add[3][4 * NT_LANES];  /* the same, one nt_record after the other */
	float more[3][8 * NT_LANES];
	float area[NT_LANES];
	int orient[NT_LANES];     /* area > 0 */
	int frameless[NT_LANES];  /* no UV area at all: certainly "any" */
	int certain[NT_LANES];    /* the area's sign is exact, and stays when v is stored */
	int sound[NT_LANES];      /* every length and ratio is well inside float's range: certainly not "any" */
	int degenerate[NT_LANES];
} lanes_out;

typedef struct corner_sum {
	float x, y, z, state;
	float bx, by, bz, angle;
} corner_sum;

/* The weighted directions of one corner with normal n, edges e (to the previous) and f (to the next vertex).
 * `state` gets the bits of what holds for it. */
static inline __attribute__((always_inline)) corner_sum solve_corner(const float n[3], const float os[3],
	const float ot[3], const float e[3], const float f[3], bool more)
{
	/* u and v: the directions without their part along n */
	const float ns = n[0] * os[0] + n[1] * os[1] + n[2] * os[2];
	const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
	float ux = os[0] - ns * n[0], uy = os[1] - ns * n[1], uz = os[2] - ns * n[2];
	float vx = ot[0] - nv * n[0], vy = ot[1] - nv * n[1], vz = ot[2] - nv * n[2];
	const float ul = sqrtf(ux * ux + uy * uy + uz * uz);
	const float ur = 1.0f / ul;
	ux = ur * ux, uy = ur * uy, uz = ur * uz;
	const float vv = vx * vx + vy * vy + vz * vz;

	/* the angle between the edges, seen along n */
	const float ne = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
	const float nf = n[0] * f[0] + n[1] * f[1] + n[2] * f[2];
	float ex = e[0] - ne * n[0], ey = e[1] - ne * n[1], ez = e[2] - ne * n[2];
	float fx = f[0] - nf * n[0], fy = f[1] - nf * n[1], fz = f[2] - nf * n[2];
	const float el = sqrtf(ex * ex + ey * ey + ez * ez);
	const float fl = sqrtf(fx * fx + fy * fy + fz * fz);
	const float er = 1.0f / el, fr = 1.0f / fl;
	ex = er * ex, ey = er * ey, ez = er * ez;
	fx = fr * fx, fy = fr * fy, fz = fr * fz;
	float c = ex * fx + ey * fy + ez * fz;
	c = c > 1.0f ? 1.0f : c;
	c = c < -1.0f ? -1.0f : c;
	const float w = nt_acos(c);

	/* a length above 0 means that the definition normalises as well */
	const int sound = (ul > LEAST_LENGTH) & (ul < MOST_LENGTH) &
			  (vv > LEAST_LENGTH * LEAST_LENGTH) & (vv < MOST_LENGTH * MOST_LENGTH) & (el > 0.0f) & (fl > 0.0f) & (w >= 0.0f);
	const float hh = HALF_SPACE * HALF_SPACE * vv;
	float state = ux > HALF_SPACE ? STATE_BIT(1) : ux < -HALF_SPACE ? STATE_BIT(2) : 0.0f;
	state += uy > HALF_SPACE ? STATE_BIT(4) : uy < -HALF_SPACE ? STATE_BIT(8) : 0.0f;
	state += uz > HALF_SPACE ? STATE_BIT(16) : uz < -HALF_SPACE ? STATE_BIT(32) : 0.0f;
	/* x |x| > hh is x > h where hh is the square of h */
	const float sx = vx * fabsf(vx), sy = vy * fabsf(vy), sz = vz * fabsf(vz);
	state += sx > hh ? STATE_BIT(1 << 6) : sx < -hh ? STATE_BIT(2 << 6) : 0.0f;
	state += sy > hh ? STATE_BIT(4 << 6) : sy < -hh ? STATE_BIT(8 << 6) : 0.0f;
	state += sz > hh ? STATE_BIT(16 << 6) : sz < -hh ? STATE_BIT(32 << 6) : 0.0f;
	state += sound ? STATE_BIT(NT_STATE_SOUND) : 0.0f;
	state += 2.0f + STATE_BIT(NT_STATE_NO_ANY + NT_STATE_LOCAL);

	corner_sum sum = {w * ux, w * uy, w * uz, state, 0, 0, 0, w};
	if (more) {
		const float vr = 1.0f / sqrtf(vv);
		sum.bx = w * (vr * vx), sum.by = w * (vr * vy), sum.bz = w * (vr * vz);
	}
	return sum;
}

/* Lanes [begin, begin + count). */
static inline __attribute__((always_inline)) void solve_lanes(const lanes_in *restrict in,
	lanes_out *restrict out, float offset, float slack, bool more, int begin, int count)
{
	for (int i = begin; i < begin + count; i++) {
		float p[3][3], n[3][3], t[3][2];
#pragma GCC unroll 3
		for (int k = 0; k < 3; k++) {
			p[k][0] = in->row[k][0][i], p[k][1] = in->row[k][1][i], p[k][2] = in->row[k][2][i];
			n[k][0] = in->row[k][3][i], n[k][1] = in->row[k][4][i], n[k][2] = in->row[k][5][i];
			t[k][0] = in->row[k][6][i], t[k][1] = in->row[k][7][i];
		}
		/* edge k from corner k to k + 1, and back */
		float e[3][3], r[3][3];
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			e[0][c] = p[1][c] - p[0][c], e[1][c] = p[2][c] - p[1][c], e[2][c] = p[0][c] - p[2][c];
			r[0][c] = p[0][c] - p[1][c], r[1][c] = p[1][c] - p[2][c], r[2][c] = p[2][c] - p[0][c];
		}
		const int same01 = (p[0][0] == p[1][0]) & (p[0][1] == p[1][1]) & (p[0][2] == p[1][2]);
		const int same12 = (p[1][0] == p[2][0]) & (p[1][1] == p[2][1]) & (p[1][2] == p[2][2]);
		const int same20 = (p[2][0] == p[0][0]) & (p[2][1] == p[0][1]) & (p[2][2] == p[0][2]);

		/* the frame: d1 is edge 0, d2 edge 2 backwards */
		const float t21x = t[1][0] - t[0][0], t21y = t[1][1] - t[0][1];
		const float t31x = t[2][0] - t[0][0], t31y = t[2][1] - t[0][1];
		const float area = t21x * t31y - t21y * t31x;
		float os[3], ot[3];
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++) {
			os[c] = t31y * e[0][c] - t21y * r[2][c];
			ot[c] = -t31x * e[0][c] + t21x * r[2][c];
		}
		const float ls = sqrtf(os[0] * os[0] + os[1] * os[1] + os[2] * os[2]);
		const float lt = sqrtf(ot[0] * ot[0] + ot[1] * ot[1] + ot[2] * ot[2]);
		const float size = fabsf(area), sign = area > 0.0f ? 1.0f : -1.0f;
		const float rs = sign / ls, rt = sign / lt;
#pragma GCC unroll 3
		for (int c = 0; c < 3; c++)
			os[c] = rs * os[c], ot[c] = rt * ot[c];
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

#pragma GCC unroll 3
		for (int k = 0; k < 3; k++) {
			const corner_sum sum = solve_corner(n[k], os, ot, r[(k + 2) % 3], e[k], more);
			out->sum[k][0][i] = sum.x;
			out->sum[k][1][i] = sum.y;
			out->sum[k][2][i] = sum.z;
			out->sum[k][3][i] = sum.state;
			if (more) {
				out->extra[k][0][i] = sum.bx;
				out->extra[k][1][i] = sum.by;
				out->extra[k][2][i] = sum.bz;
				out->extra[k][3][i] = sum.angle;
				out->extra[k][4][i] = sum.angle * (ls / size);
				out->extra[k][5][i] = sum.angle * (lt / size);
				out->extra[k][6][i] = 0.0f;
				out->extra[k][7][i] = 0.0f;
			}
		}
	}
}

/* Four rows of four floats, turned. */
static inline __attribute__((always_inline)) void turn(nt_float4 rows[4])
{
	const nt_float4 ab01 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);
	const nt_float4 ab23 = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7);
	const nt_float4 cd01 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
	const nt_float4 cd23 = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
	rows[0] = __builtin_shufflevector(ab01, cd01, 0, 1, 4, 5);
	rows[1] = __builtin_shufflevector(ab01, cd01, 2, 3, 6, 7);
	rows[2] = __builtin_shufflevector(ab23, cd23, 0, 1, 4, 5);
	rows[3] = __builtin_shufflevector(ab23, cd23, 2, 3, 6, 7);
}

/* Four components of 16 lanes into rows `stride` floats apart. By hand, because what the compiler makes of
 * the plain loop takes a fifth of the whole pass (gcc 12, AVX-512). */
static inline __attribute__((always_inline)) void interleave(const float in[4][NT_LANES], float *out,
	size_t stride)
{
	for (size_t i = 0; i < NT_LANES; i += 4) {
		nt_float4 four[4];
		for (size_t j = 0; j < 4; j++)
			memcpy(&four[j], in[j] + i, sizeof four[j]);
		turn(four);
		for (size_t j = 0; j < 4; j++)
			memcpy(out + (i + j) * stride, &four[j], sizeof four[j]);
	}
}

static void __attribute__((noinline)) solve_lanes_plain(const lanes_in *in, lanes_out *out, float offset,
	float slack)
{
	solve_lanes(in, out, offset, slack, false, 0, NT_LANES);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k], out->add[k], 4);
}

/* The same for the few triangles of a small mesh, four at a time; the compiler's vectors of four cost as much as
 * wider ones where the set has them. */
#if defined(__AVX512F__)
enum { FEW_LANES = 4 };
#else
enum { FEW_LANES = 8 };
#endif

static void __attribute__((noinline)) solve_few_lanes(const lanes_in *in, lanes_out *out, float offset,
	float slack, size_t count)
{
	for (int i = 0; i < NT_LANES; i++) {
		out->sound[i] = 1;
		out->frameless[i] = out->degenerate[i] = 0;
	}
	for (int begin = 0; begin < (int)count; begin += 4)
		solve_lanes(in, out, offset, slack, false, begin, 4);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k], out->add[k], 4);
}

static void __attribute__((noinline)) solve_lanes_more(const lanes_in *in, lanes_out *out, float offset,
	float slack)
{
	solve_lanes(in, out, offset, slack, true, 0, NT_LANES);
	for (int k = 0; k < 3; k++) {
		interleave(out->sum[k], out->add[k], 4);
		interleave(out->extra[k], out->more[k], 8);
		interleave(out->extra[k] + 4, out->more[k] + 4, 8);
	}
}

/* Half a row (four floats from `offset` on) of corner k of four triangles from `lane` on. */
static inline __attribute__((always_inline)) void gather_four(const nt_weld_row *rows, const uint32_t *ids,
	size_t offset, float (*out)[NT_LANES], size_t lane)
{
	nt_float4 four[4];
	for (size_t j = 0; j < 4; j++)
		memcpy(&four[j], (const float *)&rows[ids[3 * (lane + j)]] + offset, sizeof four[j]);
	turn(four);
	for (size_t j = 0; j < 4; j++)
		memcpy(out[offset + j] + lane, &four[j], sizeof four[j]);
}

/* Rows of the corners of `count` triangles; up to `lanes` the lanes behind repeat the last one. */
static void gather_rows(const nt_weld_row *rows, const uint32_t *ids, size_t count, size_t lanes,
	float (*restrict out)[8][NT_LANES])
{
	uint32_t padded[3 * NT_LANES];
	if (count < NT_LANES) {
		for (size_t i = 0; i < NT_LANES; i++)
			memcpy(padded + 3 * i, ids + 3 * (i < count ? i : count - 1), 3 * sizeof *ids);
		ids = padded;
	}
	for (size_t k = 0; k < 3; k++)
		for (size_t lane = 0; lane < lanes; lane += 4) {
			gather_four(rows, ids + k, 0, out[k], lane);
			gather_four(rows, ids + k, 4, out[k], lane);
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

/* Flags of the lanes; true where all of them are ordinary triangles with a frame. */
static bool classify_lanes(const nt_fast *fast, size_t first, size_t count, const lanes_in *in,
	const lanes_out *out)
{
	uint8_t *flags = fast->flags + first;
	int odd = 0, special = 0;
	for (int i = 0; i < NT_LANES; i++) {
		odd |= !(out->sound[i] | out->frameless[i]);
		special |= out->degenerate[i] | !out->sound[i];
	}
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) | (out->orient[i] ? NT_TRIANGLE_ORIENT : 0) |
				     (out->frameless[i] ? NT_TRIANGLE_ANY : 0) |
				     (out->degenerate[i] ? NT_TRIANGLE_DEGENERATE : 0) |
				     (out->certain[i] ? 0 : NT_TRIANGLE_UNCERTAIN));
	for (size_t i = 0; odd && i < count; i++)
		if (!out->sound[i] && !out->frameless[i] && !has_frame(in, (int)i, out->area[i]))
			flags[i] |= NT_TRIANGLE_ANY;
	if (fast->triangles.cuts)
		orient_quads(flags, count, out->area);
	return !special;
}

#endif

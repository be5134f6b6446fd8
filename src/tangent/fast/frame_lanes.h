/* SPDX-License-Identifier: MIT */
/*
 * Frames of 16 triangles at a time (spec page, step 4), as plain loops of which the compiler makes vectors, and what is
 * to be known of their areas. The arithmetic is that of the scalar definition, operation by operation, wherever a value
 * reaches the output. Included by lanes.h.
 */
#ifndef NT_TANGENT_FAST_FRAME_LANES_H
#define NT_TANGENT_FAST_FRAME_LANES_H

#include <float.h>
#include <math.h>
#include "tangent/fast/parts.h"
#include "tangent/fast/turn.h"

/* Half a unit in the last place of 1: the relative error of a rounded float operation. */
#define HALF_ULP 0x1p-24f

/* Ratios that a float quotient can hold with room to spare. */
#define LEAST_RATIO 1e-30f
#define MOST_RATIO 1e30f

/* 16 triangles by component. */
typedef struct lanes_in {
	NT_ALIGNED(64) float row[3][8][NT_TRIANGLES]; /* corner, float of its nt_weld_row */
} lanes_in;

typedef struct lanes_out {
	NT_ALIGNED(64) float u[3][NT_TRIANGLES], v[3][NT_TRIANGLES]; /* unit directions of the frames */
	float length_u[NT_TRIANGLES], length_v[NT_TRIANGLES]; /* of the directions before they are made unit vectors */
	float angle[3][NT_TRIANGLES];       /* of corners */
	float sum[3][4][NT_TRIANGLES];      /* corner, float of its nt_record */
	float extra[3][8][NT_TRIANGLES];    /* corner, float of its nt_record_more */
	float add[3][4 * NT_TRIANGLES];     /* corner, one nt_record after the other, in turned places */
	float more[3][2][4 * NT_TRIANGLES]; /* the same, halves of nt_record_more */
	float area[NT_TRIANGLES];
	float doubt[NT_TRIANGLES];    /* negative where the area's sign is exact, and stays when v is stored */
	bool plain;               /* all triangles are sound and not degenerate; only if not, there are: */
	int frameless[NT_TRIANGLES];  /* no UV area at all, or next to none: "any" */
	int sound[NT_TRIANGLES];      /* every length and ratio is well inside float's range: certainly not "any" */
	int degenerate[NT_TRIANGLES];
} lanes_out;

/* Lanes of whole vectors, one vector after the other: gcc 12 makes the loops over lanes that are left over and copies
 * for each number of vectors otherwise, twice the code in all. */
#define EACH_LANE(count) \
	NT_UNROLL(1) \
	for (int vector = 0; vector < (count); vector += WIDTH) \
		for (int i = vector; i < vector + WIDTH; i++)

/* For 16 triangles, the edges from corner 0 to 1, from 0 to 2 and from 1 to 2. */
typedef struct lanes_edges {
	NT_ALIGNED(64) float of[3][3][NT_TRIANGLES];
} lanes_edges;

static inline NT_ALWAYS_INLINE void make_edges(const lanes_in *NT_RESTRICT in,
	lanes_edges *NT_RESTRICT edges, int i)
{
	NT_UNROLL(3)
	for (int c = 0; c < 3; c++) {
		edges->of[0][c][i] = in->row[1][c][i] - in->row[0][c][i];
		edges->of[1][c][i] = in->row[2][c][i] - in->row[0][c][i];
		edges->of[2][c][i] = in->row[2][c][i] - in->row[1][c][i];
	}
}

/* A triangle's directions of growing u and v, not of unit length, and what they are made of. */
typedef struct uv_directions {
	float t21x, t21y, t31x, t31y; /* UV edges from corner 0 */
	float s[3], t[3], s_length, t_length;
} uv_directions;

static inline NT_ALWAYS_INLINE uv_directions directions_of(const lanes_in *NT_RESTRICT in,
	const lanes_edges *NT_RESTRICT edges, int i)
{
	uv_directions d;
	d.t21x = in->row[1][6][i] - in->row[0][6][i], d.t21y = in->row[1][7][i] - in->row[0][7][i];
	d.t31x = in->row[2][6][i] - in->row[0][6][i], d.t31y = in->row[2][7][i] - in->row[0][7][i];
	NT_UNROLL(3)
	for (int c = 0; c < 3; c++) {
		const float d1 = edges->of[0][c][i], d2 = edges->of[1][c][i];
		d.s[c] = d.t31y * d1 - d.t21y * d2;
		d.t[c] = -d.t31x * d1 + d.t21x * d2;
	}
	d.s_length = sqrtf(d.s[0] * d.s[0] + d.s[1] * d.s[1] + d.s[2] * d.s[2]);
	d.t_length = sqrtf(d.t[0] * d.t[0] + d.t[1] * d.t[1] + d.t[2] * d.t[2]);
	return d;
}

/* 3 u (|p| + |r|) bounds the rounding of an area, the difference of p and r, u = 2^-24, and the difference is rounded
 * once more. */
static inline NT_ALWAYS_INLINE float area_rounding(const uv_directions *d)
{
	return 8 * HALF_ULP * (fabsf(d->t21x * d->t31y) + fabsf(d->t21y * d->t31x));
}

/* The frames of lanes [0, count). */
static inline NT_ALWAYS_INLINE void solve_frames(const lanes_in *NT_RESTRICT in,
	const lanes_edges *NT_RESTRICT edges, lanes_out *NT_RESTRICT out, int i)
{
	const uv_directions d = directions_of(in, edges, i);
	const float area = d.t21x * d.t31y - d.t21y * d.t31x, sign = copysignf(1.0f, area);
	const float rs = sign / d.s_length, rt = sign / d.t_length;
	NT_UNROLL(3)
	for (int c = 0; c < 3; c++)
		out->u[c][i] = rs * d.s[c], out->v[c][i] = rt * d.t[c];
	out->length_u[i] = d.s_length, out->length_v[i] = d.t_length;
	out->area[i] = area;
	out->doubt[i] = area_rounding(&d) - fabsf(area);
}

/* Storing moves each v by u |v + offset| at most, an edge by twice that. */
static void NT_NOINLINE doubt_stored(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out,
	float offset, int count)
{
	const float slack = offset != 0.0f ? 3 * HALF_ULP : 0.0f;
	lanes_edges edges;
	EACH_LANE(count) {
		make_edges(in, &edges, i);
		const uv_directions d = directions_of(in, &edges, i);
		const float stored =
			fabsf(in->row[0][7][i]) + fabsf(in->row[1][7][i]) + fabsf(in->row[2][7][i]) + fabsf(offset);
		out->doubt[i] =
			area_rounding(&d) + slack * stored * (fabsf(d.t21x) + fabsf(d.t31x)) - fabsf(out->area[i]);
	}
}

/* Tells triangles apart where not all of them are plain. */
static void NT_NOINLINE tell_apart(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out, int count)
{
	EACH_LANE(count) {
		int same[3];
		NT_UNROLL(3)
		for (int k = 0; k < 3; k++) {
			const float (*const a)[NT_TRIANGLES] = in->row[k];
			const float (*const b)[NT_TRIANGLES] = in->row[(k + 1) % 3];
			same[k] = (a[0][i] == b[0][i]) & (a[1][i] == b[1][i]) & (a[2][i] == b[2][i]);
		}
		const float size = fabsf(out->area[i]), ls = out->length_u[i], lt = out->length_v[i];
		out->degenerate[i] = same[0] | same[1] | same[2];
		const int sound = (size > FLT_MIN) & (ls > FLT_MIN) & (lt > FLT_MIN) &
				  (ls > LEAST_RATIO * size) & (lt > LEAST_RATIO * size) &
				  (ls < MOST_RATIO * size) & (lt < MOST_RATIO * size);
		/* the definition's own test, for values that are out of the ordinary */
		const int framed = (ls / size > FLT_MIN) & (lt / size > FLT_MIN);
		out->sound[i] = sound;
		out->frameless[i] = !(size > FLT_MIN) || !(sound | framed);
	}
}

#endif

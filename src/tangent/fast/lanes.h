/* SPDX-License-Identifier: MIT */
/*
 * 32 triangles at a time (spec page, steps 4 and 8), as plain loops of which the compiler makes vectors: their frames,
 * the weighted u direction of each corner, and what holds for all of them. The arithmetic is that of the scalar
 * definition, operation by operation, wherever a value reaches the output. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_LANES_H
#define NT_TANGENT_FAST_LANES_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "base/vec.h"
#include "tangent/acos.h"
#include "tangent/fast/parts.h"
#include "tangent/fast/turn.h"

/* ---- frames, and what is to be known of their areas ---- */

/* Half a unit in the last place of 1: the relative error of a rounded float operation. */
#define HALF_ULP 0x1p-24f

/* Ratios that a float quotient can hold with room to spare. */
#define LEAST_RATIO 1e-30f
#define MOST_RATIO 1e30f

/* 32 triangles by component. */
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

/* For 32 triangles, the edges from corner 0 to 1, from 0 to 2 and from 1 to 2. */
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

/* ---- one corner of each triangle: its direction, its weight, the bits of its record's state ---- */

/* A component is beyond 2^-7 or -2^-7 if this, added to its upper half, sets the bit below the sign's; so it does up to
 * 2^121. Two unit vectors that both are, along one axis and on one side, have a dot product of at least
 * 2 * 2^-14 - 1 = -0.99988, well away from the -1 at which step 7 parts them: rounding moves it by 1e-6. The smaller
 * the distance is, the fewer vertices fail the test.
 *
 * Lengths in here are normalised without loss: their squares neither overflow nor lose bits. Across a normal of unit
 * length a unit vector becomes shorter. So v need not be divided by its length before the test; across long
 * normals, where its components are below 2 and its length is below 3.5, the product is still above 1.0e-5 - 1. */
#define BEYOND 0x0400u

/* The same for whole floats from 2^-100 up to 2^28, and from 2^-64 up to 2^64: an area above the latter's least divides
 * every length, which is no more than the root of FLT_MAX, to a finite magnitude. If it were infinite, a weight of 0
 * would make NaN of it, and halves of a quad are averaged whose results are not the same in all. */
#define WELL_INSIDE 0x32800000u
#define NOT_SMALL 0x20800000u

/* Below the sign of a float: it is 2 or more, infinite, or NaN. */
#define TWO 0x40000000u

static inline NT_ALWAYS_INLINE uint32_t bits_of(float x)
{
	uint32_t bits;
	memcpy(&bits, &x, sizeof bits);
	return bits;
}

/* The upper halves of two floats. */
static inline NT_ALWAYS_INLINE uint32_t halves_of(float low, float high)
{
	return bits_of(low) >> 16 | (bits_of(high) & 0xffff0000u);
}

/* The bits of a state that vectors u and v have, and NT_STATE_SOUND where v is beyond somewhere and `sound` has the bit
 * of TWO. Comparisons would take the ports that multiply, which are the busiest here. */
static inline NT_ALWAYS_INLINE uint32_t state_of(const float u[3], const float v[3], uint32_t sound)
{
	const uint32_t both = BEYOND << 16 | BEYOND;
	const uint32_t a = halves_of(u[0], u[1]) + both, b = halves_of(u[2], v[0]) + both,
		c = halves_of(v[1], v[2]) + both;
	/* sign and beyond, six times two bits */
	const uint32_t all = (a & 0xc000c000u) | (b >> 2 & 0x30003000u) | (c >> 4 & 0x0c000c00u);
	const uint32_t beyond = all & 0x54005400u, sides = beyond + (all >> 1 & beyond);
	return NT_STATE_BASE | NT_STATE_NO_ANY | NT_STATE_LOCAL | (sides & 0xfc00u) | (sides >> 22 & 0x03ffu) |
	       ((sound & (b | c | c << 16)) >> 30 & NT_STATE_SOUND);
}

/* Corners in lanes, by component. */
typedef struct corner_lanes {
	const float (*n)[NT_TRIANGLES];                 /* normal */
	const float (*u)[NT_TRIANGLES], (*v)[NT_TRIANGLES]; /* directions of the triangle's frame */
	const float (*e)[NT_TRIANGLES], (*f)[NT_TRIANGLES]; /* edges at the corner */
	float turned;                               /* -1 where one of them runs towards it, or 1 */
	float (*sum)[NT_TRIANGLES], (*extra)[NT_TRIANGLES]; /* as in lanes_out */
} corner_lanes;

/* Each corner's unit directions, the bits of what holds for it, and the cosine of its angle as seen along n, at most 1.
 * NaN may become a number: of a corner that is not sound nothing is used. */
static inline NT_ALWAYS_INLINE void find_directions(corner_lanes a, float *NT_RESTRICT cosines, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float e[3] = {a.e[0][i], a.e[1][i], a.e[2][i]};
	const float f[3] = {a.f[0][i], a.f[1][i], a.f[2][i]};
	const float os[3] = {a.u[0][i], a.u[1][i], a.u[2][i]};
	const float ot[3] = {a.v[0][i], a.v[1][i], a.v[2][i]};
	/* across the normal */
	const float ne = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
	const float nf = n[0] * f[0] + n[1] * f[1] + n[2] * f[2];
	const float nu = n[0] * os[0] + n[1] * os[1] + n[2] * os[2];
	const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
	const float ex = e[0] - ne * n[0], ey = e[1] - ne * n[1], ez = e[2] - ne * n[2];
	const float fx = f[0] - nf * n[0], fy = f[1] - nf * n[1], fz = f[2] - nf * n[2];
	const float ux = os[0] - nu * n[0], uy = os[1] - nu * n[1], uz = os[2] - nu * n[2];
	const float v[3] = {ot[0] - nv * n[0], ot[1] - nv * n[1], ot[2] - nv * n[2]};

	const float er = a.turned / sqrtf(ex * ex + ey * ey + ez * ez);
	const float fr = 1.0f / sqrtf(fx * fx + fy * fy + fz * fz);
	const float cosine = (er * ex) * (fr * fx) + (er * ey) * (fr * fy) + (er * ez) * (fr * fz);
	cosines[i] = copysignf(fabsf(cosine) < 1.0f ? fabsf(cosine) : 1.0f, cosine);
	const float uu = ux * ux + uy * uy + uz * uz, ur = 1.0f / sqrtf(uu);
	const float u[3] = {ur * ux, ur * uy, ur * uz};
	/* with this square of u the definition normalises as well; the product of an edge without length is NaN; v is
	 * as long as it is: see BEYOND */
	const uint32_t sound =
		(bits_of(uu) + WELL_INSIDE) & ~(bits_of(v[0]) | bits_of(v[1]) | bits_of(v[2]) | bits_of(cosine));
	const uint32_t state = state_of(u, v, sound);
	a.sum[0][i] = u[0];
	a.sum[1][i] = u[1];
	a.sum[2][i] = u[2];
	memcpy(&a.sum[3][i], &state, sizeof state);
}

/* Directions are weighted by the angle, which replaces its cosine. */
static inline NT_ALWAYS_INLINE void weigh_corner(corner_lanes a, float *NT_RESTRICT angles, int i)
{
	const float w = nt_acos(angles[i]);
	a.sum[0][i] *= w;
	a.sum[1][i] *= w;
	a.sum[2][i] *= w;
	angles[i] = w;
}

/* The directions of v and the magnitudes, weighted, and the weight. */
static inline NT_ALWAYS_INLINE void weigh_more(corner_lanes a, const float *NT_RESTRICT angles,
	const lanes_out *out, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float ot[3] = {a.v[0][i], a.v[1][i], a.v[2][i]};
	const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
	const float x = ot[0] - nv * n[0], y = ot[1] - nv * n[1], z = ot[2] - nv * n[2];
	const float r = 1.0f / sqrtf(x * x + y * y + z * z), w = angles[i], size = fabsf(out->area[i]);
	a.extra[0][i] = r * x * w;
	a.extra[1][i] = r * y * w;
	a.extra[2][i] = r * z * w;
	a.extra[3][i] = w;
	a.extra[4][i] = w * (out->length_u[i] / size);
	a.extra[5][i] = w * (out->length_v[i] / size);
	a.extra[6][i] = 0.0f;
	a.extra[7][i] = 0.0f;
}

/* ---- all of it ---- */

/* Without it gcc 12 makes no vectors of the loops over lanes. */
#if WIDTH > 1
#define UNROLL_CORNERS NT_UNROLL(3)
#else
#define UNROLL_CORNERS NT_UNROLL(1)
#endif

/* Corner k of 32 triangles. */
static inline NT_ALWAYS_INLINE corner_lanes corner_of(const lanes_in *in,
	const lanes_edges *edges, lanes_out *out, int k)
{
	return (corner_lanes){.n = in->row[k] + 3, .u = out->u, .v = out->v,
		.e = edges->of[k == 2 ? 1 : 0],
		.f = edges->of[k == 0 ? 1 : 2], .turned = k == 1 ? -1.0f : 1.0f, .sum = out->sum[k],
		.extra = out->extra[k]};
}

/* Whether all lanes are plain. */
static inline bool are_plain(const lanes_out *out, size_t count)
{
	lanes all = ~(lanes){0};
	for (size_t i = 0; i < count; i += WIDTH) {
		const lanes size = load_lanes(out->area + i) & (TWO * 2 - 1);
		all &= (size + WELL_INSIDE) & (size + NOT_SMALL);
		lanes states = load_lanes(out->sum[0][3] + i);
		for (size_t k = 1; k < 3; k++)
			states &= load_lanes(out->sum[k][3] + i);
		all &= states << 30;
	}
	return !any_lane(~all & TWO);
}

/* Whether an edge across the normal is as long as the definition needs to make numbers of it: it divides by the length
 * where a component is above FLT_MIN, and the square of that may be 0. */
static inline NT_ALWAYS_INLINE int has_length(const float n[3], const float e[3])
{
	const float ne = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
	const float x = e[0] - ne * n[0], y = e[1] - ne * n[1], z = e[2] - ne * n[2];
	const float squared = x * x + y * y + z * z;
	const int none = (fabsf(x) <= FLT_MIN) & (fabsf(y) <= FLT_MIN) & (fabsf(z) <= FLT_MIN);
	return none | ((squared > 0.0f) & (squared <= FLT_MAX));
}

/* Corners whose u lies exactly along the normal add nothing, whichever corners are averaged with them, if their weight
 * is a number: where all of a vertex are such, its sum is the result. The lanes have a NaN of each. */
static void NT_NOINLINE clear_along(const lanes_in *in, lanes_out *out, size_t count)
{
	static const nt_record nothing = {.state = NT_STATE_BASE | NT_STATE_NO_ANY | NT_STATE_LOCAL | NT_STATE_U};
	static_assert(NT_STATE_SOUND == 1, "as where a frame is sound");
	lanes some = {0};
	for (size_t i = 0; i < count; i += WIDTH)
		some |= load_lanes(out->sound + i) & ~load_lanes(out->degenerate + i) &
			~(load_lanes(out->sum[0][3] + i) & load_lanes(out->sum[1][3] + i) &
				load_lanes(out->sum[2][3] + i));
	if (!any_lane(some & (uint32_t)NT_STATE_SOUND))
		return;
	for (int k = 0; k < 3; k++) {
		const float (*const p)[NT_TRIANGLES] = in->row[k], (*const n)[NT_TRIANGLES] = p + 3;
		const float (*const q)[NT_TRIANGLES] = in->row[(k + 1) % 3];
		const float (*const r)[NT_TRIANGLES] = in->row[(k + 2) % 3];
		int along[NT_TRIANGLES];
		EACH_LANE((int)whole_lanes(count)) {
			const float at[3] = {n[0][i], n[1][i], n[2][i]};
			const float part = at[0] * out->u[0][i] + at[1] * out->u[1][i] + at[2] * out->u[2][i];
			const float e[3] = {q[0][i] - p[0][i], q[1][i] - p[1][i], q[2][i] - p[2][i]};
			const float f[3] = {r[0][i] - p[0][i], r[1][i] - p[1][i], r[2][i] - p[2][i]};
			along[i] = out->sound[i] & (out->u[0][i] == part * at[0]) & (out->u[1][i] == part * at[1]) &
				   (out->u[2][i] == part * at[2]) & has_length(at, e) & has_length(at, f);
		}
		for (size_t i = 0; i < count; i++)
			if (along[i])
				memcpy(out->add[k] + 4 * turned_place(i), &nothing, sizeof nothing);
	}
}

/* Facts about solved lanes; more than sums needs bounds that plain ones do not have. */
static inline void judge(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out, float offset, bool more,
	size_t count)
{
	const size_t lane_count = whole_lanes(count);
	out->plain = !more && are_plain(out, lane_count);
	if (!out->plain) {
		tell_apart(in, out, (int)lane_count);
		if (!more)
			clear_along(in, out, count);
	}
	if (offset != 0.0f)
		doubt_stored(in, out, offset, (int)lane_count);
}

/* Whole vectors of lanes, in a loop for each corner: in a single one more values are under way than there are
 * registers. */
static inline NT_ALWAYS_INLINE void solve_vectors(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out, int end)
{
	if (end < WIDTH)
		NT_UNREACHABLE; /* keeps gcc 12 from warning of loops that are not entered */
	lanes_edges edges;
	EACH_LANE(end) {
		make_edges(in, &edges, i);
		solve_frames(in, &edges, out, i);
	}
	UNROLL_CORNERS
	for (int k = 0; k < 3; k++)
		EACH_LANE(end) find_directions(corner_of(in, &edges, out, k), out->angle[k], i);
	UNROLL_CORNERS
	for (int k = 0; k < 3; k++)
		EACH_LANE(end) weigh_corner(corner_of(in, &edges, out, k), out->angle[k], i);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k][0], NT_TRIANGLES, (size_t)end, out->add[k]);
}

static void NT_NOINLINE solve_lanes(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out, size_t count)
{
	const int end = (int)whole_lanes(count);
#ifndef NT_SMALL_CODE
	/* few triangles: 10 ns less without loops */
	if (end == WIDTH) {
		solve_vectors(in, out, WIDTH);
		return;
	}
#endif
	solve_vectors(in, out, end);
}

/* Adds the numbers behind bitangents and magnitudes to solved lanes. */
static void NT_NOINLINE solve_more(const lanes_in *in, lanes_out *out, size_t count)
{
	const size_t lane_count = whole_lanes(count);
	for (int k = 0; k < 3; k++) {
		const corner_lanes corner = {.n = in->row[k] + 3, .v = out->v, .extra = out->extra[k]};
		EACH_LANE((int)lane_count) weigh_more(corner, out->angle[k], out, i);
		interleave(out->extra[k][0], NT_TRIANGLES, lane_count, out->more[k][0]);
		interleave(out->extra[k][4], NT_TRIANGLES, lane_count, out->more[k][1]);
	}
}

#endif

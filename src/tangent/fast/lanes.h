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

/* A component is beyond 2^-7 or -2^-7 if this, added to its upper half, sets the bit below the sign's; so it does up to
 * 2^121. Two unit vectors that both are, along one axis and on one side, have a dot product of at least
 * 2 * 2^-14 - 1 = -0.99988, well away from the -1 at which step 7 parts them: rounding moves it by 1e-6. The smaller
 * the distance is, the fewer vertices fail the test.
 *
 * Lengths in here are normalised without loss: their squares neither overflow nor lose bits. Across a normal of unit
 * length a unit vector becomes shorter. So v need not be divided by its length before the test; across long
 * normals, where its components are below 2 and its length is below 3.5, the product is still above 1.0e-5 - 1. */
#define BEYOND 0x0400u

/* The same for whole floats from 2^-100 up to 2^28. */
#define WELL_INSIDE 0x32800000u

/* Below the sign of a float: it is 2 or more, infinite, or NaN. */
#define TWO 0x40000000u

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
	_Alignas(64) nt_frames frames;
	float length_u[NT_LANES], length_v[NT_LANES]; /* of the directions before they are made unit vectors */
	float mag_u[NT_LANES], mag_v[NT_LANES];
	float sum[3][4][NT_LANES];      /* corner, float of its nt_record */
	float extra[3][8][NT_LANES];    /* corner, float of its nt_record_more */
	float add[3][4 * NT_LANES];     /* corner, one nt_record after the other, in turned places */
	float more[3][2][4 * NT_LANES]; /* the same, halves of nt_record_more */
	float area[NT_LANES];
	float doubt[NT_LANES];    /* negative where the area's sign is exact, and stays when v is stored */
	bool plain;               /* all triangles are sound and not degenerate; only if not, there are: */
	int frameless[NT_LANES];  /* no UV area at all, or next to none: "any" */
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

static inline __attribute__((always_inline)) uint32_t bits_of(float x)
{
	uint32_t bits;
	memcpy(&bits, &x, sizeof bits);
	return bits;
}

/* The upper halves of two floats. */
static inline __attribute__((always_inline)) uint32_t halves_of(float low, float high)
{
	return bits_of(low) >> 16 | (bits_of(high) & 0xffff0000u);
}

/* The bits of a state that vectors u and v have, and NT_STATE_SOUND where v is beyond somewhere and `sound` has the bit
 * of TWO. Comparisons would take the ports that multiply, which are the busiest here. */
static inline __attribute__((always_inline)) uint32_t state_of(const float u[3], const float v[3], uint32_t sound)
{
	const uint32_t both = BEYOND << 16 | BEYOND;
	const uint32_t a = halves_of(u[0], u[1]) + both, b = halves_of(u[2], v[0]) + both, c = halves_of(v[1], v[2]) + both;
	/* sign and beyond, six times two bits */
	const uint32_t all = (a & 0xc000c000u) | (b >> 2 & 0x30003000u) | (c >> 4 & 0x0c000c00u);
	const uint32_t beyond = all & 0x54005400u, sides = beyond + (all >> 1 & beyond);
	return NT_STATE_BASE | NT_STATE_NO_ANY | NT_STATE_LOCAL | (sides & 0xfc00u) | (sides >> 22 & 0x03ffu) |
	       ((sound & (b | c | c << 16)) >> 30 & NT_STATE_SOUND);
}

/* Lanes of whole vectors: so no compiler has to see to those that are left over. */
#define EACH_LANE(count) for (int i = 0; i < ((count) & -WIDTH); i++)

/* Of 16 triangles, the edges from corner 0 to 1, from 0 to 2 and from 1 to 2. */
typedef struct lanes_edges {
	_Alignas(64) float of[3][3][NT_LANES];
} lanes_edges;

static inline __attribute__((always_inline)) void make_edges(const lanes_in *restrict in, lanes_edges *restrict edges, int i)
{
#pragma GCC unroll 3
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

static inline __attribute__((always_inline)) uv_directions directions_of(const lanes_in *restrict in,
	const lanes_edges *restrict edges, int i)
{
	uv_directions d;
	d.t21x = in->row[1][6][i] - in->row[0][6][i], d.t21y = in->row[1][7][i] - in->row[0][7][i];
	d.t31x = in->row[2][6][i] - in->row[0][6][i], d.t31y = in->row[2][7][i] - in->row[0][7][i];
#pragma GCC unroll 3
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
static inline __attribute__((always_inline)) float area_rounding(const uv_directions *d)
{
	return 8 * HALF_ULP * (fabsf(d->t21x * d->t31y) + fabsf(d->t21y * d->t31x));
}

/* The frames of lanes [0, count). */
static inline __attribute__((always_inline)) void solve_frames(const lanes_in *restrict in, const lanes_edges *restrict edges,
	lanes_out *restrict out, bool more, int i)
{
	const uv_directions d = directions_of(in, edges, i);
	const float area = d.t21x * d.t31y - d.t21y * d.t31x, sign = copysignf(1.0f, area);
	const float rs = sign / d.s_length, rt = sign / d.t_length;
#pragma GCC unroll 3
	for (int c = 0; c < 3; c++)
		out->frames.u[c][i] = rs * d.s[c], out->frames.v[c][i] = rt * d.t[c];
	out->length_u[i] = d.s_length, out->length_v[i] = d.t_length;
	if (more)
		out->mag_u[i] = d.s_length / fabsf(area), out->mag_v[i] = d.t_length / fabsf(area);
	out->area[i] = area;
	if (NT_SHORT_WAYS)
		out->doubt[i] = area_rounding(&d) - fabsf(area);
}

/* Storing moves each v by u |v + offset| at most, an edge by twice that. */
static void __attribute__((noinline)) doubt_stored(const lanes_in *restrict in, lanes_out *restrict out, float offset, int count)
{
	const float slack = offset != 0.0f ? 3 * HALF_ULP : 0.0f;
	lanes_edges edges;
	EACH_LANE(count) {
		make_edges(in, &edges, i);
		const uv_directions d = directions_of(in, &edges, i);
		const float stored = fabsf(in->row[0][7][i]) + fabsf(in->row[1][7][i]) + fabsf(in->row[2][7][i]) + fabsf(offset);
		out->doubt[i] = area_rounding(&d) + slack * stored * (fabsf(d.t21x) + fabsf(d.t31x)) - fabsf(out->area[i]);
	}
}

/* Tells triangles apart where not all of them are plain. */
static void __attribute__((noinline)) tell_apart(const lanes_in *restrict in, lanes_out *restrict out, int count)
{
	EACH_LANE(count) {
		int same[3];
#pragma GCC unroll 3
		for (int k = 0; k < 3; k++) {
			const float (*const a)[NT_LANES] = in->row[k], (*const b)[NT_LANES] = in->row[(k + 1) % 3];
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

static inline __attribute__((always_inline)) int is_zero(float x, float y, float z)
{
	return (x == 0.0f) & (y == 0.0f) & (z == 0.0f);
}

/* Corners in lanes, by component. */
typedef struct corner_lanes {
	const float (*n)[NT_LANES];                 /* normal */
	const float (*u)[NT_LANES], (*v)[NT_LANES]; /* directions of the triangle's frame */
	const float (*e)[NT_LANES], (*f)[NT_LANES]; /* edges at the corner */
	float turned;                               /* -1 where one of them runs towards it, or 1 */
	float (*sum)[NT_LANES], (*extra)[NT_LANES]; /* as in lanes_out */
} corner_lanes;

/* What is made of them on the way. Narrow vectors do not need it for longer than a corner takes: see solve_lanes(). */
#define KEPT (WIDTH > 4 ? NT_LANES : 1)
#define KEPT_AT(i) (WIDTH > 4 ? (i) : 0)
typedef struct corner_parts {
	_Alignas(64) float u[3][KEPT], e[3][KEPT], f[3][KEPT]; /* across the normal */
	float of_u[KEPT], of_e[KEPT], of_f[KEPT];              /* reciprocals of their lengths */
	uint32_t sound[KEPT];
} corner_parts;

/* The angle between e and f: first its cosine; in the widest vectors then what tangent/acos.h calls z and s. */
typedef struct corner_angles {
	_Alignas(64) float cosine[NT_LANES];
#if WIDTH == 16
	double z[NT_LANES], s[NT_LANES], begin[NT_LANES];
#else
	float clamped[NT_LANES];
#endif
} corner_angles;

/* Each corner's edges without their part along n, and what makes them unit vectors; `along`: directions and edges
 * along the normal, of which nothing is left but zero, are sound as well. */
static inline __attribute__((always_inline)) void project_edges(corner_lanes a, corner_parts *restrict p, bool along, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float e[3] = {a.e[0][i], a.e[1][i], a.e[2][i]};
	const float f[3] = {a.f[0][i], a.f[1][i], a.f[2][i]};
	const float ne = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
	const float nf = n[0] * f[0] + n[1] * f[1] + n[2] * f[2];
	const float ex = e[0] - ne * n[0], ey = e[1] - ne * n[1], ez = e[2] - ne * n[2];
	const float fx = f[0] - nf * n[0], fy = f[1] - nf * n[1], fz = f[2] - nf * n[2];
	p->of_e[KEPT_AT(i)] = along && is_zero(ex, ey, ez) ? 1.0f : a.turned / sqrtf(ex * ex + ey * ey + ez * ez);
	p->of_f[KEPT_AT(i)] = along && is_zero(fx, fy, fz) ? 1.0f : 1.0f / sqrtf(fx * fx + fy * fy + fz * fz);
	p->e[0][KEPT_AT(i)] = ex, p->e[1][KEPT_AT(i)] = ey, p->e[2][KEPT_AT(i)] = ez;
	p->f[0][KEPT_AT(i)] = fx, p->f[1][KEPT_AT(i)] = fy, p->f[2][KEPT_AT(i)] = fz;
}

/* The same of the u directions. */
static inline __attribute__((always_inline)) void project_u(corner_lanes a, corner_parts *restrict p, bool along, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float os[3] = {a.u[0][i], a.u[1][i], a.u[2][i]};
	const float nu = n[0] * os[0] + n[1] * os[1] + n[2] * os[2];
	const float ux = os[0] - nu * n[0], uy = os[1] - nu * n[1], uz = os[2] - nu * n[2];
	const float uu = along && is_zero(ux, uy, uz) ? 1.0f : ux * ux + uy * uy + uz * uz;
	p->of_u[KEPT_AT(i)] = 1.0f / sqrtf(uu);
	p->sound[KEPT_AT(i)] = bits_of(uu) + WELL_INSIDE;
	p->u[0][KEPT_AT(i)] = ux, p->u[1][KEPT_AT(i)] = uy, p->u[2][KEPT_AT(i)] = uz;
}

/* The cosine of each corner's angle, as seen along n. */
static inline __attribute__((always_inline)) void find_cosine(const corner_parts *restrict p, corner_angles *restrict angles, int i)
{
	const float er = p->of_e[KEPT_AT(i)], ex = er * p->e[0][KEPT_AT(i)], ey = er * p->e[1][KEPT_AT(i)], ez = er * p->e[2][KEPT_AT(i)];
	const float fr = p->of_f[KEPT_AT(i)], fx = fr * p->f[0][KEPT_AT(i)], fy = fr * p->f[1][KEPT_AT(i)], fz = fr * p->f[2][KEPT_AT(i)];
	angles->cosine[i] = ex * fx + ey * fy + ez * fz;
}

/* The angle up to what takes the square root, and the rest. In the widest vectors, nt_acos() as begin + asin(s), with
 * the signs and factors of its three cases in `begin` and s, which changes no bits: 40 of 530 cycles. In others stores
 * would cost more. NaN may become a number: of a corner that is not sound nothing is used. */
static inline __attribute__((always_inline)) void begin_angle(corner_angles *restrict a, int i)
{
	const float c = a->cosine[i], size = fabsf(c) < 1.0f ? fabsf(c) : 1.0f;
#if WIDTH == 16
	const double pi = 3.14159265358979323846;
	const double x = c, z = (1.0f - size) * 0.5f, root = sqrt(z);
	a->z[i] = size > 0.5f ? z : x * x;
	a->s[i] = size > 0.5f ? copysign(root + root, x) : -x;
	a->begin[i] = size > 0.5f ? (c < 0.0f ? pi : 0.0) : pi * 0.5;
#else
	a->clamped[i] = copysignf(size, c);
#endif
}

static inline __attribute__((always_inline)) float end_angle(const corner_angles *restrict a, int i)
{
#if WIDTH == 16
	return (float)(a->begin[i] + NT_ACOS_TERM(a->s[i] * a->z[i], nt_acos_terms(a->z[i]), a->s[i]));
#else
	return nt_acos(a->clamped[i]);
#endif
}

/* Each corner's unit directions and the bits of what holds for it. */
static inline __attribute__((always_inline)) void finish_directions(corner_lanes a, const corner_parts *restrict p,
	const corner_angles *restrict angles, bool along, bool more, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float ot[3] = {a.v[0][i], a.v[1][i], a.v[2][i]};
	const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
	const float v[3] = {ot[0] - nv * n[0], ot[1] - nv * n[1], ot[2] - nv * n[2]};
	const float ur = p->of_u[KEPT_AT(i)], whole[3] = {p->u[0][KEPT_AT(i)], p->u[1][KEPT_AT(i)], p->u[2][KEPT_AT(i)]};
	const float u[3] = {ur * whole[0], ur * whole[1], ur * whole[2]};
	/* with this square of u the definition normalises as well; the product of an edge without length is NaN; v is
	 * as long as it is: see BEYOND */
	const uint32_t sound = p->sound[KEPT_AT(i)] & ~(bits_of(v[0]) | bits_of(v[1]) | bits_of(v[2]) | bits_of(angles->cosine[i]));
	uint32_t state = state_of(u, v, sound);
	const int no_v = along && is_zero(v[0], v[1], v[2]);
	if (along) {
		state = set_where(state, is_zero(whole[0], whole[1], whole[2]), NT_STATE_U);
		state = set_where(state, no_v, NT_STATE_V | (sound >> 30 & NT_STATE_SOUND));
	}
	a.sum[0][i] = u[0];
	a.sum[1][i] = u[1];
	a.sum[2][i] = u[2];
	memcpy(&a.sum[3][i], &state, sizeof state);
	if (more) {
		const float vr = no_v ? 1.0f : 1.0f / sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
		a.extra[0][i] = vr * v[0];
		a.extra[1][i] = vr * v[1];
		a.extra[2][i] = vr * v[2];
	}
}

/* Directions are weighted by the angle. */
static inline __attribute__((always_inline)) void weigh_corner(corner_lanes a, const corner_angles *restrict angles,
	const lanes_out *out, bool more, int i)
{
	const float w = end_angle(angles, i);
	a.sum[0][i] *= w;
	a.sum[1][i] *= w;
	a.sum[2][i] *= w;
	if (more) {
		a.extra[0][i] *= w;
		a.extra[1][i] *= w;
		a.extra[2][i] *= w;
		a.extra[3][i] = w;
		a.extra[4][i] = w * out->mag_u[i];
		a.extra[5][i] = w * out->mag_v[i];
		a.extra[6][i] = 0.0f;
		a.extra[7][i] = 0.0f;
	}
}

/* Corner k of 16 triangles. */
static inline __attribute__((always_inline)) corner_lanes corner_of(const lanes_in *in, const lanes_edges *edges, lanes_out *out,
	int k)
{
	return (corner_lanes){.n = in->row[k] + 3, .u = out->frames.u, .v = out->frames.v, .e = edges->of[k == 2 ? 1 : 0],
		.f = edges->of[k == 0 ? 1 : 2], .turned = k == 1 ? -1.0f : 1.0f, .sum = out->sum[k], .extra = out->extra[k]};
}

/* Lanes [0, count); the frames too, if `frames`. In wide vectors there is one loop for each idea, and each of them
 * begun early whose square roots others wait for: in a single one there are more values under way than registers, and
 * in the order of corners the processor's queue is full of what waits. This order takes 490 cycles for 16 triangles on
 * an EPYC 9004 with AVX-512, others 500 to 550. */
static inline __attribute__((always_inline)) void solve_lanes(const lanes_in *restrict in, lanes_out *restrict out,
	bool frames, bool along, bool more, int count)
{
	if (count < WIDTH)
		__builtin_unreachable(); /* keeps gcc 12 from warning of loops that are not entered */
	lanes_edges edges;
	corner_angles angles[3];
	const corner_lanes a = corner_of(in, &edges, out, 0), b = corner_of(in, &edges, out, 1), c = corner_of(in, &edges, out, 2);
#if WIDTH > 4
	corner_parts p[3];
	EACH_LANE(count) make_edges(in, &edges, i);
	EACH_LANE(count) project_edges(a, &p[0], along, i);
	EACH_LANE(count) project_edges(b, &p[1], along, i);
	if (frames)
		EACH_LANE(count) solve_frames(in, &edges, out, more, i);
	EACH_LANE(count) project_edges(c, &p[2], along, i);
	EACH_LANE(count) find_cosine(&p[1], &angles[1], i);
	EACH_LANE(count) find_cosine(&p[0], &angles[0], i);
	EACH_LANE(count) begin_angle(&angles[0], i);
	EACH_LANE(count) find_cosine(&p[2], &angles[2], i);
	EACH_LANE(count) project_u(a, &p[0], along, i);
	EACH_LANE(count) project_u(b, &p[1], along, i);
	EACH_LANE(count) finish_directions(a, &p[0], &angles[0], along, more, i);
	EACH_LANE(count) begin_angle(&angles[1], i);
	EACH_LANE(count) weigh_corner(a, &angles[0], out, more, i);
	EACH_LANE(count) begin_angle(&angles[2], i);
	EACH_LANE(count) project_u(c, &p[2], along, i);
	EACH_LANE(count) finish_directions(b, &p[1], &angles[1], along, more, i);
	EACH_LANE(count) weigh_corner(b, &angles[1], out, more, i);
	EACH_LANE(count) finish_directions(c, &p[2], &angles[2], along, more, i);
	EACH_LANE(count) weigh_corner(c, &angles[2], out, more, i);
#else
	EACH_LANE(count) {
		make_edges(in, &edges, i);
		if (frames)
			solve_frames(in, &edges, out, more, i);
	}
	const corner_lanes corners[3] = {a, b, c};
#pragma GCC unroll 3
	for (int k = 0; k < 3; k++)
		EACH_LANE(count) {
			corner_parts p;
			project_edges(corners[k], &p, along, i);
			project_u(corners[k], &p, along, i);
			find_cosine(&p, &angles[k], i);
			finish_directions(corners[k], &p, &angles[k], along, more, i);
			begin_angle(&angles[k], i);
		}
#pragma GCC unroll 3
	for (int k = 0; k < 3; k++)
		EACH_LANE(count) weigh_corner(corners[k], &angles[k], out, more, i);
#endif
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k], (size_t)count, out->add[k]);
}

/* A single corner in each lane. */
static inline __attribute__((always_inline)) void solve_corner(corner_lanes a, bool along)
{
	corner_angles angles;
#if WIDTH > 4
	corner_parts p;
	EACH_LANE(NT_LANES) project_edges(a, &p, along, i);
	EACH_LANE(NT_LANES) project_u(a, &p, along, i);
	EACH_LANE(NT_LANES) find_cosine(&p, &angles, i);
	EACH_LANE(NT_LANES) begin_angle(&angles, i);
	EACH_LANE(NT_LANES) finish_directions(a, &p, &angles, along, false, i);
#else
	EACH_LANE(NT_LANES) {
		corner_parts p;
		project_edges(a, &p, along, i);
		project_u(a, &p, along, i);
		find_cosine(&p, &angles, i);
		finish_directions(a, &p, &angles, along, false, i);
		begin_angle(&angles, i);
	}
#endif
	EACH_LANE(NT_LANES) weigh_corner(a, &angles, NULL, false, i);
}

/* Whether all lanes are plain. */
static inline bool are_plain(const lanes_out *out, size_t corners, size_t count)
{
	lanes all = ~(lanes){0};
	for (size_t i = 0; i < count; i += WIDTH) {
		all &= (load_lanes(out->area + i) & (TWO * 2 - 1)) + WELL_INSIDE;
		lanes states = load_lanes(out->sum[0][3] + i);
		for (size_t k = 1; k < corners; k++)
			states &= load_lanes(out->sum[k][3] + i);
		all &= states << 30;
	}
	return !any_lane(~all & TWO);
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
	solve_lanes(in, out, false, true, false, (int)lane_count);
}

/* What is to be known of lanes that are solved: so many corners' sums say whether they are plain. */
static inline void judge(const lanes_in *restrict in, lanes_out *restrict out, float offset, size_t corners, size_t lane_count)
{
	out->plain = NT_SHORT_WAYS && corners > 0 && are_plain(out, corners, lane_count);
	if (!out->plain)
		tell_apart(in, out, (int)lane_count);
	if (!NT_SHORT_WAYS || offset != 0.0f)
		doubt_stored(in, out, offset, (int)lane_count);
}

static void __attribute__((noinline)) solve_lanes_plain(const lanes_in *restrict in, lanes_out *restrict out, float offset,
	size_t count)
{
	const size_t lane_count = whole_lanes(count);
	solve_lanes(in, out, true, false, false, (int)lane_count);
	judge(in, out, offset, 3, lane_count);
	if (NT_SHORT_WAYS && !out->plain && has_extremes(out, lane_count))
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
	lanes_edges edges;
	_Alignas(64) float n[3][NT_LANES], e[3][NT_LANES], f[3][NT_LANES], add[4 * NT_LANES];
#pragma GCC unroll 8
	for (int c = 0; c < 8; c++)
#pragma GCC unroll 3
		for (int k = 0; k < 3; k++)
			spread(in->row[k][c], in->row[k][c], in->row[k][c], in->row[k][c], frames.row[k][c]);
	EACH_LANE(NT_LANES) make_edges(&frames, &edges, i);
	EACH_LANE(NT_LANES) solve_frames(&frames, &edges, out, false, i);
#pragma GCC unroll 3
	for (int c = 0; c < 3; c++) {
		const float *const d1 = edges.of[0][c], *const d2 = edges.of[1][c], *const d3 = edges.of[2][c];
		spread(in->row[0][3 + c], in->row[1][3 + c], in->row[2][3 + c], in->row[0][3 + c], n[c]);
		spread(d1, d1, d2, d1, e[c]);
		spread(d2, d3, d3, d2, f[c]);
		for (int i = 4; i < 8; i++)
			e[c][i] = -e[c][i]; /* it runs towards corner 1 */
	}
	solve_corner((corner_lanes){.n = n, .u = out->frames.u, .v = out->frames.v, .e = e, .f = f, .turned = 1.0f,
		.sum = out->sum[0]}, false);
	interleave(out->sum[0], NT_LANES, add);
	for (size_t k = 0; k < 3; k++)
		for (size_t i = 0; i < 4; i++)
			memcpy(out->add[k] + 4 * turned_place(i), add + 4 * turned_place(4 * k + i), 4 * sizeof *add);
	judge(&frames, out, offset, 1, NT_LANES);
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
	solve_lanes(in, out, true, false, true, NT_LANES);
	for (int k = 0; k < 3; k++) {
		interleave(out->extra[k], NT_LANES, out->more[k][0]);
		interleave(out->extra[k] + 4, NT_LANES, out->more[k][1]);
	}
	judge(in, out, offset, 0, NT_LANES);
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

/* Flags of lanes that are not plain; true where all of them are ordinary triangles with a frame. */
static bool __attribute__((noinline)) classify_special(uint8_t *flags, size_t count, const lanes_in *in, const lanes_out *out)
{
	int special = 0;
	for (size_t i = 0; i < count; i++)
		special |= out->degenerate[i] | !out->sound[i];
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) | (out->area[i] > 0.0f ? NT_TRIANGLE_ORIENT : 0) |
				     (out->frameless[i] ? NT_TRIANGLE_ANY : 0) |
				     (out->degenerate[i] ? NT_TRIANGLE_DEGENERATE : 0) |
				     (out->doubt[i] < 0.0f && !out->frameless[i] ? 0 : NT_TRIANGLE_UNCERTAIN));
	if (NT_SHORT_WAYS && special)
		clear_flat(in, flags, count);
	return !special;
}

static inline __attribute__((always_inline)) void classify_plain(uint8_t *restrict flags, size_t count,
	const lanes_out *restrict out)
{
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) | (bits_of(out->area[i]) >> 31 ^ NT_TRIANGLE_ORIENT) |
				     (~bits_of(out->doubt[i]) >> 24 & NT_TRIANGLE_UNCERTAIN));
}

/* Flags of the lanes; true where all of them are ordinary triangles with a frame. */
static inline bool classify_lanes(const nt_fast *fast, size_t first, size_t count, const lanes_in *in, const lanes_out *out)
{
	uint8_t *flags = fast->flags + first;
	bool ordinary = out->plain;
	if (!NT_SHORT_WAYS || !ordinary)
		ordinary = classify_special(flags, count, in, out);
	else if (count == NT_LANES)
		classify_plain(flags, NT_LANES, out);
	else
		classify_plain(flags, count, out);
	if (fast->triangles.cuts)
		orient_quads(flags, count, out->area);
	return ordinary;
}

#endif

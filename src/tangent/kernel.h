/* SPDX-License-Identifier: MIT */
/*
 * The two passes that need lanes, as plain loops over 16 of them. kernel_*.c include this file once for
 * each instruction set, with NT_KERNEL(name) giving the names; the compiler makes vectors of the
 * loops. The arithmetic is that of the scalar definition, operation by operation, wherever a value
 * reaches the output.
 *
 * accumulate: 16 triangles at a time. Frame (spec page, step 4), the three corners' weighted u directions
 * (step 8), then, one triangle after the other, the addition to the records of the vertices and
 * the entry in each vertex's fan.
 *
 * settle: 16 vertices at a time. A vertex is settled when the corners of each orientation make one fan
 * (step 6 would flood them in one go) and no two directions can be antiparallel (step 7 would not
 * split them). Then its sums are its results.
 */
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

typedef float nt_float4 __attribute__((vector_size(16)));
typedef int nt_int4 __attribute__((vector_size(16)));

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

static inline __attribute__((always_inline)) void solve_lanes(const lanes_in *restrict in,
	lanes_out *restrict out, float offset, float slack, bool more)
{
	for (int i = 0; i < NT_LANES; i++) {
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
	solve_lanes(in, out, offset, slack, false);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k], out->add[k], 4);
}

static void __attribute__((noinline)) solve_lanes_more(const lanes_in *in, lanes_out *out, float offset,
	float slack)
{
	solve_lanes(in, out, offset, slack, true);
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

/* Rows of the corners of `count` triangles; the lanes behind repeat the last one. */
static void gather_lanes(const nt_fast *fast, size_t first, size_t count, lanes_in *restrict in)
{
	uint32_t padded[3 * NT_LANES];
	const uint32_t *ids = fast->ids + 3 * first;
	if (count < NT_LANES) {
		for (size_t i = 0; i < NT_LANES; i++)
			memcpy(padded + 3 * i, ids + 3 * (i < count ? i : count - 1), 3 * sizeof *ids);
		ids = padded;
	}
	for (size_t k = 0; k < 3; k++)
		for (size_t lane = 0; lane < NT_LANES; lane += 4) {
			gather_four(fast->rows, ids + k, 0, in->row[k], lane);
			gather_four(fast->rows, ids + k, 4, in->row[k], lane);
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
	if (fast->corners)
		orient_quads(flags, count, out->area);
	return !special;
}

static inline void add_record(nt_record *record, const float *add)
{
	static const nt_int4 state_lane = {0, 0, 0, -1};
	nt_float4 old, new;
	memcpy(&old, record, sizeof old);
	memcpy(&new, add, sizeof new);
	const nt_int4 sum = (nt_int4)(old + new), both = (nt_int4)old & (nt_int4)new;
	const nt_int4 result = (both & state_lane) | (sum & ~state_lane);
	memcpy(record, &result, sizeof result);
}

static inline void add_more(nt_record_more *record, const float *add)
{
	nt_float4 old[2], new[2];
	memcpy(old, record, sizeof old);
	memcpy(new, add, sizeof new);
	old[0] += new[0], old[1] += new[1];
	memcpy(record, old, sizeof old);
}

/* A corner of a hub, or of a vertex that an earlier range adds to. */
static void __attribute__((noinline)) add_unusual(nt_fast *fast, unsigned range, uint32_t vertex,
	uint32_t cursor, int orient, nt_fan_entry entry, const float *add, const float *more)
{
	if (!(cursor & NT_CURSOR_HUB))
		fast->adjacency.entries[cursor & NT_CURSOR_PLACE] = entry;
	if (cursor & NT_CURSOR_SHARED) {
		nt_deferred *deferred = &fast->deferred[range][fast->deferred_count[range]++];
		deferred->vertex = vertex;
		deferred->orient = (uint32_t)orient;
		memcpy(&deferred->add, add, sizeof deferred->add);
		if (fast->wants_more)
			memcpy(&deferred->more, more, sizeof deferred->more);
		return;
	}
	add_record(&fast->records[orient][vertex], add);
	if (fast->wants_more)
		add_more(&fast->more[orient][vertex], more);
}

/* One corner, whatever its vertex is. */
static void add_corner(nt_fast *fast, unsigned range, uint32_t vertex, int orient, nt_fan_entry entry,
	const float *add, const float *more)
{
	const nt_adjacency *a = &fast->adjacency;
	uint32_t *cursor = &a->cursors[range * a->vertex_count + vertex];
	const uint32_t place = *cursor;
	*cursor = place + (place & NT_CURSOR_HUB ? 0 : NT_FAN_LANES);
	if (place >= NT_CURSOR_SHARED) {
		add_unusual(fast, range, vertex, place, orient, entry, add, more);
		return;
	}
	a->entries[place] = entry;
	add_record(&fast->records[orient][vertex], add);
	if (fast->wants_more)
		add_more(&fast->more[orient][vertex], more);
}

/* A triangle with a frame. */
static void add_triangle(nt_fast *fast, unsigned range, size_t t, int lane, const lanes_out *out)
{
	const uint32_t *v = fast->ids + 3 * t;
	const int orient = fast->flags[t] & NT_TRIANGLE_ORIENT;
	const uint32_t bit = (uint32_t)orient << 31;
	for (size_t k = 0; k < 3; k++)
		add_corner(fast, range, v[k], orient,
			(nt_fan_entry){v[(k + 1) % 3] | bit, v[(k + 2) % 3] | bit}, out->add[k] + 4 * lane,
			out->more[k] + 8 * lane);
}

/* Triangles with frames: add_triangle() with everything that does not change kept at hand. */
static void add_ordinary(nt_fast *fast, unsigned range, size_t first, size_t count, const lanes_out *out)
{
	uint32_t *const cursors = fast->adjacency.cursors + range * fast->adjacency.vertex_count;
	nt_fan_entry *const entries = fast->adjacency.entries;
	nt_record *const records[2] = {fast->records[0], fast->records[1]};
	const uint32_t *ids = fast->ids + 3 * first;
	const uint8_t *flags = fast->flags + first;
	for (size_t i = 0; i < count; i++, ids += 3) {
		const uint32_t a = ids[0], b = ids[1], c = ids[2];
		const uint32_t pa = cursors[a], pb = cursors[b], pc = cursors[c];
		const unsigned orient = flags[i] & NT_TRIANGLE_ORIENT;
		if (__builtin_expect((pa | pb | pc) >= NT_CURSOR_SHARED, 0) || fast->wants_more) {
			add_triangle(fast, range, first + i, (int)i, out);
			continue;
		}
		const uint32_t bit = orient << 31;
		cursors[a] = pa + NT_FAN_LANES;
		cursors[b] = pb + NT_FAN_LANES;
		cursors[c] = pc + NT_FAN_LANES;
		entries[pa] = (nt_fan_entry){b | bit, c | bit};
		entries[pb] = (nt_fan_entry){c | bit, a | bit};
		entries[pc] = (nt_fan_entry){a | bit, b | bit};
		nt_record *const to = records[orient];
		add_record(to + a, out->add[0] + 4 * i);
		add_record(to + b, out->add[1] + 4 * i);
		add_record(to + c, out->add[2] + 4 * i);
	}
}

/* Orientation of the record that takes note of an "any" triangle: any that exists. */
static int any_record(const nt_fast *fast, int orient)
{
	return fast->records[orient] || !fast->records[!orient] ? orient : !orient;
}

/* Adds a triangle that is degenerate (voids in the fans) or has no frame (a corner in the fans, a note in the
 * records), or is ordinary but has values that the lanes do not vouch for. */
static void __attribute__((noinline)) add_special(nt_fast *fast, unsigned range, size_t t, int lane,
	lanes_out *out)
{
	static const float zero[8] = {0};
	float note[4] = {0.0f, 0.0f, 0.0f, 2.0f + STATE_BIT(NT_STATE_ALL)};
	const uint32_t *v = fast->ids + 3 * t;
	const uint8_t flags = fast->flags[t];
	if (!(flags & (NT_TRIANGLE_DEGENERATE | NT_TRIANGLE_ANY))) {
		for (int k = 0; k < 3 && !out->sound[lane]; k++)
			out->add[k][4 * lane + 3] = 2.0f + STATE_BIT(NT_STATE_NO_ANY + NT_STATE_LOCAL);
		add_triangle(fast, range, t, lane, out);
		return;
	}
	const int orient = any_record(fast, flags & NT_TRIANGLE_ORIENT);
	if (flags & NT_TRIANGLE_DEGENERATE) {
		uint32_t *cursors = fast->adjacency.cursors + range * fast->adjacency.vertex_count;
		for (int k = 0; k < 3; k++) {
			const uint32_t place = cursors[v[k]], number = place & NT_CURSOR_PLACE;
			if (place & NT_CURSOR_HUB)
				continue;
			cursors[v[k]] = place + NT_FAN_LANES;
			fast->adjacency.entries[number] = (nt_fan_entry){NT_ENTRY_VOID | number,
				NT_ENTRY_VOID | NT_ENTRY_VOID >> 1 | number};
		}
		return;
	}
	note[3] -= STATE_BIT(NT_STATE_NO_ANY);
	for (int k = 0; k < 3; k++)
		add_corner(fast, range, v[k], orient, (nt_fan_entry){v[(k + 1) % 3], v[(k + 2) % 3]}, note,
			zero);
}

/* The orientation of a record array that these triangles need and that does not exist; -1: none. */
static int missing_record(const nt_fast *fast, size_t first, size_t count)
{
	if (fast->records[0] && fast->records[1])
		return -1;
	for (size_t i = 0; i < count; i++) {
		const uint8_t flags = fast->flags[first + i];
		int orient = flags & NT_TRIANGLE_ORIENT;
		if (flags & NT_TRIANGLE_DEGENERATE)
			continue;
		if (flags & NT_TRIANGLE_ANY)
			orient = any_record(fast, orient);
		if (!fast->records[orient])
			return orient;
	}
	return -1;
}

/* Scattered vertices: rows and cursors of the batch after the next, then, when its cursors are there, the
 * entries of the next. Always inline: to gcc 12 a function of prefetches alone has no effect, and goes. */
static inline __attribute__((always_inline)) void ask_ahead(const nt_fast *fast, unsigned range, size_t first, size_t end)
{
	const uint32_t *cursors = fast->adjacency.cursors + range * fast->adjacency.vertex_count;
	const nt_record *records = fast->records[1] ? fast->records[1] : fast->records[0];
	const size_t far = first + 2 * NT_LANES, near = first + NT_LANES;
	for (size_t i = 3 * far; i < 3 * (far + NT_LANES) && i < 3 * end; i++) {
		__builtin_prefetch(&fast->rows[fast->ids[i]]);
		__builtin_prefetch(&cursors[fast->ids[i]], 1);
		if (records)
			__builtin_prefetch(&records[fast->ids[i]], 1);
	}
	for (size_t i = 3 * near; i < 3 * (near + NT_LANES) && i < 3 * end; i++)
		__builtin_prefetch(&fast->adjacency.entries[cursors[fast->ids[i]] & NT_CURSOR_PLACE], 1);
}

static size_t accumulate(nt_fast *fast, size_t begin, size_t end, unsigned range, int *orient)
{
	lanes_in in;
	lanes_out out;
	const float offset = fast->solve->mesh->stored_v_offset;
	const float slack = offset != 0.0f ? 3 * HALF_ULP : 0.0f;
	for (size_t first = begin, count; first < end; first += count) {
		count = end - first < NT_LANES ? end - first : NT_LANES;
		if (first + count < end && (fast->flags[first + count] & NT_TRIANGLE_SECOND))
			count--; /* halves of a quad stay together */
		if (fast->scattered)
			ask_ahead(fast, range, first, end);
		gather_lanes(fast, first, count, &in);
		if (fast->wants_more)
			solve_lanes_more(&in, &out, offset, slack);
		else
			solve_lanes_plain(&in, &out, offset, slack);
		const bool ordinary = classify_lanes(fast, first, count, &in, &out);
		const int missing = missing_record(fast, first, count);
		if (missing >= 0) {
			*orient = missing;
			return first;
		}
		if (ordinary)
			add_ordinary(fast, range, first, count, &out);
		else
			for (size_t i = 0; i < count; i++)
				add_special(fast, range, first + i, (int)i, &out);
	}
	return end;
}

/* Vectors of the set's own width, for what the compiler does not make of loops. */
#if defined(__AVX512F__)
enum { WIDTH = 16 };
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#elif defined(__AVX2__)
enum { WIDTH = 8 };
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define ODD 1, 3, 5, 7, 9, 11, 13, 15
#else
enum { WIDTH = 4 };
#define EVEN 0, 2, 4, 6
#define ODD 1, 3, 5, 7
#endif
typedef uint32_t lanes __attribute__((vector_size(4 * WIDTH)));

static inline lanes load_lanes(const void *from)
{
	lanes result;
	memcpy(&result, from, sizeof result);
	return result;
}

/* The fans of WIDTH vertices by corner. */
typedef struct fans {
	lanes next[NT_FAN_DEPTH], previous[NT_FAN_DEPTH];
	lanes linked[NT_FAN_DEPTH]; /* corner i: bit j for each neighbour j of its orientation */
} fans;

/* Loads entries, voids where a vertex has fewer corners than the block is deep. */
static inline void load_fans(const nt_fan_entry *entries, uint32_t depth, lanes degree, lanes mask, fans *f)
{
	for (uint32_t k = 0; k < depth; k++, entries += NT_FAN_LANES) {
		const lanes low = load_lanes(entries), high = load_lanes(entries + WIDTH / 2);
		const lanes next = __builtin_shufflevector(low, high, EVEN) & mask;
		const lanes previous = __builtin_shufflevector(low, high, ODD) & mask;
		const lanes there = (lanes)(degree > k);
		/* above all numbers that accumulate gives to voids */
		f->next[k] = (next & there) | ((NT_ENTRY_VOID | 1u << 28 | k) & ~there);
		f->previous[k] = (previous & there) | ((NT_ENTRY_VOID | 3u << 28 | k) & ~there);
		f->linked[k] = there & 0;
	}
}

/* Links corners across shared edges. Returns all ones where a directed edge occurs twice: there pairs depend
 * on order. */
static inline lanes link_fans(uint32_t depth, fans *f)
{
	lanes doubtful = {0};
	for (uint32_t a = 0; a + 1 < depth; a++) {
		const lanes na = f->next[a], pa = f->previous[a];
		lanes linked = f->linked[a];
		for (uint32_t b = a + 1; b < depth; b++) {
			const lanes nb = f->next[b], pb = f->previous[b];
			const lanes link = (lanes)(na == pb) | (lanes)(nb == pa);
			/* compared without the orientation in bit 31 */
			doubtful |= (lanes)((na ^ nb) << 1 == 0) | (lanes)((pa ^ pb) << 1 == 0);
			linked |= link & 1u << b;
			f->linked[b] |= link & 1u << a;
		}
		f->linked[a] = linked;
	}
	return doubtful;
}

/* Counts components by elimination: a corner hands its links to the later ones it is linked with; one that
 * has none when its turn comes is the last of its component. */
static inline lanes count_fans(uint32_t depth, const fans *fan, lanes *linked)
{
	lanes count = {0};
	for (uint32_t a = 0; a < depth; a++) {
		const lanes mine = linked[a];
		for (uint32_t b = a + 1; b < depth; b++)
			linked[b] |= (lanes)((mine & 1u << b) != 0) & mine;
		const lanes last = (lanes)(mine >> a >> 1 == 0) & (lanes)((fan->next[a] & NT_ENTRY_VOID) == 0);
		count -= last;
	}
	return count;
}

/* The records of a block by component. */
typedef struct record_lanes {
	float x[NT_LANES], y[NT_LANES], z[NT_LANES];
	uint32_t state[NT_LANES]; /* then the result's */
	uint32_t present[NT_LANES];
	uint32_t sound[NT_LANES];
} record_lanes;

static void load_records(const nt_record *restrict records, size_t count, record_lanes *restrict r)
{
	nt_record copy[NT_LANES];
	if (!records || count < NT_LANES) {
		for (int i = 0; i < NT_LANES; i++)
			copy[i] = (nt_record){0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
		if (records)
			memcpy(copy, records, count * sizeof *copy);
		records = copy;
	}
	for (size_t i = 0; i < NT_LANES; i += 4) {
		nt_float4 four[4];
		memcpy(four, records + i, sizeof four);
		turn(four);
		memcpy(r->x + i, &four[0], sizeof *four);
		memcpy(r->y + i, &four[1], sizeof *four);
		memcpy(r->z + i, &four[2], sizeof *four);
		memcpy(r->state + i, &four[3], sizeof *four);
	}
	for (int i = 0; i < NT_LANES; i++) {
		const uint32_t s = r->state[i];
		r->present[i] = (s & NT_STATE_EMPTY) == 0;
		r->sound[i] = (s & NT_STATE_U) != 0 && (s & NT_STATE_V) != 0 && (s & NT_STATE_SOUND) != 0;
	}
}

static void normalise_records(record_lanes *restrict r)
{
	for (int i = 0; i < NT_LANES; i++) {
		const float x = r->x[i], y = r->y[i], z = r->z[i];
		const float scale = 1.0f / sqrtf(x * x + y * y + z * z);
		const int not_zero = (fabsf(x) > FLT_MIN) | (fabsf(y) > FLT_MIN) | (fabsf(z) > FLT_MIN);
		r->x[i] = not_zero ? scale * x : x;
		r->y[i] = not_zero ? scale * y : y;
		r->z[i] = not_zero ? scale * z : z;
	}
}

/* Settled results that judge.c would not accept. */
static size_t count_unusable(const nt_weld_row *rows, size_t count, const record_lanes *restrict r,
	const uint32_t *restrict complex)
{
	uint32_t unusable = 0;
	for (size_t i = 0; i < count; i++) {
		const float t[3] = {r->x[i], r->y[i], r->z[i]};
		const float *n = (const float *)&rows[i] + 3;
		const float squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
		const int good = (fabsf(squared - 1.0f) <= NT_UNIT_TOLERANCE) & !nt_is_parallel(t, n);
		unusable += r->present[i] & !complex[i] & !good;
	}
	return unusable;
}

static void store_records(nt_record *restrict records, size_t count, const record_lanes *restrict r)
{
	nt_record copy[NT_LANES];
	nt_record *to = count == NT_LANES ? records : copy;
	for (size_t i = 0; i < NT_LANES; i += 4) {
		nt_float4 four[4];
		memcpy(&four[0], r->x + i, sizeof *four);
		memcpy(&four[1], r->y + i, sizeof *four);
		memcpy(&four[2], r->z + i, sizeof *four);
		memcpy(&four[3], r->state + i, sizeof *four);
		turn(four);
		memcpy(to + i, four, sizeof four);
	}
	if (to == copy)
		memcpy(records, copy, count * sizeof *copy);
}

static void normalise3(float *x, float *y, float *z)
{
	if (!(fabsf(*x) > FLT_MIN || fabsf(*y) > FLT_MIN || fabsf(*z) > FLT_MIN))
		return;
	const float scale = 1.0f / sqrtf(*x * *x + *y * *y + *z * *z);
	*x = scale * *x, *y = scale * *y, *z = scale * *z;
}

static void settle_more(nt_record_more *more, size_t count, const uint32_t *present)
{
	for (size_t i = 0; i < count; i++) {
		nt_record_more *m = &more[i];
		if (!present[i]) {
			*m = (nt_record_more){.y = 1.0f, .mag_s = 1.0f, .mag_t = 1.0f};
			continue;
		}
		normalise3(&m->x, &m->y, &m->z);
		if (m->angle > 0.0f) {
			m->mag_s /= m->angle;
			m->mag_t /= m->angle;
		}
	}
}

/* Corners of the block's vertices, and which of its vertices are hubs. */
static void load_degrees(const nt_adjacency *a, size_t first, size_t count, uint32_t *restrict degree,
	uint32_t *restrict hub)
{
	const uint32_t *cursors = a->cursors + (a->ranges - 1) * a->vertex_count + first;
	const uint32_t begin = a->block_begin[first / NT_FAN_LANES];
	for (size_t i = 0; i < NT_LANES; i++) {
		const uint32_t cursor = i < count ? cursors[i] : begin;
		hub[i] = cursor >> 31;
		degree[i] = hub[i] ? 0 : ((cursor & NT_CURSOR_PLACE) - begin) / NT_FAN_LANES;
	}
}

static void settle_block(nt_fast *fast, size_t block, nt_settled *settled)
{
	const size_t first = block * NT_LANES, left = fast->vertex_count - first;
	const size_t count = left < NT_LANES ? left : NT_LANES;
	const nt_adjacency *a = &fast->adjacency;
	const uint32_t depth = (a->block_begin[block + 1] - a->block_begin[block]) / NT_FAN_LANES;
	uint32_t degree[NT_LANES], hub[NT_LANES], mask[NT_LANES], complex[NT_LANES];
	uint32_t doubtful[NT_LANES], fan_count[NT_LANES];
	record_lanes r[2];
	load_degrees(a, first, count, degree, hub);
	for (int o = 0; o < 2; o++)
		load_records(fast->records[o] ? fast->records[o] + first : NULL, count, &r[o]);

	/* "any" corners join whatever orientation there is: with one only, it need not be compared */
	for (int i = 0; i < NT_LANES; i++)
		mask[i] = r[0].present[i] & r[1].present[i] ? UINT32_MAX : NT_ENTRY_VERTEX;
	for (size_t i = 0; i < NT_LANES; i += WIDTH) {
		fans f;
		load_fans(a->entries + a->block_begin[block] + i, depth, load_lanes(degree + i),
			load_lanes(mask + i), &f);
		const lanes twice = link_fans(depth, &f), counted = count_fans(depth, &f, f.linked);
		memcpy(doubtful + i, &twice, sizeof twice);
		memcpy(fan_count + i, &counted, sizeof counted);
	}

	for (int i = 0; i < NT_LANES; i++) {
		const uint32_t both = r[0].state[i] & r[1].state[i];
		const uint32_t present = r[0].present[i] + r[1].present[i];
		const uint32_t unsound = (r[0].present[i] & !r[0].sound[i]) | (r[1].present[i] & !r[1].sound[i]);
		const uint32_t mixed = present == 2 && !(both & NT_STATE_NO_ANY);
		complex[i] = present != 0 && 0 != (unsound | mixed | hub[i] | doubtful[i] |
						     !(both & NT_STATE_LOCAL) | (fan_count[i] != present));
	}
	for (int o = 0; o < 2; o++) {
		if (!fast->records[o])
			continue;
		normalise_records(&r[o]);
		if (fast->solve->vouched)
			settled->unusable_count += count_unusable(fast->rows + first, count, &r[o], complex);
		const uint32_t sign = o ? NT_RESULT_PLUS : NT_RESULT_MINUS;
		for (int i = 0; i < NT_LANES; i++) {
			const uint32_t none = r[0].present[i] | r[1].present[i];
			/* no group at all: the default of step 10 */
			r[o].x[i] = none ? r[o].x[i] : 1.0f;
			r[o].state[i] = complex[i] ? NT_RESULT_COMPLEX
				: r[o].present[i] ? sign : none ? NT_RESULT_NONE : NT_RESULT_MINUS;
		}
		store_records(fast->records[o] + first, count, &r[o]);
		if (fast->wants_more)
			settle_more(fast->more[o] + first, count, r[o].present);
	}
	for (size_t i = 0; i < count; i++)
		settled->complex_count += complex[i];
}

static void settle(nt_fast *fast, size_t begin, size_t end, nt_settled *settled)
{
	for (size_t block = begin; block < end; block++)
		settle_block(fast, block, settled);
}

const nt_kernels NT_KERNEL = {accumulate, settle};

/* SPDX-License-Identifier: MIT */
/*
 * 16 triangles at a time: frames (frame_lanes.h), the three corners' weighted u directions (corner_lanes.h), and what
 * holds for all of them. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_LANES_H
#define NT_TANGENT_FAST_LANES_H

#include <stdbool.h>
#include <string.h>
#include "base/vec.h"
#include "tangent/fast/corner_lanes.h"
#include "tangent/fast/frame_lanes.h"

/* Without it gcc 12 makes no vectors of the loops over lanes. */
#if WIDTH > 1
#define UNROLL_CORNERS NT_UNROLL(3)
#else
#define UNROLL_CORNERS NT_UNROLL(1)
#endif

/* Corner k of 16 triangles. */
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
		all &= (load_lanes(out->area + i) & (TWO * 2 - 1)) + WELL_INSIDE;
		lanes states = load_lanes(out->sum[0][3] + i);
		for (size_t k = 1; k < 3; k++)
			states &= load_lanes(out->sum[k][3] + i);
		all &= states << 30;
	}
	return !any_lane(~all & TWO);
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
	for (size_t i = 0; any_lane(some & (uint32_t)NT_STATE_SOUND) && i < count; i++) {
		const float u[3] = {out->u[0][i], out->u[1][i], out->u[2][i]};
		float squares = 0;
		bool along[3];
		for (size_t k = 0; k < 3; k++) {
			const float *p = in->row[k][0] + i, *n = in->row[k][3] + i;
			const float x = n[0], y = n[NT_TRIANGLES], z = n[2 * NT_TRIANGLES];
			const float part = x * u[0] + y * u[1] + z * u[2];
			along[k] = (u[0] == part * x) & (u[1] == part * y) & (u[2] == part * z);
			squares += p[0] * p[0] + p[NT_TRIANGLES] * p[NT_TRIANGLES] +
				   p[2 * NT_TRIANGLES] * p[2 * NT_TRIANGLES];
		}
		for (size_t k = 0; k < 3 && out->sound[i] && squares < MOST_RATIO; k++)
			if (along[k])
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

/* SPDX-License-Identifier: MIT */
/*
 * 16 triangles at a time: frames (frame_lanes.h), the three corners' weighted u directions (corner_lanes.h), and what
 * holds for all of them. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_LANES_H
#define NT_TANGENT_FAST_LANES_H

#include <stdbool.h>
#include <string.h>
#include "tangent/fast/corner_lanes.h"
#include "tangent/fast/frame_lanes.h"

/* Corner k of 16 triangles. */
static inline NT_ALWAYS_INLINE corner_lanes corner_of(const lanes_in *in,
	const lanes_edges *edges, lanes_out *out, int k)
{
	return (corner_lanes){.n = in->row[k] + 3, .u = out->u, .v = out->v,
		.e = edges->of[k == 2 ? 1 : 0],
		.f = edges->of[k == 0 ? 1 : 2], .turned = k == 1 ? -1.0f : 1.0f, .sum = out->sum[k],
		.extra = out->extra[k]};
}

/* Lanes [0, count), in a loop for each corner: in a single one more values are under way than there are registers. */
static inline NT_ALWAYS_INLINE void solve_lanes(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out,
	bool more, int count)
{
	if (count < WIDTH)
		NT_UNREACHABLE; /* keeps gcc 12 from warning of loops that are not entered */
	lanes_edges edges;
	NT_ALIGNED(64) float cosines[3][NT_TRIANGLES];
	EACH_LANE(count) {
		make_edges(in, &edges, i);
		solve_frames(in, &edges, out, more, i);
	}
	NT_UNROLL(3)
	for (int k = 0; k < 3; k++)
		EACH_LANE(count) find_directions(corner_of(in, &edges, out, k), cosines[k], more, i);
	NT_UNROLL(3)
	for (int k = 0; k < 3; k++)
		EACH_LANE(count) weigh_corner(corner_of(in, &edges, out, k), cosines[k], out, more, i);
	for (int k = 0; k < 3; k++)
		interleave(out->sum[k][0], NT_TRIANGLES, (size_t)count, out->add[k]);
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

/* Facts about solved lanes: so many corners' sums say whether they are plain. */
static inline void judge(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out, float offset, size_t corners,
	size_t lane_count)
{
	out->plain = corners > 0 && are_plain(out, corners, lane_count);
	if (!out->plain)
		tell_apart(in, out, (int)lane_count);
	if (offset != 0.0f)
		doubt_stored(in, out, offset, (int)lane_count);
}

static void NT_NOINLINE solve_lanes_plain(const lanes_in *NT_RESTRICT in, lanes_out *NT_RESTRICT out,
	float offset, size_t count)
{
	const size_t lane_count = whole_lanes(count);
	/* few triangles: 10 ns less without loops */
	if (lane_count == WIDTH)
		solve_lanes(in, out, false, WIDTH);
	else
		solve_lanes(in, out, false, (int)lane_count);
	judge(in, out, offset, 3, lane_count);
}

static void NT_NOINLINE solve_lanes_more(const lanes_in *in, lanes_out *out, float offset, size_t count)
{
	const size_t lane_count = whole_lanes(count);
	solve_lanes(in, out, true, (int)lane_count);
	for (int k = 0; k < 3; k++) {
		interleave(out->extra[k][0], NT_TRIANGLES, lane_count, out->more[k][0]);
		interleave(out->extra[k][4], NT_TRIANGLES, lane_count, out->more[k][1]);
	}
	judge(in, out, offset, 0, lane_count);
}

#endif

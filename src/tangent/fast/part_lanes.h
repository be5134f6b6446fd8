/* SPDX-License-Identifier: MIT */
/*
 * Sums of the members of a group that belong together with one of them, for 16 of these at a time. Members are added in
 * order, and one that a lane is parted from adds zero there, which changes no bits: a sum that begins with 0 is never
 * -0. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_PART_LANES_H
#define NT_TANGENT_FAST_PART_LANES_H

#include "tangent/fast/turn.h"

#if WIDTH > 1
typedef float float_lanes __attribute__((vector_size(4 * WIDTH)));

/* Those of a set; 0 in the others. */
static inline float_lanes floats_of(lanes set, float_lanes values)
{
	return (float_lanes)(set & (lanes)values);
}
#else
typedef float float_lanes;

static inline float_lanes floats_of(lanes set, float_lanes values)
{
	return set ? values : 0.0f;
}
#endif

/* Floats that are added up at a time: those of u alone take a third of the time of all, and the code is short. */
enum { ADDED = 3 };

/* Sums of floats [from, from + ADDED) for WIDTH lanes from `lane` on, whose directions are u and then v. */
static void add_part_lanes(const nt_corner *members, size_t count, const float directions[6][NT_LANES],
	const uint32_t own[2][NT_LANES], size_t lane, size_t from, float sums[NT_CORNER_FLOATS][NT_LANES])
{
	float_lanes d[6], sum[ADDED];
	memset(sum, 0, sizeof sum);
	for (int i = 0; i < 6; i++)
		memcpy(&d[i], &directions[i][lane], sizeof d[i]);
	const lanes first = load_lanes(own[0] + lane), own_count = load_lanes(own[1] + lane);
	for (uint32_t j = 0; j < count; j++) {
		const nt_corner *m = &members[j];
		if (m->kind == NT_CORNER_ANY)
			continue;
		const float_lanes uu = d[0] * m->u[0] + d[1] * m->u[1] + d[2] * m->u[2];
		const float_lanes vv = d[3] * m->v[0] + d[4] * m->v[1] + d[5] * m->v[2];
		const lanes together = (LANES_WHERE(uu > -1.0f) & LANES_WHERE(vv > -1.0f)) |
			LANES_WHERE(j - first < own_count);
		float floats[ADDED];
		memcpy(floats, (const char *)m + from * sizeof *floats, sizeof floats);
		NT_UNROLL(3)
		for (size_t i = 0; i < ADDED; i++) {
			/* the last float is the weight itself */
			const float weight = from + i < NT_CORNER_FLOATS - 1 ? m->angle : 1.0f;
			sum[i] += floats_of(together, weight * floats[i] - (float_lanes){0});
		}
	}
	for (size_t i = 0; i < ADDED; i++)
		memcpy(&sums[from + i][lane], &sum[i], sizeof sum[i]);
}

static void kernel_part_sums(const nt_corner *members, size_t count, const float directions[6][NT_LANES],
	const uint32_t own[2][NT_LANES], bool more, float sums[NT_CORNER_FLOATS][NT_LANES])
{
	for (size_t lane = 0; lane < NT_LANES; lane += WIDTH)
		for (size_t from = 0; from < (more ? NT_CORNER_FLOATS : ADDED); from += ADDED)
			add_part_lanes(members, count, directions, own, lane, from, sums);
}

#endif

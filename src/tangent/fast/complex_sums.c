/* SPDX-License-Identifier: MIT */
/*
 * Groups that are their sums. Where step 5 has found no more than that a vertex has several groups, and all directions
 * of an orientation within a half-space, no group splits: u alone is wanted, nothing is extreme, and a group's sum over
 * its corners is its result. So corners are solved by the arithmetic of step 4, some of several vertices at a time, and
 * added to their groups one after the other; results are made and judged as those of records are, in lanes.
 */
#include "tangent/fast/complex_sums.h"

#include <string.h>
#include "topology/corners.h"

void nt_take_sums(const nt_complex *c, nt_summed *s, size_t v, const bool done[2])
{
	const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
	if (s->count + (end - begin) > NT_SUMMED)
		nt_write_sums(c, s);
	uint8_t number[NT_FAN_DEPTH]; /* of groups, by the corners that they begin with */
	for (uint32_t i = begin; i < end; i++) {
		number[i - begin] = (uint8_t)s->group_count;
		s->group_count += c->group[i] == i && !done[(c->corners[i] & NT_COMPLEX_PLUS) != 0];
	}
	for (uint32_t i = begin; i < end; i++) {
		const uint32_t corner = c->corners[i], group = c->group[i];
		if (group == NT_NONE)
			continue;
		__builtin_prefetch(c->fast->solve->tangents + 4 * nt_complex_corner(c, corner), 1);
		s->corners[s->count] = corner;
		s->group[s->count] = number[group - begin];
		s->count += !done[(corner & NT_COMPLEX_PLUS) != 0];
	}
}

typedef uint32_t four_ids __attribute__((vector_size(16)));

/* Of four corners, by which of the pairs 01, 12, 23, 30, 02 and 13 have an edge together: the first of those that each
 * one hangs together with, two bits each, and above them which ones are first themselves. */
static const uint16_t first_of_four[64] = {
	0xfe4, 0xde0, 0xbd4, 0x9c0, 0x7a4, 0x5a0, 0x354, 0x100, 0x724, 0x520, 0x314, 0x100, 0x304, 0x100, 0x100, 0x100,
	0xbc4, 0x9c0, 0x9c0, 0x9c0, 0x304, 0x100, 0x100, 0x100, 0x304, 0x100, 0x100, 0x100, 0x304, 0x100, 0x100, 0x100,
	0x764, 0x520, 0x354, 0x100, 0x354, 0x100, 0x354, 0x100, 0x520, 0x520, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100,
	0x344, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100, 0x100,
};

static inline uint32_t count_of_four(uint32_t set)
{
	return (uint32_t)(0x4332322132212110u >> 4 * set) & 7;
}

/* One bit of each pair of four corners, as above, of each corner's orientation, and of any without a frame. */
static inline __attribute__((always_inline)) uint32_t look_at_four(const uint32_t *corners, const uint32_t *ends,
	uint32_t count)
{
	const four_ids lane = {0, 1, 2, 3}, there = (four_ids)(lane < count);
	four_ids flags, low, high;
	memcpy(&flags, corners, sizeof flags);
	memcpy(&low, ends, sizeof low);
	memcpy(&high, ends + 4, sizeof high);
	/* edges of different orientations are different; where there is no corner nothing is the same */
	flags &= there & (NT_COMPLEX_PLUS | NT_COMPLEX_ANY);
	const four_ids plus = flags << 1;
	const four_ids after = ((__builtin_shufflevector(low, high, 0, 2, 4, 6) | plus) & there) | (~there & ~lane);
	const four_ids before =
		((__builtin_shufflevector(low, high, 1, 3, 5, 7) | plus) & there) | (~there & ~(lane + 4));
	const four_ids one = (four_ids)(after == __builtin_shufflevector(before, before, 1, 2, 3, 0)) |
			     (four_ids)(before == __builtin_shufflevector(after, after, 1, 2, 3, 0));
	const four_ids two = (four_ids)(after == __builtin_shufflevector(before, before, 2, 3, 0, 1)) |
			     (four_ids)(before == __builtin_shufflevector(after, after, 2, 3, 0, 1));
	const four_ids bits = (one & (four_ids){1, 2, 4, 8}) | (two & (four_ids){16, 32, 0, 0}) |
			      ((four_ids)(plus != 0) & (four_ids){64, 128, 256, 512}) | (flags & NT_COMPLEX_ANY);
	uint64_t halves[2];
	memcpy(halves, &bits, sizeof halves);
	halves[0] |= halves[1];
	return (uint32_t)(halves[0] | halves[0] >> 32);
}

bool nt_take_four(const nt_complex *c, nt_summed *s, size_t v)
{
	const uint32_t begin = nt_first_place(c, v), count = nt_first_place(c, v + 1) - begin;
	const uint32_t *corners = c->corners + begin, bits = look_at_four(corners, c->across + 2 * begin, count);
	if (bits & NT_COMPLEX_ANY)
		return false;
	const uint32_t first = first_of_four[bits % 64], all = ((uint32_t)1 << count) - 1, plus = bits >> 6;
	/* an orientation of one group is done */
	const uint32_t begins = first >> 8 & all, minus_begins = begins & ~plus, plus_begins = begins & plus;
	const uint32_t kept =
		all & ((minus_begins & (minus_begins - 1) ? ~plus : 0) | (plus_begins & (plus_begins - 1) ? plus : 0));
	if (kept == 0)
		return true;
	if (s->count + 4 > NT_SUMMED)
		nt_write_sums(c, s);
	for (uint32_t i = 0; i < 4; i++) {
		const uint32_t before = ((uint32_t)1 << (first >> 2 * i & 3)) - 1;
		s->corners[s->count] = corners[i];
		s->group[s->count] = (uint8_t)(s->group_count + count_of_four(begins & kept & before));
		s->count += kept >> i & 1;
	}
	s->group_count += count_of_four(begins & kept);
	return true;
}

void nt_load_rows(const nt_complex *c, const uint32_t *corners, size_t count, nt_weld_row *rows)
{
	/* copies, which no store to a row may change */
	const nmtan_mesh mesh = *c->fast->solve->mesh;
	const nt_triangles triangles = c->fast->triangles;
	for (size_t i = 0; i < count; i++) {
		const size_t t = (corners[i] & NT_COMPLEX_CORNER) >> 2;
#pragma GCC unroll 3
		for (unsigned k = 0; k < 3; k++)
			nt_weld_load(&mesh, nt_vertex_of(&mesh, nt_triangle_corner(&triangles, t, k)),
				&rows[3 * i + k]);
	}
}

void nt_write_sums(const nt_complex *c, nt_summed *s)
{
	nt_weld_row rows[3 * NT_SUMMED];
	nt_record add[NT_SUMMED], sums[NT_SUMMED];
	uint32_t vertices[NT_SUMMED];
	uint32_t signs[NT_SUMMED];
	nt_load_rows(c, s->corners, s->count, rows);
	c->kernels->corner_sums(rows, s->corners, s->count, add);
	/* lanes behind the last group, too */
	for (size_t g = 0; g < (s->group_count + NT_LANES - 1) / NT_LANES * NT_LANES; g++)
		sums[g] = (nt_record){0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
	for (uint32_t i = 0; i < s->count; i++) {
		const uint32_t corner = s->corners[i], group = s->group[i];
		nt_int4 sum;
		memcpy(&sum, &add[i], sizeof sum);
		if (!(corner & NT_COMPLEX_ANY))
			nt_record_add(&sums[group], sum);
		vertices[group] = 3 * i + (corner & 3);
		signs[group] = corner & NT_COMPLEX_PLUS ? 0 : NT_RESULT_PLUS ^ NT_RESULT_MINUS;
	}
	c->kernels->group_results(rows, vertices, s->group_count, sums);
	const bool judges = nt_fast_judges(c->fast->solve);
	for (size_t g = 0; g < s->group_count; g++) {
		if (judges && (sums[g].state & NT_RESULT_UNUSABLE))
			nt_fast_tell_open(c->fast->solve);
		sums[g].state = (sums[g].state & (judges ? ~0u : ~NT_RESULT_UNUSABLE)) | signs[g];
	}
	for (size_t i = 0; i < s->count; i++)
		memcpy(c->fast->solve->tangents + 4 * nt_complex_corner(c, s->corners[i]), &sums[s->group[i]],
			sizeof *sums);
	s->count = s->group_count = 0;
}

/* SPDX-License-Identifier: MIT */
/*
 * The flags of 16 triangles (parts.h), of their frames: orientation, "any", degenerate, uncertain. Included by
 * kernel.h.
 */
#ifndef NT_TANGENT_FAST_FLAG_LANES_H
#define NT_TANGENT_FAST_FLAG_LANES_H

#include <math.h>
#include <stdbool.h>
#include "tangent/fast/lanes.h"

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

/* Clears triangles whose UV area is exactly 0, whatever is rounded and as stored too: two texture coordinates are the
 * same, or all lie along an axis. Others stay uncertain. */
static void NT_NOINLINE clear_flat(const lanes_in *in, uint8_t *flags, size_t count)
{
	const float (*a)[NT_TRIANGLES] = in->row[0] + 6, (*b)[NT_TRIANGLES] = in->row[1] + 6,
		(*c)[NT_TRIANGLES] = in->row[2] + 6;
	for (size_t i = 0; i < count; i++) {
		const int ab_u = a[0][i] == b[0][i], ac_u = a[0][i] == c[0][i], bc_u = b[0][i] == c[0][i];
		const int ab_v = a[1][i] == b[1][i], ac_v = a[1][i] == c[1][i], bc_v = b[1][i] == c[1][i];
		const int flat = (ab_u & ab_v) | (ac_u & ac_v) | (bc_u & bc_v) | (ab_u & ac_u) | (ab_v & ac_v);
		flags[i] &= (uint8_t)~(flat ? NT_TRIANGLE_UNCERTAIN : 0);
	}
}

/* Flags of lanes that are not plain; true where all of them are ordinary triangles with a frame. */
static bool NT_NOINLINE classify_special(uint8_t *flags, size_t count, const lanes_in *in,
	const lanes_out *out)
{
	int special = 0;
	for (size_t i = 0; i < count; i++)
		special |= out->degenerate[i] | !out->sound[i];
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) | (out->area[i] > 0.0f ? NT_TRIANGLE_ORIENT : 0) |
				     (out->frameless[i] ? NT_TRIANGLE_ANY : 0) |
				     (out->degenerate[i] ? NT_TRIANGLE_DEGENERATE : 0) |
				     (out->doubt[i] < 0.0f && !out->frameless[i] ? 0 : NT_TRIANGLE_UNCERTAIN));
	if (special)
		clear_flat(in, flags, count);
	return !special;
}

static inline NT_ALWAYS_INLINE void classify_plain(uint8_t *NT_RESTRICT flags, size_t count,
	const lanes_out *NT_RESTRICT out)
{
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) |
			(bits_of(out->area[i]) >> 31 ^ NT_TRIANGLE_ORIENT) |
				     (~bits_of(out->doubt[i]) >> 24 & NT_TRIANGLE_UNCERTAIN));
}

/* Flags of the lanes; true where all of them are ordinary triangles with a frame. */
static inline bool classify_lanes(const nt_fast *fast, size_t first, size_t count, const lanes_in *in,
	const lanes_out *out)
{
	uint8_t *flags = fast->flags + first;
	bool ordinary = out->plain;
	if (!ordinary)
		ordinary = classify_special(flags, count, in, out);
	else if (count == NT_TRIANGLES)
		classify_plain(flags, NT_TRIANGLES, out);
	else
		classify_plain(flags, count, out);
	if (fast->triangles.cuts)
		orient_quads(flags, count, out->area);
	return ordinary;
}

#endif

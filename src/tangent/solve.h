/* SPDX-License-Identifier: MIT */
/*
 * Input and output of every method. The entry point (tangents.c) has checked the mesh: pointers, sizes
 * and indices are sound, strides are filled in, face_count is not 0, limits are kept.
 */
#ifndef NT_TANGENT_SOLVE_H
#define NT_TANGENT_SOLVE_H

#include <stdbool.h>
#include <string.h>
#include "base/compiler.h"
#include "base/cpu.h"
#include "base/scratch.h"
#include "nmtan.h"

/* A method's knowledge of its result, so that usable.c need not look at all of it. `flags` has a byte for each
 * triangle, two for a quad; what its bits mean is told by these sets of bits, of which each may be empty:
 *
 *   suspect     The triangle has to be looked at. Without these bits all its corners are usable, it is not degenerate
 *               and no half of a folded quad, and its orientation is exact and survives storing.
 *   positive    Its orientation is +1, else -1.
 *   doubtful    Some of `suspect`: its orientation is not known. Without these bits it is: 0 with a bit of `flat`,
 *               else as `positive` says.
 *   flat        Its UVs have no area.
 *   degenerate  Two of its corners are at one position; told of suspects that are not doubtful.
 *   judged      Some of `suspect`: they say no more of the triangle than that rows may have NT_W_OPEN. If there are
 *               such bits, rows without NT_W_OPEN are usable by all but w.
 *
 * With ids the rows of triangles that are no suspects may not have been written: the tangent of such a corner is that
 * of its vertex and its triangle's orientation. Meshes with quads have no ids. */
typedef struct nt_known {
	const uint8_t *flags; /* [triangle_count]; NULL: nothing is known */
	uint8_t suspect, positive, doubtful, flat, degenerate, judged;
	bool open;            /* a row may have NT_W_OPEN, which needs `judged`; set by any thread */
	const uint32_t *ids;  /* [corner_count] welded vertices, or NULL */
	const float *rows[2]; /* [welded_count][4] by orientation, w = 0 where no triangle at the vertex
	                         has it; NULL: none at all. Told with ids */
	size_t row_step;      /* floats from one row to the next */
	const uint32_t *welded; /* [corner_count] welded vertices, below welded_count, whatever else is
	                           known; NULL: ask nt_weld_corners() */
	size_t welded_count;
	bool all_flat;        /* the UVs of all triangles have exactly no area: no corner has a tangent, and what
	                         repair writes has not been written */
} nt_known;

/* In the lowest bit of a row's w, where the solve repairs: whether the row is usable has to be looked up, and then the
 * bit is taken away. No w of a result has it. */
#define NT_W_OPEN 1u

/* Whether its flags tell the exact orientation of triangle t, and which one it is. */
static inline bool nt_knows_orientation(const nt_known *known, size_t t, int *orientation)
{
	if (!known || !known->flags || known->flags[t] & known->doubtful)
		return false;
	*orientation = known->flags[t] & known->flat ? 0 : known->flags[t] & known->positive ? 1 : -1;
	return true;
}

/* The next of `count` flags from t on that has a bit of `mask`; count: none. Eight at a time, since most have none. */
static inline size_t nt_next_flagged(const uint8_t *flags, size_t t, size_t count, unsigned mask)
{
	for (uint64_t eight; count - t >= sizeof eight; t += sizeof eight) {
		memcpy(&eight, flags + t, sizeof eight);
		eight &= 0x0101010101010101u * mask;
		if (eight)
			break;
	}
	while (t < count && !(flags[t] & mask))
		t++;
	return t;
}

/* A bit for each of `count` flags, at most 64, that has a bit of `mask`; `neither` receives how many have
 * none of `mask` nor the bit `other`, which is not in it. Eight at a time: what a byte has of a mask becomes its lowest
 * bit, and products gather these, or add them up. */
static inline uint64_t nt_flagged(const uint8_t *flags, size_t count, uint8_t mask, uint8_t other, size_t *neither)
{
	const uint64_t ones = 0x0101010101010101u, low = 0x7f7f7f7f7f7f7f7fu;
	/* moves the lowest bit of byte i, in the order of memory, to bit i of the highest byte */
	const uint64_t gather = NT_BIG_ENDIAN ? 0x8040201008040201u : 0x0102040810204080u;
	uint64_t flagged = 0, plain = 0;
	size_t i = 0;
	for (uint64_t eight; i + sizeof eight <= count; i += sizeof eight) {
		memcpy(&eight, flags + i, sizeof eight);
		uint64_t has = eight & ones * mask, any = eight & ones * (mask | other);
		has = (((has & low) + low) | has) >> 7 & ones;
		any = (((any & low) + low) | any) >> 7 & ones;
		flagged |= (has * gather >> 56) << i;
		plain += ones - any;
	}
	*neither = plain * ones >> 56;
	for (; i < count; i++) {
		flagged |= (uint64_t)((flags[i] & mask) != 0) << i;
		*neither += !(flags[i] & (mask | other));
	}
	return flagged;
}

typedef struct nt_solve {
	const nmtan_mesh *mesh;  /* strides are never 0 */
	size_t corner_count;
	float threshold_cos;     /* (float)cos of the angular threshold; -1 for 180 degrees */
	unsigned threads;        /* at least 1 */
	nt_isa isa;           /* never AUTO */
	bool sorted;             /* MikkTSpace: the sort of edges is completed; else as published */
	bool one_by_one;         /* sums: each triangle by the definition in frames.c */
	nt_scratch *scratch;
	nmtan_timing *timing;    /* to be added to, or NULL */
	nt_known *known;         /* for the method to fill; empty before; may be NULL */
	bool repair;             /* a corner that no triangle gives a tangent gets w = 0 for usable.c to find; else
	                            MikkTSpace's placeholder (1, 0, 0) with w = -1 */
	bool sparse;             /* rows that known.ids stands for need not be written; not with quads */
	/* Memory that is filled or let go of after the method is done: it may serve as scratch. */
	void *spare;
	size_t spare_bytes;
	float *tangents;         /* [corner_count][4] */
	float *bitangents;       /* [corner_count][3] or NULL */
	float *magnitudes;       /* [corner_count][2] or NULL */
	uint8_t *faults;         /* [corner_count] bits of nmtan_fault are added, or NULL */
	size_t *summed_instead;  /* corners past the bound of fast/complex_solve.c are added to it; or NULL */
	bool *sorted_instead;    /* set where MikkTSpace is sorted because of a limit, not by `sorted`; or NULL */
} nt_solve;

/* The w of a corner that no triangle gave a tangent. */
static inline float nt_unassigned_sign(const nt_solve *solve)
{
	return solve->repair ? 0.0f : -1.0f;
}

/* The tangent of corner c of triangle c / 3, in its row or shared; of quads in its row. */
static inline const float *nt_corner_tangent(const nt_solve *solve, size_t c)
{
	const nt_known *v = solve->known;
	if (!v || !v->ids || v->flags[c / 3] & v->suspect)
		return solve->tangents + 4 * c;
	return v->rows[(v->flags[c / 3] & v->positive) != 0] + v->row_step * v->ids[c];
}

/* The definition: one step after the other, as the specification has them, for any mesh. */
nmtan_status nt_mikktspace_scalar(const nt_solve *solve);

#endif

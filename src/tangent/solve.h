/* SPDX-License-Identifier: MIT */
/*
 * What every method gets and gives. The entry point (tangents.c) has checked the mesh: pointers, sizes
 * and indices are sound, strides are filled in, face_count is not 0, limits are kept.
 */
#ifndef NT_TANGENT_SOLVE_H
#define NT_TANGENT_SOLVE_H

#include <stdbool.h>
#include "base/cpu.h"
#include "base/scratch.h"
#include "nmtan.h"

/* Ways of their own for meshes that are rare, and which come to the same, are not worth their bytes in a browser. */
#ifdef __wasm__
enum { NT_SHORT_WAYS = 0 };
#else
enum { NT_SHORT_WAYS = 1 };
#endif

/* What a method knows of its result, so that usable.c need not look at all of it. Of a triangle without a bit of
 * `suspect` all corners are usable, it is not degenerate, no half of a folded quad, and its orientation, positive
 * where a bit of `positive` is set, is exact and survives storing.
 *
 * With ids the rows of triangles without a bit of `suspect` may not have been written: the tangent of
 * such a corner is that of its vertex and its triangle's orientation. Meshes with quads have no ids. */
typedef struct nt_known {
	const uint8_t *flags; /* [triangle_count], quads count as two; NULL: nothing is known */
	uint8_t suspect, positive;
	uint8_t doubtful;     /* bits of `suspect` without which the orientation is known all the same, and that the
	                         triangle is not degenerate */
	const uint32_t *ids;  /* [corner_count] welded vertices, or NULL */
	const float *rows[2]; /* [vertex count][4] by orientation, w = 0 where no triangle at the vertex
	                         has it; NULL: none at all */
	size_t row_step;      /* floats from one row to the next */
	bool around;          /* where a corner is unusable by more than its sign, all triangles at its vertex are suspects */
	const uint32_t *welded; /* [corner_count] welded vertices, below welded_count, whatever else is
	                           known; NULL: ask nt_weld_corners() */
	size_t welded_count;
} nt_known;

/* The exact orientation of triangle t, where its flags tell it; 0: they do not. */
static inline int nt_known_orientation(const nt_known *known, size_t t)
{
	if (!known || !known->flags || known->flags[t] & known->doubtful)
		return 0;
	return known->flags[t] & known->positive ? 1 : -1;
}

/* Parts of a mesh in the order in which a solve is done with them. */
typedef enum nt_mesh_part { NT_PART_ATTRIBUTES, NT_PART_INDICES } nt_mesh_part;

typedef struct nt_solve {
	const nmtan_mesh *mesh;  /* strides are never 0 */
	size_t corner_count;
	float threshold_cos;     /* (float)cos of the angular threshold; -1 for 180 degrees */
	unsigned threads;        /* at least 1 */
	nt_isa isa;           /* never AUTO */
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
	/* Called when a part of the mesh will hardly be read again; may be NULL. */
	void (*passed)(void *user, nt_mesh_part part);
	void *user;
	float *tangents;         /* [corner_count][4] */
	float *bitangents;       /* [corner_count][3] or NULL */
	float *magnitudes;       /* [corner_count][2] or NULL */
	uint8_t *faults;         /* [corner_count] bits of nmtan_fault are added, or NULL */
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

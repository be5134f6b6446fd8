/* SPDX-License-Identifier: MIT */
/*
 * Shared by sums.c, its passes for one instruction set (kernel.h) and hard.c.
 */
#ifndef NT_TANGENT_SUMS_PARTS_H
#define NT_TANGENT_SUMS_PARTS_H

#include "tangent/frames.h"
#include "topology/weld.h"

enum { NT_SUM_LANES = 16 };

/* The sum at a welded vertex over the triangles of one orientation: nt_frame_sum as far as it is needed. */
typedef struct nt_vertex_sum {
	double x, y, z, sensitivity;
} nt_vertex_sum;

/* The result: the tangent as it is written, or zero for repair to fill; w is 0 where no triangle of the
 * orientation has weight. */
typedef struct nt_vertex_tangent {
	float x, y, z, w;
} nt_vertex_tangent;

/* Bits of nt_sums.flags, by triangle */
enum {
	NT_SUM_POSITIVE = 1, /* its face's orientation is +1 */
	NT_SUM_NONE = 2,     /* its face has no orientation */
	NT_SUM_SUSPECT = 4,  /* the check for unusable tangents looks at it */
	NT_SUM_SECOND = NT_SECOND_HALF
};

/* Bits of nt_sums.vertex_flags; shifted by one for orientation +1 */
enum {
	NT_VERTEX_MET = 1,  /* some triangle has weight here */
	NT_VERTEX_LOST = 4, /* and yet the result is zero */
	NT_VERTEX_ILL = 16  /* more than 24 bits cancel */
};

/* A contribution that has to wait for an earlier range's. */
typedef struct nt_later {
	nt_vertex_sum *to;
	nt_vertex_sum add;
} nt_later;

/* Contributions and kinds of 16 triangles. */
typedef struct nt_sum_block {
	NT_ALIGNED(64) double add[3][4][NT_SUM_LANES]; /* corner, double of its nt_vertex_sum */
	double sign[NT_SUM_LANES];      /* exact orientation; only where not hard */
	/* flags, 0 or not */
	double plain[NT_SUM_LANES];     /* has area in space and UV, and weight at each corner */
	double hard[NT_SUM_LANES];      /* nothing is known: frames.c must do it */
	double certain[NT_SUM_LANES];   /* the sign is that of the stored coordinates too */
} nt_sum_block;

typedef struct nt_sums {
	const nt_solve *solve;
	nt_weight weight;
	bool one_by_one;               /* all triangles are hard */
	nt_weld weld;
	size_t triangle_count;
	nt_triangles triangles;        /* of welded vertices */
	uint8_t *flags;                /* [triangle_count] */
	nt_vertex_sum *sums[2];        /* [weld.count] for orientation -1 and +1; NULL: not needed */
	nt_vertex_tangent *results[2]; /* the same */
	uint8_t *vertex_flags;         /* [weld.count] */
	bool scattered;                /* neighbouring triangles have vertices far apart: prefetch */
	nt_triangle_ranges ranges;
	uint16_t *owners;              /* [weld.count] the first range that touches the vertex */
	nt_later **later;              /* [ranges.count] */
	size_t *later_counts;          /* [ranges.count] */
} nt_sums;

typedef struct nt_sums_finished {
	size_t lost, ill; /* vertices */
} nt_sums_finished;

/* The passes of one instruction set. */
typedef struct nt_sum_kernels {
	/* Adds triangles [begin, end) of a range to the sums of their vertices, in order. Stops before triangles
	 * that need sums that do not exist, and returns the first of them and in *side which; otherwise end. */
	size_t (*accumulate)(nt_sums *s, size_t begin, size_t end, unsigned range, int *side);
	/* Turns the sums of blocks [begin, end) of 16 vertices into results. */
	void (*finish)(const nt_sums *s, size_t begin, size_t end, nt_sums_finished *finished);
} nt_sum_kernels;

extern const nt_sum_kernels nt_sum_kernels_baseline;
#if defined(__x86_64__)
extern const nt_sum_kernels nt_sum_kernels_avx2, nt_sum_kernels_avx512;
#endif

/* Corner i % 3 of triangle i / 3: the mesh's number of it, and its vertex. */
static inline size_t nt_sums_corner(const nt_sums *s, size_t i)
{
	return s->triangles.cuts ? nt_triangle_corner(&s->triangles, i / 3, i % 3) : i;
}

static inline uint32_t nt_sums_vertex(const nt_sums *s, size_t i)
{
	return s->triangles.ids[nt_sums_corner(s, i)];
}

/* Triangles that go by the definition in frames.c, one by one: hard.c */

/* Does triangle t by the definition: its lane of the block, and its sign. */
void nt_sums_do_hard(const nt_sums *s, size_t t, int lane, nt_sum_block *block);

/* A second look at vertices that are ill-conditioned by what kernels add up, which takes all errors for errors across
 * the sum: NT_VERTEX_ILL goes where what can move the direction is within bounds, and sensitivities are less by the
 * rest. That is no more than 1e10 times the sum, or the result is lost, so that what is left is good. Before results
 * are written. */
void nt_sums_judge_ill(const nt_sums *s);

/* Flags of the face of triangle t, two triangles for a quad, by the exact sign of what is stored. */
void nt_sums_orient(const nt_sums *s, size_t t);

#endif

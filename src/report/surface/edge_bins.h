/* SPDX-License-Identifier: MIT */
/*
 * The edges of a surface, a bin after the other: those whose lower point lies in a range of points. In a bin
 * edges are ordered by their lower point, then the higher one, and on each its sides, ascending.
 */
#ifndef NT_REPORT_EDGE_BINS_H
#define NT_REPORT_EDGE_BINS_H

#include "report/surface/surface.h"

/* A side as a bin lists it. */
typedef struct nt_edge_side {
	uint32_t side;
	uint32_t high; /* the edge's higher point */
	uint32_t low;  /* the lower one, counted from the bin's first, above NT_EDGE_FLAGS bits */
} nt_edge_side;

/* Below the lower point: 1 + orientation of the triangle; whether the side runs from the lower point to the higher
 * one; whether one of the points is a joint. */
enum { NT_EDGE_ORIENTATION = 3, NT_EDGE_ASCENDING = 4, NT_EDGE_JOINT = 8, NT_EDGE_FLAGS = 4 };

static inline int nt_edge_orientation(const nt_edge_side *side)
{
	return (int)(side->low & NT_EDGE_ORIENTATION) - 1;
}

/* Whether two sides of one edge begin at the same point. */
static inline bool nt_edge_same_way(const nt_edge_side *a, const nt_edge_side *b)
{
	return !((a->low ^ b->low) & NT_EDGE_ASCENDING);
}

static inline bool nt_edge_same(const nt_edge_side *a, const nt_edge_side *b)
{
	return a->high == b->high && a->low >> NT_EDGE_FLAGS == b->low >> NT_EDGE_FLAGS;
}

typedef struct nt_edge_bins {
	const nt_surface *surface;
	unsigned threads;
	size_t count;      /* of bins: the same for any number of threads */
	unsigned bits;     /* a bin has 1 << bits points */
	unsigned slots;
	uint32_t *counts;  /* [slots][count] sides that a range of triangles has in a bin */
	size_t *totals;    /* [count] the same of all ranges */
} nt_edge_bins;

/* Counts the sides of each bin. All is in scratch. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_edge_bins_make(nt_edge_bins *bins, const nt_surface *surface, unsigned threads, nt_scratch *scratch);

/* Calls visit once for each bin, several at a time: calls with one `slot`, which is below `slots`, never run beside
 * each other. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_edge_bins_visit(const nt_edge_bins *bins, nt_scratch *scratch,
	void (*visit)(void *context, size_t bin, const nt_edge_side *sides, size_t count, unsigned slot),
	void *context);

#endif

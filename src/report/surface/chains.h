/* SPDX-License-Identifier: MIT */
/*
 * Marked edges of a surface in walking order: closed loops and open chains.
 */
#ifndef NT_REPORT_CHAINS_H
#define NT_REPORT_CHAINS_H

#include "report/surface/surface.h"

/* Chain i has the sides sides[first[i]] to sides[first[i + 1] - 1], one for each edge. A chain walks from
 * one edge to the next across the point they share; reversed[s] says that sides[s] is walked against its
 * own direction. */
typedef struct nt_chains {
	size_t count;
	size_t *first; /* [count + 1] */
	bool *closed;  /* [count] */
	uint32_t *sides;
	bool *reversed;
	size_t left_out; /* triangles that OpenMesh could not take */
} nt_chains;

/* Edges of a surface, each known by one of its sides. */
typedef struct nt_marks {
	const uint64_t *sides;   /* [3 * triangle_count] bits */
	const uint64_t *against; /* [3 * triangle_count] bits: of these, sides that run against the lowest one of their
	                            edge; NULL: there are none */
	size_t count;
	bool conflicts;          /* somewhere triangles use an edge in one direction, or more than two share one */
} nt_marks;

/*
 * Puts marked edges in order. Chains are as long as possible without passing a junction, a point where
 * more than two marked edges meet (unless in fans that have only this point in common); they are ordered by
 * their lowest side.
 *
 * Everything is in scratch. Returns NT_OK, NT_ERROR_MEMORY, or NT_ERROR_MODULE and what else opening a module comes to.
 */
nt_status nt_chains_trace(const nt_surface *surface, const nt_marks *marks, nt_scratch *scratch, nt_chains *chains,
	nt_error *error);

#endif

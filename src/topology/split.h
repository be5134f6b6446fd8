/* SPDX-License-Identifier: MIT */
/*
 * Splitting one corner at a time, for callers that have tangents in another form than one row a corner.
 */
#ifndef NT_TOPOLOGY_SPLIT_H
#define NT_TOPOLOGY_SPLIT_H

#include <stdbool.h>
#include <string.h>
#include "base/hash.h"
#include "base/scratch.h"
#include "nmtan.h"

/* The bits of a tangent's four floats, -0 made +0 and all NaN one: equal floats have equal bits. */
typedef struct nt_tangent_key {
	uint32_t bits[4];
} nt_tangent_key;

/* A copy of a vertex and the tangent it was made for. */
typedef struct nt_vertex_copy {
	uint32_t original;
	nt_tangent_key tangent;
} nt_vertex_copy;

enum { NT_SEEN_SPLIT = 128 }; /* in nt_splitter.seen: the vertex has a copy */

typedef struct nt_splitter {
	const nmtan_mesh *mesh; /* strides are filled in, indices checked */
	nmtan_split_output *output;
	nt_scratch *scratch;
	size_t corner_count;
	unsigned threads;       /* that copy the indices; 0 is 1 */
	bool lazy;              /* output->indices is left alone when no vertex is split */
	bool indexed;           /* output->indices holds the mesh's indices */
	float *tangents;        /* [vertex_count][4] of the vertices' first corners */
	uint8_t *seen;          /* [vertex_count] not 0: tangents is set */
	nt_vertex_copy *copies; /* [copy_capacity] */
	size_t copy_count, copy_capacity;
	uint64_t key[NT_HASH_KEY_WORDS];
	uint32_t *table;        /* [table_size] numbers of copies; at most half full */
	size_t table_size;
} nt_splitter;

/* Begins a split. mesh and output stay the caller's. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_splitter_begin(nt_splitter *s, const nmtan_mesh *mesh, size_t corner_count,
	nmtan_split_output *output, nt_scratch *scratch);

/* The rest of nt_splitter_take: a tangent that does not have the bits of the vertex's first one. The first
 * that differs makes output->indices a copy of the mesh's. */
nmtan_status nt_splitter_differs(nt_splitter *s, uint32_t vertex, const float *tangent, size_t corner);

/* By words: memcmp() is a loop over bytes in WebAssembly. */
static inline bool nt_same_bits(const void *a, const void *b)
{
	uint64_t x[2], y[2];
	memcpy(x, a, sizeof x);
	memcpy(y, b, sizeof y);
	return ((x[0] ^ y[0]) | (x[1] ^ y[1])) == 0;
}

/* The next corner in order, of that vertex, has this tangent. Corners whose vertex is known to have one
 * tangent only may be left out once that is in `tangents` and `seen`. Copies past
 * source_capacity are only counted. Returns NMTAN_OK, NMTAN_ERROR_MEMORY or NMTAN_ERROR_TOO_LARGE. */
static inline nmtan_status nt_splitter_take(nt_splitter *s, uint32_t vertex, const float *tangent,
	size_t corner)
{
	float *first = s->tangents + 4 * (size_t)vertex;
	if (!s->seen[vertex]) {
		s->seen[vertex] = 1;
		memcpy(first, tangent, 4 * sizeof(float));
	} else if (!nt_same_bits(first, tangent)) {
		return nt_splitter_differs(s, vertex, tangent, corner);
	}
	return NMTAN_OK;
}

/* Ends a split: the count of copies, the tangents of vertices without corners, and the indices unless
 * `lazy`. */
void nt_splitter_end(nt_splitter *s);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Shared by the passes of the fast path alone. fast.c is the recipe and explains the words; kernel.h holds
 * the passes that are compiled once for each instruction set; complex.c solves the vertices that need groups.
 *
 * A vertex here is a welded vertex.
 */
#ifndef NT_TANGENT_FAST_PARTS_H
#define NT_TANGENT_FAST_PARTS_H

#include <string.h>
#include "tangent/fast/bins.h"
#include "tangent/solve.h"
#include "topology/adjacency.h"
#include "topology/edge_sort.h"
#include "topology/weld.h"

/* Counts of vertices and of single corners; and of triangles, of which the widest vectors hold half: what one half
 * waits for the other computes meanwhile (6 % of a solve). */
enum { NT_LANES = 16, NT_TRIANGLES = 32 };

/* Bits of nt_fast.flags */
enum {
	NT_TRIANGLE_ORIENT = 1,     /* UV determinant positive (after a quad's halves agreed) */
	NT_TRIANGLE_ANY = 2,        /* no frame: joins groups of any orientation */
	NT_TRIANGLE_DEGENERATE = NT_DEGENERATE, /* two corners at one position: takes no part */
	NT_TRIANGLE_SECOND = NT_SECOND_HALF,
	NT_TRIANGLE_COMPLEX = 16,   /* has a corner at a complex vertex, or one whose result is not usable */
	NT_TRIANGLE_COPY = 32,      /* degenerate, and copies corners that are written later */
	NT_TRIANGLE_DECIDED = 64,   /* "any", and a group has a corner of it: ORIENT is that group's */
	NT_TRIANGLE_UNCERTAIN = 128 /* the exact orientation, as stored too, may differ; of an "any" triangle: from 0 */
};

/* Contributions of a range that have to wait for earlier ranges'. Each has a cache line of its own, which no other
 * thread writes to. */
typedef struct nt_deferred {
	NT_ALIGNED(64) uint32_t *to; /* vertices, with NT_ENTRY_ORIENT; one more than can be counted may be written */
	nt_record *add;
	nt_record_more *more; /* or NULL */
	size_t count, swept; /* in all; in the first of two sweeps */
} nt_deferred;

typedef struct nt_fast {
	const nt_solve *solve;
	nt_triangles triangles;  /* of welded vertices */
	size_t triangle_count;
	const nt_weld_row *rows; /* [vertex_count] */
	size_t vertex_count;
	uint8_t *flags;          /* [triangle_count] */
	nt_adjacency adjacency;
	nt_record *records[2];       /* for orientation false and true, see nt_fast_record(); NULL: not needed */
	size_t record_step;          /* from one vertex to the next */
	nt_record_more *more[2];     /* [vertex_count] the same for the optional outputs */
	bool wants_more;
	bool sparse;             /* step 6 leaves out corners whose result is their record */
	uint8_t *open;           /* [blocks] of NT_LANES vertices, of a sparse solve: whether a record is not the
	                            result, or not usable */
	bool scattered;          /* neighbouring triangles have vertices far apart: prefetch */
	nt_bins bins;            /* of a scattered mesh: its corners on their way to the records */
	nt_edge_tail *tail;      /* what step 4 notes of the last triangles */
	nt_unsorted unsorted;    /* edges that are not paired as a vertex's corners alone would have it */
	nt_triangle_ranges ranges;
	unsigned sweep;              /* of step 4 */
	nt_deferred *deferred;       /* [ranges]; NULL: nothing has to wait */
	void *small;                 /* of small.c */
	const nt_row_box *box;       /* of all rows; NULL: not known */
	uint64_t work;           /* of large groups that may split, so far: complex_solve.c */
} nt_fast;

/* How many vertices are complex, with how many corners at most; of them those that are tangled, and most corners of one
 * of these. */
typedef struct nt_settled {
	size_t complex_count, complex_corners, tangled_count, tangled_corners, most_tangled;
} nt_settled;

/* Makes fast->records[orient], which a triangle of a range needs and which does not exist; false: it cannot be had. */
typedef bool nt_record_maker(nt_fast *fast, int orient, unsigned range, void *context);

/* The contribution of a corner to its group. */
typedef struct nt_corner {
	float u[3], mag_s, v[3], mag_t; /* unit directions perpendicular to the normal, magnitudes */
	float angle;                    /* the weight */
	uint32_t kind;
} nt_corner;

/* nt_corner.kind: u and v have length 1 up to 1e-5; they may not; there is no frame, and no value means anything; a
 * result is the sum of a group that may split. */
enum { NT_CORNER_UNIT, NT_CORNER_EXTREME, NT_CORNER_ANY, NT_CORNER_SUMMED };

/* The passes of one instruction set. */
typedef struct nt_kernels {
	/* Solves triangles [begin, end) of a range and adds them to their vertices, or to the bins where
	 * there are bins. Without them it calls `make` for record arrays that do not exist, and stops where that
	 * fails. */
	void (*accumulate)(nt_fast *fast, size_t begin, size_t end, unsigned range, nt_record_maker *make,
		void *context);
	/* Turns the sums of blocks [begin, end) of vertices, all of them in the adjacency, into results, which go
	 * to the records; counts the vertices that are complex. Sums are counted from the adjacency's first vertex.
	 * Results may replace the rows of their block and of those before. */
	void (*settle)(nt_fast *fast, const nt_adjacency *adjacency, nt_record *const sums[2], size_t begin,
		size_t end, nt_settled *settled);
	/* Solves corners as nt_complex has them, given with the three rows of each one's triangle. `solved` has room
	 * for a multiple of NT_LANES. */
	void (*corners)(const nt_weld_row *rows, const uint32_t *corners, size_t count, nt_corner *solved);
} nt_kernels;

extern const nt_kernels nt_kernels_baseline;
#if defined(__x86_64__)
extern const nt_kernels nt_kernels_avx2, nt_kernels_avx512;
#endif

/* Whether results are judged, so that usable.c need not. */
static inline bool nt_fast_judges(const nt_solve *solve)
{
	return solve->known && solve->repair;
}

/* A row gets NT_W_OPEN. */
static inline void nt_fast_tell_open(const nt_solve *solve)
{
	nt_atomic_store(&solve->known->open, true, RELAXED);
}

/* Whether triangle t and t + 1 are halves of one quad. Not read from the flags, which belong to another thread
 * where a range ends. */
static inline bool nt_fast_quad_begins(const nt_fast *fast, size_t t)
{
	return t + 1 < fast->triangle_count && nt_is_cut_between(&fast->triangles, t);
}

/* Corner i % 3 of triangle i / 3: the mesh's number of it, and its vertex. */
static inline size_t nt_fast_corner(const nt_fast *fast, size_t i)
{
	return fast->triangles.cuts ? nt_triangle_corner(&fast->triangles, i / 3, i % 3) : i;
}

static inline uint32_t nt_fast_vertex(const nt_fast *fast, size_t i)
{
	return fast->triangles.ids[nt_fast_corner(fast, i)];
}

static inline nt_record *nt_fast_record(const nt_fast *fast, int orient, uint32_t vertex)
{
	return &fast->records[orient][fast->record_step * vertex];
}

enum { NT_FLAG_WORD = 64 };

/* A bit for each of `count` flags, or of the first NT_FLAG_WORD, that has this one. */
uint64_t nt_fast_flagged(const uint8_t *flags, size_t count, uint8_t flag);

/* The triangles whose corners have to be looked at one by one: those that do not have three settled
 * corners, all of them usable, and a determinant whose sign is beyond doubt. */
enum { NT_TRIANGLE_SUSPECT = NT_TRIANGLE_ANY | NT_TRIANGLE_DEGENERATE | NT_TRIANGLE_COMPLEX |
			     NT_TRIANGLE_UNCERTAIN };

/* Steps 1 to 4 of few triangles: small.c */

enum { NT_SMALL_TRIANGLES = 512 };

/* Whether a mesh is for it: triangles, tangents only. */
bool nt_fast_is_small(const nt_fast *fast);

/* Welds the vertices, and makes the places of corners and one range. A mesh with a NaN is not welded, and `fast` means
 * nothing then. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_weld_small(nt_fast *fast, bool *welded);

/* Then all triangles are added to the records of their vertices. */
void nt_fast_add_small(nt_fast *fast, const nt_kernels *kernels);

/* Step 4 without bins: records.c */

/* Adds all triangles to the records of their vertices. The adjacency is made. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_add(nt_fast *fast, const nt_kernels *kernels);

/* Steps 6 and 8: write.c */

/* Every corner gets the result of its vertex; with fast->sparse those of suspects only. Marks triangles COMPLEX
 * and COPY. */
void nt_fast_write(nt_fast *fast, const nt_settled *settled);

/* Writes what a sparse solve left out. */
void nt_fast_write_rest(nt_fast *fast);

/* Writes the default to a corner that no group reached (step 10 of the spec page). */
void nt_fast_write_unassigned(const nt_fast *fast, size_t corner);

/* Writes the default to every corner, for a mesh without a sound triangle. */
void nt_fast_write_defaults(const nt_fast *fast);

/* Corners of triangles that are COPY take the values of others, which must have been written. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_write_copies(nt_fast *fast);

/* Step 7: complex.c */

/* Solves the vertices whose records are complex and writes their corners. `memory` is what the passes
 * before have left. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_complex(nt_fast *fast, const nt_kernels *kernels, const nt_settled *settled, nt_borrowed *memory);

/* Which memory steps 1 to 5 work in: memory.c */

typedef struct nt_fast_memory {
	nt_borrowed borrowed;    /* where it is used up, and where it is empty, the scratch follows */
	nt_borrowed none;        /* empty from the beginning */
	nt_borrowed *rows;       /* for rows and cursors: one of these */
	nt_record *bin_sums; /* [3 * triangle_count] for the sums of bins; NULL: take borrowed */
} nt_fast_memory;

/* `binned`: corners go by way of bins. Outputs below `least_bytes` are not borrowed. */
void nt_fast_plan_memory(const nt_fast *fast, bool binned, size_t least_bytes, nt_fast_memory *memory);

/* A binned mesh has gone through step 4: makes the records for those orientations, which are not written. False when
 * out of memory. */
bool nt_fast_place_records(nt_fast *fast, const bool orientations[2]);

/* For step 7: what steps 1 to 5 have left outside of the output. */
nt_borrowed nt_fast_left_memory(const nt_fast *fast);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * What the passes of the fast path share. fast.c is the recipe; kernel.h holds the passes that are
 * compiled once for each instruction set; complex.c solves the vertices that need groups.
 *
 * A vertex here is a welded vertex. At most vertices all corners belong to one group, or to one group of
 * either orientation, and the group's result is a sum over the vertex's corners in triangle order. So the
 * first pass adds every triangle to one record for each (vertex, orientation), without looking at groups.
 * The second looks at the corners of each vertex and either settles it, which makes the record
 * the result, or leaves it to complex.c.
 */
#ifndef NT_TANGENT_FAST_H
#define NT_TANGENT_FAST_H

#include "tangent/bins.h"
#include "tangent/solve.h"
#include "topology/adjacency.h"
#include "topology/weld.h"

enum { NT_LANES = 16 };

/* Bits of nt_fast.flags */
enum {
	NT_TRIANGLE_ORIENT = 1,     /* UV determinant positive (after a quad's halves agreed) */
	NT_TRIANGLE_ANY = 2,        /* no frame: joins groups of any orientation */
	NT_TRIANGLE_DEGENERATE = 4, /* two corners at one position: takes no part */
	NT_TRIANGLE_SECOND = 8,     /* second half of a quad: the first is the triangle before */
	NT_TRIANGLE_COMPLEX = 16,   /* has a corner at a complex vertex */
	NT_TRIANGLE_LATE = 32,      /* degenerate, and copies a corner that is not known yet */
	NT_TRIANGLE_TAKEN = 64,     /* "any", and a group has a corner of it */
	NT_TRIANGLE_UNCERTAIN = 128 /* the exact orientation, as stored too, may differ */
};

/* Entries of fans: orientation in bit 31; bit 30 marks a place without a corner, whose numbers differ
 * from all others of its vertex. */
#define NT_ENTRY_ORIENT ((uint32_t)1 << 31)
#define NT_ENTRY_VOID ((uint32_t)1 << 30)
#define NT_ENTRY_VERTEX (NT_ENTRY_ORIENT - 1)

/* A contribution that has to wait for an earlier range's. */
typedef struct nt_deferred {
	uint32_t vertex;
	uint32_t orient;
	nt_record add;
	nt_record_more more;
} nt_deferred;

typedef struct nt_fast {
	const nt_solve *solve;
	const uint32_t *ids;     /* [3 * triangle_count] welded vertices */
	const uint32_t *corners; /* [3 * triangle_count] corners of the mesh; NULL: i is i */
	size_t triangle_count;
	const nt_weld_row *rows; /* [vertex_count] */
	size_t vertex_count;
	uint8_t *flags;          /* [triangle_count] */
	nt_adjacency adjacency;
	nt_record *records[2];       /* [vertex_count] for orientation false and true; NULL: not needed */
	nt_record_more *more[2];     /* the same for the optional outputs */
	bool wants_more;
	bool sparse;             /* step 6 leaves out corners whose result is their record */
	bool scattered;          /* neighbouring triangles have vertices far apart: ask for them early */
	nt_bins bins;            /* of a scattered mesh: its corners on their way to the records */
	nt_triangle_ranges ranges;
	nt_deferred **deferred;      /* [ranges] */
	size_t *deferred_count;      /* [ranges] */
} nt_fast;

typedef struct nt_settled {
	size_t complex_count, unusable_count;
} nt_settled;

/* The passes of one instruction set. */
typedef struct nt_kernels {
	/* Solves triangles [begin, end) of a range and adds them to their vertices, or to the bins where
	 * there are bins. Without them it stops before a triangle whose record array does not exist and
	 * returns it, and its orientation in *orient; otherwise returns end. */
	size_t (*accumulate)(nt_fast *fast, size_t begin, size_t end, unsigned range, int *orient);
	/* Turns the records of blocks [begin, end) of vertices, all of them in the adjacency, into results;
	 * counts the vertices that are complex, and the settled ones whose tangent is not usable. */
	void (*settle)(nt_fast *fast, const nt_adjacency *adjacency, size_t begin, size_t end,
		nt_settled *settled);
} nt_kernels;

extern const nt_kernels nt_kernels_baseline;
#if defined(__x86_64__)
extern const nt_kernels nt_kernels_avx2, nt_kernels_avx512;
#endif

/* Whether triangle t and t + 1 are halves of one quad: the second begins with the first's first or second
 * corner. Not read from the flags, which belong to another thread where a range ends. */
static inline bool nt_fast_quad_begins(const nt_fast *fast, size_t t)
{
	const uint32_t *corner = fast->corners ? fast->corners + 3 * t : NULL;
	return corner && t + 1 < fast->triangle_count && (corner[3] == corner[0] || corner[3] == corner[1]);
}

static inline size_t nt_fast_corner(const nt_fast *fast, size_t i)
{
	return fast->corners ? fast->corners[i] : i;
}

/* The next triangle from t on that has one of these flags; triangle_count: none. */
size_t nt_fast_next_flagged(const nt_fast *fast, size_t t, unsigned flags);

/* What depends on a mesh's size and order; tests choose it themselves, so that small meshes go every way. */
typedef struct nt_fast_plan {
	size_t grain;      /* least triangles for a thread */
	unsigned bin_bits; /* log2 of the vertices of a bin, from 4 on; 0: bins where the mesh is scattered */
} nt_fast_plan;

/* nt_mikktspace_fast() by another plan. */
nmtan_status nt_mikktspace_fast_as(const nt_solve *solve, const nt_fast_plan *plan);

/* The triangles whose corners have to be looked at one by one: those that do not have three settled
 * corners, all of them usable, and a determinant whose sign is beyond doubt. */
enum { NT_TRIANGLE_SUSPECT = NT_TRIANGLE_ANY | NT_TRIANGLE_DEGENERATE | NT_TRIANGLE_COMPLEX |
			     NT_TRIANGLE_UNCERTAIN };

/*
 * All steps. With `sparse` the corners of triangles that are not suspect are not written: a corner's result
 * is the record of its vertex and its triangle's orientation. Where that is not enough everything is
 * written, and fast->sparse is false afterwards.
 *
 * Returns NMTAN_OK, NMTAN_ERROR_MEMORY or NMTAN_ERROR_TOO_LARGE (beyond the limits of the fast path).
 */
nmtan_status nt_fast_solve(nt_fast *fast, const nt_solve *solve, bool sparse);

/* Every corner gets the result of its vertex; with fast->sparse those of suspects only. Marks triangles COMPLEX
 * and LATE. */
void nt_fast_write(nt_fast *fast);

/* Writes what a sparse solve left out. */
void nt_fast_write_rest(nt_fast *fast);

/* Writes the default to every corner, for a mesh without a sound triangle (step 10 of the spec page). */
void nt_fast_write_defaults(const nt_fast *fast);

/* Corners of triangles that are LATE copy those of others, which must have been written. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_write_late(nt_fast *fast);

/* Solves the vertices whose records are NT_RESULT_COMPLEX and writes their corners. */
nmtan_status nt_fast_complex(nt_fast *fast, size_t complex_count);

#endif

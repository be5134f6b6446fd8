/* SPDX-License-Identifier: MIT */
/*
 * The triangles of a mesh: faces of 3 as they are, faces of 4 cut in two. A cut takes 4 bytes a triangle, and
 * vertices are looked up through it. Arrays of corners and of vertices would be read in one go, but take 24
 * bytes, more than everything else of a mesh of quads that does not fit its output.
 */
#ifndef NT_TOPOLOGY_TRIANGLES_H
#define NT_TOPOLOGY_TRIANGLES_H

#include <stddef.h>
#include <stdint.h>

/* Corner k of a triangle is corner k of its face, or the one behind where bit k of its cut is set. Above these
 * bits is the first corner of the face, which is the same for halves of one quad. */
enum { NT_CUT_BITS = 3 };

/* In a triangle's flags, whose other bits are the method's: two corners are at one position; it is the second half of a
 * quad, whose first half is the triangle before. */
enum { NT_DEGENERATE = 4, NT_SECOND_HALF = 8 };

typedef struct nt_triangles {
	const uint32_t *ids;  /* [corners of the mesh] the vertex of each */
	const uint32_t *cuts; /* [triangles]; NULL: every face is a triangle */
} nt_triangles;

/* First triangle of each range: range r holds [bounds[r], bounds[r + 1]). */
typedef struct nt_triangle_ranges {
	unsigned count;
	const size_t *bounds; /* [count + 1] */
} nt_triangle_ranges;

/* The cut of a triangle with these corners of the face that begins at corner `first`. */
static inline uint32_t nt_cut_of(uint32_t first, const uint32_t corners[3])
{
	uint32_t cut = first << NT_CUT_BITS;
	for (uint32_t k = 0; k < 3; k++)
		cut |= (corners[k] - first - k) << k;
	return cut;
}

/* Corner k of triangle t, as a corner of the mesh. */
static inline size_t nt_triangle_corner(const nt_triangles *triangles, size_t t, unsigned k)
{
	if (!triangles->cuts)
		return 3 * t + k;
	const uint32_t cut = triangles->cuts[t];
	return (cut >> NT_CUT_BITS) + k + (cut >> k & 1);
}

/* Whether triangles t and t + 1 are of one face. */
static inline int nt_is_cut_between(const nt_triangles *triangles, size_t t)
{
	const uint32_t *cuts = triangles->cuts;
	return cuts && (cuts[t] ^ cuts[t + 1]) >> NT_CUT_BITS == 0;
}

/* The vertices of `count` triangles from t on, three each: in place, or copied to copy[3 * count]. */
static inline const uint32_t *nt_triangle_vertices(const nt_triangles *triangles, size_t t, size_t count,
	uint32_t *copy)
{
	if (!triangles->cuts)
		return triangles->ids + 3 * t;
	for (size_t i = 0; i < count; i++) {
		const uint32_t cut = triangles->cuts[t + i];
		const uint32_t *face = triangles->ids + (cut >> NT_CUT_BITS);
		copy[3 * i] = face[cut & 1];
		copy[3 * i + 1] = face[1 + (cut >> 1 & 1)];
		copy[3 * i + 2] = face[2 + (cut >> 2 & 1)];
	}
	return copy;
}

#endif

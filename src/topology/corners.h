/* SPDX-License-Identifier: MIT */
/*
 * Meshes by corners, which are numbered through all faces: triangles, their exact orientation in UV space, and which
 * corners are one vertex to MikkTSpace: equal position, normal and texture coordinates, compared as floats (0 equals
 * -0, NaN equals nothing), no epsilon. Spec page, step 2.
 */
#ifndef NT_TOPOLOGY_CORNERS_H
#define NT_TOPOLOGY_CORNERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/exact.h"
#include "base/scratch.h"
#include "nmtan.h"

/* ---- triangles ---- */

/* Faces of 3 as they are, faces of 4 cut in two. A cut takes 4 bytes a triangle, and vertices are looked up through it.
 * Arrays of corners and of vertices would be read in one go, but take 24 bytes, more than everything else of a mesh of
 * quads that does not fit its output. */

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

/* First triangle of each range: range r holds [bounds[r], bounds[r + 1]). If there are two sweeps, it has as many
 * bounds again, and holds [bounds[count + r], bounds[count + r + 1]) too. */
typedef struct nt_triangle_ranges {
	unsigned count;
	const size_t *bounds; /* [sweeps * count + 1] */
	bool two_sweeps;
} nt_triangle_ranges;

/* Without threads there is one range. */
static inline unsigned nt_sweeps(const nt_triangle_ranges *ranges)
{
#ifdef NT_NO_THREADS
	return (void)ranges, 1;
#else
	return ranges->two_sweeps ? 2 : 1;
#endif
}

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

/* ---- orientation: orientation.c ---- */

/*
 * The one definition of "mirrored" and "degenerate" in UV space, and of how a quad is cut: as MikkTSpace does where it
 * is solved, inside where it is written as triangles.
 *
 * The sign is exact. A difference of two floats is exact in double unless their exponents lie more
 * than 2^29 apart; rounding a product is monotone, so two rounded products that differ compare as the
 * exact ones do; and where they are equal the residuals, which fma gives exactly, decide. The rest (inexact
 * differences) is summed as an expansion (J. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
 * Geometric Predicates", 1997).
 */

/* The same as nt_orientation for any input, by expansions alone. */
int nt_orientation_slow(const float a[2], const float b[2], const float c[2]);

/* The same for equal products p = fl(bu cv) = fl(bv cu) of exact differences: the residuals decide. */
static inline int nt_orientation_residual(double bu, double bv, double cu, double cv, double p)
{
	const double left = nt_fma(bu, cv, -p), right = nt_fma(bv, cu, -p);
	return p == 0.0 ? 0 : (left > right) - (left < right);
}

/* The edges of a triangle in UV space from its first corner, and 0.0 if they are exact. */
typedef struct nt_uv_edges {
	double bu, bv, cu, cv, error;
} nt_uv_edges;

static inline nt_uv_edges nt_uv_edges_of(const float a[2], const float b[2], const float c[2])
{
	const double bu = (double)b[0] - a[0], bv = (double)b[1] - a[1];
	const double cu = (double)c[0] - a[0], cv = (double)c[1] - a[1];
	return (nt_uv_edges){bu, bv, cu, cv, nt_difference_error(bu, a[0], b[0]) + nt_difference_error(bv, a[1], b[1]) +
		nt_difference_error(cu, a[0], c[0]) + nt_difference_error(cv, a[1], c[1])};
}

/* Exact sign of the UV determinant of a triangle, which has these edges: see nmtan_orientation(). */
static inline int nt_orientation_by(const nt_uv_edges *e, const float a[2], const float b[2], const float c[2])
{
	const double p = e->bu * e->cv, r = e->bv * e->cu;
	if (e->error == 0.0)
		return p != r ? p > r ? 1 : -1 : nt_orientation_residual(e->bu, e->bv, e->cu, e->cv, p);
	return nt_orientation_slow(a, b, c);
}

static inline int nt_orientation(const float a[2], const float b[2], const float c[2])
{
	const nt_uv_edges edges = nt_uv_edges_of(a, b, c);
	return nt_orientation_by(&edges, a, b, c);
}

/* Exact comparison of the determinants' magnitudes: -1, 0, +1 as |det(a, b, c)| is less than, equal to
 * or greater than |det(d, e, f)|. A triangle with a value that is not finite counts as 0. */
int nt_compare_area(const float a[2], const float b[2], const float c[2], const float d[2],
	const float e[2], const float f[2]);

/* The triangles of a quad as corner numbers 0..3: row 0 for the diagonal 0-2, row 1 for 1-3, each with
 * MikkTSpace's order and first corners. */
extern const unsigned char nt_quad_triangles[2][2][3];

/* The diagonal along which MikkTSpace cuts a quad, as a row of nt_quad_triangles: the shorter one in UV
 * space; where those are equal or not comparable, the shorter one in space, 0-2 when in doubt. */
int nt_quad_diagonal(const float *const texcoords[4], const float *const positions[4]);

/* The diagonal along which a quad is written as triangles. It is that of the solve, unless one triangle is inverted by
 * it (it lies outside of the quad in space) and none by the other diagonal. Inverted means against the quad's Newell
 * normal. A simple outline has at most one corner that turns inwards, so one diagonal inverts nothing; an outline that
 * crosses itself has an inverted triangle either way. */
int nt_written_quad_diagonal(int solved, const float *const positions[4]);

/* ---- faces and corners of a mesh: corners.c ---- */

/* A row of an attribute. */
static inline const float *nt_row(const float *data, size_t stride_bytes, size_t row)
{
	return (const float *)((const char *)data + stride_bytes * row);
}

/* The vertex of a corner. */
static inline size_t nt_vertex_of(const nmtan_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : corner;
}

/* Whether normals or texture coordinates have numbers of their own: see nmtan_mesh and nt_make_plain(). */
static inline bool nt_makes_vertices(const nmtan_mesh *mesh)
{
	return mesh->normal_count || mesh->normal_indices || mesh->texcoord_count || mesh->texcoord_indices;
}

/* Rows of an attribute, of which `own` is the mesh's count of them. */
static inline size_t nt_row_count(const nmtan_mesh *mesh, size_t own, const uint32_t *indices)
{
	return own || indices ? own : mesh->vertex_count;
}

static inline const float *nt_position(const nmtan_mesh *mesh, size_t vertex)
{
	return nt_row(mesh->positions, mesh->position_stride_bytes, vertex);
}

static inline const float *nt_normal(const nmtan_mesh *mesh, size_t vertex)
{
	return nt_row(mesh->normals, mesh->normal_stride_bytes, vertex);
}

static inline const float *nt_texcoord(const nmtan_mesh *mesh, size_t vertex)
{
	return nt_row(mesh->texcoords, mesh->texcoord_stride_bytes, vertex);
}

/* Whether two corners of a triangle are at one position. */
static inline bool nt_is_collapsed(const nmtan_mesh *mesh, const uint32_t corners[3])
{
	const float *p[3];
	unsigned same = 0;
	for (int k = 0; k < 3; k++)
		p[k] = nt_position(mesh, nt_vertex_of(mesh, corners[k]));
	for (int k = 0, next = 1; k < 3; k++, next = (next + 1) % 3)
		same |= (p[k][0] == p[next][0]) & (p[k][1] == p[next][1]) & (p[k][2] == p[next][2]);
	return same;
}

/* A row stride: 0 becomes the row's size; false where the stride cannot be, or no array can have `count` such rows.
 * A count above UINT32_MAX is nt_check_faces()'s. */
static inline bool nt_fill_stride(size_t *stride_bytes, size_t row_bytes, size_t count)
{
	if (*stride_bytes == 0)
		*stride_bytes = row_bytes;
	return *stride_bytes >= row_bytes && *stride_bytes % sizeof(float) == 0 &&
	       (count == 0 || count > UINT32_MAX || *stride_bytes <= PTRDIFF_MAX / count);
}

/* Corners of a face: 3 or 4. */
static inline unsigned nt_face_size(const nmtan_mesh *mesh, size_t face)
{
	return mesh->face_sizes ? mesh->face_sizes[face] : 3;
}

/* Triangles of a mesh of that many corners, quads cut in two: a face of n corners has n - 2. */
static inline size_t nt_triangle_count(const nmtan_mesh *mesh, size_t corner_count)
{
	return corner_count - 2 * mesh->face_count;
}

/* The first corner of a face, by counting the quads before it. */
static inline size_t nt_first_corner(const nmtan_mesh *mesh, size_t face)
{
	size_t quads = 0;
	for (size_t i = 0; mesh->face_sizes && i < face; i++)
		quads += mesh->face_sizes[i] == 4;
	return 3 * face + quads;
}

/* The number that is added to v when it is stored. */
static inline float nt_stored_v_offset(const nmtan_mesh *mesh)
{
	return mesh->stored ? mesh->stored->v_offset : 0.0f;
}

/* Whether a transform lies between what is stored and the texture coordinates of the solve. */
static inline bool nt_has_stored_texcoords(const nmtan_mesh *mesh)
{
	return mesh->stored && mesh->stored->texcoords;
}

/* Whether other texture coordinates than those of the solve decide the sign. */
static inline bool nt_has_stored(const nmtan_mesh *mesh)
{
	return nt_stored_v_offset(mesh) != 0.0f || nt_has_stored_texcoords(mesh);
}

/* Texture coordinates as they will be stored. */
static inline void nt_stored_texcoord(const nmtan_mesh *mesh, size_t vertex, float stored[2])
{
	const float *t = nt_has_stored_texcoords(mesh) ? mesh->stored->texcoords + 2 * vertex
						       : nt_texcoord(mesh, vertex);
	stored[0] = t[0];
	stored[1] = t[1] + nt_stored_v_offset(mesh);
}

/* Makes flags of triangles, all but NT_SECOND_HALF clear, and the cuts of quads, if there are some. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_cut_faces(const nmtan_mesh *mesh, size_t triangle_count, nt_scratch *scratch, uint8_t **flags,
	nt_triangles *triangles);

/* Makes ranges of triangles; halves of a quad stay together. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_cut_ranges(const uint8_t *flags, size_t triangle_count, unsigned count, nt_scratch *scratch,
	nt_triangle_ranges *ranges);

/* The one or two triangles of the face whose first corner is `first`, as corners of the mesh, for the solve: quads
 * are cut as MikkTSpace cuts them. Returns how many. */
static inline unsigned nt_face_triangles(const nmtan_mesh *mesh, size_t face, size_t first,
	uint32_t corners[2][3])
{
	if (nt_face_size(mesh, face) == 3) {
		for (uint32_t k = 0; k < 3; k++)
			corners[0][k] = (uint32_t)first + k;
		return 1;
	}
	const float *uv[4], *p[4];
	for (size_t k = 0; k < 4; k++) {
		uv[k] = nt_texcoord(mesh, nt_vertex_of(mesh, first + k));
		p[k] = nt_position(mesh, nt_vertex_of(mesh, first + k));
	}
	const int cut = nt_quad_diagonal(uv, p);
	for (int half = 0; half < 2; half++)
		for (int k = 0; k < 3; k++)
			corners[half][k] = (uint32_t)first + nt_quad_triangles[cut][half][k];
	return 2;
}

/* The diagonal along which the quad with that first corner is written: see nt_written_quad_diagonal(). Without
 * texture coordinates the positions decide. */
int nt_written_diagonal(const nmtan_mesh *mesh, size_t first);

/* The same for each face; 0 for triangles. Returns how many are not MikkTSpace's. */
size_t nt_written_diagonals(const nmtan_mesh *mesh, uint8_t *diagonals);

/* The same triangles as they are written: those that w has to fit. */
unsigned nt_written_triangles(const nmtan_mesh *mesh, size_t face, size_t first, uint32_t corners[2][3]);

/* Checks that face sizes are 3 or 4 and indices below the counts of their rows, and counts the corners. Returns
 * NMTAN_OK, NMTAN_ERROR_ARGUMENT, NMTAN_ERROR_TOO_LARGE, NMTAN_ERROR_FACE_SIZE or NMTAN_ERROR_INDEX. */
nmtan_status nt_check_faces(const nmtan_mesh *mesh, size_t *corner_count);

/*
 * Welds corners. Strides must be filled in and indices checked.
 *
 *   ids      [corner_count] receives the number of each corner's welded vertex; numbers go from 0 in
 *            order of first use
 *   count    receives how many there are
 *
 * Expected linear time. Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_weld_corners(const nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch,
	uint32_t *ids, size_t *count);

/* ---- triangles whose tangents run against their texture coordinates: orientation.c ---- */

/* A triangle with what its corners have. */
typedef struct nt_tangent_triangle {
	const float *positions[3], *normals[3], *texcoords[3];
	const float *tangents[3]; /* of four numbers */
	int orientation;          /* of the texture coordinates, not 0 */
	bool other_w;             /* w is negated */
} nt_tangent_triangle;

/* Whether all three tangents run against growing u and all bitangents against growing v although the normals agree with
 * the winding. Asked of triangles whose w is right. */
bool nt_is_reversed(const nt_tangent_triangle *triangle);

/* ---- plain meshes: plain.c ---- */

/* The only ones that the solve knows have 32-bit indices, one row of each attribute for each vertex, and v up. */

/*
 * Makes a mesh plain, whose faces nt_check_faces() has accepted and whose strides are filled in; of attributes that are
 * NULL nothing is made. New arrays are in the scratch; a plain mesh stays as it is, at no cost.
 *
 *   corners  receives NULL or, where vertices have come into being, the first corner of each: [mesh->vertex_count]
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_make_plain(nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch, const uint32_t **corners);

#endif

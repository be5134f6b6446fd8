/* SPDX-License-Identifier: MIT */
/*
 * Corners that are one vertex to MikkTSpace: equal position, normal and texture coordinates, compared as
 * floats (0 equals -0, NaN equals nothing), no epsilon. Spec page, step 2.
 */
#ifndef NT_TOPOLOGY_CORNERS_H
#define NT_TOPOLOGY_CORNERS_H

#include "base/scratch.h"
#include "nmtan.h"
#include "topology/orientation.h"
#include "topology/triangles.h"

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

/* Whether normals or texture coordinates have numbers of their own: see nmtan_mesh and plain.h. */
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

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Corners: the check of faces and indices that lets every later stage trust them, the triangles that faces are written
 * as, and the plain weld: each corner's row is looked up in the table of rows (weld_table.c).
 */
#include "topology/corners.h"

#include "base/numbers.h"
#include "topology/inside.h"

/* Counts the corners; every face must have 3 or 4. */
static nmtan_status count_corners(const nmtan_mesh *mesh, size_t *corner_count)
{
	*corner_count = mesh->face_count * 3;
	if (!mesh->face_sizes)
		return NMTAN_OK;
	size_t quads = 0, wrong = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		quads += mesh->face_sizes[face] == 4;
		wrong += mesh->face_sizes[face] != 4 && mesh->face_sizes[face] != 3;
	}
	*corner_count += quads;
	return wrong ? NMTAN_ERROR_FACE_SIZE : NMTAN_OK;
}

/* Corners that have so many rows; NULL: corner c has row c. */
static nmtan_status check_indices(const uint32_t *indices, size_t corner_count, size_t rows)
{
	if (!indices)
		return corner_count > rows ? NMTAN_ERROR_INDEX : NMTAN_OK;
	return nt_all_below(indices, corner_count, (uint32_t)rows) ? NMTAN_OK : NMTAN_ERROR_INDEX;
}

static nmtan_status check_short_indices(const uint16_t *indices, size_t corner_count, size_t rows)
{
	uint16_t most = 0;
	for (size_t c = 0; c < corner_count; c++)
		most = indices[c] > most ? indices[c] : most;
	return corner_count > 0 && most >= rows ? NMTAN_ERROR_INDEX : NMTAN_OK;
}

/* An attribute with numbers of its own. */
static nmtan_status check_own(const uint32_t *indices, size_t corner_count, size_t rows)
{
	return !rows && !indices ? NMTAN_OK : check_indices(indices, corner_count, rows);
}

nmtan_status nt_check_faces(const nmtan_mesh *mesh, size_t *corner_count)
{
	if (mesh->face_count > NMTAN_MAX_FACES || mesh->vertex_count > UINT32_MAX ||
		mesh->normal_count > UINT32_MAX || mesh->texcoord_count > UINT32_MAX)
		return NMTAN_ERROR_TOO_LARGE;
	if ((mesh->indices && mesh->indices16) || (nt_makes_vertices(mesh) && nt_has_stored_texcoords(mesh)))
		return NMTAN_ERROR_ARGUMENT;
	nmtan_status status = count_corners(mesh, corner_count);
	if (!status)
		status = mesh->indices16 ? check_short_indices(mesh->indices16, *corner_count, mesh->vertex_count)
					 : check_indices(mesh->indices, *corner_count, mesh->vertex_count);
	if (!status)
		status = check_own(mesh->normal_indices, *corner_count, mesh->normal_count);
	return status ? status : check_own(mesh->texcoord_indices, *corner_count, mesh->texcoord_count);
}

nmtan_status nt_cut_faces(const nmtan_mesh *mesh, size_t triangle_count, nt_scratch *scratch, uint8_t **flags,
	nt_triangles *triangles)
{
	const bool quads = triangle_count != mesh->face_count;
	uint32_t *cuts = quads ? nt_scratch_alloc(scratch, triangle_count, sizeof *cuts) : NULL;
	*flags = nt_scratch_alloc(scratch, triangle_count, 1);
	if (!*flags || (quads && !cuts))
		return NMTAN_ERROR_MEMORY;
	memset(*flags, 0, triangle_count);
	for (size_t face = 0, first = 0, t = 0; quads && face < mesh->face_count; first += mesh->face_sizes[face++]) {
		uint32_t corners[2][3];
		const unsigned count = nt_face_triangles(mesh, face, first, corners);
		for (unsigned half = 0; half < count; half++, t++) {
			(*flags)[t] = half ? NT_SECOND_HALF : 0;
			cuts[t] = nt_cut_of((uint32_t)first, corners[half]);
		}
	}
	triangles->cuts = cuts;
	return NMTAN_OK;
}

nmtan_status nt_cut_ranges(const uint8_t *flags, size_t triangle_count, unsigned count, nt_scratch *scratch,
	nt_triangle_ranges *ranges)
{
	size_t *bounds = nt_scratch_alloc(scratch, count + 1, sizeof *bounds);
	if (!bounds)
		return NMTAN_ERROR_MEMORY;
	for (unsigned r = 0; r <= count; r++) {
		bounds[r] = triangle_count / count * r + triangle_count % count * r / count;
		while (bounds[r] < triangle_count && flags[bounds[r]] & NT_SECOND_HALF)
			bounds[r]++;
	}
	*ranges = (nt_triangle_ranges){.count = count, .bounds = bounds};
	return NMTAN_OK;
}

/* nt_written_diagonal(); *solved receives the diagonal of the solve. */
static int written_diagonal(const nmtan_mesh *mesh, size_t first, int *solved)
{
	static const float nowhere[2] = {0};
	const float *uv[4], *p[4];
	for (size_t k = 0; k < 4; k++) {
		const size_t vertex = nt_vertex_of(mesh, first + k);
		uv[k] = mesh->texcoords ? nt_texcoord(mesh, vertex) : nowhere;
		p[k] = nt_position(mesh, vertex);
	}
	*solved = nt_quad_diagonal(uv, p);
	return nt_written_quad_diagonal(*solved, p);
}

int nt_written_diagonal(const nmtan_mesh *mesh, size_t first)
{
	int solved;
	return written_diagonal(mesh, first, &solved);
}

size_t nt_written_diagonals(const nmtan_mesh *mesh, uint8_t *diagonals)
{
	size_t changed = 0;
	for (size_t face = 0, first = 0; face < mesh->face_count; first += nt_face_size(mesh, face++)) {
		int written = 0, solved = 0;
		if (nt_face_size(mesh, face) == 4)
			written = written_diagonal(mesh, first, &solved);
		diagonals[face] = (uint8_t)written;
		changed += written != solved;
	}
	return changed;
}

unsigned nt_written_triangles(const nmtan_mesh *mesh, size_t face, size_t first, uint32_t corners[2][3])
{
	const unsigned count = nt_face_size(mesh, face) - 2;
	const int cut = count == 2 ? nt_written_diagonal(mesh, first) : 0;
	for (unsigned i = 0; i < count; i++)
		for (int k = 0; k < 3; k++)
			corners[i][k] = (uint32_t)first + nt_quad_triangles[cut][i][k];
	return count;
}

nmtan_status nt_weld_corners(const nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch,
	uint32_t *ids, size_t *count)
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	nt_borrowed memory = nt_borrow(NULL, 0, scratch);
	nt_welder w = {.mesh = mesh, .key = nt_weld_make_key(), .row_memory = &memory, .memory = &memory,
		.items = mesh->indices, .item_count = corner_count, .row_guess = corner_count / 4, .numbers = ids};
	const bool done = nt_weld_items(&w, 1);
	*count = w.row_count;
	nt_scratch_back(scratch, mark);
	return done ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

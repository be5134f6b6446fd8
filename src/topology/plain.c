/* SPDX-License-Identifier: MIT */
/*
 * Plain meshes: see corners.h. Corners that use the same rows become one vertex. The weld that finds them is the one of
 * attributes, over the halves of the rows' numbers: a float holds 16 bits exactly.
 */
#include "topology/corners.h"

#include <string.h>

enum { KEY_FLOATS = 8 };

/* JavaScript brings 32-bit indices of vertices, and is spared the code for others. */
#ifdef __wasm__
enum { OTHER_INDICES = 0 };
#else
enum { OTHER_INDICES = 1 };
#endif

static bool widen_indices(nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch)
{
	uint32_t *indices = nt_scratch_alloc(scratch, corner_count, sizeof *indices);
	for (size_t c = 0; indices && c < corner_count; c++)
		indices[c] = mesh->indices16[c];
	mesh->indices = indices;
	mesh->indices16 = NULL;
	return indices != NULL;
}

/* The row of an attribute that a corner has: its own, or that of the vertex. */
static size_t row_of(const nmtan_mesh *mesh, const uint32_t *indices, size_t own_count, size_t corner)
{
	return indices ? indices[corner] : own_count ? corner : nt_vertex_of(mesh, corner);
}

static size_t normal_row_of(const nmtan_mesh *mesh, size_t corner)
{
	return row_of(mesh, mesh->normal_indices, mesh->normal_count, corner);
}

static size_t texcoord_row_of(const nmtan_mesh *mesh, size_t corner)
{
	return row_of(mesh, mesh->texcoord_indices, mesh->texcoord_count, corner);
}

static void put_number(float *key, size_t number)
{
	key[0] = (float)(number & 0xffff);
	key[1] = (float)(number >> 16);
}

/* The vertex of each corner, and how many there are, in order of first use. */
static nmtan_status number_vertices(const nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch, uint32_t *ids,
	size_t *count)
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	float *keys = nt_scratch_alloc(scratch, corner_count, KEY_FLOATS * sizeof *keys);
	if (!keys)
		return NMTAN_ERROR_MEMORY;
	for (size_t c = 0; c < corner_count; c++) {
		float *key = keys + KEY_FLOATS * c;
		put_number(key, nt_vertex_of(mesh, c));
		put_number(key + 2, normal_row_of(mesh, c));
		put_number(key + 4, texcoord_row_of(mesh, c));
		key[6] = key[7] = 0.0f;
	}
	const size_t stride_bytes = KEY_FLOATS * sizeof *keys;
	nmtan_mesh corners = NMTAN_MESH_INIT;
	corners.vertex_count = corner_count;
	corners.positions = keys;
	corners.normals = keys + 3;
	corners.texcoords = keys + 6;
	corners.position_stride_bytes = corners.normal_stride_bytes = corners.texcoord_stride_bytes = stride_bytes;
	const nmtan_status status = nt_weld_corners(&corners, corner_count, scratch, ids, count);
	nt_scratch_back(scratch, mark);
	return status;
}

/* The rows of an attribute that vertices use, one for each. */
static bool gather(const float **data, size_t *stride_bytes, size_t floats, const uint32_t *rows, size_t count,
	nt_scratch *scratch)
{
	if (!*data)
		return true;
	float *gathered = nt_scratch_alloc(scratch, count, floats * sizeof *gathered);
	for (size_t v = 0; gathered && v < count; v++)
		memcpy(gathered + floats * v, nt_row(*data, *stride_bytes, rows[v]), floats * sizeof *gathered);
	*data = gathered;
	*stride_bytes = floats * sizeof *gathered;
	return gathered != NULL;
}

static nmtan_status make_vertices(nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch,
	const uint32_t **made)
{
	uint32_t *ids = nt_scratch_alloc(scratch, corner_count, sizeof *ids);
	size_t count = 0;
	const nmtan_status status =
		ids ? number_vertices(mesh, corner_count, scratch, ids, &count) : NMTAN_ERROR_MEMORY;
	uint32_t *rows = nt_scratch_alloc(scratch, count, 4 * sizeof *rows);
	if (status || !rows)
		return NMTAN_ERROR_MEMORY;
	uint32_t *corners = rows + 3 * count;
	for (size_t c = 0, next = 0; c < corner_count; c++)
		if (ids[c] == next) {
			rows[next] = (uint32_t)nt_vertex_of(mesh, c);
			rows[count + next] = (uint32_t)normal_row_of(mesh, c);
			rows[2 * count + next] = (uint32_t)texcoord_row_of(mesh, c);
			corners[next++] = (uint32_t)c;
		}
	if (!gather(&mesh->positions, &mesh->position_stride_bytes, 3, rows, count, scratch) ||
		!gather(&mesh->normals, &mesh->normal_stride_bytes, 3, rows + count, count, scratch) ||
		!gather(&mesh->texcoords, &mesh->texcoord_stride_bytes, 2, rows + 2 * count, count, scratch))
		return NMTAN_ERROR_MEMORY;
	mesh->indices = ids;
	mesh->vertex_count = count;
	mesh->normal_indices = mesh->texcoord_indices = NULL;
	mesh->normal_count = mesh->texcoord_count = 0;
	*made = corners;
	return NMTAN_OK;
}

static bool turn_texcoords(nmtan_mesh *mesh, nt_scratch *scratch)
{
	float *turned = nt_scratch_alloc(scratch, mesh->vertex_count, 2 * sizeof *turned);
	for (size_t v = 0; turned && v < mesh->vertex_count; v++) {
		const float *t = nt_texcoord(mesh, v);
		turned[2 * v] = t[0];
		turned[2 * v + 1] = -t[1];
	}
	mesh->texcoords = turned;
	mesh->texcoord_stride_bytes = 2 * sizeof *turned;
	mesh->v_down = 0;
	return turned != NULL;
}

nmtan_status nt_make_plain(nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch, const uint32_t **corners)
{
	*corners = NULL;
	if (OTHER_INDICES && mesh->indices16 && !widen_indices(mesh, corner_count, scratch))
		return NMTAN_ERROR_MEMORY;
	if (OTHER_INDICES && nt_makes_vertices(mesh)) {
		const nmtan_status status = make_vertices(mesh, corner_count, scratch, corners);
		if (status)
			return status;
	}
	return !mesh->v_down || !mesh->texcoords || turn_texcoords(mesh, scratch) ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

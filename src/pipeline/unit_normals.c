/* SPDX-License-Identifier: MIT */
/*
 * Unit normals, for the stage that makes normals: the one normal of a vertex is what is written, made unit, and
 * tangents have to lie across that. Most meshes have nothing but normals of unit length and are only looked at.
 *
 * A length is 1 if |n|^2 is within 2^-11 of it: such normals are used as they are, so that rounding them again
 * changes no tangent. Others are made unit, here and in the same way for every format. The normals that are solved are
 * those that are written; but a glTF that is made from a glTF keeps what it has, and so does a PLY whose normals are
 * integers. One without a direction counts as lacking if the output gets new normals; in a glTF it stays, and tangents
 * are made for the smooth normal of the faces around it.
 */
#include "pipeline/stages.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "base/dvec.h"
#include "base/parallel.h"
#include "tangent/normals.h"
#include "tangent/usable.h"

typedef struct looking {
	const float *normals;
	atomic_bool odd;
} looking;

static void look_at_range(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	looking *l = context;
	size_t odd = 0;
	for (size_t v = begin; v < end; v++)
		odd += !nt_is_unit_normal(l->normals + 3 * v);
	if (odd)
		atomic_store(&l->odd, true);
}

/* Whether a mesh has normals that are not of unit length. */
static bool has_odd(const nt_mesh *mesh, unsigned threads)
{
	enum { GRAIN = 1 << 16 };
	looking l = {.normals = mesh->normals};
	const size_t count = mesh->normals ? mesh->vertex_count : 0;
	nt_parallel_ranges(count < 2 * GRAIN ? 1 : nt_thread_count(threads), count, GRAIN, look_at_range, &l);
	return l.odd;
}

static bool has_direction(const float *n)
{
	nt_dvec3 d = nt_dvec3_load(n);
	return nt_dvec3_normalise(&d);
}

/* Vertices whose normal has no direction lack it. */
nt_status nt_mark_directionless(nt_scene *scene, nt_mesh *mesh, unsigned threads)
{
	if (!has_odd(mesh, threads))
		return NT_OK;
	for (size_t v = 0; v < mesh->vertex_count; v++) {
		if (has_direction(mesh->normals + 3 * v))
			continue;
		if (!mesh->vertex_lacks) {
			mesh->vertex_lacks = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->vertex_count, 1);
			if (!mesh->vertex_lacks)
				return NT_ERROR_MEMORY;
			memset(mesh->vertex_lacks, 0, mesh->vertex_count);
		}
		mesh->vertex_lacks[v] |= NT_LACKS_NORMAL;
	}
	return NT_OK;
}

/* Smooth normals of all corners; NULL when memory is exhausted. */
static float (*make_smooth(const nt_mesh *mesh))[4]
{
	nmtan_stored_uv stored;
	nmtan_mesh view = nt_mesh_view(mesh, &stored);
	view.position_stride_bytes = 3 * sizeof(float);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	float (*corners)[4] = nt_alloc(mesh->corner_count, sizeof *corners);
	if (corners && nt_corner_normals(&view, mesh->corner_count, NULL, NULL, &scratch, corners)) {
		free(corners);
		corners = NULL;
	}
	nt_scratch_free(&scratch);
	return corners;
}

/* Vertices without a direction take the smooth normal of their first corner. */
static nt_status replace_directionless(nt_mesh *mesh, float *normals)
{
	float (*corners)[4] = make_smooth(mesh);
	if (!corners)
		return NT_ERROR_MEMORY;
	for (size_t c = 0; c < mesh->corner_count; c++) {
		float *n = normals + 3 * (mesh->indices ? mesh->indices[c] : c);
		if (has_direction(n))
			continue;
		memcpy(n, corners[c], 3 * sizeof *n);
		mesh->replaced_normals++;
	}
	free(corners);
	return NT_OK;
}

nt_status nt_make_unit_normals(nt_scene *scene, nt_mesh *mesh, unsigned threads)
{
	if (!has_odd(mesh, threads))
		return NT_OK;
	float *normals = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->vertex_count, 3 * sizeof *normals);
	if (!normals)
		return NT_ERROR_MEMORY;
	memcpy(normals, mesh->normals, mesh->vertex_count * 3 * sizeof *normals);
	size_t directionless = 0;
	for (size_t v = 0; v < mesh->vertex_count; v++) {
		float *n = normals + 3 * v;
		nt_dvec3 d = nt_dvec3_load(n);
		if (nt_is_unit_normal(n))
			continue;
		if (!nt_dvec3_normalise(&d)) {
			directionless++;
			continue;
		}
		nt_dvec3_store(d, n);
		mesh->scaled_normals++;
	}
	*(nt_format_is_gltf(scene->format) ? &mesh->solve_normals : &mesh->normals) = normals;
	return directionless ? replace_directionless(mesh, normals) : NT_OK;
}

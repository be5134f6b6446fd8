/* SPDX-License-Identifier: MIT */
/*
 * Quads: which triangles of a glTF are solved as such, and where those of other formats are cut.
 *
 * Solved as quads are those that the author's program solved so. Its tangents tell, or FB_ngon_encoding, or the user;
 * pairs of triangles alone prove nothing.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include "base/numbers.h"
#include "report/maker/maker.h"
#include "topology/corners.h"

/* Whether the tangents that a mesh has are those of its quads and not those of its triangles. */
static nt_status ask_tangents(const nt_mesh *mesh, const uint8_t *halves, unsigned threads, bool *are_quads)
{
	nt_maker triangles = {.quads = false}, quads = {.quads = true};
	uint64_t *border = NULL;
	float *fresh = nt_alloc(mesh->corner_count, 4 * sizeof *fresh);
	*are_quads = false;
	nt_status status = fresh ? NT_OK : NT_ERROR_MEMORY;
	if (!status && mesh->has_siblings) {
		border = nt_alloc(nt_bit_words(mesh->corner_count), sizeof *border);
		status = border ? nt_maker_border(mesh, border) : NT_ERROR_MEMORY;
	}
	if (!status)
		status = nt_maker_compare(mesh, halves, border, threads, fresh, &triangles);
	if (!status && triangles.agreement < NT_MAKER_SHARE) {
		status = nt_maker_compare(mesh, halves, border, threads, fresh, &quads);
		*are_quads = !status && quads.agreement >= NT_MAKER_SHARE;
	}
	free(border);
	free(fresh);
	return status;
}

/* Whether nearly all of a mesh without tangents pairs, if its program solves quads. */
static bool suggests_quads(const nt_scene *scene, const nt_mesh *mesh, size_t quads)
{
	return scene->solves_quads && !mesh->tangents && mesh->decision == NT_DECISION_SOLVE &&
	       20 * quads >= 9 * mesh->face_count;
}

nt_status nt_find_halves(nt_scene *scene, nt_mesh *mesh, nt_quads choice, unsigned threads)
{
	const bool pairs = choice == NT_QUADS_PAIRS, polygons = !pairs && mesh->has_polygons;
	const bool proof = !pairs && !polygons && mesh->tangents && nt_mesh_gets_tangents(mesh);
	if (choice == NT_QUADS_OFF || !nt_format_is_gltf(scene->format) || mesh->plan.same_as || !mesh->positions ||
		!mesh->normals || !mesh->texcoords || !(pairs || polygons || proof || scene->solves_quads))
		return NT_OK;
	uint8_t *halves = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->face_count, 1);
	if (!halves)
		return NT_ERROR_MEMORY;
	const size_t quads = nt_pair_quads(mesh, polygons, halves);
	bool are_quads = quads > 0 && (pairs || polygons);
	mesh->may_be_quads = suggests_quads(scene, mesh, quads) && !are_quads ? quads : 0;
	if (quads > 0 && proof) {
		const nt_status status = ask_tangents(mesh, halves, threads, &are_quads);
		if (status)
			return status;
	}
	if (are_quads) {
		mesh->halves = halves;
		mesh->quad_count = quads;
	}
	return NT_OK;
}

/* For writers of triangles, as nt_written_quad_diagonal() has it. Solved meshes have it from folded_quads.c. */
nt_status nt_stage_quads(nt_scene *scene, nt_error *error)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		nmtan_stored_uv stored;
		const nmtan_mesh view = nt_mesh_view(mesh, &stored);
		if (!mesh->face_sizes || !mesh->positions || mesh->face_diagonals)
			continue;
		mesh->face_diagonals = nt_arena_alloc(&scene->arena, mesh->face_count, 1);
		if (!mesh->face_diagonals)
			return nt_fail_memory(error);
		nt_written_diagonals(&view, mesh->face_diagonals);
	}
	return NT_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * Quads: which triangles of a glTF are solved as such, and where those of other formats are cut.
 *
 * Solved as quads are those that the author's program solved so. Its tangents tell, or FB_ngon_encoding, or the user;
 * pairs of triangles alone prove nothing.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "base/numbers.h"
#include "base/structs.h"
#include "report/maker/maker.h"
#include "tangent/frames.h"
#include "topology/corners.h"

/* ---- quads of a glTF ---- */

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

/* For writers of triangles, as nt_written_quad_diagonal() has it. Solved meshes have it from nt_cut_folded_quads(). */
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

/* ---- folded quads, for writers of triangles ---- */

/*
 * The halves of a folded quad, as they are written, are wound differently in UV space, so that no w serves both: its
 * outline crosses itself there, or is concave and cut outside. MikkTSpace has one result for each of its corners; where
 * the quad is written as triangles, each of them can have its own sign.
 *
 * The mesh is solved with its quads, since the tangents of their neighbours depend on that. Then the folded ones become
 * two triangles each, in place, and repair sees to these: the half whose sign the quad has is usable and keeps its
 * bytes, the other gets the exact frame of its own orientation. All other corners stay as they are. A corner with two
 * tangents is two vertices after the split.
 */

/* Bits of nt_known.flags: the triangle is half of a cut quad. */
enum { CUT = 1, POSITIVE = 2 };

/* The arrays of a mesh whose folded quads are cut, of an arena but for the tangents. */
typedef struct cut_mesh {
	float (*tangents)[4];                      /* [corner_count] */
	uint32_t *indices;                         /* [corner_count] */
	uint32_t *polygon, *smoothing, *primitive; /* [face_count] */
	uint8_t *sizes;                            /* [face_count] */
	uint8_t *flags;                            /* [triangle_count] for repair */
	size_t face_count, corner_count, triangle_count; /* so far */
} cut_mesh;

/* Whether a face is a folded quad, and if so its halves. */
static bool is_folded(const nmtan_mesh *view, const uint8_t *diagonals, size_t face, size_t first,
	uint32_t halves[2][3])
{
	nt_fold folded = NT_NOT_FOLDED;
	if (view->face_sizes[face] == 4) {
		for (int i = 0; i < 6; i++)
			halves[i / 3][i % 3] = (uint32_t)first + nt_quad_triangles[diagonals[face]][i / 3][i % 3];
		nt_cut_orientation(view, halves, 2, true, &folded);
	}
	return folded;
}

static size_t count_folded(const nmtan_mesh *view, const uint8_t *diagonals)
{
	uint32_t halves[2][3];
	size_t folded = 0;
	for (size_t face = 0, first = 0; face < view->face_count; first += view->face_sizes[face++])
		folded += is_folded(view, diagonals, face, first, halves);
	return folded;
}

/* Whether any quad may be folded: the counts, which are of the triangles of the solve, have both orientations, or
 * `changed` quads are cut otherwise. */
static bool may_be_folded(const nt_mesh *mesh, size_t changed)
{
	const nmtan_counts *c = &mesh->counts;
	return mesh->texcoords && (changed || c->stored_differently ||
		(c->mirrored && c->mirrored < nt_mesh_triangle_count(mesh)));
}

static bool alloc_cut(const nt_mesh *mesh, size_t folded, nt_arena *arena, cut_mesh *cut)
{
	const size_t faces = mesh->face_count + folded, corners = mesh->corner_count + 2 * folded;
	*cut = (cut_mesh){.tangents = nt_alloc(corners, sizeof *cut->tangents),
		.indices = nt_arena_alloc(arena, corners + 3 * faces, sizeof *cut->indices),
		.sizes = nt_arena_alloc(arena, faces, 1), .flags = nt_arena_alloc(arena, corners - 2 * faces, 1)};
	if (!cut->tangents || !cut->indices || !cut->sizes || !cut->flags) {
		free(cut->tangents);
		return false;
	}
	cut->polygon = cut->indices + corners;
	cut->smoothing = cut->polygon + faces;
	cut->primitive = cut->smoothing + faces;
	return true;
}

/* Appends a face of `size` corners of the mesh. */
static void add_face(const nt_mesh *mesh, size_t face, const uint32_t *corners, size_t size, bool cut_here,
	cut_mesh *cut)
{
	const size_t f = cut->face_count++;
	cut->sizes[f] = (uint8_t)size;
	cut->polygon[f] = mesh->face_polygon ? mesh->face_polygon[face] : (uint32_t)face;
	cut->smoothing[f] = mesh->face_smoothing ? mesh->face_smoothing[face] : 0;
	cut->primitive[f] = mesh->face_primitive ? mesh->face_primitive[face] : 0;
	for (size_t k = 0; k < size; k++) {
		const size_t c = cut->corner_count++;
		cut->indices[c] = mesh->indices ? mesh->indices[corners[k]] : corners[k];
		memcpy(cut->tangents[c], mesh->corner_tangents + 4 * (size_t)corners[k], sizeof *cut->tangents);
	}
	for (size_t i = 2; i < size; i++)
		cut->flags[cut->triangle_count++] = cut_here ? CUT : 0;
}

static void cut_faces(nt_mesh *mesh, const nmtan_mesh *view, const uint8_t *diagonals, cut_mesh *cut)
{
	for (size_t face = 0, first = 0; face < mesh->face_count; first += mesh->face_sizes[face++]) {
		uint32_t halves[2][3];
		if (is_folded(view, diagonals, face, first, halves)) {
			add_face(mesh, face, halves[0], 3, true, cut);
			add_face(mesh, face, halves[1], 3, true, cut);
			mesh->primitives[mesh->face_primitive ? mesh->face_primitive[face] : 0].face_count++;
		} else {
			const uint32_t c = (uint32_t)first, corners[4] = {c, c + 1, c + 2, c + 3};
			add_face(mesh, face, corners, mesh->face_sizes[face], false, cut);
		}
	}
}

/* The cut arrays become the mesh's. */
static void adopt_cut(nt_mesh *mesh, const cut_mesh *cut)
{
	free(mesh->corner_tangents);
	mesh->corner_tangents = cut->tangents[0];
	mesh->indices = cut->indices;
	mesh->face_sizes = cut->sizes;
	mesh->face_polygon = cut->polygon;
	mesh->face_smoothing = mesh->face_smoothing ? cut->smoothing : NULL;
	mesh->face_primitive = mesh->face_primitive ? cut->primitive : NULL;
	mesh->face_count = cut->face_count;
	mesh->corner_count = cut->corner_count;
}

/* Repairs the halves whose sign is not their own. */
static nt_status repair_halves(nt_mesh *mesh, const nmtan_mesh *view, unsigned threads, const uint8_t *flags)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_known known = {.flags = flags, .suspect = CUT, .doubtful = CUT, .positive = POSITIVE};
	const nt_solve solve = {.mesh = view, .corner_count = mesh->corner_count, .threads = threads,
		.repair = true, .scratch = &scratch, .known = &known, .tangents = mesh->corner_tangents};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	const nt_status status = nt_status_of(nt_repair(&solve, &counts));
	nt_scratch_free(&scratch);
	mesh->counts.repaired_sign += nt_counts_repaired(&counts);
	return status;
}

nt_status nt_cut_folded_quads(nt_mesh *mesh, float stored_v_offset, unsigned threads, nt_arena *arena)
{
	nmtan_stored_uv stored;
	nmtan_mesh view = nt_mesh_view(mesh, &stored);
	stored.v_offset = stored_v_offset;
	uint8_t *diagonals = nt_arena_alloc(arena, mesh->face_count, 1);
	if (!diagonals)
		return NT_ERROR_MEMORY;
	const size_t changed = nt_written_diagonals(&view, diagonals);
	const size_t folded = may_be_folded(mesh, changed) ? count_folded(&view, diagonals) : 0;
	if (!folded) {
		mesh->face_diagonals = diagonals;
		return NT_OK;
	}
	cut_mesh cut;
	if (!alloc_cut(mesh, folded, arena, &cut))
		return NT_ERROR_MEMORY;
	cut_faces(mesh, &view, diagonals, &cut);
	adopt_cut(mesh, &cut);
	view.face_count = mesh->face_count;
	view.face_sizes = mesh->face_sizes;
	view.indices = mesh->indices;
	return repair_halves(mesh, &view, threads, cut.flags);
}

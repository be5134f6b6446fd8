/* SPDX-License-Identifier: MIT */
/*
 * The stages of a run, in its order.
 */
#ifndef NT_PIPELINE_STAGES_H
#define NT_PIPELINE_STAGES_H

#include "format/format.h"
#include "pipeline/settings.h"

/* Finds the row of who writes `path`, by settings and name; of a stream without one only when the reader is known: PLY
 * for PLY, else GLB. With settings->check: whose conversion is judged; NULL: the input is judged as it is. `reader` is
 * NULL before the input is read; with it, what its files cannot become is refused. Returns NT_OK, NT_ERROR_USAGE or,
 * where the system cannot tell what is there, NT_ERROR_IO. */
nt_status nt_choose_writer(const nt_settings *settings, const char *path, const nt_format_entry *reader,
	const nt_format_entry **writer, nt_error *error);

/* Whether a writer changes the document that the reader read. */
bool nt_writer_edits(const nt_format_entry *reader, const nt_format_entry *writer);

/* Input of the tasks of a run. */
typedef struct nt_tasks {
	nt_scene *scene;
	const nt_format_entry *reader, *writer; /* writer: NULL: the input is judged as it is */
	const nt_settings *settings;
	const nt_read_options *options;
	nt_textures *textures; /* to be made beside the solve; NULL: none */
	nt_summary *summary;
	void (*begin_stage)(void *run, nt_stage stage);
	void *run;
} nt_tasks;

/* tasks.c. After the plan: loads whatever will be solved, written or reported, makes normals, solves, splits, and hands
 * the writer what it merges. */
nt_status nt_tasks_do(const nt_tasks *tasks, nt_error *error);

/* Makes the normals that meshes lack (all of them when `mode` says replace); vertices whose corners get
 * different normals are split, copies appended. Sets mesh->normals_made where something was made. Then makes
 * unit what is not: see unit_normals.c. */
nt_status nt_stage_normals(nt_scene *scene, nt_normals mode, int degrees, unsigned threads, nt_error *error);

/* Solves and splits every mesh whose decision says so; counts and findings go to the summary. Large
 * meshes take all threads one after the other, small ones run side by side. */
nt_status nt_stage_tangents(nt_scene *scene, const nt_settings *settings, nt_format output,
	nt_summary *summary, nt_error *error);

/* Takes the images that the settings name, for a scene with one material or none. Returns NT_OK, NT_ERROR_IO,
 * NT_ERROR_MEMORY or, where the scene or the output has no place for them or one is no image, NT_ERROR_USAGE. */
nt_status nt_stage_given_maps(nt_scene *scene, const nt_settings *settings, bool makes_document, nt_error *error);

/* A finding, where the input is one person's, has texture coordinates and no normal map, and an image beside it is
 * called after it as one. */
void nt_propose_normal_map(nt_scene *scene, const nt_settings *settings);

/* Finds the images of materials for a document that is made anew, and notes in the materials which they are. output:
 * its path, which stays. *textures is to be freed after failure too. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_stage_textures(nt_scene *scene, const nt_settings *settings, const char *output, nt_textures **textures,
	nt_error *error);

/* nt_stage_tangents(), and beside it the textures are made; these may be NULL. */
nt_status nt_stage_tangents_and_textures(nt_scene *scene, const nt_settings *settings, nt_format output,
	nt_textures *textures, nt_summary *summary, nt_error *error);

/* Adds what is to be said about the images of materials to the findings, and counts materials that have none left;
 * textures: NULL where they were not looked at.
 * Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_tell_textures(nt_scene *scene, const nt_settings *settings, const nt_textures *textures,
	nt_summary *summary, nt_error *error);

/* Examines the normal maps of the output, if settings->check_maps, a report or a mesh with inverted w wants that, and
 * adds what is found of them, and of tangents that are kept. written: NT_FORMAT_UNKNOWN: a glTF is judged as it is.
 * textures: those of materials; NULL: of a glTF, or the output has none. Returns NT_OK, NT_ERROR_IO, NT_ERROR_MEMORY
 * or NT_ERROR_LIMIT. */
nt_status nt_stage_maps(nt_scene *scene, const nt_settings *settings, nt_format written, const nt_textures *textures,
	nt_error *error);

/* Folders in which the maps of materials are looked for, whatever the document. */
static inline nt_image_places nt_searched_places(const nt_settings *settings)
{
	return (nt_image_places){.folders = settings->texture_paths, .folder_count = settings->texture_path_count,
		.root = settings->root, .confined = settings->outside == NT_OUTSIDE_NO,
		.allow_outside = settings->outside == NT_OUTSIDE_YES};
}

/* If an input changed during the run, reports only that; else returns `status`. */
nt_status nt_check_inputs(nt_scene *scene, nt_status status, nt_error *error);

/* Fills summary->report: of the scene as it now is, or of what went wrong. written: the format that is judged,
 * NT_FORMAT_UNKNOWN: the input as it is. textures: what its images become, NULL: nothing. */
nt_status nt_stage_report(nt_scene *scene, const nt_settings *settings, nt_format written, const nt_textures *textures,
	nt_status status, nt_summary *summary, nt_error *error);

/* Fills summary->lines. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_stage_listing(const nt_scene *scene, nt_summary *summary, nt_error *error);

/* Says of every mesh with quads where they are cut (face_diagonals), for writers of triangles. */
nt_status nt_stage_quads(nt_scene *scene, nt_error *error);

/* tangents.c, for tasks.c too: small meshes, of which up to `slots` threads at a time solve one each. NULL: memory is
 * exhausted. */
typedef struct nt_small_solves nt_small_solves;
nt_small_solves *nt_small_solves_begin(nt_scene *scene, const nt_settings *settings, nt_format output, unsigned slots);

/* Solves a mesh, or the join that it is the first of. The scene has the results after nt_small_solves_end(). */
nt_status nt_small_solve(nt_small_solves *small, nt_mesh *mesh, unsigned slot);
void nt_small_solves_end(nt_small_solves *small);

/* Corners from which on a mesh may be worth all threads: it is not solved ahead of others. */
enum { NT_LEAST_ALONE_CORNERS = 3 * 30000 };

/* authored.c, for tangents.c and morphs.c: authored tangents that stay with --existing=repair. If a mesh has texture
 * coordinates, the corners of faces whose tangents are all valid take theirs back after a solve.
 *   solved  [corner_count][4] their w: 0 at corners that did; NULL: it is not asked for */
void nt_restore_authored(nt_mesh *mesh, float *corner_tangents, float *solved);

/* Without texture coordinates no solve is possible: each authored tangent stays or is mended by itself.
 * `tangents` [corner_count][4] is filled. */
void nt_mend_untextured(nt_mesh *mesh, const nmtan_mesh *view, float *tangents);

/* The tangents that a mesh without texture coordinates has when its normals become those of `moved`. */
void nt_turn_untextured(const nt_mesh *mesh, const nmtan_mesh *base, const nmtan_mesh *moved, float *tangents);

/* folded_quads.c, for tangents.c. Cuts the folded quads of a mesh with corner_tangents in two and gives each half its
 * own sign; the mesh gets new faces and indices, or face_diagonals, and cut_arrays to free. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_cut_folded_quads(nt_mesh *mesh, float stored_v_offset, unsigned threads);

/* The number that is added to v on its way between formats that count it from opposite ends: see nmtan_stored_uv. */
static inline float nt_v_offset(nt_format from, nt_format to)
{
	return (float)nt_format_is_gltf(from) - (float)nt_format_is_gltf(to);
}

/* Whether a mesh that nobody solves may be left as it is: it could be loaded, or it is there and cannot be. */
static inline bool nt_may_be_left(nt_status load)
{
	return load != NT_ERROR_MEMORY && load != NT_ERROR_MISSING && load != NT_ERROR_IO;
}

/* kept.c, for tasks.c. Counts what is wrong with tangents that are kept and used, which nt_tell_kept() says once pairs
 * are known. Returns NT_OK, NT_ERROR_MEMORY,
 * or NT_ERROR_MISSING or NT_ERROR_IO where their file cannot be opened. */
nt_status nt_stage_kept(nt_scene *scene, const nt_tasks *tasks, nt_error *error);
void nt_tell_kept(nt_scene *scene);

/* pairs.c. Sets mesh->signs of a loaded mesh with authored tangents and a normal map. */
void nt_judge_w(nt_mesh *mesh);
bool nt_any_inverted(const nt_scene *scene);

/* Whether T and the bitangent are reversed at all corners of a triangle, of vertices v; other_w: with w negated. */
bool nt_runs_backwards(const nt_mesh *mesh, const size_t v[3], int orientation, bool other_w);

/* Sets pair and doubted of meshes whose normal maps are known, of which there are map_count, and adds what is found.
 * Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_find_pairs(nt_scene *scene, const nt_settings *settings, size_t map_count);

/* fix.c. Repairs of --fix, found by a check of the input. */
typedef struct nt_mesh_fix {
	uint8_t existing;    /* its nt_mesh.fix */
	bool keeps_inverted; /* its nt_mesh.keeps_inverted */
	size_t doubtful;     /* triangles with inverted w that a map may cancel which cannot be decoded */
} nt_mesh_fix;

typedef struct nt_fixes {
	nt_mesh_fix *meshes; /* [mesh_count] */
	size_t mesh_count;
	bool *images; /* [image_count] of a glTF whose green is turned; NULL: of another format */
	size_t image_count;
	bool turns_maps;
	size_t counts[NT_CODE_COUNT]; /* primitives and images by the code of the finding */
	bool left[NT_CODE_COUNT];     /* what the options of the code's row repair, whatever else is true */
} nt_fixes;

/* *fixes is to be freed after failure too. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_fixes_make(nt_fixes *fixes, const nt_scene *scene, const nt_report *report);
void nt_fixes_free(nt_fixes *fixes);

/* quads.c. Decides which triangles of a mesh with normals are solved as quads. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_find_halves(nt_scene *scene, nt_mesh *mesh, nt_quads choice, unsigned threads);

/* unit_normals.c, for normals.c. Vertices whose normal has no direction lack it. Both return NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_mark_directionless(nt_scene *scene, nt_mesh *mesh, unsigned threads);

/* Makes normals unit that are not: in mesh->solve_normals if it is a glTF, which keeps those that it has. */
nt_status nt_make_unit_normals(nt_scene *scene, nt_mesh *mesh, unsigned threads);

#endif

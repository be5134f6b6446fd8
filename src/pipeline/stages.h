/* SPDX-License-Identifier: MIT */
/*
 * The stages of a run, in its order.
 */
#ifndef NT_PIPELINE_STAGES_H
#define NT_PIPELINE_STAGES_H

#include "format/format.h"
#include "pipeline/run.h"

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
	nt_format written; /* of the writer; NT_FORMAT_UNKNOWN: there is none */
	const nt_settings *settings;
	const nt_read_options *options;
	nt_textures *textures; /* to be made beside the solve; NULL: none */
	nt_summary *summary;
	void (*begin_stage)(void *run, nt_stage stage);
	void *run;
} nt_tasks;

/* summary.c. Counts what was decided of meshes. Returns whether any gets tangents. */
bool nt_count_decisions(nt_summary *summary, const nt_scene *scene);

/* summary.c. Lists the outcome of each mesh. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_list_meshes(nt_summary *summary, const nt_scene *scene, nt_error *error);

/* summary.c. At the end of a run, which failed with `status`: takes the findings of the scene, and counts the rest. */
void nt_summarise(nt_summary *summary, nt_scene *scene, const nt_settings *settings, nt_status status);

/* jobs.c. After the plan: loads whatever will be solved, written or reported, makes normals, solves, splits, hands the
 * writer what it merges, and says what was found. The textures are made beside. */
nt_status nt_stage_jobs(const nt_tasks *tasks, nt_error *error);

/* normals.c. Makes the normals that a mesh lacks (all of them when `mode` says replace); vertices whose corners get
 * different normals are split, copies appended. Sets mesh->normals_made where something was made. Then makes unit what
 * is not. */
nt_status nt_make_normals(nt_scene *scene, nt_mesh *mesh, nt_normals mode, int degrees, unsigned threads,
	nt_error *error);
void nt_tell_normals(nt_scene *scene, const nt_mesh *mesh, nt_normals mode);

/* solve.c. A mesh, or the join that it is the first of, and what is to be done with it. */
typedef struct nt_job {
	nmtan_options options;
	float v_offset;    /* that v is stored with: none if the format stays, else see nmtan_stored_uv */
	bool triangulates; /* the output has triangles where the input has quads */
	bool splits;       /* something is written, or judged as if it were */
	bool digests;
	nt_arena *arena;   /* gets the results */
} nt_job;

nt_status nt_job_solve(const nt_job *job, nt_mesh *mesh);

/* A mesh that is solved by itself, or the parts of a join. */
typedef struct nt_whole {
	const nt_join *join; /* NULL: one mesh */
	nt_mesh *const *parts; /* [part_count] */
	size_t part_count;
	const nmtan_options *options;
	nmtan_mesh mesh;
	nmtan_stored_uv stored; /* of it */
	size_t corner_count;
	const uint8_t *halves; /* [mesh.face_count]; NULL: there are no quads */
	struct nt_morph_work *works; /* [part_count] while targets are solved */
	/* of a join: */
	nt_arena arena;
	size_t *first_vertex;  /* [part_count + 1] */
	uint32_t *sources;     /* [mesh.vertex_count] vertex of its part */
} nt_whole;

/* joins.c. Puts the parts of a join together; the arena is to be freed after failure too. */
nt_status nt_whole_gather(nt_whole *whole);

/* Tangents of the corners of a mesh like the whole, malloc'ed, also after failure. */
nt_status nt_whole_solve(const nt_whole *whole, const nmtan_mesh *mesh, const nmtan_options *options, float **rows,
	nmtan_counts *counts);

/* Puts rows of three floats of a part's vertices, NULL: none, into those of the whole, which begin as a copy of `base`
 * if *to is NULL. False: memory is exhausted. */
bool nt_whole_put(const nt_whole *whole, size_t part, const float *rows, const float *base, float **to);

/* For a report on meshes that were solved each by itself: a finding for every mesh whose tangents would differ if its
 * join were solved as one. */
nt_status nt_stage_borders(nt_scene *scene, const nt_settings *settings, nt_error *error);

/* morphs.c. Data of a part while its targets are solved. Zeroed: nothing yet. */
typedef struct nt_morph_work {
	struct nt_corner_classes *classes;
	float *solved; /* [corner_count][4] before authored tangents took their place, w: 0 if one did; NULL: the mesh's
	                  corner_tangents */
} nt_morph_work;

/* Authored tangents come back into those that were solved (nt_restore_authored), if they stay with
 * --existing=repair. targets: they will be solved. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_morphs_restore(nt_mesh *mesh, nt_morph_work *work, bool targets);

/* Takes the corner tangents of a target into classes of corners; rows are changed. */
nt_status nt_morphs_classify(const nt_mesh *mesh, nt_morph_work *work, nt_morph *morph, float *rows);

/* How many triangles a target turns to the other side of their normals. */
size_t nt_morphs_count_turned(const nmtan_mesh *base, const nmtan_mesh *moved);

/* Whether corner tangents of a target are turned enough for what is between to matter. */
bool nt_morphs_turn(const nt_mesh *mesh, const nt_morph_work *work, const float *rows);

/* A mesh halfway between its own positions and normals and those it is moved to: malloc'ed, NULL if they are the same
 * pointers. False: memory is exhausted. */
bool nt_morphs_halfway(const nmtan_mesh *base, const nmtan_mesh *moved, float **positions, float **normals);

/* Fills halfway_triangles and halfway_degrees of a target, by its corner tangents and those halfway. */
void nt_morphs_compare_halfway(const nt_mesh *mesh, const nt_morph_work *work, const nmtan_mesh *base,
	const nmtan_mesh *moved, const float *rows, const float *halfway, nt_morph *morph);

/* Writes to keys [corner_count][4] numbers that are equal for two corners of a vertex exactly where the base's and all
 * targets' tangents are: what splitting goes by. */
void nt_morphs_keys(const nt_mesh *mesh, const nt_morph_work *work, float *keys);

/* After a split by keys: vertex tangents of the base, and what nt_morph_read() takes those of targets from. */
nt_status nt_morphs_finish(nt_mesh *mesh, const nt_morph_work *work, size_t source_count, nt_arena *arena);
void nt_morphs_free(nt_morph_work *work);

/* Takes the images that the settings name, for a scene with one material or none. Returns NT_OK, NT_ERROR_IO,
 * NT_ERROR_MEMORY or, where the scene or the output has no place for them or one is no image, NT_ERROR_USAGE. */
nt_status nt_stage_given_maps(nt_scene *scene, const nt_settings *settings, bool makes_document, nt_error *error);

/* A finding, where the input is one person's, has texture coordinates and no normal map, and an image beside it is
 * called after it as one. */
void nt_propose_normal_map(nt_scene *scene, const nt_settings *settings);

/* map_requests.c. The images that are requested for the maps of a material. */
typedef struct nt_map_request {
	nt_map *maps[4]; /* of the request's channels; of colours the first stands for three; NULL: none */
	nt_texture_request what;
} nt_map_request;

/* How far white is above black, as the settings or by default. */
double nt_bump_height(const nt_settings *settings);

/* Fills `requests` for the maps that a material has; returns how many there are. */
size_t nt_map_requests(nt_material *material, const nt_settings *settings, nt_map_request requests[NT_MATERIAL_MAPS]);

/* A map whose image is lost is none any more, nor is the roughness of a coat that there is not. lost: a bit for each
 * channel of the request. */
void nt_map_request_settle(nt_material *material, const nt_map_request *request, unsigned lost);

/* textures.c. Finds the images of materials for a document that is made anew, and notes in the materials which they
 * are. output: its path, which stays. *textures is to be freed after failure too. Returns NT_OK, NT_ERROR_IO or
 * NT_ERROR_MEMORY. */
nt_status nt_stage_textures(nt_scene *scene, const nt_settings *settings, const char *output, nt_textures **textures,
	nt_error *error);

/* Makes them. */
nt_status nt_make_textures(nt_textures *textures, const nt_settings *settings, nt_error *error);

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
		.root = settings->root, .confined = settings->io.outside == NT_OUTSIDE_NO,
		.allow_outside = settings->io.outside == NT_OUTSIDE_YES};
}

/* If an input changed during the run, reports only that; else returns `status`. */
nt_status nt_check_inputs(nt_scene *scene, nt_status status, nt_error *error);

/* Fills summary->report: of the scene as it now is, or of what went wrong. written: the format that is judged,
 * NT_FORMAT_UNKNOWN: the input as it is. textures: what its images become, NULL: nothing. */
nt_status nt_stage_report(nt_scene *scene, const nt_settings *settings, nt_format written, const nt_textures *textures,
	nt_status status, nt_summary *summary, nt_error *error);

/* Says of every mesh with quads where they are cut (face_diagonals), for writers of triangles. */
nt_status nt_stage_quads(nt_scene *scene, nt_error *error);

/* authored.c, for solve.c and morphs.c: authored tangents that stay with --existing=repair. If a mesh has texture
 * coordinates, the corners of faces whose tangents are all valid take theirs back after a solve.
 *   solved  [corner_count][4] their w: 0 at corners that did; NULL: it is not asked for */
void nt_restore_authored(nt_mesh *mesh, float *corner_tangents, float *solved);

/* Without texture coordinates no solve is possible: each authored tangent stays or is mended by itself.
 * `tangents` [corner_count][4] is filled. */
void nt_mend_untextured(nt_mesh *mesh, const nmtan_mesh *view, float *tangents);

/* The tangents that a mesh without texture coordinates has when its normals become those of `moved`. */
void nt_turn_untextured(const nt_mesh *mesh, const nmtan_mesh *base, const nmtan_mesh *moved, float *tangents);

/* quads.c, for solve.c. Cuts the folded quads of a mesh with corner_tangents in two and gives each half its
 * own sign; the mesh gets new faces and indices, or face_diagonals, which are the arena's. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_cut_folded_quads(nt_mesh *mesh, float stored_v_offset, unsigned threads, nt_arena *arena);

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

/* authored.c. Counts what is wrong with tangents of a loaded mesh that are kept and used; nt_tell_kept() says whether w
 * is right once pairs are known. Scratch is the scene's. halved: as nt_find_pairs() has it; NULL: of none. */
void nt_look_at_kept(nt_scene *scene, nt_mesh *mesh, nt_format written, unsigned threads);
void nt_tell_kept(nt_scene *scene, const bool *halved);

/* pairs.c. Sets mesh->signs of a loaded mesh with authored tangents and a normal map. */
void nt_judge_w(nt_mesh *mesh);
bool nt_any_inverted(const nt_scene *scene);

/* A triangle, of vertices v, has an orientation by which w is judged, of its texture coordinates, with v_offset
 * added to v; a sign of w at all its corners, 0: some have none; and whether T and the bitangent are reversed at all of
 * them. tangents: NULL: the mesh's; other_w: with w negated. */
enum { NT_W_MIXED = 2 };
static inline int nt_uv_sign(const nt_mesh *mesh, const size_t v[3], float v_offset)
{
	float uv[3][2];
	for (size_t k = 0; k < 3; k++) {
		uv[k][0] = mesh->texcoords[2 * v[k]];
		uv[k][1] = mesh->texcoords[2 * v[k] + 1] + v_offset;
	}
	return (mesh->solve_texcoords ? mesh->solve_sign : 1) * nmtan_orientation(uv[0], uv[1], uv[2]);
}

static inline int nt_w_sign(const nt_mesh *mesh, const size_t v[3])
{
	int positive = 0, negative = 0;
	for (int k = 0; k < 3; k++) {
		positive += mesh->tangents[4 * v[k] + 3] > 0.0f;
		negative += mesh->tangents[4 * v[k] + 3] < 0.0f;
	}
	return positive + negative < 3 ? 0 : positive == 3 ? 1 : negative == 3 ? -1 : NT_W_MIXED;
}

bool nt_runs_backwards(const nt_mesh *mesh, const size_t v[3], const float *const tangents[3], int orientation,
	bool other_w);

/* Sets pair and doubt of meshes whose normal maps are known, of which there are map_count, and adds what is found.
 * halved: [mesh_count] zeroed; receives whether this run changes one half of a mesh's pair alone. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_find_pairs(nt_scene *scene, const nt_settings *settings, size_t map_count, bool *halved);

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

#endif

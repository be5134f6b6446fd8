/* SPDX-License-Identifier: MIT */
/*
 * The stages between reading and writing, each on one mesh of a scene.
 */
#ifndef NT_PIPELINE_STAGES_H
#define NT_PIPELINE_STAGES_H

#include "pipeline/settings.h"

/* Makes the normals a mesh lacks (all of them when `mode` says replace); vertices whose corners get
 * different normals are split, copies appended. Sets mesh->normals_made where something was made. Then gives the mesh
 * solve_normals where its normals are not of unit length. */
nt_status nt_stage_normals(nt_scene *scene, nt_mesh *mesh, nt_normals mode, nt_error *error);

/* The findings of it, of a mesh that shares them too. */
void nt_report_normals(nt_scene *scene, const nt_mesh *mesh);

/* Solves and splits every mesh whose decision says so; counts and findings go to the summary. Large
 * meshes take all threads one after the other, small ones run side by side. */
nt_status nt_stage_tangents(nt_scene *scene, const nt_settings *settings, nt_format output,
	nt_summary *summary, nt_error *error);

/* Fills summary->lines. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_stage_listing(const nt_scene *scene, nt_summary *summary, nt_error *error);

/* Says of every mesh with quads where they are cut (face_diagonals). For writers of triangles. */
nt_status nt_stage_quads(nt_scene *scene, nt_error *error);

/* folded_quads.c, for tangents.c. Cuts the folded quads of a mesh with corner_tangents in two and gives each half its
 * own sign; the mesh gets new faces and indices, and cut_arrays to free. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_cut_folded_quads(nt_mesh *mesh, float stored_v_offset, unsigned threads);

/* unit_normals.c, for normals.c. Vertices whose normal has no direction lack it. Both return NT_OK or NT_ERROR_MEMORY. */
nt_status nt_mark_directionless(nt_scene *scene, nt_mesh *mesh);

/* Makes mesh->solve_normals where normals are not of unit length. */
nt_status nt_make_unit_normals(nt_scene *scene, nt_mesh *mesh);

#endif

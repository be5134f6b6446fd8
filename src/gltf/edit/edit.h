/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: see plan.c and edit.c.
 */
#ifndef NT_GLTF_EDIT_EDIT_H
#define NT_GLTF_EDIT_EDIT_H

#include "file/output.h"
#include "scene/scene.h"

/* Writes the source document with tangents put in, and nothing else changed. */
nt_status nt_gltf_edit(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

/* Makes the plan: after the decisions, before anything is loaded. */
nt_status nt_gltf_plan(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* draco_plan.c, for plan.c: sets plan.quantized of meshes that an edit of the document with these options will compress
 * by Draco, and lays the grids of joins. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_find_quantized(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif

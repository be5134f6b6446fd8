/* SPDX-License-Identifier: MIT */
/*
 * What is to be done with each mesh of a document: see plan.c.
 */
#ifndef NT_GLTF_EDIT_PLAN_H
#define NT_GLTF_EDIT_PLAN_H

#include "gltf/document.h"

/* For the table of formats, after the decisions and before anything is loaded. */
nt_status nt_gltf_plan(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* After the decisions and before anything is loaded: sets ->quantized of meshes that an edit of the document with
 * these options will compress by Draco, and lays the grids of joins. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_find_quantized(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif

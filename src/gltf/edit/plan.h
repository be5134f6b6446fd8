/* SPDX-License-Identifier: MIT */
/*
 * What is to be done with each mesh of a document: see plan.c.
 */
#ifndef NT_GLTF_EDIT_PLAN_H
#define NT_GLTF_EDIT_PLAN_H

#include "gltf/document.h"

/* For the table of formats, after the decisions and before anything is loaded. */
nt_status nt_gltf_plan(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif

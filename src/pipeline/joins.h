/* SPDX-License-Identifier: MIT */
/*
 * Primitives that are solved as one mesh: for pipeline/tangents.c and run.c.
 */
#ifndef NT_PIPELINE_JOINS_H
#define NT_PIPELINE_JOINS_H

#include "pipeline/settings.h"

/* Solves the parts of a join as one mesh, and, where they are wanted, as its morph targets move it. The meshes of the
 * scene among them get their corner_tangents and counts, and their morph targets corner_tangents and what is said of
 * them; blocks are malloc'ed, also after failure. */
nt_status nt_join_solve(const nt_join *join, float stored_v_offset, bool targets, const nmtan_options *options);

/* For a report on meshes that were solved each by itself: a finding for every mesh whose tangents would differ if its
 * join were solved as one. */
nt_status nt_stage_borders(nt_scene *scene, const nt_settings *settings, nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Meshes that are solved while they are written: for run.c.
 */
#ifndef NT_PIPELINE_LATE_H
#define NT_PIPELINE_LATE_H

#include "pipeline/stages.h"

/* What loading and solving them takes. */
typedef struct nt_late {
	nt_scene *scene;
	const nt_format_entry *reader;
	const nt_settings *settings;
	const nt_read_options *options;
	nt_format output;
	nt_summary *summary;
	void (*begin_stage)(void *run, nt_stage stage);
	void *run;
	nt_mesh *meshes; /* [mesh_count] those of the last call */
	size_t mesh_count;
	nt_arena arena;  /* what they hold */
} nt_late;

/* scene->solve_late with an nt_late: [first, first + count) of scene->meshes. */
nt_status nt_late_solve(void *late, size_t first, size_t count, nt_error *error);

void nt_late_free(nt_late *late);

#endif

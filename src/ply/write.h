/* SPDX-License-Identifier: MIT */
/*
 * Writing PLY, for the table of formats: a PLY is rewritten, any other scene exported.
 */
#ifndef NT_PLY_WRITE_H
#define NT_PLY_WRITE_H

#include "file/output.h"
#include "scene/scene.h"

nt_status nt_ply_write(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

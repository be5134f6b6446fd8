/* SPDX-License-Identifier: MIT */
/*
 * Writing PLY, for the table of formats: a PLY is rewritten, any other scene exported.
 */
#ifndef NT_IO_PLY_WRITER_H
#define NT_IO_PLY_WRITER_H

#include "io/file.h"
#include "scene/scene.h"

nt_status nt_ply_write(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

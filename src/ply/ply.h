/* SPDX-License-Identifier: MIT */
/*
 * Reading and writing PLY, for the table of formats: a PLY is rewritten, any other scene exported.
 */
#ifndef NT_PLY_PLY_H
#define NT_PLY_PLY_H

#include "file/output.h"
#include "scene/scene.h"

bool nt_ply_recognise(const unsigned char *bytes, size_t size);

/* Describes and loads the mesh of scene->bytes. */
nt_status nt_ply_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

nt_status nt_ply_write(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

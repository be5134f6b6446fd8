/* SPDX-License-Identifier: MIT */
/*
 * Reading PLY, for the table of formats.
 */
#ifndef NT_PLY_READ_H
#define NT_PLY_READ_H

#include "scene/scene.h"

bool nt_ply_recognise(const unsigned char *bytes, size_t size);

/* Describes and loads the mesh of scene->bytes. */
nt_status nt_ply_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif

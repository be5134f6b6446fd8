/* SPDX-License-Identifier: MIT */
/*
 * Reading OBJ, for the table of formats.
 */
#ifndef NT_OBJ_READ_H
#define NT_OBJ_READ_H

#include "scene/scene.h"

bool nt_obj_recognise(const unsigned char *bytes, size_t size);

/* Describes and loads the meshes of scene->bytes. */
nt_status nt_obj_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif

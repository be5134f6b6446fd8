/* SPDX-License-Identifier: MIT */
/*
 * Reading Draco files (.drc), for the table of formats.
 */
#ifndef NT_FORMAT_DRC_H
#define NT_FORMAT_DRC_H

#include "scene/scene.h"

bool nt_drc_recognise(const unsigned char *bytes, size_t size);

/* Describes and loads the mesh of scene->bytes. */
nt_status nt_drc_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif

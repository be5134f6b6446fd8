/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: see edit.c.
 */
#ifndef NT_GLTF_EDIT_EDIT_H
#define NT_GLTF_EDIT_EDIT_H

#include "file/output.h"
#include "scene/scene.h"

/* Writes the source document with tangents put in, and nothing else changed. */
nt_status nt_gltf_edit(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

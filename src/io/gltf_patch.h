/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: see gltf_patch.c.
 */
#ifndef NT_IO_GLTF_PATCH_H
#define NT_IO_GLTF_PATCH_H

#include "io/file.h"
#include "scene/scene.h"

/* Writes the source document with tangents put in, and nothing else changed. */
nt_status nt_gltf_patch(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

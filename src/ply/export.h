/* SPDX-License-Identifier: MIT */
/*
 * PLY from a scene of any other format.
 */
#ifndef NT_PLY_EXPORT_H
#define NT_PLY_EXPORT_H

#include "ply/encode.h"
#include "scene/scene.h"

/* Binary, little endian, in world space. */
nt_status ply_write_scene(nt_scene *scene, const nt_write_options *options, ply_output *out,
	nt_error *error);

#endif

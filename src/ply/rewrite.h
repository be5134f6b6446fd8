/* SPDX-License-Identifier: MIT */
/*
 * PLY from a PLY: the file as it was, with the tangents added.
 */
#ifndef NT_PLY_REWRITE_H
#define NT_PLY_REWRITE_H

#include "ply/encode.h"
#include "scene/scene.h"

/* The scene was read from a PLY. Sets out->encoding. */
nt_status ply_write_source(nt_scene *scene, const nt_write_options *options, ply_output *out,
	nt_error *error);

#endif

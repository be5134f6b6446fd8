/* SPDX-License-Identifier: MIT */
/*
 * glTF from any other format: a new document.
 */
#ifndef NT_GLTF_CREATE_CREATE_H
#define NT_GLTF_CREATE_CREATE_H

#include "file/output.h"
#include "scene/scene.h"

nt_status nt_gltf_compose(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * glTF from any other format: a new document.
 */
#ifndef NT_IO_GLTF_COMPOSE_H
#define NT_IO_GLTF_COMPOSE_H

#include "io/file.h"
#include "scene/scene.h"

nt_status nt_gltf_compose(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Accessors that several compressed primitives name: see draco_shared.c.
 */
#ifndef NT_GLTF_DRACO_SHARED_H
#define NT_GLTF_DRACO_SHARED_H

#include "gltf/document.h"

/* Gives each content an accessor of its own. What is malformed is left for loading to find. Returns NT_OK,
 * NT_ERROR_INPUT (dangling.h) or NT_ERROR_MEMORY. */
nt_status nt_gltf_separate_draco(nt_gltf *document, nt_error *error);

#endif

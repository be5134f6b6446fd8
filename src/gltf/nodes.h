/* SPDX-License-Identifier: MIT */
/*
 * Who shows which mesh, and where: see nodes.c.
 */
#ifndef NT_GLTF_NODES_H
#define NT_GLTF_NODES_H

#include "gltf/document.h"

/* Marks the meshes that a scene shows: reached[mesh]. Faulty nodes are passed over. */
nt_status nt_gltf_reach(const nt_gltf *document, bool *reached, size_t mesh_count, nt_error *error);

/* Calls place(context, mesh, matrix) for every mesh in the world of the default scene (of all roots,
 * where there is no scene). */
nt_status nt_gltf_walk_world(const nt_gltf *document,
	nt_status (*place)(void *context, uint64_t mesh, const double matrix[16]), void *context,
	nt_error *error);

#endif

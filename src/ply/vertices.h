/* SPDX-License-Identifier: MIT */
/*
 * The rows of the vertex element of a PLY become the attributes of a mesh.
 */
#ifndef NT_PLY_VERTICES_H
#define NT_PLY_VERTICES_H

#include "ply/cursor.h"
#include "ply/source.h"
#include "scene/scene.h"

/* Reads the rows of the vertex element at the cursor into the mesh. */
nt_status ply_read_vertices(nt_scene *scene, nt_mesh *mesh, const ply_source *source,
	ply_cursor *cursor, nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The rows of faces or strips of a PLY become faces of a mesh.
 */
#ifndef NT_PLY_FACES_H
#define NT_PLY_FACES_H

#include "ply/cursor.h"
#include "ply/source.h"
#include "scene/scene.h"

/* Reads the faces (or strips) at the cursor into the mesh, whose positions are there. */
nt_status ply_read_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_cursor *cursor,
	nt_error *error);

#endif

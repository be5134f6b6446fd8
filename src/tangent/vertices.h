/* SPDX-License-Identifier: MIT */
/*
 * Solve, repair and split in one: what nmtan_vertex_tangents() stands on.
 */
#ifndef NT_TANGENT_VERTICES_H
#define NT_TANGENT_VERTICES_H

#include "tangent/solve.h"
#include "topology/split.h"

/* MikkTSpace for vertices. solve->tangents is scratch and may or may not be filled. Returns what
 * nmtan_vertex_tangents() does. */
nmtan_status nt_mikktspace_vertices(const nt_solve *solve, bool repair, nmtan_counts *counts,
	nt_splitter *splitter);

/* Takes every corner's row of solve->tangents. */
nmtan_status nt_split_rows(const nt_solve *solve, nt_splitter *splitter);

#endif

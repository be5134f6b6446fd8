/* SPDX-License-Identifier: MIT */
/*
 * Plain meshes, the only ones that the solve knows: 32-bit indices, one row of each attribute for each vertex, v up.
 */
#ifndef NT_TOPOLOGY_PLAIN_H
#define NT_TOPOLOGY_PLAIN_H

#include "base/scratch.h"
#include "nmtan.h"

/*
 * Makes a mesh plain, whose faces nt_check_faces() has accepted and whose strides are filled in; of attributes that are
 * NULL nothing is made. New arrays are in the scratch; a plain mesh stays as it is, at no cost.
 *
 *   corners  receives NULL or, where vertices have come into being, the first corner of each: [mesh->vertex_count]
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_make_plain(nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch, const uint32_t **corners);

#endif

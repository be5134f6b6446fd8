/* SPDX-License-Identifier: MIT */
/*
 * Plain primitives that shall be compressed: see draco_gather.c.
 */
#ifndef NT_GLTF_EDIT_DRACO_GATHER_H
#define NT_GLTF_EDIT_DRACO_GATHER_H

#include "gltf/edit/draco_block.h"

/* The attributes of a plain primitive; recoding->obstacle where it cannot be compressed. */
nt_status nt_gltf_draco_gather_plain(nt_gltf_recoding *recoding, nt_error *error);

/* Takes what the block holds out of the buffers, and gives the primitive its extension. */
nt_status nt_gltf_draco_take_out(nt_gltf_recoding *recoding, nt_error *error);

#endif

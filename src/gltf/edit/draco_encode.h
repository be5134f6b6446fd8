/* SPDX-License-Identifier: MIT */
/*
 * Encoding of Draco blocks: see draco_encode.c.
 */
#ifndef NT_GLTF_EDIT_DRACO_ENCODE_H
#define NT_GLTF_EDIT_DRACO_ENCODE_H

#include "gltf/edit/draco_block.h"

/* Encodes what was looked up: ->encoded then, with the block or the obstacle. Looks at no JSON, so that several may be
 * encoded at once. Returns NT_OK or what is not the mesh's fault: NT_ERROR_MEMORY, NT_ERROR_MODULE, NT_ERROR_IO. */
nt_status nt_gltf_draco_encode(nt_gltf_recoding *recoding, nt_error *error);

/* The same for several on several threads; the list gets another order. One that fails is left as it was, for
 * nt_gltf_draco_encode(), which has it alone and says what is wrong. */
void nt_gltf_draco_encode_all(nt_gltf_recoding **list, size_t count, unsigned threads);

#endif

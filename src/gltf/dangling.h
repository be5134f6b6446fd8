/* SPDX-License-Identifier: MIT */
/*
 * References to what a file does not have: see dangling.c.
 */
#ifndef NT_GLTF_DANGLING_H
#define NT_GLTF_DANGLING_H

#include "gltf/document.h"

/* Notes the lowest dangling references of a document that nothing was added to yet. Does nothing the second time. */
void nt_gltf_find_dangling(nt_gltf *document);

/* NT_ERROR_INPUT with the place of a reference if what was added since then took the number that it names. */
nt_status nt_gltf_check_dangling(const nt_gltf *document, nt_error *error);

#endif

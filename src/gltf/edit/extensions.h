/* SPDX-License-Identifier: MIT */
/*
 * The lists of extensions: see extensions.c.
 */
#ifndef NT_GLTF_EDIT_EXTENSIONS_H
#define NT_GLTF_EDIT_EXTENSIONS_H

#include "gltf/document.h"

/* Adds an extension to extensionsUsed or extensionsRequired, where it is not there yet. */
void nt_gltf_list_extension(nt_gltf *document, const char *list, const char *name);

/* Takes an extension off "extensionsUsed" or "extensionsRequired". */
void nt_gltf_remove_extension(nt_gltf *document, const char *list, const char *name);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The lists of extensions: see gltf_extensions.c.
 */
#ifndef NT_IO_GLTF_EXTENSIONS_H
#define NT_IO_GLTF_EXTENSIONS_H

#include "io/gltf_document.h"

/* Adds an extension to extensionsUsed or extensionsRequired, where it is not there yet. */
void nt_gltf_list_extension(nt_gltf *document, const char *list, const char *name);

/* Takes an extension off "extensionsUsed" or "extensionsRequired". */
void nt_gltf_remove_extension(nt_gltf *document, const char *list, const char *name);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * tinygltf is a second opinion on files that we wrote, since its parser is not ours. The bytes of buffers and
 * images stay with the caller: nothing here opens a file.
 */
#ifndef NT_EXT_TINYGLTF_H
#define NT_EXT_TINYGLTF_H

#include "base/text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Gives the bytes of a file that a document refers to, by its URI after percent-decoding. They must stay
 * until the next call. False: there is none, which is an error for buffers and none for images. */
typedef bool (*nt_tinygltf_find)(void *user, const char *uri, const unsigned char **bytes, size_t *size);

/*
 * Whether tinygltf takes a .glb or .gltf. Images are not decoded, nor is what is compressed.
 *
 *   bytes  [size] the file
 *   find   called for buffers and images in other files; NULL: there are none
 *
 * Returns NT_OK; NT_ERROR_INPUT with tinygltf's words when it refuses the file, or JSON is nested
 * deeper than 512; NT_ERROR_UNSUPPORTED from 4 GB on, which its interface cannot take; NT_ERROR_MEMORY.
 */
nt_status nt_tinygltf_accept(const unsigned char *bytes, size_t size, nt_tinygltf_find find, void *user,
	nt_error *error);

#ifdef __cplusplus
}
#endif
#endif

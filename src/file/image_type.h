/* SPDX-License-Identifier: MIT */
/*
 * Image files that glTF can refer to, told by their first bytes.
 */
#ifndef NT_FILE_IMAGE_TYPE_H
#define NT_FILE_IMAGE_TYPE_H

#include <stddef.h>

typedef enum nt_image_type {
	NT_IMAGE_OTHER, /* glTF does not carry it */
	NT_IMAGE_PNG,
	NT_IMAGE_JPEG,
	NT_IMAGE_KTX2,
	NT_IMAGE_WEBP
} nt_image_type;

nt_image_type nt_image_type_of_bytes(const unsigned char *bytes, size_t size);

/* By the extension of a name, in any case: for files that are not there. */
nt_image_type nt_image_type_of_name(const char *name);

/* "image/png"; NULL for NT_IMAGE_OTHER. */
const char *nt_image_media_type(nt_image_type type);

/* The glTF extension through which a texture refers to such an image; NULL: the core does. */
const char *nt_image_extension(nt_image_type type);

#endif

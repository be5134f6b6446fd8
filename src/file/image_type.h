/* SPDX-License-Identifier: MIT */
/*
 * Types of image files, told by their first bytes. glTF carries some; the others are known so that they can be
 * converted or named.
 */
#ifndef NT_FILE_IMAGE_TYPE_H
#define NT_FILE_IMAGE_TYPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum nt_image_type {
	NT_IMAGE_OTHER,
	NT_IMAGE_PNG, /* these four glTF carries */
	NT_IMAGE_JPEG,
	NT_IMAGE_KTX2,
	NT_IMAGE_WEBP,
	NT_IMAGE_TGA,
	NT_IMAGE_BMP,
	NT_IMAGE_PSD,
	NT_IMAGE_HDR,
	NT_IMAGE_TIFF,
	NT_IMAGE_EXR
} nt_image_type;

/* A TGA has no signature; it is told by a header that no other format here has. */
nt_image_type nt_image_type_of_bytes(const unsigned char *bytes, size_t size);

/* By the extension of a name, in any case: for files that are not there. */
nt_image_type nt_image_type_of_name(const char *name);

/* "PNG"; for NT_IMAGE_OTHER "unknown". */
const char *nt_image_type_name(nt_image_type type);

/* Whether a glTF can refer to it, by itself or with an extension. */
bool nt_image_is_carried(nt_image_type type);

/* "image/png"; NULL where glTF does not carry it. */
const char *nt_image_media_type(nt_image_type type);

/* The glTF extension through which a texture refers to such an image; NULL: the core does. */
const char *nt_image_extension(nt_image_type type);

/* image_size.c. Width and height of a PNG, JPEG, WebP, TGA, BMP, PSD, HDR or TIFF, as its header says; false, and both
 * 0, for other types, damaged headers and images without pixels. */
bool nt_image_size(const unsigned char *bytes, size_t size, uint32_t pixels[2]);

/* The pixels that a decoder goes over: those of a JPEG of several scans once for each, those of a TIFF with all of its
 * tiles. 0: not known. */
uint64_t nt_image_work(const unsigned char *bytes, size_t size);

#endif

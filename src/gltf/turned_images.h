/* SPDX-License-Identifier: MIT */
/*
 * Images of a glTF that get other pixels: who makes them (format/turned_maps.c) hands them to who writes the document
 * (gltf/edit/images.c).
 */
#ifndef NT_GLTF_TURNED_IMAGES_H
#define NT_GLTF_TURNED_IMAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct nt_turned_image {
	uint32_t image;       /* of the document as it is now */
	bool replaces;        /* nobody needs the old pixels; else it is a copy of an image that others use */
	const char *suffix;   /* of the name of a file */
	unsigned char *bytes; /* [size] a PNG, malloc'ed */
	size_t size;
} nt_turned_image;

typedef struct nt_turned_images {
	nt_turned_image *items; /* [count] */
	size_t count, capacity;
} nt_turned_images;

#endif

/* SPDX-License-Identifier: MIT */
/*
 * How many pixels an image file has, from its header alone.
 */
#ifndef NT_FILE_IMAGE_SIZE_H
#define NT_FILE_IMAGE_SIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Width and height of a PNG or JPEG; false, and both 0, for other types, damaged headers and images without pixels. */
bool nt_image_size(const unsigned char *bytes, size_t size, uint32_t pixels[2]);

#endif

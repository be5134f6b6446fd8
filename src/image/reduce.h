/* SPDX-License-Identifier: MIT */
/*
 * Images made small, for looking at.
 */
#ifndef NT_IMAGE_REDUCE_H
#define NT_IMAGE_REDUCE_H

#include "image/image.h"

/*
 * Makes a JPEG of an image whose longer side has at most `most` pixels; transparency is lost. A JPEG is decoded only
 * as far as that takes. An image of more than 8192 x 8192 pixels is not decoded.
 *
 *   jpeg, jpeg_size  receive the file in a malloc'ed block, NULL after a failure
 *
 * Returns what nt_image_decode() does.
 */
nt_status nt_image_reduce(const unsigned char *bytes, size_t size, uint32_t most, unsigned char **jpeg,
	size_t *jpeg_size, nt_error *error);

#endif

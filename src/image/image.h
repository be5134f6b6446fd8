/* SPDX-License-Identifier: MIT */
/*
 * Images: bytes of any format to samples, samples to PNG. Knows no scene, no material, no files; nt_pixels and its
 * limits are in ext/codec/pixels.h.
 *
 *     nt_pixels pixels;
 *     nt_status status = nt_image_decode(bytes, size, &pixels, error);
 *     if (!status)
 *         status = nt_encode_png(&pixels, &png, &png_size, error);
 *     nt_pixels_free(&pixels);
 */
#ifndef NT_IMAGE_IMAGE_H
#define NT_IMAGE_IMAGE_H

#include "ext/codec/pixels.h"
#include "file/image_type.h"

/* Whether nt_image_decode() knows the format. */
bool nt_image_is_decoded(nt_image_type type);

/* Whether another image may take its place. WebP stays as it is: normal maps of heights apart. */
bool nt_image_is_converted(nt_image_type type);

/*
 * Whether a run may decode and make so many pixels.
 *
 *   most        as the user has it; 0: 2^34, which is 1 024 maps of 4096 x 4096, or more for files that have a byte for
 *               256 pixels, as all have that are not of one colour
 *   file_bytes  of the images
 *
 * Returns NT_OK or NT_ERROR_LIMIT.
 */
nt_status nt_check_pixels(uint64_t pixels, uint64_t most, uint64_t file_bytes, nt_error *error);

/* Whether a decoder may be asked for so many pixels (nt_image_work()) of one image. Without the user's word it is asked
 * for 64 times those that a file of its size has at best, as above: twice what bits of one colour come to in Deflate.
 * Returns NT_OK or NT_ERROR_LIMIT; the error names the file, unless that is NULL. */
nt_status nt_check_image(uint64_t pixels, uint64_t most, uint64_t file_bytes, const char *path, nt_error *error);

/*
 * Decodes PNG, JPEG, WebP, TGA, BMP, PSD, HDR and TIFF, told by content.
 *
 *   bytes, size  the file; any bytes
 *   pixels       receives the samples, rows from the top; nt_pixels_free(); empty after a failure
 *
 * Returns NT_OK; NT_ERROR_INPUT: damaged or cut short; NT_ERROR_UNSUPPORTED: another format, a rare variant of one
 * of these, or more than NT_PIXELS_MOST pixels; or NT_ERROR_MEMORY. The error names no file.
 */
nt_status nt_image_decode(const unsigned char *bytes, size_t size, nt_pixels *pixels, nt_error *error);

/* So many of 255 levels the red, green and blue of a grey may differ by after chroma was rounded, by JPEG or by what
 * scaled the image. */
enum { NT_NEARLY_GREY = 6 };

/* Whether red, green and blue of every pixel differ by so many levels at most. */
bool nt_pixels_are_grey(const nt_pixels *pixels, int levels);

/* Whether all pixels of a file are nearly grey; only as many rows are decoded as it takes to see that one is not, if
 * the format permits. The same statuses. */
nt_status nt_image_is_grey(const unsigned char *bytes, size_t size, bool *grey, nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Images as samples, and the libraries that decode and encode them. Bytes may be anything: what a library cannot
 * decode, and what is larger than an image may be, is an error before memory is asked for. Threads may use all of it at
 * once.
 *
 * Every decoder fills *pixels on success alone and returns NT_OK, NT_ERROR_INPUT (damaged, truncated),
 * NT_ERROR_UNSUPPORTED (sound, but of a kind that it does not decode, or too large) or NT_ERROR_MEMORY. The error says
 * why, without the file's name.
 */
#ifndef NT_EXT_CODEC_PIXELS_H
#define NT_EXT_CODEC_PIXELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/text.h"

typedef struct nt_pixels {
	uint32_t width, height; /* at least 1 */
	unsigned channels;      /* 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA */
	unsigned bits;          /* of a sample: 8 or 16 */
	bool srgb;              /* the file says that its samples are sRGB */
	bool lossy;             /* the file's compression is: JPEG, and most WebP */
	void *samples;          /* [height][width][channels] of uint8_t or uint16_t, rows from the top; free() */
} nt_pixels;

/* Largest image: a map of 16384 x 16384, with at most two bytes for each of four channels. */
#define NT_PIXELS_MOST       ((uint64_t)16384 * 16384)
#define NT_PIXELS_MOST_BYTES ((uint64_t)2 << 30)

/* For decoders: whether an image may be so large, and not empty; and the same with memory for its samples. */
nt_status nt_pixels_check(uint64_t width, uint64_t height, unsigned channels, unsigned bits, nt_error *error);
nt_status nt_pixels_create(nt_pixels *pixels, uint64_t width, uint64_t height, unsigned channels, unsigned bits,
	nt_error *error);
void nt_pixels_free(nt_pixels *pixels);

size_t nt_pixels_row_bytes(const nt_pixels *pixels);

/* `rows`: how many are wanted from the top, at least 1; the height is that of what was decoded. */
nt_status nt_decode_png(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error);
nt_status nt_decode_jpeg(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error);
/* Whole, or a half, a quarter or an eighth of it, whichever is least with a longer side of `least` or more: less is
 * decoded then. */
nt_status nt_decode_jpeg_small(const unsigned char *bytes, size_t size, uint32_t least, nt_pixels *pixels,
	nt_error *error);
/* Not an animation, which is NT_ERROR_UNSUPPORTED. */
nt_status nt_decode_webp(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error);
nt_status nt_decode_tiff(const unsigned char *bytes, size_t size, nt_pixels *pixels, nt_error *error);
/* TGA, BMP, PSD (the flattened image; 8 and 16 bits) and HDR, which becomes sRGB of 8 bits: white is 1. */
nt_status nt_decode_stb(const unsigned char *bytes, size_t size, nt_pixels *pixels, nt_error *error);

/* A PNG in a malloc'ed block. Same samples, same bytes. Returns NT_OK, NT_ERROR_MEMORY or NT_ERROR_INTERNAL. */
nt_status nt_encode_png(const nt_pixels *pixels, unsigned char **bytes, size_t *size, nt_error *error);

/* A JPEG of grey or RGB of 8 bits in a malloc'ed block; the same promise. quality: 1 to 100. Returns NT_OK,
 * NT_ERROR_MEMORY, or NT_ERROR_INPUT: more than 65500 rows or columns. */
nt_status nt_encode_jpeg(const nt_pixels *pixels, int quality, unsigned char **bytes, size_t *size, nt_error *error);

#endif

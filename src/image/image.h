/* SPDX-License-Identifier: MIT */
/*
 * Images: bytes of any format to samples, samples to PNG; and what is made of samples, and seen in them. Knows no
 * scene, no material, no files; nt_pixels and its limits are in ext/codec/pixels.h.
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
#include "file/input.h"

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

/* ---- channels of others put together (occlusion, roughness and metallic; alpha beside colours): pack.c ---- */

/* Which number of a pixel is meant. In a grey image red, green and blue are the grey; an image without alpha is
 * opaque. */
typedef enum nt_channel {
	NT_CHANNEL_RED, NT_CHANNEL_GREEN, NT_CHANNEL_BLUE, NT_CHANNEL_ALPHA,
	NT_CHANNEL_LUMINANCE, /* 0.2126 red + 0.7152 green + 0.0722 blue of the samples as they are */
	NT_CHANNEL_OPACITY    /* alpha where it is not the same everywhere, else luminance */
} nt_channel;

/* A number from 0 to 1 of a sample v from 0 to 1. With x = base + gain v, clamped to 0 to 1 without an exponent,
 * it is x; with an exponent, (2 / (2 + exponent x))^(1/4), x not below 0. */
typedef struct nt_channel_map {
	nt_channel channel;
	float base, gain;
	float exponent; /* 0: none */
	bool srgb;      /* the number is stored as sRGB stores what is linear */
} nt_channel_map;

/* Whether it changes nothing of a sample. */
bool nt_channel_map_is_identity(const nt_channel_map *map);

/* OPACITY as what it is in these pixels; others as they are. */
nt_channel nt_channel_resolve(nt_channel channel, const nt_pixels *pixels);

/*
 * Fills one channel of an image. If sizes differ, `from` is resampled: bilinear, of the samples as they are, pixel
 * centres at halves; beyond a border the opposite one follows, with `clamp` its own pixels go on.
 *
 *   map      its channel is resolved
 *   to       any size, channels and bits
 *   channel  of `to`, less than its channels
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_pack_channel(const nt_pixels *from, const nt_channel_map *map, bool clamp, nt_pixels *to, unsigned channel,
	nt_error *error);

/* The effect of alpha, in glTF's terms. */
typedef enum nt_alpha_mode {
	NT_ALPHA_OPAQUE, /* all is opaque */
	NT_ALPHA_MASK,   /* some pixels are below 1/16, and at most one of 20 is between 1/16 and 15/16 */
	NT_ALPHA_BLEND
} nt_alpha_mode;

/* The number of the only channel of an image. */
nt_alpha_mode nt_alpha_of(const nt_pixels *pixels);

/* ---- height maps to tangent-space normal maps, as glTF has them (green up): image.c ---- */

/*
 * Makes the normals of a surface. With h from 0 (black) to 1 (white), x to the right and y down in pixels, and
 * s = height * width, by central differences
 *
 *     n = (-s (h(x+1, y) - h(x-1, y)) / 2, s (h(x, y+1) - h(x, y-1)) / 2, 1), normalized; colour = (n + 1) / 2
 *
 * which is exact for planes and paraboloids. Pixels are square.
 *
 *   heights  of one channel, which is taken as it is, not as sRGB
 *   height   of white over black, as a share of the image's width; finite, also 0 or negative
 *   clamp    beyond a border its own pixels go on; else the opposite border's follow, as repeating samplers do
 *   normals  receives RGB of the same size and bits
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_heights_to_normals(const nt_pixels *heights, double height, bool clamp, nt_pixels *normals,
	nt_error *error);

/* ---- evidence in a normal map: which way its green points, and what is wrong with it; examine.c ---- */

typedef enum nt_green {
	NT_GREEN_UNKNOWN, /* too little to tell by */
	NT_GREEN_UP,      /* as glTF has it */
	NT_GREEN_DOWN,
	NT_GREEN_MIXED    /* down in places, or at some sizes of detail alone */
} nt_green;

/* The map is looked at in so many columns, and rows, of blocks. */
enum { NT_GREEN_BLOCKS = 12 };

typedef struct nt_normal_facts {
	nt_green green;
	double correlation; /* of dp/dv and dq/du, from -1 to 1: see examine.c */
	double agreement;   /* share of the blocks, by weight, whose sign is that of the correlation; 0 without any */
	int8_t votes[NT_GREEN_BLOCKS * NT_GREEN_BLOCKS]; /* row by row from the top: the same of each block, over all
	                                                    sizes, in percent; 0: it has nothing to tell */
	size_t blocks_up, blocks_down; /* with votes of 20 % and more */
	double not_unit;    /* share of the pixels whose length is more than a tenth from 1 */
	double blue_below;  /* share of the pixels that point into the surface */
	double banded;      /* share of the sloped pixels that lie in steps of one level: an 8-bit map of a
	                       smooth surface */
	bool constant, tilted; /* all pixels are alike; they are not those of a flat surface */
	bool object_space;  /* unit vectors into all directions */
	bool heights;       /* grey pixels alone: a height map, of which nothing else is told */
	bool srgb;          /* the file says that its samples are sRGB */
	bool lossy;         /* its compression is */
} nt_normal_facts;

/* Decodes an image and examines it. Returns what nt_image_decode() does. */
nt_status nt_examine_image(const unsigned char *bytes, size_t size, nt_normal_facts *facts, nt_error *error);

/* Examines RGB or RGBA, of which pixels without alpha do not count; of other images all is zero. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_examine_normals(const nt_pixels *pixels, nt_normal_facts *facts, nt_error *error);

/* ---- images made small, for looking at: image.c ---- */

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

/* SPDX-License-Identifier: MIT */
/*
 * How one image of an output comes from files: as it is, converted, a height map made a normal map, green turned
 * around, or put together of channels of several. Knows bytes and pixels; which files there are is textures.c's.
 */
#ifndef NT_IMAGE_CONVERSION_H
#define NT_IMAGE_CONVERSION_H

#include "file/input.h"
#include "image/image.h"
#include "image/pack.h"

/* Normal maps whose green points down get it turned around. */
typedef enum nt_flip {
	NT_FLIP_OFF,
	NT_FLIP_AUTO, /* where image/examine.h is sure */
	NT_FLIP_ON    /* all of them */
} nt_flip;

/* One channel of what is put together, in the order red, green, blue, alpha. */
typedef struct nt_conversion_channel {
	bool used;           /* somebody samples it */
	uint32_t source;     /* number of the image; UINT32_MAX: none, it is white */
	nt_channel_map map;
} nt_conversion_channel;

typedef struct nt_conversion {
	nt_conversion_channel channels[4]; /* without `packed` the source of the first is the image; with `heights` its
	                              map is applied */
	bool packed;
	bool png;        /* the result is a PNG, whatever the file is */
	nt_flip flip;
	bool heights;
	double height;   /* these two only with heights; clamp with packed, too */
	bool clamp;
	const char *suffix; /* of the name of what is made; only with packed */
} nt_conversion;

/* The result. */
typedef struct nt_converted {
	bool made;            /* a PNG; else the file of the first channel is the result */
	unsigned char *bytes; /* of it, in a malloc'ed block; NULL: nothing was made, or it was only judged */
	size_t size;
	bool flipped;
	nt_alpha_mode alpha;
	unsigned damaged;     /* bits: channels whose image cannot be decoded, which are white */
} nt_converted;

bool nt_conversion_equal(const nt_conversion *a, const nt_conversion *b);
uint64_t nt_conversion_hash(const nt_conversion *how);

/* Whether it takes decoding at all. */
bool nt_conversion_decodes(const nt_conversion *how);

/* Whether packed channels are those of one image in their order, as they are. */
bool nt_conversion_is_identity(const nt_conversion *how);

/* Makes one of conversions of which the results differ in what their pixels are alone. */
void nt_conversion_simplify(nt_conversion *how);

/*
 * Makes it.
 *
 *   files  [4] of the channels, where they have a source; equal sources have equal files
 *   judged_only  no pixels are made but those that show what it comes to
 *
 * Returns NT_OK, also with damaged channels, as long as one that is used is left (the error says what is wrong with the
 * last of them), or what nt_image_decode() and nt_encode_png() do.
 */
nt_status nt_conversion_make(const nt_conversion *how, const nt_file *const files[4], bool judged_only,
	nt_converted *made, nt_error *error);

#endif

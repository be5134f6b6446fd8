/* SPDX-License-Identifier: MIT */
/*
 * Images put together of channels of others: occlusion, roughness and metallic in one, alpha beside colours.
 */
#ifndef NT_IMAGE_PACK_H
#define NT_IMAGE_PACK_H

#include "ext/codec/pixels.h"

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

#endif

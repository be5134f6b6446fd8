/* SPDX-License-Identifier: MIT */
/*
 * Making one image: see textures.h. Packing holds the samples of all its images at once, and those
 * of the result; each image is decoded once.
 */
#include "image/textures.h"

#include <stdlib.h>
#include <string.h>
#include "image/image.h"

/* ---- conversions ---- */

static bool equal_maps(const nt_channel_map *a, const nt_channel_map *b)
{
	return a->channel == b->channel && a->base == b->base && a->gain == b->gain && a->exponent == b->exponent &&
	       a->srgb == b->srgb;
}

/* Adding 0 makes 0 of -0. */
void nt_conversion_key(const nt_conversion *how, double key[NT_CONVERSION_KEY])
{
	const double of_all[] = {how->packed, how->png, how->flip, how->heights, how->height + 0.0, how->clamp};
	memcpy(key, of_all, sizeof of_all);
	for (int k = 0; k < 4; k++) {
		const nt_conversion_channel *i = &how->channels[k];
		const double of_channel[] = {i->used, i->source, i->map.channel, i->map.base + 0.0, i->map.gain + 0.0,
			i->map.exponent, i->map.srgb};
		memcpy(key + 6 + 7 * k, of_channel, sizeof of_channel);
	}
}

bool nt_conversion_decodes(const nt_conversion *how)
{
	return how->packed || how->png || how->heights || how->flip != NT_FLIP_OFF;
}

bool nt_conversion_is_identity(const nt_conversion *how)
{
	const uint32_t source = how->channels[0].source;
	for (int k = 0; k < 4; k++) {
		const nt_conversion_channel *i = &how->channels[k];
		if (i->used && (k == 3 || i->source != source || i->map.channel != (nt_channel)k ||
			!nt_channel_map_is_identity(&i->map)))
			return false;
	}
	return source != UINT32_MAX;
}

/* Alpha alone is looked at; of other channels it counts where they come from, and whether they change. */
void nt_conversion_simplify(nt_conversion *how)
{
	how->height = 0;
	how->clamp = false;
	for (int k = 0; k < (how->packed ? 3 : 1); k++) {
		nt_channel_map *map = &how->channels[k].map;
		if (nt_channel_map_is_identity(map))
			continue;
		map->gain = 2;
		map->base = map->exponent = 0;
	}
}

/* ---- one image ---- */

static void flip_green(nt_pixels *p)
{
	const size_t count = (size_t)p->width * p->height * p->channels;
	for (size_t i = 1; i < count; i += p->channels)
		if (p->bits == 8)
			((uint8_t *)p->samples)[i] = (uint8_t)(UINT8_MAX - ((uint8_t *)p->samples)[i]);
		else
			((uint16_t *)p->samples)[i] = (uint16_t)(UINT16_MAX - ((uint16_t *)p->samples)[i]);
}

/* Turns green around if the conversion says so. */
static nt_status flip(const nt_conversion *how, nt_pixels *pixels, bool *flipped, nt_error *error)
{
	nt_normal_facts facts;
	nt_status status = NT_OK;
	*flipped = how->flip == NT_FLIP_ON && pixels->channels >= 3;
	if (how->flip == NT_FLIP_AUTO) {
		status = nt_examine_normals(pixels, &facts, error);
		*flipped = !status && facts.green == NT_GREEN_DOWN;
	}
	if (*flipped)
		flip_green(pixels);
	return status;
}

/* Pixels become those of what the conversion makes of them; they stay on failure. */
static nt_status replace(nt_pixels *pixels, const nt_pixels *by, nt_status status)
{
	if (!status) {
		nt_pixels_free(pixels);
		*pixels = *by;
	}
	return status;
}

static nt_status make_normals(const nt_conversion *how, nt_pixels *pixels, nt_error *error)
{
	nt_channel_map map = how->channels[0].map;
	nt_pixels made = {0};
	nt_status status = NT_OK;
	if (pixels->channels > 1 || !nt_channel_map_is_identity(&map)) {
		status = nt_pixels_create(&made, pixels->width, pixels->height, 1, pixels->bits, error);
		if (!status)
			status = replace(pixels, &made, nt_pack_channel(pixels, &map, how->clamp, &made, 0, error));
		if (status)
			nt_pixels_free(&made);
	}
	if (!status)
		status = replace(pixels, &made, nt_heights_to_normals(pixels, how->height, how->clamp, &made, error));
	return status;
}

static nt_status make_of_one(const nt_conversion *how, const nt_file *file, bool judged_only, nt_converted *made,
	nt_error *error)
{
	nt_pixels pixels;
	nt_status status = nt_image_decode(file->data, file->size, &pixels, error);
	if (!status && how->heights && !judged_only)
		status = make_normals(how, &pixels, error);
	if (!status)
		status = flip(how, &pixels, &made->flipped, error);
	made->made = !status && (how->png || how->heights || made->flipped);
	if (made->made && !judged_only)
		status = nt_encode_png(&pixels, &made->bytes, &made->size, error);
	nt_pixels_free(&pixels);
	return status;
}

/* ---- several ---- */

/* The images of what is put together; channels of one source share its samples. */
typedef struct packing {
	nt_conversion how;       /* as it comes to be */
	nt_pixels pixels[4];
	int owner[4];        /* channel whose pixels these are */
} packing;

static bool is_taken(const packing *p, int k)
{
	return p->how.channels[k].used && p->how.channels[k].source != UINT32_MAX;
}

/* Decodes the image of a channel; one that is damaged makes it white. */
static nt_status take_image(packing *p, int k, const nt_file *file, nt_converted *made, nt_error *error)
{
	nt_conversion_channel *i = &p->how.channels[k];
	p->owner[k] = k;
	for (int j = 0; j < k; j++)
		if (is_taken(p, j) && p->how.channels[j].source == i->source)
			p->owner[k] = p->owner[j];
	if (p->owner[k] != k)
		return NT_OK;
	const nt_status status = nt_image_decode(file->data, file->size, &p->pixels[k], error);
	if (status == NT_ERROR_MEMORY || !status)
		return status;
	made->damaged |= 1u << k;
	i->source = UINT32_MAX;
	return NT_OK;
}

static const nt_pixels *pixels_of(const packing *p, int k)
{
	return &p->pixels[p->owner[k]];
}

/* The effect of alpha; if it has none, alpha is not used. */
static nt_status judge_alpha(packing *p, nt_converted *made, nt_error *error)
{
	if (!is_taken(p, 3)) {
		p->how.channels[3].used = false;
		return NT_OK;
	}
	const nt_pixels *from = pixels_of(p, 3);
	nt_conversion_channel *i = &p->how.channels[3];
	nt_pixels alpha;
	nt_status status = nt_pixels_create(&alpha, from->width, from->height, 1, from->bits, error);
	if (status)
		return status;
	i->map.channel = nt_channel_resolve(i->map.channel, from);
	status = nt_pack_channel(from, &i->map, p->how.clamp, &alpha, 0, error);
	if (!status)
		made->alpha = nt_alpha_of(&alpha);
	i->used = made->alpha != NT_ALPHA_OPAQUE;
	nt_pixels_free(&alpha);
	return status;
}

/* Whether the image of the first channel that is used is what is to be made. */
static bool is_there(const packing *p, const nt_file *const files[4])
{
	int first = 0;
	while (first < 4 && !p->how.channels[first].used)
		first++;
	if (first == 4 || p->how.channels[first].source == UINT32_MAX)
		return false;
	const nt_image_type type = nt_image_type_of_bytes(files[first]->data, files[first]->size);
	const bool grey = nt_pixels_are_grey(pixels_of(p, first),
		type == NT_IMAGE_JPEG || type == NT_IMAGE_WEBP ? NT_NEARLY_GREY : 0);
	for (int k = first; k < 4; k++) {
		const nt_conversion_channel *i = &p->how.channels[k];
		const bool same = i->map.channel == (nt_channel)k ||
			(grey && k < 3 && i->map.channel != NT_CHANNEL_ALPHA);
		if (i->used &&
			(i->source != p->how.channels[first].source || !same || !nt_channel_map_is_identity(&i->map)))
			return false;
	}
	return nt_image_is_carried(type);
}

/* Grey, where red, green and blue are the same or of no use; else RGB; and alpha. */
static unsigned count_channels(const packing *p)
{
	const nt_conversion_channel *known = NULL;
	bool grey = true;
	for (int k = 0; k < 3; k++) {
		const nt_conversion_channel *i = &p->how.channels[k];
		if (!i->used)
			continue;
		grey &= !known || (known->source == i->source && equal_maps(&known->map, &i->map));
		known = i;
	}
	return (grey ? 1 : 3) + p->how.channels[3].used;
}

static nt_status put_together(const packing *p, nt_pixels *to, nt_error *error)
{
	uint32_t width = 1, height = 1;
	unsigned bits = 8;
	for (int k = 0; k < 4; k++)
		if (is_taken(p, k)) {
			const nt_pixels *from = pixels_of(p, k);
			width = from->width > width ? from->width : width;
			height = from->height > height ? from->height : height;
			bits = from->bits > bits ? from->bits : bits;
		}
	const unsigned channels = count_channels(p);
	nt_status status = nt_pixels_create(to, width, height, channels, bits, error);
	if (status)
		return status;
	memset(to->samples, 0xff, nt_pixels_row_bytes(to) * height);
	for (int k = 0; k < 4 && !status; k++)
		if (is_taken(p, k)) {
			const unsigned channel = k == 3 ? channels - 1 : channels < 3 ? 0 : (unsigned)k;
			status = nt_pack_channel(pixels_of(p, k), &p->how.channels[k].map, p->how.clamp, to,
				channel, error);
		}
	return status;
}

static nt_status make_of_several(const nt_conversion *how, const nt_file *const files[4], bool judged_only,
	nt_converted *made, nt_error *error)
{
	packing p = {.how = *how};
	nt_pixels result = {0};
	nt_status status = NT_OK;
	bool any = false;
	for (int k = 0; k < 4 && !status; k++)
		if (is_taken(&p, k)) {
			status = take_image(&p, k, files[k], made, error);
			any |= is_taken(&p, k);
		}
	if (!status && !any)
		status = error->status;
	if (!status)
		status = judge_alpha(&p, made, error);
	made->made = !status && (how->png || !is_there(&p, files));
	if (made->made && !judged_only) {
		status = put_together(&p, &result, error);
		if (!status)
			status = nt_encode_png(&result, &made->bytes, &made->size, error);
	}
	nt_pixels_free(&result);
	for (int k = 0; k < 4; k++)
		nt_pixels_free(&p.pixels[k]);
	return status;
}

nt_status nt_conversion_make(const nt_conversion *how, const nt_file *const files[4], bool judged_only,
	nt_converted *made, nt_error *error)
{
	*made = (nt_converted){0};
	return how->packed ? make_of_several(how, files, judged_only, made, error)
			   : make_of_one(how, files[0], judged_only, made, error);
}

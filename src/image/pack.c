/* SPDX-License-Identifier: MIT */
/*
 * Channels from image to image: see image.h. A number depends on one sample alone, so that a table has the results for
 * all of them; between samples, where sizes differ, it is worked out.
 */
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

bool nt_channel_map_is_identity(const nt_channel_map *map)
{
	return map->base == 0 && map->gain == 1 && map->exponent == 0 && !map->srgb;
}

/* ---- samples ---- */

static unsigned sample(const nt_pixels *p, size_t at)
{
	return p->bits == 8 ? ((const uint8_t *)p->samples)[at] : ((const uint16_t *)p->samples)[at];
}

static unsigned most(const nt_pixels *p)
{
	return (1u << p->bits) - 1;
}

/* A number of the pixel whose first sample is `at`. */
static unsigned read(const nt_pixels *p, size_t at, nt_channel channel)
{
	const bool grey = p->channels < 3;
	if (channel == NT_CHANNEL_ALPHA)
		return p->channels % 2 ? most(p) : sample(p, at + p->channels - 1);
	if (grey || channel < NT_CHANNEL_ALPHA)
		return sample(p, grey ? at : at + (size_t)channel);
	return (2126 * sample(p, at) + 7152 * sample(p, at + 1) + 722 * sample(p, at + 2) + 5000) / 10000;
}

nt_channel nt_channel_resolve(nt_channel channel, const nt_pixels *p)
{
	if (channel != NT_CHANNEL_OPACITY)
		return channel;
	const size_t count = (size_t)p->width * p->height * p->channels;
	const unsigned first = read(p, 0, NT_CHANNEL_ALPHA);
	for (size_t at = 0; at < count && p->channels % 2 == 0; at += p->channels)
		if (read(p, at, NT_CHANNEL_ALPHA) != first)
			return NT_CHANNEL_ALPHA;
	return NT_CHANNEL_LUMINANCE;
}

/* ---- numbers ---- */

/* IEC 61966-2-1. */
static double srgb_of(double linear)
{
	return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

/* v and the result from 0 to 1. */
static double number_of(const nt_channel_map *map, double v)
{
	double x = fmax(map->base + (double)map->gain * v, 0);
	if (map->exponent != 0)
		x = sqrt(sqrt(2 / (2 + (double)map->exponent * x)));
	x = fmin(x, 1);
	return map->srgb ? srgb_of(x) : x;
}

static unsigned stored(const nt_channel_map *map, double v, unsigned largest)
{
	return (unsigned)floor(number_of(map, v) * largest + 0.5);
}

static void put(nt_pixels *p, size_t at, unsigned value)
{
	if (p->bits == 8)
		((uint8_t *)p->samples)[at] = (uint8_t)value;
	else
		((uint16_t *)p->samples)[at] = (uint16_t)value;
}

/* ---- sizes ---- */

/* The two samples between which a pixel centre lies, and how far it is from the first. */
typedef struct between {
	uint32_t first, second;
	double share;
} between;

static between locate(uint32_t i, uint32_t to, uint32_t from, bool clamp)
{
	const double at = (i + 0.5) * from / to - 0.5, below = floor(at);
	const int64_t first = (int64_t)below, second = first + 1, last = (int64_t)from - 1;
	if (clamp)
		return (between){(uint32_t)(first < 0 ? 0 : first), (uint32_t)(second > last ? last : second),
			at - below};
	return (between){(uint32_t)(first < 0 ? last : first), (uint32_t)(second > last ? 0 : second), at - below};
}

static void resample_row(const nt_pixels *from, const nt_channel_map *map, const between *columns, between row,
	nt_pixels *to, size_t at)
{
	const size_t step = from->channels, width = from->width;
	for (uint32_t x = 0; x < to->width; x++, at += to->channels) {
		const between column = columns[x];
		double rows[2];
		for (int k = 0; k < 2; k++) {
			const size_t begin = (k ? row.second : row.first) * width;
			const double a = read(from, (begin + column.first) * step, map->channel);
			const double b = read(from, (begin + column.second) * step, map->channel);
			rows[k] = a + (b - a) * column.share;
		}
		const double value = rows[0] + (rows[1] - rows[0]) * row.share;
		put(to, at, stored(map, value / most(from), most(to)));
	}
}

static nt_status resample(const nt_pixels *from, const nt_channel_map *map, bool clamp, nt_pixels *to, unsigned channel,
	nt_error *error)
{
	between *columns = nt_alloc(to->width, sizeof *columns);
	if (!columns)
		return nt_fail_memory(error);
	for (uint32_t x = 0; x < to->width; x++)
		columns[x] = locate(x, to->width, from->width, clamp);
	for (uint32_t y = 0; y < to->height; y++)
		resample_row(from, map, columns, locate(y, to->height, from->height, clamp), to,
			(size_t)y * to->width * to->channels + channel);
	free(columns);
	return NT_OK;
}

nt_status nt_pack_channel(const nt_pixels *from, const nt_channel_map *map, bool clamp, nt_pixels *to, unsigned channel,
	nt_error *error)
{
	if (from->width != to->width || from->height != to->height)
		return resample(from, map, clamp, to, channel, error);
	const unsigned last = most(from);
	uint16_t *table = nt_alloc((size_t)last + 1, sizeof *table);
	if (!table)
		return nt_fail_memory(error);
	for (unsigned v = 0; v <= last; v++)
		table[v] = (uint16_t)stored(map, (double)v / last, most(to));
	const size_t count = (size_t)from->width * from->height;
	for (size_t i = 0; i < count; i++)
		put(to, i * to->channels + channel, table[read(from, i * from->channels, map->channel)]);
	free(table);
	return NT_OK;
}

/* ---- alpha ---- */

nt_alpha_mode nt_alpha_of(const nt_pixels *p)
{
	const size_t count = (size_t)p->width * p->height;
	const unsigned last = most(p);
	size_t low = 0, grey = 0, opaque = 0;
	for (size_t i = 0; i < count; i++) {
		const unsigned v = sample(p, i);
		low += 16 * v < last;
		grey += 16 * v >= last && 16 * v <= 15 * last;
		opaque += v == last;
	}
	return opaque == count ? NT_ALPHA_OPAQUE : low && grey <= count / 20 ? NT_ALPHA_MASK : NT_ALPHA_BLEND;
}

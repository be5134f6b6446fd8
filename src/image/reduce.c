/* SPDX-License-Identifier: MIT */
/*
 * Small images: see image.h. Each pixel is the mean of those that it stands for, of the samples as they are stored.
 */
#include "image/image.h"

enum { QUALITY = 80 };

static const uint64_t MOST_PIXELS = (uint64_t)8192 * 8192;

static nt_status decode(const unsigned char *bytes, size_t size, uint32_t most, nt_pixels *pixels, nt_error *error)
{
	uint32_t sides[2];
	*pixels = (nt_pixels){0};
	nt_error unused;
	if (nt_image_size(bytes, size, sides) && ((uint64_t)sides[0] * sides[1] > MOST_PIXELS ||
		nt_check_image(nt_image_work(bytes, size), 0, size, NULL, &unused)))
		return nt_fail(error, NT_ERROR_UNSUPPORTED, "an image of %u x %u pixels", sides[0], sides[1]);
	return nt_image_type_of_bytes(bytes, size) == NT_IMAGE_JPEG
		? nt_decode_jpeg_small(bytes, size, most, pixels, error)
		: nt_image_decode(bytes, size, pixels, error);
}

static unsigned sample(const nt_pixels *p, size_t at)
{
	return p->bits == 8 ? ((const uint8_t *)p->samples)[at] : ((const uint16_t *)p->samples)[at] >> 8;
}

/* The mean of a channel over columns and rows [first, end). */
static uint8_t mean(const nt_pixels *p, unsigned channel, const size_t columns[2], const size_t rows[2])
{
	const uint64_t count = (uint64_t)(columns[1] - columns[0]) * (rows[1] - rows[0]);
	uint64_t sum = count / 2;
	for (size_t y = rows[0]; y < rows[1]; y++)
		for (size_t x = columns[0]; x < columns[1]; x++)
			sum += sample(p, (y * p->width + x) * p->channels + channel);
	return (uint8_t)(sum / count);
}

/* `to` has its size, at most that of `from`, and as many channels without alpha. */
static void average(const nt_pixels *from, const nt_pixels *to)
{
	uint8_t *out = to->samples;
	for (size_t y = 0; y < to->height; y++) {
		const size_t rows[2] = {y * from->height / to->height, (y + 1) * from->height / to->height};
		for (size_t x = 0; x < to->width; x++) {
			const size_t columns[2] = {x * from->width / to->width, (x + 1) * from->width / to->width};
			for (unsigned c = 0; c < to->channels; c++)
				*out++ = mean(from, c, columns, rows);
		}
	}
}

nt_status nt_image_reduce(const unsigned char *bytes, size_t size, uint32_t most, unsigned char **jpeg,
	size_t *jpeg_size, nt_error *error)
{
	nt_pixels whole, small = {0};
	*jpeg = NULL;
	nt_status status = decode(bytes, size, most, &whole, error);
	if (status)
		return status;
	const uint64_t longer = whole.width > whole.height ? whole.width : whole.height;
	const uint64_t side = longer < most ? longer : most;
	const uint64_t width = whole.width * side / longer, height = whole.height * side / longer;
	status = nt_pixels_create(&small, width ? width : 1, height ? height : 1, whole.channels < 3 ? 1 : 3, 8, error);
	if (!status) {
		average(&whole, &small);
		status = nt_encode_jpeg(&small, QUALITY, jpeg, jpeg_size, error);
	}
	nt_pixels_free(&whole);
	nt_pixels_free(&small);
	return status;
}

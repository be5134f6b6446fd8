/* SPDX-License-Identifier: MIT */
/*
 * Images: decoded by content, made small, and of heights made normals.
 */
#include "image/image.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include "base/memory.h"

/* ---- decoding ---- */

/* Rows that show whether an image is grey, if it is not. */
enum { SAMPLE_ROWS = 8 };

bool nt_image_is_decoded(nt_image_type type)
{
	return nt_image_is_converted(type) || type == NT_IMAGE_WEBP;
}

bool nt_image_is_converted(nt_image_type type)
{
	return type == NT_IMAGE_PNG || type == NT_IMAGE_JPEG || (type >= NT_IMAGE_TGA && type <= NT_IMAGE_TIFF);
}

enum { BYTE_PIXELS = 256, MOST_TIMES = 64 };

nt_status nt_check_image(uint64_t pixels, uint64_t most, uint64_t file_bytes, const char *path, nt_error *error)
{
	if (most || pixels / (BYTE_PIXELS * MOST_TIMES) <= file_bytes)
		return NT_OK;
	nt_fail(error, NT_ERROR_LIMIT,
		"%" PRIu64 " bytes of image are to be decoded to %" PRIu64 " pixels (each scan counts), which is more "
		"than %d for each byte; --max-pixels=%" PRIu64 " allows it", file_bytes, pixels,
		BYTE_PIXELS * MOST_TIMES, pixels);
	return path ? nt_error_in_file(error, path) : NT_ERROR_LIMIT;
}

nt_status nt_check_pixels(uint64_t pixels, uint64_t most, uint64_t file_bytes, nt_error *error)
{
	static const uint64_t standard = (uint64_t)1 << 34;
	if (!most)
		most = file_bytes > standard / BYTE_PIXELS ? BYTE_PIXELS * file_bytes : standard;
	return pixels <= most ? NT_OK : nt_fail(error, NT_ERROR_LIMIT,
		"images of %" PRIu64 " pixels are to be decoded and made, --max-pixels is %" PRIu64, pixels, most);
}

static nt_status decode_rows(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	switch (nt_image_type_of_bytes(bytes, size)) {
	case NT_IMAGE_PNG:
		return nt_decode_png(bytes, size, rows, pixels, error);
	case NT_IMAGE_JPEG:
		return nt_decode_jpeg(bytes, size, rows, pixels, error);
	case NT_IMAGE_WEBP:
		return nt_decode_webp(bytes, size, rows, pixels, error);
	case NT_IMAGE_TIFF:
		return nt_decode_tiff(bytes, size, pixels, error);
	case NT_IMAGE_TGA:
	case NT_IMAGE_BMP:
	case NT_IMAGE_PSD:
	case NT_IMAGE_HDR:
		return nt_decode_stb(bytes, size, pixels, error);
	default:
		*pixels = (nt_pixels){0};
		return nt_fail(error, NT_ERROR_UNSUPPORTED, "expected PNG, JPEG, WebP, TGA, BMP, PSD, HDR or TIFF");
	}
}

nt_status nt_image_decode(const unsigned char *bytes, size_t size, nt_pixels *pixels, nt_error *error)
{
	return decode_rows(bytes, size, UINT32_MAX, pixels, error);
}

bool nt_pixels_are_grey(const nt_pixels *pixels, int levels)
{
	const int tolerance = pixels->bits == 8 ? levels : 257 * levels;
	const size_t count = (size_t)pixels->width * pixels->height, step = pixels->channels;
	if (step < 3)
		return true;
	const uint8_t *narrow = pixels->samples;
	const uint16_t *wide = pixels->samples;
	for (size_t i = 0; i < count * step; i += step) {
		const int r = pixels->bits == 8 ? narrow[i] : wide[i],
			g = pixels->bits == 8 ? narrow[i + 1] : wide[i + 1],
			  b = pixels->bits == 8 ? narrow[i + 2] : wide[i + 2];
		if (abs(r - g) > tolerance || abs(g - b) > tolerance || abs(r - b) > tolerance)
			return false;
	}
	return true;
}

nt_status nt_image_is_grey(const unsigned char *bytes, size_t size, bool *grey, nt_error *error)
{
	const uint32_t rows[] = {SAMPLE_ROWS, UINT32_MAX};
	nt_status status = NT_OK;
	*grey = true;
	for (size_t i = 0; i < 2 && !status && *grey; i++) {
		nt_pixels pixels;
		status = decode_rows(bytes, size, rows[i], &pixels, error);
		*grey = !status && nt_pixels_are_grey(&pixels, NT_NEARLY_GREY);
		const bool known = pixels.channels < 3;
		nt_pixels_free(&pixels);
		if (known)
			break;
	}
	return status;
}

/* ---- small images ---- */

/* Each pixel is the mean of those that it stands for, of the samples as they are stored. */

enum { QUALITY = 80 };

static const uint64_t MOST_PIXELS = (uint64_t)8192 * 8192;

static nt_status decode(const unsigned char *bytes, size_t size, uint32_t most, nt_pixels *pixels, nt_error *error)
{
	uint32_t sides[2];
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

/* ---- height maps to normal maps ---- */

/* Three rows of heights at a time. */

static void read_row(const nt_pixels *p, uint32_t y, float *row)
{
	const size_t begin = (size_t)y * p->width;
	const float scale = 1.0f / (float)((1u << p->bits) - 1);
	for (size_t x = 0; x < p->width; x++)
		row[x] = scale * (float)(p->bits == 8 ? ((const uint8_t *)p->samples)[begin + x]
						      : ((const uint16_t *)p->samples)[begin + x]);
}

/* The row or column that is sampled one beyond `last`, or one before 0. */
static uint32_t step(uint32_t i, int by, uint32_t last, bool clamp)
{
	if (by < 0 ? i > 0 : i < last)
		return (uint32_t)((int64_t)i + by);
	return clamp ? i : by < 0 ? last : 0;
}

static void write_pixel(nt_pixels *p, size_t pixel, const double n[3])
{
	const double most = (1u << p->bits) - 1;
	for (int c = 0; c < 3; c++) {
		const unsigned value = (unsigned)floor((n[c] + 1) / 2 * most + 0.5);
		if (p->bits == 8)
			((uint8_t *)p->samples)[3 * pixel + c] = (uint8_t)value;
		else
			((uint16_t *)p->samples)[3 * pixel + c] = (uint16_t)value;
	}
}

nt_status nt_heights_to_normals(const nt_pixels *heights, double height, bool clamp, nt_pixels *normals,
	nt_error *error)
{
	const uint32_t width = heights->width, last = heights->height - 1;
	const double scale = height * width / 2;
	*normals = (nt_pixels){0};
	float *rows = nt_alloc((size_t)width * 3, sizeof *rows);
	nt_status status = rows ? nt_pixels_create(normals, width, heights->height, 3, heights->bits, error)
				: nt_fail_memory(error);
	if (status) {
		free(rows);
		return status;
	}
	float *above = rows, *here = rows + width, *below = rows + 2 * (size_t)width;
	read_row(heights, step(0, -1, last, clamp), above);
	read_row(heights, 0, here);
	for (uint32_t y = 0; y <= last; y++) {
		read_row(heights, step(y, 1, last, clamp), below);
		for (uint32_t x = 0; x < width; x++) {
			const float left = here[step(x, -1, width - 1, clamp)],
				right = here[step(x, 1, width - 1, clamp)];
			const double dx = scale * ((double)right - left), dy = scale * ((double)below[x] - above[x]);
			const double length = sqrt(dx * dx + dy * dy + 1);
			write_pixel(normals, (size_t)y * width + x,
				(const double[]){-dx / length, dy / length, 1 / length});
		}
		float *free_row = above;
		above = here;
		here = below;
		below = free_row;
	}
	free(rows);
	return NT_OK;
}

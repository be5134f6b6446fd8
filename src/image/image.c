/* SPDX-License-Identifier: MIT */
/*
 * Decoding by content: see image.h.
 */
#include "image/image.h"

#include <inttypes.h>
#include <stdlib.h>

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

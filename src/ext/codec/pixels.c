/* SPDX-License-Identifier: MIT */
/*
 * Memory of images: see pixels.h.
 */
#include "ext/codec/pixels.h"

#include <stdlib.h>
#include "base/scratch.h"

nt_status nt_pixels_check(uint64_t width, uint64_t height, unsigned channels, unsigned bits, nt_error *error)
{
	const unsigned long long w = width, h = height;
	if (!width || !height)
		return nt_fail(error, NT_ERROR_INPUT, "%llu x %llu pixels", w, h);
	const unsigned pixel_bytes = channels * (bits / 8);
	if (width > UINT32_MAX || height > UINT32_MAX || width > NT_PIXELS_MOST / height ||
		width * height > NT_PIXELS_MOST_BYTES / pixel_bytes)
		return nt_fail(error, NT_ERROR_UNSUPPORTED,
			"%llu x %llu pixels of %u bytes, more than nmtan decodes", w, h, pixel_bytes);
	return NT_OK;
}

nt_status nt_pixels_create(nt_pixels *pixels, uint64_t width, uint64_t height, unsigned channels, unsigned bits,
	nt_error *error)
{
	const nt_status status = nt_pixels_check(width, height, channels, bits, error);
	if (status)
		return status;
	*pixels = (nt_pixels){
		.width = (uint32_t)width, .height = (uint32_t)height, .channels = channels, .bits = bits};
	pixels->samples = nt_alloc_large(nt_pixels_row_bytes(pixels) * pixels->height);
	return pixels->samples ? NT_OK : nt_fail_memory(error);
}

void nt_pixels_free(nt_pixels *pixels)
{
	free(pixels->samples);
	*pixels = (nt_pixels){0};
}

size_t nt_pixels_row_bytes(const nt_pixels *pixels)
{
	return (size_t)pixels->width * pixels->channels * (pixels->bits / 8);
}

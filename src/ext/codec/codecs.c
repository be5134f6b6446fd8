/* SPDX-License-Identifier: MIT */
/*
 * Decoders and encoders that are in modules: see pixels.h.
 */
#include "ext/codec/pixels.h"

#include "ext/module.h"
#include "ext/tables.h"

static nt_status decode(nt_module module, const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels,
	nt_error *error)
{
	nt_status status;
	const nt_codec_table *codec = nt_module_open(module, &status, error);
	*pixels = (nt_pixels){0};
	return codec ? codec->decode(bytes, size, rows, pixels, error) : status;
}

nt_status nt_decode_png(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	return decode(NT_MODULE_PNG, bytes, size, rows, pixels, error);
}

nt_status nt_decode_tiff(const unsigned char *bytes, size_t size, nt_pixels *pixels, nt_error *error)
{
	return decode(NT_MODULE_TIFF, bytes, size, UINT32_MAX, pixels, error);
}

nt_status nt_decode_webp(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	return decode(NT_MODULE_WEBP, bytes, size, rows, pixels, error);
}

nt_status nt_encode_png(const nt_pixels *pixels, unsigned char **bytes, size_t *size, nt_error *error)
{
	nt_status status;
	const nt_codec_table *codec = nt_module_open(NT_MODULE_PNG, &status, error);
	*bytes = NULL;
	return codec ? codec->encode(pixels, bytes, size, error) : status;
}

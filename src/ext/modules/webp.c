/* SPDX-License-Identifier: MIT */
/*
 * WebP by libwebp: lossy and lossless to 8 bits, with alpha if the file has it. An animation is no texture of a glTF,
 * and is not decoded. The decoder is asked for the rows that are wanted and no more.
 */
#include "ext/codec/pixels.h"
#include "ext/tables.h"

#include <webp/decode.h>

static nt_status fail(VP8StatusCode code, nt_error *error)
{
	if (code == VP8_STATUS_OUT_OF_MEMORY)
		return nt_fail_memory(error);
	const bool ends = code == VP8_STATUS_NOT_ENOUGH_DATA || code == VP8_STATUS_SUSPENDED;
	return nt_fail(error, NT_ERROR_INPUT, "WebP: %s", ends ? "the file ends within the image" : "damaged");
}

static nt_status decode_webp(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	WebPDecoderConfig config;
	*pixels = (nt_pixels){0};
	if (!WebPInitDecoderConfig(&config))
		return nt_fail(error, NT_ERROR_MODULE, "libwebp is another than nmtan was built with");
	VP8StatusCode code = WebPGetFeatures(bytes, size, &config.input);
	if (code)
		return fail(code, error);
	if (config.input.has_animation)
		return nt_fail(error, NT_ERROR_UNSUPPORTED, "WebP: an animation");
	const uint32_t width = (uint32_t)config.input.width, height = (uint32_t)config.input.height;
	const unsigned channels = config.input.has_alpha ? 4 : 3;
	const nt_status status = nt_pixels_create(pixels, width, rows < height ? rows : height, channels, 8, error);
	if (status)
		return status;
	pixels->lossy = config.input.format == 1;
	config.options.use_cropping = rows < height;
	config.options.crop_width = (int)width;
	config.options.crop_height = (int)pixels->height;
	config.output.colorspace = channels == 4 ? MODE_RGBA : MODE_RGB;
	config.output.is_external_memory = 1;
	config.output.u.RGBA = (WebPRGBABuffer){.rgba = pixels->samples, .stride = (int)nt_pixels_row_bytes(pixels),
		.size = nt_pixels_row_bytes(pixels) * pixels->height};
	code = WebPDecode(bytes, size, &config);
	WebPFreeDecBuffer(&config.output);
	if (!code)
		return NT_OK;
	nt_pixels_free(pixels);
	return fail(code, error);
}

const nt_codec_table nt_webp_module = {NT_MODULE_HEAD(nt_codec_table, "libwebp", NULL, "BSD-3-Clause", NULL),
	decode_webp, NULL};

/* SPDX-License-Identifier: MIT */
/*
 * PNG by libspng. Palettes and samples of fewer than 8 bits become 8 bits, tRNS becomes alpha; 16 bits stay. A PNG
 * that is cut short is an error, never an image that is half black.
 */
#include "ext/codec/pixels.h"
#include "ext/tables.h"

#include <spng.h>
#include <stdlib.h>

/* Chunks beside the image (text, profiles) that are looked at; and how far zlib can stretch a byte. */
enum { MOST_CHUNK_BYTES = 16 << 20, MOST_RATIO = 1032, SLACK_BYTES = 4096 };

/* A third of the time of the library's default level for one tenth more bytes (make bench, images). */
enum { LEVEL = 3 };

/* The library passes on what zlib says, which is the same for damaged data and for want of memory. */
static _Thread_local bool exhausted;

static void *note(void *block)
{
	exhausted |= !block;
	return block;
}

static void *SPNG_CDECL allocate(size_t size)
{
	return note(malloc(size));
}

static void *SPNG_CDECL reallocate(void *block, size_t size)
{
	return note(realloc(block, size));
}

static void *SPNG_CDECL allocate_zeros(size_t count, size_t size)
{
	return note(calloc(count, size));
}

static spng_ctx *create(int flags)
{
	struct spng_alloc functions = {allocate, reallocate, allocate_zeros, free};
	exhausted = false;
	return spng_ctx_new2(&functions, flags);
}

static nt_status fail(int code, const char *what, nt_error *error)
{
	if (exhausted || code == SPNG_EMEM)
		return nt_fail_memory(error);
	return nt_fail(error, NT_ERROR_INPUT, "%s: %s", what, spng_strerror(code));
}

/* How the samples of a file are asked for. */
typedef struct form {
	int format, flags;
	unsigned channels, bits;
} form;

static form form_of(const struct spng_ihdr *header, bool transparent)
{
	const unsigned bits = header->bit_depth == 16 ? 16 : 8;
	const int flags = transparent ? SPNG_DECODE_TRNS : 0;
	switch (header->color_type) {
	case SPNG_COLOR_TYPE_GRAYSCALE:
		if (transparent)
			return (form){bits == 16 ? SPNG_FMT_GA16 : SPNG_FMT_GA8, flags, 2, bits};
		return (form){bits == 16 ? SPNG_FMT_PNG : SPNG_FMT_G8, 0, 1, bits};
	case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
		return (form){SPNG_FMT_PNG, 0, 2, bits};
	case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
		return (form){SPNG_FMT_PNG, 0, 4, bits};
	default:
		if (transparent)
			return (form){bits == 16 ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, flags, 4, bits};
		return (form){bits == 16 ? SPNG_FMT_PNG : SPNG_FMT_RGB8, 0, 3, bits};
	}
}

static nt_status decode_rows(spng_ctx *png, const form *wanted, nt_pixels *pixels, nt_error *error)
{
	int code = spng_decode_image(png, NULL, 0, wanted->format, wanted->flags | SPNG_DECODE_PROGRESSIVE);
	const size_t row_bytes = nt_pixels_row_bytes(pixels);
	for (uint32_t y = 0; !code && y < pixels->height; y++)
		code = spng_decode_row(png, (char *)pixels->samples + y * row_bytes, row_bytes);
	return code && code != SPNG_EOI ? fail(code, "PNG", error) : NT_OK;
}

static nt_status decode(spng_ctx *png, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	struct spng_ihdr header;
	struct spng_trns transparency;
	uint8_t intent;
	const int code = spng_get_ihdr(png, &header);
	if (code)
		return fail(code, "PNG", error);
	const int found = spng_get_trns(png, &transparency);
	if (found && found != SPNG_ECHUNKAVAIL)
		return fail(found, "PNG", error);
	/* one bit a pixel is the least that a file holds */
	const uint64_t least_bytes = (uint64_t)header.width * header.height / 8;
	if (least_bytes / MOST_RATIO > (uint64_t)size + SLACK_BYTES)
		return nt_fail(error, NT_ERROR_INPUT, "PNG: %zu bytes cannot hold %u x %u pixels", size, header.width,
			header.height);
	const form wanted = form_of(&header, !found);
	const bool all = rows >= header.height || header.interlace_method;
	nt_status status = nt_pixels_create(pixels, header.width, all ? header.height : rows, wanted.channels,
		wanted.bits, error);
	if (status)
		return status;
	pixels->srgb = spng_get_srgb(png, &intent) == 0;
	if (!all)
		return decode_rows(png, &wanted, pixels, error);
	const int decoded = spng_decode_image(png, pixels->samples, nt_pixels_row_bytes(pixels) * pixels->height,
		wanted.format, wanted.flags);
	return decoded ? fail(decoded, "PNG", error) : NT_OK;
}

static nt_status decode_png(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	*pixels = (nt_pixels){0};
	spng_ctx *png = create(0);
	if (!png)
		return nt_fail_memory(error);
	spng_set_chunk_limits(png, MOST_CHUNK_BYTES, MOST_CHUNK_BYTES);
	const int code = spng_set_png_buffer(png, bytes, size);
	const nt_status status = code ? fail(code, "PNG", error) : decode(png, size, rows, pixels, error);
	spng_ctx_free(png);
	if (status)
		nt_pixels_free(pixels);
	return status;
}

static nt_status encode_png(const nt_pixels *pixels, unsigned char **bytes, size_t *size, nt_error *error)
{
	static const uint8_t color_types[] = {0, SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA,
		SPNG_COLOR_TYPE_TRUECOLOR, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
	struct spng_ihdr header = {.width = pixels->width, .height = pixels->height,
		.bit_depth = (uint8_t)pixels->bits, .color_type = color_types[pixels->channels]};
	spng_ctx *png = create(SPNG_CTX_ENCODER);
	if (!png)
		return nt_fail_memory(error);
	spng_set_option(png, SPNG_ENCODE_TO_BUFFER, 1);
	spng_set_option(png, SPNG_IMG_COMPRESSION_LEVEL, LEVEL);
	int code = spng_set_ihdr(png, &header);
	if (!code)
		code = spng_encode_image(png, pixels->samples, nt_pixels_row_bytes(pixels) * pixels->height,
			SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
	*bytes = code ? NULL : spng_get_png_buffer(png, size, &code);
	spng_ctx_free(png);
	if (!code)
		return NT_OK;
	const nt_status status = fail(code, "PNG encoder", error);
	return status == NT_ERROR_MEMORY ? status : (error->status = NT_ERROR_INTERNAL);
}

static const char version[] = {'0' + SPNG_VERSION_MAJOR, '.', '0' + SPNG_VERSION_MINOR, '.',
	'0' + SPNG_VERSION_PATCH, 0};

const nt_codec_table nt_png_module = {NT_MODULE_HEAD(nt_codec_table, "libspng", version, "BSD-2-Clause", NULL),
	decode_png, encode_png};

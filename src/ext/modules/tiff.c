/* SPDX-License-Identifier: MIT */
/*
 * TIFF by libtiff: the first image of the file. Grey and RGB of 8 or 16 bits, with or without alpha, are read as they
 * are; everything else that the library can show (palettes, CMYK, single bits) as 8 bits. Compressions are
 * those that textures have; the rarer codecs of the library are closed to input from outside.
 */
#include "ext/codec/pixels.h"
#include "ext/tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

/* How far the compressions can stretch a byte; one allocation of the library. */
enum { MOST_RATIO = 2048, SLACK_BYTES = 65536, MOST_BLOCK_BYTES = 1 << 30 };

typedef struct source {
	const unsigned char *bytes;
	size_t size, position;
	char message[256]; /* the first one */
	bool exhausted, limited; /* no memory; more than we give it */
} source;

static tmsize_t read_source(thandle_t handle, void *to, tmsize_t count)
{
	source *s = handle;
	const size_t left = s->size - s->position, given = (size_t)count < left ? (size_t)count : left;
	memcpy(to, s->bytes + s->position, given);
	s->position += given;
	return (tmsize_t)given;
}

static tmsize_t write_source(thandle_t handle, void *from, tmsize_t count)
{
	(void)handle, (void)from, (void)count;
	return 0;
}

static toff_t seek_source(thandle_t handle, toff_t offset, int whence)
{
	source *s = handle;
	const toff_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? s->position : s->size;
	if (offset > s->size || base + offset > s->size)
		return (toff_t)-1;
	return s->position = (size_t)(base + offset);
}

static int close_source(thandle_t handle)
{
	(void)handle;
	return 0;
}

static toff_t source_size(thandle_t handle)
{
	return ((source *)handle)->size;
}

/* The library has no code for it, and no word where zlib has none. A block beyond our limit is the file's fault. */
static bool is_of_memory(const char *message)
{
	return !strstr(message, "beyond") &&
	       (!*message || strstr(message, "emory") || strstr(message, "No space") || strstr(message, "lloc") ||
		       strstr(message, "Insertion in tif_map"));
}

static int on_error(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments)
{
	(void)tiff, (void)module;
	source *s = user;
	char message[sizeof s->message];
	vsnprintf(message, sizeof message, format, arguments);
	s->limited |= strstr(message, "beyond") != NULL; /* another message about memory follows */
	s->exhausted |= !s->limited && is_of_memory(message);
	if (!*s->message)
		strcpy(s->message, message);
	return 1;
}

static int on_warning(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments)
{
	(void)tiff, (void)user, (void)module, (void)format, (void)arguments;
	return 1;
}

static nt_status fail(const source *s, nt_error *error)
{
	if (s->exhausted)
		return nt_fail_memory(error);
	return nt_fail(error, NT_ERROR_INPUT, "TIFF: %s", *s->message ? s->message : "damaged");
}

static uint16_t field(TIFF *tiff, uint32_t tag)
{
	uint16_t value = 0;
	TIFFGetFieldDefaulted(tiff, tag, &value);
	return value;
}

static nt_status check_compression(uint16_t compression, nt_error *error)
{
	static const uint16_t known[] = {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
		COMPRESSION_DEFLATE, COMPRESSION_PACKBITS, COMPRESSION_JPEG, COMPRESSION_ZSTD};
	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if (known[i] == compression)
			return NT_OK;
	return nt_fail(error, NT_ERROR_UNSUPPORTED,
		"TIFF: compression %u, expected none, LZW, Deflate, PackBits, JPEG or Zstandard", compression);
}

/* Whether samples can be read as they are stored. */
static bool is_direct(TIFF *tiff, unsigned channels, unsigned bits)
{
	const uint16_t photometric = field(tiff, TIFFTAG_PHOTOMETRIC);
	return (bits == 8 || bits == 16) && field(tiff, TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG &&
	       field(tiff, TIFFTAG_ORIENTATION) == ORIENTATION_TOPLEFT &&
	       ((photometric == PHOTOMETRIC_MINISBLACK && channels <= 2) ||
		       (photometric == PHOTOMETRIC_RGB && (channels == 3 || channels == 4)));
}

static bool read_scanlines(TIFF *tiff, nt_pixels *pixels)
{
	const size_t row_bytes = nt_pixels_row_bytes(pixels);
	bool read = (size_t)TIFFScanlineSize(tiff) == row_bytes;
	for (uint32_t y = 0; read && y < pixels->height; y++)
		read = TIFFReadScanline(tiff, (char *)pixels->samples + y * row_bytes, y, 0) == 1;
	return read;
}

static bool read_tiles(TIFF *tiff, nt_pixels *pixels, bool *exhausted)
{
	uint32_t wide = 0, high = 0;
	TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &wide);
	TIFFGetField(tiff, TIFFTAG_TILELENGTH, &high);
	const size_t pixel_bytes = pixels->channels * (pixels->bits / 8), row_bytes = nt_pixels_row_bytes(pixels);
	const size_t tile_bytes = (size_t)TIFFTileSize(tiff);
	const bool possible = wide && high && tile_bytes <= MOST_BLOCK_BYTES && tile_bytes / wide / pixel_bytes == high;
	char *tile = possible ? _TIFFmalloc((tmsize_t)tile_bytes) : NULL;
	bool read = tile != NULL;
	*exhausted |= possible && !tile;
	for (uint32_t y = 0; read && y < pixels->height; y += high)
		for (uint32_t x = 0; read && x < pixels->width; x += wide) {
			read = TIFFReadTile(tiff, tile, x, y, 0, 0) >= 0;
			const size_t part = (pixels->width - x < wide ? pixels->width - x : wide) * pixel_bytes;
			for (uint32_t row = 0; read && row < high && y + row < pixels->height; row++)
				memcpy((char *)pixels->samples + (y + row) * row_bytes + x * pixel_bytes,
					tile + (size_t)row * wide * pixel_bytes, part);
		}
	_TIFFfree(tile);
	return read;
}

/* RGBA as the library shows it, where the file has alpha, else RGB. */
static bool read_shown(TIFF *tiff, nt_pixels *pixels)
{
	const size_t count = (size_t)pixels->width * pixels->height;
	if (!TIFFReadRGBAImageOriented(tiff, pixels->width, pixels->height, pixels->samples, ORIENTATION_TOPLEFT, 1))
		return false;
	unsigned char *to = pixels->samples;
	uint16_t extra = 0, *kinds;
	TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
	const unsigned channels = extra ? 4 : 3;
	for (size_t i = 0; i < count; i++) {
		uint32_t pixel;
		memcpy(&pixel, (char *)pixels->samples + 4 * i, sizeof pixel);
		const unsigned char rgba[] = {(unsigned char)TIFFGetR(pixel), (unsigned char)TIFFGetG(pixel),
			(unsigned char)TIFFGetB(pixel), (unsigned char)TIFFGetA(pixel)};
		memcpy(to, rgba, channels);
		to += channels;
	}
	pixels->channels = channels;
	return true;
}

/* Whether the library lacks an array that it believes to have: it says nothing where there was no memory for one. */
static bool lacks_arrays(TIFF *tiff)
{
	uint32_t table_bytes = 0;
	uint16_t extra = 0, *kinds = NULL, *palette[3] = {NULL};
	void *tables = NULL;
	return (TIFFGetField(tiff, TIFFTAG_JPEGTABLES, &table_bytes, &tables) && table_bytes && !tables) ||
	       (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds) && extra && !kinds) ||
	       (TIFFGetField(tiff, TIFFTAG_COLORMAP, &palette[0], &palette[1], &palette[2]) &&
		       !(palette[0] && palette[1] && palette[2]));
}

static nt_status decode(TIFF *tiff, source *s, nt_pixels *pixels, nt_error *error)
{
	uint32_t width = 0, height = 0;
	TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
	TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
	const uint16_t bits = field(tiff, TIFFTAG_BITSPERSAMPLE), channels = field(tiff, TIFFTAG_SAMPLESPERPIXEL);
	nt_status status = check_compression(field(tiff, TIFFTAG_COMPRESSION), error);
	if (!status && field(tiff, TIFFTAG_SAMPLEFORMAT) != SAMPLEFORMAT_UINT)
		status = nt_fail(error, NT_ERROR_UNSUPPORTED, "TIFF: samples that are no unsigned integers");
	if (status)
		return status;
	const bool direct = is_direct(tiff, channels, bits);
	/* a bit for each pixel, but all of channels that nobody looks at, for which the library has room, too */
	const double least = (double)width * height * (channels > 4 ? (double)channels * bits : 1);
	if (least / 8 / MOST_RATIO > (double)s->size + SLACK_BYTES)
		return nt_fail(error, NT_ERROR_INPUT, "TIFF: %zu bytes cannot hold %u x %u pixels", s->size,
			width, height);
	status = nt_pixels_create(pixels, width, height, direct ? channels : 4, direct ? bits : 8, error);
	if (status)
		return status;
	const bool read = !direct ? read_shown(tiff, pixels)
		: TIFFIsTiled(tiff) ? read_tiles(tiff, pixels, &s->exhausted)
		: read_scanlines(tiff, pixels);
	return read && !s->exhausted ? NT_OK : fail(s, error);
}

static nt_status decode_tiff(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	(void)rows; /* it knows no part of an image */
	*pixels = (nt_pixels){0};
	source s = {.bytes = bytes, .size = size};
	TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
	if (!options)
		return nt_fail_memory(error);
	TIFFOpenOptionsSetMaxSingleMemAlloc(options, MOST_BLOCK_BYTES);
	TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, &s);
	TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, &s);
	TIFF *tiff = TIFFClientOpenExt("", "rm", &s, read_source, write_source, seek_source, close_source, source_size,
		NULL, NULL, options);
	TIFFOpenOptionsFree(options);
	/* A directory is opened without a tag for which there was no memory, and would be decoded as if it never had
	 * it. */
	s.exhausted |= tiff && lacks_arrays(tiff);
	const nt_status status = tiff && !s.exhausted ? decode(tiff, &s, pixels, error) : fail(&s, error);
	if (tiff)
		TIFFClose(tiff);
	if (status)
		nt_pixels_free(pixels);
	return status;
}

static const char version[] = {'0' + TIFFLIB_MAJOR_VERSION, '.', '0' + TIFFLIB_MINOR_VERSION, '.',
	'0' + TIFFLIB_MICRO_VERSION, 0};

const nt_codec_table nt_tiff_module = {NT_MODULE_HEAD(nt_codec_table, "libtiff", version, "libtiff", NULL),
	decode_tiff, NULL};

/* SPDX-License-Identifier: MIT */
/* Images: see image.h. */
#include "image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "file/input.h"
#include "image/image.h"

size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t room);

/* Larger images are decoded, and no more; still larger ones a run refuses by its --max-pixels, not the decoder. */
enum { MOST_PIXELS = 1 << 16, MOST_DECODED = 1 << 25 };

static void require(bool good, const char *what, const nt_error *error)
{
	if (good)
		return;
	fprintf(stderr, "WRONG: %s: %s\n", what, error->message);
	abort();
}

static void check_grey(const uint8_t *bytes, size_t size, const nt_pixels *pixels)
{
	bool grey, alike = true;
	nt_error error;
	nt_error_clear(&error);
	require(nt_image_is_grey(bytes, size, &grey, &error) == NT_OK,
		"an image that is decoded is not looked at", &error);
	const uint8_t *narrow = pixels->bits == 8 ? pixels->samples : NULL;
	const uint16_t *wide = pixels->samples;
	const size_t count = (size_t)pixels->width * pixels->height * pixels->channels;
	const int levels = narrow ? NT_NEARLY_GREY : 257 * NT_NEARLY_GREY;
	for (size_t at = 0; pixels->channels >= 3 && at < count; at += pixels->channels)
		for (size_t k = 0; k < 3; k++) {
			const size_t other = at + (k + 1) % 3;
			alike &= abs(narrow ? narrow[at + k] - narrow[other] : wide[at + k] - wide[other]) <= levels;
		}
	require(grey == alike, "grey is told wrongly", &error);
}

static void check_png(const nt_pixels *pixels)
{
	unsigned char *png;
	size_t size;
	nt_pixels again;
	nt_error error;
	nt_error_clear(&error);
	require(nt_encode_png(pixels, &png, &size, &error) == NT_OK, "no PNG", &error);
	require(nt_image_decode(png, size, &again, &error) == NT_OK, "the PNG is not decoded", &error);
	require(again.width == pixels->width && again.height == pixels->height && again.channels == pixels->channels &&
			again.bits == pixels->bits &&
			memcmp(again.samples, pixels->samples, nt_pixels_row_bytes(pixels) * pixels->height) == 0,
		"the PNG shows something else", &error);
	nt_pixels_free(&again);
	free(png);
}

void fuzz_image(const uint8_t *bytes, size_t size)
{
	nt_pixels pixels;
	nt_error error;
	uint32_t sides[2];
	nt_error_clear(&error);
	nt_image_size(bytes, size, sides);
	if ((uint64_t)sides[0] * sides[1] > MOST_DECODED)
		return;
	const nt_status status = nt_image_decode(bytes, size, &pixels, &error);
	require(status != NT_ERROR_INTERNAL && (!status || strlen(error.message) >= 8), "no words", &error);
	require(!status == (pixels.samples != NULL), "samples after a failure, or none", &error);
	if (!status && (uint64_t)pixels.width * pixels.height <= MOST_PIXELS) {
		check_grey(bytes, size, &pixels);
		check_png(&pixels);
	}
	nt_pixels_free(&pixels);
}

static uint32_t load_big(const uint8_t *at)
{
	return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

size_t mutate_image(char *bytes, size_t size, size_t room, uint32_t *seed)
{
	(void)seed;
	uint8_t *file = (uint8_t *)bytes;
	size = LLVMFuzzerMutate(file, size, room);
	if (size < 8 || memcmp(file, "\x89PNG\r\n\x1a\n", 8) != 0)
		return size;
	/* chunks: length, type, bytes, check sum of the last two */
	for (size_t at = 8; at + 12 <= size;) {
		const size_t length = load_big(file + at);
		if (length > size - at - 12)
			break;
		const uint32_t sum = (uint32_t)crc32(0, file + at + 4, (uInt)length + 4);
		for (size_t i = 0; i < 4; i++)
			file[at + 8 + length + i] = (uint8_t)(sum >> (24 - 8 * i));
		at += 12 + length;
	}
	return size;
}

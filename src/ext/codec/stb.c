/* SPDX-License-Identifier: MIT */
/*
 * TGA, BMP, PSD and HDR by stb_image, whose other decoders are left out. It reads on behind the end of its
 * input, so the end is watched here: an image that needs bytes which are not there is an error.
 */
#include "ext/codec/pixels.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* stb_image fills its buffer of so many bytes when it has used it up, and asks for other numbers where it wants just
 * those. */
enum { BUFFER_BYTES = 128 };

/* A run of 128 equal pixels is the most that a byte of these formats can say. */
enum { MOST_RATIO = 128 };

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_ONLY_PSD
#define STBI_ONLY_HDR
#define STBI_MAX_DIMENSIONS 65535
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wshadow"
/* stb divides the colours of a PSD by alpha; if that is small, it converts floats above 255 to bytes. */
#ifdef __clang__
#pragma clang attribute push(__attribute__((no_sanitize("float-cast-overflow"))), apply_to = function)
#endif
#include <stb/stb_image.h>
#ifdef __clang__
#pragma clang attribute pop
#endif
#pragma GCC diagnostic pop

_Static_assert(sizeof(((stbi__context *)0)->buffer_start) == BUFFER_BYTES, "the end is told by this size");

typedef struct source {
	const unsigned char *bytes;
	size_t size, position;
	bool beyond; /* bytes behind the end were asked for */
} source;

static int read_source(void *user, char *to, int count)
{
	source *s = user;
	const size_t left = s->size - s->position;
	const size_t given = (size_t)count < left ? (size_t)count : left;
	s->beyond |= !left || (given < (size_t)count && count != BUFFER_BYTES);
	if (!left) { /* an empty line, which ends a header, and packets of many pixels, which end a row */
		memset(to, 0xff, (size_t)count);
		*to = '\0';
		return count;
	}
	memcpy(to, s->bytes + s->position, given);
	s->position += given;
	return (int)given;
}

static void skip_source(void *user, int count)
{
	source *s = user;
	const size_t left = s->size - s->position;
	s->beyond |= (size_t)count > left;
	s->position += (size_t)count < left ? (size_t)count : left;
}

static int at_end(void *user)
{
	const source *s = user;
	return s->position == s->size;
}

static const stbi_io_callbacks callbacks = {read_source, skip_source, at_end};

static nt_status fail_end(nt_error *error)
{
	return nt_fail(error, NT_ERROR_INPUT, "the image ends before its last pixel");
}

static nt_status fail(const source *s, nt_error *error)
{
	const char *why = stbi_failure_reason();
	if (why && strcmp(why, "outofmem") == 0)
		return nt_fail_memory(error);
	if (s->beyond)
		return fail_end(error);
	return nt_fail(error, NT_ERROR_INPUT, "not an image that stb_image decodes: %s", why ? why : "unknown");
}

/* stb_image gives every PSD four channels, and its own look at the depth does not find it (it skips two numbers inside
 * of a sizeof). The header: 4 signature, 2 version, 6 zeros, 2 channels, 8 size, 2 depth. */
static bool is_psd(const unsigned char *bytes, size_t size)
{
	return size > 24 && memcmp(bytes, "8BPS", 4) == 0;
}

nt_status nt_decode_stb(const unsigned char *bytes, size_t size, nt_pixels *pixels, nt_error *error)
{
	source s = {.bytes = bytes, .size = size};
	int width, height, channels;
	*pixels = (nt_pixels){0};
	if (size > INT_MAX)
		return nt_fail(error, NT_ERROR_UNSUPPORTED, "%zu bytes, more than stb_image takes", size);
	if (!stbi_info_from_callbacks(&callbacks, &s, &width, &height, &channels))
		return fail(&s, error);
	/* its own memory is only taken for what may be */
	const nt_status status = nt_pixels_check((uint64_t)width, (uint64_t)height, (unsigned)channels, 16, error);
	if (status)
		return status;
	if ((uint64_t)width * (uint64_t)height / MOST_RATIO > size)
		return nt_fail(error, NT_ERROR_INPUT, "%zu bytes cannot hold %d x %d pixels", size, width, height);
	const bool deep = is_psd(bytes, size) && bytes[23] == 16;
	const int wanted = is_psd(bytes, size) && bytes[13] < 4 ? 3 : 0;
	s = (source){.bytes = bytes, .size = size};
	void *samples = deep ? (void *)stbi_load_16_from_callbacks(&callbacks, &s, &width, &height, &channels, wanted)
			     : (void *)stbi_load_from_callbacks(&callbacks, &s, &width, &height, &channels, wanted);
	if (!samples)
		return fail(&s, error);
	if (s.beyond) {
		free(samples);
		return fail_end(error);
	}
	*pixels = (nt_pixels){.width = (uint32_t)width, .height = (uint32_t)height,
		.channels = (unsigned)(wanted ? wanted : channels), .bits = deep ? 16 : 8, .samples = samples};
	return NT_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * Types of image files, by the signatures of their formats' specifications, and their sizes.
 */
#include "file/input.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* ---- types ---- */

typedef struct image_row {
	const char *title;
	const char *media_type, *extension; /* of glTF */
	const char *names;                  /* endings of file names, each with its point */
} image_row;

static const image_row table[] = {
	[NT_IMAGE_OTHER] = {"unknown", NULL, NULL, ""},
	[NT_IMAGE_PNG] = {"PNG", "image/png", NULL, ".png"},
	[NT_IMAGE_JPEG] = {"JPEG", "image/jpeg", NULL, ".jpg.jpeg"},
	[NT_IMAGE_KTX2] = {"KTX2", "image/ktx2", "KHR_texture_basisu", ".ktx2"},
	[NT_IMAGE_WEBP] = {"WebP", "image/webp", "EXT_texture_webp", ".webp"},
	[NT_IMAGE_TGA] = {"TGA", NULL, NULL, ".tga"},
	[NT_IMAGE_BMP] = {"BMP", NULL, NULL, ".bmp"},
	[NT_IMAGE_PSD] = {"PSD", NULL, NULL, ".psd"},
	[NT_IMAGE_HDR] = {"HDR", NULL, NULL, ".hdr"},
	[NT_IMAGE_TIFF] = {"TIFF", NULL, NULL, ".tif.tiff"},
	[NT_IMAGE_EXR] = {"EXR", NULL, NULL, ".exr"},
};
enum { TYPE_COUNT = sizeof table / sizeof table[0] };

static const struct {
	nt_image_type type;
	size_t offset, length;
	const char *bytes;
} signatures[] = {
	{NT_IMAGE_PNG, 0, 8, "\x89PNG\r\n\x1a\n"},
	{NT_IMAGE_JPEG, 0, 3, "\xff\xd8\xff"},
	{NT_IMAGE_KTX2, 0, 12, "\xabKTX 20\xbb\r\n\x1a\n"},
	{NT_IMAGE_WEBP, 8, 4, "WEBP"},
	{NT_IMAGE_BMP, 0, 2, "BM"},
	{NT_IMAGE_PSD, 0, 4, "8BPS"},
	{NT_IMAGE_HDR, 0, 10, "#?RADIANCE"},
	{NT_IMAGE_HDR, 0, 6, "#?RGBE"},
	{NT_IMAGE_TIFF, 0, 4, "II*\0"},
	{NT_IMAGE_TIFF, 0, 4, "MM\0*"},
	{NT_IMAGE_EXR, 0, 4, "\x76\x2f\x31\x01"},
};
enum { SIGNATURE_COUNT = sizeof signatures / sizeof signatures[0] };

/* Truevision TGA 2.0: colour map type, image type, colour map, width, height, depth, descriptor. */
static bool is_tga(const unsigned char *bytes, size_t size)
{
	if (size < 18)
		return false;
	const unsigned map = bytes[1], type = bytes[2] & ~8u, depth = bytes[16];
	const bool mapped = type == 1;
	return (bytes[2] == type || bytes[2] == (type | 8)) && type >= 1 && type <= 3 && map <= 1 &&
		(!mapped || map == 1) &&
	       (bytes[12] | bytes[13]) && (bytes[14] | bytes[15]) && (bytes[17] & 0xc0) == 0 &&
	       (depth == 8 || depth == 15 || depth == 16 || ((depth == 24 || depth == 32) && !mapped));
}

nt_image_type nt_image_type_of_bytes(const unsigned char *bytes, size_t size)
{
	for (size_t i = 0; i < SIGNATURE_COUNT; i++)
		if (size >= signatures[i].offset + signatures[i].length &&
			memcmp(bytes + signatures[i].offset, signatures[i].bytes, signatures[i].length) == 0 &&
			(signatures[i].offset == 0 || memcmp(bytes, "RIFF", 4) == 0))
			return signatures[i].type;
	return is_tga(bytes, size) ? NT_IMAGE_TGA : NT_IMAGE_OTHER;
}

nt_image_type nt_image_type_of_name(const char *name)
{
	const char *dot = strrchr(name, '.');
	const size_t length = dot ? strlen(dot) : 0;
	for (int type = NT_IMAGE_PNG; length && type < TYPE_COUNT; type++)
		for (const char *ending = table[type].names; ending; ending = strchr(ending + 1, '.'))
			if (strncasecmp(ending, dot, length) == 0 &&
				(ending[length] == '.' || ending[length] == '\0'))
				return (nt_image_type)type;
	return NT_IMAGE_OTHER;
}

const char *nt_image_type_name(nt_image_type type)
{
	return table[type].title;
}

bool nt_image_is_carried(nt_image_type type)
{
	return table[type].media_type != NULL;
}

const char *nt_image_media_type(nt_image_type type)
{
	return table[type].media_type;
}

const char *nt_image_extension(nt_image_type type)
{
	return table[type].extension;
}

/* ---- sizes, where their formats have them ---- */

/* PNG in its first chunk (W3C PNG, 11.2.1), JPEG in the first frame header, behind other segments (ITU-T T.81, B.2.2),
 * TIFF among the tags of its first directory (TIFF 6.0, section 2), HDR in the line behind its header, the others at
 * fixed places. */

static uint64_t number_at(const unsigned char *p, size_t bytes, bool big_endian)
{
	uint64_t value = 0;
	for (size_t i = 0; i < bytes; i++)
		value = value << 8 | p[big_endian ? i : bytes - 1 - i];
	return value;
}

/* The place of the segment of the first marker of a kind, with the marker: SOF0 to SOF15 without DHT, JPG and DAC,
 * which lie among them, or SOS. SIZE_MAX: there is none. */
static size_t find_segment(const unsigned char *bytes, size_t size, bool scan)
{
	size_t at = 2;
	while (at + 9 < size && bytes[at] == 0xFF) {
		const unsigned char marker = bytes[at + 1];
		if (marker == 0xFF) { /* fill */
			at++;
			continue;
		}
		if (scan ? marker == 0xDA
			 : marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC)
			return at;
		at += 2 + number_at(bytes + at + 2, 2, true);
	}
	return SIZE_MAX;
}

static void size_of_jpeg(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	const size_t at = find_segment(bytes, size, false);
	if (at == SIZE_MAX)
		return;
	pixels[0] = (uint32_t)number_at(bytes + at + 7, 2, true);
	pixels[1] = (uint32_t)number_at(bytes + at + 5, 2, true);
}

/* If a frame is progressive, or its first scan lacks components, all scans are read. In their data each 0xFF has
 * 0 or the number of a restart behind it (B.1.1.5). */
static uint64_t scans_of_jpeg(const unsigned char *bytes, size_t size)
{
	const size_t frame = find_segment(bytes, size, false), scan = find_segment(bytes, size, true);
	if (frame == SIZE_MAX || scan == SIZE_MAX)
		return 1;
	const unsigned kind = bytes[frame + 1] & 3; /* 2: progressive */
	if (kind != 2 && bytes[scan + 4] == bytes[frame + 9])
		return 1;
	uint64_t count = 0;
	const unsigned char *const end = bytes + size, *at = bytes + scan;
	for (; (at = memchr(at, 0xFF, (size_t)(end - at))) && end - at > 1; at++)
		count += at[1] == 0xDA;
	return count;
}

/* `numbers` [tags] receives those of the tags from `first` on that the first directory has. */
static void tags_of_tiff(const unsigned char *bytes, size_t size, unsigned first, unsigned tags, uint32_t *numbers)
{
	enum { SHORT = 3, HEAD = 2, ENTRY = 12 };
	if (size < 8)
		return;
	const bool big_endian = bytes[0] == 'M';
	const uint64_t at = number_at(bytes + 4, 4, big_endian);
	const uint64_t count = at < size - HEAD ? number_at(bytes + at, HEAD, big_endian) : 0;
	for (uint64_t i = 0; i < count && size - at - HEAD >= (i + 1) * ENTRY; i++) {
		const unsigned char *tag = bytes + at + HEAD + i * ENTRY;
		const uint64_t name = number_at(tag, 2, big_endian), type = number_at(tag + 2, 2, big_endian);
		if (name >= first && name - first < tags)
			numbers[name - first] = (uint32_t)number_at(tag + 8, type == SHORT ? 2 : 4, big_endian);
	}
}

static void size_of_tiff(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	enum { WIDTH = 256 };
	tags_of_tiff(bytes, size, WIDTH, 2, pixels);
}

/* Tiles are decoded whole: of an image of one column, too. */
static uint64_t work_of_tiff(const unsigned char *bytes, size_t size, const uint32_t pixels[2])
{
	enum { TILE_WIDTH = 322 };
	uint32_t tile[2] = {0, 0};
	uint64_t work = 1;
	tags_of_tiff(bytes, size, TILE_WIDTH, 2, tile);
	for (int axis = 0; axis < 2; axis++) {
		const uint64_t side = tile[0] && tile[1] ? tile[axis] : 1;
		if (__builtin_mul_overflow(work, (pixels[axis] + side - 1) / side * side, &work))
			return UINT64_MAX;
	}
	return work;
}

/* "-Y 2 +X 3" behind an empty line */
static void size_of_hdr(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	const unsigned char *end = memmem(bytes, size, "\n\n", 2);
	char line[32] = "";
	if (!end)
		return;
	const size_t left = size - (size_t)(end + 2 - bytes);
	memcpy(line, end + 2, left < sizeof line - 1 ? left : sizeof line - 1);
	if (sscanf(line, "-Y %9u +X %9u", &pixels[1], &pixels[0]) != 2)
		pixels[0] = 0;
}

/* With a header of 12 bytes in 2 bytes each; a negative height is that of an image from the top. */
static void size_of_bmp(const unsigned char *bytes, uint32_t pixels[2])
{
	const bool old = number_at(bytes + 14, 4, false) == 12;
	pixels[0] = (uint32_t)number_at(bytes + 18, old ? 2 : 4, false);
	pixels[1] = (uint32_t)number_at(bytes + (old ? 20 : 22), old ? 2 : 4, false);
	if (!old && pixels[1] > INT32_MAX)
		pixels[1] = 0 - pixels[1];
}

/* Behind the header of 12 bytes is a chunk of an image with loss, of one without, or of a file with more. */
static void size_of_webp(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	enum { HEADER = 30, LOSSLESS_HEADER = 25 };
	if (size >= HEADER && memcmp(bytes + 12, "VP8 ", 4) == 0) {
		pixels[0] = (uint32_t)number_at(bytes + 26, 2, false) & 0x3fff;
		pixels[1] = (uint32_t)number_at(bytes + 28, 2, false) & 0x3fff;
	} else if (size >= LOSSLESS_HEADER && memcmp(bytes + 12, "VP8L", 4) == 0) {
		const uint32_t sides = (uint32_t)number_at(bytes + 21, 4, false);
		pixels[0] = (sides & 0x3fff) + 1;
		pixels[1] = (sides >> 14 & 0x3fff) + 1;
	} else if (size >= HEADER && memcmp(bytes + 12, "VP8X", 4) == 0) {
		pixels[0] = (uint32_t)number_at(bytes + 24, 3, false) + 1;
		pixels[1] = (uint32_t)number_at(bytes + 27, 3, false) + 1;
	}
}

bool nt_image_size(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	enum { MOST_HEADER = 26 };
	const nt_image_type type = nt_image_type_of_bytes(bytes, size);
	pixels[0] = pixels[1] = 0;
	if (type == NT_IMAGE_JPEG) {
		size_of_jpeg(bytes, size, pixels);
	} else if (type == NT_IMAGE_TIFF) {
		size_of_tiff(bytes, size, pixels);
	} else if (type == NT_IMAGE_WEBP) {
		size_of_webp(bytes, size, pixels);
	} else if (type == NT_IMAGE_HDR) {
		size_of_hdr(bytes, size, pixels);
	} else if (type == NT_IMAGE_BMP && size >= MOST_HEADER) {
		size_of_bmp(bytes, pixels);
	} else if (type == NT_IMAGE_TGA && size >= 16) {
		pixels[0] = (uint32_t)number_at(bytes + 12, 2, false);
		pixels[1] = (uint32_t)number_at(bytes + 14, 2, false);
	} else if (type == NT_IMAGE_PNG && size >= 24 && memcmp(bytes + 12, "IHDR", 4) == 0) {
		pixels[0] = (uint32_t)number_at(bytes + 16, 4, true);
		pixels[1] = (uint32_t)number_at(bytes + 20, 4, true);
	} else if (type == NT_IMAGE_PSD && size >= 22) {
		pixels[0] = (uint32_t)number_at(bytes + 18, 4, true);
		pixels[1] = (uint32_t)number_at(bytes + 14, 4, true);
	}
	if (pixels[0] && pixels[1])
		return true;
	pixels[0] = pixels[1] = 0;
	return false;
}

uint64_t nt_image_work(const unsigned char *bytes, size_t size)
{
	uint32_t pixels[2];
	if (!nt_image_size(bytes, size, pixels))
		return 0;
	const nt_image_type type = nt_image_type_of_bytes(bytes, size);
	if (type == NT_IMAGE_TIFF)
		return work_of_tiff(bytes, size, pixels);
	return (uint64_t)pixels[0] * pixels[1] * (type == NT_IMAGE_JPEG ? scans_of_jpeg(bytes, size) : 1);
}

/* SPDX-License-Identifier: MIT */
/*
 * Image types: see input.h. The signatures are those of the formats' specifications.
 */
#include "file/input.h"

#include <string.h>
#include <strings.h>

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

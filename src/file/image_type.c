/* SPDX-License-Identifier: MIT */
/*
 * Image types: see image_type.h. The signatures are those of the formats' specifications.
 */
#include "file/image_type.h"

#include <string.h>
#include <strings.h>

typedef struct image_row {
	const char *media_type, *extension; /* of glTF */
	const char *names;                  /* endings of file names, each with its point */
} image_row;

static const image_row table[] = {
	[NT_IMAGE_OTHER] = {NULL, NULL, ""},
	[NT_IMAGE_PNG] = {"image/png", NULL, ".png"},
	[NT_IMAGE_JPEG] = {"image/jpeg", NULL, ".jpg.jpeg"},
	[NT_IMAGE_KTX2] = {"image/ktx2", "KHR_texture_basisu", ".ktx2"},
	[NT_IMAGE_WEBP] = {"image/webp", "EXT_texture_webp", ".webp"},
};
enum { TYPE_COUNT = sizeof table / sizeof table[0] };

nt_image_type nt_image_type_of_bytes(const unsigned char *bytes, size_t size)
{
	if (size >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0)
		return NT_IMAGE_PNG;
	if (size >= 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0)
		return NT_IMAGE_JPEG;
	if (size >= 12 && memcmp(bytes, "\xabKTX 20\xbb\r\n\x1a\n", 12) == 0)
		return NT_IMAGE_KTX2;
	if (size >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0)
		return NT_IMAGE_WEBP;
	return NT_IMAGE_OTHER;
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

const char *nt_image_media_type(nt_image_type type)
{
	return table[type].media_type;
}

const char *nt_image_extension(nt_image_type type)
{
	return table[type].extension;
}

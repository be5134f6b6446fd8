/* SPDX-License-Identifier: MIT */
/*
 * Sizes of images: see image_size.h. A PNG has them in its first chunk (W3C PNG, 11.2.1), a JPEG in the first frame
 * header, behind other segments (ITU-T T.81, B.2.2).
 */
#include "file/image_size.h"

#include <string.h>
#include "file/image_type.h"

static uint32_t big_endian(const unsigned char *p, int bytes)
{
	uint32_t value = 0;
	for (int i = 0; i < bytes; i++)
		value = value << 8 | p[i];
	return value;
}

static void size_of_png(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	if (size < 24 || memcmp(bytes + 12, "IHDR", 4) != 0)
		return;
	pixels[0] = big_endian(bytes + 16, 4);
	pixels[1] = big_endian(bytes + 20, 4);
}

/* SOF0 to SOF15, without DHT, JPG and DAC, which lie among them. */
static bool is_frame(unsigned char marker)
{
	return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

static void size_of_jpeg(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	size_t at = 2;
	while (at + 9 < size && bytes[at] == 0xFF) {
		const unsigned char marker = bytes[at + 1];
		if (marker == 0xFF) { /* fill */
			at++;
			continue;
		}
		if (is_frame(marker)) {
			pixels[0] = big_endian(bytes + at + 7, 2);
			pixels[1] = big_endian(bytes + at + 5, 2);
			return;
		}
		at += 2 + big_endian(bytes + at + 2, 2);
	}
}

bool nt_image_size(const unsigned char *bytes, size_t size, uint32_t pixels[2])
{
	const nt_image_type type = nt_image_type_of_bytes(bytes, size);
	pixels[0] = pixels[1] = 0;
	if (type == NT_IMAGE_PNG)
		size_of_png(bytes, size, pixels);
	else if (type == NT_IMAGE_JPEG)
		size_of_jpeg(bytes, size, pixels);
	if (pixels[0] && pixels[1])
		return true;
	pixels[0] = pixels[1] = 0;
	return false;
}

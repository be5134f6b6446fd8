/* SPDX-License-Identifier: MIT */
#include "base/utf8.h"

#include <stdint.h>
#include <string.h>

size_t nt_utf8_length(const char *text, size_t size)
{
	const unsigned char *p = (const unsigned char *)text;
	if (p[0] < 0x80)
		return 1;
	const size_t length = p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
	if (p[0] < 0xc2 || p[0] > 0xf4 || length > size)
		return 0;
	for (size_t i = 1; i < length; i++)
		if ((p[i] & 0xc0) != 0x80)
			return 0;
	const bool overlong = (p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xf0 && p[1] < 0x90);
	const bool surrogate = p[0] == 0xed && p[1] > 0x9f;
	const bool beyond = p[0] == 0xf4 && p[1] > 0x8f;
	return overlong || surrogate || beyond ? 0 : length;
}

bool nt_utf8_is_unsafe(const char *text, size_t length)
{
	const unsigned char *p = (const unsigned char *)text;
	if (length < 2)
		return length == 0 || p[0] < 0x20 || p[0] == 0x7f;
	if (length == 2)
		return p[0] == 0xc2 && p[1] < 0xa0;
	const uint32_t code = length == 3 ? (p[0] & 0xfu) << 12 | (p[1] & 0x3fu) << 6 | (p[2] & 0x3fu) : 0;
	return (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) || code == 0xfffe ||
	       code == 0xffff;
}

size_t nt_utf8_cut(const char *text, size_t most)
{
	size_t cut = strnlen(text, most);
	if (text[cut])
		for (size_t back = 1; back < 4 && back <= cut; back++)
			if (nt_utf8_length(text + cut - back, SIZE_MAX) > back)
				return cut - back;
	return cut;
}

void nt_utf8_mask(char *text)
{
	for (size_t length; *text; text += length) {
		length = nt_utf8_length(text, SIZE_MAX);
		const bool unsafe = nt_utf8_is_unsafe(text, length);
		length = length ? length : 1;
		if (unsafe)
			memset(text, '?', length);
	}
}

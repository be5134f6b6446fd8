/* SPDX-License-Identifier: MIT */
/*
 * Whole numbers in few bytes: seven bits in each, the lowest first, the eighth bit says that more follow.
 */
#ifndef NT_REPORT_PACK_VARINT_H
#define NT_REPORT_PACK_VARINT_H

#include "base/buffer.h"

static inline void nt_put_varint(uint32_t value, nt_buffer *out)
{
	unsigned char bytes[5];
	size_t size = 0;
	for (; value >= 128; value >>= 7)
		bytes[size++] = (unsigned char)(value | 128);
	bytes[size++] = (unsigned char)value;
	nt_buffer_append(out, bytes, size);
}

/* Small numbers of either sign become small ones without: 0 -1 1 -2 2 ... become 0 1 2 3 4 ... */
static inline uint32_t nt_zigzag(uint32_t difference)
{
	return difference << 1 ^ (0u - (difference >> 31));
}

#endif

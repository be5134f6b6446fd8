/* SPDX-License-Identifier: MIT */
#include "ext/linked.h"

#include <libdeflate.h>

/* libdeflate's own default; one step more costs half as much time again for a hundredth of the bytes. */
enum { LEVEL = 6 };

void nt_deflate(const void *bytes, size_t size, nt_buffer *out)
{
	struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
	const size_t before = out->size;
	const size_t most = compressor ? libdeflate_deflate_compress_bound(compressor, size) : 0;
	char *packed = compressor ? nt_buffer_extend(out, most) : NULL;
	if (packed) {
		out->size = before + libdeflate_deflate_compress(compressor, bytes, size, packed, most);
		out->data[out->size] = '\0';
	}
	out->failed |= !packed;
	libdeflate_free_compressor(compressor);
}

/* SPDX-License-Identifier: MIT */
/*
 * Libraries in the tool itself: XXH3 of xxHash, whose functions are compiled in here, and libdeflate; and which they
 * are.
 */
#include "ext/linked.h"

#include <stdio.h> /* before jpeglib.h, which does not include it */
#include <stdlib.h>

#include <jpeglib.h>
#include <libdeflate.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

/* ---- digests ---- */

/* Copying 200 MB takes 52 ms, so the digest has to come at the speed of memory, and users can check it with a program
 * that every distribution has. */

struct nt_digest {
	XXH3_state_t *state;
};

nt_digest *nt_digest_create(void)
{
	nt_digest *digest = malloc(sizeof *digest);
	if (!digest)
		return NULL;
	digest->state = XXH3_createState();
	if (!digest->state) {
		free(digest);
		return NULL;
	}
	XXH3_128bits_reset(digest->state);
	return digest;
}

void nt_digest_free(nt_digest *digest)
{
	if (!digest)
		return;
	XXH3_freeState(digest->state);
	free(digest);
}

void nt_digest_add(nt_digest *digest, const void *bytes, size_t size)
{
	if (size)
		XXH3_128bits_update(digest->state, bytes, size);
}

void nt_digest_text(const nt_digest *digest, char text[NT_DIGEST_TEXT])
{
	const XXH128_hash_t hash = XXH3_128bits_digest(digest->state);
	snprintf(text, NT_DIGEST_TEXT, "%016llx%016llx", (unsigned long long)hash.high64,
		(unsigned long long)hash.low64);
}

/* ---- Deflate ---- */

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

/* ---- which they are ---- */

#define SPELLED(macro) #macro
#define TEXT(macro) SPELLED(macro)

const nt_linked_library *nt_linked_libraries(size_t *count)
{
	static const nt_linked_library libraries[] = {
		{"fast_float", NULL, "MIT OR Apache-2.0 OR BSL-1.0"},
		{"libdeflate", LIBDEFLATE_VERSION_STRING, "MIT"},
		{"libjpeg-turbo", TEXT(LIBJPEG_TURBO_VERSION), "IJG AND BSD-3-Clause AND Zlib"},
		{"libstdc++", NULL, "GPL-3.0-or-later WITH GCC-exception-3.1"},
		{"stb_image", NULL, "MIT OR Unlicense"},
		{"xxHash", TEXT(XXH_VERSION_MAJOR) "." TEXT(XXH_VERSION_MINOR) "." TEXT(XXH_VERSION_RELEASE),
			"BSD-2-Clause"},
	};
	*count = sizeof libraries / sizeof *libraries;
	return libraries;
}

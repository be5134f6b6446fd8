/* SPDX-License-Identifier: MIT */
/*
 * Digests by xxHash (libxxhash-dev), whose functions are compiled in here: nothing is to be linked.
 *
 * Why this one: copying 200 MB takes 52 ms, so the digest has to come at the speed of
 * memory, and users can check it with a program that every distribution has.
 */
#include "ext/linked.h"

#include <stdio.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

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

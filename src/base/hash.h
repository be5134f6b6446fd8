/* SPDX-License-Identifier: MIT */
/*
 * Hashes for tables of what files hold: numbers and texts. Words have a key added by XOR and are multiplied to 128
 * bits, twice (as in wyhash). The key is another in each process, so that nobody can make a file whose contents have
 * one hash and would each be compared with all others. For tables only: what is written must not depend on it.
 */
#ifndef NT_BASE_HASH_H
#define NT_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include "base/compiler.h"

#ifdef __cplusplus
extern "C" { /* for src/ext */
#endif

enum { NT_HASH_KEY_WORDS = 2 };

extern uint64_t nt_hash_key_words[NT_HASH_KEY_WORDS];
void nt_hash_make_key(void);

/* The key of this process, in memory of the caller: threads may make it at once, all the same. */
static inline void nt_hash_key(uint64_t key[NT_HASH_KEY_WORDS])
{
	/* the last word is stored last, and never 0 */
	if (!nt_atomic_load(&nt_hash_key_words[NT_HASH_KEY_WORDS - 1], ACQUIRE))
		nt_hash_make_key();
	for (size_t i = 0; i < NT_HASH_KEY_WORDS; i++)
		key[i] = nt_atomic_load(&nt_hash_key_words[i], RELAXED);
}

/* The hash of two words. Slots may be made of any of its bits: after one product grids still have up to twice as many
 * probes as what is random (test_hash.c). */
static inline uint64_t nt_hash_words_by(const uint64_t *key, uint64_t a, uint64_t b)
{
	a = nt_multiply(a ^ key[0], b ^ key[1], &b) ^ key[0];
	a = nt_multiply(a, b ^ key[1], &b);
	return a ^ b;
}

static inline uint64_t nt_hash_words(uint64_t a, uint64_t b)
{
	uint64_t key[NT_HASH_KEY_WORDS];
	nt_hash_key(key);
	return nt_hash_words_by(key, a, b);
}

/* The hash of `size` bytes that follow those of `seed`; 0 begins. */
uint64_t nt_hash_bytes(uint64_t seed, const void *bytes, size_t size);

/* The bits of two floats, -0 made +0: equal floats have equal bits. */
static inline uint64_t nt_hash_floats(float a, float b)
{
	const float values[2] = {a + 0.0f, b + 0.0f};
	uint64_t bits;
	memcpy(&bits, values, sizeof bits);
	return bits;
}

/* A hash without a key, for names that are written. */
uint64_t nt_hash_name(uint64_t seed, const char *name);

/* The same of bytes, for digests that are compared with those of other runs. */
uint64_t nt_hash_unkeyed(uint64_t seed, const void *bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif

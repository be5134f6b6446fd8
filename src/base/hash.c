/* SPDX-License-Identifier: MIT */
/*
 * The hashes of hash.h, and their key: of what Linux gives each process by chance, else of the addresses that it has.
 */
#include "base/hash.h"

#if __has_include(<sys/auxv.h>)
#include <sys/auxv.h>
#endif

uint64_t nt_hash_key_words[NT_HASH_KEY_WORDS];

/* Digits of pi: numbers of no structure. The key is mixed from them and the random bytes that the system gives a
 * process: these guard its stack, too, so that nobody may learn them from how long a table takes. */
static const uint64_t digits[2 * NT_HASH_KEY_WORDS] = {0x243f6a8885a308d3u, 0x13198a2e03707344u, 0xa4093822299f31d0u,
	0x082efa98ec4e6c89u};

/* All threads that come here make the same. */
void nt_hash_make_key(void)
{
	uint64_t chance[2] = {(uintptr_t)&nt_hash_key_words, (uintptr_t)&memcpy};
#ifdef AT_RANDOM
	const unsigned long bytes = getauxval(AT_RANDOM); /* the address of 16 */
	if (bytes)
		memcpy(chance, (const void *)bytes, sizeof chance);
#endif
	for (size_t i = 0; i < NT_HASH_KEY_WORDS; i++) {
		const uint64_t word = nt_hash_words_by(digits + 2 * i, chance[0], chance[1]);
		nt_atomic_store(&nt_hash_key_words[i], word | 1, RELEASE);
	}
}

uint64_t nt_hash_bytes(uint64_t seed, const void *bytes, size_t size)
{
	uint64_t key[NT_HASH_KEY_WORDS];
	nt_hash_key(key);
	const unsigned char *at = bytes;
	uint64_t hash = seed + 0x9e3779b97f4a7c15u * (size + 1);
	do {
		uint64_t words[2] = {0, 0};
		const size_t part = size < sizeof words ? size : sizeof words;
		memcpy(words, at, part);
		hash = nt_hash_words_by(key, words[0], words[1] ^ hash);
		at += part;
		size -= part;
	} while (size);
	return hash;
}

uint64_t nt_hash_name(uint64_t seed, const char *name)
{
	size_t size = strlen(name);
	uint64_t hash = seed ^ 0x9e3779b97f4a7c15u ^ size;
	for (; size; name += 4) {
		uint32_t word = 0;
		const size_t part = size < sizeof word ? size : sizeof word;
		memcpy(&word, name, part);
		hash = (hash ^ word) * 0xff51afd7ed558ccdu;
		hash ^= hash >> 32;
		size -= part;
	}
	return hash;
}

uint64_t nt_hash_unkeyed(uint64_t seed, const void *bytes, size_t size)
{
	static const uint64_t key[NT_HASH_KEY_WORDS] = {UINT64_C(0x9e3779b97f4a7c15), UINT64_C(0xd1b54a32d192ed03)};
	const unsigned char *p = bytes;
	uint64_t hash = nt_hash_words_by(key, seed, size);
	for (size_t left = size; left; left -= left < 16 ? left : 16, p += 16) {
		uint64_t words[2] = {0, 0};
		memcpy(words, p, left < 16 ? left : 16);
		hash = nt_hash_words_by(key, hash ^ words[0], words[1]);
	}
	return hash;
}

/* SPDX-License-Identifier: MIT */
/*
 * Things of two versions that are the same: by a key, each once.
 */
#ifndef NT_REPORT_PAIRS_H
#define NT_REPORT_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/text.h"

/* The key of a thing; 0: it has none. */
typedef uint64_t (*nt_key_of)(const void *things, size_t index);

/* A thing that has a key, by its number. */
typedef struct nt_keyed {
	uint64_t key;
	uint32_t index;
} nt_keyed;

/* The things that have keys, ascending, equal ones in their order; the caller frees the list. NULL: out of memory. */
nt_keyed *nt_list_keys(const void *things, size_t count, nt_key_of key_of, size_t *listed);

/* The partners of new things: an old one of each, UINT32_MAX: none; and whether an old one has a partner. */
typedef struct nt_pairs {
	uint32_t *partners;
	bool *taken;
} nt_pairs;

/*
 * Pairs what has no partner yet. Equal keys are paired one by one in their order, in time that many equal ones do not
 * lengthen, and a much longer old list hardly. pairs->taken NULL: none is.
 */
void nt_pair_keys(nt_pairs *pairs, const nt_keyed *old, size_t old_count, const nt_keyed *new, size_t new_count);

/* Pairs things by the first of the keys, the rest by the others. False: out of memory. To be freed in either case. */
bool nt_pair(nt_pairs *pairs, const void *old, size_t old_count, const void *new, size_t new_count,
	const nt_key_of keys[2]);

/* Every new thing without a partner. False: out of memory. */
bool nt_pairs_begin(nt_pairs *pairs, size_t new_count);

void nt_pairs_free(nt_pairs *pairs);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Things of two versions that are the same: by a key, each once.
 */
#ifndef NT_REPORT_PAIRS_H
#define NT_REPORT_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/error.h"

/* The key of a thing; 0: it has none. */
typedef uint64_t (*nt_key_of)(const void *things, size_t index);

/* A thing that has a key, by its number. */
typedef struct nt_keyed {
	uint64_t key;
	uint32_t index;
} nt_keyed;

/* The things that have keys, ascending, equal ones in their order; the caller frees the list. NULL: out of memory. */
nt_keyed *nt_list_keys(const void *things, size_t count, nt_key_of key_of, size_t *listed);

/*
 * Pairs what has no partner yet. Equal keys are paired one by one in their order, in time that many equal ones do not
 * lengthen, and a much longer old list hardly.
 *
 *   partners  [things] in and out: the old thing that each new one is; UINT32_MAX: none
 *   taken     [things] in and out: old things that have a partner; NULL: none has
 */
void nt_pair_keys(const nt_keyed *old, size_t old_count, const nt_keyed *new, size_t new_count, uint32_t *partners,
	bool *taken);

/* The same of things. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_pair(const void *old, size_t old_count, const void *new, size_t new_count, nt_key_of key_of,
	uint32_t *partners, bool *taken);

#endif

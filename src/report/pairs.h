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

/*
 * Pairs what has no partner yet. Equal keys are paired one by one in their order, in time that many equal ones do not
 * lengthen.
 *
 *   partners  [new_count] in and out: the old thing that each new one is; UINT32_MAX: none
 *   taken     [old_count] in and out: old things that have a partner
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_pair(const void *old, size_t old_count, const void *new, size_t new_count, nt_key_of key_of,
	uint32_t *partners, bool *taken);

#endif

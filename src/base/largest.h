/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers: how indices are checked. A loop that stops at the first bad one takes
 * longer, because it cannot look at several at once.
 */
#ifndef NT_BASE_LARGEST_H
#define NT_BASE_LARGEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The largest of values[0..count); 0 where there are none. */
uint32_t nt_largest(const uint32_t *values, size_t count);

/* Whether each of values[0..count) is below a limit. */
bool nt_all_below(const uint32_t *values, size_t count, uint32_t limit);

#endif

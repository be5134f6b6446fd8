/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers: how indices are checked. A loop that stops at the first bad one takes
 * longer, because it cannot look at several at once.
 */
#ifndef NT_BASE_LARGEST_H
#define NT_BASE_LARGEST_H

#include <stddef.h>
#include <stdint.h>

/* The largest of values[0..count); 0 where there are none. */
uint32_t nt_largest(const uint32_t *values, size_t count);

#endif

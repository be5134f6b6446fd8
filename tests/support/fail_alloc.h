/* SPDX-License-Identifier: MIT */
/*
 * Makes the n-th allocation of our own objects fail (malloc, calloc, realloc, posix_memalign, strdup and strndup, by
 * the linker's --wrap; what libraries allocate inside is not touched).
 */
#ifndef NT_TEST_FAIL_ALLOC_H
#define NT_TEST_FAIL_ALLOC_H

#include <stdbool.h>
#include <stddef.h>

/* From now on the allocation number n (0: the next one) fails, and every later one. */
void fail_allocations_from(size_t n);

/* The same of that one alone: memory comes back, so that what passes over a failure makes something else. */
void fail_allocation(size_t n);

/* Ends that. Returns whether an allocation failed meanwhile. */
bool stop_failing_allocations(void);

#endif

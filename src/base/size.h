/* SPDX-License-Identifier: MIT */
/*
 * Sizes that are checked: those that come from files or callers are multiplied and added here and nowhere else.
 */
#ifndef NT_BASE_SIZE_H
#define NT_BASE_SIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* product = a * b, sum = a + b; false where that overflows (the result is then SIZE_MAX). */
static inline bool nt_size_mul(size_t a, size_t b, size_t *product)
{
	const bool fits = b == 0 || a <= SIZE_MAX / b;
	*product = fits ? a * b : SIZE_MAX;
	return fits;
}

static inline bool nt_size_add(size_t a, size_t b, size_t *sum)
{
	const bool fits = a <= SIZE_MAX - b;
	*sum = fits ? a + b : SIZE_MAX;
	return fits;
}

#endif

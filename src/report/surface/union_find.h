/* SPDX-License-Identifier: MIT */
/*
 * Union and find, the lower number on top. Parents only ever become lower, whatever other threads unite at the same
 * time; so the result does not depend on their order.
 */
#ifndef NT_REPORT_UNION_FIND_H
#define NT_REPORT_UNION_FIND_H

#include <stdbool.h>
#include <stdint.h>

/* parents[i] is i at first. */
static inline uint32_t nt_find_root(uint32_t *parents, uint32_t i)
{
	for (;;) {
		const uint32_t parent = __atomic_load_n(&parents[i], __ATOMIC_RELAXED);
		if (parent == i)
			return i;
		const uint32_t above = __atomic_load_n(&parents[parent], __ATOMIC_RELAXED);
		if (above != parent)
			__atomic_store_n(&parents[i], above, __ATOMIC_RELAXED);
		i = above;
	}
}

static inline void nt_unite(uint32_t *parents, uint32_t a, uint32_t b)
{
	for (;;) {
		a = nt_find_root(parents, a);
		b = nt_find_root(parents, b);
		if (a == b)
			return;
		uint32_t high = a > b ? a : b;
		const uint32_t low = a > b ? b : a;
		if (__atomic_compare_exchange_n(&parents[high], &high, low, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
			return;
	}
}

#endif

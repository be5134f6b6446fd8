/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers, and whether all are below a limit: see numbers.h.
 */
#include "base/numbers.h"

uint32_t nt_largest(const uint32_t *values, size_t count)
{
	uint32_t largest = 0;
	for (size_t i = 0; i < count; i++)
		largest = values[i] > largest ? values[i] : largest;
	return largest;
}

/* Up to 2^31 the highest bit of a difference tells, and of all differences at once: vectors of SSE2 do not compare
 * numbers without a sign. */
bool nt_all_below(const uint32_t *values, size_t count, uint32_t limit)
{
	if (limit > (uint32_t)1 << 31)
		return count == 0 || nt_largest(values, count) < limit;
	uint32_t beyond = 0;
	for (size_t i = 0; i < count; i++)
		beyond |= values[i] | (limit - 1 - values[i]);
	return !(beyond >> 31);
}

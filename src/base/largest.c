/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers: see largest.h.
 */
#include "base/largest.h"

uint32_t nt_largest(const uint32_t *values, size_t count)
{
	uint32_t largest = 0;
	for (size_t i = 0; i < count; i++)
		largest = values[i] > largest ? values[i] : largest;
	return largest;
}

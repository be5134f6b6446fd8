/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers, wherever it stands.
 */
#include "base/largest.h"
#include "test.h"

TEST(none_of_no_numbers)
{
	assert_int_equal(nt_largest(NULL, 0), 0);
}

TEST(few_numbers_at_every_place)
{
	uint32_t values[70];
	for (size_t count = 1; count <= 70; count++) {
		for (size_t at = 0; at < count; at++) {
			for (size_t i = 0; i < count; i++)
				values[i] = (uint32_t)(i * 2654435761u) >> 1;
			values[at] = 0x80000000u; /* larger than the others as unsigned numbers only */
			assert_int_equal(nt_largest(values, count), 0x80000000u);
			values[at] = UINT32_MAX;
			assert_int_equal(nt_largest(values, count), UINT32_MAX);
		}
	}
}

int main(void)
{
	return run_group("base/largest");
}

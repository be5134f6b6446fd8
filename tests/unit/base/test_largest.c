/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers, wherever it stands.
 */
#include "base/numbers.h"
#include "test.h"

TEST(few_numbers_at_every_place)
{
	uint32_t values[70];
	assert_int_equal(nt_largest(NULL, 0), 0);
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

TEST(a_number_beyond_a_limit_is_found_at_every_place)
{
	static const uint32_t limits[] = {1, 2, 1000, 0x7fffffffu, 0x80000000u, 0x80000001u, UINT32_MAX};
	uint32_t values[70];
	assert_true(nt_all_below(NULL, 0, 0));
	for (size_t l = 0; l < sizeof limits / sizeof *limits; l++)
		for (size_t count = 1; count <= 70; count++) {
			for (size_t i = 0; i < count; i++)
				values[i] = (limits[l] - 1) / (uint32_t)(i + 1);
			assert_true(nt_all_below(values, count, limits[l]));
			assert_false(nt_all_below(values, count, 0));
			for (size_t at = 0; at < count; at++) {
				const uint32_t was = values[at];
				values[at] = limits[l];
				assert_false(nt_all_below(values, count, limits[l]));
				values[at] = UINT32_MAX;
				assert_false(nt_all_below(values, count, limits[l]));
				values[at] = was;
			}
		}
}

/* SPDX-License-Identifier: MIT */
#include "base/hash_index.h"
#include "test.h"

TEST(numbers_of_a_hash_come_in_the_order_of_adding)
{
	nt_hash_index index = {0};
	/* the last place of every table is the home of hash ~0: its numbers run over to the first places */
	const uint64_t hashes[] = {~(uint64_t)0, 0, 63};
	for (uint32_t i = 0; i < 3000; i++)
		assert_true(nt_hash_index_add(&index, hashes[i % 3], i));
	for (uint32_t k = 0; k < 3; k++) {
		size_t at = NT_HASH_BEGIN;
		for (uint32_t i = k; i < 3000; i += 3)
			assert_int_equal(nt_hash_index_next(&index, hashes[k], &at), i);
		assert_int_equal(nt_hash_index_next(&index, hashes[k], &at), UINT32_MAX);
	}
	assert_int_equal(index.count, 3000);
	nt_hash_index_free(&index);
}

TEST(equal_keys_have_one_number)
{
	nt_key_set set = {0};
	assert_int_equal(nt_key_find(&set, "ab", 2), UINT32_MAX);
	for (uint32_t i = 0; i < 5000; i++) {
		const uint32_t key[2] = {i % 2500, 7};
		assert_int_equal(nt_key_add(&set, key, sizeof key), i % 2500);
		assert_int_equal(nt_key_find(&set, key, sizeof key), i % 2500);
	}
	assert_int_equal(set.count, 2500);
	nt_key_set_free(&set);
	assert_int_equal(set.count, 0);
}

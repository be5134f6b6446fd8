/* SPDX-License-Identifier: MIT */
#include "base/scratch.h"
#include "test.h"

TEST(blocks_are_aligned_and_apart)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	unsigned char *blocks[100];
	for (size_t i = 0; i < 100; i++) {
		blocks[i] = nt_scratch_alloc(&scratch, i * i, 37);
		assert_non_null(blocks[i]);
		assert_int_equal((uintptr_t)blocks[i] % 64, 0);
		memset(blocks[i], (int)i, i * i * 37);
	}
	for (size_t i = 0; i < 100; i++)
		for (size_t k = 0; k < i * i * 37; k += 31)
			assert_int_equal(blocks[i][k], i);
	assert_null(nt_scratch_alloc(&scratch, SIZE_MAX / 2, 3));
	nt_scratch_free(&scratch);
}

TEST(going_back_reuses_the_same_memory)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	void *kept = nt_scratch_alloc(&scratch, 1000, 1);
	const nt_scratch_mark mark = nt_scratch_here(&scratch);
	void *first = nt_scratch_alloc(&scratch, 5000000, 1);
	void *second = nt_scratch_alloc(&scratch, 3000000, 1);
	const size_t bytes = nt_scratch_bytes(&scratch);
	for (int i = 0; i < 3; i++) {
		nt_scratch_back(&scratch, mark);
		assert_ptr_equal(nt_scratch_alloc(&scratch, 5000000, 1), first);
		assert_ptr_equal(nt_scratch_alloc(&scratch, 3000000, 1), second);
	}
	assert_int_equal(nt_scratch_bytes(&scratch), bytes);
	memset(kept, 1, 1000);
	nt_scratch_free(&scratch);
}

/* Lent memory of any alignment is used first, and is not given to the allocator. */
TEST(lent_memory_comes_first)
{
	enum { BYTES = 4096 };
	static char memory[BYTES + 1];
	for (size_t offset = 0; offset < 2; offset++) {
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_scratch_lend(&scratch, memory + offset, BYTES);
		const nt_scratch_mark mark = nt_scratch_here(&scratch);
		char *first = nt_scratch_alloc(&scratch, 2000, 1), *second = nt_scratch_alloc(&scratch, 3000, 1);
		assert_in_range(first, memory + offset, memory + offset + BYTES - 2000);
		assert_int_equal((uintptr_t)first % 64, 0);
		assert_true(second + 3000 <= memory + offset || second >= memory + offset + BYTES);
		memset(first, 1, 2000);
		memset(second, 2, 3000);
		nt_scratch_back(&scratch, mark);
		assert_ptr_equal(nt_scratch_alloc(&scratch, 2000, 1), first);
		nt_scratch_free(&scratch);
	}
}

/* The expected bytes are in the first block that is not lent, once. */
TEST(the_first_own_block_is_as_large_as_expected)
{
	static char memory[4096];
	for (int lends = 0; lends < 2; lends++) {
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		if (lends)
			nt_scratch_lend(&scratch, memory, sizeof memory);
		nt_scratch_expect(&scratch, 1000000);
		assert_non_null(nt_scratch_alloc(&scratch, 1000, 1));
		assert_non_null(nt_scratch_alloc(&scratch, 500000, 1));
		const size_t bytes = nt_scratch_bytes(&scratch);
		assert_in_range(bytes, 1000000, 1010000);
		nt_scratch_expect(&scratch, 1000000); /* too late */
		assert_non_null(nt_scratch_alloc(&scratch, 600000, 1));
		assert_in_range(nt_scratch_bytes(&scratch) - bytes, 600000, 610000);
		nt_scratch_free(&scratch);
	}
}

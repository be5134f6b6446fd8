/* SPDX-License-Identifier: MIT */
#include "base/scratch.h"
#include "test.h"

static void blocks_are_aligned_and_apart(void **state)
{
	(void)state;
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

static void going_back_reuses_the_same_memory(void **state)
{
	(void)state;
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(blocks_are_aligned_and_apart),
		cmocka_unit_test(going_back_reuses_the_same_memory),
	};
	return cmocka_run_group_tests_name("base/scratch", tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * One struct in three versions: whatever the caller's and whatever the library's, both see what both have.
 */
#include "base/structs.h"
#include "test.h"

typedef struct first {
	size_t struct_bytes, a;
} first;

typedef struct second {
	size_t struct_bytes, a, b;
} second;

typedef struct third {
	size_t struct_bytes, a, b, c;
} third;

TEST(older_caller_has_zeros_for_what_it_lacks)
{
	const third given = {sizeof(first), 1, 2, 3}; /* b and c lie behind the caller's struct */
	third ours = {9, 9, 9, 9};
	assert_true(nt_struct_read(&ours, sizeof ours, &given));
	assert_int_equal(ours.struct_bytes, sizeof ours);
	assert_int_equal(ours.a, 1);
	assert_int_equal(ours.b, 0);
	assert_int_equal(ours.c, 0);
}

TEST(newer_caller_may_not_ask_for_what_is_unknown)
{
	third given = {sizeof(third), 1, 2, 0};
	second ours;
	assert_true(nt_struct_read(&ours, sizeof ours, &given));
	assert_int_equal(ours.struct_bytes, sizeof ours);
	assert_int_equal(ours.b, 2);
	given.c = 1;
	assert_false(nt_struct_read(&ours, sizeof ours, &given));
}

TEST(sizes_that_no_struct_has_are_refused)
{
	static const size_t none[] = {0, 1, sizeof(size_t) - 1, sizeof(size_t) + 1, 4096 + sizeof(size_t), SIZE_MAX};
	for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
		const first given = {none[i], 1};
		first ours = {5, 5};
		assert_false(nt_struct_read(&ours, sizeof ours, &given));
	}
	static size_t largest[4096 / sizeof(size_t)] = {4096, 7};
	first ours;
	assert_true(nt_struct_read(&ours, sizeof ours, largest));
	assert_int_equal(ours.a, 7);
}

TEST(only_what_both_have_is_written)
{
	const second ours = {sizeof(second), 1, 2};
	third older = {sizeof(first), 7, 8, 9}, same = {sizeof(second), 7, 8, 9}, newer = {sizeof(third), 7, 8, 9};
	nt_struct_write(&older, &ours, sizeof ours);
	assert_memory_equal(&older, (&(third){sizeof(first), 1, 8, 9}), sizeof older);
	nt_struct_write(&same, &ours, sizeof ours);
	assert_memory_equal(&same, (&(third){sizeof(second), 1, 2, 9}), sizeof same);
	nt_struct_write(&newer, &ours, sizeof ours);
	assert_memory_equal(&newer, (&(third){sizeof(third), 1, 2, 9}), sizeof newer);
}

/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "base/deadline.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/scratch.h"

static nt_deadline deadline;

TEST(memory_is_refused_from_then_on)
{
	void *block = NULL;
	size_t capacity = 0;
	nt_arena arena = {0};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_null(nt_deadline_use(&deadline));
	void *early = nt_alloc(1, 1);
	assert_non_null(early);
	assert_false(nt_deadline_passed());
	atomic_store(&deadline.passed, true);
	assert_true(nt_deadline_passed());
	assert_null(nt_alloc(1, 1));
	assert_null(nt_calloc(1, 1));
	assert_false(nt_grow(&block, &capacity, 1, 1));
	assert_null(nt_arena_alloc(&arena, 1, 1));
	assert_null(nt_scratch_alloc(&scratch, 1, 1));
	assert_ptr_equal(nt_deadline_use(NULL), &deadline);
	atomic_store(&deadline.passed, false);
	void *late = nt_alloc(1, 1);
	assert_non_null(late);
	free(early);
	free(late);
}

static void note_passed(void *context, size_t item, unsigned slot)
{
	(void)slot;
	((bool *)context)[item] = nt_deadline_passed();
}

/* The deadline of the thread that asks for help, and of no other. */
TEST(threads_that_help_have_it)
{
	enum { ITEMS = 1000 };
	static bool passed[ITEMS];
	atomic_store(&deadline.passed, true);
	for (int with = 1; with >= 0; with--) {
		nt_deadline_use(with ? &deadline : NULL);
		nt_parallel_items(4, ITEMS, note_passed, passed);
		for (int i = 0; i < ITEMS; i++)
			assert_int_equal(passed[i], with);
	}
	atomic_store(&deadline.passed, false);
}

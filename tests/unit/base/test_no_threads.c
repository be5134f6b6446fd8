/* SPDX-License-Identifier: MIT */
/*
 * The pool of a build without threads, as WebAssembly has it: the caller does all, in order.
 */
#include "test.h"

#define NT_NO_THREADS
#define nt_pool_processors processors_alone
#define nt_pool_reserve reserve_alone
#define nt_pool_run run_alone
#define nt_pool_stay stay_alone
#define nt_pool_use use_alone
#define nmtan_end_threads end_alone
#include "base/pool.c"

static void note(void *context, unsigned slot)
{
	char digit[2] = {(char)('0' + slot), 0};
	strcat(context, digit);
}

TEST(the_caller_does_all_in_order)
{
	char order[16] = "";
	assert_int_equal(processors_alone(), 1);
	run_alone(0, note, order);
	assert_string_equal(order, "");
	run_alone(1, note, order);
	run_alone(4, note, order);
	assert_string_equal(order, "00123");
}

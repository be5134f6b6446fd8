/* SPDX-License-Identifier: MIT */
/*
 * A bound that threads share.
 */
#include "batch/gate.h"
#include "test.h"

#include <stdatomic.h>
#include <unistd.h>

static nt_gate gate;
static atomic_int inside;   /* who holds what they need */
static atomic_int alone;    /* of them, who need more than there is */
static atomic_ulong held;   /* what they hold */
static atomic_bool broken;

static void *use(void *need_of)
{
	const uint64_t need = *(const uint64_t *)need_of;
	for (int i = 0; i < 50; i++) {
		const bool is_alone = nt_gate_enter(&gate, need);
		const int others = atomic_fetch_add(&inside, 1);
		const unsigned long sum = atomic_fetch_add(&held, need) + need;
		if (is_alone != (need > gate.limit) || (is_alone && others > 0) || (!is_alone && sum > gate.limit))
			broken = true;
		atomic_fetch_add(&alone, is_alone);
		usleep(50);
		atomic_fetch_sub(&held, need);
		atomic_fetch_sub(&inside, 1);
		nt_gate_leave(&gate, need);
	}
	return NULL;
}

TEST(what_is_inside_is_never_more_than_the_limit_but_for_one_alone)
{
	static const uint64_t needs[] = {10, 40, 60, 100, 1, 101, UINT64_MAX / 4};
	enum { COUNT = sizeof needs / sizeof *needs };
	pthread_t threads[COUNT];
	nt_gate_init(&gate, 100);
	for (int i = 0; i < COUNT; i++)
		assert_int_equal(pthread_create(&threads[i], NULL, use, (void *)(uintptr_t)&needs[i]), 0);
	for (int i = 0; i < COUNT; i++)
		pthread_join(threads[i], NULL);
	assert_false(broken);
	assert_int_equal(alone, 100);
	assert_int_equal(gate.used, 0);
	nt_gate_end(&gate);
}

static void *enter_with_all(void *unused)
{
	(void)unused;
	nt_gate_enter(&gate, 100);
	atomic_store(&inside, 1);
	return NULL;
}

static void *enter_with_little(void *unused)
{
	(void)unused;
	nt_gate_enter(&gate, 1);
	atomic_store(&inside, 2);
	return NULL;
}

static uint64_t arrived(void)
{
	pthread_mutex_lock(&gate.lock);
	const uint64_t count = gate.arrived;
	pthread_mutex_unlock(&gate.lock);
	return count;
}

TEST(who_fits_does_not_pass_who_waits)
{
	pthread_t large, small;
	nt_gate_init(&gate, 100);
	atomic_store(&inside, 0);
	assert_false(nt_gate_enter(&gate, 50));
	assert_int_equal(pthread_create(&large, NULL, enter_with_all, NULL), 0);
	while (arrived() < 2)
		usleep(100);
	assert_int_equal(pthread_create(&small, NULL, enter_with_little, NULL), 0);
	while (arrived() < 3)
		usleep(100);
	usleep(2000);
	assert_int_equal(atomic_load(&inside), 0);
	nt_gate_leave(&gate, 50);
	pthread_join(large, NULL);
	assert_int_equal(atomic_load(&inside), 1);
	nt_gate_leave(&gate, 100);
	pthread_join(small, NULL);
	assert_int_equal(atomic_load(&inside), 2);
	nt_gate_end(&gate);
}

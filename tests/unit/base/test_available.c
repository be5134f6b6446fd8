/* SPDX-License-Identifier: MIT */
#include "base/available.h"
#include "test.h"

#include <sys/resource.h>
#include <unistd.h>

static void it_is_at_most_what_the_machine_has(void **state)
{
	(void)state;
	const uint64_t pages = (uint64_t)sysconf(_SC_PHYS_PAGES), page = (uint64_t)sysconf(_SC_PAGESIZE);
	assert_true(nt_memory_available() > 0);
	assert_true(nt_memory_available() <= pages * page);
}

static void a_limit_of_the_address_space_counts(void **state)
{
	(void)state;
	struct rlimit before, limit;
	assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
	limit = before;
	limit.rlim_cur = 100 * 1024 * 1024;
	assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
	const uint64_t found = nt_memory_available();
	setrlimit(RLIMIT_AS, &before);
	assert_true(found <= 100 * 1024 * 1024);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(it_is_at_most_what_the_machine_has),
		cmocka_unit_test(a_limit_of_the_address_space_counts),
	};
	return cmocka_run_group_tests_name("base/available", tests, NULL, NULL);
}

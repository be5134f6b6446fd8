/* SPDX-License-Identifier: MIT */
#include "test.h"

enum { MOST_TESTS = 100 };

static struct CMUnitTest tests[MOST_TESTS];
static size_t test_count;

void add_test(const char *name, CMUnitTestFunction function)
{
	assert_true(test_count < MOST_TESTS);
	tests[test_count++] = (struct CMUnitTest){.name = name, .test_func = function};
}

int run_group_within(const char *group, CMFixtureFunction setup, CMFixtureFunction teardown)
{
	return _cmocka_run_group_tests(group, tests, test_count, setup, teardown);
}

int run_group_each_within(const char *group, CMFixtureFunction setup, CMFixtureFunction teardown)
{
	for (size_t i = 0; i < test_count; i++) {
		tests[i].setup_func = setup;
		tests[i].teardown_func = teardown;
	}
	return run_group_within(group, NULL, NULL);
}

int run_group(const char *group)
{
	return run_group_within(group, NULL, NULL);
}

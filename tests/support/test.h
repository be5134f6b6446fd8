/* SPDX-License-Identifier: MIT */
/*
 * Included by every test file: cmocka in the order it wants its headers, tests, and what a text says.
 */
#ifndef NT_TEST_H
#define NT_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* TEST(words_are_told_apart) { ... } is a test. main() runs those of its file, in the order of their lines. */
#define TEST(name) \
	static void name(void **state); \
	__attribute__((constructor(1000 + __LINE__))) static void add_##name(void) \
	{ \
		add_test(#name, name); \
	} \
	static void name(__attribute__((unused)) void **state)

void add_test(const char *name, CMUnitTestFunction function);

/* They give what main() returns. The group's name is that of the room and the file, as "obj/read". */
int run_group(const char *group);

/* Setup and teardown run once, around all tests, or around each. */
int run_group_within(const char *group, CMFixtureFunction setup, CMFixtureFunction teardown);
int run_group_each_within(const char *group, CMFixtureFunction setup, CMFixtureFunction teardown);

/* A text has each of these, but not those that begin with "!"; NULL ends them. */
static inline void assert_says(const char *text, const char *const *parts)
{
	for (; *parts; parts++)
		if (!strstr(text, *parts + (**parts == '!')) != (**parts == '!'))
			fail_msg("%s in: %s", *parts, text);
}

#define PARTS(...) ((const char *const[]){__VA_ARGS__, NULL})

#endif

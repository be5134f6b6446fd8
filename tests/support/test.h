/* SPDX-License-Identifier: MIT */
/*
 * Included by every test file: cmocka in the order it wants its headers, tests, and what a text says.
 */
#ifndef NT_TEST_H
#define NT_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* A file tells of its tests before main() begins, in the order of its lines. */
#define AT_START(name) __attribute__((constructor(1000 + __LINE__))) static void name(void)

/*
 * TEST(words_are_told_apart) { ... } is a test. All files are linked into one program, which is there under the name of
 * each (build/release/tests/unit/obj/test_read) and runs the tests of the file that it is called by: see test.c.
 */
#define TEST(name) \
	static void name(void **state); \
	AT_START(add_##name) \
	{ \
		add_test(__FILE__, #name, name); \
	} \
	static void name(__attribute__((unused)) void **state)

/* Setup and teardown run once, around all tests of the file, or around each. */
#define AROUND_ALL(setup, teardown) \
	AT_START(around_all) \
	{ \
		add_fixture(__FILE__, false, setup, teardown); \
	}
#define AROUND_EACH(setup, teardown) \
	AT_START(around_each) \
	{ \
		add_fixture(__FILE__, true, setup, teardown); \
	}

/* Runs in the place of the file's tests where the program has arguments; what it returns is the program's status. */
#define WITH_ARGUMENTS(function) \
	AT_START(with_arguments) \
	{ \
		add_program(__FILE__, function); \
	}

void add_test(const char *file, const char *name, CMUnitTestFunction function);
void add_fixture(const char *file, bool each, CMFixtureFunction setup, CMFixtureFunction teardown);
void add_program(const char *file, int (*function)(int count, char **arguments));

/* As the program was called. */
extern const char *own_name;

/* A text has each of these, but not those that begin with "!"; NULL ends them. */
static inline void assert_says(const char *text, const char *const *parts)
{
	for (; *parts; parts++)
		if (!strstr(text, *parts + (**parts == '!')) != (**parts == '!'))
			fail_msg("%s in: %s", *parts, text);
}

#define PARTS(...) ((const char *const[]){__VA_ARGS__, NULL})

#endif

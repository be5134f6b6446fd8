/* SPDX-License-Identifier: MIT */
/*
 * The program of all tests: each file says what it has (test.h), and the program's own name says which file is meant.
 */
#include "test.h"

enum { MOST_FILES = 300, MOST_TESTS = 100 };

typedef struct test_file {
	const char *name; /* as the compiler has it: tests/unit/obj/test_read.c */
	struct CMUnitTest tests[MOST_TESTS];
	size_t test_count;
	CMFixtureFunction setup, teardown, setup_each, teardown_each;
	int (*program)(int count, char **arguments);
} test_file;

static test_file files[MOST_FILES];
static size_t file_count;
const char *own_name;

static test_file *file_of(const char *name)
{
	for (size_t i = 0; i < file_count; i++)
		if (strcmp(files[i].name, name) == 0)
			return &files[i];
	assert_true(file_count < MOST_FILES);
	files[file_count].name = name;
	return &files[file_count++];
}

void add_test(const char *file, const char *name, CMUnitTestFunction function)
{
	test_file *f = file_of(file);
	assert_true(f->test_count < MOST_TESTS);
	f->tests[f->test_count++] = (struct CMUnitTest){.name = name, .test_func = function};
}

void add_fixture(const char *file, bool each, CMFixtureFunction setup, CMFixtureFunction teardown)
{
	test_file *f = file_of(file);
	*(each ? &f->setup_each : &f->setup) = setup;
	*(each ? &f->teardown_each : &f->teardown) = teardown;
}

void add_program(const char *file, int (*function)(int count, char **arguments))
{
	file_of(file)->program = function;
}

/* .../tests/unit/obj/test_read is called by the file tests/unit/obj/test_read.c. */
static bool is_called_by(const test_file *f)
{
	const size_t size = strlen(f->name) - 2, own = strlen(own_name);
	return own >= size && memcmp(own_name + own - size, f->name, size) == 0;
}

int main(int count, char **arguments)
{
	own_name = arguments[0];
	for (test_file *f = files; f < files + file_count; f++) {
		if (!is_called_by(f))
			continue;
		if (count > 1 && f->program)
			return f->program(count, arguments);
		for (size_t i = 0; i < f->test_count; i++) {
			f->tests[i].setup_func = f->setup_each;
			f->tests[i].teardown_func = f->teardown_each;
		}
		/* the group is the room and the file: unit/obj/read */
		char group[256];
		const char *room = strchr(f->name, '/') + 1, *stem = strstr(room, "test_");
		snprintf(group, sizeof group, "%.*s%.*s", (int)(stem - room), room, (int)strlen(stem) - 7, stem + 5);
		return _cmocka_run_group_tests(group, f->tests, f->test_count, f->setup, f->teardown);
	}
	fprintf(stderr, "%s: no file of tests has this name\n", own_name);
	return 2;
}

/* SPDX-License-Identifier: MIT */
#include "cli/messages.h"
#include "fail_alloc.h"
#include "test.h"

static FILE *kept;
static char *said;
static size_t size;

static void begin(void)
{
	kept = stderr;
	stderr = open_memstream(&said, &size);
	assert_non_null(stderr);
}

static void end(const char *expected)
{
	fclose(stderr);
	stderr = kept;
	assert_string_equal(said, expected);
	free(said);
}

TEST(what_has_no_memory_says_so)
{
	nt_buffer text = {.failed = true};
	begin();
	assert_false(nt_say(&text));
	assert_true(nt_say(&text)); /* it begins anew, and is empty */
	end("nmtan: out of memory\n");
}

/* The line is shorter, and what must not reach a terminal is a question mark. */
TEST(an_error_is_said_without_memory_too)
{
	static const struct {
		const char *file, *message, *said, *said_without;
	} rows[] = {{"a\x1b.obj", "b\x1b", "nmtan: a\\x1b.obj:7: b\\x1b\n", "nmtan: a?.obj: b?\n"},
		{"-", "b", "nmtan: standard input:7: b\n", "nmtan: standard input: b\n"},
		{"", "b", "nmtan: b\n", "nmtan: b\n"},
		{"a", "", "nmtan: a:7: no such file\n", "nmtan: a: no such file\n"}};
	for (size_t i = 0; i < 2 * sizeof rows / sizeof *rows; i++) {
		nt_error error;
		nt_fail_line(&error, NT_ERROR_MISSING, 7, "%s", rows[i / 2].message);
		nt_error_in_file(&error, rows[i / 2].file);
		begin();
		if (i % 2)
			fail_allocations_from(0);
		nt_say_error(&error, (nt_style){0});
		const bool failed = stop_failing_allocations();
		end(i % 2 ? rows[i / 2].said_without : rows[i / 2].said);
		assert_true(failed || i % 2 == 0);
	}
}

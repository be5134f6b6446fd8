/* SPDX-License-Identifier: MIT */
/*
 * Whose process is gone: only one of this machine, this boot and these process numbers can be known to be.
 */
#include "file/maker.h"
#include "test.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

/* "HOST-BOOT-SPACE-PID-START" with other fields where they are not NULL, the last first. */
static const char *altered(const char *text, const char *start, const char *pid, const char *space, const char *boot)
{
	static char result[2 * NT_MAKER_TEXT];
	char copy[NT_MAKER_TEXT], *fields[4];
	const char *others[4] = {start, pid, space, boot};
	strcpy(copy, text);
	for (int i = 0; i < 4; i++) {
		char *dash = strrchr(copy, '-');
		assert_non_null(dash);
		*dash = '\0';
		fields[i] = dash + 1;
	}
	snprintf(result, sizeof result, "%s-%s-%s-%s-%s", copy, others[3] ? others[3] : fields[3],
		others[2] ? others[2] : fields[2], others[1] ? others[1] : fields[1],
		others[0] ? others[0] : fields[0]);
	return result;
}

static bool is_gone(const char *text, bool local)
{
	return nt_maker_is_gone(text, strlen(text), local);
}

static void this_process_is_there(void **state)
{
	(void)state;
	char text[NT_MAKER_TEXT];
	nt_maker_text(text);
	assert_false(is_gone(text, true));
	assert_true(is_gone(altered(text, "1", NULL, NULL, NULL), false)); /* its number was another's before */
}

static void a_child_is_gone_when_it_is(void **state)
{
	(void)state;
	int ends[2];
	char text[NT_MAKER_TEXT] = "";
	assert_int_equal(pipe(ends), 0);
	const pid_t child = fork();
	if (child == 0) {
		nt_maker_text(text);
		if (write(ends[1], text, sizeof text) != sizeof text)
			_exit(1);
		for (;;)
			pause();
	}
	assert_int_equal(read(ends[0], text, sizeof text), sizeof text);
	assert_false(is_gone(text, true));
	kill(child, SIGKILL);
	assert_int_equal(waitpid(child, NULL, 0), child);
	assert_true(is_gone(text, true));
	assert_true(is_gone(text, false));

	/* of others than this machine, boot and space nothing is known */
	char other[NT_MAKER_TEXT + 8];
	snprintf(other, sizeof other, "x%s", text);
	assert_false(is_gone(other, true));
	assert_false(is_gone(altered(text, NULL, NULL, "1", NULL), true));
	const char *boot = "0123456789abcdef0123456789abcdef";
	assert_false(is_gone(altered(text, NULL, NULL, NULL, boot), false));
	/* ... but that this machine was started again, where the folder is its own */
	assert_true(is_gone(altered(text, NULL, NULL, NULL, boot), true));
	close(ends[0]);
	close(ends[1]);
}

static void texts_that_are_no_makers_are_never_gone(void **state)
{
	(void)state;
	char text[NT_MAKER_TEXT];
	nt_maker_text(text);
	static const char *const numbers[] = {"0", "", "x", "-1", "99999999999999999999999", "1 "};
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
		assert_false(is_gone(altered(text, numbers[i], "999999999", NULL, NULL), true));
		assert_false(is_gone(altered(text, NULL, NULL, numbers[i], NULL), true));
		assert_false(is_gone(altered(text, NULL, NULL, NULL, numbers[i]), true));
	}
	static const char *const texts[] = {"", "-", "----", "12345-0-0", "a-b-c-d-e"};
	for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
		assert_false(is_gone(texts[i], true));
	assert_false(nt_maker_is_gone("a\0-b-c-d-e", 10, true));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(this_process_is_there),
		cmocka_unit_test(a_child_is_gone_when_it_is),
		cmocka_unit_test(texts_that_are_no_makers_are_never_gone),
	};
	return cmocka_run_group_tests_name("file/maker", tests, NULL, NULL);
}

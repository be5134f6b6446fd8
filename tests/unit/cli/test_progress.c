/* SPDX-License-Identifier: MIT */
/*
 * Progress in a log, while the clock of the day stands at 1970: a wait until a time of that clock would end at once,
 * and lines would come by the thousand.
 */
#include "folder.h"
#include "test.h"
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
#include "base/deadline.h"
#include "cli/messages.h"
#include "cli/options.h"

/* In place of the C library's; for the tests of this file, the time of day stands. */
static bool stands;

int clock_gettime(clockid_t clock, struct timespec *time)
{
	if (clock != CLOCK_REALTIME || !stands)
		return (int)syscall(SYS_clock_gettime, clock, time);
	*time = (struct timespec){0};
	return 0;
}

static size_t lines_of(const char *path)
{
	FILE *file = fopen(path, "r");
	size_t lines = 0;
	assert_non_null(file);
	for (int c; (c = getc(file)) != EOF;)
		lines += c == '\n';
	fclose(file);
	return lines;
}

TEST(the_clock_of_the_day_is_not_asked)
{
	fflush(stderr);
	const int kept = dup(STDERR_FILENO);
	assert_non_null(freopen(in_folder("log"), "w", stderr));
	const double begin = nt_seconds();
	nt_progress *p = nt_progress_start(NT_PROGRESS_ON, "", 1000);
	for (int i = 0; i < 20; i++) { /* what is printed differs from line to line */
		nt_progress_file(p, 1, false);
		nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
	}
	nt_progress_stop(p);
	const double seconds = nt_seconds() - begin;
	fflush(stderr);
	dup2(kept, STDERR_FILENO);
	close(kept);
	assert_true((double)lines_of(in_folder("log")) <= seconds / 10);
}

static int set_up(void **state)
{
	stands = true;
	return make_folder(state);
}

AROUND_ALL(set_up, remove_folder)

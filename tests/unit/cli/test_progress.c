/* SPDX-License-Identifier: MIT */
/*
 * Progress in a log, while the clock of the day stands at 1970: a wait until a time of that clock would end at once,
 * and lines would come by the thousand.
 */
#include "folder.h"
#include "test.h"
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
#include "base/deadline.h"
#include "cli/messages.h"
#include "cli/options.h"

/* In place of the C library's; for the tests of this file, the time of day stands, and so does the other clock if it is
 * told what it shows. */
static bool stands;
static time_t told;

int clock_gettime(clockid_t clock, struct timespec *time)
{
	const int result = (int)syscall(SYS_clock_gettime, clock, time);
	if (stands && (told || clock == CLOCK_REALTIME))
		*time = (struct timespec){.tv_sec = told};
	return result;
}

static int kept;

static void begin_log(void)
{
	fflush(stderr);
	kept = dup(STDERR_FILENO);
	assert_non_null(freopen(in_folder("log"), "w", stderr));
}

/* Returns the text that stderr got since. */
static const char *end_log(void)
{
	static char text[4096];
	fflush(stderr);
	dup2(kept, STDERR_FILENO);
	close(kept);
	FILE *file = fopen(in_folder("log"), "r");
	assert_non_null(file);
	text[fread(text, 1, sizeof text - 1, file)] = '\0';
	fclose(file);
	return text;
}

TEST(the_clock_of_the_day_is_not_asked)
{
	begin_log();
	const double begin = nt_seconds();
	const clock_t used = clock();
	nt_progress *p = nt_progress_start(NT_PROGRESS_ON, "", 1000);
	for (int i = 0; i < 20; i++) { /* what is printed differs from line to line */
		nt_progress_file(p, 1, false);
		nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
	}
	nt_progress_stop(p);
	const double seconds = nt_seconds() - begin;
	assert_true((double)(clock() - used) / CLOCKS_PER_SEC < seconds / 20); /* the thread sleeps */
	size_t lines = 0;
	for (const char *c = end_log(); *c; c++)
		lines += *c == '\n';
	assert_true((double)lines <= seconds / 10);
}

extern atomic_bool creation_fails; /* test_pool.c */

/* Without a thread the ends of files and stages are the clock: a line every ten seconds, and for each stage of one. */
TEST(a_log_has_what_is_done_and_what_is_left)
{
	begin_log();
	creation_fails = true;
	told = 1000;
	nt_progress *p = nt_progress_start(NT_PROGRESS_ON, "", 8);
	for (int i = 0; i < 6; i++) {
		told += 5;
		nt_progress_file(p, 2500000, i == 2);
	}
	nt_progress_stop(p);
	p = nt_progress_start(NT_PROGRESS_ON, "a\x1b.obj", 1);
	nt_progress_stage(p, NT_STAGE_MAP);
	nt_progress_stage(p, NT_STAGE_PARSE);
	nt_progress_stage(p, NT_STAGE_PARSE);
	nt_progress_file(p, 1, false);
	nt_progress_stop(p);
	assert_null(nt_progress_start(NT_PROGRESS_AUTO, "", 8));
	assert_null(nt_progress_start(NT_PROGRESS_OFF, "", 8));
	creation_fails = false;
	told = 0;
	assert_string_equal(end_log(), "nmtan: 2 of 8 files, 0.2 files/s, 5.0 MB, 30 s left\n"
		"nmtan: 4 of 8 files, 1 failed, 0.2 files/s, 10.0 MB, 20 s left\n"
		"nmtan: 6 of 8 files, 1 failed, 0.2 files/s, 15.0 MB, 10 s left\n"
		"nmtan: a\\x1b.obj: map\nnmtan: a\\x1b.obj: parse\n");
}

static int set_up(void **state)
{
	stands = true;
	return make_folder(state);
}

AROUND_ALL(set_up, remove_folder)

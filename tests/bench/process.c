/* SPDX-License-Identifier: MIT */
/*
 * Time of whole processes, two commands in turns: see process.sh.
 *
 *   process ROUNDS OUTPUTS NAME COMMAND... -- COMMAND...
 *
 * A command with @ in an argument runs OUTPUTS times, one process after the other, with the numbers from 0 in the place
 * of @; another one runs once. Before each turn out/0.glb and so on are removed, so that all outputs are new. Prints
 * the medians in milliseconds a turn, and the first command's part of the second's: of the medians and of the best
 * quartiles.
 */
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/deadline.h"

enum { MOST_WORDS = 31, MOST_ROUNDS = 10000, WARM_UP = 2, SIDES = 2 };

extern char **environ;

typedef struct command {
	char *words[MOST_WORDS + 1]; /* NULL behind the last */
	double ms[MOST_ROUNDS];
} command;

static void fail(const char *what, const char *why)
{
	fprintf(stderr, "process: %s: %s\n", what, why);
	exit(1);
}

static bool is_for_each(const command *c)
{
	for (int i = 0; c->words[i]; i++)
		if (strchr(c->words[i], '@'))
			return true;
	return false;
}

static void run(const command *c, int number)
{
	static posix_spawn_file_actions_t quiet;
	static bool ready;
	char texts[MOST_WORDS][512], *words[MOST_WORDS + 1] = {NULL};
	for (int i = 0; c->words[i]; i++) {
		const char *word = c->words[i], *at = strchr(word, '@');
		if (at)
			snprintf(texts[i], sizeof texts[i], "%.*s%d%s", (int)(at - word), word, number, at + 1);
		words[i] = at ? texts[i] : c->words[i];
	}
	if (!ready && (posix_spawn_file_actions_init(&quiet) ||
			      posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0)))
		fail(words[0], "no memory");
	ready = true;
	pid_t process;
	int status;
	const int error = posix_spawn(&process, words[0], &quiet, NULL, words, environ);
	if (error)
		fail(words[0], strerror(error));
	while (waitpid(process, &status, 0) < 0)
		if (errno != EINTR)
			fail(words[0], strerror(errno));
	if (status != 0)
		fail(words[0], "it did not succeed");
}

static double take_turn(const command *c, int outputs)
{
	char path[64];
	for (int i = 0; i < outputs; i++) {
		snprintf(path, sizeof path, "out/%d.glb", i);
		unlink(path);
	}
	const int times = is_for_each(c) ? outputs : 1;
	const double begin = nt_seconds();
	for (int i = 0; i < times; i++)
		run(c, i);
	return (nt_seconds() - begin) * 1e3;
}

static int compare(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

int main(int argc, char **argv)
{
	static command sides[SIDES];
	const int rounds = argc > 1 ? atoi(argv[1]) : 0, outputs = argc > 2 ? atoi(argv[2]) : 0;
	int side = 0, count = 0;
	for (int i = 4; i < argc && side < SIDES && count < MOST_WORDS; i++) {
		const bool next = strcmp(argv[i], "--") == 0;
		if (!next)
			sides[side].words[count++] = argv[i];
		side += next;
		count = next ? 0 : count;
	}
	if (rounds < 1 || rounds > MOST_ROUNDS || outputs < 1 || side != 1 || !sides[0].words[0] || !sides[1].words[0])
		fail("usage", "process ROUNDS OUTPUTS NAME COMMAND... -- COMMAND...");
	for (int r = -WARM_UP; r < rounds; r++)
		for (side = 0; side < SIDES; side++)
			sides[side].ms[r < 0 ? 0 : r] = take_turn(&sides[side], outputs);
	for (side = 0; side < SIDES; side++)
		qsort(sides[side].ms, (size_t)rounds, sizeof *sides[side].ms, compare);
	const double *a = sides[0].ms, *b = sides[1].ms;
	printf("%-48s %9.2f %9.2f   %.2f %.2f\n", argv[3], a[rounds / 2], b[rounds / 2], a[rounds / 2] / b[rounds / 2],
		a[rounds / 4] / b[rounds / 4]);
	return 0;
}

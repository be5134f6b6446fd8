/* SPDX-License-Identifier: MIT */
/*
 * Progress: see messages.h. On a terminal the line replaces itself, beginning after a second, since a
 * line that flashes by only disturbs. --progress=on without a terminal is for logs: a line for each stage of one file,
 * or one every ten seconds for many. Without threads, stages and ends of files are the clock.
 */
#include "cli/messages.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/deadline.h"
#include "cli/options.h"

/* A quarter of a second: quick enough for the eye, nothing to the processor. */
enum { TICK_NANOSECONDS = 250000000, SECONDS_BEFORE_FIRST = 1, SECONDS_PER_LOG_LINE = 10 };

struct nt_progress {
	pthread_t thread;
	pthread_mutex_t mutex;
	pthread_cond_t wake;
	const char *label;
	size_t files, ended, failed;
	uint64_t bytes; /* read and written by those that have ended */
	nt_stage stage;
	double begin, next; /* by nt_seconds(): the start, and when the clock draws */
	bool terminal, has_thread;
	bool drawn; /* the line stands on the terminal */
	bool stop;
	char last[256]; /* without a terminal: what was printed last */
};

/* All below are called with the mutex held. */

static void erase(nt_progress *p)
{
	if (p->drawn)
		fputs("\r\033[K", stderr);
	p->drawn = false;
}

static void draw(nt_progress *p)
{
	nt_buffer line = {0};
	const double seconds = nt_seconds() - p->begin;
	if (p->files <= 1) {
		nt_buffer_clean(&line, p->label);
		nt_buffer_format(&line, ": %s", nt_stage_name(p->stage));
	} else {
		nt_buffer_format(&line, "%zu of %zu files", p->ended, p->files);
		if (p->failed)
			nt_buffer_format(&line, ", %zu failed", p->failed);
		if (seconds > 0 && p->ended) /* as long for each file as so far */
			nt_buffer_format(&line, ", %.3g files/s, %.1f MB, %.0f s left", (double)p->ended / seconds,
				(double)p->bytes / 1e6, seconds / (double)p->ended * (double)(p->files - p->ended));
	}
	if (line.failed || !line.data) {
		nt_buffer_free(&line);
		return;
	}
	if (p->terminal) {
		erase(p);
		/* One row, however long the name is: a wrapped line could not be erased. */
		fprintf(stderr, "%.*s, %u s", NT_CUT(70, line.data), (unsigned)seconds);
		p->drawn = true;
	} else if (strcmp(p->last, line.data) != 0) {
		fprintf(stderr, "nmtan: %s\n", line.data);
		snprintf(p->last, sizeof p->last, "%s", line.data);
	}
	nt_buffer_free(&line);
}

static void draw_in_time(nt_progress *p)
{
	if (nt_seconds() < p->next || (!p->terminal && p->files <= 1))
		return;
	draw(p);
	p->next += p->terminal ? 0 : SECONDS_PER_LOG_LINE;
}

static void *watch(void *user)
{
	nt_progress *p = user;
	pthread_mutex_lock(&p->mutex);
	while (!p->stop) {
		/* by the clock that nobody sets: pthread_cond_init() has been told so */
		struct timespec until;
		clock_gettime(CLOCK_MONOTONIC, &until);
		until.tv_nsec += TICK_NANOSECONDS;
		until.tv_sec += until.tv_nsec / 1000000000;
		until.tv_nsec %= 1000000000;
		pthread_cond_timedwait(&p->wake, &p->mutex, &until);
		if (!p->stop)
			draw_in_time(p);
	}
	pthread_mutex_unlock(&p->mutex);
	return NULL;
}

nt_progress *nt_progress_start(int mode, const char *label, size_t files)
{
	const bool terminal = isatty(STDERR_FILENO);
	if (mode == NT_PROGRESS_OFF || (mode == NT_PROGRESS_AUTO && !terminal))
		return NULL;
	nt_progress *p = calloc(1, sizeof *p);
	if (!p)
		return NULL;
	p->label = label;
	p->files = files;
	p->terminal = terminal;
	p->begin = nt_seconds();
	p->next = p->begin + (terminal ? SECONDS_BEFORE_FIRST : SECONDS_PER_LOG_LINE);
	pthread_mutex_init(&p->mutex, NULL);
	pthread_condattr_t monotonic;
	pthread_condattr_init(&monotonic);
	pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
	pthread_cond_init(&p->wake, &monotonic);
	pthread_condattr_destroy(&monotonic);
	p->has_thread = pthread_create(&p->thread, NULL, watch, p) == 0;
	return p;
}

void nt_progress_stage(void *progress, nt_stage stage)
{
	nt_progress *p = progress;
	if (!p)
		return;
	pthread_mutex_lock(&p->mutex);
	p->stage = stage;
	if (!p->terminal)
		draw(p);
	else if (!p->has_thread)
		draw_in_time(p);
	pthread_mutex_unlock(&p->mutex);
}

void nt_progress_file(nt_progress *p, uint64_t bytes, bool failed)
{
	if (!p)
		return;
	pthread_mutex_lock(&p->mutex);
	p->ended++;
	p->bytes += bytes;
	p->failed += failed;
	if (!p->has_thread)
		draw_in_time(p);
	pthread_mutex_unlock(&p->mutex);
}

void nt_progress_hide(nt_progress *p)
{
	if (!p)
		return;
	pthread_mutex_lock(&p->mutex);
	erase(p);
}

void nt_progress_show(nt_progress *p)
{
	if (p)
		pthread_mutex_unlock(&p->mutex);
}

void nt_progress_stop(nt_progress *p)
{
	if (!p)
		return;
	pthread_mutex_lock(&p->mutex);
	p->stop = true;
	pthread_cond_signal(&p->wake);
	erase(p);
	pthread_mutex_unlock(&p->mutex);
	if (p->has_thread)
		pthread_join(p->thread, NULL);
	pthread_cond_destroy(&p->wake);
	pthread_mutex_destroy(&p->mutex);
	free(p);
}

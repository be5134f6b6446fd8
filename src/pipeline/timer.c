/* SPDX-License-Identifier: MIT */
/*
 * The time of a run. A thread sleeps until the time is over. A thread that waits for the lock for ever is in a process
 * that is ending.
 */
#include "pipeline/run.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <string.h>
#include "base/deadline.h"
#include "file/output.h"

/* Time for a run to end by itself: most of the tenth of a second within which it is to be over. */
static const double grace_seconds = 0.06;

/* With the lock: sleeps until `end`, or until the timer changes. */
static void sleep_until(nt_timer *t, double end)
{
	struct timespec time = {.tv_sec = (time_t)end, .tv_nsec = (long)((end - floor(end)) * 1e9)};
	pthread_cond_timedwait(&t->changed, &t->lock, &time);
}

static void *watch(void *context)
{
	nt_timer *t = context;
	pthread_mutex_lock(&t->lock);
	for (double now; !t->over;) {
		now = nt_seconds();
		if (t->held)
			pthread_cond_wait(&t->changed, &t->lock);
		else if (now < t->end)
			sleep_until(t, t->end);
		else if (!atomic_exchange(&t->deadline.passed, true))
			continue;
		else if (!t->too_late)
			break;
		else if (now < t->end + grace_seconds)
			sleep_until(t, t->end + grace_seconds);
		else {
			nt_temporaries_remove_all();
			t->too_late(t->user);
		}
	}
	pthread_mutex_unlock(&t->lock);
	return NULL;
}

/* Signals are for the user's threads. */
static bool begin_thread(nt_timer *t)
{
	sigset_t all, before;
	sigfillset(&all);
	pthread_sigmask(SIG_SETMASK, &all, &before);
	const bool begun = pthread_create(&t->thread, NULL, watch, t) == 0;
	pthread_sigmask(SIG_SETMASK, &before, NULL);
	return begun;
}

bool nt_timer_begin(nt_timer *t, double seconds, void (*too_late)(void *user), void *user)
{
	memset(t, 0, sizeof *t);
	if (!(seconds > 0))
		return true;
	*t = (nt_timer){.end = nt_seconds() + seconds, .too_late = too_late, .user = user,
		.lock = PTHREAD_MUTEX_INITIALIZER};
	pthread_condattr_t attributes;
	pthread_condattr_init(&attributes);
	pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
	pthread_cond_init(&t->changed, &attributes);
	pthread_condattr_destroy(&attributes);
	if (!begin_thread(t)) {
		pthread_cond_destroy(&t->changed);
		t->end = 0;
		return false;
	}
	t->outer = nt_deadline_use(&t->deadline);
	return true;
}

bool nt_timer_hold(nt_timer *t)
{
	if (t->end == 0)
		return true;
	pthread_mutex_lock(&t->lock);
	t->held = !atomic_load(&t->deadline.passed);
	pthread_mutex_unlock(&t->lock);
	return t->held;
}

static void change(nt_timer *t, bool over)
{
	if (t->end == 0)
		return;
	pthread_mutex_lock(&t->lock);
	t->held = false;
	t->over = over;
	pthread_cond_signal(&t->changed);
	pthread_mutex_unlock(&t->lock);
}

void nt_timer_release(nt_timer *t)
{
	change(t, false);
}

bool nt_timer_end(nt_timer *t)
{
	if (t->end != 0) {
		change(t, true);
		pthread_join(t->thread, NULL);
		pthread_cond_destroy(&t->changed);
		pthread_mutex_destroy(&t->lock);
		nt_deadline_use(t->outer);
		t->end = 0;
	}
	return atomic_load(&t->deadline.passed);
}

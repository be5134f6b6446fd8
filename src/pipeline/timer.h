/* SPDX-License-Identifier: MIT */
/*
 * The time that a run may take. When it is over, memory is refused to the run's threads (base/deadline.h), so that the
 * run fails at its next step; where a front end is the whole process, the process ends soon after, whatever a library
 * or a long loop is about, with no temporary file left.
 */
#ifndef NT_PIPELINE_TIMER_H
#define NT_PIPELINE_TIMER_H

#include <pthread.h>
#include "base/deadline.h"

typedef struct nt_timer {
	nt_deadline deadline;
	double end; /* as nt_seconds() has it; 0: the run may take any time */
	void (*too_late)(void *user);
	void *user;
	const nt_deadline *outer;
	pthread_t thread;
	pthread_mutex_t lock; /* of what follows */
	pthread_cond_t changed;
	bool held, over;
} nt_timer;

/*
 * Begins the time of the calling thread; 0 seconds: no bound. The timer must not move.
 *
 *   too_late  ends the process, from a thread of its own, if the run has not ended by itself shortly after its time;
 *             NULL: only the run's own steps end it
 *
 * Without a thread to be had there is no bound, and the result is false.
 */
bool nt_timer_begin(nt_timer *timer, double seconds, void (*too_late)(void *user), void *user);

/* Stops the time while an output takes its place, which happens whole. False: the time is over, nothing is to be
 * placed. */
bool nt_timer_hold(nt_timer *timer);
void nt_timer_release(nt_timer *timer);

/* Ends it; memory can be had again. Returns whether the time was over. More than once is allowed. */
bool nt_timer_end(nt_timer *timer);

#endif

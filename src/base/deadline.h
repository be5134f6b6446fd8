/* SPDX-License-Identifier: MIT */
/*
 * Time: how long something took, and when work is to end.
 */
#ifndef NT_BASE_DEADLINE_H
#define NT_BASE_DEADLINE_H

#include <stdbool.h>
#include <stddef.h>
#include <time.h>

/* Wall-clock seconds from an arbitrary start. */
static inline double nt_seconds(void)
{
#ifdef _WIN32
	return (double)clock() / CLOCKS_PER_SEC; /* of the wall, there */
#else
	struct timespec time;
	clock_gettime(CLOCK_MONOTONIC, &time);
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
#endif
}

/*
 * A deadline: when the work of a thread, and of the pool's threads that help it, is to end. From then on memory is
 * refused, by which every step knows how to fail; long loops that ask for none ask here. The caller that set a deadline
 * says that it was the reason.
 */

/* The library alone has none. */
#ifdef NT_NO_DEADLINES
typedef struct nt_deadline nt_deadline;

static inline const nt_deadline *nt_deadline_use(const nt_deadline *deadline)
{
	return deadline;
}

static inline const nt_deadline *nt_deadline_own(void)
{
	return NULL;
}

static inline bool nt_deadline_passed(void)
{
	return false;
}
#else
#include <stdatomic.h>
#include "base/compiler.h"

typedef struct nt_deadline {
	atomic_bool passed; /* stays so */
} nt_deadline;

/* NULL: none. */
extern NT_STATIC_TLS _Thread_local const nt_deadline *nt_own_deadline;

/* The deadline of this thread from now on. Returns the one that it had. */
static inline const nt_deadline *nt_deadline_use(const nt_deadline *deadline)
{
	const nt_deadline *before = nt_own_deadline;
	nt_own_deadline = deadline;
	return before;
}

static inline const nt_deadline *nt_deadline_own(void)
{
	return nt_own_deadline;
}

static inline bool nt_deadline_passed(void)
{
	const nt_deadline *own = nt_own_deadline;
	return own && atomic_load_explicit(&own->passed, memory_order_relaxed);
}
#endif

#endif

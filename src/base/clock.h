/* SPDX-License-Identifier: MIT */
/*
 * Wall-clock seconds from an arbitrary start, for telling how long something took.
 */
#ifndef NT_BASE_CLOCK_H
#define NT_BASE_CLOCK_H

#include <time.h>

static inline double nt_seconds(void)
{
	struct timespec time;
#ifdef _WIN32
	timespec_get(&time, TIME_UTC);
#else
	clock_gettime(CLOCK_MONOTONIC, &time);
#endif
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Wall-clock seconds from an arbitrary start, for telling how long something took.
 */
#ifndef NT_BASE_CLOCK_H
#define NT_BASE_CLOCK_H

#include <time.h>

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

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Parallel ranges and items on the threads of base/pool. A thread owns a contiguous range of outputs, so the
 * bytes do not depend on how many threads there are.
 */
#ifndef NT_BASE_PARALLEL_H
#define NT_BASE_PARALLEL_H

#include <stddef.h>

/* Threads that a request means: 0 is one per processor this process may use; never below 1. */
unsigned nt_thread_count(unsigned requested);

/* Splits [0, count) into at most `threads` contiguous ranges of at least `grain` items each and calls
 * body once for each, at the same time where threads can be had. `slot` numbers the ranges from 0 in order. */
void nt_parallel_ranges(unsigned threads, size_t count, size_t grain,
	void (*body)(void *context, size_t begin, size_t end, unsigned slot), void *context);

/* How many ranges nt_parallel_ranges will make. */
unsigned nt_parallel_slots(unsigned threads, size_t count, size_t grain);

/* Calls body once for each of [0, count), at most `threads` at a time: items of unlike size, handed out one by
 * one. Calls with the same `slot`, which is below `threads` and below `count`, run one after the other. */
void nt_parallel_items(unsigned threads, size_t count,
	void (*body)(void *context, size_t item, unsigned slot), void *context);

#endif

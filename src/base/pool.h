/* SPDX-License-Identifier: MIT */
/*
 * Threads that wait for work, one pool for the process. Not for general use: base/parallel hands out ranges
 * and items on it.
 *
 * The pool is made by the first region that needs it and grows to the largest region's need, up to
 * NT_POOL_MOST. Its threads belong to nobody: any number of user threads may run regions at once, and a body
 * may run a region of its own. Idle threads sleep, and never keep the process from ending. The caller runs every slot
 * that no thread has taken. A region therefore completes even if no thread can be created: under a limit, in a build
 * with NT_NO_THREADS, or with none left after fork(). A child of fork() makes threads of its own.
 */
#ifndef NT_BASE_POOL_H
#define NT_BASE_POOL_H

#include "nmtan.h"

/* Threads of the pool beside those of its users. */
enum { NT_POOL_MOST = 255 };

/* Processors that this process may use, at least 1; 1 without threads. A system call. */
unsigned nt_pool_processors(void);

/* From now on the regions of this thread, and those within them, go to the caller's threads; NULL: to the pool's.
 * Returns what it was before. */
const nmtan_jobs *nt_pool_use(const nmtan_jobs *jobs);

/* Makes at least so many threads: for a region that starts while others of the pool are known to wait. */
void nt_pool_reserve(unsigned threads);

/* One caller more (1), or less (-1), whose next region comes soon: threads of the pool need not sleep at once. Waking
 * one takes as long as adding up 3 000 triangles. */
void nt_pool_stay(int callers);

/* Calls body once for each slot below `slots` and returns when all have returned. Several at a time where
 * threads are free, begun in their order: a slot may wait for one below it, and for no other. */
void nt_pool_run(unsigned slots, void (*body)(void *context, unsigned slot), void *context);

#endif

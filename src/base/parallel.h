/* SPDX-License-Identifier: MIT */
/*
 * Threads: ranges and items of a loop, the pool that runs them, locks.
 */
#ifndef NT_BASE_PARALLEL_H
#define NT_BASE_PARALLEL_H

#include <stddef.h>
#include "nmtan.h"

/* ---- ranges and items ---- */

/* A thread owns a contiguous range of outputs, so the bytes do not depend on how many threads there are. */

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

/* ---- the pool ---- */

/*
 * Threads that wait for work, one pool for the process. Not for general use: ranges and items are handed out on it.
 *
 * The pool is made by the first region that needs it and grows to the largest region's need, up to
 * NT_POOL_MOST. Its threads belong to nobody: any number of user threads may run regions at once, and a body
 * may run a region of its own. Idle threads sleep, and never keep the process from ending. The caller runs every slot
 * that no thread has taken. A region therefore completes even if no thread can be created: under a limit, in a build
 * with NT_NO_THREADS, or with none left after fork(). A child of fork() makes threads of its own.
 */

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

/* ---- locks, which without threads (NT_NO_THREADS) do nothing and need no pthread.h ---- */

#ifdef NT_NO_THREADS

typedef char nt_lock;
#define NT_LOCK_INIT 0

static inline void nt_lock_take(nt_lock *lock) { (void)lock; }
static inline void nt_lock_give(nt_lock *lock) { (void)lock; }
static inline void nt_lock_free(nt_lock *lock) { (void)lock; }
static inline void nt_give_way(void) {}

#else

#include <pthread.h>
#include <sched.h>

typedef pthread_mutex_t nt_lock;
#define NT_LOCK_INIT PTHREAD_MUTEX_INITIALIZER

static inline void nt_lock_take(nt_lock *lock) { pthread_mutex_lock(lock); }
static inline void nt_lock_give(nt_lock *lock) { pthread_mutex_unlock(lock); }
static inline void nt_lock_free(nt_lock *lock) { pthread_mutex_destroy(lock); }

/* Lets another thread run, which the caller waits for. */
static inline void nt_give_way(void) { sched_yield(); }

#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A lock for the threads of base/pool. Without threads (NT_NO_THREADS) it does nothing and needs no pthread.h.
 */
#ifndef NT_BASE_LOCK_H
#define NT_BASE_LOCK_H

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

/* SPDX-License-Identifier: MIT */
/*
 * Threads that wait for work: see pool.h.
 *
 * A region lives on its caller's stack and is linked into the pool's list while slots of it may be free. Caller
 * and helpers take slots from one counter. The lock covers the list and the counts, never a body.
 */
#include "base/pool.h"

#ifdef NT_NO_THREADS

unsigned nt_pool_processors(void)
{
	return 1;
}

void nt_pool_reserve(unsigned threads)
{
	(void)threads;
}

void nt_pool_run(unsigned slots, void (*body)(void *context, unsigned slot), void *context)
{
	for (unsigned slot = 0; slot < slots; slot++)
		body(context, slot);
}

#else

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <unistd.h>

/* After a thread could not be made, the regions that do without before one is tried again. */
enum { REGIONS_WITHOUT = 100 };

typedef struct region {
	void (*body)(void *context, unsigned slot);
	void *context;
	unsigned slots;
	atomic_uint next; /* the first slot that nobody has taken; beyond `slots` when all are */
	unsigned helpers; /* threads of the pool that are in it */
	struct region *older;
} region;

static struct {
	pthread_mutex_t lock;  /* of all that follows, and of the helpers of regions */
	pthread_cond_t posted; /* a region was linked */
	pthread_cond_t left;   /* the last helper left a region */
	region *newest;
	unsigned threads;      /* made, or about to be */
	unsigned without;      /* regions to go before a thread is tried again */
	bool watches_forks;
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .posted = PTHREAD_COND_INITIALIZER,
	.left = PTHREAD_COND_INITIALIZER};

unsigned nt_pool_processors(void)
{
#ifdef __linux__
	cpu_set_t set;
	if (sched_getaffinity(0, sizeof set, &set) == 0)
		return (unsigned)CPU_COUNT(&set);
#endif
	const long online = sysconf(_SC_NPROCESSORS_ONLN);
	return online > 0 ? (unsigned)online : 1;
}

static void work(region *r)
{
	for (unsigned slot; (slot = atomic_fetch_add_explicit(&r->next, 1, memory_order_relaxed)) < r->slots;)
		r->body(r->context, slot);
}

/* ---- the threads ---- */

/* With the lock: the newest region with a slot to take. It stays until its helpers have left. */
static region *enter_region(void)
{
	region *r = pool.newest;
	while (r && atomic_load_explicit(&r->next, memory_order_relaxed) >= r->slots)
		r = r->older;
	if (r)
		r->helpers++;
	return r;
}

/* A new thread begins on another processor than its maker's, where there is one: a system that packs threads, as
 * virtual machines do, would have it wait there until the maker's time is up, 1.2 to 3 ms instead of 0.13. Returns the
 * processor that the thread takes back when it runs; -1: none. */
static int leave_processor(pthread_attr_t *attributes)
{
#ifdef __GLIBC__
	cpu_set_t set;
	const int here = sched_getcpu();
	if (here >= 0 && sched_getaffinity(0, sizeof set, &set) == 0 && CPU_ISSET(here, &set) && CPU_COUNT(&set) > 1) {
		CPU_CLR(here, &set);
		return pthread_attr_setaffinity_np(attributes, sizeof set, &set) == 0 ? here : -1;
	}
#else
	(void)attributes;
#endif
	return -1;
}

static void *run_thread(void *processor)
{
#ifdef __GLIBC__
	cpu_set_t set;
	if ((intptr_t)processor >= 0 && sched_getaffinity(0, sizeof set, &set) == 0) {
		CPU_SET((int)(intptr_t)processor, &set);
		sched_setaffinity(0, sizeof set, &set); /* a refusal leaves it the others */
	}
#else
	(void)processor;
#endif
	pthread_mutex_lock(&pool.lock);
	for (;;) {
		region *r = enter_region();
		if (!r) {
			pthread_cond_wait(&pool.posted, &pool.lock);
			continue;
		}
		pthread_mutex_unlock(&pool.lock);
		work(r);
		pthread_mutex_lock(&pool.lock);
		if (--r->helpers == 0)
			pthread_cond_broadcast(&pool.left);
	}
	return NULL;
}

static bool create_thread(const pthread_attr_t *attributes, int processor)
{
	pthread_t thread;
	return pthread_create(&thread, attributes, run_thread, (void *)(intptr_t)processor) == 0 &&
	       pthread_detach(thread) == 0;
}

/* Signals are for the user's threads, but for those that an instruction raises. */
static bool make_thread(void)
{
	sigset_t all, before;
	bool made = false;
	sigfillset(&all);
	sigdelset(&all, SIGBUS);
	sigdelset(&all, SIGFPE);
	sigdelset(&all, SIGILL);
	sigdelset(&all, SIGSEGV);
	sigdelset(&all, SIGTRAP);
	pthread_sigmask(SIG_SETMASK, &all, &before);
	pthread_attr_t elsewhere;
	if (pthread_attr_init(&elsewhere) == 0) {
		const int here = leave_processor(&elsewhere);
		made = here >= 0 && create_thread(&elsewhere, here);
		pthread_attr_destroy(&elsewhere);
	}
	made = made || create_thread(NULL, -1); /* a filter of system calls may refuse the choice of processors */
	pthread_sigmask(SIG_SETMASK, &before, NULL);
	return made;
}

/* In the child none of the pool's threads exists, and nobody holds the lock. */
static void start_anew(void)
{
	pool.lock = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
	pool.posted = pool.left = (pthread_cond_t)PTHREAD_COND_INITIALIZER;
	pool.newest = NULL;
	pool.threads = pool.without = 0;
}

/* With the lock: how many threads the pool lacks for a region, which the caller must then make. */
static unsigned reserve_threads(unsigned slots)
{
	const unsigned wanted = slots - 1 < NT_POOL_MOST ? slots - 1 : NT_POOL_MOST;
	if (wanted <= pool.threads)
		return 0;
	if (pool.without > 0) {
		pool.without--;
		return 0;
	}
	if (!pool.watches_forks && pthread_atfork(NULL, NULL, start_anew) != 0)
		return 0;
	pool.watches_forks = true;
	const unsigned lacking = wanted - pool.threads;
	pool.threads = wanted;
	return lacking;
}

static void make_threads(unsigned count)
{
	while (count > 0 && make_thread())
		count--;
	if (count == 0)
		return;
	pthread_mutex_lock(&pool.lock);
	pool.threads -= count;
	pool.without = REGIONS_WITHOUT;
	pthread_mutex_unlock(&pool.lock);
}

/* ---- the callers ---- */

static void post(region *r)
{
	pthread_mutex_lock(&pool.lock);
	const unsigned lacking = reserve_threads(r->slots);
	r->older = pool.newest;
	pool.newest = r;
	pthread_cond_broadcast(&pool.posted);
	pthread_mutex_unlock(&pool.lock);
	make_threads(lacking);
}

static void close_region(const region *r)
{
	pthread_mutex_lock(&pool.lock);
	region **link = &pool.newest;
	while (*link != r)
		link = &(*link)->older;
	*link = r->older;
	while (r->helpers)
		pthread_cond_wait(&pool.left, &pool.lock);
	pthread_mutex_unlock(&pool.lock);
}

void nt_pool_reserve(unsigned threads)
{
	pthread_mutex_lock(&pool.lock);
	const unsigned lacking = reserve_threads(threads + 1);
	pthread_mutex_unlock(&pool.lock);
	make_threads(lacking);
}

void nt_pool_run(unsigned slots, void (*body)(void *context, unsigned slot), void *context)
{
	region r = {.body = body, .context = context, .slots = slots};
	if (slots <= 1) {
		work(&r);
		return;
	}
	post(&r);
	work(&r);
	close_region(&r);
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Threads that wait for work: see parallel.h.
 *
 * A region lives on its caller's stack and is linked into the pool's list while slots of it may be free. Caller
 * and helpers take slots from one counter. The lock covers the list and the counts, never a body; a region is
 * entered by two short critical sections and, if a thread sleeps, one wake-up.
 */
#include "base/parallel.h"

#include <stdbool.h>
#include "base/compiler.h"
#include "base/deadline.h"

/* ---- threads of the caller ---- */

typedef void region_body(void *context, unsigned slot);

#if NT_ONE_THREAD

const nmtan_jobs *nt_pool_use(const nmtan_jobs *jobs)
{
	return jobs;
}

#else

static NT_STATIC_TLS __thread const nmtan_jobs *own_jobs;

const nmtan_jobs *nt_pool_use(const nmtan_jobs *jobs)
{
	const nmtan_jobs *before = own_jobs;
	own_jobs = jobs;
	return before;
}

typedef struct given_region {
	const nmtan_jobs *jobs;
	region_body *body;
	void *context;
	unsigned next; /* atomic: slots begin in their order, whatever the order of jobs */
} given_region;

static void run_job(void *context, unsigned i)
{
	(void)i;
	given_region *r = context;
	const nmtan_jobs *before = nt_pool_use(r->jobs);
	r->body(r->context, nt_atomic_add(&r->next, 1, RELAXED));
	nt_pool_use(before);
}

#endif

static unsigned staying; /* atomic: callers that will soon post another region */

void nt_pool_stay(int callers)
{
	(void)nt_atomic_add(&staying, (unsigned)callers, RELAXED);
}

/* Whether the caller's threads have done it. */
static bool run_given(unsigned slots, region_body *body, void *context)
{
#if !NT_ONE_THREAD
	if (own_jobs && slots > 1) {
		given_region r = {own_jobs, body, context, 0};
		own_jobs->run(own_jobs->user, slots, run_job, &r);
		return true;
	}
#endif
	(void)slots, (void)body, (void)context;
	return false;
}

#ifdef NT_NO_THREADS

void nmtan_end_threads(void)
{
}

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
	const bool given = run_given(slots, body, context);
	for (unsigned slot = 0; !given && slot < slots; slot++)
		body(context, slot);
}

#else

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>

/* How often a caller gives way to its helpers before it sleeps, and a thread of the pool to callers that stay: for
 * somewhat longer than waking it takes, 50 microseconds in a virtual machine. After a thread could not be made, the
 * regions that do without before one is tried again. */
enum { MOST_LOOKS = 200, REGIONS_WITHOUT = 100 };

typedef struct region {
	void (*body)(void *context, unsigned slot);
	void *context;
	unsigned slots;
	unsigned next;    /* atomic: the first slot that nobody has taken; beyond `slots` when all are. Slot 0 is the
	                     caller's, which finds in its cache what it left there in the region before */
	unsigned helpers; /* atomic: threads of the pool that are in it */
	struct region *older;
	const nt_deadline *deadline; /* the caller's */
} region;

static struct {
	pthread_mutex_t lock;
	pthread_cond_t posted; /* a region was linked */
	pthread_cond_t left;   /* the last helper left a region */
	region *newest;
	unsigned threads;      /* made, or about to be */
	unsigned without;      /* regions to go before a thread is tried again */
	bool watches_forks;
	unsigned waiting;      /* atomic: callers that sleep until helpers leave */
	unsigned posts;        /* atomic: regions that were linked */
	unsigned made;         /* threads that are */
	pthread_t ids[NT_POOL_MOST];
	bool ending;           /* they shall end */
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
	for (unsigned slot; (slot = nt_atomic_add(&r->next, 1, RELAXED)) < r->slots;)
		r->body(r->context, slot);
}

/* ---- the threads ---- */

/* With the lock: the newest region with a slot to take. It stays until its helpers have left. */
static region *enter_region(void)
{
	region *r = pool.newest;
	while (r && nt_atomic_load(&r->next, RELAXED) >= r->slots)
		r = r->older;
	if (r)
		nt_atomic_add(&r->helpers, 1, RELAXED);
	return r;
}

/* The region may be gone as soon as it is left, so who waits for that is known to the pool. Either the caller
 * sees this helper gone or the helper sees the caller wait: both orders are sequentially consistent. */
static void leave_region(region *r)
{
	if (nt_atomic_sub(&r->helpers, 1, SEQ_CST) != 1 || nt_atomic_load(&pool.waiting, SEQ_CST) == 0)
		return;
	pthread_mutex_lock(&pool.lock);
	pthread_cond_broadcast(&pool.left);
	pthread_mutex_unlock(&pool.lock);
}

/* A new thread goes to another processor than its maker's, where there is one: a system that packs threads, as virtual
 * machines do, lets it wait there until the maker's time is up, 1.2 to 3 ms instead of 0.13. It is there once the first
 * call returns; the second lets it go wherever its maker may. */
static void send_elsewhere(pthread_t thread)
{
#ifdef __linux__
	cpu_set_t set;
	const int here = sched_getcpu();
	if (here < 0 || sched_getaffinity(0, sizeof set, &set) != 0)
		return;
	CPU_CLR(here, &set);
	if (CPU_COUNT(&set) > 0 && pthread_setaffinity_np(thread, sizeof set, &set) == 0) {
		CPU_SET(here, &set);
		pthread_setaffinity_np(thread, sizeof set, &set);
	}
#else
	(void)thread;
#endif
}

/* With the lock, which is given back meanwhile: whether a region was linked, or all shall end. */
static bool await_region(void)
{
	const unsigned posts = pool.posts;
	pthread_mutex_unlock(&pool.lock);
	for (unsigned i = 0; i < MOST_LOOKS && nt_atomic_load(&staying, RELAXED) > 0 &&
		nt_atomic_load(&pool.posts, RELAXED) == posts; i++)
		nt_give_way();
	pthread_mutex_lock(&pool.lock);
	return pool.posts != posts || pool.ending;
}

static void *run_thread(void *unused)
{
	(void)unused;
	pthread_mutex_lock(&pool.lock);
	while (!pool.ending) {
		region *r = enter_region();
		if (!r && nt_atomic_load(&staying, RELAXED) > 0 && await_region())
			continue;
		if (!r) {
			pthread_cond_wait(&pool.posted, &pool.lock);
			continue;
		}
		pthread_mutex_unlock(&pool.lock);
		nt_deadline_use(r->deadline);
		work(r);
		nt_deadline_use(NULL);
		leave_region(r);
		pthread_mutex_lock(&pool.lock);
	}
	pthread_mutex_unlock(&pool.lock);
	return NULL;
}

/* Signals are for the user's threads, but for those that an instruction raises. */
static bool make_thread(void)
{
	sigset_t all, before;
	sigfillset(&all);
	sigdelset(&all, SIGBUS);
	sigdelset(&all, SIGFPE);
	sigdelset(&all, SIGILL);
	sigdelset(&all, SIGSEGV);
	sigdelset(&all, SIGTRAP);
	pthread_sigmask(SIG_SETMASK, &all, &before);
	pthread_t thread;
	const bool made = pthread_create(&thread, NULL, run_thread, NULL) == 0;
	pthread_sigmask(SIG_SETMASK, &before, NULL);
	if (!made)
		return false;
	send_elsewhere(thread);
	pthread_mutex_lock(&pool.lock);
	pool.ids[pool.made++] = thread;
	pthread_mutex_unlock(&pool.lock);
	return true;
}

/* In the child none of the pool's threads exists, and nobody holds the lock. */
static void start_anew(void)
{
	pool.lock = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
	pool.posted = pool.left = (pthread_cond_t)PTHREAD_COND_INITIALIZER;
	pool.newest = NULL;
	pool.threads = pool.without = pool.made = 0;
	nt_atomic_store(&pool.waiting, 0, SEQ_CST);
	nt_atomic_store(&staying, 0, RELAXED);
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
	nt_atomic_add(&pool.posts, 1, RELAXED);
	for (unsigned i = 1; i < r->slots; i++)
		pthread_cond_signal(&pool.posted); /* costs next to nothing where nobody sleeps */
	pthread_mutex_unlock(&pool.lock);
	make_threads(lacking);
}

static void close_region(region *r)
{
	pthread_mutex_lock(&pool.lock);
	region **link = &pool.newest;
	while (*link != r)
		link = &(*link)->older;
	*link = r->older;
	pthread_mutex_unlock(&pool.lock);
	for (unsigned i = 0; i < MOST_LOOKS && nt_atomic_load(&r->helpers, SEQ_CST) != 0; i++)
		nt_give_way();
	if (nt_atomic_load(&r->helpers, SEQ_CST) == 0)
		return;
	pthread_mutex_lock(&pool.lock);
	nt_atomic_add(&pool.waiting, 1, SEQ_CST);
	while (nt_atomic_load(&r->helpers, SEQ_CST) != 0)
		pthread_cond_wait(&pool.left, &pool.lock);
	nt_atomic_sub(&pool.waiting, 1, SEQ_CST);
	pthread_mutex_unlock(&pool.lock);
}

void nmtan_end_threads(void)
{
	pthread_mutex_lock(&pool.lock);
	pool.ending = true;
	pthread_cond_broadcast(&pool.posted);
	pthread_mutex_unlock(&pool.lock);
	for (unsigned i = 0; i < pool.made; i++)
		pthread_join(pool.ids[i], NULL);
	pool.made = pool.threads = 0;
	pool.ending = false;
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
	if (run_given(slots, body, context))
		return;
	region r = {.body = body, .context = context, .slots = slots, .next = 1, .deadline = nt_deadline_own()};
	if (slots == 1)
		body(context, 0);
	if (slots <= 1)
		return;
	/* a thread that ends while it waits for helpers would keep the lock, and leave them a region that is gone */
	int cancel;
	pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &cancel);
	post(&r);
	body(context, 0);
	work(&r);
	close_region(&r);
	pthread_setcancelstate(cancel, NULL);
}

#endif

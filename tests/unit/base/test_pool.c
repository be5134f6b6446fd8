/* SPDX-License-Identifier: MIT */
/*
 * The pool of threads: regions from several threads, inside one another, after fork(), and where threads cannot
 * be made. The linker hands us pthread_create, which counts and can be told to fail.
 */
#include "test.h"
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "base/parallel.h"
#include "nmtan.h"

static atomic_uint threads_made;
extern atomic_bool creation_fails; /* for other tests of the program, too */
atomic_bool creation_fails;

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument)
{
	if (creation_fails)
		return EAGAIN;
	threads_made++;
	return __real_pthread_create(thread, attributes, run, argument);
}

/* Runs f in a child, which must end well within a minute. The thread sanitizer allows no threads there, and the address
 * sanitizer does not hold its allocator's locks over fork(): the child's threads may wait for one forever. */
static void in_a_child(void (*f)(void))
{
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
	(void)f;
	return;
#endif
	const pid_t child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		alarm(60);
		f();
		_exit(0);
	}
	int status;
	assert_int_equal(waitpid(child, &status, 0), child);
	assert_true(WIFEXITED(status));
	assert_int_equal(WEXITSTATUS(status), 0);
}

/* In a child that has no cmocka around it. */
static void expect(bool holds)
{
	if (!holds)
		_exit(1);
}

/* ---- bodies ---- */

static void count_call(void *context, unsigned slot)
{
	atomic_uint *calls = context;
	calls[slot]++;
}

static bool each_slot_once(unsigned slots)
{
	atomic_uint calls[40] = {0};
	nt_pool_run(slots, count_call, calls);
	for (unsigned i = 0; i < 40; i++)
		if (calls[i] != (i < slots))
			return false;
	return true;
}

/* Two slots that meet: true where they ran beside one another, given half a minute. */
typedef struct meeting {
	atomic_uint here;
	atomic_bool missed;
	atomic_uint fewest; /* processors that a slot's thread may use */
} meeting;

static void meet(void *context, unsigned slot)
{
	(void)slot;
	meeting *m = context;
	m->here++;
	for (int i = 0; i < 30000 && m->here < 2; i++)
		nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
	if (m->here < 2)
		m->missed = true;
}

/* The same, on as many processors as the process may use: a new thread has begun on fewer. */
static void meet_anywhere(void *context, unsigned slot)
{
	meeting *m = context;
	const unsigned processors = nt_pool_processors();
	meet(context, slot);
	m->fewest = processors < m->fewest ? processors : (unsigned)m->fewest;
}

static bool two_slots_meet(void)
{
	meeting m = {0};
	nt_pool_run(2, meet, &m);
	return !m.missed;
}

/* ---- cases ---- */

/* First, while no thread is made yet. */
TEST(no_slot_and_one_slot_take_no_thread)
{
	assert_true(each_slot_once(0));
	assert_true(each_slot_once(1));
	assert_int_equal(threads_made, 0);
}

/* A strip of unit squares in the plane z = 0, which nothing is wrong with. */
static void solve_strip(size_t squares, unsigned threads, float *tangents)
{
	const size_t columns = squares + 1;
	float *values = calloc(2 * columns, 8 * sizeof *values);
	uint32_t *corners = calloc(6 * squares, sizeof *corners);
	if (!values || !corners)
		abort();
	for (size_t i = 0; i < 2 * columns; i++) {
		float *row = values + 8 * i;
		row[0] = row[6] = (float)(i / 2 % 1000);
		row[1] = row[7] = (float)(i % 2) + (float)(i / 2000) * 2;
		row[5] = 1;
	}
	for (size_t i = 0; i < squares; i++) {
		const uint32_t a = (uint32_t)(2 * i), square[6] = {a, a + 2, a + 3, a, a + 3, a + 1};
		memcpy(corners + 6 * i, square, sizeof square);
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2 * squares,
		.vertex_count = 2 * columns,
		.indices = corners, .positions = values, .position_stride_bytes = 32, .normals = values + 3,
		.normal_stride_bytes = 32,
		.texcoords = values + 6, .texcoord_stride_bytes = 32};
	const nmtan_options options = {.struct_bytes = sizeof options, .threads = threads};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents};
	if (nmtan_tangents(&mesh, &options, &output, NULL))
		abort();
	free(values);
	free(corners);
}

TEST(small_meshes_make_no_thread)
{
	static float tangents[4 * 6 * 500];
	solve_strip(500, 8, tangents);
	solve_strip(500, 0, tangents);
	assert_int_equal(threads_made, 0);
}

TEST(slots_run_beside_one_another_and_threads_are_kept)
{
	assert_true(two_slots_meet());
	assert_int_equal(threads_made, 1);
	for (unsigned i = 0; i < 3000; i++) {
		assert_true(each_slot_once(2));
		if (i % 1000 == 0) /* and after they have gone to sleep */
			usleep(2000);
	}
	assert_true(two_slots_meet());
	nt_pool_stay(1);
	for (unsigned i = 0; i < 3000; i++) {
		assert_true(each_slot_once(2));
		if (i % 1000 == 0) /* longer than a thread stays */
			usleep(2000);
	}
	assert_true(two_slots_meet());
	nt_pool_stay(-1);
	assert_int_equal(threads_made, 1);
	assert_true(each_slot_once(5));
	assert_int_equal(threads_made, 4);
	for (unsigned slots = 2; slots < 40; slots++)
		assert_true(each_slot_once(slots));
	assert_int_equal(threads_made, 38);
}

/* Every other time threads stay, of other callers too. */
static void *run_regions(void *fault)
{
	for (unsigned i = 0; i < 2000; i++) {
		const bool stays = i / 50 % 2;
		if (i % 50 == 0 && i > 0)
			nt_pool_stay(stays ? 1 : -1);
		if (!each_slot_once(2 + i % 7))
			*(bool *)fault = true;
	}
	nt_pool_stay(-1);
	return NULL;
}

TEST(threads_may_go_wherever_their_maker_may)
{
	meeting m = {.fewest = UINT_MAX};
	nt_pool_run(2, meet_anywhere, &m);
	assert_false(m.missed);
	assert_int_equal(m.fewest, nt_pool_processors());
}

TEST(processors_are_those_that_this_process_may_use)
{
	cpu_set_t all, one;
	assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
	CPU_ZERO(&one);
	CPU_SET(sched_getcpu(), &one);
	assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
	const unsigned processors = nt_pool_processors();
	assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
	assert_int_equal(processors, 1);
	assert_int_equal(nt_pool_processors(), CPU_COUNT(&all));
}

TEST(callers_may_be_many)
{
	enum { CALLERS = 6 };
	pthread_t callers[CALLERS];
	bool faults[CALLERS] = {false};
	for (unsigned i = 0; i < CALLERS; i++)
		assert_int_equal(__real_pthread_create(&callers[i], NULL, run_regions, &faults[i]), 0);
	for (unsigned i = 0; i < CALLERS; i++) {
		pthread_join(callers[i], NULL);
		assert_false(faults[i]);
	}
}

static void count_nested(void *context, unsigned slot)
{
	(void)slot;
	atomic_uint *sum = context;
	atomic_uint calls[3] = {0};
	nt_pool_run(3, count_call, calls);
	*sum += calls[0] + calls[1] + calls[2];
}

static void nest_twice(void *context, unsigned slot)
{
	(void)slot;
	nt_pool_run(4, count_nested, context);
}

static atomic_bool helper_is_in, helper_may_leave;

/* The caller's slot ends at once, so that it waits for the helper's, which stays until it may leave. */
static void leave_the_helper_alone(void *context, unsigned slot)
{
	(void)slot;
	if (!pthread_equal(*(pthread_t *)context, pthread_self())) {
		helper_is_in = true;
		for (int i = 0; !helper_may_leave && i < 30000; i++)
			nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
	} else
		for (int i = 0; !helper_is_in && i < 30000; i++)
			nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static void *call_until_cancelled(void *unused)
{
	pthread_t self = pthread_self();
	(void)unused;
	nt_pool_run(2, leave_the_helper_alone, &self);
	pthread_testcancel();
	return NULL;
}

/* A thread that is cancelled while it waits ends after the region, and others go on. */
TEST(a_cancelled_caller_leaves_the_pool_free)
{
	pthread_t caller;
	void *result;
	helper_is_in = helper_may_leave = false;
	assert_int_equal(pthread_create(&caller, NULL, call_until_cancelled, NULL), 0);
	for (int i = 0; !helper_is_in && i < 30000; i++)
		nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
	nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
	assert_int_equal(pthread_cancel(caller), 0);
	helper_may_leave = true;
	assert_int_equal(pthread_join(caller, &result), 0);
	assert_ptr_equal(result, PTHREAD_CANCELED);
	assert_true(two_slots_meet());
}

TEST(regions_nest)
{
	for (unsigned i = 0; i < 200; i++) {
		atomic_uint sum = 0;
		nt_pool_run(5, nest_twice, &sum);
		assert_int_equal(sum, 5 * 4 * 3);
	}
}

static void work_in_a_child(void)
{
	threads_made = 0;
	expect(each_slot_once(1));
	expect(threads_made == 0);
	expect(two_slots_meet());
	expect(threads_made == 1);
	for (unsigned slots = 2; slots < 10; slots++)
		expect(each_slot_once(slots));
}

static void work_in_children(void)
{
	work_in_a_child();
	const pid_t child = fork();
	if (child == 0) {
		work_in_a_child();
		_exit(0);
	}
	int status;
	expect(waitpid(child, &status, 0) == child && status == 0);
	expect(two_slots_meet());
}

TEST(a_child_makes_threads_of_its_own)
{
	assert_true(each_slot_once(8));
	in_a_child(work_in_children);
	assert_true(two_slots_meet());
}

static atomic_bool ends;

static void *run_until_the_end(void *unused)
{
	(void)unused;
	while (!ends)
		each_slot_once(4);
	return NULL;
}

static void work_shortly(void)
{
	expect(two_slots_meet());
	expect(each_slot_once(6));
}

/* The other threads may do anything, with the lock or without. */
TEST(fork_in_the_midst_of_regions)
{
	pthread_t callers[2];
	ends = false;
	for (unsigned i = 0; i < 2; i++)
		assert_int_equal(__real_pthread_create(&callers[i], NULL, run_until_the_end, NULL), 0);
	for (unsigned i = 0; i < 100; i++)
		in_a_child(work_shortly);
	ends = true;
	for (unsigned i = 0; i < 2; i++)
		pthread_join(callers[i], NULL);
}

typedef struct witnesses {
	pthread_t thread[40];
} witnesses;

static void note_thread(void *context, unsigned slot)
{
	((witnesses *)context)->thread[slot] = pthread_self();
}

static void work_alone(void)
{
	static float alone[4 * 6 * 30000], helped[4 * 6 * 30000];
	creation_fails = true;
	for (unsigned i = 0; i < 150; i++) {
		witnesses w;
		nt_pool_run(40, note_thread, &w);
		for (unsigned slot = 0; slot < 40; slot++)
			expect(pthread_equal(w.thread[slot], pthread_self()));
	}
	solve_strip(30000, 4, alone);
	creation_fails = false;
	/* it tries again, though not at once */
	for (unsigned i = 0; i < 200; i++)
		expect(each_slot_once(4));
	expect(threads_made > 0);
	expect(two_slots_meet());
	solve_strip(30000, 4, helped);
	expect(memcmp(alone, helped, sizeof alone) == 0);
	expect(helped[0] == 1 && helped[1] == 0 && helped[2] == 0 && helped[3] == 1);
}

TEST(without_threads_the_caller_does_all)
{
	threads_made = 0;
	in_a_child(work_alone);
}

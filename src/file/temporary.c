/* SPDX-License-Identifier: MIT */
/*
 * Temporary files that a signal removes: see temporary.h.
 *
 * The list is plain and guarded by a spin lock. Who takes the lock blocks the signals in its own thread
 * first, so the handler never waits for the thread it interrupted; it may wait for another one, which
 * goes on. The handler keeps the lock: from then on nobody creates or renames anything. Only unlink,
 * poll, signal calls and lock-free atomics run in the handler; all of them are async-signal-safe.
 */
#include "file/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "file/input.h"

/* What is tried before giving up on a free name: names of dead processes with our number are rare. */
enum { MOST_ATTEMPTS = 1000 };

struct nt_temporary {
	nt_temporary *next, *previous;
	bool renamed;
	char path[];
};

static const int caught_signals[] = {SIGINT, SIGTERM, SIGHUP};
enum { CAUGHT_COUNT = sizeof caught_signals / sizeof caught_signals[0] };

static atomic_flag list_lock = ATOMIC_FLAG_INIT;
static nt_temporary *list;
static sigset_t mask_before_hold; /* of the thread that holds the lock */

static void take_lock(void)
{
	while (atomic_flag_test_and_set_explicit(&list_lock, memory_order_acquire))
		poll(NULL, 0, 1);
}

void nt_temporaries_hold(void)
{
	sigset_t blocked, before;
	sigemptyset(&blocked);
	for (int i = 0; i < CAUGHT_COUNT; i++)
		sigaddset(&blocked, caught_signals[i]);
	pthread_sigmask(SIG_BLOCK, &blocked, &before);
	take_lock();
	mask_before_hold = before;
}

void nt_temporaries_release(void)
{
	const int kept = errno;
	const sigset_t before = mask_before_hold;
	atomic_flag_clear_explicit(&list_lock, memory_order_release);
	pthread_sigmask(SIG_SETMASK, &before, NULL);
	errno = kept;
}

/* Name `attempt` beside target: hidden, short enough for any file system, the extension left out. */
static void name_beside(char *path, size_t capacity, const char *target, unsigned attempt)
{
	static atomic_uint counter;
	const char *slash = strrchr(target, '/');
	const int folder_length = slash ? (int)(slash - target) + 1 : 0;
	snprintf(path, capacity, "%.*s.nmtan-%ld-%u-%u.tmp", folder_length, target, (long)getpid(),
		atomic_fetch_add(&counter, 1), attempt);
}

static int create_listed(nt_temporary *entry)
{
	nt_temporaries_hold();
	const int fd = open(entry->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
	if (fd >= 0) {
		entry->next = list;
		if (list)
			list->previous = entry;
		list = entry;
	}
	nt_temporaries_release();
	return fd;
}

int nt_temporary_create(const char *target, nt_temporary **temporary)
{
	const size_t capacity = strlen(target) + 80;
	nt_temporary *entry = calloc(1, sizeof *entry + capacity);
	if (!entry) {
		errno = ENOMEM;
		return -1;
	}
	int fd = -1;
	for (unsigned attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
		name_beside(entry->path, capacity, target, attempt);
		fd = create_listed(entry);
		if (fd >= 0 || errno != EEXIST)
			break;
	}
	if (fd < 0) {
		const int kept = errno;
		free(entry);
		errno = kept;
		return -1;
	}
	*temporary = entry;
	return fd;
}

const char *nt_temporary_path(const nt_temporary *temporary)
{
	return temporary->path;
}

/* Rename that fails with EEXIST; by a second link where the file system has no such rename. */
static bool rename_to_free_name(const char *from, const char *to)
{
	if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0)
		return true;
	if (errno != EINVAL && errno != ENOSYS)
		return false;
	if (link(from, to) != 0)
		return false;
	unlink(from);
	return true;
}

bool nt_temporary_rename(nt_temporary *temporary, const char *target, bool replace)
{
	temporary->renamed = replace ? rename(temporary->path, target) == 0
				     : rename_to_free_name(temporary->path, target);
	return temporary->renamed;
}

void nt_temporary_discard(nt_temporary *temporary)
{
	if (!temporary)
		return;
	nt_temporaries_hold();
	if (!temporary->renamed)
		unlink(temporary->path);
	if (temporary->previous)
		temporary->previous->next = temporary->next;
	else
		list = temporary->next;
	if (temporary->next)
		temporary->next->previous = temporary->previous;
	nt_temporaries_release();
	free(temporary);
}

static void remove_and_end(int signal_number)
{
	take_lock();
	for (const nt_temporary *entry = list; entry; entry = entry->next)
		if (!entry->renamed)
			unlink(entry->path);
	/* end as if it had not been caught, so that a shell sees the signal */
	sigset_t only;
	sigemptyset(&only);
	sigaddset(&only, signal_number);
	signal(signal_number, SIG_DFL);
	raise(signal_number);
	pthread_sigmask(SIG_UNBLOCK, &only, NULL);
	_exit(128 + signal_number);
}

void nt_output_catch_signals(void)
{
	struct sigaction action = {.sa_handler = remove_and_end};
	sigemptyset(&action.sa_mask);
	for (int i = 0; i < CAUGHT_COUNT; i++)
		sigaddset(&action.sa_mask, caught_signals[i]);
	for (int i = 0; i < CAUGHT_COUNT; i++) {
		/* what was ignored from the start (nohup, background jobs) stays ignored */
		struct sigaction before;
		if (sigaction(caught_signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
			sigaction(caught_signals[i], &action, NULL);
	}
	/* a reader that goes away becomes a write error, which cleans up and says so */
	signal(SIGPIPE, SIG_IGN);
}

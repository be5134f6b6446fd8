/* SPDX-License-Identifier: MIT */
/*
 * Temporary files that a signal removes: see temporary.h.
 *
 * The list is plain and guarded by a spin lock. Who takes the lock blocks the signals in its own thread
 * first, so the handler never waits for the thread it interrupted; it may wait for others: for those that hold, and
 * for the lock, which it keeps: from then on nobody creates, renames or holds anything. A fault cannot be blocked: each
 * thread knows what it has itself. Only unlink, poll, signal calls and lock-free atomics run in the handler; all of
 * them are async-signal-safe.
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
#include "file/maker.h"

/* What is tried before giving up on a free name: names of ended processes with our number are rare. */
enum { MOST_ATTEMPTS = 1000 };

struct nt_temporary {
	nt_temporary *next, *previous;
	bool renamed;
	char path[];
};

static const int caught_signals[] = {SIGINT, SIGTERM, SIGHUP};
enum { CAUGHT_COUNT = sizeof caught_signals / sizeof caught_signals[0] };

static const char name_head[] = ".nmtan-", name_tail[] = ".tmp";

static atomic_flag list_lock = ATOMIC_FLAG_INIT;
static nt_temporary *list;
static atomic_uint holders;
static atomic_bool ending; /* a signal has come */
static _Thread_local volatile unsigned own_holds; /* of the holders */
static _Thread_local volatile bool owns_list;     /* it changes the list */

static void block_signals(sigset_t *before)
{
	sigset_t blocked;
	sigemptyset(&blocked);
	for (int i = 0; i < CAUGHT_COUNT; i++)
		sigaddset(&blocked, caught_signals[i]);
	pthread_sigmask(SIG_BLOCK, &blocked, before);
}

static void restore_signals(const sigset_t *before)
{
	const int kept = errno;
	pthread_sigmask(SIG_SETMASK, before, NULL);
	errno = kept;
}

static void spin(void)
{
	while (atomic_flag_test_and_set_explicit(&list_lock, memory_order_acquire))
		poll(NULL, 0, 1);
}

static void lock_list(sigset_t *before)
{
	block_signals(before);
	spin();
	owns_list = true;
}

static void unlock_list(const sigset_t *before)
{
	owns_list = false;
	atomic_flag_clear_explicit(&list_lock, memory_order_release);
	restore_signals(before);
}

void nt_temporaries_hold(sigset_t *before)
{
	block_signals(before);
	/* either the handler sees that we hold, or we see that it has come */
	atomic_fetch_add(&holders, 1);
	if (!atomic_load(&ending)) {
		own_holds++;
		return;
	}
	atomic_fetch_sub(&holders, 1);
	for (;;)
		poll(NULL, 0, -1);
}

void nt_temporaries_release(const sigset_t *before)
{
	own_holds--;
	atomic_fetch_sub(&holders, 1);
	restore_signals(before);
}

/* ---- names ---- */

/* Name `attempt` beside target: hidden, of a length that any file system has, the target's own name left out. */
static void name_beside(char *path, size_t capacity, const char *target, unsigned attempt)
{
	static atomic_uint counter;
	char maker[NT_MAKER_TEXT];
	const char *slash = strrchr(target, '/');
	const int folder_length = slash ? (int)(slash - target) + 1 : 0;
	nt_maker_text(maker);
	snprintf(path, capacity, "%.*s%s%s-%u.%u%s", folder_length, target, name_head, maker,
		atomic_fetch_add(&counter, 1), attempt, name_tail);
}

const char *nt_temporary_maker(const char *name, size_t *length)
{
	const size_t head = strlen(name_head), tail = strlen(name_tail), whole = strlen(name);
	if (whole < head + tail || strncmp(name, name_head, head) != 0 ||
		strcmp(name + whole - tail, name_tail) != 0)
		return NULL;
	size_t end = whole - tail;
	while (end > head && name[end - 1] != '-')
		end--;
	if (end <= head + 1)
		return NULL;
	*length = end - 1 - head;
	return name + head;
}

/* ---- files ---- */

/* Makes the file, or the link to `from`, and lists it. Returns the file's descriptor, 0 for a link; -1 with errno. */
static int make_listed(nt_temporary *entry, const char *from, unsigned mode)
{
	sigset_t before;
	lock_list(&before);
	const int fd = from ? link(from, entry->path)
			    : open(entry->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, (mode_t)mode);
	if (fd >= 0) {
		entry->next = list;
		if (list)
			list->previous = entry;
		list = entry;
	}
	unlock_list(&before);
	return fd;
}

static int make(const char *target, const char *from, unsigned mode, nt_temporary **temporary)
{
	const size_t capacity = strlen(target) + NT_MAKER_TEXT + 48;
	nt_temporary *entry = calloc(1, sizeof *entry + capacity);
	if (!entry) {
		errno = ENOMEM;
		return -1;
	}
	int fd = -1;
	for (unsigned attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
		name_beside(entry->path, capacity, target, attempt);
		fd = make_listed(entry, from, mode);
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

int nt_temporary_create(const char *target, unsigned mode, nt_temporary **temporary)
{
	return make(target, NULL, mode, temporary);
}

bool nt_temporary_link(const char *from, const char *target, nt_temporary **temporary)
{
	return make(target, from, 0, temporary) >= 0;
}

const char *nt_temporary_path(const nt_temporary *temporary)
{
	return temporary->path;
}

/* Where there is neither such a rename nor a second link: an empty file takes the name, and is ours to replace. */
static bool rename_to_reserved_name(const char *from, const char *to)
{
	const int fd = open(to, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
	if (fd < 0)
		return false;
	close(fd);
	if (rename(from, to) == 0)
		return true;
	const int kept = errno;
	unlink(to);
	errno = kept;
	return false;
}

/* Rename that fails with EEXIST; by other means where the file system has no such rename. */
static bool rename_to_free_name(const char *from, const char *to)
{
	if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0)
		return true;
	if (errno != EINVAL && errno != ENOSYS)
		return false;
	if (link(from, to) == 0) {
		unlink(from);
		return true;
	}
	return errno != EEXIST && rename_to_reserved_name(from, to);
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
	sigset_t before;
	lock_list(&before);
	if (!temporary->renamed)
		unlink(temporary->path);
	if (temporary->previous)
		temporary->previous->next = temporary->next;
	else
		list = temporary->next;
	if (temporary->next)
		temporary->next->previous = temporary->previous;
	unlock_list(&before);
	free(temporary);
}

void nt_temporaries_remove_all(void)
{
	atomic_store(&ending, true);
	while (atomic_load(&holders) > own_holds)
		poll(NULL, 0, 1);
	if (owns_list)
		return; /* a fault, with the list half changed: the files are left to litter.c */
	spin();
	for (const nt_temporary *entry = list; entry; entry = entry->next)
		if (!entry->renamed)
			unlink(entry->path);
}

static void remove_and_end(int signal_number)
{
	nt_temporaries_remove_all();
	/* end as if it had not been caught, so that a shell sees the signal */
	sigset_t only;
	sigemptyset(&only);
	sigaddset(&only, signal_number);
	signal(signal_number, SIG_DFL);
	raise(signal_number);
	pthread_sigmask(SIG_UNBLOCK, &only, NULL);
	_exit(128 + signal_number);
}

void nt_temporaries_catch_signals(void)
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

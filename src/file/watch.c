/* SPDX-License-Identifier: MIT */
/*
 * Mapped files that change: see input.h.
 *
 * The handler looks the address up in a plain table of atomics and lays zeros over the map from the faulting page to
 * its end; mmap() is a system call and no more on every system that we know. A fault elsewhere gets the action
 * that was set before.
 */
#include "file/input.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* A document of so many open files keeps the others in memory; so does one that has half of the files open that the
 * process may have beside its outputs (output.c). */
enum { MOST_MAPS = 512, OTHER_FILES = 48 };

typedef struct watched {
	atomic_uintptr_t begin; /* 0: free; 1: taken, being filled */
	atomic_size_t size;
	atomic_bool shortened;
	_Atomic(const void *) owner;
	struct timespec modified; /* before it was mapped */
	int fd;
	char path[512];
} watched;

static watched maps[MOST_MAPS];
static atomic_int ever_taken; /* of them, from the first: what lies behind has not been touched, and takes no memory */
static atomic_size_t page_bytes;
static struct sigaction action_before;

static _Thread_local char lost[512]; /* a file of this thread that is closed */
static _Thread_local const char *has_lost; /* what happened to it; NULL: there is none */

/* The map that an address lies in, or NULL. */
static watched *map_of(uintptr_t address)
{
	const int count = atomic_load(&ever_taken);
	for (int i = 0; i < count; i++) {
		const uintptr_t begin = atomic_load(&maps[i].begin);
		if (begin > 1 && address >= begin && address - begin < atomic_load(&maps[i].size))
			return &maps[i];
	}
	return NULL;
}

static void put_zeros(int number, siginfo_t *info, void *context)
{
	(void)context;
	const uintptr_t address = (uintptr_t)info->si_addr;
	watched *map = map_of(address);
	const uintptr_t page = address / page_bytes * page_bytes; /* set before the first map was */
	if (map && mmap((void *)page, atomic_load(&map->begin) + atomic_load(&map->size) - page, PROT_READ,
			   MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED) {
		atomic_store(&map->shortened, true);
		return;
	}
	sigaction(number, &action_before, NULL);
	/* an instruction runs into it once more, a process that sent it does not */
	if (info->si_code <= 0)
		raise(number);
}

/* Unless it stands already: who shares the process may have set another one. */
static void install(void)
{
	static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
	struct sigaction action = {.sa_sigaction = put_zeros, .sa_flags = SA_SIGINFO}, now;
	sigemptyset(&action.sa_mask);
	pthread_mutex_lock(&lock);
	page_bytes = (size_t)sysconf(_SC_PAGESIZE);
	if (sigaction(SIGBUS, NULL, &now) == 0 && now.sa_sigaction != put_zeros)
		sigaction(SIGBUS, &action, &action_before);
	pthread_mutex_unlock(&lock);
}

int nt_watch_begin(const void *map, const struct stat *status, int fd, const char *path)
{
	install();
	struct rlimit files = {.rlim_cur = RLIM_INFINITY};
	getrlimit(RLIMIT_NOFILE, &files);
	const rlim_t free_files = files.rlim_cur > OTHER_FILES ? files.rlim_cur - OTHER_FILES : 0;
	const int most = free_files / 2 < MOST_MAPS ? (int)free_files / 2 : MOST_MAPS;
	for (int i = 0; i < most; i++) {
		watched *w = &maps[i];
		uintptr_t none = 0;
		if (!atomic_compare_exchange_strong(&w->begin, &none, 1))
			continue;
		int count = atomic_load(&ever_taken);
		while (count <= i && !atomic_compare_exchange_weak(&ever_taken, &count, i + 1))
			continue;
		atomic_store(&w->owner, &has_lost);
		w->fd = fd;
		w->modified = status->st_mtim;
		nt_utf8_keep_end(w->path, sizeof w->path, path);
		atomic_store(&w->shortened, false);
		atomic_store(&w->size, (size_t)status->st_size);
		atomic_store(&w->begin, (uintptr_t)map);
		return i;
	}
	return -1;
}

/* A page that holds the end of the file reads as zeros behind it, without a signal. */
static bool is_shortened(const watched *w, const struct stat *info)
{
	return atomic_load(&w->shortened) || (info && (uintmax_t)info->st_size < atomic_load(&w->size));
}

bool nt_watch_is_shortened(int watch)
{
	struct stat info;
	return is_shortened(&maps[watch], fstat(maps[watch].fd, &info) == 0 ? &info : NULL);
}

/* Another process's change to a file; NULL: nothing. */
static const char *change_of(const watched *w)
{
	struct stat info;
	const bool known = fstat(w->fd, &info) == 0;
	if (is_shortened(w, known ? &info : NULL))
		return "the file became shorter while it was read";
	const bool changed = known && (info.st_mtim.tv_sec != w->modified.tv_sec ||
		info.st_mtim.tv_nsec != w->modified.tv_nsec);
	return changed ? "the file changed while it was read" : NULL;
}

void nt_watch_end(int watch)
{
	watched *w = &maps[watch];
	const char *change = has_lost ? NULL : change_of(w);
	if (change) {
		memcpy(lost, w->path, sizeof lost);
		has_lost = change;
	}
	atomic_store(&w->begin, 0);
}

void nt_watch_forget(void)
{
	has_lost = NULL;
}

const char *nt_watch_any_change(const char **path)
{
	const char *change = NULL;
	const int count = atomic_load(&ever_taken);
	for (int i = 0; i < count && !change; i++)
		if (atomic_load(&maps[i].begin) > 1) {
			*path = maps[i].path;
			change = change_of(&maps[i]);
		}
	return change;
}

nt_status nt_watch_check(nt_error *error)
{
	const char *path = lost, *change = has_lost;
	const int count = atomic_load(&ever_taken);
	for (int i = 0; i < count && !change; i++) {
		if (atomic_load(&maps[i].begin) <= 1 || atomic_load(&maps[i].owner) != &has_lost)
			continue;
		path = maps[i].path;
		change = change_of(&maps[i]);
	}
	if (!change)
		return NT_OK;
	return nt_fail_file(error, NT_ERROR_IO, path, "%s", change);
}

bool nt_watch_touch(const void *bytes, size_t size)
{
	const volatile unsigned char *at = bytes;
	if (!size || !map_of((uintptr_t)bytes))
		return false;
	for (size_t i = 0; i < size; i += page_bytes)
		(void)at[i];
	(void)at[size - 1];
	return true;
}

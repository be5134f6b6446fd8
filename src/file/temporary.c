/* SPDX-License-Identifier: MIT */
/*
 * Temporary files that a signal removes: see output.h.
 *
 * The list is plain and guarded by a spin lock. A thread that takes the lock blocks the signals in its own thread
 * first, so the handler never waits for the thread it interrupted; it may wait for others: for those that hold, and
 * for the lock, which it keeps: from then on nobody creates, renames or holds anything. A fault cannot be blocked: each
 * thread knows what it has itself. Only unlinkat, poll, signal calls and lock-free atomics run in the handler; all of
 * them are async-signal-safe.
 *
 * Files are made, renamed and removed by the descriptor of their folder: somebody may move that meanwhile.
 */
#include "file/output.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>
#include "file/input.h"
#include "file/path.h"

/* Attempts to find a free name: names of ended processes with our number are rare. */
enum { MOST_ATTEMPTS = 1000, BOOT_DIGITS = 32 };

/* One that has temporary files. */
typedef struct folder {
	struct folder *next;
	int fd;
	unsigned files;
	nt_file_id id;
} folder;

struct nt_temporary {
	nt_temporary *next, *previous;
	bool renamed, led;
	int fd;         /* holds the lock; below 0: closed */
	folder *folder; /* NULL: names are whole paths */
	const char *name; /* in the folder */
	char path[];
};

static const int caught_signals[] = {SIGINT, SIGTERM, SIGHUP};
enum { CAUGHT_COUNT = sizeof caught_signals / sizeof caught_signals[0] };

static const char name_head[] = ".nmtan-", name_tail[] = ".tmp";

static atomic_flag list_lock = ATOMIC_FLAG_INIT;
static nt_temporary *list;
static folder *folders;
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

/* The kernel's number for this boot, without its dashes; zeros where there is none. */
static const char *boot_number(void)
{
	static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
	static char boot[BOOT_DIGITS + 1];
	pthread_mutex_lock(&lock);
	if (!*boot) {
		char text[64] = "";
		FILE *file = fopen("/proc/sys/kernel/random/boot_id", "re");
		if (file && fgets(text, sizeof text, file) == NULL)
			*text = '\0';
		if (file)
			fclose(file);
		size_t count = 0;
		for (const char *c = text; isxdigit((unsigned char)*c) || *c == '-'; c++)
			if (*c != '-' && count < BOOT_DIGITS)
				boot[count++] = *c;
		memset(boot + count, '0', BOOT_DIGITS - count);
	}
	pthread_mutex_unlock(&lock);
	return boot;
}

/* Name `attempt` beside target: hidden, of a length that any file system has, the target's own name left out. The
 * part behind a dash tells the leader from others of its process. */
static void name_beside(char *path, size_t capacity, const char *target, unsigned attempt, const nt_temporary *leader)
{
	static atomic_uint counter;
	const char *number = leader ? strrchr(leader->path, '-') : "";
	const size_t length = strlen(number);
	snprintf(path, capacity, "%.*s%s%s-%ld-%u.%u%.*s%s", (int)nt_folder_length(target), target, name_head,
		boot_number(), (long)getpid(), atomic_fetch_add(&counter, 1), attempt,
		(int)(length ? length - strlen(name_tail) : 0), number, name_tail);
}

bool nt_temporary_leader_of(const char *name, char leader[NT_TEMPORARY_NAME])
{
	/* head, boot, "-PID", "-NUMBER" and what the leader has in place of that */
	const char *process = strchr(name + strlen(name_head), '-');
	const char *own = process ? strchr(process + 1, '-') : NULL, *number = own ? strchr(own + 1, '-') : NULL;
	return number &&
		snprintf(leader, NT_TEMPORARY_NAME, "%.*s%s", (int)(own - name), name, number) < NT_TEMPORARY_NAME;
}

/* ---- folders ---- */

/* Descriptor for a file's own calls. */
static int folder_of(const nt_temporary *entry)
{
	return entry->folder ? entry->folder->fd : AT_FDCWD;
}

static const char *name_in(const nt_temporary *entry, const char *path)
{
	return entry->folder ? path + nt_folder_length(path) : path;
}

/* The folder that a path has now; with the list locked. NULL: it cannot be opened, or memory is exhausted. A browser's
 * files have no folders to hold. */
static folder *open_folder(const char *path)
{
#ifdef __EMSCRIPTEN__
	(void)path;
	return NULL;
#else
	char text[PATH_MAX];
	struct stat status;
	const int fd = open(nt_folder_of(path, text), O_PATH | O_DIRECTORY | O_CLOEXEC);
	if (fd < 0)
		return NULL;
	const bool is_known = fstat(fd, &status) == 0;
	folder *opened = is_known ? folders : NULL;
	while (opened && !nt_same_id(opened->id, nt_file_id_of(&status)))
		opened = opened->next;
	if (opened) {
		opened->files++;
	} else if (is_known && (opened = malloc(sizeof *opened))) {
		*opened = (folder){folders, fd, 1, nt_file_id_of(&status)};
		return folders = opened;
	}
	close(fd);
	return opened;
#endif
}

static void close_folder(folder *opened)
{
	if (!opened || --opened->files)
		return;
	folder **at = &folders;
	while (*at != opened)
		at = &(*at)->next;
	*at = opened->next;
	close(opened->fd);
	free(opened);
}

bool nt_temporary_is_lockable(const char *name, bool local)
{
	const size_t head = strlen(name_head), tail = strlen(name_tail), whole = strlen(name);
	const char *boot = name + head;
	if (whole <= head + BOOT_DIGITS + tail || strncmp(name, name_head, head) != 0 ||
		strspn(boot, "0123456789abcdef") != BOOT_DIGITS || boot[BOOT_DIGITS] != '-' ||
		strcmp(name + whole - tail, name_tail) != 0)
		return false;
	const char *own = boot_number();
	return local || (strncmp(boot, own, BOOT_DIGITS) == 0 && strspn(own, "0") != BOOT_DIGITS);
}

/* ---- files ---- */

/* Opens and locks the file, or `from`, for which it is to be another name. False, with errno; EEXIST: the name is
 * taken, or a run that looked for stale files was faster. */
static bool open_locked(nt_temporary *entry, const char *from, unsigned mode)
{
	struct stat status;
	const int at = folder_of(entry);
	from = from ? name_in(entry, from) : NULL;
	entry->fd = from ? openat(at, from, O_RDONLY | O_CLOEXEC)
			 : openat(at, entry->name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, (mode_t)mode);
	if (entry->fd < 0)
		return false;
	/* where there are no locks, nobody takes the file for stale; `from` is this run's mostly, which has its lock */
	const bool refused = flock(entry->fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
	if (from ? linkat(at, from, at, entry->name, 0) == 0
		 : !refused && fstat(entry->fd, &status) == 0 && status.st_nlink > 0)
		return true;
	const int number = from ? errno : EEXIST;
	if (!from)
		unlinkat(at, entry->name, 0);
	close(entry->fd);
	errno = number;
	return false;
}

/* Makes the file, or the link to `from`, and lists it. False, with errno. */
static bool make_listed(nt_temporary *entry, const char *from, unsigned mode)
{
	sigset_t before;
	lock_list(&before);
	const bool made = open_locked(entry, from, mode);
	if (made) {
		entry->next = list;
		if (list)
			list->previous = entry;
		list = entry;
	}
	unlock_list(&before);
	return made;
}

/* A file's folder, opened or given back. */
static void change_folder(nt_temporary *entry, bool open)
{
	sigset_t before;
	lock_list(&before);
	if (open)
		entry->folder = open_folder(entry->path);
	else
		close_folder(entry->folder);
	unlock_list(&before);
}

static int make(const char *target, const char *from, unsigned mode, const nt_temporary *leader,
	nt_temporary **temporary)
{
	const size_t capacity = strlen(target) + NT_TEMPORARY_NAME;
	nt_temporary *entry = calloc(1, sizeof *entry + capacity);
	if (!entry) {
		errno = ENOMEM;
		return -1;
	}
	bool made = false;
	memcpy(entry->path, target, nt_folder_length(target));
	change_folder(entry, true);
	entry->led = leader;
	for (unsigned attempt = 0; !made && attempt < MOST_ATTEMPTS; attempt++) {
		name_beside(entry->path, capacity, target, attempt, leader);
		entry->name = name_in(entry, entry->path);
		made = make_listed(entry, from, mode);
		if (!made && errno != EEXIST)
			break;
	}
	if (!made) {
		const int kept = errno;
		change_folder(entry, false);
		free(entry);
		errno = kept;
		return -1;
	}
	*temporary = entry;
	return entry->fd;
}

int nt_temporary_create(const char *target, unsigned mode, const nt_temporary *leader, nt_temporary **temporary)
{
	return make(target, NULL, mode, leader, temporary);
}

bool nt_temporary_close(nt_temporary *temporary)
{
	const int fd = temporary->fd;
	temporary->fd = -1;
	return close(fd) == 0 || errno == EINTR;
}

bool nt_temporary_is_led(const nt_temporary *temporary)
{
	return temporary->led;
}

bool nt_temporary_link(const char *from, const char *target, nt_temporary **temporary)
{
	return make(target, from, 0, NULL, temporary) >= 0;
}

const char *nt_temporary_path(const nt_temporary *temporary)
{
	return temporary->path;
}

/* Without such a rename or a second link, an empty file takes the name, and is ours to replace. */
static bool rename_to_reserved_name(int at, const char *from, const char *to)
{
	const int fd = openat(at, to, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
	if (fd < 0)
		return false;
	close(fd);
	if (renameat(at, from, at, to) == 0)
		return true;
	const int kept = errno;
	unlinkat(at, to, 0);
	errno = kept;
	return false;
}

/* Rename that fails with EEXIST; by other means where the file system has no such rename. */
static bool rename_to_free_name(int at, const char *from, const char *to)
{
	if (renameat2(at, from, at, to, RENAME_NOREPLACE) == 0)
		return true;
	if (errno != EINVAL && errno != ENOSYS)
		return false;
	if (linkat(at, from, at, to, 0) == 0) {
		unlinkat(at, from, 0);
		return true;
	}
	return errno != EEXIST && rename_to_reserved_name(at, from, to);
}

bool nt_temporary_rename(nt_temporary *temporary, const char *target, bool replace)
{
	const int at = folder_of(temporary);
	const char *name = name_in(temporary, target);
	temporary->renamed = replace ? renameat(at, temporary->name, at, name) == 0
				     : rename_to_free_name(at, temporary->name, name);
	return temporary->renamed;
}

void nt_temporary_remove_name(const nt_temporary *temporary, const char *target)
{
	unlinkat(folder_of(temporary), name_in(temporary, target), 0);
}

void nt_temporary_discard(nt_temporary *temporary)
{
	if (!temporary)
		return;
	sigset_t before;
	lock_list(&before);
	if (!temporary->renamed)
		unlinkat(folder_of(temporary), temporary->name, 0);
	if (temporary->previous)
		temporary->previous->next = temporary->next;
	else
		list = temporary->next;
	if (temporary->next)
		temporary->next->previous = temporary->previous;
	close_folder(temporary->folder);
	unlock_list(&before);
	if (temporary->fd >= 0)
		close(temporary->fd);
	free(temporary);
}

void nt_temporaries_remove_all(void)
{
	atomic_store(&ending, true);
	while (atomic_load(&holders) > own_holds)
		poll(NULL, 0, 1);
	if (owns_list)
		return; /* a fault, with the list half changed: the files are stale now */
	spin();
	for (const nt_temporary *entry = list; entry; entry = entry->next)
		if (!entry->renamed)
			unlinkat(folder_of(entry), entry->name, 0);
}

/* ---- what killed processes left ---- */

/*
 * The process that makes a temporary file keeps a lock of it (flock) until it has its name; the system takes the lock
 * of a process that is gone. So a file that can be locked is stale, if its owner's lock would be seen here: the folder
 * is on a disk of this machine alone, or the owner ran on this very kernel, whose number for its boot is in the name. A
 * file of a set has the lock of another one: of its leader.
 */

/* File systems that one machine has to itself. */
static bool is_local(int at)
{
	static const uint32_t known[] = {0xEF53 /* ext2 to ext4 */, 0x58465342 /* XFS */, 0x9123683E /* Btrfs */,
		0x01021994 /* tmpfs */, 0xF2F52010 /* F2FS */, 0x2FC12FC1 /* ZFS */, 0x4D44 /* FAT */,
		0x2011BAB0 /* exFAT */, 0x5346544E /* NTFS */, 0x7366746E /* NTFS3 */};
	struct statfs status = {0};
	fstatfs(at, &status);
	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if ((uint32_t)status.f_type == known[i])
			return true;
	return false;
}

/* Whether this process looks into a folder for the first time. The latest folders are remembered. */
static bool is_first_look(const struct stat *status)
{
	enum { REMEMBERED = 64 };
	static nt_file_id latest[REMEMBERED];
	static size_t count;
	static atomic_flag lock = ATOMIC_FLAG_INIT;
	bool known = false;
	while (atomic_flag_test_and_set_explicit(&lock, memory_order_acquire))
		poll(NULL, 0, 1);
	for (size_t i = 0; i < count && i < REMEMBERED && !known; i++)
		known = nt_same_id(latest[i], nt_file_id_of(status));
	if (!known)
		latest[count++ % REMEMBERED] = nt_file_id_of(status);
	atomic_flag_clear_explicit(&lock, memory_order_release);
	return !known;
}

/* A file with its lock; LOCKED: another process has that; -1: there is no such file. */
enum { LOCKED = -2 };
static int open_stale(int at, const char *name)
{
	const int fd = openat(at, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
	if (fd < 0 || flock(fd, LOCK_EX | LOCK_NB) == 0)
		return fd;
	close(fd);
	return LOCKED;
}

void nt_temporaries_clean(const char *path)
{
	/* mostly that of the file before: not asked for again, which over a network would cost as much as a file */
	static _Thread_local char latest[256];
	struct stat status;
	if (strcmp(path, latest) == 0)
		return;
	snprintf(latest, sizeof latest, "%s", path);
	if (stat(path, &status) != 0 || !is_first_look(&status))
		return;
	DIR *dir = opendir(path);
	if (!dir)
		return;
	const int at = dirfd(dir);
	const bool local = is_local(at);
	for (const struct dirent *entry; (entry = readdir(dir));) {
		if (!nt_temporary_is_lockable(entry->d_name, local))
			continue;
		char leader[NT_TEMPORARY_NAME];
		const int leads = nt_temporary_leader_of(entry->d_name, leader) ? open_stale(at, leader) : -1;
		const int fd = leads != LOCKED ? open_stale(at, entry->d_name) : -1;
		if (fd >= 0)
			unlinkat(at, entry->d_name, 0);
		if (fd >= 0)
			close(fd);
		if (leads >= 0)
			close(leads);
	}
	closedir(dir);
}

/* ---- signals ---- */

static void (*tell_end)(void);

static void remove_and_end(int signal_number)
{
	nt_temporaries_remove_all();
	if (tell_end)
		tell_end();
	/* end as if it had not been caught, so that a shell sees the signal */
	sigset_t only;
	sigemptyset(&only);
	sigaddset(&only, signal_number);
	signal(signal_number, SIG_DFL);
	raise(signal_number);
	pthread_sigmask(SIG_UNBLOCK, &only, NULL);
	/* the first process of a container has no defaults */
	_exit(128 + signal_number);
}

void nt_temporaries_catch_signals(void (*tell)(void))
{
	tell_end = tell;
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

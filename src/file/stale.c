/* SPDX-License-Identifier: MIT */
/*
 * Removing what killed processes left in a folder: see temporary.h. The process that makes a temporary file keeps a
 * lock of it (flock) until it has its name; the system takes the lock of a process that is gone. So a file that can
 * be locked is stale, if its owner's lock would be seen here: the folder is on a disk of this machine alone, or the
 * owner ran on this very kernel, whose number for its boot is in the name. A file of a large set has the lock of
 * another one: of its leader.
 */
#include "file/temporary.h"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>
#include "file/lookup.h"

/* File systems that one machine has to itself. */
static bool is_local(int folder)
{
	static const uint32_t known[] = {0xEF53 /* ext2 to ext4 */, 0x58465342 /* XFS */, 0x9123683E /* Btrfs */,
		0x01021994 /* tmpfs */, 0xF2F52010 /* F2FS */, 0x2FC12FC1 /* ZFS */, 0x4D44 /* FAT */,
		0x2011BAB0 /* exFAT */, 0x5346544E /* NTFS */, 0x7366746E /* NTFS3 */};
	struct statfs status;
	if (fstatfs(folder, &status) != 0)
		return false;
	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if ((uint32_t)status.f_type == known[i])
			return true;
	return false;
}

/* Whether this process looks into a folder for the first time. The latest folders are remembered. */
static bool is_first_look(const struct stat *status)
{
	enum { REMEMBERED = 64 };
	static nt_file_id folders[REMEMBERED];
	static size_t count;
	static atomic_flag lock = ATOMIC_FLAG_INIT;
	bool known = false;
	while (atomic_flag_test_and_set_explicit(&lock, memory_order_acquire))
		poll(NULL, 0, 1);
	for (size_t i = 0; i < count && i < REMEMBERED && !known; i++)
		known = nt_same_id(folders[i], nt_file_id_of(status));
	if (!known)
		folders[count++ % REMEMBERED] = nt_file_id_of(status);
	atomic_flag_clear_explicit(&lock, memory_order_release);
	return !known;
}

/* A file with its lock; LOCKED: another process has that; -1: there is no such file. */
enum { LOCKED = -2 };
static int open_stale(int folder, const char *name)
{
	const int fd = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
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
	DIR *folder = opendir(path);
	if (!folder)
		return;
	const int at = dirfd(folder);
	const bool local = is_local(at);
	for (const struct dirent *entry; (entry = readdir(folder));) {
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
	closedir(folder);
}

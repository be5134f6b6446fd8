/* SPDX-License-Identifier: MIT */
/*
 * Stands between a program and the calls by which it changes files (LD_PRELOAD). By environment:
 *
 *   NT_CALLS_KILL=N             SIGKILL in place of the N-th call, from 1 on
 *   NT_CALLS_FAIL=NAME:ERRNO    the calls of that name fail; with :N behind, the N-th of them alone; more follow a
 *                               comma
 *   NT_CALLS_KEEP=NAME:NAME     files of these names, in whatever folder, get no other name and no other file gets
 *                               theirs: what the system says of files that are immutable, or of others in a sticky
 *                               folder
 *   NT_CALLS_SPOIL=1            the first byte that writev() is to write becomes another one
 *   NT_CALLS_CLONE=1            FICLONE has the file system share blocks, for which they are copied here
 *   NT_CALLS_COUNT=FILE         the names of all calls in their order, at the end
 *   NT_CALLS_TRACE=DIR          DIR/log has each call that changes names or makes something lasting, after it
 *                               succeeded; what fsync makes lasting of a file is copied to DIR/NUMBER
 *
 * A rename is logged as it is; all paths are as the program gave them, below a folder's descriptor, too. fsync is not
 * passed on: no test looks at the disk itself, and it would take most of the time. Programs under test run with one
 * thread.
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <sys/xattr.h>
#include <unistd.h>

static unsigned long calls, matches;
static int log_fd = -1;
static unsigned snapshots;

enum { MOST_CALLS = 4096 };
static const char *made[MOST_CALLS];

#define REAL(name) ((__typeof__(name) *)dlsym(RTLD_NEXT, #name))

/* Before a call. False: it is to fail, errno is set. */
static bool enter(const char *name)
{
	const char *kill_at = getenv("NT_CALLS_KILL"), *fail = getenv("NT_CALLS_FAIL");
	if (calls < MOST_CALLS)
		made[calls] = name;
	calls++;
	if (kill_at && strtoul(kill_at, NULL, 10) == calls)
		kill(getpid(), SIGKILL);
	const size_t length = strlen(name);
	for (fail = fail ? fail : ""; *fail && (strncmp(fail, name, length) != 0 || fail[length] != ':');)
		fail += strcspn(fail, ",") + (strchr(fail, ',') != NULL);
	if (!*fail)
		return true;
	char *end;
	const long number = strtol(fail + length + 1, &end, 10);
	matches++;
	if (*end == ':' && strtoul(end + 1, NULL, 10) != matches)
		return true;
	errno = (int)number;
	return false;
}

/* Whether NT_CALLS_KEEP has a file; errno is set then. */
static bool is_kept(const char *path)
{
	const char *names = getenv("NT_CALLS_KEEP"), *slash = strrchr(path, '/');
	const char *name = slash ? slash + 1 : path;
	for (size_t length; names && *names; names += length + (names[length] == ':')) {
		length = strcspn(names, ":");
		if (strlen(name) == length && strncmp(names, name, length) == 0) {
			errno = EPERM;
			return true;
		}
	}
	return false;
}

__attribute__((destructor)) static void end(void)
{
	const char *path = getenv("NT_CALLS_COUNT");
	FILE *file = path ? fopen(path, "w") : NULL;
	if (file) {
		for (unsigned long i = 0; i < calls && i < MOST_CALLS; i++)
			fprintf(file, "%s\n", made[i]);
		fclose(file);
	}
}

/* ---- the log ---- */

static void note(const char *format, ...)
{
	const char *folder = getenv("NT_CALLS_TRACE");
	char line[9000];
	va_list arguments;
	if (!folder)
		return;
	const int kept = errno;
	if (log_fd < 0) {
		snprintf(line, sizeof line, "%s/log", folder);
		log_fd = REAL(open)(line, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
	}
	va_start(arguments, format);
	const int length = vsnprintf(line, sizeof line, format, arguments);
	va_end(arguments);
	if (REAL(write)(log_fd, line, (size_t)length) != length)
		_exit(98);
	errno = kept;
}

/* The file of a descriptor: a folder or a file, by its inode. */
static void note_sync(int fd)
{
	const char *folder = getenv("NT_CALLS_TRACE");
	struct stat status;
	if (!folder || fstat(fd, &status) != 0)
		return;
	if (S_ISDIR(status.st_mode)) {
		note("sync-folder\t%llu\n", (unsigned long long)status.st_ino);
		return;
	}
	char path[9000], bytes[65536], self[64];
	const unsigned number = snapshots++;
	snprintf(path, sizeof path, "%s/%u", folder, number);
	snprintf(self, sizeof self, "/proc/self/fd/%d", fd);
	FILE *from = fopen(self, "rb"), *to = fopen(path, "wb");
	if (!from || !to)
		_exit(98);
	for (size_t size; (size = fread(bytes, 1, sizeof bytes, from)) > 0;)
		if (fwrite(bytes, 1, size, to) != size)
			_exit(98);
	fclose(from);
	fclose(to);
	note("sync-file\t%llu\t%u\n", (unsigned long long)status.st_ino, number);
}

static void note_name(const char *what, int folder, const char *path)
{
	struct stat status;
	if (getenv("NT_CALLS_TRACE") && fstatat(folder, path, &status, AT_SYMLINK_NOFOLLOW) == 0)
		note("%s\t%s\t%llu\n", what, path, (unsigned long long)status.st_ino);
}

/* ---- the calls ---- */

/* One of which nothing is noted. */
#define CALL(type, name, parameters, arguments) \
	type name parameters \
	{ \
		return enter(#name) ? REAL(name) arguments : -1; \
	}

CALL(ssize_t, write, (int fd, const void *bytes, size_t size), (fd, bytes, size))
CALL(ssize_t, pwritev, (int fd, const struct iovec *parts, int count, off_t offset), (fd, parts, count, offset))
CALL(int, fchmod, (int fd, mode_t mode), (fd, mode))
CALL(int, fchown, (int fd, uid_t user, gid_t group), (fd, user, group))
CALL(int, fsetxattr, (int fd, const char *name, const void *value, size_t size, int flags),
	(fd, name, value, size, flags))
CALL(ssize_t, listxattr, (const char *path, char *list, size_t size), (path, list, size))
CALL(int, mkdir, (const char *path, mode_t mode), (path, mode))

ssize_t writev(int fd, const struct iovec *parts, int count)
{
	if (!enter("writev"))
		return -1;
	const ssize_t size = REAL(writev)(fd, parts, count);
	if (getenv("NT_CALLS_SPOIL") && size > 0 && pwrite(fd, "?", 1, lseek(fd, 0, SEEK_CUR) - size) != 1)
		_exit(98);
	return size;
}

int ioctl(int fd, unsigned long request, ...)
{
	va_list arguments;
	va_start(arguments, request);
	const int from = va_arg(arguments, int);
	va_end(arguments);
	const off_t size = getenv("NT_CALLS_CLONE") && enter("ioctl") ? lseek(from, 0, SEEK_END) : -1;
	return size >= 0 && copy_file_range(from, &(off_t){0}, fd, &(off_t){0}, (size_t)size, 0) == size ? 0 : -1;
}

int open(const char *path, int flags, ...)
{
	va_list arguments;
	va_start(arguments, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
	va_end(arguments);
	if (!(flags & O_CREAT))
		return REAL(open)(path, flags);
	const int fd = enter("open") ? REAL(open)(path, flags, mode) : -1;
	if (fd >= 0)
		note_name("create", AT_FDCWD, path);
	return fd;
}

int openat(int folder, const char *path, int flags, ...)
{
	va_list arguments;
	va_start(arguments, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
	va_end(arguments);
	if (!(flags & O_CREAT))
		return REAL(openat)(folder, path, flags);
	const int fd = enter("open") ? REAL(openat)(folder, path, flags, mode) : -1;
	if (fd >= 0)
		note_name("create", folder, path);
	return fd;
}

int fsync(int fd)
{
	if (!enter("fsync"))
		return -1;
	note_sync(fd);
	return 0;
}

static int renamed(int result, const char *from, const char *to)
{
	if (result == 0)
		note("rename\t%s\t%s\n", from, to);
	return result;
}

int rename(const char *from, const char *to)
{
	const bool allowed = enter("rename") && !is_kept(from) && !is_kept(to);
	return renamed(allowed ? REAL(rename)(from, to) : -1, from, to);
}

int renameat(int from_folder, const char *from, int to_folder, const char *to)
{
	const bool allowed = enter("rename") && !is_kept(from) && !is_kept(to);
	return renamed(allowed ? REAL(renameat)(from_folder, from, to_folder, to) : -1, from, to);
}

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags)
{
	const bool allowed = enter("renameat2") && !is_kept(from) && !is_kept(to);
	return renamed(allowed ? REAL(renameat2)(from_folder, from, to_folder, to, flags) : -1, from, to);
}

int link(const char *from, const char *to)
{
	const int result = enter("link") && !is_kept(from) ? REAL(link)(from, to) : -1;
	if (result == 0)
		note_name("link", AT_FDCWD, to);
	return result;
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
	const int result =
		enter("link") && !is_kept(from) ? REAL(linkat)(from_folder, from, to_folder, to, flags) : -1;
	if (result == 0)
		note_name("link", to_folder, to);
	return result;
}

int unlinkat(int folder, const char *path, int flags)
{
	const int result = enter("unlink") && !is_kept(path) ? REAL(unlinkat)(folder, path, flags) : -1;
	if (result == 0)
		note("unlink\t%s\n", path);
	return result;
}

int unlink(const char *path)
{
	const int result = enter("unlink") && !is_kept(path) ? REAL(unlink)(path) : -1;
	if (result == 0)
		note("unlink\t%s\n", path);
	return result;
}

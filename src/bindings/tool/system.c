/* SPDX-License-Identifier: MIT */
/*
 * The system calls that emscripten's C library lacks, or makes otherwise than the tool needs: what fstat() says of a
 * file that was renamed, times of less than a second, links, and bytes that are on the disk. Each calls a function of
 * the object `system` that nmtan.js gives to the module; a page gives none, and its files in memory know a second best.
 */
#include <emscripten.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

enum { FIELDS = 14 };

// clang-format off
/* The result of a call of JavaScript, or an error number below 0. */
EM_JS(int, call_system, (const char *name, const char *from, const char *to, int fd), {
	var system = Module["system"];
	var call = system && system[UTF8ToString(name)];
	if (!call)
		return -ERRNO_CODES.ENOSYS;
	try {
		call(UTF8ToString(from), UTF8ToString(to), fd);
		return 0;
	} catch (error) {
		return -(ERRNO_CODES[error.code] || ERRNO_CODES.EIO);
	}
})

/* A path, or NULL and a file that is open. */
EM_JS(int, read_status, (const char *path, int fd, int follow, double *fields), {
	try {
		var system = Module["system"];
		var name = path ? UTF8ToString(path) : null;
		var stream = path ? null : FS.getStream(fd);
		if (!path && !stream)
			return -ERRNO_CODES.EBADF;
		var s;
		if (system) {
			s = system.status(name, fd, follow);
		} else {
			var a = path ? FS.stat(name, !follow) : stream.node.node_ops.getattr(stream.node);
			var time = a.mtime.getTime();
			s = [a.dev, a.ino, 0, a.mode, a.nlink, a.uid, a.gid, a.size,
				Math.floor(time / 1000), time % 1000 * 1e6];
		}
		for (var i = 0; i < s.length; i++)
			HEAPF64[(fields >> 3) + i] = s[i];
		return 0;
	} catch (error) {
		return -(error.errno > 0 ? error.errno : ERRNO_CODES[error.code] || ERRNO_CODES.EIO);
	}
})
/* A second descriptor of an open file; emscripten's own would create the file once more. */
EM_JS(int, second_descriptor, (int fd), {
	try {
		var stream = FS.getStream(fd);
		if (fd > 2)
			return FS.open(stream.path, 0).fd;
		var free = FS.nextfd(3);
		FS.streams[free] = Object.assign(Object.create(Object.getPrototypeOf(stream)), stream, {fd: free});
		return free;
	} catch (error) {
		return -(error.errno > 0 ? error.errno : ERRNO_CODES.EBADF);
	}
})

EM_JS(int, process_number, (void), {
	return Module["system"] ? Module["system"].process : 42;
})
// clang-format on

static int result_of(int code)
{
	if (code >= 0)
		return code;
	errno = -code;
	return -1;
}

static int status_of(const char *path, int fd, bool follow, struct stat *status)
{
	double f[FIELDS] = {0};
	const int code = read_status(path, fd, follow, f);
	if (code < 0)
		return result_of(code);
	*status = (struct stat){
		.st_dev = (dev_t)f[0],
		.st_ino = (ino_t)f[1] | (ino_t)f[2] << 32,
		.st_mode = (mode_t)f[3],
		.st_nlink = (nlink_t)f[4],
		.st_uid = (uid_t)f[5],
		.st_gid = (gid_t)f[6],
		.st_size = (off_t)f[7],
		.st_blksize = 4096,
		.st_blocks = (blkcnt_t)((f[7] + 511) / 512),
	};
	status->st_mtim = (struct timespec){(time_t)f[8], (long)f[9]};
	status->st_ctim = f[10] != 0 ? (struct timespec){(time_t)f[10], (long)f[11]} : status->st_mtim;
	status->st_atim = status->st_mtim;
	return 0;
}

int stat(const char *restrict path, struct stat *restrict status)
{
	return status_of(path, -1, true, status);
}

int lstat(const char *restrict path, struct stat *restrict status)
{
	return status_of(path, -1, false, status);
}

int fstat(int fd, struct stat *status)
{
	return status_of(NULL, fd, true, status);
}

int fsync(int fd)
{
	const int code = call_system("sync", "", "", fd);
	return code == -ENOSYS ? 0 : result_of(code);
}

int link(const char *from, const char *to)
{
	return result_of(call_system("link", from, to, -1));
}

/* The tool asks for no more of it. */
int fcntl(int fd, int command, ...)
{
	if (command == F_DUPFD_CLOEXEC)
		return result_of(second_descriptor(fd));
	if (command == F_GETFD)
		return 0;
	errno = ENOTSUP;
	return -1;
}

pid_t getpid(void)
{
	return process_number();
}

/* No system of JavaScript has it: callers make a link instead, or an empty file that takes the name. */
int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags)
{
	(void)from_folder, (void)from, (void)to_folder, (void)to, (void)flags;
	errno = ENOSYS;
	return -1;
}

/* The tool asks for the present time alone. */
int utimensat(int folder, const char *path, const struct timespec times[2], int flags)
{
	(void)folder, (void)times, (void)flags;
	const int code = call_system("touch", path, "", -1);
	return code == -ENOSYS ? 0 : result_of(code);
}

/* ---- what is refused ---- */

static int refuse(void)
{
	errno = ENOTSUP;
	return -1;
}

/* Blocks that files share. Emscripten's own ends the process. */
int ioctl(int fd, int request, ...)
{
	(void)fd, (void)request;
	return refuse();
}

/* Room for a file: its writes find out. */
int fallocate(int fd, int mode, off_t offset, off_t size)
{
	(void)fd, (void)mode, (void)offset, (void)size;
	return refuse();
}

/* Locks. Leftovers of others look like files that they are writing, and stay. */
int flock(int fd, int operation)
{
	(void)fd, (void)operation;
	return refuse();
}

/* Attributes of files, access lists among them. */
ssize_t listxattr(const char *path, char *list, size_t size)
{
	(void)path, (void)list, (void)size;
	return refuse();
}

ssize_t getxattr(const char *path, const char *name, void *value, size_t size)
{
	(void)path, (void)name, (void)value, (void)size;
	return refuse();
}

int fsetxattr(int fd, const char *name, const void *value, size_t size, int flags)
{
	(void)fd, (void)name, (void)value, (void)size, (void)flags;
	return refuse();
}

int fremovexattr(int fd, const char *name)
{
	(void)fd, (void)name;
	return refuse();
}

/* A variable of the other C++ library, which ext/modules/cxx.cpp looks at. */
void *once_callable __asm__("_ZSt15__once_callable");

/* SPDX-License-Identifier: MIT */
/*
 * Inputs: a regular file is mapped, anything else (pipe, terminal, device, a file without a size as
 * /proc has them) is read to its end. The descriptor of a mapped file stays open: watch.c asks it for changes.
 *
 * A file that another process changes while it is mapped is no input: see watch.c.
 */
#include "file/input.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/deadline.h"
#include "base/memory.h"

enum { FIRST_READ_BYTES = 64 * 1024 };

#ifndef MADV_POPULATE_READ
#define MADV_POPULATE_READ MADV_WILLNEED
#endif

static const unsigned char no_bytes[1]; /* where the data of an empty input points */

/* Waits for bytes, or the end, of what may let a thread with a deadline wait. False: the deadline has passed. */
static bool wait_for_bytes(int fd)
{
	enum { STEP_MILLISECONDS = 25 }; /* a deadline wakes nobody */
	struct pollfd waited = {.fd = fd, .events = POLLIN};
	while (nt_deadline_own() && !nt_deadline_passed() && poll(&waited, 1, STEP_MILLISECONDS) == 0)
		;
	return !nt_deadline_passed();
}

/* Reads a descriptor to its end. */
static nt_status read_all(nt_file *file, int fd, const char *path, nt_error *error)
{
	unsigned char *data = NULL;
	size_t size = 0, capacity = 0;
	for (;;) {
		size_t needed;
		if (!nt_size_add(size, size ? 1 : FIRST_READ_BYTES, &needed) ||
			!nt_grow((void **)&data, &capacity, needed, 1) || !wait_for_bytes(fd)) {
			free(data);
			nt_fail_memory(error);
			return nt_error_in_file(error, path);
		}
		const ssize_t count = read(fd, data + size, capacity - size);
		if (count < 0 && errno == EINTR)
			continue;
		if (count < 0) {
			const int number = errno;
			free(data);
			return nt_lookup_failed(path, number, error);
		}
		if (count == 0)
			break;
		size += (size_t)count;
	}
	if (!size)
		free(data);
	file->data = size ? data : no_bytes;
	file->size = size;
	return NT_OK;
}

/* Maps what can be mapped; false: it has to be read. */
static bool map_all(nt_file *file, int fd, const char *path, const struct stat *status)
{
	if (!S_ISREG(status->st_mode) || status->st_size <= 0 ||
		(uintmax_t)status->st_size > SIZE_MAX / 2 || lseek(fd, 0, SEEK_CUR) != 0)
		return false;
	const size_t size = (size_t)status->st_size;
	void *data = mmap(NULL, size, PROT_READ, MAP_PRIVATE, fd, 0);
	if (data == MAP_FAILED)
		return false;
	file->watch = nt_watch_begin(data, status, fd, path);
	if (file->watch < 0) {
		munmap(data, size);
		return false;
	}
	file->data = data;
	file->size = size;
	file->mapped = true;
	file->fd = fd;
	return true;
}

/* Maps or reads what has been opened, and has no end that is not known. */
static nt_status take_bytes(nt_file *file, int fd, const char *path, bool standard, bool referred, nt_error *error)
{
	struct stat status;
	if (fstat(fd, &status) != 0)
		return nt_lookup_failed(path, errno, error);
	if (referred && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
		nt_trace_note(NT_TRACE_MISSING, path, NULL, NULL);
		return nt_fail_file(error, NT_ERROR_MISSING, path, "cannot read: it is no regular file");
	}
	if (!standard) {
		file->device = (uint64_t)status.st_dev;
		file->inode = (uint64_t)status.st_ino;
		nt_trace_note(NT_TRACE_READ, path, NULL, &status);
	}
	if (map_all(file, fd, path, &status))
		return NT_OK;
	if (S_ISDIR(status.st_mode))
		return nt_lookup_failed(path, EISDIR, error);
	if (!standard && !S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode) && !S_ISSOCK(status.st_mode))
		return nt_fail_file(error, NT_ERROR_IO, path, "cannot read: it is a device");
	return read_all(file, fd, path, error);
}

/* `referred`: by a document, which must not make the run wait for the writer of a pipe. Nor is a thread with a deadline
 * to wait for one: it opens the pipe first, and waits for bytes. */
static nt_status open_file(nt_file *file, const char *path, bool referred, nt_error *error)
{
	*file = (nt_file){.data = no_bytes, .fd = -1};
	const bool standard = !referred && strcmp(path, "-") == 0;
	const bool waits = !referred && !nt_deadline_own();
	const int flags = O_RDONLY | O_CLOEXEC | (waits ? 0 : O_NONBLOCK) | (referred ? O_NOCTTY : 0);
	int fd;
	do /* a file system over a network may be interrupted */
		fd = standard ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0) : open(path, flags);
	while (fd < 0 && errno == EINTR);
	if (fd < 0)
		return nt_lookup_failed(path, errno, error);
	if (!standard && !waits)
		fcntl(fd, F_SETFL, 0);
	const nt_status status = take_bytes(file, fd, path, standard, referred, error);
	if (!file->mapped)
		close(fd);
	return status;
}

nt_status nt_file_open(nt_file *file, const char *path, nt_naming naming, nt_error *error)
{
	static const char pointer[] = "version https://git-lfs.github.com/spec/";
	const bool ours = naming == NT_NAMED_BY_US;
	nt_trace *trace = ours ? nt_trace_use(NULL) : NULL;
	const nt_status status = open_file(file, path, naming == NT_NAMED_BY_DOCUMENT, error);
	if (ours)
		nt_trace_use(trace);
	if (status || ours || file->size < sizeof pointer - 1 || memcmp(file->data, pointer, sizeof pointer - 1) != 0)
		return status;
	nt_file_close(file);
	return nt_fail_file(error, NT_ERROR_MISSING, path,
		"Git LFS's pointer to the file, not the file itself: git lfs pull brings it");
}

bool nt_is_folder(const char *path)
{
	struct stat info;
	return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

nt_file nt_file_of_bytes(const unsigned char *bytes, size_t size)
{
	return (nt_file){.data = bytes, .size = size, .borrowed = true, .fd = -1};
}

bool nt_file_is_intact(const nt_file *file)
{
	return !file->mapped || !nt_watch_is_shortened(file->watch);
}

void nt_file_close(nt_file *file)
{
	if (file->mapped)
		munmap((void *)(uintptr_t)file->data, file->size);
	else if (!file->borrowed && file->data != no_bytes)
		free((void *)(uintptr_t)file->data);
	if (file->mapped) {
		nt_watch_end(file->watch);
		close(file->fd);
	}
	*file = (nt_file){.data = no_bytes, .fd = -1};
}

/* Advice on the whole pages that hold a range. */
static void advise(const nt_file *file, size_t offset, size_t size, int advice)
{
	const size_t page = (size_t)sysconf(_SC_PAGESIZE), begin = offset / page * page;
	if (file->mapped && size)
		madvise((void *)(uintptr_t)(file->data + begin), offset + size - begin, advice);
}

/* Brings the pages of a range in at once, which costs less than a fault for every few of them. */
static void fetch(const nt_file *file, size_t offset, size_t size)
{
	advise(file, offset, size, MADV_POPULATE_READ);
}

void nt_file_release(const nt_file *file, size_t offset, size_t size)
{
	advise(file, offset, size, MADV_DONTNEED);
}

bool nt_file_is(const nt_file *file, const char *path)
{
	struct stat status;
	return file->inode && strcmp(path, "-") != 0 && stat(path, &status) == 0 &&
	       nt_same_id(nt_file_id_of(&status), (nt_file_id){file->device, file->inode});
}

/* ---- whole files ---- */

/* Files are compared in parts that are let go of, so that large ones do not fill the memory. */
enum { COMPARED_BYTES = 2 * 1024 * 1024 };

/* Opens what may be somebody else's: *opened is false where we are not allowed to or it is gone. */
static nt_status open_foreign(nt_file *file, const char *path, bool *opened, nt_error *error)
{
	*opened = false;
	if (access(path, R_OK) != 0)
		return NT_OK;
	const nt_status status = nt_file_open(file, path, NT_NAMED_BY_US, error);
	*opened = status == NT_OK;
	return status;
}

nt_status nt_same_bytes(const char *a, const char *b, bool *same, nt_error *error)
{
	nt_file x, y;
	bool opened;
	*same = false;
	nt_status status = open_foreign(&x, a, &opened, error);
	if (!opened)
		return status;
	status = open_foreign(&y, b, &opened, error);
	if (opened) {
		*same = x.size == y.size;
		for (size_t at = 0, part; *same && at < x.size; at += part) {
			part = x.size - at < COMPARED_BYTES ? x.size - at : COMPARED_BYTES;
			fetch(&x, at, part);
			fetch(&y, at, part);
			*same = memcmp(x.data + at, y.data + at, part) == 0;
			nt_file_release(&x, at, part);
			nt_file_release(&y, at, part);
		}
		nt_file_close(&y);
	}
	nt_file_close(&x);
	return status;
}

nt_status nt_digest_of_file(const char *path, char text[NT_DIGEST_TEXT], nt_error *error)
{
	nt_file file;
	bool opened;
	text[0] = '\0';
	const nt_status status = open_foreign(&file, path, &opened, error);
	if (!opened)
		return status;
	nt_digest *digest = nt_digest_create();
	for (size_t at = 0, part; digest && at < file.size; at += part) {
		part = file.size - at < COMPARED_BYTES ? file.size - at : COMPARED_BYTES;
		fetch(&file, at, part);
		nt_digest_add(digest, file.data + at, part);
		nt_file_release(&file, at, part);
	}
	nt_file_close(&file);
	if (digest)
		nt_digest_text(digest, text);
	nt_digest_free(digest);
	return digest ? NT_OK : nt_fail_memory(error);
}

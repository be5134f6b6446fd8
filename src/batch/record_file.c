/* SPDX-License-Identifier: MIT */
/*
 * The file of a record: see record_file.h.
 *
 * A process that appends or rewrites locks the file, by a lock of the open file that network file systems know, too.
 * If there are no locks, appending goes on without (O_APPEND is enough on local disks), and nothing is rewritten. A
 * rewritten file is another one: who has waited for the lock of the old one opens it again.
 */
#include "batch/record_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/memory.h"
#include "file/input.h"
#include "file/output.h"

/* Below so many superseded lines nothing is rewritten; how often a file may be replaced while we wait for it. */
enum { FEW_LINES = 100, MOST_ATTEMPTS = 100 };

static nt_status fail(const nt_record_file *file, int number, nt_error *error)
{
	if (number == ENOMEM)
		return nt_fail_memory(error);
	return nt_fail_file(error, NT_ERROR_IO, file->path, "cannot write the record: %s", strerror(number));
}

/* ---- reading ---- */

static uint32_t find(const nt_record_file *file, uint64_t hash, const char *key, size_t length)
{
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i; (i = nt_hash_index_next(&file->index, hash, &at)) != UINT32_MAX;) {
		const nt_record_line *line = &file->lines[i];
		if (line->key_length == length &&
			memcmp(file->text + line->offset + strlen(file->prefix), key, length) == 0)
			return i;
	}
	return UINT32_MAX;
}

/* A line, without its line feed. */
static nt_status add_line(nt_record_file *file, size_t offset, size_t length, nt_error *error)
{
	const size_t head = strlen(file->prefix);
	const char *key = file->text + offset + head;
	if (length <= head || memcmp(file->text + offset, file->prefix, head) != 0)
		return NT_OK;
	const char *end = memchr(key, '"', length - head);
	if (!end || (file->is_whole && !file->is_whole(file->text + offset, length)))
		return NT_OK;
	const nt_record_line line = {offset, length, (size_t)(end - key)};
	const uint64_t hash = nt_hash_bytes(0, key, line.key_length);
	const uint32_t known = find(file, hash, key, line.key_length);
	if (known != UINT32_MAX) {
		file->lines[known] = line;
		file->superseded_count++;
		return NT_OK;
	}
	if (!nt_grow((void **)&file->lines, &file->line_capacity, file->line_count + 1, sizeof line) ||
		!nt_hash_index_add(&file->index, hash, (uint32_t)file->line_count))
		return nt_fail_memory(error);
	file->lines[file->line_count++] = line;
	return NT_OK;
}

static void forget(nt_record_file *file)
{
	free(file->text);
	free(file->lines);
	nt_hash_index_free(&file->index);
	*file = (nt_record_file){.path = file->path, .prefix = file->prefix, .is_whole = file->is_whole};
}

/* A copy of the file's bytes: others append to it. Bytes after the last line feed are half a line of a process
 * that was killed. */
static nt_status read_text(nt_record_file *file, nt_error *error)
{
	nt_file input;
	struct stat info;
	if (stat(file->path, &info) != 0 && errno == ENOENT)
		return NT_OK;
	nt_status status = nt_file_open_untraced(&input, file->path, error);
	if (status)
		return status;
	file->text = nt_alloc(input.size + 1, 1);
	if (file->text) {
		memcpy(file->text, input.data, input.size);
		file->size = input.size;
	} else {
		status = nt_fail_memory(error);
	}
	nt_file_close(&input);
	return status;
}

static nt_status load(nt_record_file *file, nt_error *error)
{
	forget(file);
	nt_status status = read_text(file, error);
	const char *end;
	for (size_t at = 0; !status && at < file->size && (end = memchr(file->text + at, '\n', file->size - at));) {
		status = add_line(file, at, (size_t)(end - file->text) - at, error);
		at = (size_t)(end - file->text) + 1;
	}
	const size_t head = strlen(file->prefix), known = file->size < head ? file->size : head;
	if (!status && known && !file->line_count && memcmp(file->text, file->prefix, known) != 0)
		status = nt_fail_file(error, NT_ERROR_IO, file->path,
			"refusing to write: it is no record; delete it, or name another by --record=FILE");
	return status;
}

/* ---- the lock ---- */

/* Opens the file for appending, made where it is not there, and waits for its lock. *locked: it was to be had. Below
 * 0, with errno: failed. */
static int open_locked(const nt_record_file *file, bool *locked)
{
	for (int attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
		const int fd = open(file->path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
		if (fd < 0)
			return fd;
		struct stat here, there;
		struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
		do
			*locked = fcntl(fd, F_OFD_SETLKW, &lock) == 0;
		while (!*locked && errno == EINTR);
		if (!*locked || (fstat(fd, &here) == 0 && stat(file->path, &there) == 0 &&
			here.st_ino == there.st_ino && here.st_dev == there.st_dev))
			return fd;
		close(fd);
	}
	errno = EBUSY;
	return -1;
}

/* ---- writing ---- */

/* In one piece: what was written of it only in part is taken back. */
static bool append_whole(int fd, const char *bytes, size_t size, off_t before)
{
	ssize_t written;
	do
		written = write(fd, bytes, size);
	while (written < 0 && errno == EINTR);
	if (written == (ssize_t)size)
		return true;
	const int number = written < 0 ? errno : ENOSPC;
	if (written > 0 && ftruncate(fd, before) != 0) {
		/* half a line at the end is passed over by readers */
	}
	errno = number;
	return false;
}

nt_status nt_record_file_append(const nt_record_file *file, const void *lines, size_t size, nt_error *error)
{
	bool locked;
	struct stat info;
	const int fd = open_locked(file, &locked);
	if (fd < 0)
		return fail(file, errno, error);
	bool done = fstat(fd, &info) == 0;
	/* a line that was cut short must not become the beginning of this one */
	char last = '\n';
	if (done && info.st_size > 0 && pread(fd, &last, 1, info.st_size - 1) == 1 && last != '\n')
		done = write(fd, "\n", 1) == 1;
	if (done)
		done = append_whole(fd, lines, size, info.st_size);
	const int number = errno;
	close(fd);
	return done ? NT_OK : fail(file, number, error);
}

/* The lines that count take the place of the file. */
static nt_status write_anew(const nt_record_file *file, nt_error *error)
{
	nt_output *output;
	nt_sink *sink;
	nt_status status = nt_output_create(&output, NULL, error);
	if (status)
		return status;
	status = nt_output_add(output, file->path, NT_ROLE_MAIN, &sink, error);
	for (size_t i = 0; i < file->line_count && !status; i++)
		status = nt_sink_write(sink, file->text + file->lines[i].offset, file->lines[i].length + 1, error);
	if (!status)
		return nt_output_commit(output, error);
	nt_output_abort(output);
	return status;
}

/* With the lock nobody appends in between; without one, the file stays as long as it is. A failure leaves it so, too,
 * unless memory ends. */
static nt_status rewrite(nt_record_file *file, nt_error *error)
{
	bool locked;
	const int fd = open_locked(file, &locked);
	if (fd < 0)
		return NT_OK;
	nt_status status = NT_OK;
	if (locked)
		status = load(file, error);
	if (locked && !status && write_anew(file, error) == NT_ERROR_MEMORY)
		status = NT_ERROR_MEMORY;
	close(fd);
	return status;
}

nt_status nt_record_file_open(nt_record_file *file, const char *path, const char *prefix,
	bool (*is_whole)(const char *line, size_t length), bool tidy, nt_error *error)
{
	*file = (nt_record_file){.path = strdup(path), .prefix = prefix, .is_whole = is_whole};
	if (!file->path)
		return nt_fail_memory(error);
	nt_status status = load(file, error);
	if (!status && tidy && file->superseded_count > FEW_LINES && file->superseded_count > file->line_count / 2)
		status = rewrite(file, error);
	return status;
}

void nt_record_file_close(nt_record_file *file)
{
	forget(file);
	free(file->path);
	*file = (nt_record_file){0};
}

const char *nt_record_file_find(const nt_record_file *file, const char *key, size_t *length)
{
	const size_t key_length = strlen(key);
	const uint32_t i = find(file, nt_hash_bytes(0, key, key_length), key, key_length);
	if (i == UINT32_MAX)
		return NULL;
	*length = file->lines[i].length;
	return file->text + file->lines[i].offset;
}

/* SPDX-License-Identifier: MIT */
/*
 * The file of a record: see inside.h.
 *
 * A process that appends or rewrites locks the file, by a lock of the open file that network file systems know, too.
 * If there are no locks, appending goes on without (O_APPEND is enough on local disks), and nothing is rewritten. A
 * rewritten file is another one: who has waited for the lock of the old one opens it again.
 */
#include "batch/inside.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/memory.h"
#include "file/input.h"
#include "file/output.h"
#include "file/path.h"

/* Below so many superseded lines nothing is rewritten; how often a file may be replaced while we wait for it. */
enum { FEW_LINES = 100, MOST_ATTEMPTS = 100 };

static const char begin[] = NT_RECORD_BEGIN;
enum { BEGIN_BYTES = sizeof begin - 1, SUM_BYTES = sizeof ",\"sum\":\"0123456789abcdef\"}" - 1 };

static nt_status fail(const nt_record *record, int number, const char *then, nt_error *error)
{
	return nt_fail_file(error, NT_ERROR_IO, record->path, "cannot write the record: %s%s", strerror(number), then);
}

/* ---- lines ---- */

/* The end of a line of which there are `size` bytes. */
static void spell_sum(char sum[SUM_BYTES + 1], const char *line, size_t size)
{
	snprintf(sum, SUM_BYTES + 1, ",\"sum\":\"%016" PRIx64 "\"}", nt_hash_unkeyed(0, line, size));
}

void nt_record_end(nt_buffer *line)
{
	char sum[SUM_BYTES + 1];
	spell_sum(sum, line->data ? line->data : "", line->size);
	nt_buffer_format(line, "%s\n", sum);
}

const nt_name *nt_record_find(const nt_record *record, const nt_buffer *output)
{
	const uint32_t number = nt_name_find(&record->outputs, output->data, output->size);
	return number != UINT32_MAX ? &record->lines[number] : NULL;
}

/* Takes a line, if it counts, in place of an earlier one of its output. */
static nt_status add_line(nt_record *record, const char *text, size_t length, nt_error *error)
{
	char sum[SUM_BYTES + 1];
	const char *name = text + BEGIN_BYTES, *end;
	if (length < BEGIN_BYTES + SUM_BYTES || memcmp(text, begin, BEGIN_BYTES) != 0 ||
		!(end = memchr(name, '"', length - BEGIN_BYTES)))
		return NT_OK;
	spell_sum(sum, text, length - SUM_BYTES);
	if (memcmp(sum, text + length - SUM_BYTES, SUM_BYTES) != 0)
		return NT_OK;
	const size_t before = record->outputs.count;
	const uint32_t number = nt_grow((void **)&record->lines, &record->line_capacity, before + 1,
		sizeof *record->lines) ? nt_name_add(&record->outputs, name, (size_t)(end - name)) : UINT32_MAX;
	if (number == UINT32_MAX)
		return nt_fail_memory(error);
	record->lines[number] = (nt_name){text, length};
	record->superseded_count += number < before;
	return NT_OK;
}

/* ---- reading ---- */

static void forget(nt_record *record)
{
	free(record->text);
	free(record->lines);
	nt_name_table_free(&record->outputs);
	*record = (nt_record){.path = record->path};
}

/* A copy of the file's bytes: others append to it. */
static nt_status read_text(nt_record *record, nt_error *error)
{
	nt_file input;
	struct stat info;
	if (stat(record->path, &info) != 0 && errno == ENOENT)
		return NT_OK;
	nt_status status = nt_file_open(&input, record->path, NT_NAMED_BY_US, error);
	if (status)
		return status;
	record->text = nt_alloc(input.size + 1, 1);
	if (record->text) {
		memcpy(record->text, input.data, input.size);
		record->text[record->size = input.size] = '\0';
	} else {
		status = nt_fail_memory(error);
	}
	nt_file_close(&input);
	return status;
}

static nt_status load(nt_record *record, nt_error *error)
{
	forget(record);
	nt_status status = read_text(record, error);
	const char *const text = record->text, *end;
	for (size_t at = 0; !status && at < record->size && (end = memchr(text + at, '\n', record->size - at));) {
		status = add_line(record, text + at, (size_t)(end - text) - at, error);
		at = (size_t)(end - text) + 1;
	}
	const size_t known = record->size < BEGIN_BYTES ? record->size : BEGIN_BYTES;
	if (!status && known && !record->outputs.count && memcmp(text, begin, known) != 0)
		status = nt_fail_file(error, NT_ERROR_IO, record->path,
			"refusing to write: it is no record; delete it, or name another by --record=FILE");
	return status;
}

/* ---- the lock ---- */

/* Opens the file for appending, made where it is not there, and waits for its lock. *locked: it was to be had. Below
 * 0, with errno: failed. */
static int open_locked(const nt_record *record, bool *locked)
{
	for (int attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
		const int fd = open(record->path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
		if (fd < 0)
			return fd;
		struct stat here, there;
		struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
		do
			*locked = fcntl(fd, F_OFD_SETLKW, &lock) == 0;
		while (!*locked && errno == EINTR);
		if (!*locked ||
			(fstat(fd, &here) == 0 && stat(record->path, &there) == 0 && nt_same_file(&here, &there)))
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

nt_status nt_record_append(const nt_record *record, const void *lines, size_t size, nt_error *error)
{
	static const char then[] = "; the output stands, --update makes it again";
	bool locked;
	struct stat info;
	const int fd = open_locked(record, &locked);
	if (fd < 0)
		return fail(record, errno, then, error);
	bool done = fstat(fd, &info) == 0;
	/* a line that was cut short must not become the beginning of this one */
	char last = '\n';
	if (done && info.st_size > 0 && pread(fd, &last, 1, info.st_size - 1) == 1 && last != '\n')
		done = write(fd, "\n", 1) == 1;
	if (done)
		done = append_whole(fd, lines, size, info.st_size);
	const int number = errno;
	close(fd);
	return done ? NT_OK : fail(record, number, then, error);
}

/* The lines that count take the place of the file. */
static nt_status write_anew(const nt_record *record, nt_error *error)
{
	nt_output *output;
	nt_sink *sink;
	nt_status status = nt_output_create(&output, NULL, error);
	if (status)
		return status;
	status = nt_output_add(output, record->path, NT_ROLE_MAIN, &sink, error);
	for (size_t i = 0; i < record->outputs.count && !status; i++)
		status = nt_sink_write(sink, record->lines[i].text, record->lines[i].length + 1, error);
	return nt_output_end(output, status, error);
}

/* With the lock nobody appends in between; without one, the file stays as long as it is. A failure leaves it so, too,
 * unless memory ends. */
static nt_status rewrite(nt_record *record, nt_error *error)
{
	bool locked;
	const int fd = open_locked(record, &locked);
	if (fd < 0)
		return NT_OK;
	nt_status status = NT_OK;
	if (locked)
		status = load(record, error);
	if (locked && !status && write_anew(record, error) == NT_ERROR_MEMORY)
		status = NT_ERROR_MEMORY;
	close(fd);
	return status;
}

/* Said before anything is made; of a folder that is not there, the output is. */
static nt_status check_writable(const nt_record *record, nt_error *error)
{
	char folder[PATH_MAX];
	int failed = access(record->path, W_OK);
	if (failed && errno == ENOENT)
		failed = access(nt_folder_of(record->path, folder), W_OK);
	return failed && errno != ENOENT ? fail(record, errno, "", error) : NT_OK;
}

nt_status nt_record_open(nt_record *record, const char *path, bool writes, nt_error *error)
{
	*record = (nt_record){.path = strdup(path)};
	if (!record->path)
		return nt_fail_memory(error);
	nt_status status = load(record, error);
	if (!status && writes)
		status = check_writable(record, error);
	const size_t superseded = record->superseded_count;
	if (!status && writes && superseded > FEW_LINES && superseded > record->outputs.count / 2)
		status = rewrite(record, error);
	return status;
}

void nt_record_close(nt_record *record)
{
	forget(record);
	free(record->path);
	*record = (nt_record){0};
}

/* SPDX-License-Identifier: MIT */
/*
 * Looking for files, and the trace of those that a run reads and writes: see input.h.
 */
#include "file/input.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include "base/memory.h"
#include "base/text.h"

/* ---- looking for files ---- */

nt_status nt_lookup_failed(const char *path, int number, nt_error *error)
{
	if (number == ENOENT)
		nt_fail(error, NT_ERROR_MISSING, "no such file");
	else if (number == ENOTDIR || number == ENAMETOOLONG)
		nt_fail(error, NT_ERROR_MISSING, "no such file: %s", strerror(number));
	else if (number == EISDIR)
		nt_fail(error, NT_ERROR_MISSING, "cannot read: %s", strerror(number));
	else if (number == ENOMEM)
		nt_fail_memory(error);
	else
		nt_fail(error, NT_ERROR_IO, "cannot read: %s", strerror(number));
	/* what has too long a name will not come to be */
	if (error->status == NT_ERROR_MISSING && number != ENAMETOOLONG)
		nt_trace_note(NT_TRACE_MISSING, path, NULL, NULL);
	return nt_error_in_file(error, path);
}

bool nt_name_is_too_long(const char *name)
{
	return strnlen(name, PATH_MAX) == PATH_MAX;
}

nt_status nt_lookup(const char *path, struct stat *info, nt_error *error)
{
	return stat(path, info) == 0 ? NT_OK : nt_lookup_failed(path, errno, error);
}

nt_status nt_lookup_found(const char *path, struct stat *info, bool *found, nt_error *error)
{
	nt_error failure;
	const nt_status status = nt_lookup(path, info, &failure);
	*found = status == NT_OK;
	if (status == NT_OK || status == NT_ERROR_MISSING)
		return NT_OK;
	if (error)
		*error = failure;
	return status;
}

static nt_status find_entry(
	DIR *dir, const char *name, size_t length, char **entry, nt_error *error)
{
	for (const struct dirent *e; dir && (e = readdir(dir));) {
		if (strlen(e->d_name) != length || strncasecmp(e->d_name, name, length) != 0 ||
			(*entry && strcmp(e->d_name, *entry) > 0))
			continue;
		free(*entry);
		*entry = strdup(e->d_name);
		if (!*entry)
			return nt_fail_memory(error);
	}
	return NT_OK;
}

nt_status nt_lookup_any_case(
	const char *folder, const char *name, size_t length, char **entry, nt_error *error)
{
	struct stat info = {0}; /* as it was before it is read */
	*entry = NULL;
	DIR *dir = opendir(*folder ? folder : "/");
	if (!dir && errno == ENOMEM)
		return nt_fail_memory(error);
	if (dir && fstat(dirfd(dir), &info) != 0)
		info = (struct stat){0};
	nt_status status = find_entry(dir, name, length, entry, error);
	if (dir)
		closedir(dir);
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s/%.*s", folder, (int)length, name);
	if (!path.failed)
		nt_trace_note(NT_TRACE_SEARCHED, path.data, *entry, &info);
	else if (!status)
		status = nt_fail_memory(error);
	nt_buffer_free(&path);
	if (status) {
		free(*entry);
		*entry = NULL;
	}
	return status;
}

/* ---- the trace ---- */

static _Thread_local nt_trace *current;

/* One lock for all traces: noting takes less than the system call that is noted. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

nt_trace *nt_trace_use(nt_trace *trace)
{
	nt_trace *before = current;
	current = trace;
	return before;
}

/* ---- what others read ---- */

void nt_trace_share(nt_trace *trace, nt_readers *readers)
{
	pthread_mutex_lock(&lock);
	trace->readers = readers;
	trace->reader = readers ? ++readers->runs : 0;
	pthread_mutex_unlock(&lock);
}

void nt_readers_free(nt_readers *readers)
{
	free(readers->readers);
	nt_key_set_free(&readers->files);
	*readers = (nt_readers){0};
}

static bool add_read(nt_readers *readers, unsigned reader, const struct stat *info)
{
	const nt_file_id id = nt_file_id_of(info);
	const size_t count = readers->files.count;
	if (!nt_grow((void **)&readers->readers, &readers->capacity, count + 1, sizeof reader))
		return false;
	const uint32_t number = nt_key_add(&readers->files, &id, sizeof id);
	if (number != UINT32_MAX)
		readers->readers[number] = number == count || readers->readers[number] == reader ? reader : 0;
	return number != UINT32_MAX;
}

bool nt_trace_is_read_elsewhere(const struct stat *info)
{
	if (!current || !current->readers)
		return false;
	const nt_readers *readers = current->readers;
	const nt_file_id id = nt_file_id_of(info);
	pthread_mutex_lock(&lock);
	const uint32_t number = nt_key_find(&readers->files, &id, sizeof id);
	const bool elsewhere = number != UINT32_MAX && readers->readers[number] != current->reader;
	pthread_mutex_unlock(&lock);
	return elsewhere;
}

/* ---- times ---- */

static int64_t nanoseconds(struct timespec time)
{
	return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

int64_t nt_trace_modified(const struct stat *info)
{
	return nanoseconds(info->st_mtim);
}

int64_t nt_trace_changed(const struct stat *info)
{
	return nanoseconds(info->st_ctim);
}

static int64_t now_in_nanoseconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_REALTIME, &now);
	return nanoseconds(now);
}

static bool is_noted(const nt_trace *trace, uint64_t hash, nt_trace_kind kind, const char *path)
{
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i; (i = nt_hash_index_next(&trace->index, hash, &at)) != UINT32_MAX;)
		if (i < trace->count && trace->files[i].kind == kind && strcmp(trace->files[i].path, path) == 0)
			return true;
	return false;
}

static void free_file(nt_trace_file *file)
{
	free(file->path);
	free(file->found);
}

static bool add(nt_trace *trace, uint64_t hash, const nt_trace_file *file)
{
	nt_trace_file added = *file;
	added.path = strdup(file->path);
	added.found = file->found ? strdup(file->found) : NULL;
	const bool made = added.path && (added.found || !file->found) &&
		nt_grow((void **)&trace->files, &trace->capacity, trace->count + 1, sizeof added) &&
		nt_hash_index_add(&trace->index, hash, (uint32_t)trace->count);
	if (made)
		trace->files[trace->count++] = added;
	else
		free_file(&added);
	return made;
}

void nt_trace_note(nt_trace_kind kind, const char *path, const char *found, const struct stat *info)
{
	nt_trace *trace = current;
	if (!trace)
		return;
	nt_trace_file file = {.path = (char *)(uintptr_t)path, .kind = kind, .found = (char *)(uintptr_t)found,
		.noted = now_in_nanoseconds()};
	if (info) {
		file.size = (uint64_t)info->st_size;
		file.inode = (uint64_t)info->st_ino;
		file.modified = nt_trace_modified(info);
		file.changed = nt_trace_changed(info);
	}
	const uint64_t hash = nt_hash_bytes((uint64_t)kind, path, strlen(path));
	pthread_mutex_lock(&lock);
	if (!trace->failed && !is_noted(trace, hash, kind, path))
		trace->failed = !add(trace, hash, &file) ||
			(kind == NT_TRACE_READ && trace->readers && !add_read(trace->readers, trace->reader, info));
	pthread_mutex_unlock(&lock);
}

/* Nothing but these comes after them. Their numbers stay in the index, and are given again. */
void nt_trace_forget_written(nt_trace *trace)
{
	while (trace->count && trace->files[trace->count - 1].kind == NT_TRACE_WRITTEN)
		free_file(&trace->files[--trace->count]);
}

void nt_trace_free(nt_trace *trace)
{
	for (size_t i = 0; i < trace->count; i++)
		free_file(&trace->files[i]);
	free(trace->files);
	nt_hash_index_free(&trace->index);
	*trace = (nt_trace){0};
}

/* SPDX-License-Identifier: MIT */
/*
 * Files that a run reads and writes: see trace.h.
 */
#include "file/trace.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/memory.h"

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

struct nt_read_file {
	uint64_t device, inode;
	unsigned reader; /* 0: several */
};

void nt_trace_share(nt_trace *trace, nt_readers *readers)
{
	pthread_mutex_lock(&lock);
	trace->readers = readers;
	trace->reader = readers ? ++readers->runs : 0;
	pthread_mutex_unlock(&lock);
}

void nt_readers_free(nt_readers *readers)
{
	free(readers->files);
	nt_hash_index_free(&readers->index);
	*readers = (nt_readers){0};
}

static struct nt_read_file *find_read(const nt_readers *readers, const uint64_t key[2], uint64_t *hash)
{
	size_t at = NT_HASH_BEGIN;
	*hash = nt_hash_bytes(0, key, 2 * sizeof *key);
	for (uint32_t i; (i = nt_hash_index_next(&readers->index, *hash, &at)) != UINT32_MAX;)
		if (readers->files[i].device == key[0] && readers->files[i].inode == key[1])
			return &readers->files[i];
	return NULL;
}

static bool add_read(nt_readers *readers, unsigned reader, const struct stat *info)
{
	uint64_t hash;
	const uint64_t key[2] = {(uint64_t)info->st_dev, (uint64_t)info->st_ino};
	struct nt_read_file *file = find_read(readers, key, &hash);
	if (file) {
		file->reader = file->reader == reader ? reader : 0;
		return true;
	}
	if (!nt_grow((void **)&readers->files, &readers->capacity, readers->count + 1, sizeof *readers->files) ||
		!nt_hash_index_add(&readers->index, hash, (uint32_t)readers->count))
		return false;
	readers->files[readers->count++] = (struct nt_read_file){key[0], key[1], reader};
	return true;
}

bool nt_trace_is_read_elsewhere(const struct stat *info)
{
	if (!current || !current->readers)
		return false;
	uint64_t hash;
	const uint64_t key[2] = {(uint64_t)info->st_dev, (uint64_t)info->st_ino};
	pthread_mutex_lock(&lock);
	const struct nt_read_file *file = find_read(current->readers, key, &hash);
	const bool elsewhere = file && file->reader != current->reader;
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

int64_t nt_trace_now(void)
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
	if (!nt_grow((void **)&trace->files, &trace->capacity, trace->count + 1, sizeof *trace->files) ||
		!nt_hash_index_add(&trace->index, hash, (uint32_t)trace->count))
		return false;
	nt_trace_file *added = &trace->files[trace->count];
	*added = *file;
	added->path = strdup(file->path);
	added->found = file->found ? strdup(file->found) : NULL;
	if (added->path && (added->found || !file->found)) {
		trace->count++;
		return true;
	}
	/* the index has a number that nothing stands behind */
	free_file(added);
	return false;
}

static void note(nt_trace_kind kind, const char *path, const char *found, const struct stat *info)
{
	nt_trace *trace = current;
	if (!trace)
		return;
	nt_trace_file file = {.path = (char *)(uintptr_t)path, .kind = kind, .found = (char *)(uintptr_t)found,
		.noted = nt_trace_now()};
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

void nt_trace_read(const char *path, const struct stat *info)
{
	note(NT_TRACE_READ, path, NULL, info);
}

void nt_trace_missing(const char *path)
{
	note(NT_TRACE_MISSING, path, NULL, NULL);
}

void nt_trace_written(const char *path, const struct stat *info)
{
	note(NT_TRACE_WRITTEN, path, NULL, info);
}

void nt_trace_link(const char *path, const char *real)
{
	note(NT_TRACE_LINK, path, real, NULL);
}

void nt_trace_outside(const char *path, const char *name)
{
	note(NT_TRACE_OUTSIDE, path, name, NULL);
}

void nt_trace_searched(const char *path, const char *found, const struct stat *info)
{
	note(NT_TRACE_SEARCHED, path, found, info);
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

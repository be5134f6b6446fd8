/* SPDX-License-Identifier: MIT */
/*
 * A file of large blocks: see spill.h. It has lost its name before anything is written, so that nobody has to remove
 * it. Whatever the system refuses (space, maps) leaves a block in memory.
 */
#include "file/spill.h"

#include <pthread.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>
#include "base/memory.h"
#include "file/temporary.h"

/* What is smaller stays in memory: a thousand of them take less than one image being decoded. */
enum { SPILLED_BYTES = 256 * 1024 };

typedef struct block {
	unsigned char *bytes;
	size_t size;
	bool mapped;
} block;

struct nt_spill {
	const char *target;
	pthread_mutex_t lock;
	int fd; /* -1: no file yet */
	size_t end;
	block *blocks;
	size_t count, capacity;
};

nt_spill *nt_spill_create(const char *target)
{
	nt_spill *s = nt_calloc(1, sizeof *s);
	if (!s)
		return NULL;
	s->target = target;
	s->fd = -1;
	pthread_mutex_init(&s->lock, NULL);
	return s;
}

void nt_spill_free(nt_spill *s)
{
	if (!s)
		return;
	for (size_t i = 0; i < s->count; i++)
		if (s->blocks[i].mapped)
			munmap(s->blocks[i].bytes, s->blocks[i].size);
		else
			free(s->blocks[i].bytes);
	if (s->fd >= 0)
		close(s->fd);
	free(s->blocks);
	pthread_mutex_destroy(&s->lock);
	free(s);
}

static size_t page_size(void)
{
	return (size_t)sysconf(_SC_PAGESIZE);
}

/* Reserves a range that begins with a page, in the file that is made for the first; -1: there is none. */
static int reserve(nt_spill *s, size_t size, size_t *at)
{
	pthread_mutex_lock(&s->lock);
	if (s->fd < 0 && s->target) {
		nt_temporary *temporary;
		s->fd = nt_temporary_create(s->target, 0600, &temporary);
		if (s->fd < 0)
			s->target = NULL;
		else
			nt_temporary_discard(temporary);
	}
	*at = s->end;
	s->end += (size + page_size() - 1) / page_size() * page_size();
	const int fd = s->fd;
	pthread_mutex_unlock(&s->lock);
	return fd;
}

static bool write_all(int fd, const unsigned char *bytes, size_t size, size_t at)
{
	while (size) {
		const ssize_t written = pwrite(fd, bytes, size, (off_t)at);
		if (written <= 0)
			return false;
		bytes += written;
		at += (size_t)written;
		size -= (size_t)written;
	}
	return true;
}

/* The bytes in the file; NULL: they are not there. */
static unsigned char *write_and_map(nt_spill *s, const unsigned char *bytes, size_t size)
{
	size_t at;
	const int fd = size >= SPILLED_BYTES ? reserve(s, size, &at) : -1;
	if (fd < 0 || !write_all(fd, bytes, size, at))
		return NULL;
	void *map = mmap(NULL, size, PROT_READ, MAP_PRIVATE, fd, (off_t)at);
	return map == MAP_FAILED ? NULL : map;
}

const unsigned char *nt_spill_take(nt_spill *s, unsigned char *bytes, size_t size)
{
	pthread_mutex_lock(&s->lock);
	const bool room = nt_grow((void **)&s->blocks, &s->capacity, s->count + 1, sizeof *s->blocks);
	const size_t number = s->count;
	if (room)
		s->blocks[s->count++] = (block){bytes, size, false};
	pthread_mutex_unlock(&s->lock);
	if (!room)
		return NULL;
	unsigned char *map = write_and_map(s, bytes, size);
	if (!map)
		return bytes;
	free(bytes);
	pthread_mutex_lock(&s->lock);
	s->blocks[number] = (block){map, size, true};
	pthread_mutex_unlock(&s->lock);
	return map;
}

void nt_spill_forget(const nt_spill *s, const unsigned char *bytes)
{
	for (size_t i = 0; i < s->count; i++)
		if (s->blocks[i].mapped && s->blocks[i].bytes == bytes)
			madvise(s->blocks[i].bytes, s->blocks[i].size, MADV_DONTNEED); /* a refusal changes nothing */
}

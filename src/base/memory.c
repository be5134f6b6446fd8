/* SPDX-License-Identifier: MIT */
/*
 * Checked allocation and the arena. The arena bumps requests through blocks of 4 KiB to 4 MiB, each twice as large as
 * the one before: a large arena is in large pages, of which each costs as much to begin as some ten small ones. A
 * request that is large beside the block gets one of its own.
 */
#include "base/memory.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include "base/deadline.h"

enum {
	LEAST_BLOCK_BYTES = 4 * 1024,
	MOST_BLOCK_BYTES = 4 * 1024 * 1024, /* the least that nt_alloc_large() has large pages for */
	LEAST_LARGE_BYTES = 8 * 1024,       /* of a request; in large blocks more is not large yet */
	LARGE_SHARE = 8,
	ALIGNMENT = 16
};

struct nt_arena_block {
	struct nt_arena_block *next;
	void *adopted; /* freed with the block */
	size_t used;
	size_t capacity;
};

enum { HEADER_BYTES = (sizeof(struct nt_arena_block) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT };

void *nt_alloc(size_t count, size_t size)
{
	size_t bytes;
	if (!nt_size_mul(count, size, &bytes))
		return NULL;
	return nt_alloc_large(bytes ? bytes : 1);
}

void *nt_calloc(size_t count, size_t size)
{
	size_t bytes;
	if (!nt_size_mul(count, size, &bytes) || nt_deadline_passed())
		return NULL;
	return calloc(bytes ? bytes : 1, 1);
}

bool nt_grow(void **block, size_t *capacity, size_t needed, size_t size)
{
	if (needed <= *capacity)
		return true;
	size_t wanted = *capacity < SIZE_MAX / 2 ? *capacity * 2 : SIZE_MAX;
	if (wanted < needed)
		wanted = needed;
	if (wanted < 16)
		wanted = 16;
	size_t bytes;
	if (!nt_size_mul(wanted, size, &bytes) || nt_deadline_passed())
		return false;
	void *grown = realloc(*block, bytes);
	if (!grown)
		return false;
	*block = grown;
	*capacity = wanted;
	return true;
}

/* The first block is the one that small requests are taken from; others go behind it, since it may have room yet. */
static struct nt_arena_block *add_block(nt_arena *arena, size_t capacity, bool first)
{
	size_t bytes;
	if (!nt_size_add(capacity, HEADER_BYTES, &bytes))
		return NULL;
	struct nt_arena_block *block = nt_alloc_large(bytes);
	if (!block)
		return NULL;
	struct nt_arena_block **at = first || !arena->blocks ? &arena->blocks : &arena->blocks->next;
	*block = (struct nt_arena_block){.next = *at, .capacity = capacity};
	*at = block;
	return block;
}

void *nt_arena_alloc(nt_arena *arena, size_t count, size_t size)
{
	size_t bytes;
	if (!nt_size_mul(count, size, &bytes) || bytes > SIZE_MAX - ALIGNMENT)
		return NULL;
	bytes = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
	struct nt_arena_block *block = arena->blocks;
	if (!block || block->capacity - block->used < bytes) {
		const size_t last = arena->block_bytes, next = !last ? LEAST_BLOCK_BYTES :
			last < MOST_BLOCK_BYTES ? 2 * last : MOST_BLOCK_BYTES;
		const bool small =
			bytes <= (next > LARGE_SHARE * LEAST_LARGE_BYTES ? next / LARGE_SHARE : LEAST_LARGE_BYTES);
		block = add_block(arena, small && bytes <= next - HEADER_BYTES ? next - HEADER_BYTES : bytes, small);
		if (!block)
			return NULL;
		if (small)
			arena->block_bytes = next;
	}
	void *result = (char *)block + HEADER_BYTES + block->used;
	block->used += bytes;
	return result;
}

char *nt_arena_text(nt_arena *arena, const char *text, size_t length)
{
	if (length == SIZE_MAX)
		return NULL;
	char *copy = nt_arena_alloc(arena, length + 1, 1);
	if (!copy)
		return NULL;
	memcpy(copy, text, length);
	copy[length] = '\0';
	return copy;
}

bool nt_arena_adopt(nt_arena *arena, void *block)
{
	if (!block)
		return true;
	struct nt_arena_block *holder = add_block(arena, 0, false);
	if (!holder) {
		free(block);
		return false;
	}
	holder->adopted = block;
	return true;
}

/* Behind the first block, from which small requests go on being taken; as long as the other's blocks, however many are
 * here: joining many arenas with one takes linear time. */
void nt_arena_join(nt_arena *arena, nt_arena *other)
{
	struct nt_arena_block **at = arena->blocks ? &arena->blocks->next : &arena->blocks, *const behind = *at;
	*at = other->blocks;
	while (*at)
		at = &(*at)->next;
	*at = behind;
	*other = (nt_arena){0};
}

void nt_arena_clear(nt_arena *arena)
{
	struct nt_arena_block *kept = arena->blocks;
	if (!kept || kept->adopted || kept->capacity > MOST_BLOCK_BYTES) {
		nt_arena_free(arena);
		return;
	}
	const size_t block_bytes = arena->block_bytes;
	arena->blocks = kept->next;
	nt_arena_free(arena);
	kept->next = NULL;
	kept->used = 0;
	*arena = (nt_arena){kept, block_bytes};
}

void nt_arena_free(nt_arena *arena)
{
	struct nt_arena_block *block = arena->blocks;
	while (block) {
		struct nt_arena_block *next = block->next;
		free(block->adopted);
		free(block);
		block = next;
	}
	*arena = (nt_arena){0};
}

/* ---- how much memory this process may take ---- */

/* A limit that cannot be read does not count. */

static uint64_t least(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static uint64_t meminfo_available(void)
{
	char line[128];
	uint64_t kilobytes, found = UINT64_MAX;
	FILE *file = fopen("/proc/meminfo", "re");
	while (file && found == UINT64_MAX && fgets(line, sizeof line, file))
		if (sscanf(line, "MemAvailable: %" SCNu64 " kB", &kilobytes) == 1)
			found = kilobytes * 1024;
	if (file)
		fclose(file);
	return found;
}

/* A file with one number; "max" is none. */
static uint64_t limit_in(const char *root, const char *group, const char *name)
{
	char path[4096];
	uint64_t number, found = UINT64_MAX;
	const int length = snprintf(path, sizeof path, "%s%s/%s", root, group, name);
	FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "re") : NULL;
	if (file && fscanf(file, "%" SCNu64, &number) == 1)
		found = number;
	if (file)
		fclose(file);
	return found;
}

/* The least limit of a group and those above it. In a container the path may be that outside of it, so that only the
 * root is there. */
static uint64_t limit_of_group(const char *root, char *group, const char *name)
{
	uint64_t found = limit_in(root, "", name);
	for (char *slash; (slash = strrchr(group, '/')) && slash[1]; *slash = '\0')
		found = least(found, limit_in(root, group, name));
	return found;
}

/* The list has lines like "0::/a/b" (version 2) and "4:memory:/a/b", whose files are below a folder "memory". */
uint64_t nt_memory_of_groups(const char *list, const char *root)
{
	char line[4096], memory[4096];
	uint64_t found = UINT64_MAX;
	snprintf(memory, sizeof memory, "%s/memory", root);
	FILE *file = fopen(list, "re");
	while (file && fgets(line, sizeof line, file)) {
		char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
		if (!group)
			continue;
		*group++ = '\0';
		group[strcspn(group, "\n")] = '\0';
		if (!controllers[1])
			found = least(found, limit_of_group(root, group, "memory.max"));
		else if (strcmp(controllers + 1, "memory") == 0)
			found = least(found, limit_of_group(memory, group, "memory.limit_in_bytes"));
	}
	if (file)
		fclose(file);
	return found;
}

uint64_t nt_memory_available(void)
{
	struct rlimit limit;
	uint64_t found = least(meminfo_available(), nt_memory_of_groups("/proc/self/cgroup", "/sys/fs/cgroup"));
	if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
		found = least(found, (uint64_t)limit.rlim_cur);
	return found;
}

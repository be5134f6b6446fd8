/* SPDX-License-Identifier: MIT */
/*
 * Memory of the tool, by sizes that are checked: blocks, arenas, and how much there is.
 */
#ifndef NT_BASE_MEMORY_H
#define NT_BASE_MEMORY_H

#include <stddef.h>
#include <stdint.h>
#include "base/scratch.h"

/* malloc(count * size) and calloc; NULL on overflow or exhaustion. A count of 0 gives a block that can
 * be freed. */
void *nt_alloc(size_t count, size_t size);
void *nt_calloc(size_t count, size_t size);

/* Grows *block, of *capacity elements, to at least `needed` elements (at least doubling). False, and
 * everything as it was, on overflow or exhaustion. */
bool nt_grow(void **block, size_t *capacity, size_t needed, size_t size);

/* An arena owns blocks that live equally long. A zeroed arena is empty. */
typedef struct nt_arena {
	struct nt_arena_block *blocks;
	size_t block_bytes; /* of the last block that small requests were taken from; begins at 4 MiB where much
	                       will come */
} nt_arena;

/* count * size bytes, aligned for any type, not cleared. NULL on overflow or exhaustion. */
void *nt_arena_alloc(nt_arena *arena, size_t count, size_t size);

/* A copy of `length` bytes of text with a final NUL. NULL on exhaustion. */
char *nt_arena_text(nt_arena *arena, const char *text, size_t length);

/* Hands a malloc'ed block over to the arena, which will free it. On failure (false) the block is freed
 * at once. NULL is allowed. */
bool nt_arena_adopt(nt_arena *arena, void *block);

/* Takes over everything in another arena, which is empty afterwards. */
void nt_arena_join(nt_arena *arena, nt_arena *other);

/* Everything in the arena is gone; some memory is kept for what comes next. */
void nt_arena_clear(nt_arena *arena);

/* Frees everything; the arena is empty afterwards. */
void nt_arena_free(nt_arena *arena);

/* ---- how much memory this process may take ---- */

/* Bytes that the system could give without swapping (MemAvailable), but at most what the control groups of this process
 * (memory.max; memory.limit_in_bytes of version 1) and its address space (ulimit -v) are limited to; UINT64_MAX where
 * nothing says. Page cache counts as available, so this is a guess about what others do. */
uint64_t nt_memory_available(void);

/* The part of it that is about control groups: `list` is /proc/self/cgroup, `root` /sys/fs/cgroup. */
uint64_t nt_memory_of_groups(const char *list, const char *root);

#endif

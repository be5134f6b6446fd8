/* SPDX-License-Identifier: MIT */
/*
 * Large blocks of memory.
 */
#ifndef NT_BASE_PAGES_H
#define NT_BASE_PAGES_H

#include <stddef.h>

/* malloc(bytes) for blocks that are going to be used: large ones are laid out for huge pages, where the
 * system has them, because a fault for every 4 KiB costs a seventh of a conversion (perf stat, a million
 * triangles). They may be a twelfth larger for that. free() as usual. */
void *nt_alloc_large(size_t bytes);

/* What is in a part of a block is not needed any more, but the block cannot be freed: the system takes the pages of a
 * large one back. */
void nt_drop_pages(void *memory, size_t bytes);

#endif

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

/* Returns the pages of a part of a block to the system: its content is lost, the block stays allocated. Small parts are
 * left as they are. */
void nt_drop_pages(void *memory, size_t bytes);

#endif

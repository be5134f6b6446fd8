/* SPDX-License-Identifier: MIT */
/*
 * Scratch memory: see scratch.h. Blocks form a list in the order they were made; going back to a mark
 * makes the blocks behind it empty again, and later requests reuse the first of them that is large
 * enough. A request that fits nowhere gets a block of at least its size.
 */
#include "base/scratch.h"

#include <stdint.h>
#include <stdlib.h>

enum { ALIGNMENT = 64, LEAST_BLOCK_BYTES = 64 * 1024 };

/* Not in front of its memory: that may be a large page which nobody else touches. */
struct nt_scratch_block {
	struct nt_scratch_block *next;
	char *memory;
	size_t size_bytes;
	char *first; /* aligned byte of memory */
	size_t room; /* from there on; it and `used` are multiples of ALIGNMENT */
	size_t used;
	bool lent;   /* the caller's, this header too */
};

static void begin_block(struct nt_scratch_block *block, void *memory, size_t size_bytes, bool lent)
{
	const size_t gap = (ALIGNMENT - (uintptr_t)memory % ALIGNMENT) % ALIGNMENT;
	*block = (struct nt_scratch_block){.memory = (char *)memory, .size_bytes = size_bytes,
		.first = (char *)memory + gap, .room = (size_bytes - gap) / ALIGNMENT * ALIGNMENT, .lent = lent};
}

static void *default_allocate(void *user, size_t size_bytes)
{
	(void)user;
	return nt_alloc_large(size_bytes);
}

static void default_release(void *user, void *block, size_t size_bytes)
{
	(void)user;
	(void)size_bytes;
	free(block);
}

void nt_scratch_init(nt_scratch *scratch, const nmtan_allocator *allocator)
{
	*scratch = (nt_scratch){.allocator = {default_allocate, default_release, NULL}};
	if (allocator)
		scratch->allocator = *allocator;
}

void nt_scratch_lend(nt_scratch *scratch, void *memory, size_t size_bytes)
{
	const size_t gap = (ALIGNMENT - (uintptr_t)memory % ALIGNMENT) % ALIGNMENT;
	struct nt_scratch_block *block = (struct nt_scratch_block *)((char *)memory + gap);
	begin_block(block, block + 1, size_bytes - gap - sizeof *block, true);
	scratch->first = scratch->current = block;
}

static inline void *take(struct nt_scratch_block *block, size_t bytes)
{
	if (block->room - block->used < bytes)
		return NULL;
	void *result = block->first + block->used;
	block->used += (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
	return result;
}

static struct nt_scratch_block *insert_block(nt_scratch *scratch, size_t bytes)
{
	size_t size_bytes;
	if (!nt_size_add(bytes, 2 * ALIGNMENT, &size_bytes)) /* of which nothing is used before and behind */
		return NULL;
	if (size_bytes < LEAST_BLOCK_BYTES)
		size_bytes = LEAST_BLOCK_BYTES;
	if (size_bytes < scratch->expected_bytes)
		size_bytes = scratch->expected_bytes;
	scratch->expected_bytes = 0;
	const nmtan_allocator *from = &scratch->allocator;
	struct nt_scratch_block *block = (struct nt_scratch_block *)from->allocate(from->user, sizeof *block);
	if (!block)
		return NULL;
	void *memory = from->allocate(from->user, size_bytes);
	if (!memory) {
		from->release(from->user, block, sizeof *block);
		return NULL;
	}
	begin_block(block, memory, size_bytes, false);
	if (scratch->current) {
		block->next = scratch->current->next;
		scratch->current->next = block;
	} else {
		block->next = scratch->first;
		scratch->first = block;
	}
	return block;
}

/* Not in line: it needs many registers, which all requests would have to save. */
static void *NT_NOINLINE alloc_behind(nt_scratch *scratch, size_t bytes)
{
	struct nt_scratch_block *block = scratch->current ? scratch->current->next : scratch->first;
	for (; block; block = block->next) {
		void *result = take(block, bytes);
		if (result) {
			scratch->current = block;
			return result;
		}
	}
	block = insert_block(scratch, bytes);
	if (!block)
		return NULL;
	scratch->current = block;
	return take(block, bytes);
}

nt_memory nt_scratch_alloc(nt_scratch *scratch, size_t count, size_t size)
{
	size_t bytes;
	if (!nt_size_mul(count, size, &bytes))
		return NULL;
	void *const result = scratch->current ? take(scratch->current, bytes) : NULL;
	return result ? result : alloc_behind(scratch, bytes);
}

void nt_scratch_expect(nt_scratch *scratch, size_t bytes)
{
	const struct nt_scratch_block *block = scratch->first;
	while (block && block->lent)
		block = block->next;
	scratch->expected_bytes = block ? 0 : bytes;
}

nt_scratch_mark nt_scratch_here(const nt_scratch *scratch)
{
	const struct nt_scratch_block *block = scratch->current;
	return (nt_scratch_mark){scratch->current, block ? block->used : 0};
}

void nt_scratch_back(nt_scratch *scratch, nt_scratch_mark mark)
{
	struct nt_scratch_block *block = mark.block ? mark.block->next : scratch->first;
	for (; block; block = block->next)
		block->used = 0;
	if (mark.block)
		mark.block->used = mark.used;
	scratch->current = mark.block;
}

size_t nt_scratch_bytes(const nt_scratch *scratch)
{
	size_t bytes = 0;
	for (const struct nt_scratch_block *block = scratch->first; block; block = block->next)
		bytes += block->size_bytes;
	return bytes;
}

void nt_scratch_free(nt_scratch *scratch)
{
	struct nt_scratch_block *block = scratch->first;
	while (block) {
		struct nt_scratch_block *next = block->next;
		if (!block->lent) {
			scratch->allocator.release(scratch->allocator.user, block->memory, block->size_bytes);
			scratch->allocator.release(scratch->allocator.user, block, sizeof *block);
		}
		block = next;
	}
	scratch->first = scratch->current = NULL;
}

nmtan_workspace *nmtan_workspace_create(const nmtan_allocator *allocator)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, allocator);
	nmtan_workspace *workspace =
		(nmtan_workspace *)scratch.allocator.allocate(scratch.allocator.user, sizeof *workspace);
	if (workspace)
		workspace->scratch = scratch;
	return workspace;
}

void nmtan_workspace_destroy(nmtan_workspace *workspace)
{
	if (!workspace)
		return;
	const nmtan_allocator allocator = workspace->scratch.allocator;
	nt_scratch_free(&workspace->scratch);
	allocator.release(allocator.user, workspace, sizeof *workspace);
}

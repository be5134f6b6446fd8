/* SPDX-License-Identifier: MIT */
/*
 * Scratch memory of one call: a stack of blocks from the caller's allocator. A workspace is a scratch
 * that keeps its blocks, so that a second call of the same size touches no fresh page.
 *
 * Not for several threads: allocate before a parallel region, or one scratch per thread.
 */
#ifndef NT_BASE_SCRATCH_H
#define NT_BASE_SCRATCH_H

#include <stdbool.h>
#include "base/compiler.h"
#include "nmtan.h"

typedef struct nt_scratch {
	nmtan_allocator allocator;
	struct nt_scratch_block *first, *current;
	size_t expected_bytes; /* of the first own block; 0: none is expected, or it is there */
} nt_scratch;

/* A position of a stack, to go back to. */
typedef struct nt_scratch_mark {
	struct nt_scratch_block *block;
	size_t used;
} nt_scratch_mark;

/* An empty scratch over an allocator; NULL: malloc and free. */
void nt_scratch_init(nt_scratch *scratch, const nmtan_allocator *allocator);

/* Gives an empty scratch its first block: at least 256 bytes of the caller, which outlive it. */
void nt_scratch_lend(nt_scratch *scratch, void *memory, size_t size_bytes);

/* count * size bytes aligned to 64, not cleared. NULL on overflow or exhaustion. */
nt_memory nt_scratch_alloc(nt_scratch *scratch, size_t count, size_t size);

/* Sets the least size of the first block that a scratch gets from its allocator. With many small blocks, malloc returns
 * pages to the system after each call, and the next call has to clear new ones. */
void nt_scratch_expect(nt_scratch *scratch, size_t bytes);

/* Everything allocated after nt_scratch_here() is released by nt_scratch_back(); blocks are kept. */
nt_scratch_mark nt_scratch_here(const nt_scratch *scratch);
void nt_scratch_back(nt_scratch *scratch, nt_scratch_mark mark);

/* Bytes that the blocks hold, used or not: for tests and tests/bench. */
size_t nt_scratch_bytes(const nt_scratch *scratch);

/* Returns all blocks to the allocator. */
void nt_scratch_free(nt_scratch *scratch);

struct nmtan_workspace {
	nt_scratch scratch;
};

#endif

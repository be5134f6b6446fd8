/* SPDX-License-Identifier: MIT */
/*
 * Memory of the compute library: sizes that are checked, large blocks, scratch of one call, and outputs that serve as
 * scratch.
 */
#ifndef NT_BASE_SCRATCH_H
#define NT_BASE_SCRATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/compiler.h"
#include "nmtan.h"

/* ---- sizes from files or callers, which are multiplied and added here and nowhere else ---- */

/* product = a * b, sum = a + b; false where that overflows (the result is then SIZE_MAX). */
static inline bool nt_size_mul(size_t a, size_t b, size_t *product)
{
	const bool fits = b == 0 || a <= SIZE_MAX / b;
	*product = fits ? a * b : SIZE_MAX;
	return fits;
}

static inline bool nt_size_add(size_t a, size_t b, size_t *sum)
{
	const bool fits = a <= SIZE_MAX - b;
	*sum = fits ? a + b : SIZE_MAX;
	return fits;
}

/* ---- large blocks ---- */

/* malloc(bytes) for blocks that are going to be used: large ones are laid out for huge pages, where the
 * system has them, because a fault for every 4 KiB costs a seventh of a conversion (perf stat, a million
 * triangles). They may be a twelfth larger for that. free() as usual. */
void *nt_alloc_large(size_t bytes);

/* Returns the pages of a part of a block to the system: its content is lost, the block stays allocated. Small parts are
 * left as they are. */
void nt_drop_pages(void *memory, size_t bytes);

/* ---- scratch ---- */

/* A stack of blocks from the caller's allocator, for one call. A workspace is a scratch that keeps its blocks, so that
 * a second call of the same size touches no fresh page. Not for several threads: allocate before a parallel region, or
 * one scratch per thread. */

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

/* ---- borrowed scratch ---- */

/* An output that is written last serves as scratch memory until then. An array that does not fit comes from the scratch
 * itself. */

typedef struct nt_borrowed {
	char *begin, *end; /* what is still free */
	nt_scratch *scratch;
} nt_borrowed;

enum { NT_BORROWED_ALIGNMENT = 64 };

/* Borrows `bytes` at `memory`, of any alignment. */
static inline nt_borrowed nt_borrow(void *memory, size_t bytes, nt_scratch *scratch)
{
	const size_t lost = (NT_BORROWED_ALIGNMENT - (uintptr_t)memory % NT_BORROWED_ALIGNMENT) % NT_BORROWED_ALIGNMENT;
	char *begin = memory;
	return lost >= bytes ? (nt_borrowed){begin, begin, scratch}
			     : (nt_borrowed){begin + lost, begin + bytes, scratch};
}

/* Whether that much of the borrowed memory is free. */
static inline bool nt_borrowed_has(const nt_borrowed *memory, size_t count, size_t size)
{
	size_t bytes;
	return nt_size_mul(count, size, &bytes) && bytes <= (size_t)(memory->end - memory->begin);
}

/* count * size bytes aligned to 64, not cleared; NULL on overflow or exhaustion. */
static inline nt_memory nt_borrowed_alloc(nt_borrowed *memory, size_t count, size_t size)
{
	if (!nt_borrowed_has(memory, count, size))
		return nt_scratch_alloc(memory->scratch, count, size);
	void *result = memory->begin;
	const size_t bytes = count * size, left = (size_t)(memory->end - memory->begin);
	const size_t padded = bytes + (NT_BORROWED_ALIGNMENT - bytes % NT_BORROWED_ALIGNMENT) % NT_BORROWED_ALIGNMENT;
	memory->begin += padded < left ? padded : left;
	return result;
}

/* Gives back what lies behind `used` bytes of the block that was allocated last, which must be borrowed memory:
 * see nt_borrowed_has(). */
static inline void nt_borrowed_trim(nt_borrowed *memory, void *block, size_t used)
{
	const size_t padded = used + (NT_BORROWED_ALIGNMENT - used % NT_BORROWED_ALIGNMENT) % NT_BORROWED_ALIGNMENT;
	if (padded <= (size_t)(memory->begin - (char *)block))
		memory->begin = (char *)block + padded;
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Borrowed scratch: an output that is written last serves as scratch memory until then. An array that does not fit
 * comes from the scratch itself.
 */
#ifndef NT_BASE_BORROWED_H
#define NT_BASE_BORROWED_H

#include <stdint.h>
#include "base/size.h"
#include "base/scratch.h"

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

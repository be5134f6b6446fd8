/* SPDX-License-Identifier: MIT */
/*
 * Memory that is going to be overwritten anyway: a large output lends its bytes as scratch until it is
 * filled. What does not fit comes from the scratch.
 */
#ifndef NT_BASE_ROOM_H
#define NT_BASE_ROOM_H

#include <stdint.h>
#include "base/memory.h"
#include "base/scratch.h"

typedef struct nt_room {
	char *begin, *end; /* what is still free */
	nt_scratch *scratch;
} nt_room;

enum { NT_ROOM_ALIGNMENT = 64 };

/* Lends `bytes` at `memory`, of any alignment. */
static inline nt_room nt_room_over(void *memory, size_t bytes, nt_scratch *scratch)
{
	const size_t lost = (NT_ROOM_ALIGNMENT - (uintptr_t)memory % NT_ROOM_ALIGNMENT) % NT_ROOM_ALIGNMENT;
	char *begin = memory;
	return lost >= bytes ? (nt_room){begin, begin, scratch}
			     : (nt_room){begin + lost, begin + bytes, scratch};
}

/* Whether that much is free in the room itself. */
static inline bool nt_room_has(const nt_room *room, size_t count, size_t size)
{
	size_t bytes;
	return nt_size_mul(count, size, &bytes) && bytes <= (size_t)(room->end - room->begin);
}

/* count * size bytes aligned to 64, not cleared; NULL on overflow or exhaustion. */
static inline void *nt_room_alloc(nt_room *room, size_t count, size_t size)
{
	if (!nt_room_has(room, count, size))
		return nt_scratch_alloc(room->scratch, count, size);
	void *result = room->begin;
	const size_t bytes = count * size, left = (size_t)(room->end - room->begin);
	const size_t padded = bytes + (NT_ROOM_ALIGNMENT - bytes % NT_ROOM_ALIGNMENT) % NT_ROOM_ALIGNMENT;
	room->begin += padded < left ? padded : left;
	return result;
}

/* Gives back what lies behind `used` bytes of the block that was allocated last, which must be in the room itself:
 * see nt_room_has(). */
static inline void nt_room_trim(nt_room *room, void *block, size_t used)
{
	const size_t padded = used + (NT_ROOM_ALIGNMENT - used % NT_ROOM_ALIGNMENT) % NT_ROOM_ALIGNMENT;
	if (padded <= (size_t)(room->begin - (char *)block))
		room->begin = (char *)block + padded;
}

#endif

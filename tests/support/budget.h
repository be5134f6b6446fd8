/* SPDX-License-Identifier: MIT */
/*
 * An allocator for so many allocations, after which memory is exhausted.
 */
#ifndef NT_BUDGET_H
#define NT_BUDGET_H

#include <stdlib.h>

typedef struct budget {
	size_t allowed;
} budget;

static inline void *take_budget(void *user, size_t bytes)
{
	budget *b = user;
	return b->allowed > 0 ? b->allowed--, malloc(bytes) : NULL;
}

static inline void give_back(void *user, void *block, size_t bytes)
{
	(void)user;
	(void)bytes;
	free(block);
}

#endif

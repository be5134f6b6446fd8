/* SPDX-License-Identifier: MIT */
/*
 * Pairs by keys: see pairs.h. Both lists are sorted and gone through at once.
 */
#include "report/pairs.h"

#include <stdlib.h>
#include "base/memory.h"

typedef struct keyed {
	uint64_t key;
	uint32_t index;
} keyed;

static int by_key(const void *a, const void *b)
{
	const keyed *x = a, *y = b;
	if (x->key != y->key)
		return x->key < y->key ? -1 : 1;
	return x->index < y->index ? -1 : x->index > y->index;
}

static void add(keyed *list, size_t *count, uint64_t key, size_t index)
{
	if (key)
		list[(*count)++] = (keyed){key, (uint32_t)index};
}

nt_status nt_pair(const void *old, size_t old_count, const void *new, size_t new_count, nt_key_of key_of,
	uint32_t *partners, bool *taken)
{
	keyed *lists[2] = {nt_alloc(old_count, sizeof(keyed)), nt_alloc(new_count, sizeof(keyed))};
	size_t counts[2] = {0, 0};
	const bool made = lists[0] && lists[1];
	for (size_t i = 0; made && i < old_count; i++)
		add(lists[0], &counts[0], taken[i] ? 0 : key_of(old, i), i);
	for (size_t i = 0; made && i < new_count; i++)
		add(lists[1], &counts[1], partners[i] != UINT32_MAX ? 0 : key_of(new, i), i);
	for (int i = 0; i < 2; i++)
		if (counts[i])
			qsort(lists[i], counts[i], sizeof(keyed), by_key);
	for (size_t a = 0, b = 0; b < counts[1]; b++) {
		const keyed *wanted = &lists[1][b];
		while (a < counts[0] && lists[0][a].key < wanted->key)
			a++;
		if (a == counts[0] || lists[0][a].key != wanted->key)
			continue;
		partners[wanted->index] = lists[0][a].index;
		taken[lists[0][a++].index] = true;
	}
	free(lists[0]);
	free(lists[1]);
	return made ? NT_OK : NT_ERROR_MEMORY;
}

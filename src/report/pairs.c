/* SPDX-License-Identifier: MIT */
/*
 * Pairs by keys: see pairs.h. Both lists are sorted and gone through at once.
 */
#include "report/pairs.h"

#include <stdlib.h>
#include "base/memory.h"

static int by_key(const void *a, const void *b)
{
	const nt_keyed *x = a, *y = b;
	if (x->key != y->key)
		return x->key < y->key ? -1 : 1;
	return x->index < y->index ? -1 : x->index > y->index;
}

nt_keyed *nt_list_keys(const void *things, size_t count, nt_key_of key_of, size_t *listed)
{
	nt_keyed *list = nt_alloc(count, sizeof *list);
	*listed = 0;
	for (size_t i = 0; list && i < count; i++) {
		const uint64_t key = key_of(things, i);
		if (key)
			list[(*listed)++] = (nt_keyed){key, (uint32_t)i};
	}
	if (*listed)
		qsort(list, *listed, sizeof *list, by_key);
	return list;
}

/* The first one from `at` on whose key is not below, by steps that grow and shrink. */
static size_t skip_to(const nt_keyed *list, size_t count, size_t at, uint64_t key)
{
	for (size_t step = 1; step > 0;) {
		const bool below = step <= count - at && list[at + step - 1].key < key;
		at += below ? step : 0;
		step = below ? 2 * step : step / 2;
	}
	return at;
}

void nt_pair_keys(const nt_keyed *old, size_t old_count, const nt_keyed *new, size_t new_count, uint32_t *partners,
	bool *taken)
{
	for (size_t a = 0, b = 0; b < new_count; b++) {
		if (partners[new[b].index] != UINT32_MAX)
			continue;
		a = skip_to(old, old_count, a, new[b].key);
		while (a < old_count && old[a].key == new[b].key && taken && taken[old[a].index])
			a++;
		if (a == old_count || old[a].key != new[b].key)
			continue;
		partners[new[b].index] = old[a].index;
		if (taken)
			taken[old[a].index] = true;
		a++;
	}
}

nt_status nt_pair(const void *old, size_t old_count, const void *new, size_t new_count, nt_key_of key_of,
	uint32_t *partners, bool *taken)
{
	size_t counts[2];
	nt_keyed *lists[2] = {nt_list_keys(old, old_count, key_of, &counts[0]),
		nt_list_keys(new, new_count, key_of, &counts[1])};
	const bool made = lists[0] && lists[1];
	if (made)
		nt_pair_keys(lists[0], counts[0], lists[1], counts[1], partners, taken);
	free(lists[0]);
	free(lists[1]);
	return made ? NT_OK : NT_ERROR_MEMORY;
}

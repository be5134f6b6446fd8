/* SPDX-License-Identifier: MIT */
/*
 * Pairs by keys: see report.h. Both lists are sorted and gone through at once.
 */
#include "report/report.h"

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

void nt_pair_keys(nt_pairs *pairs, const nt_keyed *old, size_t old_count, const nt_keyed *new, size_t new_count)
{
	bool *taken = pairs->taken;
	for (size_t a = 0, b = 0; b < new_count; b++) {
		if (pairs->partners[new[b].index] != UINT32_MAX)
			continue;
		a = skip_to(old, old_count, a, new[b].key);
		while (a < old_count && old[a].key == new[b].key && taken && taken[old[a].index])
			a++;
		if (a == old_count || old[a].key != new[b].key)
			continue;
		pairs->partners[new[b].index] = old[a].index;
		if (taken)
			taken[old[a].index] = true;
		a++;
	}
}

bool nt_pairs_begin(nt_pairs *pairs, size_t new_count)
{
	pairs->partners = nt_alloc(new_count, sizeof *pairs->partners);
	for (size_t i = 0; pairs->partners && i < new_count; i++)
		pairs->partners[i] = UINT32_MAX;
	return pairs->partners != NULL;
}

bool nt_pair(nt_pairs *pairs, const void *old, size_t old_count, const void *new, size_t new_count,
	const nt_key_of keys[2])
{
	pairs->taken = nt_calloc(old_count, sizeof *pairs->taken);
	bool made = nt_pairs_begin(pairs, new_count) && pairs->taken;
	for (int i = 0; i < 2 && keys[i] && made; i++) {
		size_t counts[2] = {0};
		nt_keyed *lists[2] = {nt_list_keys(old, old_count, keys[i], &counts[0]),
			nt_list_keys(new, new_count, keys[i], &counts[1])};
		made = lists[0] && lists[1];
		if (made)
			nt_pair_keys(pairs, lists[0], counts[0], lists[1], counts[1]);
		free(lists[0]);
		free(lists[1]);
	}
	return made;
}

void nt_pairs_free(nt_pairs *pairs)
{
	free(pairs->partners);
	free(pairs->taken);
}

/* SPDX-License-Identifier: MIT */
/*
 * The index of hash_index.h.
 */
#include "base/hash_index.h"

#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

enum { FIRST_SIZE = 64 };

/* Linear probing keeps numbers of one hash in the order they came, also when they are put in again in the
 * order of the old table, as long as that is read from behind a free place. */
static void put(nt_hash_index *index, uint64_t hash, uint32_t number)
{
	size_t at = (size_t)hash & (index->size - 1);
	while (index->numbers[at] != UINT32_MAX)
		at = (at + 1) & (index->size - 1);
	index->hashes[at] = hash;
	index->numbers[at] = number;
}

static bool grow(nt_hash_index *index)
{
	nt_hash_index larger = {.size = index->size ? 2 * index->size : FIRST_SIZE, .count = index->count};
	larger.hashes = nt_alloc(larger.size, sizeof *larger.hashes);
	larger.numbers = nt_alloc(larger.size, sizeof *larger.numbers);
	if (!larger.hashes || !larger.numbers) {
		nt_hash_index_free(&larger);
		return false;
	}
	memset(larger.numbers, 0xFF, larger.size * sizeof *larger.numbers);
	size_t begin = 0;
	while (begin < index->size && index->numbers[begin] != UINT32_MAX)
		begin++;
	for (size_t i = 0; i < index->size; i++) {
		const size_t at = (begin + i) & (index->size - 1);
		if (index->numbers[at] != UINT32_MAX)
			put(&larger, index->hashes[at], index->numbers[at]);
	}
	nt_hash_index_free(index);
	*index = larger;
	return true;
}

bool nt_hash_index_add(nt_hash_index *index, uint64_t hash, uint32_t number)
{
	if (2 * (index->count + 1) > index->size && !grow(index))
		return false;
	put(index, hash, number);
	index->count++;
	return true;
}

uint32_t nt_hash_index_next(const nt_hash_index *index, uint64_t hash, size_t *at)
{
	if (index->size == 0)
		return UINT32_MAX;
	*at = *at == NT_HASH_BEGIN ? (size_t)hash & (index->size - 1) : (*at + 1) & (index->size - 1);
	while (index->numbers[*at] != UINT32_MAX && index->hashes[*at] != hash)
		*at = (*at + 1) & (index->size - 1);
	return index->numbers[*at];
}

void nt_hash_index_free(nt_hash_index *index)
{
	free(index->hashes);
	free(index->numbers);
	*index = (nt_hash_index){0};
}

/* A key of a set, or a name, by its number. */
static uint32_t find(const nt_hash_index *index, const unsigned char *keys, const nt_name *names, const void *key,
	size_t size, uint64_t hash)
{
	size_t at = NT_HASH_BEGIN;
	uint32_t number;
	while ((number = nt_hash_index_next(index, hash, &at)) != UINT32_MAX)
		if (names ? names[number].length == size && memcmp(names[number].text, key, size) == 0
			  : memcmp(keys + number * size, key, size) == 0)
			break;
	return number;
}

/* Room for one more thing, of which the index gets the number. */
static bool extend(nt_hash_index *index, uint64_t hash, void **items, size_t *capacity, size_t count, size_t size)
{
	return count < UINT32_MAX - 1 && nt_grow(items, capacity, count + 1, size) &&
		nt_hash_index_add(index, hash, (uint32_t)count);
}

uint32_t nt_key_find(const nt_key_set *set, const void *key, size_t size)
{
	return find(&set->index, set->keys, NULL, key, size, nt_hash_bytes(0, key, size));
}

uint32_t nt_key_add(nt_key_set *set, const void *key, size_t size)
{
	const uint64_t hash = nt_hash_bytes(0, key, size);
	const uint32_t known = find(&set->index, set->keys, NULL, key, size, hash);
	if (known != UINT32_MAX || !extend(&set->index, hash, (void **)&set->keys, &set->capacity, set->count, size))
		return known;
	memcpy(set->keys + set->count * size, key, size);
	return (uint32_t)set->count++;
}

void nt_key_set_free(nt_key_set *set)
{
	free(set->keys);
	nt_hash_index_free(&set->index);
	*set = (nt_key_set){0};
}

uint32_t nt_name_find(const nt_name_table *table, const char *text, size_t length)
{
	return find(&table->index, NULL, table->names, text, length, nt_hash_bytes(0, text, length));
}

uint32_t nt_name_add(nt_name_table *table, const char *text, size_t length)
{
	const uint64_t hash = nt_hash_bytes(0, text, length);
	const uint32_t known = find(&table->index, NULL, table->names, text, length, hash);
	if (known != UINT32_MAX || !extend(&table->index, hash, (void **)&table->names, &table->capacity, table->count,
		sizeof *table->names))
		return known;
	table->names[table->count] = (nt_name){text, length};
	return (uint32_t)table->count++;
}

void nt_name_table_free(nt_name_table *table)
{
	free(table->names);
	nt_hash_index_free(&table->index);
	*table = (nt_name_table){0};
}

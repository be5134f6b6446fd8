/* SPDX-License-Identifier: MIT */
/*
 * Names by number: see name_table.h.
 */
#include "base/name_table.h"

#include <stdlib.h>
#include <string.h>
#include "base/utf8.h"

uint32_t nt_name_find(const nt_name_table *table, const char *text, size_t length)
{
	const uint64_t hash = nt_hash_bytes(0, text, length);
	size_t at = NT_HASH_BEGIN;
	uint32_t number;
	while ((number = nt_hash_index_next(&table->index, hash, &at)) != UINT32_MAX)
		if (table->names[number].length == length && memcmp(table->names[number].text, text, length) == 0)
			break;
	return number;
}

uint32_t nt_name_add(nt_name_table *table, const char *text, size_t length)
{
	const uint32_t known = nt_name_find(table, text, length);
	if (known != UINT32_MAX)
		return known;
	if (table->count >= UINT32_MAX - 1 ||
		!nt_grow((void **)&table->names, &table->capacity, table->count + 1, sizeof *table->names) ||
		!nt_hash_index_add(&table->index, nt_hash_bytes(0, text, length), (uint32_t)table->count))
		return UINT32_MAX;
	table->names[table->count] = (nt_name){text, length};
	return (uint32_t)table->count++;
}

void nt_name_table_free(nt_name_table *table)
{
	free(table->names);
	nt_hash_index_free(&table->index);
	*table = (nt_name_table){0};
}

static bool is_utf8(const char *text, size_t length)
{
	for (size_t i = 0; i < length;) {
		const size_t step = nt_utf8_length(text + i, length - i);
		if (step == 0)
			return false;
		i += step;
	}
	return true;
}

char *nt_utf8_text(nt_arena *arena, const char *text, size_t length)
{
	if (is_utf8(text, length))
		return nt_arena_text(arena, text, length);
	if (length > SIZE_MAX / 2 - 1)
		return NULL;
	char *copy = nt_arena_alloc(arena, 2 * length + 1, 1);
	if (!copy)
		return NULL;
	char *to = copy;
	for (size_t i = 0; i < length; i++) {
		const unsigned char c = (unsigned char)text[i];
		if (c >= 0x80)
			*to++ = (char)(0xC0 | c >> 6);
		*to++ = (char)(c < 0x80 ? c : 0x80 | (c & 0x3F));
	}
	*to = '\0';
	return copy;
}

/* SPDX-License-Identifier: MIT */
/*
 * Names by number: an open-addressing hash table, at most half full.
 */
#include "base/name_table.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/utf8.h"

/* The slot that holds the name, or the free one where it belongs. */
static size_t find_slot(const nt_name_table *table, const char *text, size_t length)
{
	size_t slot = (size_t)nt_hash_bytes(0, text, length) & (table->slot_count - 1);
	while (table->slots[slot]) {
		const nt_name *name = &table->names[table->slots[slot] - 1];
		if (name->length == length && memcmp(name->text, text, length) == 0)
			break;
		slot = (slot + 1) & (table->slot_count - 1);
	}
	return slot;
}

static bool grow_slots(nt_name_table *table)
{
	if (2 * (table->count + 1) <= table->slot_count)
		return true;
	const size_t slot_count = table->slot_count ? 2 * table->slot_count : 16;
	uint32_t *slots = nt_calloc(slot_count, sizeof *slots);
	if (!slots)
		return false;
	free(table->slots);
	table->slots = slots;
	table->slot_count = slot_count;
	for (size_t i = 0; i < table->count; i++)
		slots[find_slot(table, table->names[i].text, table->names[i].length)] = (uint32_t)i + 1;
	return true;
}

uint32_t nt_name_find(const nt_name_table *table, const char *text, size_t length)
{
	return table->count ? table->slots[find_slot(table, text, length)] - 1 : UINT32_MAX;
}

uint32_t nt_name_add(nt_name_table *table, const char *text, size_t length)
{
	if (table->count >= UINT32_MAX - 1 || !grow_slots(table))
		return UINT32_MAX;
	const size_t slot = find_slot(table, text, length);
	if (table->slots[slot])
		return table->slots[slot] - 1;
	if (!nt_grow((void **)&table->names, &table->capacity, table->count + 1, sizeof *table->names))
		return UINT32_MAX;
	table->names[table->count] = (nt_name){text, length};
	table->slots[slot] = (uint32_t)++table->count;
	return (uint32_t)table->count - 1;
}

void nt_name_table_free(nt_name_table *table)
{
	free(table->names);
	free(table->slots);
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

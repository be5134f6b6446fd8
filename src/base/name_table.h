/* SPDX-License-Identifier: MIT */
/*
 * Names by number: equal names get the same number, in the order in which they come.
 */
#ifndef NT_BASE_NAME_TABLE_H
#define NT_BASE_NAME_TABLE_H

#include "base/hash_index.h"
#include "base/memory.h"

typedef struct nt_name {
	const char *text; /* not copied, no NUL at its end */
	size_t length;
} nt_name;

/* Zero-initialised: empty. */
typedef struct nt_name_table {
	nt_name *names;
	size_t count, capacity;
	nt_hash_index index;
} nt_name_table;

/* The number of a name that is there; UINT32_MAX: it is not. */
uint32_t nt_name_find(const nt_name_table *table, const char *text, size_t length);

/* The number of a name, which is added where it is new. UINT32_MAX: out of memory. */
uint32_t nt_name_add(nt_name_table *table, const char *text, size_t length);

void nt_name_table_free(nt_name_table *table);

/* The text as UTF-8 with a final NUL. If it is not UTF-8 already, it is taken as Latin-1. NULL: out of memory. */
char *nt_utf8_text(nt_arena *arena, const char *text, size_t length);

#endif

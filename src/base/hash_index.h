/* SPDX-License-Identifier: MIT */
/*
 * An index of numbered things by hash: the owner of the things compares those that have the same hash. Open
 * addressing with the hashes stored, so that growing needs nothing of the things.
 */
#ifndef NT_BASE_HASH_INDEX_H
#define NT_BASE_HASH_INDEX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/hash.h"

/* Zeroed: empty. */
typedef struct nt_hash_index {
	uint64_t *hashes;
	uint32_t *numbers; /* [size] UINT32_MAX: free */
	size_t size, count; /* size: 0 or a power of two, at least twice the count */
} nt_hash_index;

/* Adds a number, which is not UINT32_MAX. False, and everything as it was, when memory is exhausted. */
bool nt_hash_index_add(nt_hash_index *index, uint64_t hash, uint32_t number);

/* The numbers that were added with this hash, one by one in the order of adding; UINT32_MAX behind the last.
 * *at begins with NT_HASH_BEGIN. */
#define NT_HASH_BEGIN SIZE_MAX
uint32_t nt_hash_index_next(const nt_hash_index *index, uint64_t hash, size_t *at);

void nt_hash_index_free(nt_hash_index *index);

/* Keys of one size, copied, by number: equal keys get the same one, in the order in which they come. Zeroed: empty. */
typedef struct nt_key_set {
	unsigned char *keys;
	size_t count, capacity;
	nt_hash_index index;
} nt_key_set;

/* The number of a key that is there; UINT32_MAX: it is not. */
uint32_t nt_key_find(const nt_key_set *set, const void *key, size_t size);

/* The number of a key, which is added where it is new: then that is the count before. UINT32_MAX: out of memory. */
uint32_t nt_key_add(nt_key_set *set, const void *key, size_t size);

void nt_key_set_free(nt_key_set *set);

typedef struct nt_name {
	const char *text; /* not copied, no NUL at its end */
	size_t length;
} nt_name;

/* Names by number, as keys are, but not copied. Zeroed: empty. */
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

#endif

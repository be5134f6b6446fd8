/* SPDX-License-Identifier: MIT */
/*
 * Shapes: the keys of objects, each order of keys once. The objects of an array mostly have the same keys, so that a
 * document of a million objects has some ten shapes, and a question for a key looks at the same few bytes each time.
 */
#include <stdlib.h>
#include "json/tree.h"

static int compare_keys(const void *a, const void *b)
{
	const nt_json_name *x = *(const nt_json_name *const *)a, *y = *(const nt_json_name *const *)b;
	if (x->length != y->length)
		return x->length < y->length ? -1 : 1;
	const int difference = memcmp(x->text, y->text, x->length);
	return difference ? difference : x < y ? -1 : x > y;
}

/* Fills `repeated`. Few are compared pair by pair, many are sorted. False: out of memory. */
static bool find_repeated(nt_json_shape *shape)
{
	enum { FEW = 16 };
	const size_t count = shape->count;
	const nt_json_name *const keys = shape->keys;
	shape->repeated = count;
	if (count <= FEW) {
		for (size_t i = 1; i < count; i++)
			for (size_t k = 0; k < i; k++)
				if (nt_json_same_key(&keys[i], &keys[k]))
					shape->repeated = i;
		return true;
	}
	const nt_json_name **order = nt_alloc(count, sizeof *order);
	if (!order)
		return false;
	for (size_t i = 0; i < count; i++)
		order[i] = &keys[i];
	qsort(order, count, sizeof *order, compare_keys);
	for (size_t i = 1; i < count && shape->repeated == count; i++)
		if (nt_json_same_key(order[i], order[i - 1]))
			shape->repeated = (size_t)(order[i] - keys);
	free(order);
	return true;
}

static nt_json_shape *make_shape(nt_json *document, const nt_json_name *keys, size_t count)
{
	size_t bytes;
	if (!nt_size_mul(count, sizeof *keys, &bytes) || !nt_size_add(bytes, sizeof(nt_json_shape), &bytes))
		return NULL;
	nt_json_shape *shape = nt_arena_alloc(&document->arena, bytes, 1);
	if (!shape)
		return NULL;
	*shape = (nt_json_shape){.count = count};
	if (count)
		memcpy(shape->keys, keys, count * sizeof *keys);
	return find_repeated(shape) ? shape : NULL;
}

nt_json_shape *nt_json_shape_of(nt_json *document, const nt_json_name *keys, size_t count)
{
	uint64_t hash = count;
	for (size_t i = 0; i < count; i++)
		hash = nt_hash_bytes(hash, keys[i].text, keys[i].length);
	uint32_t number;
	for (size_t at = NT_HASH_BEGIN; (number = nt_hash_index_next(&document->known, hash, &at)) != UINT32_MAX;)
		if (nt_json_has_keys(document->shapes[number], keys, count))
			return document->shapes[number];
	if (document->shape_count >= UINT32_MAX || !nt_grow((void **)&document->shapes, &document->shape_capacity,
		document->shape_count + 1, sizeof *document->shapes))
		return NULL;
	nt_json_shape *shape = make_shape(document, keys, count);
	if (!shape || !nt_hash_index_add(&document->known, hash, (uint32_t)document->shape_count))
		return NULL;
	document->shapes[document->shape_count++] = shape;
	return shape;
}

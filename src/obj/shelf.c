/* SPDX-License-Identifier: MIT */
/*
 * Where the arrays of chunks are kept. A thread reads one chunk after the other into the same arrays, its desk, whose
 * pages are there and in the cache; what was read is then copied, without the room that was left, into blocks large
 * enough for huge pages. With arrays of its own for each chunk, 106 MB of text take 193 ms on one thread instead of
 * 172, and 120 MB of memory instead of 88 (nmtan --threads=1 --timing; perf stat -e minor-faults: 18 300 faults instead
 * of 6 500).
 *
 * A file of few chunks has no such blocks: the arrays that were read are kept as they are.
 */
#include "obj/parts.h"

#include <stdlib.h>
#include <string.h>

enum {
	FEW_CHUNKS = 4,
	BLOCK_BYTES = 4 << 20, /* two huge pages; what 1 MiB of text has of a kind is no large request there */
	ARRAY_COUNT = OBJ_KIND_COUNT + 3
};

typedef struct array {
	void **rows;
	size_t *capacity;
	size_t bytes; /* of its rows */
} array;

static void list_arrays(obj_chunk *chunk, array list[ARRAY_COUNT])
{
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++) {
		obj_rows *rows = &chunk->rows[kind];
		list[kind] =
			(array){(void **)&rows->data, &rows->capacity, rows->count * obj_widths[kind] * sizeof(float)};
	}
	list[OBJ_KIND_COUNT] = (array){(void **)&chunk->distinct, &chunk->distinct_capacity,
		chunk->distinct_count * sizeof *chunk->distinct};
	list[OBJ_KIND_COUNT + 1] = (array){(void **)&chunk->corners, &chunk->corner_capacity,
		chunk->corner_count * sizeof *chunk->corners};
	list[OBJ_KIND_COUNT + 2] = (array){(void **)&chunk->face_sizes, &chunk->face_capacity, chunk->face_count};
}

bool obj_shelves_make(obj_file *file)
{
	file->shelves = nt_calloc(file->threads, sizeof *file->shelves);
	for (unsigned i = 0; file->shelves && i < file->threads && file->chunk_count > FEW_CHUNKS; i++) {
		file->shelves[i].copies = true;
		file->shelves[i].rows.block_bytes = file->shelves[i].corners.block_bytes = BLOCK_BYTES;
	}
	return file->shelves;
}

void obj_shelf_lend(obj_shelf *shelf, obj_chunk *chunk)
{
	array desk[ARRAY_COUNT], list[ARRAY_COUNT];
	list_arrays(&shelf->desk, desk);
	list_arrays(chunk, list);
	for (int i = 0; i < ARRAY_COUNT; i++) {
		*list[i].rows = *desk[i].rows;
		*list[i].capacity = *desk[i].capacity;
		*desk[i].rows = NULL;
		*desk[i].capacity = 0;
	}
}

/* In blocks: the array goes back to the desk, and what is in it stays as a copy. NULL: out of memory, or it is
 * empty. */
static void *copy_rows(nt_arena *arena, const array *from, const array *desk)
{
	void *copy = from->bytes ? nt_arena_alloc(arena, from->bytes, 1) : NULL;
	if (copy)
		memcpy(copy, *from->rows, from->bytes);
	*desk->rows = *from->rows;
	*desk->capacity = *from->capacity;
	return copy;
}

bool obj_shelf_keep(obj_shelf *shelf, obj_chunk *chunk)
{
	array desk[ARRAY_COUNT], list[ARRAY_COUNT];
	bool kept = true;
	list_arrays(&shelf->desk, desk);
	list_arrays(chunk, list);
	for (int i = 0; i < ARRAY_COUNT; i++) {
		nt_arena *arena = i < OBJ_KIND_COUNT ? &shelf->rows : &shelf->corners;
		if (shelf->copies)
			*list[i].rows = copy_rows(arena, &list[i], &desk[i]);
		else if (!nt_arena_adopt(arena, *list[i].rows))
			*list[i].rows = NULL;
		kept = kept && (*list[i].rows || !list[i].bytes);
	}
	return kept;
}

void obj_chunk_free_arrays(obj_chunk *chunk)
{
	array list[ARRAY_COUNT];
	list_arrays(chunk, list);
	for (int i = 0; i < ARRAY_COUNT; i++) {
		free(*list[i].rows);
		*list[i].rows = NULL;
	}
}

void obj_shelves_clear_corners(obj_file *file)
{
	for (unsigned i = 0; file->shelves && i < file->threads; i++)
		nt_arena_free(&file->shelves[i].corners);
}

void obj_shelves_free(obj_file *file)
{
	obj_shelves_clear_corners(file);
	for (unsigned i = 0; file->shelves && i < file->threads; i++)
		nt_arena_free(&file->shelves[i].rows);
	free(file->shelves);
}

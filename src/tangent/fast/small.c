/* SPDX-License-Identifier: MIT */
/*
 * Steps 1 to 4 of a mesh of few triangles: all that they need is one block, and no step is shared among threads. Scenes
 * have thousands of such meshes, and what a call costs before its first triangle is most of their time: with this file
 * 2 triangles take 340 ns instead of 460, 8 take 415 instead of 570, 512 with vertices of their own 18 600 instead of
 * 26 600 (sorted; Zen 5, AVX-512).
 */
#include "tangent/fast/parts.h"

#include <float.h>
#include <string.h>

/* The box of the rows falls out of loading them, where that is an instruction each. */
#if NT_VECTORS && defined(__SSE2__)
#define BOXES
#endif

enum { MOST_VERTICES = 3 * NT_SMALL_TRIANGLES, LEAST_SLOT_BITS = 5, MOST_SLOT_BITS = 12 };
static_assert(2 * MOST_VERTICES <= 1 << MOST_SLOT_BITS, "a table that is half full at most");

/* Begins the block. */
typedef struct small_room {
	nt_weld_row *rows;
	nt_record *records[2];
	uint32_t *cursors, *narrow, *ids;
	uint8_t *flags, *open;
	size_t bounds[2];
	nt_row_box box;
} small_room;

static nt_memory take(char **at, size_t bytes)
{
	char *const taken = *at;
	*at += (bytes + 63) / 64 * 64;
	return taken;
}

/* Memory for so many vertices and triangles; NULL: there is none. */
static small_room *make_room(nt_scratch *scratch, size_t vertices, size_t triangles, size_t step)
{
	const size_t bytes = vertices * sizeof(nt_weld_row) +
		step * (2 * sizeof(nt_record) + (1 + NT_FAN_DEPTH) * sizeof(uint32_t) + 1) +
		triangles * (3 * sizeof(uint32_t) + 1);
	enum { AND_ROOM = 1024 }; /* itself, and what nine arrays are rounded up by */
	char *at = nt_scratch_alloc(scratch, 1, bytes + AND_ROOM);
	if (!at)
		return NULL;
	small_room *room = take(&at, sizeof *room);
	room->rows = take(&at, vertices * sizeof *room->rows);
	for (int o = 0; o < 2; o++)
		room->records[o] = take(&at, step * sizeof *room->records[o]);
	room->cursors = take(&at, (step + NT_FAN_LANES) * sizeof *room->cursors);
	room->narrow = take(&at, NT_FAN_DEPTH * step * sizeof *room->narrow);
	room->ids = take(&at, 3 * triangles * sizeof *room->ids);
	room->flags = take(&at, triangles);
	room->open = take(&at, step / NT_LANES);
	return room;
}

/* Loads the rows of vertices, which have a box, and numbers each by the first that is equal. False: a value is NaN. */
static bool number_rows(const nmtan_mesh *mesh, size_t count, small_room *room, uint32_t *numbers, bool *equal)
{
	nt_weld_row *const rows = room->rows;
	const uint64_t odd[4] = {0x9e3779b97f4a7c15u, 0xa4093822299f31d1u, 0x082efa98ec4e6c89u, 0x452821e638d01377u};
	uint16_t slots[1 << MOST_SLOT_BITS]; /* 0, or one more than a vertex */
	unsigned bits = LEAST_SLOT_BITS;
	nt_weld_flags unordered = {0};
	while ((size_t)1 << bits < 2 * count)
		bits++;
	memset(slots, 0, sizeof *slots << bits);
	uint64_t any_equal = 0;
#ifdef BOXES
	__m128 low = _mm_set1_ps(FLT_MAX), high = _mm_set1_ps(-FLT_MAX);
#endif
	for (size_t v = 0; v < count; v++) {
		unordered |= nt_weld_load(mesh, v, &rows[v]);
#ifdef BOXES
		const __m128 position = _mm_loadu_ps(rows[v].position);
		low = _mm_min_ps(low, position);
		high = _mm_max_ps(high, position);
#endif
		const uint64_t hash = nt_weld_word(&rows[v], 0) * odd[0] + nt_weld_word(&rows[v], 1) * odd[1] +
			(nt_weld_word(&rows[v], 2) * odd[2] + nt_weld_word(&rows[v], 3) * odd[3]);
		size_t at = hash >> (64 - bits);
		while (slots[at] && !nt_weld_same(&rows[slots[at] - 1], &rows[v]))
			at = (at + 1) & (((size_t)1 << bits) - 1);
		any_equal |= slots[at];
		if (!slots[at])
			slots[at] = (uint16_t)(v + 1);
		numbers[v] = slots[at] - 1u;
	}
#ifdef BOXES
	_mm_storeu_ps(room->box.low, low);
	_mm_storeu_ps(room->box.high, high);
#endif
	*equal = any_equal != 0;
	return nt_weld_ordered(unordered);
}

/* The welded vertex of each corner: the mesh's own indices, where none is equal to another. */
static const uint32_t *number_corners(const nmtan_mesh *mesh, size_t corner_count, const uint32_t *numbers, bool equal,
	uint32_t *ids)
{
	if (!equal && mesh->indices)
		return mesh->indices;
	for (size_t c = 0; c < corner_count; c++)
		ids[c] = numbers[nt_vertex_of(mesh, c)];
	return ids;
}

/* The nt_record_maker. */
static bool clear_records(nt_fast *fast, int orient, unsigned range, void *context)
{
	(void)range;
	small_room *room = context;
	nt_record *const records = room->records[orient];
	const size_t count = (fast->vertex_count + NT_LANES - 1) / NT_LANES * NT_LANES;
	for (size_t v = 0; v < count; v++)
		memcpy(&records[v], &nt_no_record, sizeof nt_no_record);
	fast->records[orient] = records;
	return true;
}

bool nt_fast_is_small(const nt_fast *fast)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	return NT_NARROW_LIMIT > 0 && fast->triangle_count <= NT_SMALL_TRIANGLES && !mesh->face_sizes &&
	       (!mesh->indices || mesh->vertex_count <= MOST_VERTICES) && !fast->wants_more;
}

nmtan_status nt_fast_weld_small(nt_fast *fast, bool *welded)
{
	const nt_solve *solve = fast->solve;
	const nmtan_mesh *mesh = solve->mesh;
	uint32_t numbers[MOST_VERTICES];
	bool equal;
	fast->vertex_count = mesh->indices ? mesh->vertex_count : solve->corner_count;
	/* an odd number of blocks, as in adjacency.c */
	const size_t step = ((fast->vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES | 1) * NT_FAN_LANES;
	small_room *room = make_room(solve->scratch, fast->vertex_count, fast->triangle_count, step);
	if (!room)
		return NMTAN_ERROR_MEMORY;
	*welded = number_rows(mesh, fast->vertex_count, room, numbers, &equal);
#ifdef BOXES
	fast->box = *welded ? &room->box : NULL; /* minima and maxima lose NaN */
#endif
	fast->rows = room->rows;
	fast->triangles.ids = number_corners(mesh, solve->corner_count, numbers, equal, room->ids);
	fast->flags = (uint8_t *)memset(room->flags, 0, fast->triangle_count);
	room->bounds[0] = 0;
	room->bounds[1] = fast->triangle_count;
	fast->ranges = (nt_triangle_ranges){.count = 1, .bounds = room->bounds};
	fast->adjacency = (nt_adjacency){.vertex_count = fast->vertex_count, .ranges = 1, .cursors = room->cursors,
		.narrow = room->narrow, .step = (uint32_t)step};
	fast->record_step = 1;
	fast->open = room->open;
	fast->small = room;
	return NMTAN_OK;
}

void nt_fast_add_small(nt_fast *fast, const nt_kernels *kernels)
{
	for (size_t v = 0; v < fast->vertex_count; v++)
		fast->adjacency.cursors[v] = (uint32_t)v;
	kernels->accumulate(fast, 0, fast->triangle_count, 0, clear_records, fast->small);
}

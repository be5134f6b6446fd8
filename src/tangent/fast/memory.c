/* SPDX-License-Identifier: MIT */
/*
 * Which memory the fast path works in. A large mesh needs as much of it as its output has, and fresh pages cost more
 * than what is done in them. So what ends with step 5 lies in the output, as far as it fits, and step 7 works where
 * the steps before have been.
 *
 *   array              steps  memory
 *   tables of the weld 1      borrowed
 *   ids, flags, cuts   1-8    scratch
 *   rows               1-5    borrowed where there is memory, see has_room_for_rows(); binned: scratch
 *   cursors            3-5    as the rows
 *   entries            3-5    borrowed
 *   sums of bins       4-5    the output: 16 bytes a corner, as many as it has
 *   entries of bins    4-5    scratch
 *   records            4-8    scratch; binned: that of the rows, see nt_fast_place_records()
 *   complex vertices   7      the largest of rows and entries that does not lie in the output
 *
 * Borrowed is the output itself, or, in a sparse solve, whose output is not filled so that its pages need not exist,
 * what the caller fills afterwards (nt_solve.spare).
 */
#include "tangent/fast/parts.h"

static size_t output_bytes(const nt_solve *solve)
{
	return solve->corner_count * 4 * sizeof(float);
}

/* Whether there is room for the rows beside the entries. If not, the larger of them should have it. */
static bool has_room_for_rows(const nt_fast *fast, const nt_borrowed *memory)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	const size_t free = (size_t)(memory->end - memory->begin);
	/* without indices: two triangles for a vertex */
	const size_t vertices = mesh->indices ? mesh->vertex_count : fast->triangle_count / 2;
	const size_t entries = 3 * fast->triangle_count * sizeof(nt_fan_entry);
	const size_t rows = vertices * (sizeof(nt_weld_row) + sizeof(uint32_t));
	return rows + entries <= free || entries > free || rows > entries;
}

void nt_fast_plan_memory(const nt_fast *fast, bool binned, size_t least_bytes, nt_fast_memory *memory)
{
	const nt_solve *solve = fast->solve;
	const size_t bytes = output_bytes(solve);
	/* entries of a small mesh that lie in two places take longer */
	memory->borrowed = fast->sparse ? nt_borrow(solve->spare, solve->spare_bytes, solve->scratch)
		: nt_borrow(solve->tangents, bytes < least_bytes ? 0 : bytes, solve->scratch);
	memory->none = nt_borrow(NULL, 0, solve->scratch);
	/* rows of a binned mesh are read at random, which is quicker in the large pages of the scratch */
	memory->rows = !binned && has_room_for_rows(fast, &memory->borrowed) ? &memory->borrowed : &memory->none;
	memory->bin_sums = fast->sparse ? NULL : (nt_record *)solve->tangents;
}

/* Records take the rows' place: settle looks at the normals of a block before it writes its records. Records of both
 * orientations lie in pairs. Records of one are packed, so that write reads fewer lines; but only one thread alone
 * has passed all the rows that it then overwrites, and whole blocks fit where there is one. */
bool nt_fast_place_records(nt_fast *fast, const bool orientations[2])
{
	static_assert(sizeof(nt_weld_row) == 2 * sizeof(nt_record), "a pair of records is as large as a row");
	const bool both = orientations[0] && orientations[1];
	nt_record *records = (nt_record *)fast->rows;
	if (!both && (fast->ranges.count > 1 || fast->vertex_count < NT_LANES))
		records = nt_scratch_alloc(fast->solve->scratch, fast->vertex_count + NT_LANES, sizeof *records);
	for (int o = 0; o < 2; o++)
		fast->records[o] = orientations[o] ? records + (both ? o : 0) : NULL;
	fast->record_step = both ? 2 : 1;
	return records;
}

nt_borrowed nt_fast_left_memory(const nt_fast *fast)
{
	const nt_solve *solve = fast->solve;
	const nt_adjacency *a = &fast->adjacency;
	/* records have taken the place of the rows of a binned mesh */
	const bool binned = fast->bins.cursors;
	const struct {
		const void *memory;
		size_t bytes;
	} arrays[4] = {
		{fast->rows, binned ? 0 : fast->vertex_count * sizeof *fast->rows},
		{binned ? (const void *)fast->bins.entries : a->entries,
			binned ? 3 * fast->triangle_count * NT_BINNED_ENTRY : a->entry_count * sizeof *a->entries},
		{a->narrow, nt_adjacency_is_narrow(a) ? NT_FAN_DEPTH * a->step * sizeof *a->narrow : 0},
	};
	nt_borrowed largest = nt_borrow(NULL, 0, solve->scratch);
	for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
		const uintptr_t at = (uintptr_t)arrays[i].memory - (uintptr_t)solve->tangents;
		const bool in_output = at < output_bytes(solve);
		if (!in_output && arrays[i].bytes > (size_t)(largest.end - largest.begin))
			largest = nt_borrow((void *)arrays[i].memory, arrays[i].bytes, solve->scratch);
	}
	return largest;
}

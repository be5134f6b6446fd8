/* SPDX-License-Identifier: MIT */
/*
 * The weld without a hash, for rows that were made to have one: some ten times as long as a table takes for others,
 * but no more.
 */
#include "topology/crit_bit.h"
#include "topology/weld_parts.h"

bool nt_weld_by_bits(nt_welder *w)
{
	w->rows = NULL;
	w->row_count = 0;
	w->unordered = false;
	if (!nt_weld_grow_rows(w, w->item_count))
		return false;
	nt_crit_bit tree = {.keys = (const nt_crit_bit_word *)w->rows, .words = sizeof *w->rows / sizeof *tree.keys,
		.nodes = nt_borrowed_alloc(w->memory, w->item_count, sizeof *tree.nodes)};
	if (!tree.nodes)
		return false;
	for (size_t i = 0; i < w->item_count; i++) {
		const uint32_t next = (uint32_t)w->row_count;
		const size_t vertex = w->items ? w->items[i] : w->first_vertex + i;
		const bool ordered = nt_weld_ordered(nt_weld_load(w->mesh, vertex, &w->rows[next]));
		w->numbers[i] = ordered ? nt_crit_bit_add(&tree, next) : next;
		w->row_count += w->numbers[i] == next;
		w->unordered |= !ordered;
	}
	return true;
}

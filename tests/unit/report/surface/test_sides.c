/* SPDX-License-Identifier: MIT */
/* All sides of a mesh come by their edges, in the order that sorting all of them at once gives. */
#include "lattice.h"

typedef struct sorted_side {
	uint32_t low, high, side;
} sorted_side;

static int by_edge(const void *a, const void *b)
{
	const sorted_side *x = a, *y = b;
	if (x->low != y->low)
		return x->low < y->low ? -1 : 1;
	if (x->high != y->high)
		return x->high < y->high ? -1 : 1;
	return x->side < y->side ? -1 : x->side > y->side;
}

static sorted_side *sort_all(const nt_surface *s, size_t *count)
{
	sorted_side *sides = calloc(3 * s->triangle_count, sizeof *sides);
	*count = 0;
	for (uint32_t side = 0; side < 3 * s->triangle_count; side++) {
		if (!nt_has_edges(s, side / 3))
			continue;
		const uint32_t a = nt_side_point(s, side), b = nt_side_point(s, nt_side_next(side));
		assert_int_not_equal(a, b);
		sides[(*count)++] = (sorted_side){a < b ? a : b, a < b ? b : a, side};
	}
	qsort(sides, *count, sizeof *sides, by_edge);
	return sides;
}

TEST(edges_come_in_order)
{
	lattice *l = lattice_new(true);
	for (unsigned threads = 1; threads <= 3; threads++) {
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_surface s;
		assert_int_equal(nt_surface_build(&s, &l->mesh, &scratch), NT_OK);
		for (size_t b = 0; b < nt_block_count(&s); b++)
			nt_surface_measure(&s, b);
		size_t count, seen = 0, right = 0;
		sorted_side *sides = sort_all(&s, &count);
		assert_int_equal(nt_surface_list_sides(&s, threads), NT_OK);
		nt_edge_side *edges = calloc(s.most_sides, sizeof *edges);
		for (uint32_t low = 0; low < s.point_count; low++) {
			const size_t these = nt_surface_edges(&s, low, edges);
			for (size_t i = 0; i < these && seen < count; i++, seen++) {
				const sorted_side *x = &sides[seen];
				right += x->low == low && x->high == edges[i].high && x->side == edges[i].side &&
					edges[i].ascending == (nt_side_point(&s, x->side) == low) &&
					edges[i].orientation == s.orientation[x->side / 3];
			}
		}
		assert_int_equal(right, count);
		free(edges);
		free(sides);
		nt_surface_free_sides(&s);
		nt_scratch_free(&scratch);
	}
	free(l);
}

/* SPDX-License-Identifier: MIT */
/* All sides of a mesh come by their edges, in the order that sorting all of them at once gives. */
#include "lattice.h"
#include "report/surface/edge_bins.h"

typedef struct sorted_side {
	uint32_t low, high, side;
	bool ascending;
} sorted_side;

typedef struct expected {
	const nt_edge_bins *bins;
	const nt_surface *surface;
	sorted_side *sides;
	size_t count, right;
} expected;

static int by_edge(const void *a, const void *b)
{
	const sorted_side *x = a, *y = b;
	if (x->low != y->low)
		return x->low < y->low ? -1 : 1;
	if (x->high != y->high)
		return x->high < y->high ? -1 : 1;
	return x->side < y->side ? -1 : x->side > y->side;
}

static void sort_all(const nt_surface *s, expected *e)
{
	e->sides = calloc(3 * s->triangle_count, sizeof *e->sides);
	for (uint32_t side = 0; side < 3 * s->triangle_count; side++) {
		if (!nt_has_edges(s, side / 3))
			continue;
		const uint32_t a = nt_side_point(s, side), b = nt_side_point(s, nt_side_next(side));
		assert_int_not_equal(a, b);
		e->sides[e->count++] = (sorted_side){a < b ? a : b, a < b ? b : a, side, a < b};
	}
	qsort(e->sides, e->count, sizeof *e->sides, by_edge);
}

static void compare_bin(void *context, size_t bin, const nt_edge_side *sides, size_t count, unsigned slot)
{
	expected *e = context;
	size_t first = 0, right = 0;
	for (size_t i = 0; i < bin; i++)
		first += e->bins->totals[i];
	for (size_t i = 0; i < count && slot < e->bins->slots && count == e->bins->totals[bin]; i++) {
		const sorted_side *x = &e->sides[first + i];
		const nt_edge_side *y = &sides[i];
		const bool joint = nt_bit(e->surface->joints, x->low) || nt_bit(e->surface->joints, x->high);
		right += y->side == x->side && y->high == x->high &&
			(bin << e->bins->bits) + (y->low >> NT_EDGE_FLAGS) == x->low &&
			((y->low & NT_EDGE_ASCENDING) != 0) == x->ascending &&
			nt_edge_orientation(y) == e->surface->orientation[x->side / 3] &&
			((y->low & NT_EDGE_JOINT) != 0) == joint;
	}
	__atomic_add_fetch(&e->right, right, __ATOMIC_RELAXED);
}

TEST(edges_come_in_order)
{
	lattice *l = lattice_new(true);
	expected e = {0};
	for (unsigned threads = 1; threads <= 3; threads++) {
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_surface s;
		nt_edge_bins bins;
		assert_int_equal(nt_surface_build(&s, &l->mesh, &scratch), NT_OK);
		for (size_t b = 0; b < nt_block_count(&s); b++)
			nt_surface_measure(&s, b);
		assert_int_equal(nt_edge_bins_make(&bins, &s, threads, &scratch), NT_OK);
		assert_true(bins.count > 4);
		if (!e.sides)
			sort_all(&s, &e);
		e.bins = &bins;
		e.surface = &s;
		e.right = 0;
		assert_int_equal(nt_edge_bins_visit(&bins, &scratch, compare_bin, &e), NT_OK);
		assert_int_equal(e.right, e.count);
		nt_scratch_free(&scratch);
	}
	free(e.sides);
	free(l);
}

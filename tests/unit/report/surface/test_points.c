/* SPDX-License-Identifier: MIT */
/* Points are what a table of all places says, numbered by first use. */
#include "lattice.h"

enum { PLACES = LATTICE_SIDE * LATTICE_SIDE * LATTICE_SIDE };

typedef struct expected {
	uint32_t points[3 * LATTICE_TRIANGLES], point_count;
	uint32_t vertices[PLACES + LATTICE_TRIANGLES]; /* of each point: how many */
	bool joints[PLACES + LATTICE_TRIANGLES];
} expected;

static expected *expect(const lattice *l)
{
	static uint32_t point_at[PLACES];
	expected *e = calloc(1, sizeof *e);
	memset(e->points, 0xff, sizeof e->points);
	memset(point_at, 0xff, sizeof point_at);
	for (size_t c = 0; c < l->mesh.corner_count; c++) {
		const size_t v = l->mesh.indices ? l->mesh.indices[c] : c;
		if (e->points[v] != NT_NONE)
			continue;
		uint32_t own = NT_NONE, *point = l->places[v] == NT_NONE ? &own : &point_at[l->places[v]];
		if (*point == NT_NONE)
			*point = e->point_count++;
		e->points[v] = *point;
		e->vertices[*point]++;
		e->joints[*point] |= e->vertices[*point] > 1 || isnan(l->texcoords[v][0]);
	}
	return e;
}

static void compare(bool indexed)
{
	lattice *l = lattice_new(indexed);
	expected *e = expect(l);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_surface s;
	assert_int_equal(nt_surface_build(&s, &l->mesh, &scratch), NT_OK);
	assert_int_equal(s.point_count, e->point_count);
	assert_memory_equal(s.points, e->points, l->mesh.vertex_count * sizeof *s.points);
	for (size_t p = 0; p < s.point_count; p++)
		assert_int_equal(nt_bit(s.joints, p), e->joints[p]);
	nt_scratch_free(&scratch);
	free(e);
	free(l);
}

TEST(points_of_an_indexed_mesh)
{
	compare(true);
}

TEST(points_of_a_soup)
{
	compare(false);
}

/* SPDX-License-Identifier: MIT */
/*
 * Outlines of meshes made by hand, read back as numbers: region count; of each island and winding, and how many loops;
 * of each how many points, and these.
 */
#include "test.h"

#include "report/pack/outline.h"

enum { MOST = 64 };

/* Every number of the stream, differences undone. */
typedef struct regions {
	size_t count;
	struct {
		uint32_t region, loop_count, sizes[MOST], points[MOST][MOST];
	} items[MOST];
} regions;

static const unsigned char *get_varint(const unsigned char *at, uint32_t *value)
{
	*value = 0;
	for (unsigned shift = 0;; shift += 7) {
		*value |= (uint32_t)(*at & 127) << shift;
		if (!(*at++ & 128))
			return at;
	}
}

static const unsigned char *add_difference(const unsigned char *at, uint32_t *value)
{
	uint32_t code;
	at = get_varint(at, &code);
	*value += code & 1 ? 0u - (code + 1) / 2 : code / 2;
	return at;
}

static void outline(const nt_outlined *mesh, regions *r)
{
	nt_buffer out = {0};
	assert_int_equal(nt_outline_islands(mesh, &out), NT_OK);
	const unsigned char *at = (const unsigned char *)out.data;
	uint32_t count, region = 0, point = 0;
	at = get_varint(at, &count);
	r->count = count;
	for (uint32_t i = 0; i < count; i++) {
		at = add_difference(at, &region);
		r->items[i].region = region;
		at = get_varint(at, &r->items[i].loop_count);
		for (uint32_t l = 0; l < r->items[i].loop_count; l++) {
			at = get_varint(at, &r->items[i].sizes[l]);
			for (uint32_t k = 0; k < r->items[i].sizes[l]; k++) {
				at = add_difference(at, &point);
				r->items[i].points[l][k] = point;
			}
		}
	}
	assert_ptr_equal(at, out.data + out.size);
	nt_buffer_free(&out);
}

/* Twice the area that the loops of a region enclose. */
static double enclosed(const nt_outlined *mesh, const regions *r, size_t region)
{
	double sum = 0.0;
	for (uint32_t l = 0; l < r->items[region].loop_count; l++)
		for (uint32_t k = 0, n = r->items[region].sizes[l]; k < n; k++) {
			const float *a = mesh->texcoords + 2 * (size_t)r->items[region].points[l][k];
			const float *b = mesh->texcoords + 2 * (size_t)r->items[region].points[l][(k + 1) % n];
			sum += (double)a[0] * b[1] - (double)b[0] * a[1];
		}
	return sum;
}

static regions found;

TEST(a_square_of_two_triangles_has_one_loop_of_four_points)
{
	/* the diagonal's vertices are there twice, with the same coordinates; -0 is 0 */
	static const float uv[] = {0, 0, 1, 0, 1, 1, -0.0f, 0, 1, 1, 0, 1};
	static const uint32_t indices[] = {0, 1, 2, 3, 4, 5};
	static const int8_t orientation[] = {1, 1};
	const nt_outlined mesh = {6, 2, indices, uv, orientation, NULL};
	outline(&mesh, &found);
	assert_int_equal(found.count, 1);
	assert_int_equal(found.items[0].region, 0);
	assert_int_equal(found.items[0].loop_count, 1);
	assert_int_equal(found.items[0].sizes[0], 4);
	assert_true(enclosed(&mesh, &found, 0) == 2.0);
}

TEST(each_winding_and_island_is_a_region_and_degenerate_ones_none)
{
	static const float uv[] = {0, 0, 1, 0, 0, 1, 0.5f, 0.5f};
	static const uint32_t indices[] = {0, 1, 2, 0, 2, 1, 0, 1, 2, 1, 2, 3, 0, 1, 2};
	static const int8_t orientation[] = {1, -1, 1, 0, 1};
	static const uint32_t islands[] = {0, 0, 5, 5, NT_NONE};
	const nt_outlined mesh = {4, 5, indices, uv, orientation, islands};
	outline(&mesh, &found);
	assert_int_equal(found.count, 3);
	assert_int_equal(found.items[0].region, 0);
	assert_int_equal(found.items[1].region, 1); /* island 0, mirrored: its loop is counterclockwise too */
	assert_int_equal(found.items[2].region, 10);
	for (size_t i = 0; i < 3; i++)
		assert_true(found.items[i].sizes[0] == 3 && enclosed(&mesh, &found, i) == 1.0);
}

TEST(a_frame_has_an_outer_and_an_inner_loop)
{
	/* corners of a square of 3, then of one of 1 in its middle */
	static const float uv[] = {0, 0, 3, 0, 3, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2};
	static const uint32_t indices[] = {0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 7, 6, 3, 0, 7, 0, 4, 7};
	static const int8_t orientation[] = {1, 1, 1, 1, 1, 1, 1, 1};
	const nt_outlined mesh = {8, 8, indices, uv, orientation, NULL};
	outline(&mesh, &found);
	assert_int_equal(found.count, 1);
	assert_int_equal(found.items[0].loop_count, 2);
	assert_true(enclosed(&mesh, &found, 0) == 2.0 * (9 - 1));
}

TEST(triangles_that_touch_at_a_point_are_closed_loops)
{
	static const float uv[] = {0, 0, 1, 1, 0, 2, 2, 0, 2, 2};
	static const uint32_t indices[] = {0, 1, 2, 1, 3, 4};
	static const int8_t orientation[] = {1, 1};
	const nt_outlined mesh = {5, 2, indices, uv, orientation, NULL};
	outline(&mesh, &found);
	uint32_t points = 0;
	for (uint32_t l = 0; l < found.items[0].loop_count; l++)
		points += found.items[0].sizes[l];
	assert_int_equal(points, 6);
	assert_true(enclosed(&mesh, &found, 0) == 4.0);
}

TEST(one_triangle_twice_is_wound_around_twice)
{
	static const float uv[] = {0, 0, 1, 0, 0, 1};
	static const uint32_t indices[] = {0, 1, 2, 0, 1, 2};
	static const int8_t orientation[] = {1, 1};
	const nt_outlined mesh = {3, 2, indices, uv, orientation, NULL};
	outline(&mesh, &found);
	assert_true(enclosed(&mesh, &found, 0) == 2.0);
}

TEST(no_triangles_have_no_regions)
{
	const nt_outlined mesh = {0, 0, NULL, NULL, NULL, NULL};
	outline(&mesh, &found);
	assert_int_equal(found.count, 0);
}

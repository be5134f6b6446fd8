/* SPDX-License-Identifier: MIT */
/*
 * What the library is for, on the smallest mesh that shows it: two unit quads side by side in the plane
 * z = 0. The texture runs to the right on the left quad and is mirrored on the right one, as an artist
 * does with the two halves of a face. The vertices on the seam have one position, one normal and one UV,
 * but two tangents.
 *
 *     3 ---- 2 ---- 5        u:  0      1      0
 *     |      |      |
 *     0 ---- 1 ---- 4
 */
#include "nmtan.h"
#include "test.h"

static const float positions[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
static const float normals[6][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const float texcoords[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {0, 1}};
static const uint32_t triangles[12] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};

static const nmtan_mesh mesh = {
	.struct_bytes = sizeof mesh,
	.face_count = 4,
	.vertex_count = 6,
	.indices = triangles,
	.positions = &positions[0][0],
	.normals = &normals[0][0],
	.texcoords = &texcoords[0][0],
};

static const nmtan_options mikktspace = NMTAN_OPTIONS_INIT;
static const nmtan_options raw = {.struct_bytes = sizeof raw, .repair = NMTAN_REPAIR_OFF};
static const nmtan_options area = {.struct_bytes = sizeof area, .method = NMTAN_METHOD_AREA};
static const nmtan_options lengyel = {.struct_bytes = sizeof lengyel, .method = NMTAN_METHOD_LENGYEL};

/* On the left u grows along +x, and B = cross(N, T) w must run along +y: w = +1. On the right u grows
 * along -x while v still grows along +y: cross((0,0,1), (-1,0,0)) = (0,-1,0), so w = -1. */
static void check_tangents(const nmtan_options *options)
{
	float tangents[12][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, options, &output, &counts), NMTAN_OK);
	for (int c = 0; c < 12; c++) {
		const float left[4] = {1, 0, 0, 1}, right[4] = {-1, 0, 0, -1};
		const float *expected = c < 6 ? left : right;
		for (int i = 0; i < 4; i++)
			assert_true(tangents[c][i] == expected[i]);
	}
	assert_int_equal(counts.mirrored, 2);
	assert_int_equal(counts.degenerate_texcoords, 0);
}

TEST(tangents_follow_u_and_w_tells_the_mirrored_side)
{
	check_tangents(&mikktspace);
	check_tangents(&raw);
	check_tangents(&area);
	check_tangents(&lengyel);
}

/* The two vertices of the seam, 1 and 2, get a copy each, in the order in which the right side meets
 * them; nothing else changes. */
static void check_split(const nmtan_options *options)
{
	float tangents[12][4], vertex_tangents[18][4];
	uint32_t indices[12], sources[12];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	assert_int_equal(nmtan_tangents(&mesh, options, &output, NULL), NMTAN_OK);
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = indices, .sources = sources,
		.source_capacity = 12,
		.vertex_tangents = &vertex_tangents[0][0]};
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], options, &split), NMTAN_OK);
	const uint32_t expected[12] = {0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7};
	assert_int_equal(split.source_count, 2);
	assert_int_equal(sources[0], 1);
	assert_int_equal(sources[1], 2);
	assert_memory_equal(indices, expected, sizeof expected);
	for (int c = 0; c < 12; c++)
		assert_memory_equal(vertex_tangents[indices[c]], tangents[c], sizeof tangents[c]);
}

TEST(seam_vertices_are_split_and_the_rest_stays)
{
	check_split(&mikktspace);
	check_split(&area);
}

/* The same mesh with all tangents at vertex 2 made different: its corners 2, 4 and 11 need two copies, and the
 * count that comes before everything else says so. */
TEST(copies_are_counted_before_there_is_room_for_them)
{
	float tangents[12][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	assert_int_equal(nmtan_tangents(&mesh, &mikktspace, &output, NULL), NMTAN_OK);
	tangents[4][0] = 0.5f;
	const uint32_t expected[6] = {0, 1, 2, 0, 0, 0};
	uint32_t copy_counts[6], indices[12], sources[3];
	memset(copy_counts, 0xff, sizeof copy_counts);
	nmtan_split_output split = NMTAN_SPLIT_OUTPUT_INIT;
	split.copy_counts = copy_counts;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], &mikktspace, &split), NMTAN_OK);
	assert_int_equal(split.source_count, 3);
	assert_memory_equal(copy_counts, expected, sizeof expected);

	memset(copy_counts, 0xff, sizeof copy_counts);
	split.indices = indices;
	split.sources = sources;
	split.source_capacity = split.source_count;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], &mikktspace, &split), NMTAN_OK);
	assert_int_equal(split.source_count, 3);
	assert_memory_equal(copy_counts, expected, sizeof expected);
	split.source_capacity = 2;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], &mikktspace, &split), NMTAN_ERROR_CAPACITY);
}

/* nmtan_vertex_tangents() counts them too. */
static void check_counts(const nmtan_options *options)
{
	uint32_t indices[12], sources[12], copy_counts[6];
	float vertex_tangents[18][4];
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = indices, .sources = sources,
		.source_capacity = 12,
		.vertex_tangents = &vertex_tangents[0][0], .copy_counts = copy_counts};
	memset(copy_counts, 0xff, sizeof copy_counts);
	assert_int_equal(nmtan_vertex_tangents(&mesh, options, &split, NULL), NMTAN_OK);
	const uint32_t expected[6] = {0, 1, 1, 0, 0, 0};
	assert_memory_equal(copy_counts, expected, sizeof expected);
}

TEST(a_solve_with_split_counts_copies)
{
	check_counts(&mikktspace);
	check_counts(&area);
}

int main(void)
{
	return run_group("api/mirrored_quad");
}

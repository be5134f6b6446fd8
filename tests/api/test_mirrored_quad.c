/* SPDX-License-Identifier: MIT */
/*
 * The purpose of the library, on the smallest mesh that shows it: two unit quads side by side in the plane
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

#include <stdbool.h>
#include <stdlib.h>

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
 * them; nothing else changes. A solve with split gives the same, and both count copies. */
static void check_split(const nmtan_options *options)
{
	float tangents[12][4], vertex_tangents[18][4];
	uint32_t indices[12], sources[12], copy_counts[6];
	const uint32_t expected[12] = {0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7}, expected_counts[6] = {0, 1, 1, 0, 0, 0};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	assert_int_equal(nmtan_tangents(&mesh, options, &output, NULL), NMTAN_OK);
	for (int solved = 0; solved < 2; solved++) {
		nmtan_split_output split = {.struct_bytes = sizeof split, .indices = indices, .sources = sources,
			.source_capacity = 12, .vertex_tangents = &vertex_tangents[0][0], .copy_counts = copy_counts};
		memset(copy_counts, 0xff, sizeof copy_counts);
		assert_int_equal(solved ? nmtan_vertex_tangents(&mesh, options, &split, NULL)
					: nmtan_split(&mesh, &tangents[0][0], options, &split), NMTAN_OK);
		assert_int_equal(split.source_count, 2);
		assert_int_equal(sources[0], 1);
		assert_int_equal(sources[1], 2);
		assert_memory_equal(indices, expected, sizeof expected);
		assert_memory_equal(copy_counts, expected_counts, sizeof expected_counts);
		for (int c = 0; c < 12; c++)
			assert_memory_equal(vertex_tangents[indices[c]], tangents[c], sizeof tangents[c]);
	}
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

/* ---- interleaved, in place ---- */

/* Two orders of the same attributes, with a word of the caller's (its number) and room that stays 0xee. */
static const struct {
	nmtan_layout layout;
	size_t number_offset;
} layouts[] = {
	{{.stride_bytes = 52, .position_offset = 0, .normal_offset = 12, .texcoord_offset = 24, .tangent_offset = 32},
		48},
	{{.stride_bytes = 60, .position_offset = 28, .normal_offset = 40, .texcoord_offset = 16, .tangent_offset = 0},
		24},
};
enum { MOST_BYTES = 60 * 8 };

static void *at(unsigned char *vertices, const nmtan_layout *layout, size_t vertex, size_t offset)
{
	return vertices + vertex * layout->stride_bytes + offset;
}

static void interleave(size_t row, bool v_down, nmtan_layout *layout, unsigned char *vertices)
{
	*layout = layouts[row].layout;
	layout->v_down = v_down;
	memset(vertices, 0xee, MOST_BYTES);
	for (uint32_t v = 0; v < 6; v++) {
		const float texcoord[2] = {texcoords[v][0], v_down ? 1 - texcoords[v][1] : texcoords[v][1]};
		memcpy(at(vertices, layout, v, layout->position_offset), positions[v], sizeof positions[v]);
		memcpy(at(vertices, layout, v, layout->normal_offset), normals[v], sizeof normals[v]);
		memcpy(at(vertices, layout, v, layout->texcoord_offset), texcoord, sizeof texcoord);
		memcpy(at(vertices, layout, v, layouts[row].number_offset), &v, sizeof v);
	}
}

/* Copies have all of their source but its tangent. */
TEST(interleaved_vertices_get_tangents_and_copies_in_place)
{
	for (size_t i = 0; i < 4; i++) {
		const size_t row = i / 2;
		unsigned char vertices[MOST_BYTES], before[MOST_BYTES];
		uint32_t indices[12];
		nmtan_layout layout;
		interleave(row, i & 1, &layout, vertices);
		memcpy(before, vertices, sizeof before);
		memcpy(indices, triangles, sizeof indices);
		assert_int_equal(nmtan_generate(&layout, vertices, 6, 8, indices, 12, &mikktspace), 8);
		const uint32_t expected[12] = {0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7};
		const size_t sources[8] = {0, 1, 2, 3, 4, 5, 1, 2};
		assert_memory_equal(indices, expected, sizeof expected);
		for (size_t v = 0; v < 8; v++) {
			const float left[4] = {1, 0, 0, 1}, right[4] = {-1, 0, 0, -1};
			const void *tangent = at(vertices, &layout, v, layout.tangent_offset);
			assert_memory_equal(tangent, v < 4 ? left : right, sizeof left);
			memcpy(at(before, &layout, v, 0), at(before, &layout, sources[v], 0), layout.stride_bytes);
			memcpy(at(before, &layout, v, layout.tangent_offset), tangent, sizeof left);
		}
		assert_memory_equal(vertices, before, sizeof before);
	}
}

TEST(too_little_room_says_how_much_is_needed_and_changes_only_tangents)
{
	for (size_t capacity = 6; capacity < 8; capacity++) {
		unsigned char vertices[MOST_BYTES], before[MOST_BYTES];
		uint32_t indices[12];
		nmtan_layout layout;
		interleave(1, true, &layout, vertices);
		memcpy(before, vertices, sizeof before);
		memcpy(indices, triangles, sizeof indices);
		assert_int_equal(nmtan_generate(&layout, vertices, 6, capacity, indices, 12, NULL), 8);
		assert_memory_equal(indices, triangles, sizeof triangles);
		for (size_t v = 0; v < 6; v++)
			memset(at(vertices, &layout, v, layout.tangent_offset), 0xee, 16);
		assert_memory_equal(vertices, before, capacity * layout.stride_bytes);
		assert_int_equal(nmtan_generate(&layout, vertices, 6, 8, indices, 12, NULL), 8);
	}
}

/* Each corner its own vertex: nothing is copied. */
TEST(triangles_without_indices_get_tangents_in_place)
{
	unsigned char vertices[MOST_BYTES];
	nmtan_layout layout;
	interleave(0, false, &layout, vertices);
	assert_int_equal(nmtan_generate(&layout, vertices, 3, 3, NULL, 0, NULL), 3);
	const float expected[4] = {1, 0, 0, 1};
	for (size_t v = 0; v < 3; v++)
		assert_memory_equal(at(vertices, &layout, v, layout.tangent_offset), expected, sizeof expected);
}

/* Sixty-five thousand and more vertices lie before the quads: their numbers need 32 bits. */
TEST(indices_have_32_bits)
{
	enum { BEFORE = 70000, STRIDE = 52 };
	unsigned char *vertices = calloc(BEFORE + 8, STRIDE), own[MOST_BYTES];
	uint32_t indices[12];
	nmtan_layout layout;
	assert_non_null(vertices);
	interleave(0, false, &layout, own);
	memcpy(vertices + BEFORE * STRIDE, own, 6 * STRIDE);
	for (int c = 0; c < 12; c++)
		indices[c] = triangles[c] + BEFORE;
	assert_int_equal(nmtan_generate(&layout, vertices, BEFORE + 6, BEFORE + 8, indices, 12, NULL), BEFORE + 8);
	assert_int_equal(indices[6], BEFORE + 6);
	assert_int_equal(indices[11], BEFORE + 7);
	assert_memory_equal(at(vertices, &layout, BEFORE + 6, 0), at(vertices, &layout, BEFORE + 1, 0), 32);
	free(vertices);
}

TEST(what_is_wrong_gives_no_vertices)
{
	unsigned char vertices[MOST_BYTES];
	uint32_t indices[12], beyond[3] = {0, 1, 6};
	nmtan_layout layout;
	interleave(0, false, &layout, vertices);
	memcpy(indices, triangles, sizeof indices);
	assert_int_equal(nmtan_generate(NULL, vertices, 6, 8, indices, 12, NULL), 0);
	assert_int_equal(nmtan_generate(&layout, NULL, 6, 8, indices, 12, NULL), 0);
	assert_int_equal(nmtan_generate(&layout, vertices, 6, 5, indices, 12, NULL), 0);
	assert_int_equal(nmtan_generate(&layout, vertices, 6, 8, indices, 11, NULL), 0);
	assert_int_equal(nmtan_generate(&layout, vertices, 6, 8, beyond, 3, NULL), 0);
	assert_int_equal(nmtan_generate(&layout, vertices, 0, 8, indices, 0, NULL), 0);
	assert_int_equal(nmtan_generate(&layout, vertices, 5, 8, NULL, 0, NULL), 0);
	size_t *const offsets[] = {&layout.position_offset, &layout.normal_offset, &layout.texcoord_offset,
		&layout.tangent_offset};
	for (size_t i = 0; i < sizeof offsets / sizeof *offsets; i++) {
		const size_t right = *offsets[i];
		static const size_t wrong[] = {48, 49, SIZE_MAX - 3};
		for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
			*offsets[i] = wrong[k];
			assert_int_equal(nmtan_generate(&layout, vertices, 6, 8, indices, 12, NULL), 0);
		}
		*offsets[i] = right;
	}
	for (layout.stride_bytes = 0; layout.stride_bytes < 48; layout.stride_bytes++)
		assert_int_equal(nmtan_generate(&layout, vertices, 6, 8, indices, 12, NULL), 0);
	assert_memory_equal(indices, triangles, sizeof triangles);
}

/* The call with all parts apart, and the rows of another array. */
TEST(rows_are_copied_whole_or_but_for_their_tangents)
{
	const uint32_t sources[2] = {2, 0};
	char rows[5][9] = {"aaTTaaaa", "bbTTbbbb", "ccTTcccc", "..12....", "..34...."}, whole[5][9] = {"a", "b", "c"};
	nmtan_copy_rows(rows, 9, 3, sources, 2, 2, 2);
	assert_string_equal(rows[3], "cc12cccc");
	assert_string_equal(rows[4], "aa34aaaa");
	nmtan_copy_rows(whole, 9, 3, sources, 2, 0, 0);
	assert_string_equal(whole[3], "c");
	assert_string_equal(whole[4], "a");
}

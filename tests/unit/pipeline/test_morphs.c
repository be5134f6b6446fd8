/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets: what --morph does with them, on one quad in the plane z = 0 with normals along
 * z and (u, v down) = (x, -y), so that T = (1, 0, 0).
 *
 * Target 0 tilts it by 45 degrees about y, normals too: T = (1, 0, 1) / sqrt 2. It has a TANGENT of its own,
 * which is nonsense. Target 1 moves x to -x: T = (-1, 0, 0), and both triangles are seen from behind. Another mesh over
 * the same vertices has them the other way round.
 */
#include "hand_gltf_file.h"
#include <math.h>
#include <time.h>

static const float rows[6][4][3] = {
	{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},     /* 0: positions */
	{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},     /* 1: normals */
	{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 0}},     /* 2: positions of target 0 */
	{{-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}}, /* 3: normals of target 0 */
	{{3, 1, 4}, {3, 1, 4}, {3, 1, 4}, {3, 1, 4}},     /* 4: tangents of target 0 */
	{{0, 0, 0}, {-2, 0, 0}, {-2, 0, 0}, {0, 0, 0}},   /* 5: positions of target 1 */
};
static const float texcoords[4][2] = {{0, 0}, {1, 0}, {1, -1}, {0, -1}};
static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};

/* integers: normals are stored as (0, 0, 64 / 127), and target 0 adds -64 / 127 to x, which is 45 degrees, too. */
static void write_input(bool integers)
{
	static const int8_t short_normals[4][3] = {{0, 0, 64}, {0, 0, 64}, {0, 0, 64}, {0, 0, 64}};
	float values[6][4][3];
	memcpy(values, rows, sizeof values);
	for (int i = 0; integers && i < 4; i++)
		values[3][i][0] = -64 / 127.0f;
	hand_file f = {0};
	for (int i = 0; i < 6; i++)
		if (integers && i == 1)
			put_accessor(&f, short_normals, 4, NT_GLTF_BYTE, "VEC3");
		else
			put_accessor(&f, values[i], 4, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, texcoords, 4, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, indices, 6, NT_GLTF_USHORT, "SCALAR");
	put_glb("in.glb", &f, NORMAL_MAP "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
		"\"TEXCOORD_0\":6},\"indices\":7,\"material\":0,\"targets\":[{\"POSITION\":2,\"NORMAL\":3,"
		"\"TANGENT\":4},{\"POSITION\":5}]}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
		"\"TEXCOORD_0\":6},\"indices\":7,\"material\":0,\"targets\":[{\"POSITION\":5},{\"POSITION\":2,"
		"\"NORMAL\":3}]}]}],");
}

typedef struct result {
	nt_file file;
	nt_scene scene;
	size_t turned; /* what TAN_MORPH_TURNED counted */
} result;

/* Converts the input and opens what came out. */
static void convert(result *r, nt_morph_choice morphs)
{
	nt_summary summary = convert_file("in.glb", "out.glb", (nt_settings){.morphs = morphs});
	assert_int_equal(summary.solved_count, 2);
	assert_int_equal(summary.appended_tangents, 0);
	r->turned = count_findings(&summary, NT_CODE_TAN_MORPH_TURNED);
	nt_summary_free(&summary);
	open_file(&r->scene, &r->file, "out.glb", &(nt_read_options){.texcoord_set = -1});
}

static void close_result(result *r)
{
	nt_scene_free(&r->scene);
	nt_file_close(&r->file);
}

static void rows_are(result *r, uint32_t index, uint32_t width, const float *expected)
{
	uint64_t count;
	const float *found = rows_of(&r->scene, index, width, &count);
	assert_int_equal(count, 4);
	for (size_t i = 0; i < 4 * width; i++)
		assert_true(fabsf(found[i] - expected[i % width]) <= 1.2e-7f);
}

static void check_baked(void)
{
	const float half = sqrtf(0.5f);
	result r;
	convert(&r, NT_MORPH_BAKE);
	rows_are(&r, tangent_of(&r.scene, 0, 0, -1), 4, (float[]){1, 0, 0, 1});
	rows_are(&r, tangent_of(&r.scene, 0, 0, 0), 3, (float[]){half - 1, 0, half});
	rows_are(&r, tangent_of(&r.scene, 0, 0, 1), 3, (float[]){-2, 0, 0});
	rows_are(&r, tangent_of(&r.scene, 1, 0, 0), 3, (float[]){-2, 0, 0});
	rows_are(&r, tangent_of(&r.scene, 1, 0, 1), 3, (float[]){half - 1, 0, half});
	close_result(&r);
}

TEST(baked_deltas_lead_to_the_moved_mesh)
{
	check_baked();
}

/* A renderer adds deltas to what the integers stand for, and then makes the sum unit. */
TEST(deltas_are_added_to_integer_normals_as_they_are)
{
	write_input(true);
	check_baked();
	write_input(false);
}

TEST(kept_targets_are_as_they_were)
{
	result r;
	convert(&r, NT_MORPH_KEEP);
	rows_are(&r, tangent_of(&r.scene, 0, 0, -1), 4, (float[]){1, 0, 0, 1});
	assert_int_equal(tangent_of(&r.scene, 0, 0, 0), 4);
	rows_are(&r, 4, 3, rows[4][0]);
	assert_int_equal(tangent_of(&r.scene, 0, 0, 1), NT_NONE);
	close_result(&r);
}

TEST(dropped_targets_have_none)
{
	result r;
	convert(&r, NT_MORPH_DROP);
	rows_are(&r, tangent_of(&r.scene, 0, 0, -1), 4, (float[]){1, 0, 0, 1});
	assert_int_equal(tangent_of(&r.scene, 0, 0, 0), NT_NONE);
	assert_int_equal(tangent_of(&r.scene, 0, 0, 1), NT_NONE);
	/* accessors keep their numbers */
	rows_are(&r, 4, 3, rows[4][0]);
	close_result(&r);
}

TEST(triangles_seen_from_behind_are_counted)
{
	result r;
	convert(&r, NT_MORPH_BAKE);
	assert_int_equal(r.turned, 4);
	close_result(&r);
}

/* HUB triangles that have one vertex in common and no edge, each turned a little further: (u, v up) = (0, 0),
 * (1, 0), (0, 1) at the hub, at the angle a and at a + 90 degrees, so that T = (cos a, sin a, 0). */
enum { HUB = 100000, HUB_VERTICES = 1 + 2 * HUB };

static void write_hub(void)
{
	float (*positions)[3] = calloc(HUB_VERTICES, sizeof *positions);
	float (*normals)[3] = calloc(HUB_VERTICES, sizeof *normals);
	float (*uvs)[2] = calloc(HUB_VERTICES, sizeof *uvs);
	uint32_t (*triangles)[3] = calloc(HUB, sizeof *triangles);
	assert_true(positions && normals && uvs && triangles);
	normals[0][2] = 1;
	for (uint32_t i = 0; i < HUB; i++)
		for (uint32_t k = 0; k < 2; k++) {
			const uint32_t v = 1 + 2 * i + k;
			const double angle = 6.28 * i / HUB + (k ? 1.57079632679 : 0);
			positions[v][0] = (float)cos(angle);
			positions[v][1] = (float)sin(angle);
			normals[v][2] = 1;
			uvs[v][0] = k ? 0.0f : 1.0f;
			uvs[v][1] = k ? -1.0f : 0.0f;
			triangles[i][k + 1] = v;
		}
	hand_file f = {0};
	put_accessor(&f, positions, HUB_VERTICES, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, normals, HUB_VERTICES, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, uvs, HUB_VERTICES, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, triangles, 3 * HUB, NT_GLTF_UINT, "SCALAR");
	free(positions);
	free(normals);
	free(uvs);
	free(triangles);
	put_glb("hub.glb", &f, NORMAL_MAP "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
		"\"TEXCOORD_0\":2},\"indices\":3,\"material\":0,\"targets\":[{\"POSITION\":1}]}]}],");
}

/* Compared one with another the corners of the hub would be 5 * 10^9 pairs, twice: when it is split, and when
 * rows are found for what was split. */
TEST(a_hub_of_a_hundred_thousand_tangents_is_no_burden)
{
	write_hub();
	const clock_t begin = clock();
	nt_summary summary = convert_file("hub.glb", "out.glb", (nt_settings){.threads = 1});
	assert_true(clock() - begin < 20 * CLOCKS_PER_SEC);
	/* neighbours differ by 6e-5 in a float of 24 bits: no two tangents are the same */
	assert_int_equal(summary.appended_tangents, HUB - 1);
	nt_summary_free(&summary);
}

static int set_up(void **state)
{
	if (make_folder(state))
		return -1;
	write_input(false);
	return 0;
}

AROUND_ALL(set_up, remove_folder)

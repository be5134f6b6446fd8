/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets: what --morph does with them, on one quad in the plane z = 0 with normals along
 * z and (u, v down) = (x, -y), so that T = (1, 0, 0).
 *
 * Target 0 tilts it by 45 degrees about y, normals too: T = (1, 0, 1) / sqrt 2. It has a TANGENT of its own,
 * which is nonsense. Target 1 moves x to -x: T = (-1, 0, 0), and both triangles are seen from behind.
 */
#include "folder.h"
#include "test.h"
#include <math.h>
#include <stdio.h>
#include <time.h>
#include "base/buffer.h"
#include "gltf/accessor.h"
#include "gltf/document.h"
#include "gltf/open.h"
#include "pipeline/run.h"

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
	static const int8_t short_normals[4][4] = {{0, 0, 64}, {0, 0, 64}, {0, 0, 64}, {0, 0, 64}};
	float values[6][4][3];
	memcpy(values, rows, sizeof values);
	if (integers)
		memcpy(values[1], short_normals, sizeof short_normals);
	for (int i = 0; integers && i < 4; i++)
		values[3][i][0] = -64 / 127.0f;
	nt_buffer bin = {0}, json = {0};
	nt_buffer_append(&bin, values, sizeof values);
	nt_buffer_append(&bin, texcoords, sizeof texcoords);
	nt_buffer_append(&bin, indices, sizeof indices);
	nt_buffer_text(&json, "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"normalTexture\":{\"index\":0}}],"
		"\"textures\":[{}],\"bufferViews\":[");
	for (int i = 0; i < 6; i++)
		nt_buffer_format(&json, "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":48%s},", 48 * i,
			integers && i == 1 ? ",\"byteStride\":4" : "");
	nt_buffer_text(&json, "{\"buffer\":0,\"byteOffset\":288,\"byteLength\":32},"
		"{\"buffer\":0,\"byteOffset\":320,\"byteLength\":12}],\"accessors\":[");
	for (int i = 0; i < 6; i++)
		nt_buffer_format(&json, "{\"bufferView\":%d,\"componentType\":%s,\"count\":4,\"type\":\"VEC3\"},", i,
			integers && i == 1 ? "5120,\"normalized\":true" : "5126");
	nt_buffer_format(&json, "{\"bufferView\":6,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
		"{\"bufferView\":7,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":6},"
		"\"indices\":7,\"material\":0,\"targets\":[{\"POSITION\":2,\"NORMAL\":3,\"TANGENT\":4},"
		"{\"POSITION\":5}]}]}],\"buffers\":[{\"byteLength\":%zu}]}", bin.size);
	put_glb_file("in.glb", json.data, bin.data, bin.size);
	nt_buffer_free(&bin);
	nt_buffer_free(&json);
}

typedef struct result {
	nt_file file;
	nt_scene scene;
	size_t turned; /* what TAN_MORPH_TURNED counted */
} result;

/* Converts the input and opens what came out. */
static void convert(result *r, nt_morph_choice morphs)
{
	const nt_settings settings = {.texcoord_set = -1, .morphs = morphs};
	nt_summary summary;
	nt_error error;
	if (nt_run(in_folder("in.glb"), in_folder("out.glb"), &settings, &summary, &error))
		fail_msg("%s: %s", error.place.pointer, error.message);
	assert_int_equal(summary.solved_count, 1);
	assert_int_equal(summary.appended_tangents, 0);
	r->turned = 0;
	for (size_t i = 0; i < summary.findings.count; i++)
		if (summary.findings.items[i].code == NT_CODE_TAN_MORPH_TURNED)
			r->turned += summary.findings.items[i].count;
	nt_summary_free(&summary);

	assert_int_equal(nt_file_open(&r->file, in_folder("out.glb"), &error), NT_OK);
	nt_scene_init(&r->scene, "out.glb");
	r->scene.bytes = r->file.data;
	r->scene.byte_count = r->file.size;
	r->scene.format = NT_FORMAT_GLB;
	assert_int_equal(nt_gltf_open(&r->scene, &(nt_read_options){.texcoord_set = -1}, &error), NT_OK);
}

static void close_result(result *r)
{
	nt_scene_free(&r->scene);
	nt_file_close(&r->file);
}

/* The accessor of a target's TANGENT; target -1: the primitive's. NT_NONE: there is none. */
static uint32_t tangent_of(const result *r, int target)
{
	const nt_json_value *primitive = nt_json_at(nt_json_find(
		nt_json_at(nt_gltf_root_member(r->scene.source, "meshes"), 0), "primitives"), 0);
	const nt_json_value *attributes = target < 0 ? nt_json_find(primitive, "attributes") :
		nt_json_at(nt_json_find(primitive, "targets"), (size_t)target);
	uint64_t index = NT_NONE;
	nt_json_get_uint64(nt_json_find(attributes, "TANGENT"), &index);
	return (uint32_t)index;
}

static void rows_are(const result *r, uint32_t index, uint32_t width, const float *expected)
{
	nt_gltf_accessor accessor;
	nt_error error;
	float *found;
	assert_int_equal(nt_gltf_get_accessor(r->scene.source, index, "", &accessor, &error), NT_OK);
	assert_int_equal(nt_gltf_floats(r->scene.source, &accessor, width, 0, (nt_arena *)&r->scene.arena, &found,
		&error), NT_OK);
	assert_int_equal(accessor.count, 4);
	for (size_t i = 0; i < 4 * width; i++)
		assert_true(fabsf(found[i] - expected[i % width]) <= 1.2e-7f);
}

static void check_baked(void)
{
	const float half = sqrtf(0.5f);
	result r;
	convert(&r, NT_MORPH_BAKE);
	rows_are(&r, tangent_of(&r, -1), 4, (float[]){1, 0, 0, 1});
	rows_are(&r, tangent_of(&r, 0), 3, (float[]){half - 1, 0, half});
	rows_are(&r, tangent_of(&r, 1), 3, (float[]){-2, 0, 0});
	close_result(&r);
}

static void baked_deltas_lead_to_the_moved_mesh(void **state)
{
	(void)state;
	check_baked();
}

/* A renderer adds deltas to what the integers stand for, and then makes the sum unit. */
static void deltas_are_added_to_integer_normals_as_they_are(void **state)
{
	(void)state;
	write_input(true);
	check_baked();
	write_input(false);
}

static void kept_targets_are_as_they_were(void **state)
{
	(void)state;
	result r;
	convert(&r, NT_MORPH_KEEP);
	rows_are(&r, tangent_of(&r, -1), 4, (float[]){1, 0, 0, 1});
	assert_int_equal(tangent_of(&r, 0), 4);
	rows_are(&r, 4, 3, rows[4][0]);
	assert_int_equal(tangent_of(&r, 1), NT_NONE);
	close_result(&r);
}

static void dropped_targets_have_none(void **state)
{
	(void)state;
	result r;
	convert(&r, NT_MORPH_DROP);
	rows_are(&r, tangent_of(&r, -1), 4, (float[]){1, 0, 0, 1});
	assert_int_equal(tangent_of(&r, 0), NT_NONE);
	assert_int_equal(tangent_of(&r, 1), NT_NONE);
	/* accessors keep their numbers */
	rows_are(&r, 4, 3, rows[4][0]);
	close_result(&r);
}

static void triangles_seen_from_behind_are_counted(void **state)
{
	(void)state;
	result r;
	convert(&r, NT_MORPH_BAKE);
	assert_int_equal(r.turned, 2);
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
	nt_buffer bin = {0}, json = {0};
	nt_buffer_append(&bin, positions, HUB_VERTICES * sizeof *positions);
	nt_buffer_append(&bin, normals, HUB_VERTICES * sizeof *normals);
	nt_buffer_append(&bin, uvs, HUB_VERTICES * sizeof *uvs);
	nt_buffer_append(&bin, triangles, HUB * sizeof *triangles);
	free(positions);
	free(normals);
	free(uvs);
	free(triangles);
	nt_buffer_format(&json, "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"normalTexture\":{\"index\":0}}],"
		"\"textures\":[{}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],\"accessors\":[", bin.size);
	const struct {
		const char *type;
		size_t offset;
	} parts[] = {{"VEC3", 0}, {"VEC3", 12}, {"VEC2", 24}};
	for (size_t i = 0; i < 3; i++)
		nt_buffer_format(&json, "{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":5126,\"count\":%d,"
			"\"type\":\"%s\"},", parts[i].offset * HUB_VERTICES, HUB_VERTICES, parts[i].type);
	nt_buffer_format(&json, "{\"bufferView\":0,\"byteOffset\":%d,\"componentType\":5125,\"count\":%d,"
		"\"type\":\"SCALAR\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
		"\"TEXCOORD_0\":2},\"indices\":3,\"material\":0,\"targets\":[{\"POSITION\":1}]}]}],"
		"\"buffers\":[{\"byteLength\":%zu}]}", 32 * HUB_VERTICES, 3 * HUB, bin.size);
	put_glb_file("hub.glb", json.data, bin.data, bin.size);
	nt_buffer_free(&bin);
	nt_buffer_free(&json);
}

/* Compared one with another the corners of the hub would be 5 * 10^9 pairs, twice: when it is split, and when
 * rows are found for what was split. */
static void a_hub_of_a_hundred_thousand_tangents_is_no_burden(void **state)
{
	(void)state;
	write_hub();
	const nt_settings settings = {.texcoord_set = -1, .threads = 1};
	nt_summary summary;
	nt_error error;
	const clock_t begin = clock();
	if (nt_run(in_folder("hub.glb"), in_folder("out.glb"), &settings, &summary, &error))
		fail_msg("%s: %s", error.place.pointer, error.message);
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(baked_deltas_lead_to_the_moved_mesh),
		cmocka_unit_test(deltas_are_added_to_integer_normals_as_they_are),
		cmocka_unit_test(kept_targets_are_as_they_were),
		cmocka_unit_test(a_hub_of_a_hundred_thousand_tangents_is_no_burden),
		cmocka_unit_test(dropped_targets_have_none),
		cmocka_unit_test(triangles_seen_from_behind_are_counted),
	};
	return cmocka_run_group_tests(tests, set_up, remove_folder);
}

/* SPDX-License-Identifier: MIT */
/*
 * Two primitives over the same vertices, a quad in the plane z = 0 with normals along z and (u, v down) = (x, -y), so
 * that T = (1, 0, 0). Each has three morph targets; one of the three turns the quad by 90 degrees about z, so that
 * T = (0, 1, 0): of the first primitive target 1, of the second target 0. All others move nothing.
 *
 * The numbers of the targets' accessors were searched for: an FNV hash of 32 bits over them, begun with the number of
 * targets, is the same for both primitives.
 */
#include "base/buffer.h"
#include "folder.h"
#include "gltf/accessor.h"
#include "gltf/open.h"
#include "pipeline/run.h"
#include "test.h"

enum { ACCESSORS = 20, TURNED_A = 8, TURNED_B = 7 };

static const uint32_t targets[2][6] = { /* POSITION and NORMAL of each target */
	{16, 13, TURNED_A, 12, 19, 4},
	{TURNED_B, 16, 10, 19, 11, 13},
};

static uint32_t hash_of(const uint32_t *numbers)
{
	uint32_t hash = 3;
	for (int i = 0; i < 6; i++)
		hash = (hash ^ numbers[i]) * 16777619u;
	return hash;
}

static void write_input(void)
{
	static const float corners[3][4][3] = {
		{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},    /* positions */
		{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},    /* normals */
		{{0, 0, 0}, {-1, 1, 0}, {-2, 0, 0}, {-1, -1, 0}}, /* (x, y) to (-y, x) */
	};
	static const float texcoords[4][2] = {{0, 0}, {1, 0}, {1, -1}, {0, -1}}, zeros[4][3];
	static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
	nt_buffer bin = {0}, json = {0};
	nt_buffer_text(&json, "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"normalTexture\":{\"index\":0}}],"
		"\"textures\":[{}],\"accessors\":[");
	for (int i = 0; i < ACCESSORS; i++) {
		const bool turned = i == TURNED_A || i == TURNED_B;
		if (i < 2 || i > 3)
			nt_buffer_append(&bin, i < 2 ? corners[i] : turned ? corners[2] : zeros, sizeof zeros);
		nt_buffer_format(&json,
			i == 2 ? "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"}," :
			i == 3 ? "{\"bufferView\":2,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}," :
			"{\"bufferView\":0,\"byteOffset\":%d,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}%s",
			(i < 2 ? i : i - 2) * (int)sizeof zeros, i == ACCESSORS - 1 ? "" : ",");
	}
	const size_t rows = bin.size;
	nt_buffer_append(&bin, texcoords, sizeof texcoords);
	nt_buffer_append(&bin, indices, sizeof indices);
	nt_buffer_format(&json, "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},"
		"{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":%zu,"
		"\"byteLength\":12}],\"buffers\":[{\"byteLength\":%zu}],\"meshes\":[", rows, rows, rows + 32, bin.size);
	for (int p = 0; p < 2; p++) {
		nt_buffer_format(&json,
			"%s{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
			"\"indices\":3,\"material\":0,\"targets\":[", p ? "," : "");
		for (int t = 0; t < 3; t++)
			nt_buffer_format(&json, "%s{\"POSITION\":%u,\"NORMAL\":%u}", t ? "," : "",
				targets[p][2 * t], targets[p][2 * t + 1]);
		nt_buffer_text(&json, "]}]}");
	}
	nt_buffer_text(&json, "]}");
	put_glb_file("in.glb", json.data, bin.data, bin.size);
	nt_buffer_free(&bin);
	nt_buffer_free(&json);
}

/* Whether every row of the TANGENT of a target is `expected`. */
static void target_is(const nt_scene *scene, size_t mesh, size_t target, const float *expected)
{
	const nt_json_value *primitive = nt_json_at(nt_json_find(
		nt_json_at(nt_gltf_root_member(scene->source, "meshes"), mesh), "primitives"), 0);
	uint64_t index = NT_NONE;
	nt_json_get_uint64(nt_json_find(nt_json_at(nt_json_find(primitive, "targets"), target), "TANGENT"), &index);
	nt_gltf_accessor accessor;
	nt_error error;
	float *rows;
	assert_int_equal(nt_gltf_get_accessor(scene->source, index, "", &accessor, &error), NT_OK);
	assert_int_equal(accessor.count, 4);
	assert_int_equal(nt_gltf_floats(scene->source, &accessor, 3, 0, (nt_arena *)&scene->arena, &rows, &error),
		NT_OK);
	for (int i = 0; i < 12; i++)
		assert_true(rows[i] == expected[i % 3]);
}

static void targets_of_equal_hash_are_told_apart(void **state)
{
	(void)state;
	assert_int_equal(hash_of(targets[0]), hash_of(targets[1]));
	write_input();
	const nt_settings settings = {.texcoord_set = -1};
	nt_summary summary;
	nt_error error;
	if (nt_run(in_folder("in.glb"), in_folder("out.glb"), &settings, &summary, &error))
		fail_msg("%s: %s", error.place.pointer, error.message);
	assert_int_equal(summary.solved_count, 2);
	nt_summary_free(&summary);

	nt_file file;
	nt_scene scene;
	assert_int_equal(nt_file_open(&file, in_folder("out.glb"), &error), NT_OK);
	nt_scene_init(&scene, "out.glb");
	scene.bytes = file.data;
	scene.byte_count = file.size;
	scene.format = NT_FORMAT_GLB;
	assert_int_equal(nt_gltf_open(&scene, &(nt_read_options){.texcoord_set = -1}, &error), NT_OK);
	for (size_t t = 0; t < 3; t++) {
		target_is(&scene, 0, t, t == 1 ? (float[]){-1, 1, 0} : (float[]){0, 0, 0});
		target_is(&scene, 1, t, t == 0 ? (float[]){-1, 1, 0} : (float[]){0, 0, 0});
	}
	nt_scene_free(&scene);
	nt_file_close(&file);
}

int main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(targets_of_equal_hash_are_told_apart)};
	return cmocka_run_group_tests_name("gltf/edit/vertex_pools", tests, make_folder, remove_folder);
}

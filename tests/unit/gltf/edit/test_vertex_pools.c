/* SPDX-License-Identifier: MIT */
/*
 * Two primitives over the same vertices, a quad in the plane z = 0 with normals along z and (u, v down) = (x, -y), so
 * that T = (1, 0, 0). Each has three morph targets; one of the three turns the quad by 90 degrees about z, so that
 * T = (0, 1, 0): of the first primitive target 1, of the second target 0. All others move nothing.
 *
 * The numbers of the targets' accessors were searched for: an FNV hash of 32 bits over them, begun with the number of
 * targets, is the same for both primitives.
 */
#include "hand_gltf_file.h"

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
	hand_file f = {0};
	nt_buffer members = {0};
	for (int i = 0; i < ACCESSORS; i++)
		if (i == 2)
			put_accessor(&f, texcoords, 4, NT_GLTF_FLOAT, "VEC2");
		else if (i == 3)
			put_accessor(&f, indices, 6, NT_GLTF_USHORT, "SCALAR");
		else
			put_accessor(&f, i < 2 ? corners[i] : i == TURNED_A || i == TURNED_B ? corners[2] : zeros, 4,
				NT_GLTF_FLOAT, "VEC3");
	nt_buffer_text(&members, NORMAL_MAP "\"meshes\":[");
	for (int p = 0; p < 2; p++) {
		nt_buffer_format(&members,
			"%s{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
			"\"indices\":3,\"material\":0,\"targets\":[", p ? "," : "");
		for (int t = 0; t < 3; t++)
			nt_buffer_format(&members, "%s{\"POSITION\":%u,\"NORMAL\":%u}", t ? "," : "",
				targets[p][2 * t], targets[p][2 * t + 1]);
		nt_buffer_text(&members, "]}]}");
	}
	nt_buffer_text(&members, "],");
	put_glb("in.glb", &f, members.data);
	nt_buffer_free(&members);
}

static void targets_of_equal_hash_are_told_apart(void **state)
{
	(void)state;
	assert_int_equal(hash_of(targets[0]), hash_of(targets[1]));
	write_input();
	nt_summary summary = convert_file("in.glb", "out.glb", (nt_settings){0});
	assert_int_equal(summary.solved_count, 2);
	nt_summary_free(&summary);

	nt_file file;
	nt_scene scene;
	open_file(&scene, &file, "out.glb", &(nt_read_options){.texcoord_set = -1});
	for (int i = 0; i < 6; i++) {
		const size_t mesh = (size_t)i / 3;
		const float *expected = i == 1 || i == 3 ? (float[]){-1, 1, 0} : (float[]){0, 0, 0};
		uint64_t count;
		const float *rows = rows_of(&scene, tangent_of(&scene, mesh, 0, i % 3), 3, &count);
		assert_int_equal(count, 4);
		for (int k = 0; k < 12; k++)
			assert_true(rows[k] == expected[k % 3]);
	}
	nt_scene_free(&scene);
	nt_file_close(&file);
}

int main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(targets_of_equal_hash_are_told_apart)};
	return cmocka_run_group_tests_name("gltf/edit/vertex_pools", tests, make_folder, remove_folder);
}

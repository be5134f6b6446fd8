/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "scene/scene.h"
#include "scene/values.h"

TEST(meshes_are_called_as_their_source_calls_them)
{
	static const struct {
		nt_mesh mesh;
		const char *pointer, *object;
	} rows[] = {
		{{.name = "head", .gltf_mesh = 3, .gltf_primitive = 2, .gltf_material_name = "skin"},
			"/meshes/3/primitives/2", "mesh \"head\", primitive 2, material \"skin\""},
		{{.name = "", .gltf_mesh = 3, .gltf_primitive = 0, .gltf_material = 7},
			"/meshes/3/primitives/0", "mesh 3, primitive 0, material 7"},
		{{.name = "", .gltf_mesh = 0, .gltf_primitive = 1, .gltf_material = NT_NONE},
			"/meshes/0/primitives/1", "mesh 0, primitive 1"},
		{{.name = "wing", .gltf_mesh = NT_NONE, .file = "a.obj", .line = 5}, "", "object \"wing\""},
		{{.name = "", .gltf_mesh = NT_NONE, .file = "a.obj", .line = 5}, "", ""},
		{{.name = "", .gltf_mesh = NT_NONE}, "", "mesh"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_place place = {.file = "x", .line = 99, .pointer = "x", .object = "x"};
		assert_ptr_equal(nt_mesh_place(&rows[i].mesh, &place), &place);
		assert_string_equal(place.pointer, rows[i].pointer);
		assert_string_equal(place.object, rows[i].object);
		assert_string_equal(place.file, rows[i].mesh.file ? rows[i].mesh.file : "");
		assert_int_equal(place.line, rows[i].mesh.line);
	}
}

/* The twin keeps what it is called, how it is shown and what was decided; what was computed is the other's. */
TEST(twins_share_geometry_and_nothing_else)
{
	static float numbers[12];
	static uint32_t indices[3];
	nt_primitive parts[2] = {{.material = 1, .face_count = 0}, {.material = 2, .face_count = 9}};
	const nt_join join = {.part_count = 2};
	nt_mesh first = {.name = "first", .gltf_mesh = 0, .gltf_primitive = 1, .gltf_material = 2,
		.gltf_material_name = "wood", .positions = numbers, .normals = numbers, .indices = indices,
		.vertex_count = 3, .source_vertex_count = 3, .face_count = 1, .corner_count = 3, .quad_count = 4,
		.split = {.vertex_tangents = numbers, .source_count = 1}, .primitives = parts + 1,
		.primitive_count = 1, .decision = NT_DECISION_SOLVE, .wrap = {1, 2}, .wrap_offset = {3, 4}};
	nt_mesh own = {.name = "own", .gltf_mesh = 5, .gltf_primitive = 6, .gltf_material = 7,
		.gltf_material_name = "skin", .slots = 8, .triangles = true, .reachable = true, .unlit = true,
		.wrap = {5, 6}, .wrap_offset = {7, 8}, .texcoord_set = 9, .texcoords_transformed = true,
		.transforms_differ = true, .transform_animated = true, .texcoord_conflict = true,
		.texcoord_other_set = 10, .moving_targets = 11, .targets_without_tangents = 12,
		.decision = NT_SKIP_UNLIT, .plan = {.same_as = &first, .join = &join, .copied = true},
		.primitives = parts, .primitive_count = 1};
	nt_mesh mesh = own;
	nt_mesh_share(&mesh);
	assert_string_equal(mesh.name, own.name);
	assert_string_equal(mesh.gltf_material_name, own.gltf_material_name);
	assert_true(mesh.gltf_mesh == 5 && mesh.gltf_primitive == 6 && mesh.gltf_material == 7 && mesh.slots == 8);
	assert_true(mesh.triangles && mesh.reachable && mesh.unlit && mesh.plan.copied);
	assert_true(mesh.wrap[0] == 5 && mesh.wrap[1] == 6 && mesh.wrap_offset[0] == 7 && mesh.wrap_offset[1] == 8);
	assert_true(mesh.texcoord_set == 9 && mesh.texcoord_other_set == 10);
	assert_true(mesh.texcoords_transformed && mesh.transforms_differ && mesh.transform_animated &&
		mesh.texcoord_conflict);
	assert_true(mesh.moving_targets == 11 && mesh.targets_without_tangents == 12);
	assert_true(mesh.decision == NT_SKIP_UNLIT && mesh.plan.same_as == &first && mesh.plan.join == &join);
	assert_ptr_equal(mesh.positions, numbers);
	assert_ptr_equal(mesh.indices, indices);
	assert_ptr_equal(mesh.split.vertex_tangents, numbers);
	assert_true(mesh.vertex_count == 3 && mesh.face_count == 1 && mesh.quad_count == 4);
	assert_ptr_equal(mesh.primitives, parts);
	assert_int_equal(parts[0].face_count, 1);
	assert_int_equal(parts[1].face_count, 9);
}

/* Half a unit in the last place of IEEE 754 floats: 24 bits. */
TEST(rounding_is_half_of_the_last_bit)
{
	static const double rows[][2] = {{1, 0x1p-24}, {1.5, 0x1p-24}, {0.75, 0x1p-25}, {2, 0x1p-23}, {0, 0},
		{(double)INFINITY, 0}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		assert_true(nt_float_rounding((float)rows[i][0]) == rows[i][1]);
	/* with coordinates of 2 it is 2^-23; a hundredth of an edge is that much at 100 times the length */
	static const double edges[4] = {99 * 0x1p-23, 99 * 0x1p-23, 99 * 0x1p-23, 101 * 0x1p-23};
	assert_true(nt_origin_is_suspected(2, edges, 4, 1));
	assert_false(nt_origin_is_suspected(2, edges + 2, 2, 1));
	assert_false(nt_origin_is_suspected(2, edges, 4, 0.5));
	assert_true(nt_origin_is_suspected(2, edges + 3, 1, 2));
	assert_false(nt_origin_is_suspected(2, edges, 0, 1));
	static const float values[] = {1, -9, 2, 3, 4, -5, -11};
	for (size_t count = 0; count <= 7; count++) {
		float most = 0.5f;
		for (size_t i = 0; i < count; i++)
			most = fmaxf(most, fabsf(values[i]));
		assert_true(nt_largest_of(values, count, 0.5f) == most);
	}
}

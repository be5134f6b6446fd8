/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "scene/origin.h"
#include "scene/scene.h"

TEST(what_is_left_out_is_one_list)
{
	nt_scene scene;
	nt_scene_init(&scene, "a.obj");
	nt_scene_leave_out(&scene, 0, 2, "points (%d)", 2);
	assert_int_equal(scene.left_out_line, 0);
	nt_scene_leave_out(&scene, 9, 3, "lines (%d)", 3);
	nt_scene_leave_out(&scene, 4, 1, "curves");
	nt_scene_leave_out(&scene, 7, 1, "surfaces");
	assert_string_equal(scene.left_out.data, "points (2), lines (3), curves, surfaces");
	assert_int_equal(scene.left_out_count, 7);
	assert_int_equal(scene.left_out_line, 4);
	nt_scene_free(&scene);
	assert_null(scene.path);
	assert_int_equal(scene.left_out.size, 0);
}

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

TEST(materials_and_maps_have_the_place_of_their_statement)
{
	const nt_scene scene = {.path = "a.obj"};
	nt_material m = nt_material_default("skin");
	assert_true(m.roughness == 1 && m.metallic == 0 && m.normal_scale == 1 && m.base_color[3] == 1);
	m.line = 3;
	nt_place place = nt_material_place(&scene, &m, 0);
	assert_string_equal(place.file, "a.obj");
	assert_string_equal(place.object, "material \"skin\"");
	assert_int_equal(place.line, 3);
	m.library = "a.mtl";
	m.name = "";
	place = nt_material_place(&scene, &m, 8);
	assert_string_equal(place.file, "a.mtl");
	assert_string_equal(place.object, "");
	assert_int_equal(place.line, 8);
	nt_map map = {.name = "n.png", .line = 6};
	nt_map_place(&scene, &m, &map, &place);
	assert_string_equal(place.file, "a.mtl");
	assert_int_equal(place.line, 6);
	map.given = true;
	nt_map_place(&scene, &m, &map, &place);
	assert_string_equal(place.file, "n.png");
	assert_int_equal(place.line, 0);
}

TEST(maps_and_anisotropy_take_texture_coordinates)
{
	nt_material m = nt_material_default("");
	assert_false(nt_material_takes_texcoords(&m));
	m.anisotropy = -0.5f;
	assert_true(nt_material_takes_texcoords(&m));
	for (size_t i = 0; i < NT_MATERIAL_MAPS; i++) {
		m = nt_material_default("");
		m.maps[i].name = "a.png";
		assert_true(nt_material_takes_texcoords(&m));
	}
}

TEST(a_mesh_without_triangles_has_none)
{
	nt_mesh meshes[2] = {{.triangles = true, .face_count = 0}, {.triangles = false, .face_count = 4}};
	nt_scene scene = {.meshes = meshes, .mesh_count = 2};
	assert_false(nt_scene_has_triangles(&scene));
	meshes[0].face_count = 1;
	assert_true(nt_scene_has_triangles(&scene));
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

TEST(a_mesh_whose_arena_is_gone_points_nowhere)
{
	nt_mesh mesh;
	memset(&mesh, 0x5a, sizeof mesh);
	nt_mesh_drop_arrays(&mesh);
	const void *const gone[] = {mesh.positions, mesh.normals, mesh.solve_normals, mesh.stored_normals,
		mesh.texcoords, mesh.solve_texcoords, mesh.colors, mesh.tangents, mesh.vertex_lacks, mesh.face_sizes,
		mesh.face_diagonals, mesh.indices, mesh.halves, mesh.face_polygon, mesh.face_smoothing,
		mesh.face_primitive, mesh.pool_vertices, mesh.vertex_sources, mesh.morphs, mesh.morph_tangents,
		mesh.corner_tangents, mesh.split.indices, mesh.split.sources, mesh.split.vertex_tangents};
	for (size_t i = 0; i < sizeof gone / sizeof *gone; i++)
		assert_null(gone[i]);
	assert_int_equal(mesh.morph_count, 0);
	assert_true(mesh.vertex_count && mesh.quad_count && mesh.split.source_count);
}

TEST(the_view_is_of_what_is_solved)
{
	float arrays[5][6];
	nt_mesh mesh = {.positions = arrays[0], .normals = arrays[1], .texcoords = arrays[2], .face_count = 1,
		.vertex_count = 3, .solve_sign = -1};
	nmtan_stored_uv stored;
	nmtan_mesh view = nt_mesh_view(&mesh, &stored);
	assert_ptr_equal(view.normals, arrays[1]);
	assert_ptr_equal(view.texcoords, arrays[2]);
	assert_null(stored.texcoords);
	assert_ptr_equal(view.stored, &stored);
	assert_true(view.position_stride_bytes == 12 && view.normal_stride_bytes == 12 &&
		view.texcoord_stride_bytes == 8);
	mesh.solve_normals = arrays[3];
	mesh.solve_texcoords = arrays[4];
	view = nt_mesh_view(&mesh, &stored);
	assert_ptr_equal(view.normals, arrays[3]);
	assert_ptr_equal(view.texcoords, arrays[4]);
	assert_ptr_equal(stored.texcoords, arrays[2]);
	assert_true(stored.mirrored);
	mesh.solve_sign = 1;
	nt_mesh_view(&mesh, &stored);
	assert_false(stored.mirrored);
	mesh.solve_sign = 0;
	nt_mesh_view(&mesh, &stored);
	assert_null(stored.texcoords);
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

/* SPDX-License-Identifier: MIT */
/*
 * New glTF documents: their geometry in every container. Their images are in tests/unit/gltf/create/test_images.c.
 */
#include "gltf/create/create.h"
#include "hand_gltf.h"

#include <math.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static hand_scene hand;

/* A scene for each test, in the folder of all. */
static int set_up(void **state)
{
	*state = make_scene(&hand);
	return 0;
}

static int tear_down(void **state)
{
	nt_scene_free(*state);
	return 0;
}

/* cross((0, 0, 1), (x, 0, 0)) * w = (0, x, 0) * w; the last has w = -1, which signs its zeros */
static const float out_bitangents[] = {
	0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, -0.0f, 1, -0.0f};

TEST(one_primitive_is_the_same_in_every_container)
{
	nt_scene *scene = *state;
	static const char *const names[] = {"one.gltf", "one embedded.gltf", "one.glb"};
	for (size_t i = 0; i < COUNT(names); i++) {
		compose_well(scene, (nt_write_options){.buffers = i == 1 ? NT_BUFFERS_EMBED : NT_BUFFERS_DEFAULT,
			.bitangents = true}, names[i]);
		opened file = open_back(names[i]);
		assert_whole(&file, hand.tangents);
		assert_floats(&file, 0, "_BITANGENT", out_bitangents, 6, 3);
		close_back(&file);
	}
	assert_true(exists("one.bin"));
	assert_false(exists("one embedded.bin"));
	assert_file_says("one.gltf", PARTS("\"uri\":\"one.bin\"", "\"min\":[0.0,0.0,0.0]", "\"max\":[2.0,1.0,0.0]",
		"\"generator\":\"nmtan " NMTAN_VERSION_STRING "\""));
}

TEST(several_primitives_get_their_own_vertices)
{
	nt_scene *scene = *state;
	divide(&hand);
	compose_well(scene, (nt_write_options){.bitangents = true}, "two.gltf");
	opened file = open_back("two.gltf");
	assert_int_equal(nt_reread_primitive_count(file.reread, 0), 2);

	/* triangle 1 4 5 */
	static const uint16_t triangle[] = {0, 1, 2};
	static const float triangle_positions[] = {1, 0, 0, 2, 1, 0, 1, 1, 0};
	static const float triangle_normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
	static const float triangle_tangents[] = {1, 0, 0, 1, 1, 0, 0, 1, -1, 0, 0, -1};
	assert_indices(&file, 0, triangle, 3);
	assert_floats(&file, 0, "POSITION", triangle_positions, 3, 3);
	assert_floats(&file, 0, "TANGENT", triangle_tangents, 3, 4);
	assert_floats(&file, 0, "NORMAL", triangle_normals, 3, 3);
	assert_floats(&file, 0, "_BITANGENT", out_bitangents + 9, 3, 3);

	/* quad 0 1 3, 1 2 3: vertices 0 1 3 2 */
	static const uint16_t quad[] = {0, 1, 2, 1, 3, 2};
	static const float quad_positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
	static const float quad_texcoords[] = {0, 1, 1, 1 - 0.1f, 0, 1 - 0.7f, 1, 0};
	assert_indices(&file, 1, quad, 6);
	assert_floats(&file, 1, "POSITION", quad_positions, 4, 3);
	assert_floats(&file, 1, "TEXCOORD_0", quad_texcoords, 4, 2);
	close_back(&file);
}

TEST(mesh_without_tangents_is_written_without)
{
	nt_scene *scene = *state;
	hand.mesh.split = (nt_split){0};
	hand.mesh.face_diagonals = NULL; /* unsolved quads: either diagonal will do */
	compose_well(scene, (nt_write_options){.bitangents = true}, "bare.glb");
	opened file = open_back("bare.glb");
	assert_null(array_of(&file, 0, 0, "TANGENT").data);
	assert_null(array_of(&file, 0, 0, "_BITANGENT").data);
	static const uint16_t indices[] = {0, 1, 2, 0, 2, 3, 1, 4, 2};
	assert_indices(&file, 0, indices, 9);
	close_back(&file);

	/* no NORMAL, no TANGENT */
	make_scene(&hand);
	hand.mesh.normals = NULL;
	compose_well(scene, (nt_write_options){0}, "bare.glb");
	file = open_back("bare.glb");
	assert_null(array_of(&file, 0, 0, "TANGENT").data);
	close_back(&file);

	/* solved quads must say where they were cut */
	make_scene(&hand);
	hand.mesh.face_diagonals = NULL;
	nt_error error;
	assert_int_equal(compose(scene, (nt_write_options){0}, "bare.glb", &error), NT_ERROR_INTERNAL);
}

TEST(triangles_without_indices_stay_without)
{
	nt_scene *scene = *state;
	float *const positions = hand.mesh.positions;
	hand.mesh = (nt_mesh){.name = "", .vertex_count = 5, .positions = positions,
		.colors = hand.tangents, .face_count = 1, .corner_count = 3};
	compose_well(scene, (nt_write_options){0}, "soup.gltf");
	opened file = open_back("soup.gltf");
	assert_null(array_of(&file, 0, 0, NULL).data);
	assert_floats(&file, 0, "POSITION", positions, 3, 3); /* the other two are not used */
	assert_floats(&file, 0, "COLOR_0", hand.tangents, 3, 4);
	assert_null(array_of(&file, 0, 0, "TEXCOORD_0").data);
	close_back(&file);
}

TEST(index_65535_is_reserved)
{
	nt_scene *scene = *state;
	enum { MOST = 65536 };
	float *many = calloc(MOST, 3 * sizeof *many);
	many[3 * (MOST - 1)] = 7;
	uint32_t triangle[] = {0, 1, MOST - 2};
	hand.mesh = (nt_mesh){.name = "", .positions = many, .face_count = 1, .corner_count = 3,
		.indices = triangle};
	for (size_t count = MOST - 1; count <= MOST; count++) {
		triangle[2] = (uint32_t)count - 1;
		hand.mesh.vertex_count = count;
		compose_well(scene, (nt_write_options){0}, "many.glb");
		opened file = open_back("many.glb");
		const nt_reread_array indices = array_of(&file, 0, 0, NULL);
		const int type = count < MOST ? NT_GLTF_USHORT : NT_GLTF_UINT;
		assert_int_equal(indices.component_type, type);
		assert_int_equal(array_of(&file, 0, 0, "POSITION").count, count);
		close_back(&file);
	}
	free(many);
}

TEST(bounds_are_finite_whatever_the_positions_are)
{
	nt_scene *scene = *state;
	float wild[] = {NAN, -INFINITY, NAN, NAN, 2, INFINITY, NAN, 3, INFINITY};
	hand.mesh = (nt_mesh){.name = "", .vertex_count = 3, .positions = wild, .face_count = 1,
		.corner_count = 3};
	compose_well(scene, (nt_write_options){0}, "wild.gltf");
	assert_file_says("wild.gltf", PARTS("!null", "\"max\":[0.0,3.0,3.4028234663852886e+38]",
		"\"min\":[0.0,-3.4028234663852886e+38,3.4028234663852886e+38]"));
}

TEST(empty_scene_is_refused)
{
	nt_scene *scene = *state;
	nt_error error;
	hand.mesh.face_count = hand.mesh.corner_count = 0;
	assert_int_equal(compose(scene, (nt_write_options){0}, "empty.gltf", &error), NT_ERROR_UNSUPPORTED);
	assert_false(exists("empty.gltf"));
}

TEST(gltf_with_a_bin_cannot_go_to_standard_output)
{
	nt_scene *scene = *state;
	const nt_write_options options = {.format = NT_FORMAT_GLTF, .path = "-"};
	nt_error error;
	assert_int_equal(nt_gltf_compose(scene, &options, NULL, &error), NT_ERROR_USAGE);
}

AROUND_ALL(make_folder, remove_folder)
AROUND_EACH(set_up, tear_down)

/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <stdio.h>
#include <unistd.h>
#include "io/verify.h"

static char folder[] = "/tmp/nmtan-verify-XXXXXX";

static int make_folder(void **state)
{
	(void)state;
	return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
	(void)state;
	return rmdir(folder); /* nothing was committed, so nothing may be left */
}

/* A quad and a triangle of two materials, the triangle first in the document; vertex 2 is split. */
static float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 1, 0};
static float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static uint32_t corners[] = {0, 1, 2, 3, 1, 4, 2};
static uint32_t split_corners[] = {0, 1, 2, 3, 1, 4, 5};
static uint32_t sources[] = {2};
static uint8_t sizes[] = {4, 3}, diagonals[] = {1, 0};
static uint32_t face_primitive[] = {1, 0};

typedef struct hand_scene {
	nt_scene scene;
	nt_mesh mesh;
	nt_primitive primitives[2];
	nt_instance instance;
	float tangents[24];
} hand_scene;

static void make_scene(hand_scene *hand)
{
	*hand = (hand_scene){
		.mesh = {.name = "hand", .vertex_count = 5, .positions = positions, .normals = normals,
			.face_count = 2, .corner_count = 7, .face_sizes = sizes, .face_diagonals = diagonals,
			.indices = corners, .primitive_count = 2, .face_primitive = face_primitive,
			.split = {split_corners, sources, 1, hand->tangents}},
		.primitives = {{.material = NT_NONE}, {.material = NT_NONE}},
		.instance = {.matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
	};
	for (int v = 0; v < 6; v++)
		hand->tangents[4 * v] = hand->tangents[4 * v + 3] = v == 5 ? -1 : 1;
	nt_scene_init(&hand->scene, "hand.obj");
	hand->mesh.primitives = hand->primitives;
	hand->scene.meshes = &hand->mesh;
	hand->scene.mesh_count = 1;
	hand->scene.instances = &hand->instance;
	hand->scene.instance_count = 1;
}

/* Writes the scene, lets `spoil` change what the writer should have written, and verifies. */
static nmtan_status verify_after(const char *name, void (*spoil)(hand_scene *), nt_error *error)
{
	hand_scene hand;
	make_scene(&hand);
	char path[100];
	snprintf(path, sizeof path, "%s/%s", folder, name);
	const nt_write_options options = {.path = path,
		.format = strstr(name, ".glb") ? NT_FORMAT_GLB : NT_FORMAT_GLTF};
	nt_output *output;
	assert_int_equal(nt_output_create(&output, NULL, error), NMTAN_OK);
	assert_int_equal(nt_gltf_compose(&hand.scene, &options, output, error), NMTAN_OK);
	if (spoil)
		spoil(&hand);
	const nmtan_status status = nt_verify_gltf(&hand.scene, output, path, error);
	nt_output_abort(output);
	return status;
}

static void good_output_is_good(void **state)
{
	(void)state;
	nt_error error;
	assert_int_equal(verify_after("a b.glb", NULL, &error), NMTAN_OK);
	assert_int_equal(verify_after("a b.gltf", NULL, &error), NMTAN_OK); /* its .bin has no name yet */
}

static void change_last_tangent(hand_scene *hand)
{
	hand->tangents[23] = 1;
}

static void add_a_mesh(hand_scene *hand)
{
	static nt_mesh twice[2];
	twice[0] = twice[1] = hand->mesh;
	hand->scene.meshes = twice;
	hand->scene.mesh_count = 2;
}

static void turn_the_diagonal(hand_scene *hand)
{
	static uint8_t other[] = {0, 0};
	hand->mesh.face_diagonals = other;
}

static void every_difference_is_told(void **state)
{
	(void)state;
	nt_error error;
	assert_int_equal(verify_after("a.glb", change_last_tangent, &error), NMTAN_ERROR_INTERNAL);
	assert_non_null(strstr(error.message, "corner 6 of mesh \"hand\""));
	assert_int_equal(verify_after("a.gltf", turn_the_diagonal, &error), NMTAN_ERROR_INTERNAL);
	assert_int_equal(verify_after("a.glb", add_a_mesh, &error), NMTAN_ERROR_INTERNAL);
	assert_non_null(strstr(error.place.file, "a.glb"));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(good_output_is_good),
		cmocka_unit_test(every_difference_is_told),
	};
	return cmocka_run_group_tests_name("io/verify", tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: MIT */
#include "hand_gltf.h"
#include "io/verify.h"

/* Nothing is committed, so nothing may be left. */
static int remove_empty_folder(void **state)
{
	return count_in_folder() ? -1 : remove_folder(state);
}

/* Writes the scene, lets `spoil` change what the writer should have written, and verifies. */
static nmtan_status verify_after(const char *name, void (*spoil)(hand_scene *), nt_error *error)
{
	hand_scene hand;
	make_scene(&hand);
	divide(&hand);
	const char *path = in_folder(name);
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
	return cmocka_run_group_tests_name("io/verify", tests, make_folder, remove_empty_folder);
}

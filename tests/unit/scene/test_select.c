/* SPDX-License-Identifier: MIT */
#include "scene/select.h"
#include "test.h"

/* A reachable mesh of triangles with everything a solve takes. */
static nt_mesh complete_mesh(unsigned slots)
{
	nt_mesh mesh = {.name = "", .slots = slots, .triangles = true, .reachable = true, .has_positions = true,
		.has_normals = true, .has_texcoords = true, .face_count = 1};
	return mesh;
}

static nt_decision decide(nt_mesh mesh, nt_format format, nt_only only, nt_existing existing,
	bool make_normals, const nt_code *expected_codes, size_t expected_count)
{
	nt_scene scene;
	nt_scene_init(&scene, "test");
	scene.format = format;
	scene.meshes = &mesh;
	scene.mesh_count = 1;
	nt_select(&scene, only, existing, make_normals);
	assert_int_equal(scene.findings.count, expected_count);
	for (size_t i = 0; i < expected_count; i++)
		assert_int_equal(scene.findings.items[i].code, expected_codes[i]);
	nt_finding_list_free(&scene.findings);
	return mesh.decision;
}

static nt_decision decide_gltf(nt_mesh mesh, nt_only only, nt_existing existing)
{
	return decide(mesh, NT_FORMAT_GLTF, only, existing, false, NULL, 0);
}

static void gltf_needs_a_slot(void **state)
{
	(void)state;
	const unsigned slots[] = {NT_SLOT_NORMAL, NT_SLOT_CLEARCOAT_NORMAL, NT_SLOT_ANISOTROPY};
	for (size_t i = 0; i < 3; i++)
		assert_int_equal(decide_gltf(complete_mesh(slots[i]), NT_ONLY_AUTO, NT_EXISTING_KEEP),
			NT_DECISION_SOLVE);
	assert_int_equal(decide_gltf(complete_mesh(0), NT_ONLY_AUTO, NT_EXISTING_KEEP), NT_SKIP_NO_SLOT);
	assert_int_equal(decide_gltf(complete_mesh(0), NT_ONLY_ALL, NT_EXISTING_KEEP), NT_DECISION_SOLVE);
	nt_mesh unlit = complete_mesh(0);
	unlit.unlit = true;
	assert_int_equal(decide_gltf(unlit, NT_ONLY_NEEDED, NT_EXISTING_KEEP), NT_SKIP_UNLIT);
	nt_mesh hidden = complete_mesh(NT_SLOT_NORMAL);
	hidden.reachable = false;
	assert_int_equal(decide_gltf(hidden, NT_ONLY_AUTO, NT_EXISTING_KEEP), NT_SKIP_UNREACHABLE);
	nt_mesh lines = complete_mesh(NT_SLOT_NORMAL);
	lines.triangles = false;
	assert_int_equal(decide_gltf(lines, NT_ONLY_ALL, NT_EXISTING_KEEP), NT_SKIP_NOT_TRIANGLES);
	nt_mesh empty = complete_mesh(NT_SLOT_NORMAL);
	empty.face_count = 0;
	assert_int_equal(decide_gltf(empty, NT_ONLY_ALL, NT_EXISTING_KEEP), NT_SKIP_EMPTY);
}

static void obj_and_ply_get_tangents_wherever_there_are_texcoords(void **state)
{
	(void)state;
	const nt_mesh plain = complete_mesh(0);
	assert_int_equal(decide(plain, NT_FORMAT_OBJ, NT_ONLY_AUTO, NT_EXISTING_KEEP, false, NULL, 0),
		NT_DECISION_SOLVE);
	assert_int_equal(decide(plain, NT_FORMAT_PLY, NT_ONLY_NEEDED, NT_EXISTING_KEEP, false, NULL, 0),
		NT_SKIP_NO_SLOT);
	nt_mesh bare = plain;
	bare.has_texcoords = false;
	const nt_code none = NT_CODE_TAN_NO_UV;
	assert_int_equal(decide(bare, NT_FORMAT_PLY, NT_ONLY_AUTO, NT_EXISTING_KEEP, false, &none, 1),
		NT_SKIP_NO_TEXCOORDS);
	assert_int_equal(decide(bare, NT_FORMAT_PLY, NT_ONLY_NEEDED, NT_EXISTING_KEEP, false, NULL, 0),
		NT_SKIP_NO_SLOT);
}

static void existing_tangents_are_kept_repaired_or_replaced(void **state)
{
	(void)state;
	nt_mesh mesh = complete_mesh(NT_SLOT_NORMAL);
	mesh.has_tangents = true;
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_KEEP), NT_SKIP_HAS_TANGENTS);
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_REPAIR), NT_DECISION_REPAIR);
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_REPLACE), NT_DECISION_SOLVE);
	mesh.has_texcoords = false; /* not lost where they cannot be computed anew, and nothing that they need lacks */
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_KEEP), NT_SKIP_HAS_TANGENTS);
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_REPAIR), NT_DECISION_REPAIR);
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_REPLACE), NT_DECISION_REPAIR);
	mesh.has_texcoords = true;
	mesh.has_normals = false; /* kept all the same: nothing is lost by it */
	assert_int_equal(decide_gltf(mesh, NT_ONLY_AUTO, NT_EXISTING_KEEP), NT_SKIP_HAS_TANGENTS);
}

static void what_is_needed_and_lacks_is_a_finding(void **state)
{
	(void)state;
	const nt_code both[] = {NT_CODE_TAN_NO_UV, NT_CODE_TAN_NO_NORMAL};
	nt_mesh mesh = complete_mesh(NT_SLOT_NORMAL);
	mesh.has_normals = false;
	assert_int_equal(decide(mesh, NT_FORMAT_GLTF, NT_ONLY_AUTO, NT_EXISTING_KEEP, false, both + 1, 1),
		NT_SKIP_NO_NORMALS);
	assert_int_equal(decide(mesh, NT_FORMAT_GLTF, NT_ONLY_AUTO, NT_EXISTING_KEEP, true, NULL, 0),
		NT_DECISION_SOLVE);
	mesh.has_texcoords = false;
	assert_int_equal(decide(mesh, NT_FORMAT_GLTF, NT_ONLY_AUTO, NT_EXISTING_KEEP, false, both, 2),
		NT_SKIP_NO_TEXCOORDS);
	mesh.slots = 0; /* not needed: not worth a word */
	assert_int_equal(decide(mesh, NT_FORMAT_GLTF, NT_ONLY_ALL, NT_EXISTING_KEEP, false, NULL, 0),
		NT_SKIP_NO_TEXCOORDS);
}

static void slots_that_want_different_sets_are_a_finding(void **state)
{
	(void)state;
	const nt_code conflict = NT_CODE_TAN_UVSET_CONFLICT;
	nt_mesh mesh = complete_mesh(NT_SLOT_NORMAL | NT_SLOT_ANISOTROPY);
	mesh.texcoord_conflict = true;
	mesh.texcoord_other_set = 1;
	assert_int_equal(decide(mesh, NT_FORMAT_GLB, NT_ONLY_AUTO, NT_EXISTING_KEEP, false, &conflict, 1),
		NT_DECISION_SOLVE);
}

static void every_decision_has_its_words(void **state)
{
	(void)state;
	for (int i = 0; i < NT_DECISION_COUNT; i++)
		assert_string_not_equal(nt_decision_text((nt_decision)i), "unknown");
	assert_string_equal(nt_decision_text(NT_DECISION_COUNT), "unknown");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(gltf_needs_a_slot),
		cmocka_unit_test(obj_and_ply_get_tangents_wherever_there_are_texcoords),
		cmocka_unit_test(existing_tangents_are_kept_repaired_or_replaced),
		cmocka_unit_test(what_is_needed_and_lacks_is_a_finding),
		cmocka_unit_test(slots_that_want_different_sets_are_a_finding),
		cmocka_unit_test(every_decision_has_its_words),
	};
	return cmocka_run_group_tests_name("scene/select", tests, NULL, NULL);
}

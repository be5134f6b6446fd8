/* SPDX-License-Identifier: MIT */
/*
 * Tangents that are kept although their w is wrong, and meshes without area in texture coordinates, are told by
 * conversion: one quad in the plane z = 0 with normals along z and (u, v down) = (x, -y), so that T = (1, 0, 0) and
 * w = 1.
 */
#include "hand_gltf_file.h"

static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};

/* v down. The last corner folds the second triangle over the diagonal: it is wound the other way, and is the smaller
 * one. */
static const float plain[4][2] = {{0, 0}, {1, 0}, {1, -1}, {0, -1}},
	folded[4][2] = {{0, 0}, {1, 0}, {1, -1}, {0.8f, -0.2f}},
	alike[4][2] = {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}};

#define TURNED "\"textures\":[{}],\"materials\":[{\"normalTexture\":{\"index\":0,\"extensions\":" \
	"{\"KHR_texture_transform\":{\"scale\":[-1,1]}}}}]," \
	"\"extensionsUsed\":[\"KHR_texture_transform\"],"

static const struct {
	const char *name, *material;
	const float (*texcoords)[2];
	float w[4];
	size_t wrong;
} cases[] = {
	{"right", NORMAL_MAP, plain, {1, 1, 1, 1}, 0},
	{"inverted", NORMAL_MAP, plain, {-1, -1, -1, -1}, 2},
	{"one triangle, and the other has two signs", NORMAL_MAP, plain, {-1, -1, -1, 1}, 2},
	{"inverted, and no material uses it", "\"materials\":[{}],", plain, {-1, -1, -1, -1}, 0},
	{"right without the texture transform", TURNED, plain, {1, 1, 1, 1}, 2},
	{"right with it", TURNED, plain, {-1, -1, -1, -1}, 0},
	{"a folded quad's own sign", NORMAL_MAP, folded, {1, 1, 1, 1}, 0},
	{"the sign of its smaller half", NORMAL_MAP, folded, {-1, -1, -1, -1}, 1},
	{"two signs in a triangle", NORMAL_MAP, plain, {1, -1, 1, 1}, 1},
	{"two signs in both", NORMAL_MAP, plain, {-1, 1, 1, 1}, 2},
};

/* A tangent of the second corner, which one triangle uses. */
static const struct {
	const char *name;
	float tangent[4];
	size_t faulty;
} faults[] = {
	{"zero", {0, 0, 0, 1}, 1},
	{"not a number", {NAN, 0, 0, 1}, 1},
	{"w is none", {1, 0, 0, NAN}, 1},
	{"w is 0", {1, 0, 0, 0}, 1},
	{"w is nearly a sign", {1, 0, 0, 0.998f}, 1},
	{"twice as long", {2, 0, 0, 1}, 1},
	{"along the normal", {0, 0, 1, 1}, 1},
	{"half a degree from it", {0.0087265f, 0, 0.9999619f, 1}, 1},
	{"two degrees from it", {0.0348995f, 0, 0.9993908f, 1}, 0},
	{"as long as bytes make it", {1.006f, 0, 0, 1}, 0},
	{"longer", {1.008f, 0, 0, 1}, 1},
};

static void write_tangents(const char *material, const float (*texcoords)[2], const float (*tangents)[4])
{
	hand_file f = {0};
	put_accessor(&f, positions, 4, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, normals, 4, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, texcoords, 4, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, indices, 6, NT_GLTF_USHORT, "SCALAR");
	if (tangents)
		put_accessor(&f, tangents, 4, NT_GLTF_FLOAT, "VEC4");
	char members[1024];
	snprintf(members, sizeof members, "%s\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
		"\"TEXCOORD_0\":2%s},\"indices\":3,\"material\":0}]}],", material, tangents ? ",\"TANGENT\":4" : "");
	put_glb("in.glb", &f, members);
}

static void write_quad(const char *material, const float (*texcoords)[2], const float w[4])
{
	float tangents[4][4];
	for (int v = 0; w && v < 4; v++)
		memcpy(tangents[v], (float[4]){1, 0, 0, w[v]}, sizeof tangents[v]);
	write_tangents(material, texcoords, w ? tangents : NULL);
}

static size_t convert_and_count(nt_settings settings, nt_code code)
{
	nt_summary summary = convert_file("in.glb", "out.glb", settings);
	const size_t count = count_findings(&summary, code);
	nt_summary_free(&summary);
	return count;
}

TEST(wrong_signs_are_told_where_they_are_kept_and_used)
{
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		write_quad(cases[i].material, cases[i].texcoords, cases[i].w);
		const size_t wrong = convert_and_count((nt_settings){0}, NT_CODE_TAN_KEPT_SIGN);
		if (wrong != cases[i].wrong)
			fail_msg("%s: %zu wrong, expected %zu", cases[i].name, wrong, cases[i].wrong);
		assert_true(same_files("in.glb", "out.glb"));
	}
}

/* Errors of --check. */
TEST(tangents_that_no_renderer_can_use_are_told)
{
	for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
		float tangents[4][4] = {{1, 0, 0, 1}, {0}, {1, 0, 0, 1}, {1, 0, 0, 1}};
		memcpy(tangents[1], faults[i].tangent, sizeof tangents[1]);
		write_tangents(NORMAL_MAP, plain, tangents);
		const size_t plainly = convert_and_count((nt_settings){0}, NT_CODE_TAN_EXISTING_BAD);
		if (plainly != faults[i].faulty)
			fail_msg("%s: %zu faulty, expected %zu", faults[i].name, plainly, faults[i].faulty);
		assert_true(same_files("in.glb", "out.glb"));
	}
}

/* Two slots with different texture transforms are a finding of meshes that are solved, not of those that are kept. */
TEST(what_loads_find_is_theirs)
{
	enum { PRIMITIVES = 40 };
	hand_file f = {0};
	put_accessor(&f, positions, 4, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, normals, 4, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, plain, 4, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, indices, 6, NT_GLTF_USHORT, "SCALAR");
	put_accessor(&f, (const float[4][4]){{1, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 0, -1}}, 4,
		NT_GLTF_FLOAT, "VEC4");
	char members[8192];
	size_t length = (size_t)snprintf(members, sizeof members, "\"textures\":[{}],\"materials\":[{"
		"\"normalTexture\":{\"index\":0},\"extensions\":{\"KHR_materials_clearcoat\":{"
		"\"clearcoatFactor\":1,\"clearcoatNormalTexture\":{\"index\":0,\"extensions\":{"
		"\"KHR_texture_transform\":{\"rotation\":1}}}}}}],\"meshes\":[{\"primitives\":[");
	for (int i = 0; i < PRIMITIVES; i++)
		length += (size_t)snprintf(members + length, sizeof members - length,
			"%s{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"TANGENT\":4},"
			"\"indices\":3,\"material\":0}", i ? "," : "");
	snprintf(members + length, sizeof members - length, "]}],");
	put_glb("in.glb", &f, members);
	assert_int_equal(convert_and_count((nt_settings){0}, NT_CODE_TAN_KEPT_SIGN), 2 * PRIMITIVES);
	assert_int_equal(convert_and_count((nt_settings){0}, NT_CODE_TAN_UVSET_CONFLICT), 0);
}

TEST(repair_counts_what_it_changes)
{
	write_quad(NORMAL_MAP, plain, (float[4]){-1, -1, -1, 1});
	nt_summary summary = convert_file("in.glb", "out.glb", (nt_settings){.existing = NT_EXISTING_REPAIR});
	assert_int_equal(count_findings(&summary, NT_CODE_TAN_KEPT_SIGN), 0);
	assert_int_equal(summary.repaired, 6); /* one triangle is wrong, the other has two signs */
	nt_summary_free(&summary);
	assert_int_equal(convert_and_count((nt_settings){.existing = NT_EXISTING_REPAIR},
		NT_CODE_TAN_EXISTING_REPAIRED), 6);
}

TEST(meshes_without_texture_area_are_unmapped)
{
	write_quad(NORMAL_MAP, alike, NULL);
	assert_int_equal(convert_and_count((nt_settings){0}, NT_CODE_UV_UNMAPPED), 2);
	write_quad(NORMAL_MAP, (const float[4][2]){{0, 0}, {1, 0}, {1, -1}, {0.5f, -0.5f}}, NULL);
	assert_int_equal(convert_and_count((nt_settings){0}, NT_CODE_UV_UNMAPPED), 0);
	assert_int_equal(convert_and_count((nt_settings){0}, NT_CODE_UV_DEGENERATE_TRIANGLE), 1);
}

AROUND_ALL(make_folder, remove_folder)

/* SPDX-License-Identifier: MIT */
/*
 * Materials, texture transforms, scenes and instances of a document. tests/support/gltf_refused.py has its faults,
 * gltf_table.py how its bytes may lie.
 */
#include "hand_gltf_file.h"
#include <math.h>
#include "gltf/load.h"

/* A document in memory over one data URI buffer. */
typedef struct fixture {
	nt_scene scene;
	nt_buffer text;
	nt_error error;
} fixture;

static const nt_read_options plain_options = {.texcoord_set = -1};

static nt_status open_text(fixture *f, const char *before, const void *bytes, size_t size,
	const nt_read_options *options)
{
	memset(f, 0, sizeof *f);
	nt_buffer_format(&f->text, "{\"asset\":{\"version\":\"2.0\"},%s,\"buffers\":[", before);
	append_buffer(&f->text, bytes, size);
	nt_buffer_text(&f->text, "]}");
	return open_bytes(&f->scene, f->text.data, f->text.size, options, &f->error);
}

static void close_text(fixture *f)
{
	nt_scene_free(&f->scene);
	nt_buffer_free(&f->text);
}

/* Four vertices: positions, normals, texture coordinates, and indices as bytes, shorts and ints. */
typedef struct quad_bytes {
	float positions[4][3];
	float normals[4][3];
	float texcoords[4][2];
	uint8_t indices8[8];
	uint16_t indices16[8];
	uint32_t indices32[6];
} quad_bytes;

static const quad_bytes quad = {
	{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
	{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
	{{0, 1}, {1, 1}, {1, 0}, {0, 0.25f}},
	{0, 1, 2, 0, 2, 3, 0, 0},
	{0, 1, 2, 0, 2, 3, 0, 0},
	{0, 1, 2, 0, 2, 3},
};

#define QUAD_VIEWS                                                                                 \
	"\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"       \
	"\"byteLength\":48},{\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},{\"buffer\":0,"     \
	"\"byteOffset\":128,\"byteLength\":8},{\"buffer\":0,\"byteOffset\":136,\"byteLength\":16}," \
	"{\"buffer\":0,\"byteOffset\":152,\"byteLength\":24}]"
#define QUAD_ACCESSORS                                                                             \
	"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"   \
	"{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"                  \
	"{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"                  \
	"{\"bufferView\":3,\"componentType\":5121,\"count\":6,\"type\":\"SCALAR\"},"                \
	"{\"bufferView\":4,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"                \
	"{\"bufferView\":5,\"componentType\":5125,\"count\":6,\"type\":\"SCALAR\"}]"
#define QUAD_ATTRIBUTES "\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}"

static nt_status open_quad(fixture *f, const char *primitive, const char *more)
{
	char json[6000];
	snprintf(json, sizeof json, QUAD_VIEWS "," QUAD_ACCESSORS ",\"meshes\":[{\"name\":\"q\","
		"\"primitives\":[{%s}]}]%s", primitive, more);
	return open_text(f, json, &quad, sizeof quad, &plain_options);
}

static nt_mesh *load_quad(fixture *f, const char *primitive, const char *more)
{
	assert_int_equal(open_quad(f, primitive, more), NT_OK);
	assert_int_equal(nt_gltf_load(&f->scene, &f->scene.meshes[0], &plain_options, &f->error), NT_OK);
	return &f->scene.meshes[0];
}


/* Materials: what each asks for, and of which texture coordinates. */
static void check_material(const char *materials, const char *primitive, unsigned slots, uint32_t set,
	bool conflict)
{
	char more[2048], json[2048];
	snprintf(more, sizeof more, ",\"materials\":[%s]", materials);
	snprintf(json, sizeof json, QUAD_ATTRIBUTES ",%s", primitive);
	fixture f;
	assert_int_equal(open_quad(&f, json, more), NT_OK);
	assert_int_equal(f.scene.meshes[0].slots, slots);
	assert_int_equal(f.scene.meshes[0].texcoord_set, set);
	assert_int_equal(f.scene.meshes[0].texcoord_conflict, conflict);
	assert_int_equal(f.scene.meshes[0].has_texcoords, set == 0);
	close_text(&f);
}

TEST(materials_become_slots)
{
	const char *const mine = "\"material\":0";
	check_material("{}", mine, 0, 0, false);
	check_material("{\"normalTexture\":{\"index\":0}}", mine, NT_SLOT_NORMAL, 0, false);
	check_material("{\"normalTexture\":{\"index\":0,\"texCoord\":1}}", mine, NT_SLOT_NORMAL, 1, false);
	check_material("{\"normalTexture\":{\"index\":0,\"texCoord\":1,\"extensions\":{"
		"\"KHR_texture_transform\":{\"texCoord\":0}}}}", mine, NT_SLOT_NORMAL, 0, false);
	check_material("{\"extensions\":{\"KHR_materials_anisotropy\":{}}}", mine, NT_SLOT_ANISOTROPY, 0,
		false);
	check_material("{\"extensions\":{\"KHR_materials_clearcoat\":{}}}", mine, 0, 0, false);
	check_material("{\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatNormalTexture\":"
		"{\"index\":0,\"texCoord\":1}},\"KHR_materials_anisotropy\":{\"anisotropyTexture\":"
		"{\"index\":0}}}}", mine, NT_SLOT_CLEARCOAT_NORMAL | NT_SLOT_ANISOTROPY, 1, true);
	check_material("{\"normalTexture\":{\"index\":0},\"extensions\":{\"KHR_materials_unlit\":{}}}",
		mine, 0, 0, false);
	/* MToon of VRM 1 samples the map although the fallback is unlit */
	check_material("{\"normalTexture\":{\"index\":0},\"extensions\":{\"KHR_materials_unlit\":{},"
		"\"VRMC_materials_mtoon\":{}}}", mine, NT_SLOT_NORMAL, 0, false);
	check_material("{\"extensions\":{\"KHR_materials_unlit\":{},\"VRMC_materials_mtoon\":{}}}", mine, 0, 0, false);
	/* that of VRM 0 is in the root */
	check_material("{\"extensions\":{\"KHR_materials_unlit\":{}}}],\"extensions\":{\"VRM\":{"
		"\"materialProperties\":[{\"textureProperties\":{\"_BumpMap\":0}}]}},\"extras\":[0",
		mine, NT_SLOT_NORMAL, 0, false);
	check_material("{}],\"extensions\":{\"VRM\":{\"materialProperties\":"
		"[{\"textureProperties\":{\"_MainTex\":0}}]}},\"extras\":[0", mine, 0, 0, false);
	check_material("{},{\"normalTexture\":{\"index\":0}}", "\"material\":0,\"extensions\":{"
		"\"KHR_materials_variants\":{\"mappings\":[{\"material\":0},{\"material\":1}]}}",
		NT_SLOT_NORMAL, 0, false);
	check_material("{\"extensions\":{\"MSFT_lod\":{\"ids\":[1]}}},{\"normalTexture\":{\"index\":0}}",
		mine, NT_SLOT_NORMAL, 0, false);
}

TEST(vrm_0_mirrors_a_normal_map_by_its_main_texture)
{
	fixture f;
	load_quad(&f, QUAD_ATTRIBUTES ",\"material\":0", ",\"materials\":[{}],\"extensions\":{\"VRM\":{"
		"\"materialProperties\":[{\"textureProperties\":{\"_BumpMap\":0},"
		"\"vectorProperties\":{\"_MainTex\":[0,0,-1,1]}}]}}");
	assert_int_equal(f.scene.meshes[0].solve_sign, -1);
	close_text(&f);
}

static void load_transformed(fixture *f, const char *transform, const char *more)
{
	char materials[1024];
	snprintf(materials, sizeof materials, ",\"materials\":[{\"normalTexture\":{\"index\":0,"
		"\"extensions\":{\"KHR_texture_transform\":{%s}}}}]%s", transform, more);
	load_quad(f, QUAD_ATTRIBUTES ",\"material\":0", materials);
}

TEST(texture_transforms_turn_and_scale)
{
	fixture f;
	load_transformed(&f, "\"offset\":[0.5,0.25]", "");
	assert_null(f.scene.meshes[0].solve_texcoords);
	assert_int_equal(f.scene.meshes[0].solve_sign, 0);
	close_text(&f);

	/* scale first, exactly */
	load_transformed(&f, "\"scale\":[-2,0.5]", "");
	for (size_t i = 0; i < 4; i++) {
		const nt_mesh *mesh = &f.scene.meshes[0];
		assert_true(mesh->solve_texcoords[2 * i] == -2 * quad.texcoords[i][0]);
		assert_true(mesh->solve_texcoords[2 * i + 1] == -0.5f * quad.texcoords[i][1]);
		assert_true(mesh->texcoords[2 * i] == quad.texcoords[i][0]);
	}
	assert_int_equal(f.scene.meshes[0].solve_sign, -1);
	close_text(&f);

	/* a quarter turn, counterclockwise where v points up: (u, v) goes to (-v, u). glTF issue 1563: viewers
	 * and TextureTransformTest take it so */
	load_transformed(&f, "\"rotation\":1.5707963267948966", "");
	for (size_t i = 0; i < 4; i++) {
		const nt_mesh *mesh = &f.scene.meshes[0];
		assert_true(fabsf(mesh->solve_texcoords[2 * i] - quad.texcoords[i][1]) < 1e-6f);
		assert_true(fabsf(mesh->solve_texcoords[2 * i + 1] - quad.texcoords[i][0]) < 1e-6f);
	}
	assert_int_equal(f.scene.findings.count, 0);
	close_text(&f);
}

TEST(animated_transforms_are_known)
{
	fixture f;
	const char *animation = ",\"animations\":[{\"channels\":[{\"target\":{\"extensions\":{"
		"\"KHR_animation_pointer\":{\"pointer\":\"/materials/0/normalTexture/extensions/"
		"KHR_texture_transform/%s\"}}}}]}]";
	char text[512];
	snprintf(text, sizeof text, animation, "rotation");
	load_transformed(&f, "\"scale\":[1,1]", text);
	assert_true(f.scene.meshes[0].transform_animated);
	close_text(&f);
	snprintf(text, sizeof text, animation, "offset");
	load_transformed(&f, "\"scale\":[1,1]", text);
	assert_false(f.scene.meshes[0].transform_animated);
	close_text(&f);
}

TEST(scenes_decide_what_is_reached)
{
	static const struct {
		const char *more;
		bool reached;
	} cases[] = {
		{"", true},
		{",\"scenes\":[]", false},
		{",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1]},{\"mesh\":0}]", true},
		{",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{},{\"mesh\":0}]", false},
		{",\"scenes\":[{},{\"nodes\":[1]}],\"nodes\":[{},{\"mesh\":0}]", true},
		{",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[0,77,\"x\",1]},{\"children\":[0]}]",
			false},
		{",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"extensions\":{\"MSFT_lod\":{\"ids\":[1]}}},"
			"{\"mesh\":0}]", true},
		{",\"scenes\":7,\"nodes\":8", false},
	};
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		fixture f;
		assert_int_equal(open_quad(&f, QUAD_ATTRIBUTES, cases[i].more), NT_OK);
		assert_int_equal(f.scene.meshes[0].reachable, cases[i].reached);
		close_text(&f);
	}
}

TEST(instances_have_world_matrices)
{
	const nt_read_options options = {.texcoord_set = -1, .world = true};
	fixture f;
	/* parent: turned by 90 degrees about z (x to y), then moved by (10, 0, 0); child: scaled by 2 and moved
	 * by (1, 0, 0): the child's origin goes to (10, 1, 0), its x axis to 2 y */
	assert_int_equal(open_text(&f, "\"meshes\":[{\"primitives\":[{},{}]}],\"scenes\":[{\"nodes\":[0]}],"
		"\"nodes\":[{\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],"
		"\"translation\":[10,0,0],\"children\":[1]},{\"mesh\":0,\"matrix\":"
		"[2,0,0,0,0,2,0,0,0,0,2,0,1,0,0,1]}]", "", 0, &options), NT_OK);
	assert_int_equal(f.scene.instance_count, 2);
	assert_int_equal(f.scene.instances[1].mesh, 1);
	const double expected[16] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 1, 0, 1};
	for (int i = 0; i < 16; i++)
		assert_true(fabs(f.scene.instances[0].matrix[i] - expected[i]) < 1e-12);
	close_text(&f);
}

/* The other buffers do not exist, or say nothing; nobody asks for them. */
TEST(buffers_are_opened_only_when_wanted)
{
	fixture f = {0};
	nt_buffer_text(&f.text, "{\"asset\":{\"version\":\"2.0\"}," QUAD_ACCESSORS "," QUAD_VIEWS ",\"meshes\":[{"
		"\"primitives\":[{" QUAD_ATTRIBUTES "}]}],\"buffers\":[");
	append_buffer(&f.text, &quad, sizeof quad);
	nt_buffer_text(&f.text, ",{\"byteLength\":100,\"uri\":\"../absent.bin\"},{\"uri\":7}]}");
	assert_int_equal(open_bytes(&f.scene, f.text.data, f.text.size, &plain_options, &f.error), NT_OK);
	const nt_gltf *document = f.scene.source;
	assert_false(document->buffers[0].opened);
	assert_int_equal(nt_gltf_load(&f.scene, &f.scene.meshes[0], &plain_options, &f.error), NT_OK);
	assert_true(document->buffers[0].opened && !document->buffers[1].opened && !document->buffers[2].opened);
	close_text(&f);
}

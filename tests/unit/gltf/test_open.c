/* SPDX-License-Identifier: MIT */
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

static void check_triangles(const char *primitive, const uint32_t *expected, size_t corner_count)
{
	fixture f;
	const nt_mesh *mesh = load_quad(&f, primitive, "");
	assert_int_equal(mesh->corner_count, corner_count);
	assert_int_equal(mesh->face_count, corner_count / 3);
	for (size_t c = 0; c < corner_count; c++)
		assert_int_equal(mesh->indices ? mesh->indices[c] : c, expected[c]);
	close_text(&f);
}

TEST(all_kinds_of_indices_are_read)
{
	const uint32_t expected[] = {0, 1, 2, 0, 2, 3};
	for (int accessor = 3; accessor <= 5; accessor++) {
		char primitive[256];
		snprintf(primitive, sizeof primitive, QUAD_ATTRIBUTES ",\"indices\":%d", accessor);
		check_triangles(primitive, expected, 6);
	}
	check_triangles(QUAD_ATTRIBUTES, (const uint32_t[]){0, 1, 2}, 3);
}

/* glTF 2.0, 3.7.2.1: strip triangle i is (i, i+1+i%2, i+2-i%2), fan triangle i is (i+1, i+2, 0). */
TEST(strips_and_fans_become_triangles)
{
	check_triangles(QUAD_ATTRIBUTES ",\"mode\":5", (const uint32_t[]){0, 1, 2, 1, 3, 2}, 6);
	check_triangles(QUAD_ATTRIBUTES ",\"mode\":6", (const uint32_t[]){1, 2, 0, 2, 3, 0}, 6);
	/* the chain 0 1 2 0 2 3 */
	check_triangles(QUAD_ATTRIBUTES ",\"mode\":5,\"indices\":4",
		(const uint32_t[]){0, 1, 2, 1, 0, 2, 2, 0, 2, 0, 3, 2}, 12);
}

TEST(texcoords_have_v_up)
{
	fixture f;
	nt_mesh *mesh = load_quad(&f, QUAD_ATTRIBUTES, "");
	assert_int_equal(mesh->vertex_count, 4);
	for (size_t i = 0; i < 4; i++) {
		assert_true(mesh->texcoords[2 * i] == quad.texcoords[i][0]);
		assert_true(mesh->texcoords[2 * i + 1] == -quad.texcoords[i][1]);
	}
	assert_memory_equal(mesh->positions, quad.positions, sizeof quad.positions);
	assert_memory_equal(mesh->normals, quad.normals, sizeof quad.normals);
	assert_null(mesh->tangents);
	nt_place place;
	nt_mesh_place(mesh, &place);
	assert_string_equal(place.object, "mesh \"q\", primitive 0");
	assert_string_equal(place.pointer, "/meshes/0/primitives/0");
	close_text(&f);
}

TEST(faults_have_their_pointer)
{
	static const char attribute[] = "/meshes/0/primitives/0/attributes/POSITION";
	static const char *const rows[][2] = {{"\"attributes\":{\"NORMAL\":1}", "/meshes/0/primitives/0"},
		{"\"attributes\":{\"POSITION\":9}", attribute}, {"\"attributes\":{\"POSITION\":-1}", attribute},
		{"\"attributes\":{\"POSITION\":2}", attribute},
		{"\"attributes\":{\"POSITION\":0},\"indices\":0", "/accessors/0"},
		{"\"attributes\":{\"POSITION\":0},\"indices\":\"x\"", "/meshes/0/primitives/0/indices"},
		{"\"attributes\":{\"POSITION\":0},\"extensions\":{\"KHR_draco_mesh_compression\":{}}",
			"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression"}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		fixture f;
		assert_int_equal(open_quad(&f, rows[i][0], ""), NT_OK);
		assert_int_equal(nt_gltf_load(&f.scene, &f.scene.meshes[0], &plain_options, &f.error), NT_ERROR_INPUT);
		assert_string_equal(f.error.place.pointer, rows[i][1]);
		close_text(&f);
	}
}

/* One accessor of three elements, with anything about it. */
static nt_status load_positions(fixture *f, const char *view, const char *accessor, const void *bytes,
	size_t size)
{
	char json[2048];
	snprintf(json, sizeof json, "\"bufferViews\":[{%s}],\"accessors\":[{%s}],\"meshes\":[{"
		"\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]", view, accessor);
	const nt_status status = open_text(f, json, bytes, size, &plain_options);
	if (status)
		return status;
	return nt_gltf_load(&f->scene, &f->scene.meshes[0], &plain_options, &f->error);
}

#define FLOATS(view, count) "\"bufferView\":" view ",\"componentType\":5126,\"type\":\"VEC3\",\"count\":" count

TEST(counts_offsets_and_strides_are_checked)
{
	static const char view[] = "\"buffer\":0,\"byteLength\":36", vec3[] = FLOATS("0", "3");
	static const struct {
		const char *view, *accessor, *pointer;
		size_t size;
	} rows[] = {{view, vec3, NULL, 36}, {view, vec3, "/bufferViews/0", 35},
		{view, FLOATS("0", "4"), "/accessors/0", 36}, {view, FLOATS("0", "4294967294"), "/accessors/0", 36},
		{view, FLOATS("0", "99999999999999999999"), "/accessors/0/count", 36},
		{view, FLOATS("0", "3,\"byteOffset\":1"), "/accessors/0", 36},
		{view, "\"bufferView\":0,\"componentType\":5124,\"type\":\"VEC3\",\"count\":3",
			"/accessors/0/componentType", 36},
		{view, "\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC5\",\"count\":3",
			"/accessors/0/type", 36},
		{view, FLOATS("1", "3"), "/accessors/0", 36},
		{"\"buffer\":0,\"byteLength\":36,\"byteStride\":8", vec3, "/accessors/0", 36},
		{"\"buffer\":0,\"byteLength\":36,\"byteStride\":16", vec3, "/accessors/0", 36},
		{"\"buffer\":0,\"byteLength\":36,\"byteOffset\":9007199254740992", vec3, "/bufferViews/0", 36},
		{"\"buffer\":1,\"byteLength\":36", vec3, "/bufferViews/0", 36},
		{"\"buffer\":0", vec3, "/bufferViews/0", 36}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		static const unsigned char bytes[36];
		fixture f;
		assert_int_equal(load_positions(&f, rows[i].view, rows[i].accessor, bytes, rows[i].size),
			rows[i].pointer ? NT_ERROR_INPUT : NT_OK);
		assert_string_equal(f.error.place.pointer, rows[i].pointer ? rows[i].pointer : "");
		close_text(&f);
	}
}

static void check_positions(const char *view, const char *accessor, const void *bytes, size_t size,
	const float *expected)
{
	fixture f;
	assert_int_equal(load_positions(&f, view, accessor, bytes, size), NT_OK);
	for (size_t i = 0; i < 9; i++)
		assert_true(f.scene.meshes[0].positions[i] == expected[i]);
	close_text(&f);
}

TEST(quantized_interleaved_and_sparse_values_are_decoded)
{
	/* KHR_mesh_quantization: max(c / 127, -1) and so on */
	const int8_t bytes[12] = {127, -127, -128, 99, 0, 1, 2, 99, 64, -64, 3, 99};
	check_positions("\"buffer\":0,\"byteLength\":12,\"byteStride\":4", "\"bufferView\":0,"
		"\"componentType\":5120,\"normalized\":true,\"type\":\"VEC3\",\"count\":3", bytes, 12,
		(const float[]){1, -1, -1, 0, 1 / 127.0f, 2 / 127.0f, 64 / 127.0f, -64 / 127.0f, 3 / 127.0f});
	check_positions("\"buffer\":0,\"byteLength\":12,\"byteStride\":4", "\"bufferView\":0,"
		"\"componentType\":5121,\"type\":\"VEC3\",\"count\":3", bytes, 12,
		(const float[]){127, 129, 128, 0, 1, 2, 64, 192, 3});
	const uint16_t shorts[10] = {65535, 0, 32768, 7, 1, 2, 3, 7, 4, 5};
	check_positions("\"buffer\":0,\"byteLength\":20,\"byteStride\":6", "\"bufferView\":0,"
		"\"componentType\":5123,\"normalized\":true,\"type\":\"VEC3\",\"count\":3", shorts, 20,
		(const float[]){1, 0, 32768 / 65535.0f, 7 / 65535.0f, 1 / 65535.0f, 2 / 65535.0f,
			3 / 65535.0f, 7 / 65535.0f, 4 / 65535.0f});
	/* zeros but for row 1 */
	const struct {
		float value[3];
		uint8_t row[4];
	} sparse = {{1.5f, 2.5f, 3.5f}, {1}};
	check_positions("\"buffer\":0,\"byteLength\":16", "\"componentType\":5126,\"type\":\"VEC3\","
		"\"count\":3,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"byteOffset\":12,"
		"\"componentType\":5121},\"values\":{\"bufferView\":0}}", &sparse, sizeof sparse,
		(const float[]){0, 0, 0, 1.5f, 2.5f, 3.5f, 0, 0, 0});
}

TEST(sparse_elements_are_checked)
{
	const char *accessor = "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3,\"sparse\":{"
		"\"count\":2,\"indices\":{\"bufferView\":0,\"componentType\":5121},"
		"\"values\":{\"bufferView\":0,\"byteOffset\":4}}";
	static const uint8_t sparse[][2] = {{0, 3}, {1, 1}, {2, 1}};
	for (size_t i = 0; i < 3; i++) {
		unsigned char bytes[28] = {sparse[i][0], sparse[i][1]};
		fixture f;
		assert_int_equal(load_positions(&f, "\"buffer\":0,\"byteLength\":28", accessor, bytes, 28),
			NT_ERROR_INPUT);
		assert_string_equal(f.error.place.pointer, "/accessors/0/sparse/indices");
		close_text(&f);
	}
}

TEST(zeros_without_backing_are_limited)
{
	fixture f;
	assert_int_equal(load_positions(&f, "\"buffer\":0,\"byteLength\":4", "\"componentType\":5126,"
		"\"type\":\"VEC3\",\"count\":4000000000", "abcd", 4), NT_ERROR_UNSUPPORTED);
	close_text(&f);
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

TEST(what_is_not_read_is_not_checked)
{
	fixture f;
	load_quad(&f, QUAD_ATTRIBUTES, ",\"cameras\":[7],\"skins\":{},\"images\":[{\"uri\":\"../../etc/passwd\"}],"
		"\"animations\":[{\"channels\":9}],\"materials\":[3]");
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

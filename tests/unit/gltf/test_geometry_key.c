/* SPDX-License-Identifier: MIT */
/*
 * Which primitives count as the same. One triangle with everything a solve takes, and lists of primitives
 * over it; the expected answer is written beside each: the number of the earlier primitive, or -1.
 */
#include "hand_gltf_file.h"
#include "gltf/load.h"
#include "gltf/vertex_pools.h"

/* Positions, normals, texture coordinates, indices of one triangle; accessor 4 is 0 once more, 5 are other
 * positions, 6 is a delta. */
static const float floats[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, /* 0 */
	0, 0, 1, 0, 0, 1, 0, 0, 1,                         /* 36 */
	0, 0, 1, 0, 0, 1,                                  /* 72 */
	0, 0, 0, 2, 0, 0, 0, 2, 0};                        /* 96 */
static const char accessors[] = "\"accessors\":["
	"{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
	"{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
	"{\"bufferView\":0,\"byteOffset\":72,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},"
	"{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"},"
	"{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
	"{\"bufferView\":0,\"byteOffset\":96,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
	"\"min\":[0,0,0],\"max\":[2,2,0]}],"
	"\"bufferViews\":[{\"buffer\":0,\"byteLength\":132},{\"buffer\":0,\"byteOffset\":132,\"byteLength\":3}],";
static const char materials[] = "\"textures\":[{}],\"materials\":[{\"normalTexture\":{\"index\":0}},"
	"{\"name\":\"other\",\"normalTexture\":{\"index\":0,\"scale\":2}},"
	"{\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"rotation\":1}}}},{}],";

#define P(attributes, more) "{\"attributes\":{" attributes "}" more "}"
#define ALL "\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2"

static nt_scene scene;
static nt_buffer text;

static void open_with(const char *primitives, const nt_read_options *options)
{
	unsigned char bytes[sizeof floats + 3] = {0};
	memcpy(bytes, floats, sizeof floats);
	bytes[sizeof floats + 1] = 1;
	bytes[sizeof floats + 2] = 2;
	nt_buffer_text(&text, "{\"asset\":{\"version\":\"2.0\"},");
	nt_buffer_text(&text, accessors);
	nt_buffer_text(&text, materials);
	nt_buffer_format(&text, "\"meshes\":[{\"primitives\":[%s]}],\"buffers\":[", primitives);
	append_buffer(&text, bytes, sizeof bytes);
	nt_buffer_text(&text, "]}");
	nt_error error;
	if (open_bytes(&scene, text.data, text.size, options, &error))
		fail_msg("%s: %s", error.place.pointer, error.message);
	nt_select(&scene, NT_ONLY_AUTO, NT_EXISTING_REPLACE, NT_MAKING_MISSING);
	if (nt_vertex_pools_find(&scene, options, &error) || nt_gltf_find_same(&scene, options, &error))
		fail_msg("%s: %s", error.place.pointer, error.message);
}

static void close_scene(void)
{
	nt_scene_free(&scene);
	nt_buffer_free(&text);
}

static void expect(const char *primitives, const int *same, size_t count, const nt_read_options *options)
{
	open_with(primitives, options);
	assert_int_equal(scene.mesh_count, count);
	for (size_t i = 0; i < count; i++) {
		const nt_mesh *other = scene.meshes[i].plan.same_as;
		assert_int_equal(other ? (int)(other - scene.meshes) : -1, same[i]);
	}
	close_scene();
}

static const nt_read_options defaults = {.texcoord_set = -1};

TEST(equal_accessors_and_materials_that_turn_alike_are_the_same)
{
	expect(P(ALL, ",\"material\":0") "," P(ALL, ",\"material\":0") ","
		P("\"NORMAL\":1,\"TEXCOORD_0\":2,\"POSITION\":4", ",\"material\":1") ","
		P(ALL, ",\"material\":2") "," P(ALL, ",\"material\":2") ","
		P(ALL, ",\"material\":3") /* needs nothing */,
		(const int[]){-1, 0, 0, -1, 3, -1}, 6, &defaults);
}

TEST(other_corners_are_not_the_same)
{
	expect(P(ALL, ",\"material\":0") "," P(ALL, ",\"material\":0,\"indices\":3") ","
		P(ALL, ",\"material\":0,\"mode\":5") "," P(ALL, ",\"material\":0,\"mode\":4") ","
		P(ALL, ",\"material\":0,\"indices\":3") ","
		P("\"POSITION\":5,\"NORMAL\":1,\"TEXCOORD_0\":2", ",\"material\":0") ","
		P("\"POSITION\":0,\"TEXCOORD_0\":2", ",\"material\":0"),
		(const int[]){-1, -1, -1, 0, 1, -1, -1}, 7, &defaults);
}

TEST(targets_count_where_they_are_baked)
{
	static const char primitives[] = P(ALL, ",\"material\":0,\"targets\":[{\"POSITION\":5}]") ","
		P(ALL, ",\"material\":0,\"targets\":[{\"POSITION\":1}]") ","
		P(ALL, ",\"material\":0,\"targets\":[{\"NORMAL\":5}]") ","
		P(ALL, ",\"material\":0,\"targets\":[{\"POSITION\":5}]") "," P(ALL, ",\"material\":0");
	expect(primitives, (const int[]){-1, -1, -1, 0, -1}, 5, &defaults);
	const nt_read_options keep = {.texcoord_set = -1, .morphs = NT_MORPH_KEEP};
	expect(primitives, (const int[]){-1, 0, 0, 0, 0}, 5, &keep);
}

TEST(a_faulty_reference_is_like_nothing_else)
{
	expect(P("\"POSITION\":0,\"NORMAL\":99,\"TEXCOORD_0\":2", ",\"material\":0") ","
		P("\"POSITION\":0,\"NORMAL\":99,\"TEXCOORD_0\":2", ",\"material\":0") ","
		P("\"POSITION\":0,\"NORMAL\":-1,\"TEXCOORD_0\":2", ",\"material\":0") ","
		P("\"POSITION\":0,\"TEXCOORD_0\":2", ",\"material\":0"),
		(const int[]){-1, -1, -1, -1}, 4, &defaults);
}

TEST(what_is_loaded_is_shared_and_not_copied)
{
	nt_error error;
	open_with(P(ALL, ",\"material\":0,\"indices\":3") "," P(ALL, ",\"material\":1,\"indices\":3"), &defaults);
	for (size_t i = 0; i < 2; i++)
		assert_int_equal(nt_gltf_load(&scene, &scene.meshes[i], &defaults, &error), NT_OK);
	const nt_mesh *a = &scene.meshes[0], *b = &scene.meshes[1];
	assert_ptr_equal(a->positions, b->positions);
	assert_ptr_equal(a->texcoords, b->texcoords);
	assert_ptr_equal(a->indices, b->indices);
	assert_int_equal(b->corner_count, 3);
	/* what it is called stays its own */
	nt_place place;
	assert_string_equal(nt_mesh_place(b, &place)->object, "mesh 0, primitive 1, material \"other\"");
	assert_int_equal(b->gltf_primitive, 1);
	close_scene();
}

/* Many primitives in one file, in linear time: n compared with each other would be 10^10. */
TEST(a_hundred_thousand_primitives_are_no_burden)
{
	enum { COUNT = 100000 };
	nt_buffer primitives = {0};
	for (int i = 0; i < COUNT; i++)
		nt_buffer_format(&primitives, "%s" P(ALL, ",\"material\":0,\"targets\":[{\"POSITION\":%d}]"),
			i ? "," : "", i % 2 ? 5 : i + 1000);
	open_with(primitives.data, &defaults);
	size_t same = 0;
	for (size_t i = 0; i < COUNT; i++)
		same += scene.meshes[i].plan.same_as == &scene.meshes[1];
	assert_int_equal(same, COUNT / 2 - 1);
	close_scene();
	nt_buffer_free(&primitives);
}

/* SPDX-License-Identifier: MIT */
/*
 * Data URIs that are made while the text is written. What is written is read again, and says what sidecars say.
 */
#include "folder.h"
#include "test.h"
#include <sys/stat.h>
#include "file/base64.h"
#include "pipeline/run.h"

/* A triangle whose normals and texture coordinates are in a file, and positions, beside which tangents will be, in a
 * data URI with a media type of its own. name: of the mesh. */
static void put_triangle(const char *name)
{
	static const float others[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
	static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
	nt_buffer json = {0};
	put_file("in.bin", others, sizeof others);
	nt_buffer_format(&json, "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"name\":\"%s\",\"primitives\":[{"
		"\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"material\":0}]}],"
		"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
		"\"min\":[0,0,0],\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":3,"
		"\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
		"\"bufferViews\":[{\"buffer\":1,\"byteLength\":36},{\"buffer\":0,\"byteLength\":36},"
		"{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}],\"buffers\":[{\"byteLength\":60,"
		"\"uri\":\"in.bin\"},{\"byteLength\":36,\"uri\":\"data:application/gltf-buffer;base64,", name);
	nt_base64_append(&json, positions, sizeof positions);
	nt_buffer_text(&json, "\"}],\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{}]}");
	put_file("in.gltf", json.data, json.size);
	nt_buffer_free(&json);
}

static void run(const char *from, const char *to, nt_settings settings)
{
	nt_summary summary;
	nt_error error;
	settings.texcoord_set = -1;
	if (nt_run(in_folder(from), in_folder(to), &settings, &summary, &error))
		fail_msg("%s: %s: %s", from, error.place.pointer, error.message);
	nt_summary_free(&summary);
}

static nt_file open_file(const char *name)
{
	nt_file file;
	nt_error error;
	assert_int_equal(nt_file_open(&file, in_folder(name), &error), NT_OK);
	return file;
}

static bool has_text(const nt_file *file, const char *text)
{
	return memmem(file->data, file->size, text, strlen(text)) != NULL;
}

/* The way back, to a .glb of one chunk after the other, gives the same bytes as the way without data URIs. */
static void assert_embedded(const char *name)
{
	put_triangle(name);
	run("in.gltf", "embedded.gltf", (nt_settings){.embed = true, .verify = true});
	run("in.gltf", "linked.gltf", (nt_settings){.verify = true});
	run("embedded.gltf", "a.glb", (nt_settings){0});
	run("linked.gltf", "b.glb", (nt_settings){0});
	nt_file a = open_file("a.glb"), b = open_file("b.glb"), text = open_file("embedded.gltf");
	assert_int_equal(a.size, b.size);
	assert_memory_equal(a.data, b.data, a.size);
	/* the name is as it was, and the second buffer has its media type */
	assert_true(has_text(&text, name));
	assert_true(has_text(&text, "\"uri\":\"data:application/octet-stream;base64,AAAA"));
	assert_true(has_text(&text, "\"uri\":\"data:application/gltf-buffer;base64,AAAA"));
	nt_file_close(&a);
	nt_file_close(&b);
	nt_file_close(&text);
}

static void buffers_are_encoded_where_they_belong(void **state)
{
	(void)state;
	assert_embedded("plain");
}

/* The mesh is called like a data URI without its data, and like the first of its characters. */
static void names_that_look_like_data_stay(void **state)
{
	(void)state;
	assert_embedded("data:application/octet-stream;base64,");
	assert_embedded("data:application/gltf-buffer;base64,A");
}

/* The text is made twice where a sidecar gets its name in two steps: the second run replaces the first one's
 * out/in.bin, while the other buffer is a data URI in both texts. */
static void data_is_in_every_text(void **state)
{
	(void)state;
	const nt_settings settings = {.buffers = NT_BUFFERS_COPY, .verify = true};
	assert_int_equal(mkdir(in_folder("out"), 0777), 0);
	put_triangle("first");
	run("in.gltf", "out/in.gltf", settings);
	nt_file before = open_file("out/in.gltf");
	static const float turned[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0}; /* u and v exchanged */
	put_file("in.bin", turned, sizeof turned);
	run("in.gltf", "out/in.gltf", settings);
	nt_file after = open_file("out/in.gltf"), sidecar = open_file("out/in.bin");
	assert_true(has_text(&after, "\"uri\":\"data:application/gltf-buffer;base64,AAAA"));
	assert_true(has_text(&after, "\"uri\":\"in.bin\""));
	assert_int_equal(after.size, before.size);
	assert_int_equal(sidecar.size, sizeof turned);
	assert_memory_equal(sidecar.data, turned, sizeof turned);
	nt_file_close(&before);
	nt_file_close(&after);
	nt_file_close(&sidecar);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(buffers_are_encoded_where_they_belong),
		cmocka_unit_test(names_that_look_like_data_stay),
		cmocka_unit_test(data_is_in_every_text),
	};
	return cmocka_run_group_tests_name("gltf/edit/data_uris", tests, make_folder, remove_folder);
}

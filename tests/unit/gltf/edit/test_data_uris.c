/* SPDX-License-Identifier: MIT */
/*
 * Data URIs that are made while the text is written. The output is read again, and has the bytes of sidecars.
 */
#include "hand_gltf_file.h"
#include <sys/stat.h>
#include "file/base64.h"

/* A triangle whose normals and texture coordinates are in a file, and positions, beside which tangents will be, in a
 * data URI with a media type of its own. name: of the mesh. */
static void put_triangle(const char *name)
{
	static const float others[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
	static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
	nt_buffer json = {0};
	put_file("in.bin", others, sizeof others);
	nt_buffer_format(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"%s\"}," TRIANGLE "\"bufferViews\":["
		"{\"buffer\":1,\"byteLength\":36},{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
		"\"byteLength\":24}],\"buffers\":[{\"byteLength\":60,\"uri\":\"in.bin\"},{\"byteLength\":36,"
		"\"uri\":\"data:application/gltf-buffer;base64,", name);
	nt_base64_append(&json, positions, sizeof positions);
	nt_buffer_text(&json, "\"}]}");
	put_file("in.gltf", json.data, json.size);
	nt_buffer_free(&json);
}

static void run(const char *from, const char *to, nt_settings settings)
{
	nt_summary summary = convert_file(from, to, settings);
	nt_summary_free(&summary);
}

static bool has_text(const nt_file *file, const char *text)
{
	return memmem(file->data, file->size, text, strlen(text)) != NULL;
}

/* The way back, to a .glb of one chunk after the other, gives the same bytes as the way without data URIs. */
static void assert_embedded(const char *name)
{
	put_triangle(name);
	run("in.gltf", "embedded.gltf", (nt_settings){.io.buffers = NT_BUFFERS_EMBED, .verify = true});
	run("in.gltf", "linked.gltf", (nt_settings){.verify = true});
	run("embedded.gltf", "a.glb", (nt_settings){0});
	run("linked.gltf", "b.glb", (nt_settings){0});
	assert_true(same_files("a.glb", "b.glb"));
	nt_file text = file_in_folder("embedded.gltf");
	/* the name is as it was, and the second buffer has its media type */
	assert_true(has_text(&text, name));
	assert_true(has_text(&text, "\"uri\":\"data:application/octet-stream;base64,AAAA"));
	assert_true(has_text(&text, "\"uri\":\"data:application/gltf-buffer;base64,AAAA"));
	nt_file_close(&text);
}

/* Also where the file has the name of a data URI without its data, or with the first of its characters. */
TEST(buffers_are_encoded_where_they_belong)
{
	assert_embedded("plain");
	assert_embedded("data:application/octet-stream;base64,");
	assert_embedded("data:application/gltf-buffer;base64,A");
}

/* The text is made twice where a sidecar gets its name in two steps: the second run replaces the first one's
 * out/in.bin, while the other buffer is a data URI in both texts. */
TEST(data_is_in_every_text)
{
	const nt_settings settings = {.io.buffers = NT_BUFFERS_COPY, .verify = true};
	assert_int_equal(mkdir(in_folder("out"), 0777), 0);
	put_triangle("first");
	run("in.gltf", "out/in.gltf", settings);
	nt_file before = file_in_folder("out/in.gltf");
	static const float turned[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0}; /* u and v exchanged */
	put_file("in.bin", turned, sizeof turned);
	run("in.gltf", "out/in.gltf", settings);
	nt_file after = file_in_folder("out/in.gltf"), sidecar = file_in_folder("out/in.bin");
	assert_true(has_text(&after, "\"uri\":\"data:application/gltf-buffer;base64,AAAA"));
	assert_true(has_text(&after, "\"uri\":\"in.bin\""));
	assert_int_equal(after.size, before.size);
	assert_int_equal(sidecar.size, sizeof turned);
	assert_memory_equal(sidecar.data, turned, sizeof turned);
	nt_file_close(&before);
	nt_file_close(&after);
	nt_file_close(&sidecar);
}

AROUND_ALL(make_folder, remove_folder)

/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "file/path.h"

static void check_data(const char *uri, const char *expected, size_t expected_size)
{
	unsigned char *bytes;
	size_t size;
	nt_error error;
	assert_true(nt_uri_is_data(uri, strlen(uri)));
	assert_int_equal(nt_uri_decode_data(uri, strlen(uri), &bytes, &size, &error), NT_OK);
	assert_int_equal(size, expected_size);
	assert_memory_equal(bytes, expected, expected_size);
	free(bytes);
}

TEST(data_uris_of_any_kind_are_decoded)
{
	check_data("data:application/octet-stream;base64,AAECAw==", "\0\1\2\3", 4);
	check_data("data:;base64,AAECAw", "\0\1\2\3", 4);
	check_data("DATA:image/png;x=y;BASE64,/+8=", "\xFF\xEF", 2);
	check_data("data:application/gltf-buffer;base64,", "", 0);
	check_data("data:text/plain,a%20b%4a%4G%g4%", "a bJ%4G%g4%", 11);
	check_data("data:,", "", 0);
}

TEST(broken_data_uris_are_refused)
{
	static const char *const broken[] = {"data:", "data:x;base64", "data:;base64,AA*A", "data:;base64,AAAAA",
		"data:;base64,=AAA", "data:;base64,AA===="};
	for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
		unsigned char *bytes;
		size_t size;
		nt_error error;
		assert_true(nt_uri_is_data(broken[i], strlen(broken[i])));
		assert_int_equal(nt_uri_decode_data(broken[i], strlen(broken[i]), &bytes, &size, &error),
			NT_ERROR_INPUT);
		assert_null(bytes);
	}
}

TEST(base64_comes_back)
{
	unsigned char bytes[50];
	for (size_t i = 0; i < sizeof bytes; i++)
		bytes[i] = (unsigned char)(i * 37 + 11);
	for (size_t size = 0; size < sizeof bytes; size++) {
		nt_buffer uri = {0};
		nt_uri_append_data(&uri, "a/b", bytes, size);
		check_data(uri.data, (const char *)bytes, size);
		nt_buffer_free(&uri);
	}
}

static nt_status resolve(const char *document, const char *uri, size_t length, bool allow,
	char *path)
{
	nt_arena arena = {0};
	nt_error error;
	const char *found = NULL;
	nt_error_clear(&error);
	const nt_status status =
		nt_uri_resolve(&arena, document, uri, length, allow, &found, &error);
	if (status == NT_OK)
		strcpy(path, found);
	else if (length && uri[0])
		assert_non_null(strstr(error.message, uri));
	nt_arena_free(&arena);
	return status;
}

static void check_resolve(const char *document, const char *uri, bool allow, nt_status expected)
{
	char path[512];
	assert_int_equal(resolve(document, uri, strlen(uri), allow, path), expected);
}

TEST(names_outside_are_refused)
{
	static const char *const outside[] = {"../x.bin", "a/../../x.bin", "%2e%2e/x.bin", "..\\x.bin",
		"/etc/passwd", "%2Fetc/passwd", "\\\\host\\share", "C:\\x.bin", "c:/x.bin", "..", ""};
	for (size_t i = 0; i < sizeof outside / sizeof *outside; i++)
		check_resolve("dir/a.gltf", outside[i], false, NT_ERROR_INPUT);
	check_resolve("dir/a.gltf", "http://host/x.bin", false, NT_ERROR_UNSUPPORTED);
	check_resolve("dir/a.gltf", "Zz+a-9.0:x", true, NT_ERROR_UNSUPPORTED);
	check_resolve("dir/a.gltf", "2a:x", true, NT_OK);
	check_resolve("dir/a.gltf", "file:///x.bin", true, NT_ERROR_UNSUPPORTED);
	check_resolve("dir/a.gltf", "x%00.bin", true, NT_ERROR_INPUT);
	char path[512];
	assert_int_equal(resolve("a.gltf", "x\0y", 3, true, path), NT_ERROR_INPUT);
	assert_int_equal(resolve("dir/a.gltf", "../x%20y.bin", 12, true, path), NT_OK);
	assert_string_equal(path, "dir/../x y.bin");
	assert_int_equal(resolve("dir/a.gltf", "/x.bin", 6, true, path), NT_OK);
	assert_string_equal(path, "/x.bin");
}

TEST(paths_are_percent_encoded)
{
	nt_buffer text = {0};
	nt_uri_append_path(&text, "dir/a b%c\xC3\xA9#.bin");
	assert_string_equal(text.data, "dir/a%20b%25c%C3%A9%23.bin");
	nt_buffer_free(&text);
}

/* SPDX-License-Identifier: MIT */
#include "folder.h"
#include "file/output.h"
#include "test.h"

/* Writes `size` bytes in pieces of `piece` and gives the text. */
static char *encoded(const unsigned char *bytes, size_t size, size_t piece)
{
	nt_output *output;
	nt_sink *sink;
	nt_error error;
	assert_int_equal(nt_output_create(&output, NULL, &error), NT_OK);
	assert_int_equal(nt_output_add(output, in_folder("out"), NT_ROLE_MAIN, &sink, &error), NT_OK);
	nt_base64 base64 = {.sink = sink};
	for (size_t at = 0; at < size; at += piece)
		assert_int_equal(nt_base64_write(&base64, bytes + at, size - at < piece ? size - at : piece,
					 &error), NT_OK);
	assert_int_equal(nt_base64_end(&base64, &error), NT_OK);
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("out"), NT_NAMED_BY_USER, &error), NT_OK);
	char *text = calloc(file.size + 1, 1);
	memcpy(text, file.data, file.size);
	nt_file_close(&file);
	return text;
}

TEST(vectors_of_rfc_4648_come_out_in_any_pieces)
{
	static const char *const expected[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
	for (size_t size = 0; size <= 6; size++)
		for (size_t piece = 1; piece <= 6; piece++) {
			char *text = encoded((const unsigned char *)"foobar", size, piece);
			assert_string_equal(text, expected[size]);
			free(text);
		}
}

TEST(large_blocks_pass_the_buffer_whole)
{
	enum { SIZE = 100001 };
	unsigned char *bytes = malloc(SIZE);
	memset(bytes, 0xff, SIZE);
	char *text = encoded(bytes, SIZE, 50000);
	assert_int_equal(strlen(text), (SIZE + 2) / 3 * 4);
	assert_int_equal(strspn(text, "/"), SIZE / 3 * 4 + 2); /* 100001 = 3 * 33333 + 2 */
	assert_string_equal(text + SIZE / 3 * 4, "//8=");
	free(text);
	free(bytes);
}

AROUND_ALL(make_folder, remove_folder)

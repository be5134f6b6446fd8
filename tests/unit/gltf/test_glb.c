/* SPDX-License-Identifier: MIT */
#include "folder.h"
#include "test.h"
#include <stdio.h>
#include <unistd.h>
#include "base/buffer.h"
#include "gltf/glb.h"

static void append_u32(nt_buffer *buffer, uint32_t value)
{
	const unsigned char bytes[] = {value & 255, value >> 8 & 255, value >> 16 & 255, value >> 24};
	nt_buffer_append(buffer, bytes, 4);
}

static void append_chunk(nt_buffer *buffer, const char *type, const char *data, uint32_t size)
{
	append_u32(buffer, size);
	nt_buffer_append(buffer, type, 4);
	nt_buffer_append(buffer, data, size);
}

static void append_header(nt_buffer *buffer, uint32_t version, uint32_t length)
{
	nt_buffer_text(buffer, "glTF");
	append_u32(buffer, version);
	append_u32(buffer, length);
}

static void finish_length(nt_buffer *buffer)
{
	for (int i = 0; i < 4; i++)
		buffer->data[8 + i] = (char)(buffer->size >> 8 * i);
}

static nt_status parse(const nt_buffer *file, nt_glb *glb, nt_arena *arena, nt_error *error)
{
	/* a copy of the exact size, so that a read behind it is seen */
	unsigned char *copy = malloc(file->size ? file->size : 1);
	if (file->size)
		memcpy(copy, file->data, file->size);
	nt_error_clear(error);
	const nt_status status = nt_glb_parse(glb, arena, copy, file->size, error);
	free(copy);
	return status;
}

static void check_refused(nt_buffer *file, nt_status status, uint64_t offset)
{
	nt_glb glb;
	nt_arena arena = {0};
	nt_error error;
	assert_int_equal(parse(file, &glb, &arena, &error), status);
	assert_int_equal(error.place.offset, offset);
	nt_arena_free(&arena);
	nt_buffer_free(file);
}

static void chunks_are_found_and_extra_ones_kept(void **state)
{
	(void)state;
	nt_buffer file = {0};
	append_header(&file, 2, 0);
	append_chunk(&file, "JSON", "{}\0\0", 4); /* padded with NULs: a quirk */
	append_chunk(&file, "BIN", "12345", 5);   /* not padded: another */
	append_chunk(&file, "XTRA", "abcd", 4);
	append_chunk(&file, "BIN", "6789", 4);
	finish_length(&file);
	nt_buffer_append(&file, "trailing", 8);
	nt_glb glb;
	nt_arena arena = {0};
	nt_error error;
	assert_int_equal(parse(&file, &glb, &arena, &error), NT_OK);
	assert_int_equal(glb.json.offset, 20);
	assert_int_equal(glb.json.size, 2);
	assert_true(glb.has_bin);
	assert_int_equal(glb.bin.offset, 32);
	assert_int_equal(glb.bin.size, 5);
	assert_int_equal(glb.other_count, 2);
	assert_int_equal(glb.others[0].offset, 45);
	assert_int_equal(glb.others[0].size, 4);
	assert_int_equal(glb.others[1].type, 0x004E4942);
	nt_arena_free(&arena);
	nt_buffer_free(&file);
}

static void faults_have_their_offset(void **state)
{
	(void)state;
	nt_buffer file = {0};
	check_refused(&file, NT_ERROR_INPUT, 0);
	nt_buffer_text(&file, "glTF\2");
	check_refused(&file, NT_ERROR_INPUT, 5);
	nt_buffer_append(&file, "glTX\2\0\0\0\0\0\0\0", 12);
	check_refused(&file, NT_ERROR_INPUT, 0);
	append_header(&file, 1, 20);
	check_refused(&file, NT_ERROR_UNSUPPORTED, 4);
	append_header(&file, 2, 12);
	check_refused(&file, NT_ERROR_INPUT, 8);
	append_header(&file, 2, 200);
	append_chunk(&file, "JSON", "{}  ", 4);
	check_refused(&file, NT_ERROR_INPUT, 8);
	append_header(&file, 2, 0);
	append_chunk(&file, "BIN", "{}  ", 4);
	finish_length(&file);
	check_refused(&file, NT_ERROR_INPUT, 16);
	append_header(&file, 2, 0);
	append_chunk(&file, "JSON", "", 0);
	finish_length(&file);
	check_refused(&file, NT_ERROR_INPUT, 12);
	append_header(&file, 2, 0);
	append_u32(&file, 0xFFFFFFFF);
	nt_buffer_text(&file, "JSON{}  ");
	finish_length(&file);
	check_refused(&file, NT_ERROR_INPUT, 12);
	append_header(&file, 2, 0);
	append_chunk(&file, "JSON", "{}  ", 4);
	nt_buffer_text(&file, "12345");
	finish_length(&file);
	check_refused(&file, NT_ERROR_INPUT, 24);
}

/* Writes a GLB through a sink and reads it back. */
static void written_container_is_padded_and_sized(void **state)
{
	(void)state;
	char *path = in_tmpdir("nmtan-test-glb-XXXXXX");
	const int descriptor = mkstemp(path);
	assert_true(descriptor >= 0);
	close(descriptor);
	nt_error error;
	nt_output *output;
	nt_sink *sink;
	assert_int_equal(nt_output_create(&output, &(nt_output_options){0}, &error), NT_OK);
	assert_int_equal(nt_output_add(output, path, NT_ROLE_MAIN, &sink, &error), NT_OK);
	assert_int_equal(nt_glb_begin(sink, 7, true, 5, nt_glb_chunk_bytes(3), &error), NT_OK);
	assert_int_equal(nt_sink_write(sink, "{\"a\":1}", 7, &error), NT_OK);
	assert_int_equal(nt_glb_end_json(sink, 7, true, 5, &error), NT_OK);
	assert_int_equal(nt_sink_write(sink, "12345", 5, &error), NT_OK);
	assert_int_equal(nt_glb_end_bin(sink, 5, &error), NT_OK);
	assert_int_equal(nt_glb_write_chunk(sink, 0x41525458, "abc", 3, &error), NT_OK);
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	nt_file file;
	assert_int_equal(nt_file_open(&file, path, &error), NT_OK);
	static const char expected[] = "glTF\2\0\0\0\x38\0\0\0\x08\0\0\0JSON{\"a\":1} \x08\0\0\0BIN\0"
		"12345\0\0\0\4\0\0\0XTRAabc";
	assert_int_equal(file.size, 56);
	assert_int_equal(sizeof expected, 56);
	assert_memory_equal(file.data, expected, 56);
	nt_file_close(&file);
	remove(path);
}

static void four_gigabytes_are_refused(void **state)
{
	(void)state;
	nt_error error;
	assert_int_equal(nt_glb_begin(NULL, 2, true, UINT32_MAX - 20, 0, &error),
		NT_ERROR_UNSUPPORTED);
	assert_int_equal(nt_glb_begin(NULL, 2, true, UINT64_MAX, 0, &error),
		NT_ERROR_UNSUPPORTED);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(chunks_are_found_and_extra_ones_kept),
		cmocka_unit_test(faults_have_their_offset),
		cmocka_unit_test(written_container_is_padded_and_sized),
		cmocka_unit_test(four_gigabytes_are_refused),
	};
	return cmocka_run_group_tests_name("gltf/glb", tests, NULL, NULL);
}

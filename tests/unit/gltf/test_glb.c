/* SPDX-License-Identifier: MIT */
#include "hand_gltf_file.h"
#include "gltf/glb.h"

/* Reads a copy of the exact size, so that a read behind it is seen. */
static nt_status parse(const char *bytes, size_t size, nt_glb *glb, nt_arena *arena, nt_error *error)
{
	unsigned char *copy = memcpy(malloc(size + !size), bytes, size);
	nt_error_clear(error);
	const nt_status status = nt_glb_parse(glb, arena, copy, size, error);
	free(copy);
	return status;
}

TEST(chunks_are_found_and_extra_ones_kept)
{
	/* the first padded with NULs: a quirk; the second not padded: another */
	static const char file[] = "glTF\2\0\0\0\x3D\0\0\0\4\0\0\0JSON{}\0\0\5\0\0\0BIN\0" "12345\4\0\0\0XTRAabcd"
		"\4\0\0\0BIN\0" "6789trailing";
	nt_glb glb;
	nt_arena arena = {0};
	nt_error error;
	assert_int_equal(parse(file, sizeof file, &glb, &arena, &error), NT_OK);
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
}

TEST(faults_have_their_offset)
{
	static const struct {
		const char *bytes;
		size_t size;
		uint64_t offset;
	} rows[] = {{"", 0, 0}, {"glTF\2", 5, 5}, {"glTX\2\0\0\0\0\0\0\0", 12, 0},
		{"glTF\1\0\0\0\x14\0\0\0", 12, 4}, {"glTF\2\0\0\0\x0C\0\0\0", 12, 8},
		{"glTF\2\0\0\0\xC8\0\0\0\4\0\0\0JSON{}  ", 24, 8}, {"glTF\2\0\0\0\x18\0\0\0\4\0\0\0BIN\0{}  ", 24, 16},
		{"glTF\2\0\0\0\x14\0\0\0\0\0\0\0JSON", 20, 12},
		{"glTF\2\0\0\0\x18\0\0\0\xFF\xFF\xFF\xFFJSON{}  ", 24, 12},
		{"glTF\2\0\0\0\x1D\0\0\0\4\0\0\0JSON{}  12345", 29, 24}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_glb glb;
		nt_arena arena = {0};
		nt_error error;
		assert_int_equal(parse(rows[i].bytes, rows[i].size, &glb, &arena, &error),
			rows[i].offset == 4 ? NT_ERROR_UNSUPPORTED : NT_ERROR_INPUT);
		assert_int_equal(error.place.offset, rows[i].offset);
		nt_arena_free(&arena);
	}
}

/* Writes a GLB through a sink and reads it back. */
TEST(written_container_is_padded_and_sized)
{
	nt_error error;
	nt_output *output;
	nt_sink *sink;
	assert_int_equal(nt_output_create(&output, &(nt_output_options){0}, &error), NT_OK);
	assert_int_equal(nt_output_add(output, in_folder("a.glb"), NT_ROLE_MAIN, &sink, &error), NT_OK);
	assert_int_equal(nt_glb_begin(sink, 7, true, 5, nt_glb_chunk_bytes(3), &error), NT_OK);
	assert_int_equal(nt_sink_write(sink, "{\"a\":1}", 7, &error), NT_OK);
	assert_int_equal(nt_glb_end_json(sink, 7, true, 5, &error), NT_OK);
	assert_int_equal(nt_sink_write(sink, "12345", 5, &error), NT_OK);
	assert_int_equal(nt_glb_end_bin(sink, 5, &error), NT_OK);
	assert_int_equal(nt_glb_write_chunk(sink, 0x41525458, "abc", 3, &error), NT_OK);
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	nt_file file = file_in_folder("a.glb");
	static const char expected[] = "glTF\2\0\0\0\x38\0\0\0\x08\0\0\0JSON{\"a\":1} \x08\0\0\0BIN\0"
		"12345\0\0\0\4\0\0\0XTRAabc";
	assert_int_equal(file.size, 56);
	assert_int_equal(sizeof expected, 56);
	assert_memory_equal(file.data, expected, 56);
	nt_file_close(&file);
}

TEST(four_gigabytes_are_refused)
{
	nt_error error;
	assert_int_equal(nt_glb_begin(NULL, 2, true, UINT32_MAX - 20, 0, &error), NT_ERROR_UNSUPPORTED);
	assert_int_equal(nt_glb_begin(NULL, 2, true, UINT64_MAX, 0, &error), NT_ERROR_UNSUPPORTED);
}

AROUND_ALL(make_folder, remove_folder)

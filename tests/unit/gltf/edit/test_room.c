/* SPDX-License-Identifier: MIT */
/*
 * Room on the disk is asked for by what is there, not by what a file says of itself.
 */
#include "hand_gltf_file.h"
#include <errno.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <fcntl.h>

enum { FILE_BYTES = 1200000 };

/* Stands for that of the system, which the tests of this file do not ask. */
static bool is_asked = true;
static off_t asked_for;

int fallocate(int fd, int mode, off_t offset, off_t size)
{
	if (is_asked)
		return (int)syscall(SYS_fallocate, fd, mode, offset, size);
	asked_for += offset + size;
	errno = EOPNOTSUPP;
	return -1;
}

/* A triangle in a file of FILE_BYTES, which is said to have `length`. */
static void put_triangle(unsigned long long length)
{
	static const float values[FILE_BYTES / 4] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0,
		1, 0, 0, 1};
	nt_buffer json = {0};
	put_file("in.bin", values, sizeof values);
	nt_buffer_format(&json, "{\"asset\":{\"version\":\"2.0\"}," TRIANGLE "\"bufferViews\":[{\"buffer\":0,"
		"\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":72,"
		"\"byteLength\":24}],\"buffers\":[{\"byteLength\":%llu,\"uri\":\"in.bin\"}]}", length);
	put_file("in.gltf", json.data, json.size);
	nt_buffer_free(&json);
}

static nt_status run(const char *to, nt_error *error)
{
	nt_summary summary;
	asked_for = 0;
	const nt_status status = nt_run(in_folder("in.gltf"), in_folder(to), &(nt_settings){.io.texcoord_set = -1},
		&summary, error);
	nt_summary_free(&summary);
	return status;
}

TEST(lengths_are_looked_at_before_room_is_made)
{
	static const char *const outputs[] = {"out.gltf", "out.glb"};
	static const unsigned long long wrong[] = {FILE_BYTES + 4, 3ull << 30};
	nt_error error;
	for (size_t k = 0; k < 2; k++) {
		put_triangle(FILE_BYTES + 3); /* padding may be missing */
		assert_int_equal(run(outputs[k], &error), NT_OK);
		assert_in_range(asked_for, FILE_BYTES + 48, FILE_BYTES + 4096);
		for (size_t i = 0; i < 2; i++) {
			put_triangle(wrong[i]);
			assert_int_equal(run(outputs[k], &error), NT_ERROR_INPUT);
			assert_string_equal(error.place.pointer, "/buffers/0");
			assert_non_null(strstr(error.message, " but only 1200000 bytes are there"));
			assert_int_equal(asked_for, 0);
		}
	}
}

static int set_up(void **state)
{
	is_asked = false;
	return make_folder(state);
}

AROUND_EACH(set_up, remove_folder)

/* SPDX-License-Identifier: MIT */
/*
 * A .glb with a long JSON, which is made while another thread writes what comes behind it: a triangle, so much in its
 * extras, a BIN chunk of some megabytes and a chunk that nobody knows.
 */
#include "hand_gltf_file.h"
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

enum { EXTRAS_BYTES = 600000, BIN_BYTES = 3000000, JSON_BEGIN = 20 };

static void put_u32(nt_buffer *to, size_t number)
{
	nt_buffer_append(to, &(uint32_t){(uint32_t)number}, 4);
}

static void put_triangle(void)
{
	static float values[BIN_BYTES / 4] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
	for (size_t i = 24; i < BIN_BYTES / 4; i++)
		values[i] = (float)i;
	nt_buffer json = {0}, glb = {0};
	nt_buffer_text(&json, "{\"asset\":{\"version\":\"2.0\"}," TRIANGLE);
	nt_buffer_format(&json, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
		"\"byteLength\":36},{\"buffer\":0,\"byteOffset\":72,\"byteLength\":24},{\"buffer\":0,\"byteOffset\":96,"
		"\"byteLength\":%d}],\"buffers\":[{\"byteLength\":%d}],\"extras\":[0", BIN_BYTES - 96, BIN_BYTES);
	while (json.size < EXTRAS_BYTES)
		nt_buffer_format(&json, ",%zu", json.size);
	nt_buffer_text(&json, "]}");
	while (json.size % 4)
		nt_buffer_text(&json, " ");
	nt_buffer_text(&glb, "glTF");
	put_u32(&glb, 2);
	put_u32(&glb, JSON_BEGIN + json.size + 8 + BIN_BYTES + 12);
	put_u32(&glb, json.size);
	nt_buffer_text(&glb, "JSON");
	nt_buffer_append(&glb, json.data, json.size);
	put_u32(&glb, BIN_BYTES);
	nt_buffer_append(&glb, "BIN", 4);
	nt_buffer_append(&glb, values, BIN_BYTES);
	put_u32(&glb, 4);
	nt_buffer_text(&glb, "odd.odd!");
	assert_false(glb.failed || json.failed);
	put_file("in.glb", glb.data, glb.size);
	nt_buffer_free(&json);
	nt_buffer_free(&glb);
}

static nt_status run(const char *to, unsigned threads, nt_error *error)
{
	nt_summary summary;
	const nt_status status = nt_run(in_folder("in.glb"), in_folder(to),
		&(nt_settings){.texcoord_set = -1, .threads = threads}, &summary, error);
	nt_summary_free(&summary);
	return status;
}

/* One thread writes one after the other. */
TEST(a_long_json_is_the_same_for_any_number_of_threads)
{
	nt_error error;
	put_triangle();
	assert_int_equal(run("one.glb", 1, &error), NT_OK);
	nt_file in = file_in_folder("in.glb"), one = file_in_folder("one.glb");
	assert_true(one.size > in.size + 48); /* with TANGENT, its accessor and its view */
	assert_memory_equal(one.data + one.size - 8, "odd.odd!", 8);
	for (unsigned threads = 2; threads <= 3; threads++) {
		assert_int_equal(run("many.glb", threads, &error), NT_OK);
		assert_true(same_files("many.glb", "one.glb"));
	}
	nt_file_close(&one);
	nt_file_close(&in);
}

/* An output that may not grow beyond some size: neither the text nor what is behind it fits, or the text alone. */
TEST(a_file_that_may_not_grow_is_an_error_of_either_thread)
{
	static const rlim_t most[] = {EXTRAS_BYTES / 2, EXTRAS_BYTES + BIN_BYTES / 2};
	struct rlimit unlimited;
	put_triangle();
	assert_int_equal(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
	signal(SIGXFSZ, SIG_IGN);
	for (unsigned threads = 1; threads <= 2; threads++)
		for (size_t i = 0; i < sizeof most / sizeof *most; i++) {
			nt_error error;
			assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){most[i], unlimited.rlim_max}), 0);
			assert_int_equal(run("out.glb", threads, &error), NT_ERROR_IO);
			assert_int_equal(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
			assert_string_equal(error.message, "cannot write: File too large");
			assert_string_equal(error.place.file, in_folder("out.glb"));
			assert_int_equal(count_in_folder(), 1);
		}
	signal(SIGXFSZ, SIG_DFL);
}

TEST(exhausted_memory_is_told)
{
	nt_error error;
	put_triangle();
	for (unsigned threads = 1; threads <= 2; threads++)
		for (size_t failures = 0, failed = 1; failed; failures++) {
			fail_allocations_from(failures);
			const nt_status status = run("out.glb", threads, &error);
			failed = stop_failing_allocations();
			assert_true(status == NT_OK || (failed && status == NT_ERROR_MEMORY));
			assert_int_equal(count_in_folder(), status ? 1 : 2);
			if (!status)
				assert_int_equal(unlink(in_folder("out.glb")), 0);
			assert_true(failures < 10000);
		}
}

AROUND_EACH(make_folder, remove_folder)

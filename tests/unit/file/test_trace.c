/* SPDX-License-Identifier: MIT */
#include "file/input.h"
#include "file/lookup.h"
#include "file/trace.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

static const nt_trace_file *find(const nt_trace *trace, nt_trace_kind kind, const char *path)
{
	for (size_t i = 0; i < trace->count; i++)
		if (trace->files[i].kind == kind && strcmp(trace->files[i].path, path) == 0)
			return &trace->files[i];
	return NULL;
}

TEST(what_is_opened_and_what_is_missing_is_noted_once)
{
	nt_trace trace = {0};
	nt_error error;
	nt_file file;
	struct stat info;
	bool found;
	put_text_file("a", "12345");
	assert_null(nt_trace_use(&trace));
	for (int i = 0; i < 3; i++) {
		assert_int_equal(nt_file_open(&file, in_folder("a"), &error), NT_OK);
		nt_file_close(&file);
		assert_int_equal(nt_file_open(&file, in_folder("b"), &error), NT_ERROR_MISSING);
		assert_int_equal(nt_lookup_found(in_folder("c"), &info, &found, &error), NT_OK);
	}
	assert_int_equal(nt_file_open_untraced(&file, in_folder("a"), &error), NT_OK);
	nt_file_close(&file);
	assert_ptr_equal(nt_trace_use(NULL), &trace);
	assert_int_equal(nt_file_open(&file, in_folder("d"), &error), NT_ERROR_MISSING);
	assert_int_equal(trace.count, 3);
	const nt_trace_file *read = find(&trace, NT_TRACE_READ, in_folder("a"));
	assert_non_null(read);
	assert_int_equal(read->size, 5);
	assert_int_equal(stat(in_folder("a"), &info), 0);
	assert_int_equal(read->modified, info.st_mtim.tv_sec * INT64_C(1000000000) + info.st_mtim.tv_nsec);
	assert_true(read->noted >= read->modified);
	assert_non_null(find(&trace, NT_TRACE_MISSING, in_folder("b")));
	assert_non_null(find(&trace, NT_TRACE_MISSING, in_folder("c")));
	nt_trace_free(&trace);
}

TEST(what_was_written_is_noted_anew_when_it_is_forgotten)
{
	nt_trace trace = {0};
	struct stat info = {.st_size = 1};
	nt_trace_use(&trace);
	nt_trace_read("in", &info);
	nt_trace_written("out", "temporary", &info);
	nt_trace_written("out.bin", "temporary", &info);
	nt_trace_forget_written(&trace);
	assert_int_equal(trace.count, 1);
	info.st_size = 2;
	nt_trace_written("out.bin", "temporary", &info);
	nt_trace_written("out", "temporary", &info);
	nt_trace_read("out", &info);
	nt_trace_use(NULL);
	assert_int_equal(trace.count, 4);
	assert_int_equal(find(&trace, NT_TRACE_WRITTEN, "out")->size, 2);
	nt_trace_free(&trace);
}

TEST(what_another_run_has_read_is_known)
{
	nt_readers readers = {0};
	nt_trace traces[2] = {0};
	struct stat own = {.st_size = 1, .st_ino = 1}, both = {.st_size = 1, .st_ino = 2}, none = {.st_ino = 3};
	for (size_t i = 0; i < 2; i++) {
		nt_trace_share(&traces[i], &readers);
		nt_trace_use(&traces[i]);
		nt_trace_read("both", &both);
		if (i == 0)
			nt_trace_read("own", &own);
	}
	assert_true(nt_trace_is_read_elsewhere(&own));
	assert_true(nt_trace_is_read_elsewhere(&both));
	assert_false(nt_trace_is_read_elsewhere(&none));
	nt_trace_use(&traces[0]);
	nt_trace_read("own, by another name", &own);
	assert_false(nt_trace_is_read_elsewhere(&own));
	nt_trace_use(NULL);
	assert_false(nt_trace_is_read_elsewhere(&own));
	nt_trace_free(&traces[0]);
	nt_trace_free(&traces[1]);
	nt_readers_free(&readers);
}

TEST(an_exhausted_memory_is_remembered)
{
	const struct stat info = {.st_size = 1};
	size_t failures = 0;
	for (size_t n = 0; n < 20; n++) {
		nt_trace trace = {0};
		fail_allocations_from(n);
		nt_trace_use(&trace);
		nt_trace_read("in", &info);
		nt_trace_use(NULL);
		stop_failing_allocations();
		assert_int_equal(trace.count, trace.failed ? 0 : 1);
		failures += trace.failed;
		nt_trace_free(&trace);
	}
	assert_true(failures > 0 && failures < 20);
}

AROUND_ALL(make_folder, remove_folder)

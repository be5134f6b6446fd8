/* SPDX-License-Identifier: MIT */
/*
 * Looking for files: what is missing, and what is a fault.
 */
#include "test.h"
#include <errno.h>
#include <unistd.h>
#include "file/lookup.h"
#include "file/trace.h"
#include "folder.h"

TEST(only_some_numbers_mean_missing)
{
	static const struct {
		int number;
		nt_status status;
	} rows[] = {{ENOENT, NT_ERROR_MISSING}, {ENOTDIR, NT_ERROR_MISSING}, {ENAMETOOLONG, NT_ERROR_MISSING},
		{EISDIR, NT_ERROR_MISSING}, {ENOMEM, NT_ERROR_MEMORY}, {EIO, NT_ERROR_IO}, {EACCES, NT_ERROR_IO},
		{ELOOP, NT_ERROR_IO}, {EMFILE, NT_ERROR_IO}, {ESTALE, NT_ERROR_IO}, {0, NT_ERROR_IO}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_error error;
		assert_int_equal(nt_lookup_failed("a/b", rows[i].number, &error), rows[i].status);
		assert_int_equal(error.status, rows[i].status);
		assert_string_equal(error.place.file, "a/b");
	}
}

TEST(files_are_found_or_missing_or_behind_a_fault)
{
	put_text_file("there", "x");
	assert_int_equal(symlink("loop", "loop"), 0);
	struct stat info;
	nt_error error;
	bool found;
	assert_int_equal(nt_lookup("there", &info, &error), NT_OK);
	assert_int_equal(info.st_size, 1);
	assert_int_equal(nt_lookup_found("there", &info, &found, &error), NT_OK);
	assert_true(found);
	assert_int_equal(nt_lookup("nowhere", &info, &error), NT_ERROR_MISSING);
	assert_int_equal(nt_lookup_found("there/below", &info, &found, &error), NT_OK);
	assert_false(found);
	assert_int_equal(nt_lookup_found("loop", &info, &found, &error), NT_ERROR_IO);
	assert_false(found);

	char *real;
	nt_error untouched = {.status = NT_OK};
	assert_int_equal(nt_lookup_found("nowhere", &info, &found, &untouched), NT_OK);
	assert_int_equal(untouched.status, NT_OK);
	assert_int_equal(nt_lookup_real("./there", &real, &error), NT_OK);
	assert_string_equal(strrchr(real, '/'), "/there");
	free(real);
	assert_int_equal(nt_lookup_real("nowhere", &real, &error), NT_ERROR_MISSING);
	assert_null(real);
	assert_int_equal(nt_lookup_real("loop", &real, &error), NT_ERROR_IO);
}

static void entry_is(const char *folder, const char *name, const char *expected)
{
	nt_error error;
	char *entry;
	nt_trace trace = {0};
	nt_trace *outer = nt_trace_use(&trace);
	assert_int_equal(nt_lookup_any_case(folder, name, strlen(name), &entry, &error), NT_OK);
	nt_trace_use(outer);
	if (expected)
		assert_string_equal(entry, expected);
	else
		assert_null(entry);
	assert_int_equal(trace.count, 1);
	assert_int_equal(trace.files[0].kind, NT_TRACE_SEARCHED);
	assert_int_equal(trace.files[0].inode != 0, strcmp(folder, "d") == 0);
	free(entry);
	nt_trace_free(&trace);
}

TEST(a_name_is_found_in_any_case_and_the_first_of_several)
{
	assert_int_equal(mkdir("d", 0700), 0);
	put_text_file("d/N.pNG", "");
	put_text_file("d/N.png", "");
	put_text_file("d/n.pn", "");
	entry_is("d", "n.png", "N.pNG");
	entry_is("d", "m.png", NULL);
	entry_is("nowhere", "n.png", NULL);
	entry_is("there", "n.png", NULL);
}

AROUND_ALL(enter_folder, leave_folder)

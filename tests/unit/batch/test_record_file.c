/* SPDX-License-Identifier: MIT */
/*
 * Lines with keys in a file, in a folder of our own.
 */
#include "batch/record_file.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

static const char prefix[] = "{\"k\":\"";

static void finds(const nt_record_file *file, const char *key, const char *expected)
{
	size_t length;
	const char *line = nt_record_file_find(file, key, &length);
	if (!expected) {
		assert_null(line);
		return;
	}
	assert_non_null(line);
	assert_int_equal(length, strlen(expected));
	assert_memory_equal(line, expected, length);
}

TEST(the_last_whole_line_of_a_key_counts)
{
	nt_record_file file;
	nt_error error;
	assert_int_equal(nt_record_file_open(&file, in_folder("none"), prefix, NULL, true, &error), NT_OK);
	finds(&file, "a", NULL);
	nt_record_file_close(&file);

	put_text_file("r",
		"{\"k\":\"a\",1}\n\nnonsense\n{\"k\":\"b\",2}\n{\"k\":\"a\",3}\n{\"k\":\"\",4}\n{\"k\":\"b\",5");
	assert_int_equal(nt_record_file_open(&file, in_folder("r"), prefix, NULL, true, &error), NT_OK);
	finds(&file, "a", "{\"k\":\"a\",3}");
	finds(&file, "b", "{\"k\":\"b\",2}");
	finds(&file, "", "{\"k\":\"\",4}");
	finds(&file, "c", NULL);
	assert_int_equal(file.superseded_count, 1);
	/* behind half a line */
	assert_int_equal(nt_record_file_append(&file, "{\"k\":\"c\"}\n", 10, &error), NT_OK);
	nt_record_file_close(&file);
	assert_int_equal(nt_record_file_open(&file, in_folder("r"), prefix, NULL, true, &error), NT_OK);
	finds(&file, "b", "{\"k\":\"b\",5");
	finds(&file, "c", "{\"k\":\"c\"}");
	nt_record_file_close(&file);
}

TEST(what_cannot_be_written_or_read_is_told)
{
	nt_record_file file;
	nt_error error;
	assert_int_equal(nt_record_file_open(&file, in_folder("no/r"), prefix, NULL, true, &error), NT_OK);
	assert_int_equal(nt_record_file_append(&file, "x\n", 2, &error), NT_ERROR_IO);
	assert_non_null(strstr(error.place.file, "no/r"));
	nt_record_file_close(&file);
	assert_int_equal(nt_record_file_open(&file, in_folder(""), prefix, NULL, true, &error), NT_ERROR_MISSING);
	nt_record_file_close(&file);
}

TEST(an_exhausted_memory_is_told)
{
	nt_error error;
	put_text_file("m", "{\"k\":\"a\",1}\n{\"k\":\"b\",2}\n");
	bool failed = true;
	for (size_t n = 0; failed; n++) {
		nt_record_file file;
		fail_allocations_from(n);
		const nt_status status = nt_record_file_open(&file, in_folder("m"), prefix, NULL, true, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		nt_record_file_close(&file);
		assert_true(n < 20);
	}
}

AROUND_ALL(make_folder, remove_folder)

/* SPDX-License-Identifier: MIT */
/*
 * A record's statement about an output, and when that no longer holds, in a fresh folder that is the current one.
 */
#include "batch/record.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* A file that changed long before now, so that its time tells. */
static void put_old_file(const char *name, const char *text)
{
	const struct timespec times[] = {{1000000000, 500}, {1000000000, 500}};
	put_text_file(name, text);
	assert_int_equal(utimensat(AT_FDCWD, name, times, 0), 0);
}

/* in/a.obj and a.png, without a.mtl, became out.glb. */
static void put_files(void)
{
	mkdir("in", 0700);
	unlink("in/a.mtl");
	put_old_file("in/a.obj", "mesh");
	put_old_file("in/a.png", "image");
	put_old_file("out.glb", "result");
}

static nt_making making_of(nt_update_by by)
{
	nt_making making = {.input = "in/a.obj", .output = "out.glb", .options = "--method=area", .by = by};
	assert_int_equal(stat(making.input, &making.input_info), 0);
	return making;
}

static void note(nt_trace *trace)
{
	struct stat info;
	nt_trace *outer = nt_trace_use(trace);
	for (size_t i = 0; i < 3; i++) {
		const char *name = ((const char *const[]){"in/a.obj", "in/a.png", "out.glb"})[i];
		assert_int_equal(stat(name, &info), 0);
		if (i < 2)
			nt_trace_read(name, &info);
		else
			nt_trace_written(name, NULL, &info);
	}
	nt_trace_missing("in/a.mtl");
	nt_trace_use(outer);
}

static void append(nt_update_by by)
{
	nt_record *record;
	nt_trace trace = {0};
	nt_buffer line = {0};
	nt_error error;
	unlink("record");
	const nt_making making = making_of(by);
	note(&trace);
	assert_int_equal(nt_record_open(&record, "record", true, &error), NT_OK);
	assert_int_equal(nt_record_append(record, &making, &trace, &line, &error), NT_OK);
	nt_record_placed(record, &making, &line, &trace);
	nt_record_close(record);
	nt_buffer_free(&line);
	nt_trace_free(&trace);
}

static nt_freshness look_for(const nt_making *making, nt_trace *trace)
{
	nt_record *record;
	nt_error error;
	nt_freshness freshness;
	assert_int_equal(nt_record_open(&record, "record", true, &error), NT_OK);
	assert_int_equal(nt_record_look(record, making, &freshness, trace, &error), NT_OK);
	nt_record_close(record);
	return freshness;
}

static nt_freshness look(nt_update_by by)
{
	const nt_making making = making_of(by);
	return look_for(&making, NULL);
}

TEST(an_output_is_current_while_all_is_as_it_was)
{
	nt_trace trace = {0};
	put_files();
	append(NT_UPDATE_BY_TIME);
	nt_making making = making_of(NT_UPDATE_BY_TIME);
	assert_int_equal(look_for(&making, &trace), NT_FRESH_CURRENT);
	assert_int_equal(trace.count, 4);
	assert_int_equal(trace.files[0].kind, NT_TRACE_READ);
	assert_int_equal(trace.files[0].size, 4);
	nt_trace_free(&trace);
	making.output = "other.glb";
	assert_int_equal(look_for(&making, NULL), NT_FRESH_UNKNOWN);
	making = making_of(NT_UPDATE_BY_TIME);
	making.options = "";
	assert_int_equal(look_for(&making, NULL), NT_FRESH_STALE);
}

TEST(any_file_that_differs_makes_it_stale)
{
	for (size_t i = 0; i < 3; i++) {
		const char *name = ((const char *const[]){"in/a.obj", "in/a.png", "out.glb"})[i];
		put_files();
		append(NT_UPDATE_BY_TIME);
		put_old_file(name, "another size");
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
		put_files();
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
		assert_int_equal(utimensat(AT_FDCWD, name, NULL, 0), 0);
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
		if (i == 0)
			continue; /* what cannot be looked at is no input */
		put_files();
		assert_int_equal(unlink(name), 0);
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
	}
	put_files();
	append(NT_UPDATE_BY_TIME);
	put_text_file("in/a.mtl", "it has come");
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
}

TEST(by_content_times_do_not_count)
{
	put_files();
	append(NT_UPDATE_BY_CONTENT);
	assert_int_equal(utimensat(AT_FDCWD, "in/a.png", NULL, 0), 0);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
	assert_int_equal(look(NT_UPDATE_BY_CONTENT), NT_FRESH_CURRENT);
	/* its new times are noted */
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
	put_old_file("in/a.png", "IMAGE");
	assert_int_equal(look(NT_UPDATE_BY_CONTENT), NT_FRESH_STALE);
}

TEST(what_changed_just_before_is_compared_by_content_too)
{
	/* an hour from now is just before, however long it takes to come to it */
	const struct timespec times[] = {{time(NULL) + 3600, 500}, {time(NULL) + 3600, 500}};
	put_files();
	assert_int_equal(utimensat(AT_FDCWD, "in/a.png", times, 0), 0);
	append(NT_UPDATE_BY_TIME);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
	put_text_file("in/a.png", "IMAGE");
	assert_int_equal(utimensat(AT_FDCWD, "in/a.png", times, 0), 0);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
}

/* Nothing that mv and cp -p can do is unseen; what they do to equal bytes is noted, and no bytes are read again. */
TEST(equal_sizes_and_times_are_not_equal_bytes)
{
	struct stat before, after;
	for (size_t i = 0; i < 3; i++) {
		const char *name = ((const char *const[]){"in/a.obj", "in/a.png", "out.glb"})[i];
		put_files();
		append(NT_UPDATE_BY_TIME);
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
		put_old_file("other", i == 0 ? "MESH" : i == 1 ? "IMAGE" : "RESULT");
		assert_int_equal(rename(name, "kept"), 0);
		assert_int_equal(rename("other", name), 0);
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
		put_files();
		put_old_file(name, i == 0 ? "MESH" : i == 1 ? "IMAGE" : "RESULT");
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
		put_files();
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
		assert_int_equal(stat("record", &before), 0);
		assert_int_equal(rename("kept", name), 0);
		assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
		assert_int_equal(stat("record", &after), 0);
		assert_true(after.st_size > before.st_size);
		/* what was noted just now may have changed unseen, at most once more */
		for (int k = 0; k < 20 && after.st_size != before.st_size; k++) {
			usleep(5000);
			before = after;
			assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
			assert_int_equal(stat("record", &after), 0);
		}
		assert_int_equal(after.st_size, before.st_size);
	}
}

/* in -> v1, whose a.png is missing; then v2. */
TEST(the_links_on_the_way_to_a_file_count)
{
	put_files();
	assert_int_equal(rename("in", "v1"), 0);
	assert_int_equal(symlink("v1", "in"), 0);
	append(NT_UPDATE_BY_TIME);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
	/* all that was read is there by its real name, in the state that it had */
	assert_int_equal(mkdir("v2", 0700), 0);
	assert_int_equal(link("v1/a.obj", "v2/a.obj"), 0);
	assert_int_equal(unlink("in"), 0);
	assert_int_equal(symlink("v2", "in"), 0);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
	assert_int_equal(unlink("in"), 0);
	assert_int_equal(symlink("v1", "in"), 0);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
	assert_int_equal(unlink("in"), 0);
	assert_int_equal(rename("v1", "in"), 0);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_STALE);
	assert_int_equal(unlink("v2/a.obj"), 0);
}

/* Lines as they were before they had a digest of themselves hold for nothing either. */
TEST(lines_that_are_damaged_hold_for_nothing)
{
	static const char *const parts[] = {"links", "uri", "a.obj", "sum"};
	for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
		char text[8192] = "";
		put_files();
		append(NT_UPDATE_BY_TIME);
		FILE *file = fopen("record", "r");
		assert_non_null(file);
		assert_true(fread(text, 1, sizeof text - 1, file) > 0);
		fclose(file);
		assert_non_null(strstr(text, parts[i]));
		for (char *key = text; (key = strstr(key, parts[i]));)
			*key = 'X';
		put_text_file("record", text);
		assert_true(look(NT_UPDATE_BY_TIME) != NT_FRESH_CURRENT);
	}
}

TEST(a_tree_can_be_moved_with_its_record)
{
	put_files();
	append(NT_UPDATE_BY_TIME);
	assert_int_equal(mkdir("moved", 0700), 0);
	assert_int_equal(rename("in", "moved/in"), 0);
	assert_int_equal(rename("out.glb", "moved/out.glb"), 0);
	assert_int_equal(rename("record", "moved/record"), 0);
	assert_int_equal(chdir("moved"), 0);
	assert_int_equal(look(NT_UPDATE_BY_TIME), NT_FRESH_CURRENT);
	assert_int_equal(chdir(".."), 0);
}

TEST(an_exhausted_memory_is_told)
{
	put_files();
	append(NT_UPDATE_BY_TIME);
	const nt_making making = making_of(NT_UPDATE_BY_TIME);
	nt_trace noted = {0};
	note(&noted);
	bool failed = true;
	for (size_t n = 0; failed; n++) {
		nt_record *record = NULL;
		nt_error error;
		nt_freshness freshness;
		nt_trace trace = {0};
		nt_buffer line = {0};
		fail_allocations_from(n);
		nt_status status = nt_record_open(&record, "record", true, &error);
		if (!status)
			status = nt_record_look(record, &making, &freshness, &trace, &error);
		if (!status)
			status = nt_record_append(record, &making, &noted, &line, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		nt_trace_free(&trace);
		nt_record_close(record);
		nt_buffer_free(&line);
		assert_true(n < 300);
	}
	nt_trace_free(&noted);
}

AROUND_EACH(enter_folder, leave_folder)

/* SPDX-License-Identifier: MIT */
/*
 * Deciding by records and times, in a fresh folder that is the current one. record.c has the contents of records.
 */
#include "batch/update.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static void put_at(const char *name, time_t seconds)
{
	const struct timespec times[] = {{seconds, 500}, {seconds, 500}};
	put_text_file(name, name);
	assert_int_equal(utimensat(AT_FDCWD, name, times, 0), 0);
}

/* The decision about a.obj and a.glb. `settings` may be changed; a trace of it is written to the record if
 * `make`. */
static bool is_current(const nt_update_options *options, nt_settings *settings, bool make)
{
	nt_update *update;
	nt_update_job job;
	nt_trace found = {0}, made = {0};
	nt_error error;
	struct stat info;
	bool current;
	assert_int_equal(nt_update_begin(&update, options, &error), NT_OK);
	assert_int_equal(nt_update_look(update, "a.obj", "a.glb", &job, settings, &current, &found, &error), NT_OK);
	assert_int_equal(current, found.count > 0);
	if (make) {
		nt_trace *outer = nt_trace_use(&made);
		assert_int_equal(stat("a.obj", &info), 0);
		nt_trace_read("a.obj", &info);
		assert_int_equal(stat("a.glb", &info), 0);
		nt_trace_written("a.glb", NULL, &info);
		nt_trace_use(outer);
		assert_int_equal(settings->placing(settings->placing_user, &made, &error), NT_OK);
	}
	nt_update_done(&job, make, &made);
	nt_trace_free(&found);
	nt_trace_free(&made);
	nt_update_end(update);
	return current;
}

static const nt_update_options usual = {.look = true, .options = ""};

TEST(without_a_record_nothing_is_current)
{
	nt_settings settings = {0};
	put_at("a.obj", 2000);
	assert_false(is_current(&usual, &settings, false));
	/* younger than its input, and made by who knows which options */
	put_at("a.glb", 3000);
	settings = (nt_settings){0};
	assert_false(is_current(&usual, &settings, false));
	/* an output with the bytes that it gets is touched, so that its time says that it is current */
	assert_int_equal(settings.equal, NT_EQUAL_TOUCH);
}

TEST(a_record_decides_where_it_knows_the_output)
{
	nt_settings settings = {0};
	put_at("a.obj", 2000);
	put_at("a.glb", 1000);
	assert_false(is_current(&usual, &settings, true));
	assert_int_equal(access(".nmtan-record", F_OK), 0);
	assert_true(is_current(&usual, &settings, false));
	nt_update_options other = usual;
	other.options = "--method=area";
	settings = (nt_settings){0};
	assert_false(is_current(&other, &settings, false));
	/* its bytes may be the same all the same, and then its time tells nobody anything */
	assert_int_equal(settings.equal, NT_EQUAL_KEEP);
	settings.equal = NT_EQUAL_TOUCH;
	assert_false(is_current(&other, &settings, false));
	assert_int_equal(settings.equal, NT_EQUAL_TOUCH);
}

TEST(a_record_can_be_written_without_being_asked)
{
	nt_settings settings = {0};
	nt_update_options only_written = usual;
	only_written.look = false;
	only_written.record = "r";
	put_at("a.obj", 2000);
	put_at("a.glb", 3000);
	assert_false(is_current(&only_written, &settings, true));
	assert_int_equal(settings.equal, NT_EQUAL_REPLACE);
	assert_false(is_current(&only_written, &settings, false));
	nt_update_options asked = only_written;
	asked.look = true;
	put_at("a.glb", 3000);
	assert_true(is_current(&asked, &settings, false));
	assert_int_equal(access(".nmtan-record", F_OK), -1);
}

TEST(streams_and_pipes_have_no_record)
{
	nt_update *update;
	nt_update_job job;
	nt_error error;
	nt_trace trace = {0};
	bool current;
	assert_int_equal(mkfifo("pipe.obj", 0600), 0);
	put_at("a.obj", 2000);
	assert_int_equal(nt_update_begin(&update, &usual, &error), NT_OK);
	const char *const pairs[][2] = {{"-", "a.glb"}, {"a.obj", "-"}, {"pipe.obj", "a.glb"},
		{"missing.obj", "a.glb"}};
	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		nt_settings settings = {0};
		assert_int_equal(nt_update_look(update, pairs[i][0], pairs[i][1], &job, &settings, &current,
			&trace, &error), NT_OK);
		assert_false(current);
		assert_null(settings.placing);
	}
	nt_update_end(update);
	nt_trace_free(&trace);
}

TEST(a_record_that_cannot_be_is_refused_before_anything_runs)
{
	nt_update *update;
	nt_error error;
	nt_update_options options = usual;
	options.record = "no/r";
	assert_int_equal(nt_update_begin(&update, &options, &error), NT_ERROR_MISSING);
	nt_update_end(update);
	nt_update_end(NULL);
}

TEST(an_exhausted_memory_is_told)
{
	nt_settings settings = {0};
	put_at("a.obj", 2000);
	put_at("a.glb", 3000);
	is_current(&usual, &settings, true);
	bool failed = true;
	for (size_t n = 0; failed; n++) {
		nt_update *update = NULL;
		nt_update_job job;
		nt_error error;
		nt_trace trace = {0};
		bool current = false;
		fail_allocations_from(n);
		nt_status status = nt_update_begin(&update, &usual, &error);
		if (!status)
			status = nt_update_look(update, "a.obj", "a.glb", &job, &settings, &current, &trace, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		assert_int_equal(current, !failed);
		nt_trace_free(&trace);
		nt_update_end(update);
		assert_true(n < 300);
	}
}

AROUND_EACH(enter_folder, leave_folder)

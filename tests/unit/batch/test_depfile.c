/* SPDX-License-Identifier: MIT */
/*
 * Rules as make's manual spells them; that make and Ninja read them so is tested in tests/cli/test_depfile.sh.
 */
#include "batch/depfile.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Read in this order; NULL ends them. Another was looked for in vain. */
static void make_trace(nt_trace *trace, const char *const *read)
{
	const struct stat info = {0};
	*trace = (nt_trace){0};
	nt_trace *outer = nt_trace_use(trace);
	for (; *read; read++)
		nt_trace_read(*read, &info);
	nt_trace_missing("missing.mtl");
	nt_trace_written("o.glb", NULL, &info);
	nt_trace_use(outer);
}

#define READ(...) ((const char *const[]){__VA_ARGS__, NULL})

/* The text of the rules of one output. */
static void becomes(const char *output, const char *const *read, const char *expected)
{
	nt_depfile depfile = {0};
	nt_trace trace;
	nt_error error;
	make_trace(&trace, read);
	assert_int_equal(nt_depfile_add(&depfile, output, &trace, &error), NT_OK);
	nt_buffer_append(&depfile.text, "", 1);
	assert_string_equal(depfile.text.data, expected);
	nt_depfile_free(&depfile);
	nt_trace_free(&trace);
}

TEST(an_output_depends_on_what_was_read_and_that_on_nothing)
{
	becomes("o.glb", READ("a.obj"), "o.glb: \\\n a.obj\n");
	becomes("o.glb", READ("a.obj", "a.mtl", "t/n.png"),
		"o.glb: \\\n a.obj \\\n a.mtl \\\n t/n.png\na.mtl:\nt/n.png:\n");
}

/* Not those that the run writes to, of which each run changes the time. */
TEST(folders_in_which_something_is_missing_are_named_once)
{
	nt_depfile depfile = {0};
	nt_trace trace;
	nt_error error;
	const struct stat info = {0};
	assert_int_equal(mkdir("t", 0700), 0);
	make_trace(&trace, READ("a.obj", "a.mtl"));
	nt_trace *outer = nt_trace_use(&trace);
	nt_trace_missing("t/none/below/n.png");
	nt_trace_searched("t/n.png", NULL, &info);
	nt_trace_missing("/none");
	nt_trace_use(outer);
	assert_int_equal(nt_depfile_add(&depfile, "o.glb", &trace, &error), NT_OK);
	nt_buffer_append(&depfile.text, "", 1);
	assert_int_equal(rmdir("t"), 0);
	assert_string_equal(depfile.text.data, "o.glb: \\\n a.obj \\\n a.mtl \\\n t \\\n /\na.mtl:\nt:\n/:\n");
	nt_depfile_free(&depfile);
	nt_trace_free(&trace);
}

TEST(names_are_escaped)
{
	becomes("o.glb", READ("a b.obj"), "o.glb: \\\n a\\ b.obj\n");
	becomes("o#.glb", READ("c:d.obj"), "o\\#.glb: \\\n c\\:d.obj\n");
	becomes("$o", READ("a\\b\\ c"), "$$o: \\\n a\\b\\\\\\ c\n");
	becomes("%o*", READ("\\"), "%o*: \\\n \\\n");
}

TEST(files_below_the_current_folder_are_named_as_the_output_is)
{
	char here[1024], inside[1100], expected[2300];
	assert_non_null(getcwd(here, sizeof here));
	snprintf(inside, sizeof inside, "%s/sub/a.obj", here);
	becomes("o.glb", READ(inside, "/elsewhere/b"), "o.glb: \\\n sub/a.obj \\\n /elsewhere/b\n/elsewhere/b:\n");
	snprintf(expected, sizeof expected, "/o.glb: \\\n %s\n", inside);
	becomes("/o.glb", READ(inside), expected);
}

TEST(a_line_feed_has_no_spelling)
{
	nt_depfile depfile = {0};
	nt_trace trace;
	nt_error error;
	make_trace(&trace, READ("a.obj", "b\n.mtl"));
	assert_int_equal(nt_depfile_add(&depfile, "o.glb", &trace, &error), NT_ERROR_UNSUPPORTED);
	assert_string_equal(error.place.file, "b\n.mtl");
	nt_depfile_free(&depfile);
	nt_trace_free(&trace);
}

TEST(it_is_written_whole_and_not_over_an_input)
{
	nt_depfile depfile = {0};
	nt_trace trace;
	nt_error error;
	char text[64] = "";
	make_trace(&trace, READ("a.obj"));
	put_text_file("a.obj", "mesh");
	const char *const inputs[] = {"a.obj"};
	assert_int_equal(nt_depfile_add(&depfile, "o.glb", &trace, &error), NT_OK);
	assert_int_equal(nt_depfile_write(&depfile, "a.obj", inputs, 1, &error), NT_ERROR_IO);
	assert_int_equal(nt_depfile_write(&depfile, "no/d", inputs, 1, &error), NT_ERROR_IO);
	assert_int_equal(nt_depfile_write(&depfile, "d", inputs, 1, &error), NT_OK);
	FILE *file = fopen("d", "r");
	assert_non_null(file);
	assert_int_equal(fread(text, 1, sizeof text - 1, file), 16);
	fclose(file);
	assert_string_equal(text, "o.glb: \\\n a.obj\n");
	assert_int_equal(count_in_folder(), 2);
	nt_depfile_free(&depfile);
	nt_trace_free(&trace);
}

TEST(an_exhausted_memory_is_told)
{
	nt_trace trace;
	make_trace(&trace, READ("a.obj", "/x/a.mtl"));
	bool failed = true;
	for (size_t n = 0; failed; n++) {
		nt_depfile depfile = {0};
		nt_error error;
		fail_allocations_from(n);
		const nt_status status = nt_depfile_add(&depfile, "o.glb", &trace, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		nt_depfile_free(&depfile);
		assert_true(n < 100);
	}
	nt_trace_free(&trace);
}

AROUND_ALL(enter_folder, leave_folder)

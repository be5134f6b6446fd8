/* SPDX-License-Identifier: MIT */
/*
 * Lines of jobs that are made by hand, in a fresh folder that is the current one. That they are valid is tested in
 * tests/cli/test_manifest.sh.
 */
#include "cli/manifest.h"
#include "fail_alloc.h"
#include "folder.h"
#include "nmtan.h"
#include "test.h"

#include <stdio.h>
#include <unistd.h>

/* Which files a job had to do with. */
static void note(nt_trace *trace)
{
	const struct stat info = {.st_size = 7};
	nt_trace *outer = nt_trace_use(trace);
	nt_trace_read("a\".obj", &info);
	nt_trace_missing("a.mtl");
	nt_trace_written("o\n.glb", NULL, &info);
	nt_trace_use(outer);
}

/* The file's text with what this job's line is made of. */
static const char *line_of(const nt_job *job, int exit_code)
{
	static char text[4096];
	nt_manifest manifest;
	nt_error error;
	assert_int_equal(nt_manifest_open(&manifest, "m", "--method=area", &error), NT_OK);
	nt_manifest_add(&manifest, job, exit_code);
	assert_int_equal(nt_manifest_close(&manifest, &error), NT_OK);
	FILE *file = fopen("m", "r");
	assert_non_null(file);
	text[fread(text, 1, sizeof text - 1, file)] = '\0';
	fclose(file);
	return text;
}

#define BEGIN(name, status, code) "{\"input\":\"" name "\",\"status\":\"" status "\",\"exit_code\":" #code \
	",\"nmtan\":\"" NMTAN_VERSION_STRING "\",\"options\":\"--method=area\","
#define FILES "\"outputs\":[{\"path\":\"o\\n.glb\",\"bytes\":7}]," \
	"\"dependencies\":[{\"path\":\"a\\\".obj\",\"bytes\":7}]," \
	"\"missing\":[\"a.mtl\"],\"searched\":[],\"missing_digest\":\"01da7a59925b528c\""
#define NO_FILES "\"outputs\":[],\"dependencies\":[],\"missing\":[],\"searched\":[]"

TEST(a_job_that_ran_has_its_files_and_numbers)
{
	nt_outcome outcome = {.summary = {.triangle_count = 8, .vertex_count = 12, .appended_normals = 1,
				      .appended_tangents = 2, .bytes_read = 100, .bytes_written = 200,
				      .total_seconds = 0.5}};
	nt_job job = {.input = "a\".obj", .outcome = &outcome, .end = NT_JOB_RAN};
	note(&outcome.summary.trace);
	const char *line = line_of(&job, 0);
	assert_memory_equal(line, BEGIN("a\\\".obj", "done", 0) FILES ",\"findings\":{},\"fixed\":{},\"triangles\":8",
		strlen(BEGIN("a\\\".obj", "done", 0) FILES ",\"findings\":{},\"fixed\":{},\"triangles\":8"));
	assert_non_null(strstr(line, ",\"vertices_before\":12,\"vertices_after\":15,\"split\":2,\"repaired\":0,"
				     "\"sorted_instead\":0,\"summed_instead\":0,\"bytes_read\":100,"
				     "\"bytes_written\":200,\"seconds\":{"));
	assert_non_null(strstr(line, "\"total\":0.500000}}\n"));
	outcome.summary.left = true;
	assert_non_null(strstr(line_of(&job, 6), "\"status\":\"left\",\"exit_code\":6,"));
	nt_trace_free(&outcome.summary.trace);
}

TEST(one_that_did_not_run_has_what_is_known)
{
	nt_outcome outcome = {0};
	note(&outcome.summary.trace);
	const nt_job current = {.input = "a", .outcome = &outcome, .end = NT_JOB_CURRENT};
	assert_string_equal(line_of(&current, 0), BEGIN("a", "up-to-date", 0) FILES "}\n");
	nt_trace_free(&outcome.summary.trace);
	const nt_job untried = {.input = "b", .end = NT_JOB_UNTRIED};
	assert_string_equal(line_of(&untried, 0), BEGIN("b", "untried", 0) NO_FILES "}\n");
	/* not even memory for its outcome */
	const nt_job exhausted = {.input = "c", .status = NT_ERROR_MEMORY, .end = NT_JOB_RAN};
	assert_string_equal(line_of(&exhausted, 4), BEGIN("c", "failed", 4) NO_FILES "}\n");
}

TEST(a_failure_has_its_place)
{
	nt_outcome outcome = {.error = {.status = NT_ERROR_INPUT, .message = "no \"v\"",
				      .place = {.file = "a.mtl", .line = 3, .offset = 0, .pointer = "/a",
				      	.object = "mesh"}}};
	const nt_job job = {.input = "a", .outcome = &outcome, .status = NT_ERROR_INPUT, .end = NT_JOB_RAN};
	assert_non_null(strstr(line_of(&job, 3),
		",\"error\":{\"message\":\"no \\\"v\\\"\",\"file\":\"a.mtl\",\"line\":3,"
						 "\"offset\":0,\"pointer\":\"/a\",\"object\":\"mesh\"}"));
	outcome.error = (nt_error){.status = NT_ERROR_INPUT, .message = "bad", .place = {.offset = NT_NO_OFFSET}};
	assert_non_null(strstr(line_of(&job, 3), ",\"error\":{\"message\":\"bad\"},"));
}

static void refuses(const char *path, nt_status expected)
{
	nt_manifest manifest;
	nt_error error;
	assert_int_equal(nt_manifest_open(&manifest, path, "", &error), expected);
	if (expected == NT_ERROR_IO)
		assert_string_equal(error.place.file, path);
	nt_manifest_close(&manifest, &error);
}

TEST(only_a_manifest_is_replaced)
{
	const nt_job job = {.input = "a.obj", .end = NT_JOB_UNTRIED};
	put_text_file("notes", "mine");
	refuses("notes", NT_ERROR_IO);
	refuses("no/m", NT_ERROR_IO);
	put_text_file("m", "{\"input\":\"earlier\"}\n");
	assert_null(strstr(line_of(&job, 0), "earlier"));
}

TEST(what_cannot_be_written_is_told_at_the_end)
{
	const nt_job job = {.input = "a", .end = NT_JOB_UNTRIED};
	nt_manifest manifest;
	nt_error error;
	assert_int_equal(nt_manifest_open(&manifest, "/dev/full", "", &error), NT_OK);
	nt_manifest_add(&manifest, &job, 0);
	nt_manifest_add(&manifest, &job, 0);
	assert_int_equal(nt_manifest_close(&manifest, &error), NT_ERROR_IO);
	assert_string_equal(error.place.file, "/dev/full");
}

/* Memory for most lines is there from the start, so that the failure itself can be told. */
TEST(a_line_needs_no_memory)
{
	const nt_job job = {.input = "a", .status = NT_ERROR_MEMORY, .end = NT_JOB_RAN};
	nt_manifest manifest;
	nt_error error;
	fail_allocations_from(0);
	assert_int_equal(nt_manifest_open(&manifest, "m", "", &error), NT_ERROR_MEMORY);
	stop_failing_allocations();
	nt_manifest_close(&manifest, &error);
	assert_int_equal(nt_manifest_open(&manifest, "m", "", &error), NT_OK);
	fail_allocations_from(0);
	nt_manifest_add(&manifest, &job, 4);
	assert_false(stop_failing_allocations());
	assert_int_equal(nt_manifest_close(&manifest, &error), NT_OK);
}

AROUND_ALL(enter_folder, leave_folder)

/* SPDX-License-Identifier: MIT */
#include "cli/say.h"
#include "cli/messages.h"
#include "test.h"

static const nt_style plain = {false, 0, true}, verbose = {false, 1, true}, coloured = {true, 0, true};

static void says(nt_buffer *out, const char *expected)
{
	assert_false(out->failed);
	assert_string_equal(out->data, expected);
	nt_buffer_free(out);
}

static void fails_with(nt_error *error, const char *file, nt_style style, const char *expected)
{
	nt_buffer out = {0};
	if (file)
		nt_error_in_file(error, file);
	nt_message_error(&out, error, style);
	says(&out, expected);
}

TEST(an_error_stands_behind_its_line_offset_or_pointer)
{
	nt_error error;
	nt_fail_line(&error, NT_ERROR_INPUT, 12, "vertex 9 of 8");
	fails_with(&error, "a.obj", plain, "nmtan: a.obj:12: vertex 9 of 8\n");
	nt_fail_offset(&error, NT_ERROR_INPUT, 0, "no magic");
	fails_with(&error, "a.glb", plain, "nmtan: a.glb: at byte 0: no magic\n");
	nt_fail_pointer(&error, NT_ERROR_INPUT, "/accessors/3/count", "is -1");
	fails_with(&error, "-", plain, "nmtan: standard input: /accessors/3/count: is -1\n");
	nt_fail_memory(&error);
	fails_with(&error, NULL, plain, "nmtan: out of memory\n");
	nt_fail(&error, NT_ERROR_USAGE, "bad");
	fails_with(&error, NULL, coloured, "\033[1;31mnmtan:\033[0m bad\n");
	/* text from files cannot steer the terminal */
	nt_fail(&error, NT_ERROR_INPUT, "found '%s'", "\033[2J\r\n\x7f\xc3\xa9");
	fails_with(&error, "a\tb", plain, "nmtan: a\\x09b: found '\\x1b[2J\\x0d\\x0a\\x7f\xc3\xa9'\n");
}

TEST(findings_come_worst_first_and_grouped)
{
	nt_finding_list findings = {0};
	nt_place place;
	nt_place_clear(&place);
	for (unsigned i = 0; i < 8; i++) {
		place.line = i + 1;
		nt_finding_add(&findings, NT_CODE_MATERIAL_UNKNOWN, &place, 1, "m%u", i);
		nt_finding_add(&findings, NT_CODE_NORMALS_MADE, &place, 1, "o%u", i);
	}
	static nt_report_options options; /* zeros: as the table says */
	nt_buffer out = {0};
	nt_message_findings(&out, &findings, NULL, &options, "a.obj", NULL, false, NT_SEVERITY_ERROR, plain);
	assert_says(out.data, PARTS("nmtan: a.obj:1: warning: ", "nmtan: a.obj:5: warning: ", "!a.obj:6:",
		"nmtan: warning: and 3 more [MATERIAL_UNKNOWN]", "!NORMALS_MADE"));
	nt_buffer_free(&out);

	nt_message_findings(&out, &findings, NULL, &options, "a.obj", NULL, true, NT_SEVERITY_ERROR, verbose);
	const char *warning = strstr(out.data, "a.obj:8: warning: ");
	const char *info = strstr(out.data, "a.obj:1: info: ");
	assert_true(warning && info && warning < info);
	assert_null(strstr(out.data, "more"));
	nt_buffer_free(&out);

	/* severities are those that the user says */
	options.severity[NT_CODE_MATERIAL_UNKNOWN] = 1 + NT_SEVERITY_INFO;
	options.severity[NT_CODE_NORMALS_MADE] = 1 + NT_SEVERITY_WARNING;
	nt_message_findings(&out, &findings, NULL, &options, "a.obj", NULL, false, NT_SEVERITY_ERROR, plain);
	assert_says(out.data, PARTS("a.obj:1: warning: ", "NORMALS_MADE", "!MATERIAL_UNKNOWN"));
	nt_buffer_free(&out);
	nt_finding_list_free(&findings);
}

TEST(success_is_one_line_that_accounts_for_everything)
{
	nt_buffer out = {0};
	nt_settings settings = {0};
	char output[] = "b.glb";
	nt_outcome outcome = {0};
	nt_summary *summary = &outcome.summary;
	nt_job job = {.input = "a.obj", .output = output, .outcome = &outcome};
	*summary = (nt_summary){.mesh_count = 3, .solved_count = 2, .triangle_count = 12,
		.vertex_count = 20, .appended_tangents = 4, .appended_normals = 1, .total_seconds = 0.25};
	summary->skipped[NT_SKIP_NO_TEXCOORDS] = 1;
	nt_message_success(&out, &job, &settings);
	char expected[256];
	snprintf(expected, sizeof expected,
		"nmtan: a.obj -> b.glb: 2 of 3 primitives, 12 triangles, 20 -> 25 vertices "
		"(+4 where tangents differ, +1 where made normals differ), skipped 1 (%s), 250 ms\n",
		nt_decision_text(NT_SKIP_NO_TEXCOORDS));
	says(&out, expected);

	char stream[] = "-";
	job = (nt_job){.input = "-", .output = stream, .outcome = &outcome};
	*summary = (nt_summary){.mesh_count = 1, .solved_count = 1, .triangle_count = 1, .vertex_count = 3};
	nt_message_success(&out, &job, &settings);
	says(&out, "nmtan: standard input -> standard output: 1 primitive, 1 triangle, 3 vertices, 0.1 ms\n");

	/* every primitive is judged, whichever would get tangents */
	job = (nt_job){.input = "a.obj", .outcome = &outcome};
	*summary = (nt_summary){.mesh_count = 3, .solved_count = 1, .triangle_count = 1,
		.vertex_count = 3, .repaired = 3};
	summary->skipped[NT_SKIP_NO_TEXCOORDS] = 2;
	settings.check = true;
	nt_message_success(&out, &job, &settings);
	says(&out, "nmtan: a.obj: checked, 3 primitives, would repair the tangents of 3 corners, "
		"no findings, 0.1 ms\n");
}

TEST(times_are_numbers_for_people)
{
	static const struct {
		double seconds;
		const char *shown;
	} rows[] = {{0, "0.1 ms"}, {7.41e-05, "0.1 ms"}, {0.00164, "1.6 ms"}, {0.09994, "99.9 ms"},
		{0.09996, "100 ms"},
		{0.9994, "999 ms"}, {0.9996, "1.00 s"}, {9.994, "9.99 s"}, {12.34, "12.3 s"}, {1234.5, "1234 s"}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_buffer out = {0};
		nt_settings settings = {.check = true};
		nt_outcome outcome = {.summary = {.mesh_count = 1, .total_seconds = rows[i].seconds}};
		const nt_job job = {.input = "a.obj", .outcome = &outcome};
		char expected[128];
		nt_message_success(&out, &job, &settings);
		snprintf(expected, sizeof expected, "nmtan: a.obj: checked, 1 primitive, no findings, %s\n",
			rows[i].shown);
		says(&out, expected);
	}
}

TEST(a_list_has_a_line_for_each_mesh)
{
	nt_buffer out = {0};
	nt_mesh_line lines[] = {
		{.decision = NT_DECISION_SOLVE, .triangle_count = 4, .vertex_count = 6, .appended = 2},
		{.decision = NT_SKIP_NO_SLOT, .triangle_count = 1},
		{.decision = NT_DECISION_SOLVE, .same = true, .triangle_count = 4, .vertex_count = 6},
	};
	for (size_t i = 0; i < 3; i++)
		nt_place_clear(&lines[i].place);
	strcpy(lines[1].place.pointer, "/meshes/0/primitives/1");
	strcpy(lines[1].place.object, "mesh \"head\", primitive 1");
	nt_outcome outcome = {.summary = {.lines = lines, .line_count = 3}};
	const nt_job job = {.input = "a.glb", .outcome = &outcome};
	nt_message_meshes(&out, &job);
	says(&out, "nmtan: a.glb: tangents are computed, 4 triangles, 6 -> 8 vertices\n"
		   "nmtan: a.glb: /meshes/0/primitives/1: mesh \"head\", primitive 1: skipped (no material of "
		   "it uses tangents), 1 triangle\n"
		   "nmtan: a.glb: tangents are computed (the same as an earlier one's), 4 triangles, 6 vertices\n");
}

TEST(timing_names_every_stage)
{
	nt_buffer out = {0};
	nt_summary summary = {.total_seconds = 2, .bytes_read = 5000000000u};
	summary.seconds[NT_STAGE_PARSE] = 1.5;
	nt_message_timing(&out, &summary);
	for (int stage = 0; stage < NT_STAGE_COUNT; stage++)
		assert_non_null(strstr(out.data, nt_stage_name((nt_stage)stage)));
	assert_says(out.data, PARTS("parse     1500.000\n", "other      500.000\n",
		"5000000000 bytes read, 0 bytes written"));
	nt_buffer_free(&out);
	summary.bytes_copied = 7;
	nt_message_timing(&out, &summary);
	assert_non_null(strstr(out.data, "5000000000 bytes read, 7 copied as they are, 0 bytes written"));
	nt_buffer_free(&out);
}

TEST(of_many_exit_codes_the_worst_counts)
{
	/* The order of the issue. */
	static const int order[] = {4, 2, 3, 5, 6, 0};
	for (unsigned i = 0; i < 6; i++)
		for (unsigned k = i; k < 6; k++) {
			assert_int_equal(nt_exit_worse(order[i], order[k]), order[i]);
			assert_int_equal(nt_exit_worse(order[k], order[i]), order[i]);
		}
	assert_int_equal(nt_exit_worse(1, 0), 1);
	static const struct {
		nt_status status;
		int code;
	} rows[] = {{NT_OK, 0}, {NT_ERROR_USAGE, 1}, {NT_ERROR_IO, 2}, {NT_ERROR_INPUT, 3}, {NT_ERROR_MEMORY, 4},
		{NT_ERROR_INTERNAL, 4}, {NT_ERROR_UNSUPPORTED, 5}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		assert_int_equal(nt_exit_code(rows[i].status), rows[i].code);
}

/* SPDX-License-Identifier: MIT */
#include "cli/messages.h"
#include "test.h"


static void says(nt_buffer *out, const char *expected)
{
	assert_false(out->failed);
	assert_string_equal(out->data, expected);
	nt_buffer_free(out);
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
		snprintf(expected, sizeof expected, "nmtan: a.obj: checked, 1 mesh, no findings, %s\n",
			rows[i].shown);
		says(&out, expected);
	}
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

/* SPDX-License-Identifier: MIT */
/*
 * Reports to files: see report_file.h. A report is written as any output is, to a temporary file that takes
 * its name at the end, and never over an input.
 */
#include "pipeline/report_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include "base/buffer.h"
#include "file/output.h"

static nt_status to_sink(void *user, const void *bytes, size_t size, nt_error *error)
{
	return nt_sink_write(user, bytes, size, error);
}

static nt_status write_set(const nt_report *const *reports, size_t count,
	const nt_report_target *target, nt_error *error)
{
	const nt_output_options options = {.no_clobber = target->no_clobber};
	nt_output *output = NULL;
	nt_sink *sink = NULL;
	nt_status status = nt_output_create(&output, &options, error);
	if (status)
		return status;
	for (size_t i = 0; i < target->input_count && !status; i++)
		status = nt_output_protect(output, target->inputs[i], NULL, error);
	if (!status)
		status = nt_output_add(output, target->path, NT_ROLE_MAIN, &sink, error);
	const nt_report_list what = {.items = reports, .count = count, .style = target->style, .diff = target->diff,
		.rows = target->rows};
	if (!status)
		status = target->text ? nt_sink_write(sink, target->text, strlen(target->text), error)
				      : nt_report_write(&what, target->format, to_sink, sink, error);
	if (status) {
		nt_output_abort(output);
		return status;
	}
	return nt_output_commit(output, error);
}

nt_status nt_report_to_file(nt_report *const *reports, size_t count, const nt_report_target *target,
	nt_error *error)
{
	const nt_report **made = nt_alloc(count, sizeof(const nt_report *));
	if (!made)
		return nt_fail_memory(error);
	size_t made_count = 0;
	for (size_t i = 0; i < count; i++)
		if (reports[i])
			made[made_count++] = reports[i];
	const nt_status status = write_set(made, made_count, target, error);
	free(made);
	return status;
}

nt_status nt_baseline_open(nt_baseline *baseline, const char *path, nt_error *error)
{
	nt_file file;
	nt_status status = nt_file_open(&file, path, error);
	if (status)
		return status;
	status = nt_baseline_read(baseline, (const char *)file.data, file.size, error);
	nt_file_close(&file);
	return status ? nt_error_in_file(error, path) : NT_OK;
}

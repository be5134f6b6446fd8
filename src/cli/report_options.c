/* SPDX-License-Identifier: MIT */
/*
 * Words to report options: see options.h.
 */
#include "cli/options.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "file/output.h"
#include "file/path.h"

/* Takes the next word of a list separated by commas; false at its end. */
static bool next_word(const char **list, char *word, size_t size)
{
	if (!*list || !**list)
		return false;
	const size_t length = strcspn(*list, ",");
	snprintf(word, size, "%.*s", (int)(length < size ? length : size - 1), *list);
	*list += length;
	*list += **list == ',';
	return true;
}

static nt_status read_severities(nt_report_options *options, const char *list, nt_error *error)
{
	char word[128];
	while (next_word(&list, word, sizeof word)) {
		char *level = strchr(word, '=');
		bool chosen[NT_CODE_COUNT] = {false};
		nt_severity severity = NT_SEVERITY_INFO;
		if (!level)
			return nt_fail(error, NT_ERROR_USAGE, "--severity: '%s' is not CODE=LEVEL", word);
		*level++ = '\0';
		if (nt_match_codes("severity", word, chosen, error))
			return error->status;
		const bool off = strcmp(level, "off") == 0;
		if (!off && !nt_severity_find(level, &severity))
			return nt_fail(error, NT_ERROR_USAGE,
				"--severity: '%s' is none of: error warning info off", level);
		for (size_t code = 0; code < NT_CODE_COUNT; code++) {
			if (!chosen[code])
				continue;
			options->ignore[code] = off;
			options->severity[code] = (uint8_t)(1 + severity);
		}
	}
	return NT_OK;
}

/* The nt_severity that a word means. */
static const int least_severity[] = {[NT_FAIL_ON_ERROR] = NT_SEVERITY_ERROR, [NT_FAIL_ON_WARNING] = NT_SEVERITY_WARNING,
	[NT_FAIL_ON_INFO] = NT_SEVERITY_INFO, [NT_FAIL_ON_NEVER] = NT_SEVERITY_ERROR + 1};

static nt_status choose_target(nt_report_plan *plan, const nt_command *c, bool colour,
	nt_error *error)
{
	nt_report_target *target = &plan->target;
	target->no_clobber = c->settings.no_clobber;
	target->inputs = c->operands;
	target->input_count = nt_command_is_many(c) ? c->operand_count : 1;
	target->path = c->report;
	/* what fails a run fails its tests */
	target->style.least_failure = least_severity[c->fail_on];
	/* who names a format wants to see it */
	if (!target->path && c->settings.check && (c->verbosity >= 0 || c->report_format))
		target->path = "-";
	if (!target->path)
		return NT_OK;
	const bool dash = strcmp(target->path, "-") == 0;
	struct stat info;
	target->folder = c->report && !dash && ((*c->report && c->report[strlen(c->report) - 1] == '/') ||
		(stat(c->report, &info) == 0 && S_ISDIR(info.st_mode)));
	if (target->folder && c->report_format && c->report_format - 1 != NT_REPORT_HTML)
		return nt_fail(error, NT_ERROR_USAGE,
			"a report in a folder is HTML; for another format, --report names a file");
	if (target->folder)
		target->format = NT_REPORT_HTML;
	else if (c->report_format)
		target->format = (nt_report_format)(c->report_format - 1);
	else if (dash || !c->report)
		target->format = NT_REPORT_TEXT;
	else if (!nt_report_format_of_path(target->path, &target->format))
		return nt_fail(error, NT_ERROR_USAGE,
			"cannot tell the report's format from the name '%s': use --report-format, or an ending: .txt "
			".json .sarif .xml .csv .md .html, or a slash for a folder of pages",
			target->path);
	if (c->diff && (target->folder || !nt_diff_has_format(target->format)))
		return nt_fail(error, NT_ERROR_USAGE, "--diff is written to one file, as text, JSON, Markdown or HTML");
	target->style.colour = dash && colour;
	return NT_OK;
}

/* Standard output holds one thing only. */
static nt_status check_outputs(const nt_command *c, nt_error *error)
{
	const bool mesh_on_stdout = !c->settings.check && !c->directory && c->operand_count == 2 &&
		strcmp(c->operands[1], "-") == 0;
	const bool manifest_on_stdout = c->manifest && strcmp(c->manifest, "-") == 0;
	if (manifest_on_stdout && mesh_on_stdout)
		return nt_fail(error, NT_ERROR_USAGE, "the mesh and the manifest cannot both go to standard output");
	if (mesh_on_stdout && c->report && strcmp(c->report, "-") == 0)
		return nt_fail(error, NT_ERROR_USAGE,
			"the mesh and the report cannot both go to standard output");
	const bool judged = c->report || c->settings.check;
	if (!judged && (c->report_format || c->max_issues >= 0))
		return nt_fail(error, NT_ERROR_USAGE, "--%s needs --report or --check",
			c->report_format ? "report-format" : "max-issues");
	if (!judged && c->path_prefix)
		return nt_fail(error, NT_ERROR_USAGE, "--path-prefix needs --report or --check");
	if (!judged && (c->baseline || c->min_severity != NT_FAIL_ON_INFO) && c->fail_on == NT_FAIL_ON_NEVER)
		return nt_fail(error, NT_ERROR_USAGE, "--%s needs --report, --check or --fail-on",
			c->baseline ? "baseline" : "min-severity");
	return NT_OK;
}

static nt_status check_diff(const nt_command *c, nt_error *error)
{
	if (!c->diff)
		return NT_OK;
	if (c->operand_count != 2)
		return nt_fail(error, NT_ERROR_USAGE, "--diff compares two files, an old one and a new one");
	if (c->baseline || c->max_issues >= 0)
		return nt_fail(error, NT_ERROR_USAGE, "--%s and --diff exclude each other",
			c->baseline ? "baseline" : "max-issues");
	return NT_OK;
}

/* With the command that makes one, if its folder is there. */
static void tell_no_baseline(const char *path, nt_error *error)
{
	nt_buffer word = {0};
	nt_report_format format;
	const bool named = nt_report_format_of_path(path, &format) && format == NT_REPORT_JSON;
	nt_shell_word(path, &word);
	const char *option = named ? "" : "--report-format=json ";
	nt_error folder;
	if (nt_output_check_folder(path, &folder) == NT_OK)
		nt_fail(error, NT_ERROR_MISSING, "--baseline: there is no file '%s'; to make it: "
			"nmtan --check %s--report=%s INPUT...", path, option, word.data ? word.data : "FILE");
	else
		nt_fail(error, NT_ERROR_MISSING, "--baseline: there is no file '%s', and no folder for it", path);
	nt_buffer_free(&word);
}

nt_status nt_report_plan_make(nt_report_plan *plan, const nt_command *command, bool colour,
	nt_error *error)
{
	enum { MOST_READ = 10 };
	*plan = (nt_report_plan){
		.wanted = command->settings.check || command->report || command->ignore.count ||
			command->severity.count || command->fail_on != NT_FAIL_ON_NEVER};
	plan->options.min_severity = (nt_severity)least_severity[command->min_severity];
	nt_status status = check_outputs(command, error);
	if (command->settings.check && command->settings.converts) {
		nt_options_shaping(command, true, &plan->conversion);
		plan->options.conversion = plan->conversion.size ? plan->conversion.data : "";
	}
	nt_options_given(command, &plan->given);
	plan->options.given = plan->given.data;
	plan->options.in_place = command->settings.in_place;
	if (!status)
		status = check_diff(command, error);
	for (size_t i = 0; i < command->severity.count && !status; i++)
		status = read_severities(&plan->options, command->severity.items[i], error);
	/* last: a later level does not bring back what is ignored */
	for (size_t i = 0; i < command->ignore.count && !status; i++)
		status = nt_match_codes("ignore", command->ignore.items[i], plan->options.ignore, error);
	if (!status)
		status = choose_target(plan, command, colour, error);
	/* people read a few findings; programs, and pages that unfold, take all */
	const nt_report_target *target = &plan->target;
	const bool read = target->format == NT_REPORT_TEXT || target->format == NT_REPORT_MARKDOWN;
	plan->options.max_findings = command->max_issues >= 0 ? (size_t)command->max_issues
		: target->path && read && !command->diff ? MOST_READ : 0;
	if (!status && plan->wanted) {
		status = nt_shown_paths_begin(&plan->paths, command->operands, target->input_count,
			command->path_prefix, error);
		plan->options.paths = status ? NULL : &plan->paths;
		if (status != NT_ERROR_MEMORY)
			status = NT_OK; /* where the run's folder has no name, files are called as they were given */
	}
	if (!status && command->baseline) {
		status = nt_baseline_open(&plan->baseline, command->baseline, error);
		if (status == NT_ERROR_MISSING && access(command->baseline, F_OK) != 0)
			tell_no_baseline(command->baseline, error);
		plan->options.baseline = &plan->baseline;
	}
	const bool page_wanted = target->path && target->format == NT_REPORT_HTML;
	if (!status && page_wanted && strcmp(target->path, "-") != 0) {
		nt_buffer page = {0};
		nt_buffer_text(&page, target->path);
		while (target->folder && page.size > 1 && page.data[page.size - 1] == '/')
			page.size--;
		nt_buffer_text(&page, target->folder ? "/page" : "");
		status = page.failed ? nt_fail_memory(error) : nt_link_folder(&plan->folder, page.data, error);
		plan->options.page_folder = plan->folder.data;
		nt_buffer_free(&page);
	}
	plan->options.measures = target->path && target->format == NT_REPORT_JSON && !command->diff;
	plan->options.keep_geometry = command->diff || page_wanted;
	plan->options.keep_frames = page_wanted && !command->diff;
	return status;
}

void nt_report_plan_free(nt_report_plan *plan)
{
	nt_baseline_free(&plan->baseline);
	nt_shown_paths_free(&plan->paths);
	nt_buffer_free(&plan->conversion);
	nt_buffer_free(&plan->given);
	nt_buffer_free(&plan->folder);
}

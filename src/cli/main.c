/* SPDX-License-Identifier: MIT */
/*
 * nmtan, the command: words become options, and these inputs and jobs, which session.c runs; or a text that is printed.
 */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/text.h"
#include "batch/batch.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "cli/session.h"
#include "ext/linked.h"
#include "ext/module.h"
#include "file/input.h"
#include "file/output.h"
#include "file/path.h"
#include "report/report.h"

static void say_usage(const nt_error *error, nt_style style)
{
	nt_buffer text = {0};
	nt_say_error(error, style);
	nt_options_usage(&text);
	if (!text.failed)
		nt_say(&text);
	nt_buffer_free(&text);
}

/* Prints and frees what was asked for; that it arrived is part of the success. */
static int print_text(nt_buffer *text, nt_style style)
{
	nt_error error;
	const bool made = !text->failed;
	const bool written = made && fwrite(text->data, 1, text->size, stdout) == text->size && fflush(stdout) == 0;
	const int number = errno;
	nt_buffer_free(text);
	if (!written && nt_reader_is_gone())
		nt_end_unread();
	if (written)
		return NT_EXIT_DONE;
	if (made)
		nt_fail(&error, NT_ERROR_IO, "cannot write to standard output: %s", strerror(number));
	else
		nt_fail_memory(&error);
	nt_say_error(&error, style);
	return nt_exit_code(error.status);
}

static void libraries_text(nt_buffer *out)
{
	size_t count;
	const nt_linked_library *linked = nt_linked_libraries(&count);
	nt_buffer_format(out, "nmtan %s, MIT\n", nmtan_version());
	for (size_t i = 0; i < count; i++)
		nt_buffer_format(out, "linked: %s%s%s, %s\n", linked[i].name, linked[i].version ? " " : "",
			linked[i].version ? linked[i].version : "", linked[i].licence);
	for (int module = 0; module < NT_MODULE_COUNT; module++) {
		char line[1000];
		nt_module_describe((nt_module)module, line, sizeof line);
		nt_buffer_format(out, "%s\n", line);
	}
}

static nt_status prepare_jobs(nt_batch *batch, const nt_command *c, nt_error *error)
{
	if (c->settings.check && c->output)
		return nt_batch_pair(batch, c->operands[0], c->output, error);
	if (c->settings.check && !c->directory && !c->settings.in_place)
		return nt_batch_check(batch, c->operands, c->operand_count, error);
	if (c->directory)
		return nt_batch_into(batch, c->operands, c->operand_count, c->directory, c->keep_tree, &c->settings,
			error);
	const char *input = c->operands[0], *output = c->operands[c->operand_count - 1];
	/* the same file twice says the same thing */
	struct stat first, second;
	const bool twice = c->operand_count == 2 && (strcmp(input, output) == 0 || (stat(input, &first) == 0 &&
		stat(output, &second) == 0 && nt_same_file(&first, &second)));
	if (c->settings.in_place && !twice)
		return nt_batch_in_place(batch, c->operands, c->operand_count, error);
	if (strcmp(output, "-") == 0 && !c->settings.dry_run && isatty(STDOUT_FILENO))
		return nt_fail(error, NT_ERROR_USAGE,
			"'-' is a terminal here: send the output to a file or a pipe");
	return nt_batch_pair(batch, input, output, error);
}

/* roots: of the operands; NULL: they were named one by one. */
static nt_status prepare(nt_batch *batch, const nt_command *c, const char *const *roots, nt_error *error)
{
	const nt_status status = prepare_jobs(batch, c, error);
	for (size_t i = 0; i < batch->count; i++)
		batch->jobs[i].root = c->keep_tree ? c->keep_tree : roots ? roots[i] : NULL;
	return status;
}

/* The names of many inputs become the command's operands. */
static nt_status choose_inputs(nt_command *c, nt_inputs *inputs, nt_style style, nt_error *error)
{
	const nt_folder_rules rules = {.recursive = c->recursive, .include = c->include.items,
		.include_count = c->include.count, .exclude = c->exclude.items, .exclude_count = c->exclude.count,
		.leave_out = c->directory};
	nt_status status = NT_OK;
	if (!nt_command_is_many(c))
		return NT_OK;
	for (size_t i = 0; i < c->operand_count && !status; i++)
		status = nt_inputs_add(inputs, c->operands[i], &rules, error);
	if (!status && c->files_from)
		status = nt_inputs_add_list(inputs, c->files_from, c->settings.max_seconds, &rules, error);
	if (!status && (c->directory || c->settings.in_place))
		status = nt_inputs_drop_repeated(inputs, error);
	/* a folder in which nothing is found was named by mistake; a list that selects nothing is an answer */
	if (!status && !inputs->count && inputs->nothing.status) {
		*error = inputs->nothing;
		status = error->status;
	} else if (!status && (inputs->nothing.status || !inputs->count) && c->verbosity >= 0) {
		nt_error warning;
		const bool list = !inputs->count;
		nt_fail_file(&warning, NT_ERROR_IO, list ? c->files_from : inputs->nothing.place.file, "warning: %s",
			list ? "there are no names in it, and nothing to do" : inputs->nothing.message);
		nt_say_error(&warning, style);
	}
	c->operands = inputs->names;
	c->operand_count = inputs->count;
	return status;
}

static int run(nt_command *command, nt_style style, bool colour_on_stdout)
{
	nt_inputs inputs = {0};
	nt_batch batch = {0};
	nt_report_plan plan = {0};
	nt_report_folder folder = {0};
	nt_error error;
	nt_status status = nt_own_files_check(command, NULL, false, &error);
	if (!status)
		status = choose_inputs(command, &inputs, style, &error);
	const bool none = status && inputs.nothing.status && !inputs.count;
	if (!status)
		status = nt_report_plan_make(&plan, command, colour_on_stdout, &error);
	if (!status)
		status = prepare(&batch, command, inputs.roots, &error);
	if (!status)
		status = nt_own_files_check(command, &batch, plan.target.folder, &error);
	if (!status && plan.target.folder)
		status = nt_report_folder_begin(&folder, &plan.target, &error);
	int code = nt_exit_code(status);
	if (status == NT_ERROR_USAGE)
		say_usage(&error, style);
	else if (status)
		nt_say_error(&error, style);
	else
		code = nt_session_run(command, style, &plan, &batch, plan.target.folder ? &folder : NULL);
	if (none)
		nt_session_tell_left_over(command, style, &plan);
	nt_report_folder_free(&folder);
	nt_batch_free(&batch);
	nt_report_plan_free(&plan);
	nt_inputs_free(&inputs);
	return code;
}

/* In a signal handler, so that what must not reach a terminal is a question mark. */
static void end_changed(const char *path, const char *change)
{
	const char *const parts[] = {"nmtan: ", path, ": ", change};
	char line[1024];
	size_t size = 0;
	for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
		for (const char *c = parts[i]; *c && size < sizeof line - 1; c++)
			line[size++] = *c;
	line[size] = 0;
	nt_utf8_mask(line);
	line[size++] = '\n';
	const ssize_t written = write(STDERR_FILENO, line, size);
	(void)written;
	_exit(NT_EXIT_IO);
}

int main(int argc, char **argv)
{
	/* A standard stream that the caller closed must not become an output file, into which messages would go.
	 * Reading and writing fails on what stands in for the first two; messages may vanish. */
	static const int flags[] = {O_WRONLY, O_RDONLY, O_WRONLY};
	for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
		if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", flags[fd]) < 0)
			break;
	/* A reader that goes away, or a file beyond the limit, is an error of writing like any other, after
	 * which temporary files are removed. */
	signal(SIGPIPE, SIG_IGN);
	signal(SIGXFSZ, SIG_IGN);
	nt_temporaries_catch_signals(nt_session_tell_interrupted);
	nt_output_catch_exhaustion(nt_session_end_exhausted);
	nt_output_catch_faults(end_changed);

	nt_command command;
	nt_error error;
	const char *no_color = getenv("NO_COLOR");
	const bool may_colour = !(no_color && *no_color);
	nt_style style = {.colour = may_colour && isatty(STDERR_FILENO)};
	if (nt_options_parse(argc, argv, &command, &error)) {
		say_usage(&error, style);
		return NT_EXIT_USAGE;
	}
	style.verbosity = command.verbosity;
	nt_buffer text = {0};
	switch (command.action) {
	case NT_ACTION_HELP:
		nt_options_help(&text);
		break;
	case NT_ACTION_FIRST_HELP:
		nt_options_first_help(&text);
		break;
	case NT_ACTION_VERSION:
		if (style.verbosity > 0)
			libraries_text(&text);
		else
			nt_buffer_format(&text, "nmtan %s\n", nmtan_version());
		break;
	case NT_ACTION_LIST_CODES:
		nt_codes_list(&text);
		break;
	case NT_ACTION_EXPLAIN:
		nt_options_explain(&command, &text);
		break;
	case NT_ACTION_COMPLETION_BASH:
		nt_options_bash(&text);
		break;
	case NT_ACTION_COMPLETION_ZSH:
		nt_options_zsh(&text);
		break;
	default:
		return run(&command, style, may_colour && isatty(STDOUT_FILENO));
	}
	return print_text(&text, style);
}

/* SPDX-License-Identifier: MIT */
/*
 * Tells what became of a run's jobs: see session.h. Sums are over jobs that have ended; their messages come in the
 * order of the jobs, each in one piece. The last words, from signal handlers and where memory is exhausted, are at the
 * end.
 */
#include "cli/session.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include "base/parallel.h"
#include "base/text.h"
#include "batch/batch.h"
#include "cli/messages.h"
#include "cli/options.h"

/* Sums over the jobs that have ended. */
typedef struct session {
	const nt_command *command;
	const nt_report_plan *plan;
	nt_report **reports; /* [of the batch] taken from the jobs */
	size_t report_count;
	nt_report_folder *folder; /* of reports; NULL: they are one file, or none */
	size_t told; /* jobs */
	nt_style style;
	nt_progress *progress;
	nt_buffer text;   /* what is being said */
	nt_buffer shaping, recorded, judging; /* the options on which outputs and severities of findings depend */
	nt_update *update; /* NULL: no records */
	nt_depfile depfile;
	bool no_depfile; /* a rule is missing in it */
	bool unread;     /* who reads standard output has gone */
	bool no_report;  /* it would replace a file of a job, or say nothing of one for want of memory */
	nt_manifest manifest;
	nt_summary total; /* of the times and sizes alone */
	nt_failures failures;
	size_t count, current, untried, failing; /* jobs: all, up to date, not tried; with findings that fail */
	/* outputs: left because they had these bytes; with new tangents; of glTF and PLY, unchanged; others; and of all
	 * of them, with wrong tangents that were kept */
	size_t left, solved, unchanged, without, wrong;
	int exit_code;
} session;

/* Counts that a signal handler prints for a run of many. */
static struct {
	atomic_size_t count, ended, failed; /* jobs */
	bool erases;                        /* a line of progress */
} in_work;

/* The run allocates the usual memory of its messages first: none fails because that took all memory. */
enum { MESSAGE_BYTES = 16 * 1024 };

/* Whether findings reach the severity at which the run fails. The report, which is made whenever that is asked,
 * knows what is ignored or old. */
static bool findings_fail(const nt_summary *summary, int least_failure)
{
	nt_severity worst;
	return summary->report && nt_report_worst(summary->report, &worst) && (int)worst >= least_failure;
}

/* Sums that --timing shows. */
static void add_times(nt_summary *total, const nt_summary *one)
{
	for (int stage = 0; stage < NT_STAGE_COUNT; stage++)
		total->seconds[stage] += one->seconds[stage];
	total->total_seconds += one->total_seconds;
	total->bytes_read += one->bytes_read;
	total->bytes_copied += one->bytes_copied;
	total->bytes_written += one->bytes_written;
	total->same_count += one->same_count;
	total->bare_materials += one->bare_materials;
	for (int reason = 0; reason < NT_DECISION_COUNT; reason++)
		total->skipped[reason] += one->skipped[reason];
}

/* Writes the job's own page. An index without it would not be whole. */
static void add_page(session *s, nt_report *report, int *code)
{
	nt_error error;
	if (!s->folder)
		return;
	const nt_status status = report ? nt_report_folder_add(s->folder, s->told, report, &error) : NT_OK;
	if (status)
		nt_message_error(&s->text, &error, s->style);
	s->no_report |= status || !report;
	*code = nt_exit_worse(*code, nt_exit_code(status));
}

/* Says what became of a job that ran, and returns its exit code. */
static int tell_run(session *s, nt_job *job)
{
	const nt_command *c = s->command;
	nt_summary *summary = &job->outcome->summary;
	int code = nt_exit_code(job->status);
	const int least_failure = s->plan->target.style.least_failure;
	const bool fails = !job->status && !c->diff && findings_fail(summary, least_failure);
	const int most = fails ? least_failure - 1 : NT_SEVERITY_ERROR;
	const nt_style style = {s->style.colour, s->style.verbosity, fails || job->status};
	/* a report on standard output says it better */
	const bool shown = s->plan->target.path && strcmp(s->plan->target.path, "-") == 0;
	if (fails && !shown)
		nt_message_failure(&s->text, summary->report, &s->plan->options, job->input, job->output, NULL,
			least_failure, s->style);
	if (s->style.verbosity >= 0 && !shown) {
		/* what nmtan chose for a file that is not there says nothing */
		const nt_shown_infos infos = c->settings.check || s->style.verbosity > 0 ? NT_INFOS_ALL
			: job->status ? NT_INFOS_NONE : NT_INFOS_CHOSEN;
		nt_message_findings(&s->text, &summary->findings, summary->report, &s->plan->options, job->input,
			job->output, infos, most, style);
	} else if (s->style.verbosity < 0 && !job->status && !c->settings.check)
		nt_message_left_out(&s->text, job, s->plan->options.ignore);
	/* in a quiet run a batch counts them */
	if (!job->status && !shown && (s->style.verbosity >= 0 || (summary->keeps_wrong && s->count == 1)))
		nt_message_checked(&s->text, &summary->findings, summary->report, &s->plan->options, job->input,
			job->output, most, style);
	const bool is_found = s->style.verbosity >= 0 && !shown && job->status == NT_ERROR_MISSING &&
		nt_message_has(&summary->findings, &s->plan->options, NT_CODE_BUFFER_MISSING, style);
	nt_message_meshes(&s->text, job); /* none unless -v asked for them */
	if (job->status) {
		if (!job->reason_is_told && !is_found)
			nt_message_error(&s->text, &job->outcome->error, s->style);
	} else {
		if (s->style.verbosity >= 0)
			nt_message_success(&s->text, job, &c->settings);
		if (fails)
			code = NT_EXIT_FINDINGS;
		s->failing += fails;
	}
	if (!job->status)
		*(summary->left ? &s->left : summary->solved_count ? &s->solved
			: summary->unchanged ? &s->unchanged : &s->without) += 1;
	s->wrong += !job->status && summary->keeps_wrong;
	add_times(&s->total, summary);
	add_page(s, summary->report, &code);
	if (s->reports)
		s->reports[s->report_count++] = summary->report;
	else
		nt_report_free(summary->report); /* it was for the verdict alone */
	summary->report = NULL;
	return code;
}

/* Called once per job, as soon as it ends and still has its report. */
static void note_end(void *user, const nt_job *job)
{
	session *s = user;
	const bool fails = !job->status && job->outcome && !s->command->diff &&
		findings_fail(&job->outcome->summary, s->plan->target.style.least_failure);
	in_work.ended += job->end != NT_JOB_UNTRIED;
	in_work.failed += job->status != NT_OK;
	if (!s->command->manifest)
		return;
	nt_manifest_add(&s->manifest, job, fails ? NT_EXIT_FINDINGS : nt_exit_code(job->status));
}

/* Reports must not replace files that a job has read or written. */
static void refuse_own(session *s, const nt_job *job, const char *path, bool *refused, int *code)
{
	nt_error error;
	if (*refused || !job->outcome || !nt_own_file_check_trace(path, &job->outcome->summary.trace, &error))
		return;
	*refused = true;
	nt_message_error(&s->text, &error, s->style);
	*code = nt_exit_worse(*code, nt_exit_code(error.status));
}

/* The rule of an output that is there. */
static void add_rule(session *s, const nt_job *job, int *code)
{
	nt_error error;
	if (!s->command->depfile || s->command->settings.dry_run || job->status || job->end == NT_JOB_UNTRIED ||
		!job->outcome ||
		!nt_depfile_add(&s->depfile, job->output, &job->outcome->summary.trace, &error))
		return;
	nt_message_error(&s->text, &error, s->style);
	s->no_depfile = true;
	*code = nt_exit_worse(*code, nt_exit_code(error.status));
}

/* A message for which there is no memory is printed all the same, shorter. */
static void tell_shortly(session *s, const nt_job *job)
{
	nt_error error;
	if (job->status == NT_ERROR_LIMIT)
		nt_fail_memory_limit(s->command->settings.max_memory, &error);
	else if (job->status)
		nt_fail_memory(&error);
	else
		nt_fail(&error, NT_ERROR_MEMORY, "out of memory for a message%s",
			job->output && !s->command->settings.dry_run ? "; the output stands" : "");
	nt_error_in_file(&error, job->input);
	nt_say_error(job->status && job->outcome ? &job->outcome->error : &error, s->style);
}

/* Called once per job, in order: says what became of it. */
static void tell_job(void *user, nt_job *job)
{
	session *s = user;
	int code = nt_exit_code(job->status);
	if (job->end == NT_JOB_UNTRIED)
		s->untried++;
	else if (job->end == NT_JOB_CURRENT)
		s->current++;
	else if (job->outcome)
		code = tell_run(s, job);
	else
		s->no_report = true;
	const bool current = job->end == NT_JOB_CURRENT, still_wrong = current && job->outcome->summary.keeps_wrong;
	s->wrong += still_wrong;
	if (current && (s->style.verbosity + (s->count == 1) > 0 || (still_wrong && s->count == 1)))
		nt_message_current(&s->text, job);
	refuse_own(s, job, s->command->depfile, &s->no_depfile, &code);
	refuse_own(s, job, s->command->report, &s->no_report, &code);
	add_rule(s, job, &code);
	if (job->status)
		nt_failures_add(&s->failures, job);
	const nt_summary *summary = job->outcome ? &job->outcome->summary : NULL;
	nt_progress_file(s->progress, summary ? summary->bytes_read + summary->bytes_written : 0, job->status != NT_OK);
	nt_progress_hide(s->progress);
	if (s->text.failed || (job->status && !job->outcome)) {
		tell_shortly(s, job);
		code = nt_exit_worse(code, job->status ? NT_EXIT_DONE : NT_EXIT_INTERNAL);
	} else {
		nt_say(&s->text);
	}
	s->text.size = 0;
	s->text.failed = false;
	nt_progress_show(s->progress);
	s->exit_code = nt_exit_worse(s->exit_code, code);
	s->told++;
}

/* Returns whether there is sense in writing more. */
static bool tell_report_error(session *s, nt_error *error, const char *path)
{
	const bool unread = strcmp(path, "-") == 0 && nt_reader_is_gone();
	s->unread |= unread;
	if (unread)
		return true;
	nt_error_in_output(error, path);
	nt_say_error(error, s->style);
	s->exit_code = nt_exit_worse(s->exit_code, nt_exit_code(error->status));
	return error->status != NT_ERROR_MEMORY;
}

/* Compares the two reports and lets what is new decide. A version that could not be judged has been told. */
static void tell_diff(session *s)
{
	nt_report_target target = s->plan->target;
	nt_report_diff diff = {0};
	nt_error error;
	if (s->report_count != 2 || !s->reports[0] || !s->reports[1] || s->reports[0]->failure ||
		s->reports[1]->failure)
		return;
	if (nt_report_compare(&diff, s->reports[0], s->reports[1], target.format == NT_REPORT_HTML)) {
		nt_fail_memory(&error);
		tell_report_error(s, &error, target.path ? target.path : "");
		return;
	}
	for (int severity = target.style.least_failure; severity <= NT_SEVERITY_ERROR; severity++)
		if (diff.by_severity[1][severity])
			s->exit_code = nt_exit_worse(s->exit_code, NT_EXIT_FINDINGS);
	if (!target.path || strcmp(target.path, "-") != 0)
		nt_message_failure(&s->text, s->reports[1], &s->plan->options, s->command->operands[1], NULL,
			diff.known[1], target.style.least_failure, s->style);
	target.diff = &diff;
	if (target.path && nt_report_to_file(s->reports, s->report_count, &target, &error))
		tell_report_error(s, &error, target.path);
	nt_report_diff_free(&diff);
}

/* Writes the report of all inputs if it was asked for. */
static void tell_report(session *s)
{
	const nt_report_target *target = &s->plan->target;
	nt_error error;
	/* what had no memory for its report has been told */
	bool all = !s->no_report;
	for (size_t i = 0; i < s->report_count; i++)
		all &= s->reports[i] || !s->plan->wanted;
	if (s->command->diff)
		tell_diff(s);
	else if (all && s->folder && nt_report_folder_end(s->folder, &error))
		tell_report_error(s, &error, target->path);
	else if (all && !s->folder && target->path && nt_report_to_file(s->reports, s->report_count, target, &error))
		tell_report_error(s, &error, target->path);
}

/* The files that are complete only now. A depfile without rules would be one of no outputs. */
static void tell_files(session *s)
{
	const nt_command *c = s->command;
	nt_error error;
	if (c->manifest && nt_manifest_close(&s->manifest, &error))
		tell_report_error(s, &error, c->manifest);
	if (c->depfile && s->depfile.text.size && !s->no_depfile &&
		nt_depfile_write(&s->depfile, c->depfile, c->operands,
			nt_command_is_many(c) ? c->operand_count : 1, &error))
		tell_report_error(s, &error, c->depfile);
}

/* Counts of those that are done. */
static void append_outcomes(session *s)
{
	const size_t counts[] = {s->solved, s->unchanged, s->without, s->left, s->wrong};
	const char *const words[] = {"got tangents", "unchanged", "written without new tangents",
		s->left == 1 ? "left as it was" : "left as they were",
		s->wrong == 1 ? "keeps wrong tangents" : "keep wrong tangents"};
	const char *before = "; ";
	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
		if (!counts[i])
			continue;
		nt_buffer_format(&s->text, "%s%zu %s", before, counts[i], words[i]);
		before = ", ";
	}
}

/* Outputs that no input of a folder makes any more. */
static void tell_left_over(session *s)
{
	nt_buffer first = {0};
	const nt_command *c = s->command;
	const size_t count = c->update && c->recursive && s->style.verbosity >= 0
		? nt_update_left_over(s->update, &first) : 0;
	if (count) {
		nt_buffer_format(&s->text, "nmtan: %zu output%s left whose input is gone: ", count,
			count == 1 ? " is" : "s are");
		nt_buffer_clean(&s->text, first.data ? first.data : "");
		if (count > 1)
			nt_buffer_format(&s->text, " and %zu more", count - 1);
		nt_buffer_text(&s->text, "\n");
	}
	nt_buffer_free_into(&first, &s->text);
}

/* After the last of many: how many failed, and why; and the times. */
static void tell_end(session *s)
{
	const size_t failed = s->failures.count, count = s->count;
	if (count > 1 && (failed || s->failing || s->wrong || s->style.verbosity >= 0)) {
		const bool check = s->command->settings.check;
		const nt_phrase jobs[] = {
			{s->current, ", ", "", " of them up to date"},
			{failed, ", ", "", " failed"},
			{s->untried, ", ", "", " not tried"},
			{s->failing, ", ", "", " with findings that fail the run"}};
		const nt_phrase rest[] = {
			{s->command->settings.dry_run && !check, "; dry run, nothing written", NULL, ""},
			{s->total.bare_materials, ", ", "material", " without any image"},
			{1, "\n", NULL, ""}};
		nt_buffer_format(&s->text, "nmtan: %zu of %zu done", count - failed - s->untried, count);
		nt_message_phrases(&s->text, jobs, sizeof jobs / sizeof *jobs);
		if (!check)
			append_outcomes(s);
		nt_message_phrases(&s->text, rest, sizeof rest / sizeof *rest);
		nt_failures_append(&s->text, &s->failures, s->command->manifest);
	}
	tell_left_over(s);
	if (s->command->timing)
		nt_message_timing(&s->text, &s->total);
	if (!nt_say(&s->text))
		s->exit_code = nt_exit_worse(s->exit_code, NT_EXIT_INTERNAL);
}

/* The records, if any. */
static nt_status begin_update(session *s, nt_error *error)
{
	const nt_command *c = s->command;
	if ((!c->update && !c->record) || c->settings.check)
		return NT_OK;
	const nt_update_options options = {.look = c->update != 0,
		.by = c->update ? (nt_update_by)(c->update - 1) : NT_UPDATE_BY_TIME, .record = c->record,
		.folder = c->directory, .dry_run = c->settings.dry_run,
		.options = s->recorded.data ? s->recorded.data : "",
		.judging = !s->plan->wanted ? NULL : s->judging.data ? s->judging.data : "",
		.least_failure = s->plan->target.style.least_failure};
	return nt_update_begin(&s->update, &options, error);
}

/* Memory for what is said and for the reports, and what else may be refused. */
static nt_status begin_session(session *s, nt_error *error)
{
	const bool kept = (s->plan->target.path && !s->folder) || s->command->diff;
	if (kept)
		s->reports = nt_calloc(s->count, sizeof *s->reports);
	if ((!s->reports && kept) || !nt_buffer_reserve(&s->text, MESSAGE_BYTES))
		return nt_fail_memory(error);
	nt_options_shaping(s->command, true, &s->shaping);
	nt_options_shaping(s->command, false, &s->recorded);
	nt_options_judging(s->command, &s->judging);
	if (s->shaping.failed || s->recorded.failed || s->judging.failed)
		return nt_fail_memory(error);
	const char *options = s->shaping.data ? s->shaping.data : "";
	if (s->command->manifest && nt_manifest_open(&s->manifest, s->command->manifest, options,
		&s->plan->options, s->command->settings.check, error))
		return error->status;
	return begin_update(s, error);
}

static void end_session(session *s)
{
	nt_error told; /* where the batch ran to its end it is closed, and this does nothing */
	nt_manifest_close(&s->manifest, &told);
	for (size_t i = 0; i < s->report_count; i++)
		nt_report_free(s->reports[i]);
	free(s->reports);
	nt_update_end(s->update);
	nt_depfile_free(&s->depfile);
	nt_buffer_free(&s->shaping);
	nt_buffer_free(&s->recorded);
	nt_buffer_free(&s->judging);
	nt_buffer_free(&s->text);
	nt_failures_free(&s->failures);
}

static nt_style style_of_late;

static void end_late(const nt_error *error)
{
	nt_say_error(error, style_of_late);
	_exit(NT_EXIT_LIMIT);
}

static struct rlimit data_before;

/* The last words if memory is exhausted in a place that cannot fail. */
static struct {
	char line[320];
	int code;
} exhausted = {"nmtan: out of memory\n", NT_EXIT_INTERNAL};

/* Has the system refuse memory beyond the limit, while files are worked on. Threads get their stacks all the same, of
 * which they use little. */
static void limit_memory(const nt_command *command, const nt_batch *batch)
{
	struct rlimit data, stack;
	const uint64_t most = command->settings.max_memory;
	if (!most || getrlimit(RLIMIT_DATA, &data) != 0 || getrlimit(RLIMIT_STACK, &stack) != 0)
		return;
	nt_error error;
	const char *one = batch->count == 1 ? batch->jobs[0].input : "";
	nt_fail_memory_limit(most, &error);
	snprintf(exhausted.line, sizeof exhausted.line - 1, "nmtan: %.*s%s%.*s", NT_CUT(160, one), *one ? ": " : "",
		NT_CUT(100, error.message));
	nt_utf8_mask(exhausted.line);
	strcat(exhausted.line, "\n");
	exhausted.code = NT_EXIT_LIMIT;
	const uint64_t each = stack.rlim_cur == RLIM_INFINITY ? 2 << 20 : stack.rlim_cur;
	data_before = data;
	const uint64_t whole = most + each * (nt_thread_count(command->settings.io.threads) + 1);
	if (data.rlim_cur == RLIM_INFINITY || whole < data.rlim_cur)
		data.rlim_cur = whole;
	setrlimit(RLIMIT_DATA, &data);
}

int nt_session_run(const nt_command *command, nt_style style, const nt_report_plan *plan,
	nt_batch *batch, nt_report_folder *folder)
{
	session s = {.command = command, .plan = plan, .folder = folder, .style = style, .count = batch->count,
		.manifest = {.fd = -1}};
	nt_error error;
	if (begin_session(&s, &error)) {
		end_session(&s);
		nt_say_error(&error, style);
		return nt_exit_code(error.status);
	}
	nt_settings settings = command->settings;
	settings.report = plan->wanted ? &plan->options : NULL;
	settings.list_meshes = style.verbosity > 0;
	settings.digests = command->manifest != NULL;
	s.progress = nt_progress_start(style.verbosity < 0 ? NT_PROGRESS_OFF : command->progress,
		batch->count ? batch->jobs[0].input : "", batch->count);
	if (s.progress && batch->count == 1) {
		settings.on_stage = nt_progress_stage;
		settings.on_stage_user = s.progress;
	}
	style_of_late = style;
	if (batch->count == 1)
		settings.too_late = end_late;
	const nt_batch_options options = {.run = nt_run, .jobs = (unsigned)command->jobs,
		.memory = command->memory, .update = s.update,
		.fail_fast = command->fail_fast, .done = tell_job,
		.ended = note_end, .user = &s};
	in_work.erases = s.progress && isatty(STDERR_FILENO);
	in_work.count = batch->count;
	limit_memory(command, batch);
	nt_batch_run(batch, &settings, &options);
	/* for what is told of the runs: what they have given back, a thread's heap may keep */
	if (command->settings.max_memory && data_before.rlim_cur)
		setrlimit(RLIMIT_DATA, &data_before);
	nt_progress_stop(s.progress);
	tell_report(&s);
	tell_files(&s);
	tell_end(&s);
	end_session(&s);
	if (s.unread)
		nt_end_unread();
	return s.exit_code;
}

/* The same if a folder has no inputs any more. */
void nt_session_tell_left_over(const nt_command *command, nt_style style, const nt_report_plan *plan)
{
	session s = {.command = command, .plan = plan, .style = style};
	nt_error ignored; /* the run has failed already */
	if (!begin_update(&s, &ignored)) {
		tell_left_over(&s);
		nt_say(&s.text);
	}
	nt_update_end(s.update);
	nt_buffer_free(&s.text);
}

static size_t put_number(char *text, size_t number)
{
	size_t size = 1;
	for (size_t rest = number; rest > 9; rest /= 10)
		size++;
	for (size_t i = size; i-- > 0; number /= 10)
		text[i] = (char)('0' + number % 10);
	return size;
}

/* In a signal handler. */
void nt_session_tell_interrupted(void)
{
	const size_t failed = in_work.failed, numbers[] = {in_work.ended - failed, in_work.count, failed};
	const char *const words[] = {" of ", " done, ", &" failed, ended by a signal\n"[failed ? 0 : 9]};
	char line[160];
	if (in_work.count < 2)
		return;
	size_t size = (size_t)(stpcpy(line, in_work.erases ? "\r\033[Knmtan: " : "nmtan: ") - line);
	for (size_t i = 0; i < 3; i++) {
		size += i < 2 || failed ? put_number(line + size, numbers[i]) : 0;
		size = (size_t)(stpcpy(line + size, words[i]) - line);
	}
	const ssize_t written = write(STDERR_FILENO, line, size);
	(void)written;
}

void nt_session_end_exhausted(void)
{
	const ssize_t written = write(STDERR_FILENO, exhausted.line, strlen(exhausted.line));
	(void)written;
	_exit(exhausted.code);
}

/* SPDX-License-Identifier: MIT */
/*
 * Tells people: messages, the channels that they go through, failures by reason, the line of a long run.
 */
#ifndef NT_CLI_MESSAGES_H
#define NT_CLI_MESSAGES_H

#include "base/text.h"
#include "batch/batch.h"

/* ---- messages: messages.c ---- */

/*
 * Texts in a buffer: errors with their place, findings, the line on success, the table of --timing. The caller prints
 * them in one piece, so that the messages of files that run at the same time do not mix.
 *
 * Names and texts from files may hold anything; control characters are shown as \x1b, never sent to a terminal.
 */

typedef struct nt_style {
	bool colour;
	int verbosity; /* as in nt_command */
	bool fails;    /* what is told of ends with an exit code that is not 0 */
} nt_style;

/* A part of a sentence, said if its count is not 0: what is before, "1 primitive" or "2 primitives" with this noun (""
 * the number alone, NULL nothing), what is after. */
typedef struct nt_phrase {
	size_t count;
	const char *before, *noun, *after;
} nt_phrase;

void nt_message_phrases(nt_buffer *out, const nt_phrase *phrases, size_t count);

/* "nmtan: file:line: message", "nmtan: file: at byte N: message" or "nmtan: file: /pointer: message". */
void nt_message_error(nt_buffer *out, const nt_error *error, nt_style style);

/* Infos that are printed: none, what nmtan chose, or all. */
typedef enum nt_shown_infos { NT_INFOS_NONE, NT_INFOS_CHOSEN, NT_INFOS_ALL } nt_shown_infos;

/* Findings of the severities from `most` (nt_severity) down, a few of each code, with such infos: "nmtan:
 * file:line: warning: sentence [CODE]", and the command, if one repairs it, with `output` (NULL: a name beside the
 * file). Severities are those of `options`; findings that these ignore, or that the report (NULL: there is none)
 * knows from its baseline, are left out. */
void nt_message_findings(nt_buffer *out, const nt_finding_list *findings, const nt_report *report,
	const nt_report_options *options, const char *file, const char *output,
	nt_shown_infos infos, int most, nt_style style);

/* Whether nt_message_findings() prints an error or a warning of a code. */
bool nt_message_has(const nt_finding_list *findings, const nt_report_options *options, nt_code code, nt_style style);

/* Errors and warnings that the checks of a report found, up to a severity, as nt_message_findings() has it. In a quiet
 * run only wrong tangents that were kept, one line for each code; report NULL: findings know them. */
void nt_message_checked(nt_buffer *out, const nt_finding_list *findings, const nt_report *report,
	const nt_report_options *options, const char *file, const char *output, int most, nt_style style);

/* One line, of a quiet run too, where something of the input is not in the output, with the codes that say what but for
 * those of ignore[code]. */
void nt_message_left_out(nt_buffer *out, const nt_job *job, const bool *ignore);

/* An output that was up to date. */
void nt_message_current(nt_buffer *out, const nt_job *job);

/* A line for each mesh of the summary's list: what was decided and why, triangles, vertices. */
void nt_message_meshes(nt_buffer *out, const nt_job *job);

/* The findings for which a run fails, with commands: those of a report from the severity `least_failure` on that are
 * not known. known: [findings] which are; NULL: as each says. */
void nt_message_failure(nt_buffer *out, const nt_report *report, const nt_report_options *options, const char *file,
	const char *output, const bool *known, int least_failure, nt_style style);

/* One line: what happened. */
void nt_message_success(nt_buffer *out, const nt_job *job, const nt_settings *settings);

/* A table of the stages' seconds. */
void nt_message_timing(nt_buffer *out, const nt_summary *summary);

/* ---- channels: say.c ---- */

/* Standard error, also when there is no memory to build a message in, and exit codes, which are part of the tool's
 * interface (nmtan.1). */

/* Prints a text and empties the buffer, which keeps its memory. False where memory was too short to build the
 * text: then one line says that. */
bool nt_say(nt_buffer *text);

/* Prints "nmtan: place: message". */
void nt_say_error(const nt_error *error, nt_style style);

/* Whether standard output is a pipe that nobody reads any more. */
bool nt_reader_is_gone(void);

/* Ends the program as others end if a reader takes the first lines alone (head), without a message. */
void nt_end_unread(void);

enum nt_exit {
	NT_EXIT_DONE = 0,
	NT_EXIT_USAGE = 1,
	NT_EXIT_IO = 2,
	NT_EXIT_INPUT = 3,
	NT_EXIT_INTERNAL = 4, /* out of memory too */
	NT_EXIT_UNSUPPORTED = 5,
	NT_EXIT_FINDINGS = 6,
	NT_EXIT_LIMIT = 7
};

/* The exit code of a status. */
int nt_exit_code(nt_status status);

/* The worse of two exit codes, in the order 4, 2, 3, 5, 7, 1, 6, 0. */
int nt_exit_worse(int a, int b);

/* ---- failures of a run of many: say.c ---- */

/* They are grouped by reason: ten thousand files that fail for one reason are one line. */

/* So many reasons have a line, and so many inputs of each a name. */
enum { NT_FAILURE_GROUPS = 10, NT_FAILURE_NAMES = 3 };

typedef struct nt_failure_group {
	char *reason;
	char *names[NT_FAILURE_NAMES];
	size_t count;
} nt_failure_group;

/* Zeroed: nothing failed. */
typedef struct nt_failures {
	nt_failure_group groups[NT_FAILURE_GROUPS];
	size_t group_count, count;
} nt_failures;

/* Counts a job that failed. A reason that finds no memory counts as a further reason. */
void nt_failures_add(nt_failures *failures, const nt_job *job);

/* Appends a line for each reason, and one for those that have none; `manifest`: the file that has them all, or NULL. */
void nt_failures_append(nt_buffer *out, const nt_failures *failures, const char *manifest);

void nt_failures_free(nt_failures *failures);

/* ---- the line that shows what a long run is doing: progress.c ---- */

/* A thread looks at it once in a while. It costs the run nothing but a store per stage, and does not exist where nobody
 * would see it. */

typedef struct nt_progress nt_progress;

/* Starts showing, or returns NULL where nothing is to be shown; all functions accept NULL. `label` is
 * the input's name, `files` how many there are. */
nt_progress *nt_progress_start(int mode, const char *label, size_t files);

/* For settings.on_stage. */
void nt_progress_stage(void *progress, nt_stage stage);

/* One more file has ended, for which so many bytes were read and written. */
void nt_progress_file(nt_progress *progress, uint64_t bytes, bool failed);

/* Between these two the line is gone and stays away, for messages. */
void nt_progress_hide(nt_progress *progress);
void nt_progress_show(nt_progress *progress);

void nt_progress_stop(nt_progress *progress);

#endif

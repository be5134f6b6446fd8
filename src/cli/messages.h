/* SPDX-License-Identifier: MIT */
/*
 * Messages to people, as text in a buffer: errors with their place, findings, the line on
 * success, the table of --timing. The caller prints them in one piece, so that the messages of files
 * that run at the same time do not mix.
 *
 * Names and texts from files may hold anything; control characters are shown as \x1b, never sent to a
 * terminal.
 */
#ifndef NT_CLI_MESSAGES_H
#define NT_CLI_MESSAGES_H

#include "base/text.h"
#include "batch/batch.h"

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

#endif

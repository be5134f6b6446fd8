/* SPDX-License-Identifier: MIT */
/*
 * Standard error, exit codes, and the failures of a run of many: see messages.h.
 */
#include "cli/messages.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/text.h"

bool nt_say(nt_buffer *text)
{
	const bool whole = !text->failed;
	if (!whole)
		fputs("nmtan: out of memory\n", stderr);
	else if (text->size)
		fwrite(text->data, 1, text->size, stderr);
	text->size = 0;
	text->failed = false;
	return whole;
}

void nt_say_error(const nt_error *error, nt_style style)
{
	nt_buffer text = {0};
	nt_message_error(&text, error, style);
	if (text.failed) {
		/* the place is the file alone, and what must not reach a terminal is a question mark */
		char line[sizeof error->place.file + sizeof error->message + 16];
		const char *file = strcmp(error->place.file, "-") == 0 ? "standard input" : error->place.file;
		snprintf(line, sizeof line, "nmtan: %s%s%s", file, *file ? ": " : "",
			error->message[0] ? error->message : nt_status_text(error->status));
		nt_utf8_mask(line);
		fprintf(stderr, "%s\n", line);
	} else {
		nt_say(&text);
	}
	nt_buffer_free(&text);
}

bool nt_reader_is_gone(void)
{
	struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
	return poll(&out, 1, 0) == 1 && (out.revents & POLLERR);
}

void nt_end_unread(void)
{
	signal(SIGPIPE, SIG_DFL);
	raise(SIGPIPE);
}

/* ---- exit codes ---- */

int nt_exit_code(nt_status status)
{
	switch (status) {
	case NT_OK:
		return NT_EXIT_DONE;
	case NT_ERROR_USAGE:
		return NT_EXIT_USAGE;
	case NT_ERROR_IO:
	case NT_ERROR_MISSING:
		return NT_EXIT_IO;
	case NT_ERROR_INPUT:
		return NT_EXIT_INPUT;
	case NT_ERROR_LIMIT:
		return NT_EXIT_LIMIT;
	case NT_ERROR_UNSUPPORTED:
	case NT_ERROR_MODULE:
	case NT_ERROR_TOO_LARGE:
		return NT_EXIT_UNSUPPORTED;
	default:
		/* A reader should have refused before what the compute API refuses: our mistake. */
		return NT_EXIT_INTERNAL;
	}
}

int nt_exit_worse(int a, int b)
{
	static const int worst_first[] = {NT_EXIT_INTERNAL, NT_EXIT_IO, NT_EXIT_INPUT,
		NT_EXIT_UNSUPPORTED, NT_EXIT_LIMIT, NT_EXIT_USAGE, NT_EXIT_FINDINGS};
	for (unsigned i = 0; i < sizeof worst_first / sizeof *worst_first; i++)
		if (a == worst_first[i] || b == worst_first[i])
			return worst_first[i];
	return NT_EXIT_DONE;
}

/* ---- failures by reason ---- */

/* Whether two reasons are equal but for what is quoted, as names of files are. */
static bool are_alike(const char *a, const char *b)
{
	for (; *a && *a == *b; a++, b++) {
		const char *a_end = *a == '"' ? strchr(a + 1, '"') : NULL;
		const char *b_end = *a == '"' ? strchr(b + 1, '"') : NULL;
		a = a_end && b_end ? a_end : a;
		b = a_end && b_end ? b_end : b;
	}
	return *a == *b;
}

/* Puts "..." for what is quoted. */
static void drop_quoted(char **reason)
{
	nt_buffer text = {0};
	for (const char *from = *reason; *from; from++) {
		const char *end = *from == '"' ? strchr(from + 1, '"') : NULL;
		nt_buffer_append(&text, end ? "\"...\"" : from, end ? strlen("\"...\"") : 1);
		from = end ? end : from;
	}
	if (!text.failed) {
		free(*reason);
		*reason = text.data;
	} else {
		nt_buffer_free(&text);
	}
}

static nt_failure_group *group_of(nt_failures *failures, const char *reason)
{
	for (size_t i = 0; i < failures->group_count; i++) {
		char **known = &failures->groups[i].reason;
		if (!are_alike(*known, reason))
			continue;
		if (strcmp(*known, reason) != 0)
			drop_quoted(known);
		return &failures->groups[i];
	}
	if (failures->group_count == NT_FAILURE_GROUPS)
		return NULL;
	nt_failure_group *group = &failures->groups[failures->group_count];
	group->reason = strdup(reason);
	failures->group_count += group->reason != NULL;
	return group->reason ? group : NULL;
}

void nt_failures_add(nt_failures *failures, const nt_job *job)
{
	failures->count++;
	const nt_error *error = job->outcome ? &job->outcome->error : NULL;
	/* each clash of names has told which ones */
	nt_failure_group *group = group_of(failures, job->refused ? "would replace another output or an input"
		: error && error->message[0] ? error->message : nt_status_text(job->status));
	if (!group)
		return;
	if (group->count < NT_FAILURE_NAMES)
		group->names[group->count] = strdup(job->input);
	group->count++;
}

static void append_group(nt_buffer *out, const nt_failure_group *group)
{
	size_t named = 0;
	nt_buffer_format(out, "nmtan:   %zu failed: ", group->count);
	nt_buffer_clean(out, group->reason);
	for (size_t i = 0; i < NT_FAILURE_NAMES; i++)
		if (group->names[i]) {
			nt_buffer_text(out, named++ ? ", " : ": ");
			nt_buffer_clean(out, group->names[i]);
		}
	if (group->count > named)
		nt_buffer_format(out, " and %zu more", group->count - named);
	nt_buffer_text(out, "\n");
}

void nt_failures_append(nt_buffer *out, const nt_failures *failures, const char *manifest)
{
	size_t shown = 0;
	for (size_t i = 0; i < failures->group_count; i++) {
		append_group(out, &failures->groups[i]);
		shown += failures->groups[i].count;
	}
	if (shown == failures->count)
		return;
	nt_buffer_format(out, "nmtan:   %zu failed for other reasons, which are ", failures->count - shown);
	if (manifest) {
		nt_buffer_text(out, "in ");
		nt_buffer_clean(out, manifest);
	} else {
		nt_buffer_text(out, "printed above");
	}
	nt_buffer_text(out, "\n");
}

void nt_failures_free(nt_failures *failures)
{
	for (size_t i = 0; i < failures->group_count; i++) {
		free(failures->groups[i].reason);
		for (size_t k = 0; k < NT_FAILURE_NAMES; k++)
			free(failures->groups[i].names[k]);
	}
	*failures = (nt_failures){0};
}

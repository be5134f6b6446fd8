/* SPDX-License-Identifier: MIT */
/*
 * Standard error and exit codes: see messages.h.
 */
#include "cli/messages.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
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

/* SPDX-License-Identifier: MIT */
/*
 * Standard error: see say.h.
 */
#include "cli/say.h"

#include <stdio.h>
#include <string.h>

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

/* Without memory the place is the file alone, and what must not reach a terminal is a question mark. */
static void say_plainly(const nt_error *error)
{
	char line[sizeof error->place.file + sizeof error->message + 16];
	const char *file = strcmp(error->place.file, "-") == 0 ? "standard input" : error->place.file;
	snprintf(line, sizeof line, "nmtan: %s%s%s", file, *file ? ": " : "",
		error->message[0] ? error->message : nt_status_text(error->status));
	for (char *c = line; *c; c++)
		if ((unsigned char)*c < 0x20 || *c == 0x7f)
			*c = '?';
	fprintf(stderr, "%s\n", line);
}

void nt_say_error(const nt_error *error, nt_style style)
{
	nt_buffer text = {0};
	nt_message_error(&text, error, style);
	if (text.failed)
		say_plainly(error);
	else
		nt_say(&text);
	nt_buffer_free(&text);
}

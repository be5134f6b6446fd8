/* SPDX-License-Identifier: MIT */
/*
 * Channels to people and scripts: standard error, also when there is no memory to build a message in, and
 * exit codes, which are part of the tool's interface (nmtan.1).
 */
#ifndef NT_CLI_SAY_H
#define NT_CLI_SAY_H

#include "base/text.h"
#include "cli/messages.h"

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

#endif

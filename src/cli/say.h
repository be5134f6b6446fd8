/* SPDX-License-Identifier: MIT */
/*
 * Standard error, also when there is no memory to build a message in.
 */
#ifndef NT_CLI_SAY_H
#define NT_CLI_SAY_H

#include "base/buffer.h"
#include "cli/messages.h"

/* Prints a text and empties the buffer, which keeps its memory. False where memory was too short to build the
 * text: then one line says that. */
bool nt_say(nt_buffer *text);

/* Prints "nmtan: place: message". */
void nt_say_error(const nt_error *error, nt_style style);

#endif

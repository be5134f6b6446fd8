/* SPDX-License-Identifier: MIT */
/*
 * Who makes temporary files: a name part by which a later run, on this or another machine, can tell whether the
 * process that made a file is gone.
 */
#ifndef NT_FILE_MAKER_H
#define NT_FILE_MAKER_H

#include <stdbool.h>
#include <stddef.h>

/* Room for the text of a maker. */
enum { NT_MAKER_TEXT = 160 };

/* This process: "HOST-BOOT-SPACE-PID-START", of letters, digits, ".", "_" and "-". What the system does not tell
 * is 0. */
void nt_maker_text(char text[NT_MAKER_TEXT]);

/*
 * Whether the process of such a text is certainly gone. It is when the process number is free, or was given to a
 * later process, on this very kernel and among the same process numbers; or when this machine was started again since,
 * where the folder is on a disk of this machine alone (`local`): on a shared one another machine could have our name.
 */
bool nt_maker_is_gone(const char *text, size_t length, bool local);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Temporary files that a signal removes. A file is on the list from the moment it exists until it has
 * its name or is gone, without a gap in between.
 */
#ifndef NT_FILE_TEMPORARY_H
#define NT_FILE_TEMPORARY_H

#include <stdbool.h>

typedef struct nt_temporary nt_temporary;

/* Creates a new file beside `target` (mode 0666 less the umask), open for writing. Returns its
 * descriptor; -1 with errno set otherwise (ENOMEM included). */
int nt_temporary_create(const char *target, nt_temporary **temporary);

/* Where it is. */
const char *nt_temporary_path(const nt_temporary *temporary);

/* Between hold and release no signal ends the process, so that the renames of a set happen all or not
 * at all. The calling thread must not create temporaries meanwhile. */
void nt_temporaries_hold(void);
void nt_temporaries_release(void);

/* Gives the file its name; while held. `replace`: an existing file may go. On failure errno is set and
 * the file stays what it was. */
bool nt_temporary_rename(nt_temporary *temporary, const char *target, bool replace);

/* Frees the entry and removes the file, where it has not been renamed. NULL is allowed. */
void nt_temporary_discard(nt_temporary *temporary);

#endif

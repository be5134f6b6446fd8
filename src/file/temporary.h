/* SPDX-License-Identifier: MIT */
/*
 * Temporary files that a signal removes, or, where nothing could (SIGKILL, a power cut), a later run. A file
 * is on the list from the moment it exists until it has its name or is gone, without a gap in between.
 */
#ifndef NT_FILE_TEMPORARY_H
#define NT_FILE_TEMPORARY_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct nt_temporary nt_temporary;

/* Creates a new file beside `target`, open for reading and writing; its mode is less the umask. The folder is the one
 * that has the path now, wherever that is moved. `leader`: another one of that folder, whose lock will do for both, so
 * that nt_temporary_close() is allowed; it has to be discarded later. NULL: none. Returns its descriptor,
 * which nt_temporary_discard() closes; -1 with errno set otherwise (ENOMEM included). */
int nt_temporary_create(const char *target, unsigned mode, const nt_temporary *leader, nt_temporary **temporary);

/* Closes the descriptor of a file that has a leader: of many files, few are open. False, with errno: the system had not
 * written all of it. */
bool nt_temporary_close(nt_temporary *temporary);

/* Whether its descriptor may be closed. */
bool nt_temporary_is_led(const nt_temporary *temporary);

/* A second name beside `target` for the file `from`. False, with errno, where the file system has no links. */
bool nt_temporary_link(const char *from, const char *target, nt_temporary **temporary);

/* Its place. */
const char *nt_temporary_path(const nt_temporary *temporary);

/* The name of a file's leader, which is in the same folder; false: it has none. */
enum { NT_TEMPORARY_NAME = 160 };
bool nt_temporary_leader_of(const char *name, char leader[NT_TEMPORARY_NAME]);

/* Whether a name is that of a temporary file, and its owner, if it still runs, has a lock that this process meets: on a
 * disk of this machine alone (`local`), or of this boot. */
bool nt_temporary_is_lockable(const char *name, bool local);

/* Removes stale temporary files from a folder, which each process looks through once. A failure does not matter: the
 * next run looks again. */
void nt_temporaries_clean(const char *folder);

/* Between hold and release no signal ends the process, so that the steps of a set happen all or not at all. Several
 * threads may hold. `before` keeps the thread's signals. */
void nt_temporaries_hold(sigset_t *before);
void nt_temporaries_release(const sigset_t *before);

/* Gives the file the name that ends `target`, in its folder; while held. `replace`: an existing file may go; otherwise
 * that is EEXIST. On failure errno is set and the file stays what it was. */
bool nt_temporary_rename(nt_temporary *temporary, const char *target, bool replace);

/* Takes that name away again. */
void nt_temporary_remove_name(const nt_temporary *temporary, const char *target);

/* Frees the entry and removes the file, where it has not been renamed. NULL is allowed. */
void nt_temporary_discard(nt_temporary *temporary);

/* Removes the temporary files of all sets, for a process that ends: what is on its way to its place gets there first,
 * and nothing sets out any more. Safe in a signal handler. */
void nt_temporaries_remove_all(void);

/* Makes SIGINT, SIGTERM and SIGHUP remove the temporary files and call `tell` (NULL: nothing), in the handler, before
 * they end the process, and turns SIGPIPE into a write error. Called once by the front end. */
void nt_temporaries_catch_signals(void (*tell)(void));

#endif

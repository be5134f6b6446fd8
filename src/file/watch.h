/* SPDX-License-Identifier: MIT */
/*
 * Detects that another process changed a mapped file while it was read (by its time of modification), so that the
 * result is not used.
 *
 * If a file becomes shorter, reading the missing pages raises SIGBUS, which would end the process; here they become
 * zeros, and the reader goes on. If checked values are zeros later and that is a fault, nt_output_catch_faults()
 * reports it.
 *
 * A file belongs to the thread that opened it. Threads that help this one may read it too.
 */
#ifndef NT_FILE_WATCH_H
#define NT_FILE_WATCH_H

#include <stdbool.h>
#include <sys/stat.h>
#include "base/text.h"

/* Watches a map of a whole file, named by `path`, whose status was taken before it was mapped; a number for
 * nt_watch_end(). Below 0: too many are watched, so that the file has to be read instead. */
int nt_watch_begin(const void *map, const struct stat *status, int fd, const char *path);

/* To be called before the file is closed, and after its map is gone. */
void nt_watch_end(int watch);

/* Forgets what this thread has read so far, but for files that are open. */
void nt_watch_forget(void);

/* Returns NT_ERROR_IO, with the name, if a file that this thread opened has changed; else NT_OK. */
nt_status nt_watch_check(nt_error *error);

/* The change of the first open file that has changed, and its name; NULL: none has. Safe in a signal
 * handler. */
const char *nt_watch_any_change(const char **path);

/* Whether a file has become shorter. */
bool nt_watch_is_shortened(int watch);

/* For bytes that a system call could not read (EFAULT): reads them as a program does. True when they were in a
 * watched map and can be read now. */
bool nt_watch_touch(const void *bytes, size_t size);

#endif

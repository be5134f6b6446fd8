/* SPDX-License-Identifier: MIT */
/*
 * The line that shows what a long run is doing: a thread that looks at it once in a while. It costs the
 * run nothing but a store per stage, and does not exist where nobody would see it.
 */
#ifndef NT_CLI_PROGRESS_H
#define NT_CLI_PROGRESS_H

#include "cli/options.h"

typedef struct nt_progress nt_progress;

/* Starts showing, or returns NULL where nothing is to be shown; all functions accept NULL. `label` is
 * the input's name, `files` how many there are. */
nt_progress *nt_progress_start(int mode, const char *label, size_t files);

/* For settings.on_stage. */
void nt_progress_stage(void *progress, nt_stage stage);

/* One more file has ended, for which so many bytes were read and written. */
void nt_progress_file(nt_progress *progress, uint64_t bytes, bool failed);

/* Between these two the line is gone and stays away, for messages. */
void nt_progress_hide(nt_progress *progress);
void nt_progress_show(nt_progress *progress);

void nt_progress_stop(nt_progress *progress);

#endif

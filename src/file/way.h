/* SPDX-License-Identifier: MIT */
/*
 * Follows a path link by link and says whether it stays inside a folder. It never touches anything outside, so an
 * attacker cannot probe for files.
 */
#ifndef NT_FILE_WAY_H
#define NT_FILE_WAY_H

#include "base/buffer.h"

/* Called for each link on the way: its path, of which the folder is real, and what it says. */
typedef void (*nt_way_link)(void *user, const char *path, const char *target);

/* Appends the target of a path, of which parts may be missing. `link` may be NULL. Returns NT_OK, NT_ERROR_MISSING or
 * NT_ERROR_IO if the current folder has no name, or NT_ERROR_MEMORY. */
nt_status nt_way_follow(
	nt_buffer *real, const char *path, nt_way_link link, void *user, nt_error *error);

/* Whether `name`, taken from `folder` (absolute and real), stays below it through all links. If it does not, that is
 * noted (trace.h). Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_way_is_inside(const char *folder, const char *name, bool *inside, nt_error *error);

#endif

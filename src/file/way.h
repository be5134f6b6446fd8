/* SPDX-License-Identifier: MIT */
/*
 * The way of a path, symbolic link by symbolic link: where it leads, and whether that is inside a folder, which is told
 * without a look at anything outside, so that nobody learns what is there.
 */
#ifndef NT_FILE_WAY_H
#define NT_FILE_WAY_H

#include "base/buffer.h"

/* Called for each link on the way: its path, of which the folder is real, and what it says. */
typedef void (*nt_way_link)(void *user, const char *path, const char *target);

/* Appends where a path leads; what is missing need not be there. `link`: NULL: nobody wants to know. Returns NT_OK,
 * NT_ERROR_MISSING or NT_ERROR_IO where the current folder has no name, or NT_ERROR_MEMORY. */
nt_status nt_way_follow(
	nt_buffer *real, const char *path, nt_way_link link, void *user, nt_error *error);

/* Whether `name`, taken from `folder` (absolute and real), stays below it through all links. If it does not, that is
 * noted (trace.h). Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_way_is_inside(const char *folder, const char *name, bool *inside, nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Temporary files of processes that were killed.
 */
#ifndef NT_FILE_LITTER_H
#define NT_FILE_LITTER_H

/* Removes files that nt_temporary_create() made in a folder and whose process is gone (maker.h). Each
 * folder is looked through once by a process. What goes wrong is no matter: the files are looked for again by the next
 * run. */
void nt_litter_clean(const char *folder);

#endif

/* SPDX-License-Identifier: MIT */
/* The C library's, and the rename that it lacks: see system.c. */
#include_next <stdio.h>
#ifndef RENAME_NOREPLACE
#define RENAME_NOREPLACE 1
#ifdef __cplusplus
extern "C"
#endif
int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags);
#endif

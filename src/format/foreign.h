/* SPDX-License-Identifier: MIT */
/*
 * Files that people bring and that are not read: what they are, and what to bring instead.
 */
#ifndef NT_FORMAT_FOREIGN_H
#define NT_FORMAT_FOREIGN_H

#include <stddef.h>

/* "FBX is not read: ..." by the first bytes, else by the name's ending; NULL: none that is known. Static. */
const char *nt_foreign_advice(const unsigned char *bytes, size_t size, const char *path);

#endif

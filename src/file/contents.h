/* SPDX-License-Identifier: MIT */
/*
 * What whole files hold, which may be somebody else's: whether two hold the same, and a digest.
 */
#ifndef NT_FILE_CONTENTS_H
#define NT_FILE_CONTENTS_H

#include "base/error.h"
#include "ext/digest.h"

/* Whether two files hold the same bytes. False too where one of them cannot be read; NT_ERROR_MEMORY or
 * NT_ERROR_IO where that is the system's fault. */
nt_status nt_same_bytes(const char *a, const char *b, bool *same, nt_error *error);

/* The digest of a file's bytes; empty where it cannot be read. Returns as nt_same_bytes(). */
nt_status nt_digest_of_file(const char *path, char text[NT_DIGEST_TEXT], nt_error *error);

#endif

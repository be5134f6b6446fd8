/* SPDX-License-Identifier: MIT */
/*
 * Looking for files. If a file is missing, a reader may go on; if the system cannot tell, that is an error and never
 * counts as missing.
 */
#ifndef NT_FILE_LOOKUP_H
#define NT_FILE_LOOKUP_H

#include <sys/stat.h>
#include "base/text.h"

/*
 * The status for an errno of looking for a file: NT_ERROR_MISSING for ENOENT and ENOTDIR, and for names that are longer
 * than any file's, or are a folder's; NT_ERROR_MEMORY; else NT_ERROR_IO. The error names the path.
 */
nt_status nt_lookup_failed(const char *path, int number, nt_error *error);

/* Whether a name is longer than any path that the system takes. A function that follows a name step by step asks this
 * first: the steps of a long one take quadratic time. */
bool nt_name_is_too_long(const char *name);

/* stat(). Returns NT_OK or what nt_lookup_failed() says. */
nt_status nt_lookup(const char *path, struct stat *info, nt_error *error);

/* The same, where a file that is missing is no fault and leaves the error alone: *found says which. */
nt_status nt_lookup_found(const char *path, struct stat *info, bool *found, nt_error *error);

/* The entry of a folder that is called `name` in some case (of ASCII), the first in the order of bytes; free(*entry).
 * NULL: there is none, or no such folder. Noted as a search (trace.h). Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_lookup_any_case(
	const char *folder, const char *name, size_t length, char **entry, nt_error *error);

/* Which file it is, by whatever name. Zeroed: none. */
typedef struct nt_file_id {
	uint64_t device, inode;
} nt_file_id;

static inline nt_file_id nt_file_id_of(const struct stat *info)
{
	return (nt_file_id){(uint64_t)info->st_dev, (uint64_t)info->st_ino};
}

static inline bool nt_same_id(nt_file_id a, nt_file_id b)
{
	return a.device == b.device && a.inode == b.inode;
}

static inline bool nt_same_file(const struct stat *a, const struct stat *b)
{
	return nt_same_id(nt_file_id_of(a), nt_file_id_of(b));
}

#endif

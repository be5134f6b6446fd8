/* SPDX-License-Identifier: MIT */
/*
 * Inputs: a file's bytes, mapped. Outputs are in output.h.
 */
#ifndef NT_FILE_INPUT_H
#define NT_FILE_INPUT_H

#include "base/text.h"
#include "ext/digest.h"

/* An input's bytes. */
typedef struct nt_file {
	const unsigned char *data; /* never NULL after success */
	size_t size;
	bool mapped; /* else malloc'ed, unless it is borrowed */
	bool borrowed;
	int watch;   /* of a mapped file: see watch.h */
	int fd;      /* of a mapped file, -1 otherwise */
	uint64_t device, inode; /* which file it is; 0, 0 for standard input */
} nt_file;

/* The one who names a file. */
typedef enum nt_naming {
	NT_NAMED_BY_USER,     /* "-" is standard input; a pipe is read to its end */
	NT_NAMED_BY_DOCUMENT, /* only regular files, for which nobody waits; "-" is a file that is called so */
	NT_NAMED_BY_US        /* no source of what is made, such as an output that is compared: not in the trace */
} nt_naming;

/* Maps a file, or reads it where it cannot be mapped; devices have no end and are refused. If a checkout has only the
 * pointer by which Git LFS stands for the file, NT_ERROR_MISSING says so, but for files of ours. The error carries the
 * name. Returns NT_OK, NT_ERROR_MISSING, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_file_open(nt_file *file, const char *path, nt_naming naming, nt_error *error);

bool nt_is_folder(const char *path);

void nt_file_close(nt_file *file);

/* Bytes of the caller, as a file. */
nt_file nt_file_of_bytes(const unsigned char *bytes, size_t size);

/* Brings the pages of a range of a mapped file in at once, which costs less than a fault for every few of them,
 * and lets go of them again, so that a file that is copied does not fill the memory. Nothing is lost: what is
 * read afterwards comes back. For files that are not mapped, and kernels that cannot, nothing happens. */
void nt_file_fetch(const nt_file *file, size_t offset, size_t size);
void nt_file_release(const nt_file *file, size_t offset, size_t size);

/* Whether the file is as long as when it was opened: reading what is gone gives zeros (watch.h). */
bool nt_file_is_intact(const nt_file *file);

/* Whether path names the file that was opened. */
bool nt_file_is(const nt_file *file, const char *path);

/* ---- files that may be somebody else's ---- */

/* Whether two files hold the same bytes. False too where one of them cannot be read; NT_ERROR_MEMORY or
 * NT_ERROR_IO where that is the system's fault. */
nt_status nt_same_bytes(const char *a, const char *b, bool *same, nt_error *error);

/* The digest of a file's bytes; empty where it cannot be read. Returns as nt_same_bytes(). */
nt_status nt_digest_of_file(const char *path, char text[NT_DIGEST_TEXT], nt_error *error);

#endif

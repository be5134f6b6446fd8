/* SPDX-License-Identifier: MIT */
/*
 * Files that a run reads and writes, noted by those that do it: nt_file_open() and the looking for files (lookup.h)
 * note what is read and what is missing, nt_output_commit() what is written. The caller of a run sets the trace of
 * its thread; functions in between need no argument for it.
 *
 * A later run can tell by it whether it would read the same: nothing that decides on a file goes unnoted.
 */
#ifndef NT_FILE_TRACE_H
#define NT_FILE_TRACE_H

#include <sys/stat.h>
#include "base/hash_index.h"
#include "base/text.h"

typedef enum nt_trace_kind {
	NT_TRACE_READ,
	NT_TRACE_MISSING, /* it was looked for, and would have been read as a regular file */
	NT_TRACE_WRITTEN,
	NT_TRACE_SEARCHED, /* its folder was searched for its name in any case */
	NT_TRACE_LINK,     /* by links on its way, it is another path */
	NT_TRACE_OUTSIDE   /* by links on its way, it leaves a folder */
} nt_trace_kind;

/* A file as it was when it was opened, or as it will be when its set is in place; or a folder as it was searched. */
typedef struct nt_trace_file {
	char *path; /* as the run named it: relative to the current folder, or absolute */
	nt_trace_kind kind;
	char *found; /* SEARCHED: the entry that has the name; LINK: the path; NULL: none. OUTSIDE: the name
	                in the folder */
	uint64_t size, inode;      /* 0 for what is missing */
	int64_t modified, changed; /* nanoseconds since 1970: last change of the bytes, and of the inode */
	int64_t noted;             /* when it was noted */
} nt_trace_file;

/* Which files the runs of a batch have read, so that none of them overwrites what another one reads. Zeroed: none. */
typedef struct nt_readers {
	nt_key_set files;  /* of nt_file_id */
	unsigned *readers; /* of each; 0: several */
	size_t capacity;
	unsigned runs;
} nt_readers;

void nt_readers_free(nt_readers *readers);

/* Zeroed: empty. A file is in it once for each kind, in the order of first use. */
typedef struct nt_trace {
	nt_trace_file *files;
	size_t count, capacity;
	nt_hash_index index;
	bool failed; /* memory ran out: something is not in it */
	nt_readers *readers; /* NULL: nobody wants to know; else what is read is there, too, */
	unsigned reader;     /* as read by this one */
} nt_trace;

/* Shares what the trace notes as read from now on. Once for each run. */
void nt_trace_share(nt_trace *trace, nt_readers *readers);

/* Whether a run that shares with that of the trace that is used has read a file. */
bool nt_trace_is_read_elsewhere(const struct stat *info);

/* From now on this thread notes in `trace`; NULL: nowhere. Returns what it noted in before. Several threads may note
 * in one trace: each that helps a run and opens files has to be lent it. */
nt_trace *nt_trace_use(nt_trace *trace);

/* Notes one. A file that is about to be written has its `info` already. A search has that of the folder in which it
 * looked for the last part of `path`; a link and a file that is missing have none. Nothing happens if no trace is used.
 */
void nt_trace_note(nt_trace_kind kind, const char *path, const char *found, const struct stat *info);

/* Times in nanoseconds since 1970: of the last change of a file's bytes, and of its inode; the present one. */
int64_t nt_trace_modified(const struct stat *info);
int64_t nt_trace_changed(const struct stat *info);
int64_t nt_trace_now(void);

/* Forgets what was written, for a run that is to be done again. */
void nt_trace_forget_written(nt_trace *trace);

void nt_trace_free(nt_trace *trace);

#endif

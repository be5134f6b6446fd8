/* SPDX-License-Identifier: MIT */
/*
 * Records: what outputs were made of, with which options, so that a later run can tell which of them it need not make
 * again, before it reads anything.
 *
 * A record is a file of JSON lines, one for each time an output was made; the last one of an output counts. Several
 * processes may append at once. Files in it are URIs relative to its folder, so that a tree can be moved with its
 * record. A line is
 *
 *   {"output":"a.glb","nmtan":"0.1.0","options":"--method=area","read":[FILE,...],"missing":["a.mtl"],"written":[FILE]}
 *
 * where the first file that was read is the input and FILE is {"uri":"../a.obj","bytes":10,"modified":T,"noted":T}: T
 * are nanoseconds since 1970, and "noted" is when the file was opened. It has "xxh128", the digest of its bytes, where
 * contents are to be compared, and where a file that was read had changed so shortly before that it may have changed
 * again within one tick of its clock.
 *
 * The line is written before the output is renamed. If a run is killed in between, the line does not match the output,
 * which is made again.
 */
#ifndef NT_BATCH_RECORD_H
#define NT_BATCH_RECORD_H

#include "file/trace.h"

/* Whether two names are of one file. */
static inline bool nt_same_file(const struct stat *a, const struct stat *b)
{
	return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* What is compared beside sizes. */
typedef enum nt_update_by { NT_UPDATE_BY_TIME, NT_UPDATE_BY_CONTENT } nt_update_by;

typedef struct nt_record nt_record;

/* Reads a record, which need not be there yet. Lines that cannot be understood are passed over, and with `tidy`
 * superseded ones are taken out of the file when they are many. Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING (no such
 * folder) or NT_ERROR_MEMORY. */
nt_status nt_record_open(nt_record **record, const char *path, bool tidy, nt_error *error);

/* NULL is allowed. */
void nt_record_close(nt_record *record);

typedef enum nt_freshness {
	NT_FRESH_UNKNOWN, /* the record does not know the output */
	NT_FRESH_STALE,   /* something differs, or is gone, or has come */
	NT_FRESH_CURRENT  /* the output would be what it is */
} nt_freshness;

/* How an output is, or is to be, made. */
typedef struct nt_making {
	const char *input, *output; /* files */
	struct stat input_info;     /* of the input */
	const char *options;        /* in words, in one way for each meaning */
	nt_update_by by;
} nt_making;

/* Looks whether everything is as the record says. `trace` receives what was read, missed and written then, with paths
 * that can be opened, when the answer is CURRENT; NULL: not wanted. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_record_look(nt_record *record, const nt_making *making, nt_freshness *freshness, nt_trace *trace,
	nt_error *error);

/* Appends a line for an output that is complete. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_record_append(nt_record *record, const nt_making *making, const nt_trace *trace, nt_error *error);

#endif

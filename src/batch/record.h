/* SPDX-License-Identifier: MIT */
/*
 * Records: what outputs were made of, with which options, so that a later run can tell which of them it need not make
 * again, before it reads anything.
 *
 * A record is a file of JSON lines, one for each time an output was made; the last one of an output counts. Several
 * processes may append at once. Files in it are URIs relative to its folder, so that a tree can be moved with its
 * record. A line is
 *
 *   {"output":"a.glb","nmtan":"0.1.0","options":"--method=area","links":[{"uri":"../in","to":"v1"}],
 *    "read":[FILE,...],"missing":["a.mtl"],"searched":[FOLDER,...],"written":[FILE],"sum":D}
 *
 * where the first file that was read is the input and FILE is {"uri":"../v1/a.obj","bytes":10,STATE,"xxh128":D}.
 * STATE is "modified":T,"changed":T,"inode":N,"noted":T: T are nanoseconds since 1970, of the last change of the bytes,
 * of that of the inode, and of when the file was opened. If the state is another one, or if a file that was read
 * had changed so shortly before that it may have changed again within one tick of its clock, the digests of the bytes
 * decide; when they are equal, a new line notes the new state.
 *
 * URIs go through no links; those that paths went through are in "links". FOLDER is {"uri":"../in/n.png",STATE,
 * "found":"N.PNG"}: it was searched for the last part of the URI in any case, and is again if its state is another one.
 * "judged" is the highest severity of the findings, or "none", and "judging" the options that decide on that; a run
 * that nobody judged has neither.
 * "wrong" is 1 if the output keeps tangents that are known to be wrong: a run that leaves it alone says so again.
 * "sum" is a digest of the line before it. A line without it is damaged, or was written by a version that noted less,
 * and holds for nothing.
 *
 * The line is written before the output is renamed. If a run is killed in between, the line does not match the output,
 * which is made again. The rename changes the inode's time, so that another line follows, with all others of its kind,
 * when the record is closed.
 */
#ifndef NT_BATCH_RECORD_H
#define NT_BATCH_RECORD_H

#include "base/buffer.h"
#include "file/trace.h"

/* Whether two names are of one file. */
static inline bool nt_same_file(const struct stat *a, const struct stat *b)
{
	return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* The comparison beside sizes: the state and, if only the inode changed, digests; or digests alone. */
typedef enum nt_update_by { NT_UPDATE_BY_TIME, NT_UPDATE_BY_CONTENT } nt_update_by;

typedef struct nt_record nt_record;

/* Reads a record, which need not be there yet. Lines that cannot be understood are passed over, and with `tidy`
 * superseded ones are taken out of the file when they are many. Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING (no such
 * folder) or NT_ERROR_MEMORY. */
nt_status nt_record_open(nt_record **record, const char *path, bool tidy, nt_error *error);

/* Writes the lines of files that are the same in another state, if `tidy`, as far as that goes. NULL is allowed. */
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
	/* Findings that fail a run fail it again: an output that was judged by other options, or not at all, is not up
	 * to date. */
	const char *judging; /* options that decide on findings, in words; NULL: nobody judges */
	int least_failure;   /* the nt_severity that fails; above the highest: none does */
	int worst;           /* of what was made: the highest nt_severity of its findings; -1: there are none */
	bool keeps_wrong;    /* and it keeps tangents that are known to be wrong */
} nt_making;

/* Looks whether everything is as the record says; then the answer is CURRENT, making->keeps_wrong is set, and `trace`
 * receives what was read, missed and written, with paths that can be opened; NULL: not wanted. Returns NT_OK,
 * NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_record_look(nt_record *record, nt_making *making, nt_freshness *freshness, nt_trace *trace,
	nt_error *error);

/* Counts outputs of the record that are there although their input is gone, and names the first by name: path is the
 * record's, as it was spelled. Looks only if this run has not looked at every output of the record. */
size_t nt_record_left_over(nt_record *record, const char *path, nt_buffer *first);

/* Appends a line for an output that is complete, and says which. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_record_append(nt_record *record, const nt_making *making, const nt_trace *trace, nt_buffer *line,
	nt_error *error);

/* The output of a line, and what belongs to it, is in place, and judged if `making` says so. */
void nt_record_placed(nt_record *record, const nt_making *making, const nt_buffer *line, const nt_trace *trace);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Doing only what is needed: which outputs are up to date, by the records in their folders or one that is named.
 *
 * A record has JSON lines, one for each time an output was made; the last one of an output counts. Files in it are URIs
 * relative to its folder, so that a tree can be moved with its record. A line is
 *
 *   {"output":"a.glb","nmtan":"0.1.0","options":"--method=area","files":[FILE,...],"sum":"0123456789abcdef"}
 *
 * and a FILE one of these, in the order in which the run met them:
 *
 *   {"read":"../a.obj","bytes":10,"modified":T,"changed":T,"inode":N}   T: nanoseconds since 1970
 *   {"read":"../a.obj","bytes":10,"xxh128":D}         by its digest, with NT_UPDATE_BY_CONTENT
 *   {"read":"../a.gltf"}                              it was written, too, and counts as that
 *   {"written":"a.glb",...}                           as what was read
 *   {"missing":"../a.mtl"}                            it was looked for
 *   {"searched":"../n.png","found":"N.PNG",...}       its folder was, for the name in any case; the folder's times
 *   {"link":"../tex","to":"../v1"}                    what the path is by links; without "to": nothing is there
 *   {"outside":"../in/tex/n.png","to":"tex/n.png"}    this name leaves its folder by links
 *
 * A file that changed so shortly before it was read that it may have changed again within one tick of the clock has
 * a digest, too, and a folder no times: it is searched anew. An output is up to date if all is still so, and was made
 * by this version and these options; if anything cannot be told, it is not. If a line would have other times now,
 * that one follows when the record is closed.
 *
 * "judged" is the highest severity of the findings, or "none", and "judging" the options that decide on that; a run
 * that nobody judged has neither. "wrong" is 1 if the output keeps tangents that are known to be wrong: a run that
 * leaves it alone says so again.
 *
 * The line is written when the output has its name. If a run is killed in between, the output is made again.
 */
#ifndef NT_BATCH_UPDATE_H
#define NT_BATCH_UPDATE_H

#include "batch/record.h"
#include "file/input.h"
#include "pipeline/run.h"

/* The comparison of files: by size, times and inode, or by size and digest. */
typedef enum nt_update_by { NT_UPDATE_BY_TIME, NT_UPDATE_BY_CONTENT } nt_update_by;

typedef struct nt_update_options {
	bool look;           /* leave alone what is up to date; else records are only written */
	nt_update_by by;
	const char *record;  /* the record's file; NULL: .nmtan-record in `folder` */
	const char *folder;  /* that of all outputs; NULL: each output's own */
	bool dry_run;        /* records stay as they are */
	const char *options; /* what shapes outputs, in one way for each meaning */
	/* Findings that fail a run fail it again: an output that was judged by other options, or not at all, is not up
	 * to date. */
	const char *judging; /* options that decide on findings, in words; NULL: nobody judges */
	int least_failure;   /* the nt_severity that fails; above the highest: none does */
} nt_update_options;

/* The records of one batch; for any number of threads. */
typedef struct nt_update nt_update;

/* Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING or NT_ERROR_MEMORY. */
nt_status nt_update_begin(nt_update **update, const nt_update_options *options, nt_error *error);

/* Writes the lines of files that are the same at other times, as far as that goes. NULL is allowed. */
void nt_update_end(nt_update *update);

/* Counts outputs of the records that are there although their input is gone, and names the first by name: beside the
 * record, as that was spelled. Looks only if this run has not looked at every output of a record. NULL is allowed. */
size_t nt_update_left_over(const nt_update *update, nt_buffer *first);

/* One input on its way through the records. */
typedef struct nt_update_job {
	nt_update *update;
	struct nt_open_record *record; /* NULL: the output is a stream, or the input is */
	const char *input, *output;
	struct stat input_info;
	nt_buffer options; /* what shapes this output */
	int worst;         /* of what was made: the highest nt_severity of its findings; -1: there are none */
	bool keeps_wrong;  /* and it keeps tangents that are known to be wrong */
} nt_update_job;

/*
 * Decides whether an output is up to date, without reading the input; job->keeps_wrong says what the record does. If
 * it is not, changes `settings`: an output that has its bytes already will keep its time of change if a record says
 * what it was made of, else get a new one. `job` must live until nt_update_done().
 *
 *   trace  receives what the output was made of, as far as known, with paths that can be opened
 *
 * Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING or NT_ERROR_MEMORY.
 */
nt_status nt_update_look(nt_update *update, const char *input, const char *output, nt_update_job *job,
	nt_settings *settings, bool *current, nt_trace *trace, nt_error *error);

/* The run of a job, or the look at it, has ended; if it was `made`, the record says of what. Returns NT_OK or
 * NT_ERROR_IO, or NT_ERROR_MEMORY from the system. */
nt_status nt_update_done(nt_update_job *job, bool made, const nt_trace *trace, nt_error *error);

#endif

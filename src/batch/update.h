/* SPDX-License-Identifier: MIT */
/*
 * Doing only what is needed: which outputs are up to date, by the records (record.h) in their folders or one that is
 * named, and where those know nothing by the times of change of input and output.
 */
#ifndef NT_BATCH_UPDATE_H
#define NT_BATCH_UPDATE_H

#include "batch/record.h"
#include "pipeline/run.h"

typedef struct nt_update_options {
	bool look;           /* leave alone what is up to date; else records are only written */
	nt_update_by by;
	const char *record;  /* the record's file; NULL: .nmtan-record in `folder` */
	const char *folder;  /* that of all outputs; NULL: each output's own */
	bool dry_run;        /* records stay as they are */
	const char *options; /* what shapes outputs, in words */
	const char *judging; /* as in nt_making */
	int least_failure;
} nt_update_options;

/* The records of one batch; for any number of threads. */
typedef struct nt_update nt_update;

/* Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING or NT_ERROR_MEMORY. */
nt_status nt_update_begin(nt_update **update, const nt_update_options *options, nt_error *error);

/* NULL is allowed. */
void nt_update_end(nt_update *update);

/* The same as nt_record_left_over() of all records; NULL is allowed. */
size_t nt_update_left_over(const nt_update *update, nt_buffer *first);

/* One input on its way through the records. */
typedef struct nt_update_job {
	nt_update *update;
	nt_making making;
	nt_record *record; /* NULL: the output is a stream, or the input is */
	nt_buffer line;    /* that was written to it */
	nt_buffer options; /* of this one, if they differ from those of all */
} nt_update_job;

/*
 * Decides whether an output is up to date, without reading the input. If it is not, changes `settings`: an output that
 * has its bytes already will keep its time of change where a record says what it was made of, else get a new one; and
 * the record will be written when the output is complete. `job` must live until nt_update_done().
 *
 *   trace  receives what the output was made of, as far as known, when it is up to date
 *
 * Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING or NT_ERROR_MEMORY.
 */
nt_status nt_update_look(nt_update *update, const char *input, const char *output, nt_update_job *job,
	nt_settings *settings, bool *current, nt_trace *trace, nt_error *error);

/* The run of a job, or the look at it, has ended, `well` or not; job->making.worst says what it was judged. */
void nt_update_done(nt_update_job *job, bool well, const nt_trace *trace);

#endif

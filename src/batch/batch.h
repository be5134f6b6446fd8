/* SPDX-License-Identifier: MIT */
/*
 * Many inputs: which output each gets (outputs.c), all of them run, several at once, and told about in their order
 * (batch.c).
 *
 * One input has all threads; several inputs share them, which uses a machine better than many threads on one small
 * file after the other. Every input is tried, whatever became of the others, unless the caller wants to stop.
 */
#ifndef NT_BATCH_BATCH_H
#define NT_BATCH_BATCH_H

#include "batch/update.h"
#include "pipeline/run.h"

/* The outcome of an input, while somebody may want to know. */
typedef struct nt_outcome {
	nt_error error; /* when the job's status is not NT_OK */
	nt_summary summary;
} nt_outcome;

/* How a job ended. */
typedef enum nt_job_end {
	NT_JOB_RAN,     /* well or not, as its status says */
	NT_JOB_CURRENT, /* its output was up to date; the summary has the trace, and keeps_wrong */
	NT_JOB_UNTRIED  /* an earlier one failed, and nothing was to be done after that */
} nt_job_end;

/* One input, and what became of it. */
typedef struct nt_job {
	const char *input;
	const char *root; /* the folder of the user's that it is below, for settings.root; NULL: none */
	char *output; /* NULL: nothing is written */
	char *refused; /* why it is not run: a usage error; NULL: it is */
	bool reason_is_told; /* another job is refused for the same reason, and says it */
	nt_outcome *outcome; /* until the job has been told about; NULL: untried, or no memory for it */
	nt_status status;
	nt_job_end end;
	bool ended;
	bool deferred; /* until the others have ended */
} nt_job;

typedef struct nt_batch {
	nt_job *jobs;
	size_t count;
} nt_batch;

/*
 * Prepares one input and its output, or inputs that are checked only (output NULL). The names of inputs
 * must outlive the batch.
 *
 * Returns NT_OK or NT_ERROR_MEMORY. The batch is to be freed after failure too.
 */
nt_status nt_batch_pair(nt_batch *batch, const char *input, const char *output, nt_error *error);
nt_status nt_batch_check(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error);

/*
 * Prepares inputs whose outputs get their names in a folder: the input's name with the ending of
 * settings->output_format; without that .ply for PLY, .gltf for .gltf and .glb for all others. With `tree` (NULL:
 * none), a folder that has all inputs below it, the name below the output folder is the input's name below that one.
 * The folder is made when it is missing (not in a dry run), with its parents, and those below it that are needed.
 *
 * Jobs that would have the same output, and those whose output would replace another input, are refused.
 * Nothing runs when an input is not below `tree`: NT_ERROR_USAGE. Else NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY.
 */
nt_status nt_batch_into(nt_batch *batch, const char *const *inputs, size_t count, const char *directory,
	const char *tree, const nt_settings *settings, nt_error *error);

/* Prepares inputs that are replaced by their outputs. Jobs are refused whose input is there twice, also by another
 * name. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_batch_in_place(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error);

/* The function that runs a job: nt_run, or something else in tests. */
typedef nt_status (*nt_runner)(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error);

/* How the jobs of a batch are run. */
typedef struct nt_batch_options {
	nt_runner run;
	unsigned jobs;  /* so many at a time; 0: as many as there are threads */
	/* Bytes that jobs at a time may need together, as need.h guesses; who needs more runs alone, with all threads.
	 * 0: half of what is available. */
	uint64_t memory;
	nt_update *update; /* what is up to date is left alone, and records are written; NULL: every input runs */
	bool fail_fast; /* after a failure no further job begins */
	/* Called once per job, in the order of the inputs, by one thread at a time, as soon as the job and all before
	 * it have ended. It may take the summary's report, leaving NULL. */
	void (*done)(void *user, nt_job *job);
	/* Called before that as soon as a job has ended, by one thread at a time; NULL: nobody wants to know. */
	void (*ended)(void *user, const nt_job *job);
	void *user;
} nt_batch_options;

/* Runs all jobs: files first, then what is read from pipes and sockets. */
void nt_batch_run(nt_batch *batch, const nt_settings *settings, const nt_batch_options *options);

void nt_batch_free(nt_batch *batch);

#endif

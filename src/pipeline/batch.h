/* SPDX-License-Identifier: MIT */
/*
 * Many inputs: which output each gets, all of them run, several at once, and told about in their order.
 *
 * One input has all threads; several inputs have one thread each, which uses a machine better than
 * many threads on one small file. Every input is tried, whatever became of the others.
 */
#ifndef NT_PIPELINE_BATCH_H
#define NT_PIPELINE_BATCH_H

#include "pipeline/run.h"

/* One input, and what became of it. */
typedef struct nt_job {
	const char *input;
	char *output; /* NULL: nothing is written */
	nt_status status;
	nt_error error;     /* when status is not NT_OK */
	nt_summary summary; /* until the job has been told about */
	bool finished;
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
 * settings->output_format; without that .ply for PLY, .gltf for .gltf and .glb for all others. The
 * folder is made when it is missing (not its parents, and not in a dry run).
 *
 * Nothing runs when two inputs would have the same output, or when an output would replace another
 * input: NT_ERROR_USAGE. Else NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY.
 */
nt_status nt_batch_into(nt_batch *batch, const char *const *inputs, size_t count,
	const char *directory, const nt_settings *settings, nt_error *error);

/* Prepares inputs that are replaced by their outputs. Nothing runs when one of them is there twice, also by another
 * name: NT_ERROR_USAGE. Else NT_OK or NT_ERROR_MEMORY. */
nt_status nt_batch_in_place(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error);

/* What runs a job: nt_run, or something else in tests. */
typedef nt_status (*nt_runner)(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error);

/* Runs all jobs. `done` is called once per job, in the order of the inputs, by one thread at a time, as
 * soon as the job and all before it have ended. It may take the summary's report, leaving NULL. */
void nt_batch_run(nt_batch *batch, const nt_settings *settings, nt_runner run,
	void (*done)(void *user, nt_job *job), void *user);

void nt_batch_free(nt_batch *batch);

#endif

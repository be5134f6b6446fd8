/* SPDX-License-Identifier: MIT */
/*
 * Many inputs: see batch.h. Jobs are handed out one by one, since files differ in size; each that ends
 * opens the way for those after it to be told about.
 */
#include "pipeline/batch.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/buffer.h"
#include "base/parallel.h"
#include "format/format.h"

static nt_status make_jobs(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error)
{
	*batch = (nt_batch){.jobs = nt_calloc(count, sizeof *batch->jobs)};
	if (!batch->jobs)
		return nt_fail_memory(error);
	batch->count = count;
	for (size_t i = 0; i < count; i++)
		batch->jobs[i].input = inputs[i];
	return NT_OK;
}

nt_status nt_batch_check(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error)
{
	return make_jobs(batch, inputs, count, error);
}

nt_status nt_batch_pair(nt_batch *batch, const char *input, const char *output, nt_error *error)
{
	const nt_status status = make_jobs(batch, &input, 1, error);
	if (status)
		return status;
	batch->jobs[0].output = strdup(output);
	return batch->jobs[0].output ? NT_OK : nt_fail_memory(error);
}

/* By the name, which needs no look into the file; by content where the name says nothing. */
static nt_format input_format(const char *path)
{
	const nt_format_entry *entry = nt_format_of_path(path);
	nt_file file;
	nt_error ignored; /* the run will meet it again, and say it */
	struct stat info;
	/* A pipe could be read once only. */
	if (!entry && stat(path, &info) == 0 && S_ISREG(info.st_mode) &&
		nt_file_open(&file, path, &ignored) == NT_OK) {
		entry = nt_format_of_input(file.data, file.size, path);
		nt_file_close(&file);
	}
	return entry ? entry->format : NT_FORMAT_UNKNOWN;
}

static const char *output_ending(const char *input, nt_format wanted)
{
	switch (wanted == NT_FORMAT_UNKNOWN ? input_format(input) : wanted) {
	case NT_FORMAT_PLY:
		return ".ply";
	case NT_FORMAT_GLTF:
		return ".gltf";
	default:
		return ".glb";
	}
}

/* DIR/name.ending: the input's ending goes if it is one of a format ("head.v2" keeps its own). */
static char *output_name(const char *input, const char *directory, nt_format wanted)
{
	const char *slash = strrchr(input, '/');
	const char *base = slash ? slash + 1 : input;
	const char *dot = strrchr(base, '.');
	const size_t stem = dot && dot != base && nt_format_of_path(base) ? (size_t)(dot - base)
									   : strlen(base);
	const size_t length = strlen(directory);
	nt_buffer name = {0};
	nt_buffer_text(&name, directory);
	if (length && directory[length - 1] != '/')
		nt_buffer_text(&name, "/");
	nt_buffer_append(&name, base, stem);
	nt_buffer_text(&name, output_ending(input, wanted));
	if (name.failed)
		nt_buffer_free(&name);
	return name.data;
}

static int compare_outputs(const void *a, const void *b)
{
	const nt_job *x = *(const nt_job *const *)a, *y = *(const nt_job *const *)b;
	const int order = strcmp(x->output, y->output);
	return order ? order : (x > y) - (x < y);
}

static nt_status refuse_equal_outputs(const nt_batch *batch, nt_error *error)
{
	const nt_job **sorted = nt_alloc(batch->count, sizeof(const nt_job *));
	if (!sorted)
		return nt_fail_memory(error);
	for (size_t i = 0; i < batch->count; i++)
		sorted[i] = &batch->jobs[i];
	qsort(sorted, batch->count, sizeof(const nt_job *), compare_outputs);
	nt_status status = NT_OK;
	for (size_t i = 1; i < batch->count && !status; i++)
		if (strcmp(sorted[i - 1]->output, sorted[i]->output) == 0)
			status = nt_fail(error, NT_ERROR_USAGE, "'%s' and '%s' would both be written to '%s'",
				sorted[i - 1]->input, sorted[i]->input, sorted[i]->output);
	free(sorted);
	return status;
}

typedef struct identity {
	dev_t device;
	ino_t inode;
	size_t job;
} identity;

static int compare_identities(const void *a, const void *b)
{
	const identity *x = a, *y = b;
	if (x->device != y->device)
		return x->device < y->device ? -1 : 1;
	return (x->inode > y->inode) - (x->inode < y->inode);
}

/* An output that is a file already must not be the input of another job: who reads it when? Its own
 * input is nt_run's affair. */
static nt_status refuse_foreign_inputs(const nt_batch *batch, nt_error *error)
{
	identity *inputs = nt_alloc(batch->count, sizeof *inputs);
	if (!inputs)
		return nt_fail_memory(error);
	size_t count = 0;
	struct stat info;
	for (size_t i = 0; i < batch->count; i++)
		if (stat(batch->jobs[i].input, &info) == 0)
			inputs[count++] = (identity){info.st_dev, info.st_ino, i};
	qsort(inputs, count, sizeof *inputs, compare_identities);
	nt_status status = NT_OK;
	for (size_t i = 0; i < batch->count && !status; i++) {
		if (stat(batch->jobs[i].output, &info) != 0)
			continue;
		const identity key = {info.st_dev, info.st_ino, i};
		const identity *found = bsearch(&key, inputs, count, sizeof *inputs, compare_identities);
		if (found && found->job != i && strcmp(batch->jobs[found->job].input, batch->jobs[i].input))
			status = nt_fail(error, NT_ERROR_USAGE,
				"'%s' would be written to '%s', which is the input '%s'", batch->jobs[i].input,
				batch->jobs[i].output, batch->jobs[found->job].input);
	}
	free(inputs);
	return status;
}

static nt_status make_folder(const char *directory, const nt_settings *settings, nt_error *error)
{
	struct stat info;
	if (stat(directory, &info) == 0) {
		if (S_ISDIR(info.st_mode))
			return NT_OK;
		nt_fail(error, NT_ERROR_IO, "is not a folder");
		return nt_error_in_file(error, directory);
	}
	if (settings->dry_run)
		return NT_OK;
	if (mkdir(directory, 0777) == 0)
		return settings->sync ? nt_output_sync_name(directory, error) : NT_OK;
	nt_fail(error, NT_ERROR_IO, "cannot make the folder: %s", strerror(errno));
	return nt_error_in_file(error, directory);
}

nt_status nt_batch_into(nt_batch *batch, const char *const *inputs, size_t count,
	const char *directory, const nt_settings *settings, nt_error *error)
{
	nt_status status = make_jobs(batch, inputs, count, error);
	if (status)
		return status;
	for (size_t i = 0; i < count; i++) {
		batch->jobs[i].output = output_name(inputs[i], directory, settings->output_format);
		if (!batch->jobs[i].output)
			return nt_fail_memory(error);
	}
	status = refuse_equal_outputs(batch, error);
	if (!status)
		status = refuse_foreign_inputs(batch, error);
	return status ? status : make_folder(directory, settings, error);
}

nt_status nt_batch_in_place(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error)
{
	nt_status status = make_jobs(batch, inputs, count, error);
	for (size_t i = 0; i < count && !status; i++) {
		batch->jobs[i].output = strdup(inputs[i]);
		status = batch->jobs[i].output ? NT_OK : nt_fail_memory(error);
	}
	if (!status)
		status = refuse_equal_outputs(batch, error);
	return status ? status : refuse_foreign_inputs(batch, error);
}

/* Shared by the threads of one batch. */
typedef struct progress {
	nt_batch *batch;
	const nt_settings *settings;
	nt_runner run;
	pthread_mutex_t lock; /* of what follows */
	size_t told;          /* jobs before this one have been told about */
	void (*done)(void *user, nt_job *job);
	void *user;
} progress;

static void run_job(nt_job *job, const nt_settings *settings, nt_runner run)
{
	nt_error_clear(&job->error);
	job->status = run(job->input, job->output, settings, &job->summary, &job->error);
}

static void tell(progress *p, nt_job *ended)
{
	pthread_mutex_lock(&p->lock);
	ended->finished = true;
	for (; p->told < p->batch->count && p->batch->jobs[p->told].finished; p->told++) {
		nt_job *job = &p->batch->jobs[p->told];
		p->done(p->user, job);
		nt_summary_free(&job->summary);
	}
	pthread_mutex_unlock(&p->lock);
}

static void run_one(void *context, size_t item, unsigned slot)
{
	(void)slot;
	progress *p = context;
	nt_job *job = &p->batch->jobs[item];
	run_job(job, p->settings, p->run);
	tell(p, job);
}

void nt_batch_run(nt_batch *batch, const nt_settings *settings, nt_runner run,
	void (*done)(void *user, nt_job *job), void *user)
{
	nt_settings each = *settings;
	if (batch->count > 1)
		each.threads = 1;
	progress p = {.batch = batch, .settings = &each, .run = run, .lock = PTHREAD_MUTEX_INITIALIZER,
		.done = done, .user = user};
	nt_parallel_items(nt_thread_count(settings->threads), batch->count, run_one, &p);
	pthread_mutex_destroy(&p.lock);
}

void nt_batch_free(nt_batch *batch)
{
	for (size_t i = 0; i < batch->count; i++)
		free(batch->jobs[i].output);
	free(batch->jobs);
	*batch = (nt_batch){0};
}

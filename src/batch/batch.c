/* SPDX-License-Identifier: MIT */
/*
 * Many inputs: see batch.h. Jobs are handed out one by one, since files differ in size; each that ends
 * opens the way for those after it to be told about.
 */
#include "batch/batch.h"

#include <malloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "batch/inside.h"

/* Shared by the threads of one batch. */
typedef struct progress {
	nt_batch *batch;
	const nt_settings *settings;
	const nt_batch_options *options;
	unsigned threads;     /* of all jobs */
	unsigned jobs;        /* at a time */
	nt_gate gate;         /* where several run at a time */
	pthread_mutex_t lock; /* of what follows */
	size_t told;          /* jobs before this one have been told about */
	bool deferred;        /* some jobs are for the second round */
	bool stop;            /* no further job begins */
} progress;

/* A run that goes through the gate once its input has been read. */
typedef struct stream_run {
	nt_gate *gate;
	bool inside;
} stream_run;

static void enter_once_read(void *user, nt_stage stage)
{
	stream_run *r = user;
	if (stage == NT_STAGE_MAP || r->inside)
		return;
	nt_gate_enter(r->gate, UINT64_MAX);
	r->inside = true;
}

static nt_status run(progress *p, nt_job *job, nt_settings *settings)
{
	if (settings->max_memory)
		settings->need = nt_need_of(job->input, settings, 0);
	return p->options->run(job->input, job->output, settings, &job->outcome->summary, &job->outcome->error);
}

/* Nothing is known of it before it has been read, so that it runs alone. */
static nt_status run_stream(progress *p, nt_job *job, nt_settings *settings)
{
	stream_run r = {.gate = &p->gate};
	settings->on_stage = enter_once_read;
	settings->on_stage_user = &r;
	settings->io.threads = p->threads;
	nt_pool_reserve(p->jobs - 1 + p->threads - 1);
	const nt_status status = run(p, job, settings);
	if (r.inside)
		nt_gate_leave(&p->gate, UINT64_MAX);
	return status;
}

/* Once more, when nobody else runs. */
static nt_status run_alone(progress *p, nt_job *job, nt_settings *settings)
{
	nt_gate_enter(&p->gate, UINT64_MAX);
	nt_summary_free(&job->outcome->summary);
	job->outcome->summary = (nt_summary){0};
	const nt_status status = run(p, job, settings);
	nt_gate_leave(&p->gate, UINT64_MAX);
	return status;
}

/* Runs it when there is memory for it; one that has it all has all threads, too. */
static nt_status run_with_memory(progress *p, nt_job *job, nt_settings *settings)
{
	if (p->jobs <= 1)
		return run(p, job, settings);
	if (job->deferred)
		return run_stream(p, job, settings);
	const uint64_t need = nt_need_of(job->input, settings, p->gate.limit / p->jobs);
	const bool alone = nt_gate_enter(&p->gate, need);
	if (alone) {
		settings->io.threads = p->threads;
		nt_pool_reserve(p->jobs - 1 + p->threads - 1); /* the others wait */
	}
	/* too little beside others is no limit yet; what one needs that had all of it is not there */
	const uint64_t most = settings->max_memory;
	settings->max_memory = alone ? most : 0;
	nt_status status = run(p, job, settings);
	settings->max_memory = most;
	nt_gate_leave(&p->gate, need);
	if (status == NT_ERROR_MEMORY && !alone)
		status = run_alone(p, job, settings);
	return status;
}

/* Runs it unless it is up to date. */
static nt_status run_if_needed(progress *p, nt_job *job)
{
	const nt_batch_options *options = p->options;
	nt_outcome *outcome = job->outcome;
	nt_settings own = *p->settings;
	own.root = job->root;
	nt_update_job updated = {0};
	bool current = false;
	nt_status status = NT_OK;
	nt_error_clear(&outcome->error);
	if (options->update && job->output)
		status = nt_update_look(options->update, job->input, job->output, &updated, &own, &current,
			&outcome->summary.trace, &outcome->error);
	if (current) {
		job->end = NT_JOB_CURRENT;
		outcome->summary.keeps_wrong = updated.keeps_wrong;
	}
	const bool runs = !status && !current;
	if (runs) {
		nt_trace_free(&outcome->summary.trace);
		status = run_with_memory(p, job, &own);
	}
	nt_severity worst;
	if (runs && outcome->summary.report && nt_report_worst(outcome->summary.report, &worst))
		updated.worst = (int)worst;
	updated.keeps_wrong = outcome->summary.keeps_wrong;
	const nt_status done = nt_update_done(&updated, runs && !status, &outcome->summary.trace, &outcome->error);
	return status ? status : done;
}

static void tell(progress *p, nt_job *ended)
{
	pthread_mutex_lock(&p->lock);
	ended->ended = true;
	p->stop |= ended->status && p->options->fail_fast;
	if (p->options->ended)
		p->options->ended(p->options->user, ended);
	for (; p->told < p->batch->count && p->batch->jobs[p->told].ended; p->told++) {
		nt_job *job = &p->batch->jobs[p->told];
		p->options->done(p->options->user, job);
		if (job->outcome)
			nt_summary_free(&job->outcome->summary);
		free(job->outcome);
		job->outcome = NULL;
	}
	pthread_mutex_unlock(&p->lock);
}

static nt_status tell_refusal(const progress *p, nt_job *job)
{
	nt_outcome *outcome = job->outcome;
	nt_fail(&outcome->error, NT_ERROR_USAGE, "%s", job->refused);
	if (p->settings->report)
		outcome->summary.report = nt_report_of_error(job->input, NULL, p->settings->report, &outcome->error);
	return NT_ERROR_USAGE;
}

static void run_one(progress *p, nt_job *job)
{
	pthread_mutex_lock(&p->lock);
	const bool stopped = p->stop && !job->refused;
	pthread_mutex_unlock(&p->lock);
	if (stopped)
		job->end = NT_JOB_UNTRIED;
	else
		job->outcome = nt_calloc(1, sizeof *job->outcome);
	if (!stopped)
		job->status = !job->outcome ? NT_ERROR_MEMORY
			: job->refused      ? tell_refusal(p, job)
					    : run_if_needed(p, job);
	if (job->status == NT_ERROR_MEMORY && p->settings->max_memory)
		job->status = nt_fail_memory_limit(p->settings->max_memory, job->outcome ? &job->outcome->error : NULL);
	tell(p, job);
}

static void run_file(void *context, size_t item, unsigned slot)
{
	(void)slot;
	progress *p = context;
	nt_job *job = &p->batch->jobs[item];
	struct stat info;
	/* a stream waits for who writes it, perhaps for ever */
	job->deferred = p->batch->count > 1 && !job->refused && (strcmp(job->input, "-") == 0 ||
		(stat(job->input, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode))));
	if (!job->deferred) {
		run_one(p, job);
		return;
	}
	pthread_mutex_lock(&p->lock);
	p->deferred = true;
	pthread_mutex_unlock(&p->lock);
}

static void run_deferred(void *context, size_t item, unsigned slot)
{
	(void)slot;
	progress *p = context;
	if (p->batch->jobs[item].deferred)
		run_one(p, &p->batch->jobs[item]);
}

void nt_batch_run(nt_batch *batch, const nt_settings *settings, const nt_batch_options *options)
{
	const unsigned threads = nt_thread_count(settings->io.threads);
	unsigned jobs = options->jobs ? options->jobs : threads;
	if (jobs > batch->count)
		jobs = (unsigned)batch->count;
	nt_readers readers = {0};
	nt_settings each = *settings;
	each.readers = batch->count > 1 ? &readers : NULL;
	if (jobs)
		each.io.threads = threads / jobs ? threads / jobs : 1;
	progress p = {.batch = batch, .settings = &each, .options = options, .threads = threads, .jobs = jobs,
		.lock = PTHREAD_MUTEX_INITIALIZER};
#ifdef M_TRIM_THRESHOLD
	/* malloc() has a heap for each thread, which may keep up to 64 MB of what that has freed, while the next job's
	 * thread takes new: four jobs in turn took twice as much as one. Its default, which gives back every 128 KB,
	 * costs a mesh of 6000 triangles a tenth of its time. */
	mallopt(M_MMAP_THRESHOLD, 4 << 20);
	mallopt(M_TRIM_THRESHOLD, 1 << 20);
#endif
	/* one job at a time needs no gate: what is available is in six files of the system */
	nt_gate_init(&p.gate, options->memory ? options->memory : settings->max_memory ? settings->max_memory
		: jobs > 1 ? nt_memory_available() / 2 : 0);
	/* nothing begins where something has failed already */
	for (size_t i = 0; i < batch->count && options->fail_fast; i++)
		p.stop |= batch->jobs[i].refused != NULL;
	/* streams come last: a job for each could wait while no file is done */
	nt_parallel_items(jobs, batch->count, run_file, &p);
	if (p.deferred)
		nt_parallel_items(jobs, batch->count, run_deferred, &p);
	nt_gate_end(&p.gate);
	nt_readers_free(&readers);
	pthread_mutex_destroy(&p.lock);
}

/* SPDX-License-Identifier: MIT */
/*
 * Doing only what is needed: see update.h.
 */
#include "batch/update.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/buffer.h"
#include "base/memory.h"
#include "file/lookup.h"
#include "file/relative_path.h"

static const char record_name[] = ".nmtan-record";

typedef struct open_record {
	char *path;
	nt_record *record;
} open_record;

struct nt_update {
	nt_update_options options;
	pthread_mutex_t lock; /* of what follows */
	open_record *records;
	size_t count, capacity;
	nt_hash_index index; /* by path */
};

/* ---- records ---- */

/* Takes the path over. */
static nt_status open_one(nt_update *update, uint64_t hash, char *path, nt_record **record, nt_error *error)
{
	nt_status status = nt_record_open(record, path, !update->options.dry_run, error);
	if (!status &&
		(!nt_grow((void **)&update->records, &update->capacity, update->count + 1, sizeof *update->records) ||
			       !nt_hash_index_add(&update->index, hash, (uint32_t)update->count))) {
		nt_record_close(*record);
		status = nt_fail_memory(error);
	}
	if (status) {
		free(path);
		return status;
	}
	update->records[update->count++] = (open_record){path, *record};
	return NT_OK;
}

/* The record of a path, opened by the first who asks for it. */
static nt_status get(nt_update *update, char *path, nt_record **record, nt_error *error)
{
	const uint64_t hash = nt_hash_bytes(0, path, strlen(path));
	pthread_mutex_lock(&update->lock);
	nt_status status = NT_OK;
	size_t at = NT_HASH_BEGIN;
	*record = NULL;
	for (uint32_t i; !*record && (i = nt_hash_index_next(&update->index, hash, &at)) != UINT32_MAX;)
		if (strcmp(update->records[i].path, path) == 0)
			*record = update->records[i].record;
	if (*record)
		free(path);
	else
		status = open_one(update, hash, path, record, error);
	pthread_mutex_unlock(&update->lock);
	return status;
}

static nt_status get_of_output(nt_update *update, const char *output, nt_record **record, nt_error *error)
{
	const nt_update_options *o = &update->options;
	if (o->record) {
		char *path = strdup(o->record);
		return path ? get(update, path, record, error) : nt_fail_memory(error);
	}
	/* of a folder, named with its slash or by nothing */
	const char *slash = strrchr(output, '/'), *folder = o->folder ? o->folder : output;
	const size_t length = o->folder ? strlen(folder) : slash ? (size_t)(slash - output) + 1 : 0;
	nt_buffer path = {0};
	nt_buffer_append(&path, folder, length);
	nt_buffer_format(&path, "%s%s", length && folder[length - 1] != '/' ? "/" : "", record_name);
	return path.failed ? nt_fail_memory(error) : get(update, path.data, record, error);
}

nt_status nt_update_begin(nt_update **update, const nt_update_options *options, nt_error *error)
{
	nt_record *record;
	*update = nt_calloc(1, sizeof **update);
	if (!*update)
		return nt_fail_memory(error);
	(*update)->options = *options;
	pthread_mutex_init(&(*update)->lock, NULL);
	/* the only one can be refused before anything runs; the folder of -d may be still to come, in a dry run */
	if (options->record) {
		struct stat info;
		const char *slash = strrchr(options->record, '/');
		char *folder = slash ? strndup(options->record, (size_t)(slash - options->record) + 1) : strdup("./");
		const nt_status status = folder ? nt_lookup(folder, &info, error) : nt_fail_memory(error);
		free(folder);
		if (status)
			return status;
	}
	return options->record || options->folder ? get_of_output(*update, "", &record, error) : NT_OK;
}

void nt_update_end(nt_update *update)
{
	if (!update)
		return;
	for (size_t i = 0; i < update->count; i++) {
		free(update->records[i].path);
		nt_record_close(update->records[i].record);
	}
	free(update->records);
	nt_hash_index_free(&update->index);
	pthread_mutex_destroy(&update->lock);
	free(update);
}

size_t nt_update_left_over(const nt_update *update, nt_buffer *first)
{
	size_t count = 0;
	for (size_t i = 0; update && i < update->count; i++) {
		nt_buffer name = {0};
		count += nt_record_left_over(update->records[i].record, update->records[i].path, &name);
		if (!first->size && name.size)
			nt_buffer_text(first, name.data);
		nt_buffer_free_into(&name, first);
	}
	return count;
}

/* ---- one output ---- */

static nt_status append(void *user, const nt_trace *trace, nt_error *error)
{
	nt_update_job *job = user;
	return nt_record_append(job->record, &job->making, trace, &job->line, error);
}

void nt_update_done(nt_update_job *job, bool well, const nt_trace *trace)
{
	if (well && job->record)
		nt_record_placed(job->record, &job->making, &job->line, trace);
	nt_buffer_free(&job->line);
	nt_buffer_free(&job->options);
}

/* Subjects of a record: regular files, of which the output need not be there yet. */
static nt_status look_at_files(const nt_making *making, struct stat *input, struct stat *output, bool *regular,
	bool *made, nt_error *error)
{
	*regular = *made = false;
	if (strcmp(making->input, "-") == 0 || strcmp(making->output, "-") == 0)
		return NT_OK;
	nt_status status = nt_lookup_found(making->input, input, regular, error);
	if (!status)
		status = nt_lookup_found(making->output, output, made, error);
	*regular = *regular && S_ISREG(input->st_mode) && (!*made || S_ISREG(output->st_mode));
	return status;
}

nt_status nt_update_look(nt_update *update, const char *input, const char *output, nt_update_job *job,
	nt_settings *settings, bool *current, nt_trace *trace, nt_error *error)
{
	const nt_update_options *o = &update->options;
	struct stat output_info;
	bool regular, made;
	*job = (nt_update_job){.update = update,
		.making = {.input = input, .output = output, .options = o->options, .by = o->by,
			.judging = o->judging, .least_failure = o->least_failure, .worst = -1}};
	*current = false;
	nt_status status;
	/* images may lie below it */
	if (settings->root) {
		nt_buffer_format(&job->options, "%s%s--keep-tree=", o->options, *o->options ? " " : "");
		status = nt_path_absolute(&job->options, settings->root, error);
		if (status || job->options.failed)
			return status ? status : nt_fail_memory(error);
		job->making.options = job->options.data;
	}
	status = look_at_files(&job->making, &job->making.input_info, &output_info, &regular, &made, error);
	if (status || !regular)
		return status;
	nt_freshness freshness = NT_FRESH_STALE;
	status = get_of_output(update, output, &job->record, error);
	if (!status && o->look && made)
		status = nt_record_look(job->record, &job->making, &freshness, trace, error);
	if (status)
		return status;
	*current = o->look && freshness == NT_FRESH_CURRENT;
	if (o->look && settings->equal == NT_EQUAL_REPLACE)
		settings->equal = freshness == NT_FRESH_UNKNOWN ? NT_EQUAL_TOUCH : NT_EQUAL_KEEP;
	settings->placing = append;
	settings->placing_user = job;
	return NT_OK;
}

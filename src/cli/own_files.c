/* SPDX-License-Identifier: MIT */
/*
 * Files beside the outputs: see options.h. A file is known by its inode, one that is not there by the folder in which
 * it may come to be.
 */
#include "cli/options.h"

#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include "file/input.h"
#include "file/output.h"
#include "file/path.h"

typedef struct own_file {
	const char *option, *path;
	nt_buffer key;
} own_file;

static bool is_named(const char *path)
{
	return path && strcmp(path, "-") != 0;
}

/* The key of the file that a path names, by links of any kind. Empty: it is a pipe or a device, which may be named
 * twice, or opening it will fail. */
static nt_status identify(const char *path, nt_buffer *key, nt_error *error)
{
	struct stat info;
	nt_error failure;
	nt_status status = NT_OK;
	key->size = 0;
	if (stat(path, &info) != 0)
		status = nt_path_place(key, path, &failure);
	else if (S_ISREG(info.st_mode))
		nt_buffer_format(key, "%" PRIu64 " %" PRIu64, (uint64_t)info.st_dev, (uint64_t)info.st_ino);
	if (key->failed || status == NT_ERROR_MEMORY)
		return nt_fail_memory(error);
	key->size = status ? 0 : key->size;
	return NT_OK;
}

static bool is_there(const own_file *own)
{
	return own->key.size && own->key.data[0] != '/';
}

/* Whether a path names the file. */
static bool is_own(const own_file *own, const char *path, nt_error *error)
{
	nt_buffer key = {0};
	if (!own->key.size || (!is_there(own) && strcmp(nt_last_part(own->path), nt_last_part(path)) != 0))
		return false;
	const bool same = !identify(path, &key, error) && key.size == own->key.size &&
		memcmp(key.data, own->key.data, key.size) == 0;
	nt_buffer_free(&key);
	return same;
}

static nt_status check_jobs(const own_file *own, const nt_batch *batch, nt_error *error)
{
	for (size_t i = 0; i < batch->count && !error->status; i++) {
		const nt_job *job = &batch->jobs[i];
		if (job->output && is_own(own, job->output, error))
			nt_fail(error, NT_ERROR_USAGE, "%s and an output are both '%s'", own->option, own->path);
		else if (is_there(own) && !error->status && is_own(own, job->input, error))
			nt_fail_file(error, NT_ERROR_IO, own->path,
				"refusing to write: it is the same file as the input %s", job->input);
	}
	return error->status;
}

nt_status nt_own_files_check(const nt_command *c, const nt_batch *batch, bool report_is_folder, nt_error *error)
{
	enum { REPORT, MANIFEST, DEPFILE, RECORD, OUTPUT, COUNT };
	/* an output has its own words for an input, and may be one */
	const bool is_pair = !nt_command_is_many(c) && c->operand_count == 2;
	own_file own[COUNT] = {{"--report", c->report, {0}}, {"--manifest", c->manifest, {0}},
		{"--depfile", c->depfile, {0}}, {"--record", c->record, {0}},
		{"an output", is_pair ? c->operands[1] : NULL, {0}}};
	const nt_output_options options = {.no_clobber = c->settings.no_clobber};
	nt_error_clear(error);
	for (int i = 0; i < COUNT && !error->status; i++) {
		if (!is_named(own[i].path) || identify(own[i].path, &own[i].key, error))
			continue;
		for (int k = 0; k < i && !error->status; k++)
			if (is_own(&own[k], own[i].path, error))
				nt_fail(error, NT_ERROR_USAGE, "%s and %s are both '%s'", own[k].option, own[i].option,
					own[i].path);
		if (batch && i != OUTPUT && !error->status)
			check_jobs(&own[i], batch, error);
	}
	static const int order[] = {DEPFILE, MANIFEST, REPORT};
	for (size_t i = 0; i < sizeof order / sizeof *order && batch && !error->status; i++) {
		const char *path = own[order[i]].path;
		if (is_named(path) && !(order[i] == REPORT && report_is_folder) &&
			!nt_output_check_folder(path, error))
			nt_output_check_clobber(&options, path, error);
	}
	for (int i = 0; i < COUNT; i++)
		nt_buffer_free(&own[i].key);
	return error->status;
}

nt_status nt_own_file_check_trace(const char *path, const nt_trace *trace, nt_error *error)
{
	struct stat own, other;
	if (!is_named(path) || stat(path, &own) != 0)
		return NT_OK;
	for (size_t i = 0; i < trace->count; i++) {
		const nt_trace_file *file = &trace->files[i];
		if (stat(file->path, &other) == 0 && nt_same_file(&own, &other))
			return nt_fail_file(error, NT_ERROR_IO, path,
				"refusing to write: it is the same file as the %s %s",
				file->kind == NT_TRACE_WRITTEN ? "output" : "input", file->path);
	}
	return NT_OK;
}

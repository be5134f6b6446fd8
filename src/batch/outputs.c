/* SPDX-License-Identifier: MIT */
/*
 * Which output each of many inputs gets: see batch.h. Everything that can be refused is refused before anything runs,
 * and the other jobs go on.
 */
#include "batch/batch.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/text.h"
#include "file/input.h"
#include "file/path.h"
#include "format/format.h"
#include "report/report.h"

nt_status nt_batch_check(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error)
{
	*batch = (nt_batch){.jobs = nt_calloc(count, sizeof *batch->jobs)};
	if (!batch->jobs)
		return nt_fail_memory(error);
	batch->count = count;
	for (size_t i = 0; i < count; i++)
		batch->jobs[i].input = inputs[i];
	return NT_OK;
}

nt_status nt_batch_pair(nt_batch *batch, const char *input, const char *output, nt_error *error)
{
	const nt_status status = nt_batch_check(batch, &input, 1, error);
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
		nt_file_open(&file, path, NT_NAMED_BY_USER, &ignored) == NT_OK) {
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

/* DIR/below.ending: the input's ending goes if it is one of a format ("head.v2" keeps its own). `below` is the end of
 * the input's name that is kept. */
static char *output_name(const char *input, const char *below, const char *directory, nt_format wanted)
{
	const char *base = nt_last_part(below), *dot = strrchr(base, '.');
	const size_t stem = dot && dot != base && nt_format_of_path(base) ? (size_t)(dot - below) : strlen(below);
	const size_t length = strlen(directory);
	nt_buffer name = {0};
	nt_buffer_text(&name, directory);
	if (length && directory[length - 1] != '/')
		nt_buffer_text(&name, "/");
	nt_buffer_append(&name, below, stem);
	nt_buffer_text(&name, output_ending(input, wanted));
	if (name.failed)
		nt_buffer_free(&name);
	return name.data;
}

static int compare_outputs(const void *a, const void *b)
{
	const nt_job *x = *(const nt_job *const *)a, *y = *(const nt_job *const *)b;
	const int loosely = strcasecmp(x->output, y->output), order = loosely ? loosely : strcmp(x->output, y->output);
	return order ? order : (x > y) - (x < y);
}

/* Whether one file has names that differ by case; asked where the input is, since outputs may not be there. */
static bool ignores_case(const char *input)
{
	struct stat one, other;
	char *changed = strdup(input);
	for (char *c = changed ? changed + (nt_last_part(input) - input) : NULL; c && *c; c++)
		*c = (char)(isupper((unsigned char)*c) ? tolower((unsigned char)*c) : toupper((unsigned char)*c));
	const bool same = changed && strcmp(changed, input) != 0 && lstat(input, &one) == 0 &&
		lstat(changed, &other) == 0 && nt_same_file(&one, &other);
	free(changed);
	return same;
}

static bool same_output(const nt_job *x, const nt_job *y)
{
	return strcasecmp(x->output, y->output) == 0 && (strcmp(x->output, y->output) == 0 || ignores_case(y->input));
}

static nt_status refuse(nt_job *job, const nt_buffer *reason, nt_error *error)
{
	if (!job->refused && !reason->failed)
		job->refused = strdup(reason->data);
	return job->refused ? NT_OK : nt_fail_memory(error);
}

/* The folder that all inputs are in or below, as they are spelled, a word of a shell; "ROOT": none that their spelling
 * tells. */
static void append_common_folder(nt_buffer *out, const nt_batch *batch)
{
	const char *first = batch->jobs[0].input;
	size_t common = nt_folder_length(first);
	for (size_t i = 1; i < batch->count; i++) {
		size_t same = 0;
		while (same < common && batch->jobs[i].input[same] == first[same])
			same++;
		while (same && first[same - 1] != '/')
			same--;
		common = same;
	}
	bool below = true;
	for (size_t i = 0; i < batch->count; i++)
		below &= (common || batch->jobs[i].input[0] != '/') &&
			!nt_uri_has_parent_step(batch->jobs[i].input + common);
	nt_buffer folder = {0};
	if (below && common)
		nt_buffer_append(&folder, first, common > 1 ? common - 1 : 1);
	else if (below)
		nt_buffer_text(&folder, ".");
	if (!folder.data || !nt_shell_word(folder.data, out))
		nt_buffer_text(out, "ROOT");
	nt_buffer_free_into(&folder, out);
}

static int compare_folders(const void *a, const void *b)
{
	const nt_job *x = *(const nt_job *const *)a, *y = *(const nt_job *const *)b;
	const size_t length = nt_folder_length(x->input),
		     other = nt_folder_length(y->input);
	return length != other ? (length > other) - (length < other) : memcmp(x->input, y->input, length);
}

static int compare_jobs(const void *a, const void *b)
{
	const nt_job *x = *(nt_job *const *)a, *y = *(nt_job *const *)b;
	return (x > y) - (x < y);
}

/* Refuses jobs with one output: all of them, since which one is meant? The reason is one for all. */
static nt_status refuse_clash(const nt_batch *batch, nt_job **jobs, size_t count, bool tree_helps, const char *remedy,
	nt_error *error)
{
	enum { NAMED = 3 };
	nt_buffer reason = {0};
	const size_t named = count > NAMED ? NAMED - 1 : count;
	size_t folders = 1;
	qsort(jobs, count, sizeof *jobs, compare_folders);
	for (size_t i = 1; i < count; i++)
		folders += compare_folders(&jobs[i - 1], &jobs[i]) != 0;
	tree_helps &= folders > 1;
	qsort(jobs, count, sizeof *jobs, compare_jobs);
	for (size_t i = 0; i < named; i++)
		nt_buffer_format(&reason, "%s'%s'", !i ? "" : i + 1 < count ? ", " : " and ", jobs[i]->input);
	if (named < count)
		nt_buffer_format(&reason, " and %zu more", count - named);
	nt_buffer_format(&reason, " would %s be written to '%s'", count == 2 ? "both" : "all", jobs[0]->output);
	if (tree_helps) {
		nt_buffer_text(&reason, "; --keep-tree=");
		append_common_folder(&reason, batch);
		nt_buffer_text(&reason, " keeps the folders of inputs");
	}
	if (tree_helps && folders < count)
		nt_buffer_format(&reason, ", and of inputs in one folder: %s", remedy);
	else if (!tree_helps)
		nt_buffer_format(&reason, "; %s", remedy);
	nt_status status = NT_OK;
	for (size_t i = 0; i < count && !status; i++) {
		jobs[i]->reason_is_told = i > 0;
		status = refuse(jobs[i], &reason, error);
	}
	nt_buffer_free(&reason);
	return status;
}

static nt_status refuse_equal_outputs(const nt_batch *batch, bool tree_helps, const char *remedy,
	nt_error *error)
{
	nt_job **sorted = nt_alloc(batch->count, sizeof(nt_job *));
	if (!sorted)
		return nt_fail_memory(error);
	for (size_t i = 0; i < batch->count; i++)
		sorted[i] = &batch->jobs[i];
	qsort(sorted, batch->count, sizeof(nt_job *), compare_outputs);
	nt_status status = NT_OK;
	for (size_t first = 0, end; first < batch->count && !status; first = end) {
		for (end = first + 1; end < batch->count && same_output(sorted[first], sorted[end]);)
			end++;
		if (end - first > 1)
			status = refuse_clash(batch, sorted + first, end - first, tree_helps, remedy, error);
	}
	free(sorted);
	return status;
}

/* An output that is a file already must not be the input of another job: who reads it when? Its own
 * input is nt_run's affair. */
static nt_status refuse_foreign_inputs(const nt_batch *batch, const char *remedy, nt_error *error)
{
	nt_key_set files = {0};
	size_t(*readers)[2] = nt_alloc(batch->count, sizeof *readers); /* of each file, the first two */
	nt_status status = readers ? NT_OK : nt_fail_memory(error);
	struct stat info;
	/* an input that cannot be looked at cannot be read either, and its run says so */
	for (size_t i = 0; i < batch->count && !status; i++) {
		if (stat(batch->jobs[i].input, &info) != 0)
			continue;
		const nt_file_id id = nt_file_id_of(&info);
		const size_t known = files.count;
		const uint32_t number = nt_key_add(&files, &id, sizeof id);
		if (number == UINT32_MAX)
			status = nt_fail_memory(error);
		else if (number == known)
			readers[number][0] = readers[number][1] = i;
		else if (readers[number][1] == readers[number][0])
			readers[number][1] = i;
	}
	for (size_t i = 0; i < batch->count && !status; i++) {
		bool found_output;
		status = nt_lookup_found(batch->jobs[i].output, &info, &found_output, error);
		if (status || !found_output)
			continue;
		const nt_file_id id = nt_file_id_of(&info);
		const uint32_t number = nt_key_find(&files, &id, sizeof id);
		const size_t *of = number != UINT32_MAX ? readers[number] : (size_t[]){i, i};
		const nt_job *reader = &batch->jobs[of[of[0] == i]];
		if (reader == &batch->jobs[i])
			continue;
		nt_buffer reason = {0};
		nt_buffer_format(&reason, "'%s' would be written to '%s', which is the input '%s'; %s",
			batch->jobs[i].input, batch->jobs[i].output, reader->input, remedy);
		status = refuse(&batch->jobs[i], &reason, error);
		nt_buffer_free(&reason);
	}
	free(readers);
	nt_key_set_free(&files);
	return status;
}

static nt_status make_folder(const char *directory, const nt_settings *settings, nt_error *error)
{
	struct stat info;
	bool found;
	const nt_status status = nt_lookup_found(directory, &info, &found, error);
	if (status || (found && S_ISDIR(info.st_mode)))
		return status;
	if (found)
		return nt_fail_file(error, NT_ERROR_IO, directory, "is not a folder");
	if (settings->dry_run)
		return NT_OK;
	/* another process may have been faster */
	if (mkdir(directory, 0777) == 0 || (errno == EEXIST && stat(directory, &info) == 0 && S_ISDIR(info.st_mode)))
		return settings->sync ? nt_output_sync_name(directory, error) : NT_OK;
	return nt_fail_file(error, NT_ERROR_IO, directory, "cannot make the folder: %s", strerror(errno));
}

/* Outputs in a tree below the folder that is like the inputs' below the root. The names are compared as they are
 * spelled: a tree of links is a tree. */
static nt_status name_in_tree(nt_batch *batch, const char *directory, const char *tree, nt_format wanted,
	nt_error *error)
{
	nt_buffer current = {0}, root = {0}, path = {0};
	nt_status status = nt_path_absolute(&current, ".", error);
	if (!status)
		status = nt_path_absolute(&root, tree, error);
	for (size_t i = 0; i < batch->count && !status; i++) {
		nt_job *job = &batch->jobs[i];
		path.size = 0;
		nt_path_join(&path, current.data, job->input);
		if (path.failed) {
			status = nt_fail_memory(error);
			break;
		}
		if (!nt_link_is_inside(path.data, root.data)) {
			status = nt_fail(error, NT_ERROR_USAGE, "'%s' is not below '%s', as --keep-tree asks",
				job->input, tree);
			break;
		}
		const char *below = path.data + (root.size > 1 ? root.size + 1 : 1);
		job->output = output_name(job->input, below, directory, wanted);
		if (!job->output)
			status = nt_fail_memory(error);
	}
	nt_buffer_free(&current);
	nt_buffer_free(&root);
	nt_buffer_free(&path);
	return status;
}

static nt_status name_outputs(nt_batch *batch, const char *directory, const char *tree, nt_format wanted,
	nt_error *error)
{
	if (tree)
		return name_in_tree(batch, directory, tree, wanted, error);
	for (size_t i = 0; i < batch->count; i++) {
		nt_job *job = &batch->jobs[i];
		job->output = output_name(job->input, nt_last_part(job->input), directory, wanted);
		if (!job->output)
			return nt_fail_memory(error);
	}
	return NT_OK;
}

/* The folders of a path but for its last part; `known` characters long are those that are there. */
static nt_status make_folders_of(char *path, size_t known, const nt_settings *settings, nt_error *error)
{
	nt_status status = NT_OK;
	for (char *slash = strchr(path + known, '/'); slash && !status; slash = strchr(slash + 1, '/')) {
		*slash = '\0';
		if (slash > path)
			status = make_folder(path, settings, error);
		*slash = '/';
	}
	return status;
}

static nt_status make_folders(const nt_batch *batch, const char *directory, bool as_tree,
	const nt_settings *settings, nt_error *error)
{
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s/", directory);
	nt_status status = path.failed ? nt_fail_memory(error) : make_folders_of(path.data, 0, settings, error);
	nt_buffer_free(&path);
	const char *last = "";
	for (size_t i = 0; i < batch->count && as_tree && !settings->dry_run && !status; i++) {
		char *output = batch->jobs[i].output;
		const size_t length = nt_folder_length(output);
		/* neighbours are mostly of one folder */
		if (strncmp(last, output, length) != 0 || strchr(last + length, '/'))
			status = make_folders_of(output, strlen(directory) + 1, settings, error);
		last = output;
	}
	return status;
}

nt_status nt_batch_into(nt_batch *batch, const char *const *inputs, size_t count, const char *directory,
	const char *tree, const nt_settings *settings, nt_error *error)
{
	nt_status status = nt_batch_check(batch, inputs, count, error);
	if (!status)
		status = name_outputs(batch, directory, tree, settings->output_format, error);
	if (!status)
		status = refuse_equal_outputs(batch, !tree, "convert one of them by itself, to another name", error);
	if (!status)
		status = refuse_foreign_inputs(batch, "choose another folder for -d", error);
	size_t refused = 0;
	while (refused < batch->count && batch->jobs[refused].refused)
		refused++;
	if (status || (count && refused == count))
		return status;
	return make_folders(batch, directory, tree != NULL, settings, error);
}

nt_status nt_batch_in_place(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error)
{
	static const char once[] = "it is one file: name it once";
	nt_status status = nt_batch_check(batch, inputs, count, error);
	for (size_t i = 0; i < count && !status; i++) {
		batch->jobs[i].output = strdup(inputs[i]);
		status = batch->jobs[i].output ? NT_OK : nt_fail_memory(error);
	}
	if (!status)
		status = refuse_equal_outputs(batch, false, once, error);
	return status ? status : refuse_foreign_inputs(batch, once, error);
}

void nt_batch_free(nt_batch *batch)
{
	for (size_t i = 0; i < batch->count; i++) {
		free(batch->jobs[i].output);
		free(batch->jobs[i].refused);
	}
	free(batch->jobs);
	*batch = (nt_batch){0};
}

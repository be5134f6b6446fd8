/* SPDX-License-Identifier: MIT */
/*
 * Depfiles: see batch.h. Names are spelled as GNU make's manual ("Rule Syntax", "Using Wildcard Characters") and
 * Ninja's depfile lexer both read them: a backslash before a blank, "#" and ":", each backslash before those doubled,
 * and "$$". Characters that only one of them knows (%, * in make) are left as they are. Ninja reads "\#" in a name
 * with one backslash too many, and makes the output again each time; make would lose the rest of the line the other
 * way.
 */
#include "batch/batch.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/memory.h"
#include "file/input.h"
#include "file/output.h"
#include "file/path.h"

static void append_escaped(nt_buffer *text, const char *name)
{
	size_t backslashes = 0;
	for (const char *c = name; *c; c++) {
		if (strchr(" \t#:", *c)) {
			/* those before it would be taken for escapes */
			for (size_t i = 0; i < backslashes; i++)
				nt_buffer_text(text, "\\");
			nt_buffer_text(text, "\\");
		} else if (*c == '$') {
			nt_buffer_text(text, "$");
		}
		backslashes = *c == '\\' ? backslashes + 1 : 0;
		nt_buffer_append(text, c, 1);
	}
}

static nt_status append_name(nt_depfile *depfile, const char *path, bool relative, nt_error *error)
{
	nt_buffer shown = {0};
	nt_status status = depfile->current.size ? NT_OK : nt_path_absolute(&depfile->current, ".", error);
	/* as a build that runs here names it */
	if (!status && relative && path[0] == '/')
		nt_path_below(&shown, depfile->current.data, path, depfile->current.data, path);
	else
		nt_buffer_text(&shown, path);
	if (!status && !shown.failed && strpbrk(shown.data, "\n\r"))
		status = nt_fail_file(error, NT_ERROR_UNSUPPORTED, path,
			"a name with a line feed cannot be in a depfile");
	else if (!status && !shown.failed)
		append_escaped(&depfile->text, shown.data);
	nt_buffer_free_into(&shown, &depfile->text);
	return status;
}

/* The folder of a path, or the first above that is there. */
static bool find_folder(const char *path, char folder[PATH_MAX], struct stat *info)
{
	char below[PATH_MAX];
	for (;; path = strcpy(below, folder)) {
		nt_folder_of(path, folder);
		if (stat(folder, info) == 0 && S_ISDIR(info->st_mode))
			return true;
		if (!folder[0] || strcmp(folder, ".") == 0 || strcmp(folder, "/") == 0)
			return false;
	}
}

/* Takes the folders of files of two kinds that are new in the set, and appends them to the list (NULL: nowhere). */
static nt_status add_folders(const nt_trace *trace, nt_trace_kind one, nt_trace_kind other, nt_key_set *folders,
	nt_buffer *list, nt_error *error)
{
	for (size_t i = 0; i < trace->count; i++) {
		const nt_trace_file *file = &trace->files[i];
		char folder[PATH_MAX];
		struct stat info;
		if ((file->kind != one && file->kind != other) || !find_folder(file->path, folder, &info))
			continue;
		const nt_file_id id = nt_file_id_of(&info);
		const size_t before = folders->count;
		if (nt_key_add(folders, &id, sizeof id) == UINT32_MAX)
			return nt_fail_memory(error);
		if (list && folders->count > before)
			nt_buffer_append(list, folder, strlen(folder) + 1);
	}
	return NT_OK;
}

/* The dependencies of an output, each with a NUL behind it: files that were read, the input first, and the folders in
 * which others were looked for in vain, but for those that are written to: in them each run leaves another time of
 * change. */
static nt_status list_dependencies(const nt_trace *trace, nt_buffer *list, nt_error *error)
{
	nt_key_set folders = {0};
	for (size_t i = 0; i < trace->count; i++)
		if (trace->files[i].kind == NT_TRACE_READ)
			nt_buffer_append(list, trace->files[i].path, strlen(trace->files[i].path) + 1);
	nt_status status = add_folders(trace, NT_TRACE_WRITTEN, NT_TRACE_WRITTEN, &folders, NULL, error);
	if (!status)
		status = add_folders(trace, NT_TRACE_MISSING, NT_TRACE_SEARCHED, &folders, list, error);
	nt_key_set_free(&folders);
	return status || !list->failed ? status : nt_fail_memory(error);
}

/* Appends the names from `at` on, each with `before` and `after` around it. */
static nt_status append_list(nt_depfile *depfile, const nt_buffer *list, size_t at, bool relative, const char *before,
	const char *after, nt_error *error)
{
	nt_status status = NT_OK;
	for (; at < list->size && !status; at += strlen(list->data + at) + 1) {
		nt_buffer_text(&depfile->text, before);
		status = append_name(depfile, list->data + at, relative, error);
		nt_buffer_text(&depfile->text, after);
	}
	return status;
}

nt_status nt_depfile_add(nt_depfile *depfile, const char *output, const nt_trace *trace, nt_error *error)
{
	const bool relative = output[0] != '/';
	nt_buffer list = {0};
	nt_status status = list_dependencies(trace, &list, error);
	if (!status)
		status = append_name(depfile, output, relative, error);
	nt_buffer_text(&depfile->text, ":");
	if (!status)
		status = append_list(depfile, &list, 0, relative, " \\\n ", "", error);
	nt_buffer_text(&depfile->text, "\n");
	if (!status && list.size)
		status = append_list(depfile, &list, strlen(list.data) + 1, relative, "", ":\n", error);
	nt_buffer_free(&list);
	return status || !depfile->text.failed ? status : nt_fail_memory(error);
}

nt_status nt_depfile_write(const nt_depfile *depfile, const char *path, const char *const *inputs, size_t input_count,
	nt_error *error)
{
	nt_output *output;
	nt_sink *sink;
	nt_status status = nt_output_create(&output, NULL, error);
	if (status)
		return status;
	for (size_t i = 0; i < input_count && !status; i++)
		status = nt_output_protect(output, inputs[i], NULL, error);
	if (!status)
		status = nt_output_add(output, path, NT_ROLE_MAIN, &sink, error);
	if (!status && depfile->text.size)
		status = nt_sink_write(sink, depfile->text.data, depfile->text.size, error);
	return nt_output_end(output, status, error);
}

void nt_depfile_free(nt_depfile *depfile)
{
	nt_buffer_free(&depfile->text);
	nt_buffer_free(&depfile->current);
}

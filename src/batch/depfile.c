/* SPDX-License-Identifier: MIT */
/*
 * Depfiles: see depfile.h. Names are spelled as GNU make's manual ("Rule Syntax", "Using Wildcard Characters") and
 * Ninja's depfile lexer both read them: a backslash before a blank, "#" and ":", each backslash before those doubled,
 * and "$$". Characters that only one of them knows (%, * in make) are left as they are. Ninja reads "\#" in a name
 * with one backslash too many, and makes the output again each time; make would lose the rest of the line the other
 * way.
 */
#include "batch/depfile.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/memory.h"
#include "file/lookup.h"
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
	if (!status && shown.failed)
		status = nt_fail_memory(error);
	if (!status && strpbrk(shown.data, "\n\r"))
		status = nt_fail_file(error, NT_ERROR_UNSUPPORTED, path,
			"a name with a line feed cannot be in a depfile");
	if (!status)
		append_escaped(&depfile->text, shown.data);
	nt_buffer_free(&shown);
	return status;
}

/* The folder of a path, or the first above that is there. */
static bool find_folder(const char *path, nt_buffer *folder, struct stat *info)
{
	folder->size = 0;
	nt_buffer_text(folder, path);
	while (!folder->failed) {
		const char *slash = strrchr(folder->data, '/');
		folder->size = slash ? (size_t)(slash - folder->data) : 0;
		folder->data[folder->size] = '\0';
		if (!folder->size)
			nt_buffer_text(folder, slash ? "/" : ".");
		if (!folder->failed && stat(folder->data, info) == 0 && S_ISDIR(info->st_mode))
			return true;
		if (!slash)
			break;
	}
	return false;
}

/* Notes the folders that are written to: in them each run leaves another time of change. */
static nt_status list_written(const nt_trace *trace, nt_key_set *written, nt_error *error)
{
	nt_buffer folder = {0};
	nt_status status = NT_OK;
	for (size_t i = 0; i < trace->count && !status; i++) {
		struct stat info;
		if (trace->files[i].kind != NT_TRACE_WRITTEN || !find_folder(trace->files[i].path, &folder, &info))
			continue;
		const nt_file_id id = nt_file_id_of(&info);
		if (nt_key_add(written, &id, sizeof id) == UINT32_MAX)
			status = nt_fail_memory(error);
	}
	nt_buffer_free(&folder);
	return status;
}

/* Appends the folders in which files were looked for in vain, each once. */
static nt_status list_searched(const nt_trace *trace, const nt_key_set *written, nt_buffer *list, nt_error *error)
{
	nt_name_table listed = {0};
	nt_arena texts = {0};
	nt_buffer folder = {0};
	nt_status status = NT_OK;
	for (size_t i = 0; i < trace->count && !status; i++) {
		const nt_trace_kind kind = trace->files[i].kind;
		struct stat info;
		if ((kind != NT_TRACE_MISSING && kind != NT_TRACE_SEARCHED) ||
			!find_folder(trace->files[i].path, &folder, &info) ||
			nt_name_find(&listed, folder.data, folder.size) != UINT32_MAX)
			continue;
		const char *text = nt_arena_text(&texts, folder.data, folder.size);
		if (!text || nt_name_add(&listed, text, folder.size) == UINT32_MAX)
			status = nt_fail_memory(error);
		const nt_file_id id = nt_file_id_of(&info);
		if (nt_key_find(written, &id, sizeof id) == UINT32_MAX)
			nt_buffer_append(list, folder.data, folder.size + 1);
	}
	nt_name_table_free(&listed);
	nt_arena_free(&texts);
	nt_buffer_free_into(&folder, list);
	return status;
}

/* The dependencies of an output, each with a NUL behind it: files that were read, the input first, and the folders in
 * which others were looked for in vain. */
static nt_status list_dependencies(const nt_trace *trace, nt_buffer *list, nt_error *error)
{
	nt_key_set written = {0};
	for (size_t i = 0; i < trace->count; i++)
		if (trace->files[i].kind == NT_TRACE_READ)
			nt_buffer_append(list, trace->files[i].path, strlen(trace->files[i].path) + 1);
	nt_status status = list_written(trace, &written, error);
	if (!status)
		status = list_searched(trace, &written, list, error);
	nt_key_set_free(&written);
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
	if (!status)
		return nt_output_commit(output, error);
	nt_output_abort(output);
	return status;
}

void nt_depfile_free(nt_depfile *depfile)
{
	nt_buffer_free(&depfile->text);
	nt_buffer_free(&depfile->current);
}

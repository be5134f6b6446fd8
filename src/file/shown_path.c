/* SPDX-License-Identifier: MIT */
/*
 * Names in reports: see shown_path.h.
 */
#include "file/shown_path.h"

#include <string.h>
#include "file/relative_path.h"

/* Shortens `folder` to what it has in common with the folder of `path`. */
static void narrow(nt_buffer *folder, const char *path)
{
	size_t common = 0;
	for (size_t i = 0;; i++) {
		const bool ends = i == folder->size || (folder->data[i] == '/' && i > 0);
		if (ends && path[i] == '/')
			common = i;
		if (i == folder->size || folder->data[i] != path[i])
			break;
	}
	folder->size = common ? common : 1;
	folder->data[folder->size] = '\0';
}

/* The folder of the first input, shortened by each further one. */
static nt_status take_input(nt_shown_paths *paths, const char *input, nt_buffer *path, bool *below)
{
	path->size = 0;
	nt_path_join(path, paths->current.data, input);
	if (!paths->base.size && !path->failed) {
		const size_t length = (size_t)(nt_last_part(path->data) - path->data);
		nt_buffer_append(&paths->base, path->data, length > 1 ? length - 1 : 1);
	}
	if (path->failed || paths->base.failed)
		return NT_ERROR_MEMORY;
	narrow(&paths->base, path->data);
	*below &= nt_link_is_inside(path->data, paths->current.data);
	return NT_OK;
}

nt_status nt_shown_paths_begin(nt_shown_paths *paths, const char *const *inputs, size_t count, const char *prefix,
	nt_error *error)
{
	nt_buffer path = {0};
	bool below = true;
	*paths = (nt_shown_paths){.prefix = prefix};
	nt_status status = nt_path_absolute(&paths->current, ".", error);
	for (size_t i = 0; i < count && !status; i++)
		if (strcmp(inputs[i], "-") != 0 && take_input(paths, inputs[i], &path, &below))
			status = nt_fail_memory(error);
	nt_buffer_free(&path);
	if (status || !below)
		return status;
	paths->base.size = 0;
	nt_buffer_text(&paths->base, paths->current.data);
	return paths->base.failed ? nt_fail_memory(error) : NT_OK;
}

static void append_prefix(const nt_shown_paths *paths, nt_buffer *out)
{
	const char *prefix = paths->prefix;
	if (prefix)
		nt_buffer_format(out, "%s%s", prefix, *prefix && prefix[strlen(prefix) - 1] != '/' ? "/" : "");
}

/* The path from a folder on if it is below, else `otherwise`. */
static void append_below(const nt_shown_paths *paths, const nt_buffer *folder, const char *path, const char *otherwise,
	nt_buffer *out)
{
	nt_buffer whole = {0};
	nt_path_join(&whole, paths->current.data, path);
	const bool below = whole.data && nt_link_is_inside(whole.data, folder->data);
	nt_buffer_text(out, below ? whole.data + (folder->size > 1 ? folder->size + 1 : 1) : otherwise);
	nt_buffer_free_into(&whole, out);
}

void nt_shown_path(const nt_shown_paths *paths, const char *path, nt_buffer *out)
{
	if (!paths || strcmp(path, "-") == 0) {
		nt_buffer_text(out, path);
		return;
	}
	append_prefix(paths, out);
	append_below(paths, &paths->base, path, nt_last_part(path), out);
}

void nt_opened_path(const nt_shown_paths *paths, const char *path, nt_buffer *out)
{
	if (!paths || paths->prefix || strcmp(path, "-") == 0)
		nt_shown_path(paths, path, out);
	else
		append_below(paths, &paths->current, path, path, out);
}

void nt_shown_paths_free(nt_shown_paths *paths)
{
	nt_buffer_free(&paths->current);
	nt_buffer_free(&paths->base);
}

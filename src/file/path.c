/* SPDX-License-Identifier: MIT */
/*
 * Paths: see path.h.
 */
#include "file/path.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "file/input.h"

static void cut(nt_buffer *text, size_t size)
{
	if (text->data)
		text->data[text->size = size] = '\0';
}

/* ---- as it is spelled ---- */

const char *nt_last_part(const char *path)
{
	const char *slash = strrchr(path, '/');
	return slash ? slash + 1 : path;
}

size_t nt_folder_length(const char *path)
{
	return (size_t)(nt_last_part(path) - path);
}

const char *nt_folder_of(const char *path, char folder[PATH_MAX])
{
	const size_t length = nt_folder_length(path);
	const int kept = length >= PATH_MAX ? 0 : length > 1 ? (int)length - 1 : 1;
	snprintf(folder, PATH_MAX, "%.*s", kept, length ? path : ".");
	return folder;
}

void nt_path_beside(nt_buffer *text, const char *file, const char *name)
{
	nt_buffer_append(text, file, name[0] == '/' ? 0 : nt_folder_length(file));
	nt_buffer_text(text, name);
}

/* Appends the components of a name to a path, one by one. `begin`: where the path begins in text. */
static void append_components(nt_buffer *text, size_t begin, const char *name)
{
	while (*name && !text->failed) {
		const size_t length = strcspn(name, "/");
		if (length == 2 && memcmp(name, "..", 2) == 0) {
			while (text->size > begin && text->data[--text->size] != '/')
				;
			cut(text, text->size);
		} else if (length > 0 && !(length == 1 && *name == '.')) {
			nt_buffer_text(text, "/");
			nt_buffer_append(text, name, length);
		}
		name += length;
		name += *name != '\0';
	}
}

void nt_path_join(nt_buffer *text, const char *folder, const char *name)
{
	const size_t begin = text->size;
	if (name[0] != '/')
		append_components(text, begin, folder);
	append_components(text, begin, name);
	/* a path of no components is the root's */
	nt_buffer_text(text, text->size == begin ? "/" : "");
}

nt_status nt_path_absolute(nt_buffer *text, const char *name, nt_error *error)
{
	char *current = name[0] == '/' ? NULL : getcwd(NULL, 0);
	if (name[0] != '/' && !current)
		return nt_lookup_failed(".", errno, error);
	nt_path_join(text, current, name);
	free(current);
	return text->failed ? nt_fail_memory(error) : NT_OK;
}

/* How much of an absolute path, which has a folder or more above it, is `folder` or above that. */
static size_t common_length(const char *folder, const char *path)
{
	size_t common = 0;
	for (size_t i = 0;; i++) {
		if ((folder[i] == '/' || folder[i] == '\0') && path[i] == '/')
			common = i;
		if (folder[i] == '\0' || folder[i] != path[i])
			return common;
	}
}

void nt_path_relative(nt_buffer *text, const char *folder, const char *path)
{
	folder = strcmp(folder, "/") == 0 ? "" : folder;
	const size_t common = common_length(folder, path);
	for (const char *rest = folder + common; *rest; rest++)
		if (*rest == '/')
			nt_buffer_text(text, "../");
	nt_buffer_text(text, path + common + 1);
}

bool nt_link_is_inside(const char *path, const char *folder)
{
	const size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
	return strncmp(path, folder, length) == 0 && path[length] == '/';
}

void nt_path_below(nt_buffer *text, const char *current, const char *name, const char *folder, const char *otherwise)
{
	nt_buffer whole = {0};
	nt_path_join(&whole, current, name);
	if (!whole.failed && nt_link_is_inside(whole.data, folder))
		nt_path_relative(text, folder, whole.data);
	else
		nt_buffer_text(text, otherwise);
	nt_buffer_free_into(&whole, text);
}

static bool is_separator(char c)
{
	return c == '/' || c == '\\';
}

bool nt_link_is_absolute(const char *name)
{
	const size_t scheme = strspn(name,
		"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-.");
	return is_separator(name[0]) || (scheme > 0 && name[scheme] == ':' &&
		(scheme == 1 || (is_separator(name[scheme + 1]) && is_separator(name[scheme + 2]))));
}

/* ---- as links have it ---- */

nt_status nt_path_real(nt_buffer *text, const char *path, nt_error *error)
{
	nt_buffer spelled = {0};
	char *real = realpath(path, NULL);
	nt_status status = real ? nt_path_absolute(&spelled, path, error) : nt_lookup_failed(path, errno, error);
	if (!status && strcmp(spelled.data, real) != 0)
		nt_trace_note(NT_TRACE_LINK, path, real, NULL);
	if (status == NT_ERROR_MISSING)
		nt_trace_note(NT_TRACE_LINK, path, NULL, NULL);
	if (real)
		nt_buffer_text(text, real);
	nt_buffer_free(&spelled);
	free(real);
	return status || !text->failed ? status : nt_fail_memory(error);
}

nt_status nt_link_folder(nt_buffer *text, const char *path, nt_error *error)
{
	if (nt_name_is_too_long(path))
		return nt_lookup_failed(path, ENAMETOOLONG, error);
	const char *slash = strrchr(path, '/');
	char *folder = slash ? strndup(path, (size_t)(slash - path) + (slash == path)) : strdup(".");
	if (!folder)
		return nt_fail_memory(error);
	nt_status status = NT_OK;
	if (slash && access(folder, F_OK) != 0 && errno == ENOENT) {
		/* not there (yet, in a dry run): its own folder, and its name as it is spelled */
		const char *name = strrchr(folder, '/');
		status = nt_link_folder(text, folder, error);
		nt_buffer_format(text, "/%s", name ? name + 1 : folder);
	} else {
		status = nt_path_real(text, folder, error);
	}
	free(folder);
	return status || !text->failed ? status : nt_fail_memory(error);
}

nt_status nt_path_place(nt_buffer *text, const char *path, nt_error *error)
{
	const nt_status status = nt_link_folder(text, path, error);
	nt_buffer_format(text, "%s%s", text->size > 1 ? "/" : "", nt_last_part(path));
	return status || !text->failed ? status : nt_fail_memory(error);
}

/* Whether `path` is `folder` or below. */
static bool is_within(const char *path, const char *folder)
{
	const size_t size = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
	return strncmp(path, folder, size) == 0 && (path[size] == '/' || path[size] == '\0');
}

/* As the system goes it, component by component; a link's text takes the place of the component. */
nt_status nt_path_stays_inside(const char *folder, const char *name, bool *inside, nt_error *error)
{
	enum { MOST_LINKS = 40 }; /* as Linux follows */
	nt_buffer real = {0}, rest = {0};
	unsigned links = 0;
	bool outside = false;
	nt_buffer_text(&real, strcmp(folder, "/") != 0 ? folder : "");
	nt_buffer_text(&rest, name);
	const size_t begin = real.size;
	for (size_t at = 0; !outside && !real.failed && !rest.failed && at < rest.size;) {
		const char *part = rest.data + at;
		const size_t length = strcspn(part, "/"), before = real.size;
		char target[PATH_MAX];
		at += length + (part[length] == '/');
		if (length == 2 && memcmp(part, "..", 2) == 0) {
			const char *slash = before ? strrchr(real.data, '/') : NULL;
			cut(&real, slash ? (size_t)(slash - real.data) : 0);
			continue;
		}
		if (!length || (length == 1 && *part == '.'))
			continue;
		nt_buffer_format(&real, "/%.*s", (int)length, part);
		/* the folder is real, and so is what leads to it */
		if (real.failed || is_within(folder, real.data))
			continue;
		outside = !is_within(real.data, folder);
		const ssize_t size = outside ? -1 : readlink(real.data, target, sizeof target - 1);
		if (size < 0 || ++links > MOST_LINKS)
			continue;
		nt_buffer next = {0};
		nt_buffer_format(&next, "%.*s/%s", (int)size, target, rest.data + at);
		cut(&real, target[0] == '/' ? 0 : before);
		nt_buffer_free_into(&rest, &next);
		rest = next;
		at = 0;
	}
	*inside = !outside && real.size > begin;
	if (!*inside) {
		cut(&real, 0);
		nt_buffer_format(&real, "%s/%s", folder, name);
	}
	const bool failed = real.failed || rest.failed;
	if (!*inside && !failed)
		nt_trace_note(NT_TRACE_OUTSIDE, real.data, name, NULL);
	nt_buffer_free(&real);
	nt_buffer_free(&rest);
	return failed ? nt_fail_memory(error) : NT_OK;
}

/* ---- as reports show it ---- */

/* The folder of the first input, shortened by each further one. */
static nt_status take_input(nt_shown_paths *paths, const char *input, nt_buffer *path, bool *below)
{
	path->size = 0;
	nt_path_join(path, paths->current.data, input);
	if (path->failed)
		return NT_ERROR_MEMORY;
	if (!paths->base.size)
		nt_buffer_append(&paths->base, path->data, nt_folder_length(path->data));
	const size_t common = paths->base.failed ? 0 : common_length(paths->base.data, path->data);
	cut(&paths->base, common ? common : 1);
	*below &= nt_link_is_inside(path->data, paths->current.data);
	return paths->base.failed ? NT_ERROR_MEMORY : NT_OK;
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

void nt_shown_path(const nt_shown_paths *paths, const char *path, nt_buffer *out)
{
	if (!paths || strcmp(path, "-") == 0) {
		nt_buffer_text(out, path);
		return;
	}
	const char *prefix = paths->prefix ? paths->prefix : "";
	nt_buffer_format(out, "%s%s", prefix, *prefix && prefix[strlen(prefix) - 1] != '/' ? "/" : "");
	nt_path_below(out, paths->current.data, path, paths->base.data, nt_last_part(path));
}

void nt_opened_path(const nt_shown_paths *paths, const char *path, nt_buffer *out)
{
	if (!paths || paths->prefix || strcmp(path, "-") == 0)
		nt_shown_path(paths, path, out);
	else
		nt_path_below(out, paths->current.data, path, paths->current.data, path);
}

void nt_shown_paths_free(nt_shown_paths *paths)
{
	nt_buffer_free(&paths->current);
	nt_buffer_free(&paths->base);
}

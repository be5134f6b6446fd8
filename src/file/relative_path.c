/* SPDX-License-Identifier: MIT */
/*
 * Names of files: see relative_path.h. Resolving is lexical, so that a name keeps the symbolic links it goes
 * through; who must know where a file really is asks realpath().
 */
#include "file/relative_path.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "file/lookup.h"
#include "file/trace.h"

/* ---- links ---- */

nt_status nt_path_real(nt_buffer *text, const char *path, nt_error *error)
{
	nt_buffer spelled = {0};
	char *real = realpath(path, NULL);
	nt_status status = real ? nt_path_absolute(&spelled, path, error) : nt_lookup_failed(path, errno, error);
	if (!status && strcmp(spelled.data, real) != 0)
		nt_trace_link(path, real);
	if (status == NT_ERROR_MISSING)
		nt_trace_link(path, NULL);
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

/* Whether `path` is `folder` or below. */
static bool is_within(const char *path, const char *folder)
{
	const size_t size = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
	return strncmp(path, folder, size) == 0 && (path[size] == '/' || path[size] == '\0');
}

static void cut(nt_buffer *text, size_t size)
{
	if (text->data)
		text->data[text->size = size] = '\0';
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
		nt_trace_missing(real.data);
	nt_buffer_free(&real);
	nt_buffer_free(&rest);
	return failed ? nt_fail_memory(error) : NT_OK;
}

/* ---- text ---- */

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

/* Appends the components of a name to a path, one by one. `begin`: where the path begins in text. */
static void append_components(nt_buffer *text, size_t begin, const char *name, const char *separators)
{
	while (*name && !text->failed) {
		const size_t length = strcspn(name, separators);
		if (length == 2 && memcmp(name, "..", 2) == 0) {
			while (text->size > begin && text->data[--text->size] != '/')
				;
			if (text->data)
				text->data[text->size] = '\0';
		} else if (length > 0 && !(length == 1 && *name == '.')) {
			nt_buffer_text(text, "/");
			nt_buffer_append(text, name, length);
		}
		name += length;
		name += *name != '\0';
	}
}

/* A path of no components is the root's. */
static void end_path(nt_buffer *text, size_t begin)
{
	if (text->size == begin)
		nt_buffer_text(text, "/");
}

void nt_link_join(nt_buffer *text, const char *folder, const char *name)
{
	const size_t begin = text->size;
	if (!nt_link_is_absolute(name))
		append_components(text, begin, folder, "/\\");
	append_components(text, begin, name, "/\\");
	end_path(text, begin);
}

void nt_path_join(nt_buffer *text, const char *folder, const char *name)
{
	const size_t begin = text->size;
	if (name[0] != '/')
		append_components(text, begin, folder, "/");
	append_components(text, begin, name, "/");
	end_path(text, begin);
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

bool nt_link_is_inside(const char *path, const char *folder)
{
	const size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
	return strncmp(path, folder, length) == 0 && path[length] == '/';
}

const char *nt_last_part(const char *path)
{
	const char *slash = strrchr(path, '/');
	return slash ? slash + 1 : path;
}

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
#include "file/uri.h"

nt_status nt_link_folder(nt_buffer *text, const char *path, nt_error *error)
{
	if (nt_name_is_too_long(path))
		return nt_lookup_failed(path, ENAMETOOLONG, error);
	const char *slash = strrchr(path, '/');
	char *folder = slash ? strndup(path, (size_t)(slash - path) + (slash == path)) : strdup(".");
	if (!folder)
		return nt_fail_memory(error);
	char *resolved = realpath(folder, NULL);
	nt_status status = NT_OK;
	if (resolved) {
		nt_buffer_text(text, resolved);
	} else if (slash && errno == ENOENT) {
		/* not there (yet, in a dry run): its own folder, and its name as it is spelled */
		const char *name = strrchr(folder, '/');
		status = nt_link_folder(text, folder, error);
		nt_buffer_format(text, "/%s", name ? name + 1 : folder);
	} else {
		status = nt_lookup_failed(folder, errno, error);
	}
	free(folder);
	free(resolved);
	return status || !text->failed ? status : nt_fail_memory(error);
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

void nt_link_uri(nt_buffer *text, const char *folder, const char *path)
{
	if (strcmp(folder, "/") == 0)
		folder = "";
	/* where the last common component ends */
	size_t common = 0;
	for (size_t i = 0;; i++) {
		const bool folder_ends = folder[i] == '/' || folder[i] == '\0';
		if (folder_ends && path[i] == '/')
			common = i;
		if (folder[i] == '\0' || folder[i] != path[i])
			break;
	}
	for (const char *rest = folder + common; *rest; rest++)
		if (*rest == '/')
			nt_buffer_text(text, "../");
	const char *name = path + common + 1;
	nt_uri_append_path(text, name);
}

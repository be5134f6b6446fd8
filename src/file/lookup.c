/* SPDX-License-Identifier: MIT */
/*
 * Looking for files: see input.h.
 */
#include "file/input.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/text.h"

nt_status nt_lookup_failed(const char *path, int number, nt_error *error)
{
	if (number == ENOENT)
		nt_fail(error, NT_ERROR_MISSING, "no such file");
	else if (number == ENOTDIR || number == ENAMETOOLONG)
		nt_fail(error, NT_ERROR_MISSING, "no such file: %s", strerror(number));
	else if (number == EISDIR)
		nt_fail(error, NT_ERROR_MISSING, "cannot read: %s", strerror(number));
	else if (number == ENOMEM)
		nt_fail_memory(error);
	else
		nt_fail(error, NT_ERROR_IO, "cannot read: %s", strerror(number));
	/* what has too long a name will not come to be */
	if (error->status == NT_ERROR_MISSING && number != ENAMETOOLONG)
		nt_trace_note(NT_TRACE_MISSING, path, NULL, NULL);
	return nt_error_in_file(error, path);
}

bool nt_name_is_too_long(const char *name)
{
	return strnlen(name, PATH_MAX) == PATH_MAX;
}

nt_status nt_lookup(const char *path, struct stat *info, nt_error *error)
{
	return stat(path, info) == 0 ? NT_OK : nt_lookup_failed(path, errno, error);
}

nt_status nt_lookup_found(const char *path, struct stat *info, bool *found, nt_error *error)
{
	nt_error failure;
	const nt_status status = nt_lookup(path, info, &failure);
	*found = status == NT_OK;
	if (status == NT_OK || status == NT_ERROR_MISSING)
		return NT_OK;
	if (error)
		*error = failure;
	return status;
}

static nt_status find_entry(
	DIR *dir, const char *name, size_t length, char **entry, nt_error *error)
{
	for (const struct dirent *e; dir && (e = readdir(dir));) {
		if (strlen(e->d_name) != length || strncasecmp(e->d_name, name, length) != 0 ||
			(*entry && strcmp(e->d_name, *entry) > 0))
			continue;
		free(*entry);
		*entry = strdup(e->d_name);
		if (!*entry)
			return nt_fail_memory(error);
	}
	return NT_OK;
}

nt_status nt_lookup_any_case(
	const char *folder, const char *name, size_t length, char **entry, nt_error *error)
{
	struct stat info = {0}; /* as it was before it is read */
	*entry = NULL;
	DIR *dir = opendir(*folder ? folder : "/");
	if (!dir && errno == ENOMEM)
		return nt_fail_memory(error);
	if (dir && fstat(dirfd(dir), &info) != 0)
		info = (struct stat){0};
	nt_status status = find_entry(dir, name, length, entry, error);
	if (dir)
		closedir(dir);
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s/%.*s", folder, (int)length, name);
	if (!path.failed)
		nt_trace_note(NT_TRACE_SEARCHED, path.data, *entry, &info);
	else if (!status)
		status = nt_fail_memory(error);
	nt_buffer_free(&path);
	if (status) {
		free(*entry);
		*entry = NULL;
	}
	return status;
}

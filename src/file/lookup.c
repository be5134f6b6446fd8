/* SPDX-License-Identifier: MIT */
/*
 * Looking for files: see lookup.h.
 */
#include "file/lookup.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include "file/trace.h"

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
	if (error->status == NT_ERROR_MISSING)
		nt_trace_missing(path);
	return nt_error_in_file(error, path);
}

nt_status nt_lookup(const char *path, struct stat *info, nt_error *error)
{
	return stat(path, info) == 0 ? NT_OK : nt_lookup_failed(path, errno, error);
}

/* Passes on what is a fault. */
static nt_status unless_missing(nt_status status, const nt_error *failure, nt_error *error)
{
	if (status == NT_OK || status == NT_ERROR_MISSING)
		return NT_OK;
	if (error)
		*error = *failure;
	return status;
}

nt_status nt_lookup_found(const char *path, struct stat *info, bool *found, nt_error *error)
{
	nt_error failure;
	const nt_status status = nt_lookup(path, info, &failure);
	*found = status == NT_OK;
	return unless_missing(status, &failure, error);
}

nt_status nt_lookup_real(const char *path, char **real, nt_error *error)
{
	*real = realpath(path, NULL);
	return *real ? NT_OK : nt_lookup_failed(path, errno, error);
}

nt_status nt_lookup_real_found(const char *path, char **real, nt_error *error)
{
	nt_error failure;
	const nt_status status = nt_lookup_real(path, real, &failure);
	return unless_missing(status, &failure, error);
}

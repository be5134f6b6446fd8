/* SPDX-License-Identifier: MIT */
/*
 * A rename creates a new inode; copy mode, owner and xattrs of the old one to it.
 *
 * Mode, owner, group, extended attributes and access lists go over. Nobody may come to read what he could not read
 * before: the new file is made for its owner alone, and where the group cannot be kept, the new group gets what
 * others have. Rights of the old content are dropped: set-user-ID and set-group-ID bits, capabilities,
 * and signatures. A file with further names could not keep them, and one that is read-only is meant to stay.
 */
#include "file/output_parts.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/xattr.h>
#include <unistd.h>
#include "base/memory.h"

static const char access_list[] = "system.posix_acl_access";

const char *nt_in_place_refusal(const char *path, const struct stat *status)
{
	if ((status->st_mode & 0222) == 0 || (faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) != 0 && errno == EACCES))
		return "the file is read-only; chmod u+w allows to replace it, or name another output";
	if (status->st_nlink > 1)
		return "the file has further names (hard links), which would keep the old content; name another output";
	return NULL;
}

static nt_status fail_keeping(nt_error *error, const char *what, const char *target)
{
	const int number = errno;
	if (number == ENOMEM)
		nt_fail_memory(error);
	else
		nt_fail(error, NT_ERROR_IO, "cannot keep the file's %s: %s; name another output", what,
			strerror(number));
	return nt_error_in_file(error, target);
}

static bool has_no_attributes(void)
{
	return errno == ENOTSUP || errno == ENOSYS;
}

/* The names of a file's attributes, each with its NUL; malloc'ed. */
static bool list_attributes(const char *target, char **names, ssize_t *size)
{
	for (;;) {
		*names = NULL;
		*size = listxattr(target, NULL, 0);
		if (*size <= 0)
			return *size == 0 || has_no_attributes();
		*names = nt_alloc((size_t)*size, 1);
		if (!*names)
			return errno = ENOMEM, false;
		const ssize_t got = listxattr(target, *names, (size_t)*size);
		if (got >= 0) {
			*size = got;
			return true;
		}
		free(*names);
		*names = NULL;
		if (errno != ERANGE)
			return false;
	}
}

/* Copies one attribute. The system may refuse those that it keeps for itself. */
static bool copy_attribute(int fd, const char *target, const char *name)
{
	const ssize_t size = getxattr(target, name, NULL, 0);
	void *value = size < 0 ? NULL : nt_alloc((size_t)size, 1);
	const ssize_t got = value ? getxattr(target, name, value, (size_t)size) : -1;
	const bool copied = got >= 0 && fsetxattr(fd, name, value, (size_t)got, 0) == 0;
	const int number = size >= 0 && !value ? ENOMEM : errno;
	free(value);
	errno = number;
	const bool must = strncmp(name, "user.", 5) == 0 || strcmp(name, access_list) == 0;
	return copied || number == ENODATA || (!must && number != ENOMEM);
}

static nt_status keep_extended(int fd, const char *target, nt_error *error)
{
	char *names;
	ssize_t size;
	if (!list_attributes(target, &names, &size))
		return fail_keeping(error, "attributes", target);
	bool listed = false;
	nt_status status = NT_OK;
	for (ssize_t at = 0; at < size && !status; at += (ssize_t)strlen(names + at) + 1) {
		const char *name = names + at;
		const bool is_list = strcmp(name, access_list) == 0;
		listed |= is_list;
		/* those belong to the old content */
		const bool kept = strcmp(name, "security.capability") != 0 && strcmp(name, "security.ima") != 0 &&
			strcmp(name, "security.evm") != 0;
		if (kept && !copy_attribute(fd, target, name))
			status = fail_keeping(error, is_list ? "access list" : "attributes", target);
	}
	free(names);
	/* what the folder gives to new files is not the old file's */
	if (!status && !listed && fremovexattr(fd, access_list) != 0 && errno != ENODATA && !has_no_attributes())
		status = fail_keeping(error, "access list", target);
	return status;
}

nt_status nt_keep_attributes(int fd, const char *target, nt_error *error)
{
	struct stat status;
	if (stat(target, &status) != 0)
		return fail_keeping(error, "attributes", target);
	mode_t mode = status.st_mode & 01777;
	if (fchown(fd, status.st_uid, status.st_gid) != 0 && fchown(fd, (uid_t)-1, status.st_gid) != 0)
		mode = (mode & ~(mode_t)070) | (mode & 07) << 3;
	const nt_status kept = keep_extended(fd, target, error);
	if (kept)
		return kept;
	return fchmod(fd, mode) == 0 ? NT_OK : fail_keeping(error, "mode", target);
}

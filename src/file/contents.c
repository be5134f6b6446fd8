/* SPDX-License-Identifier: MIT */
/*
 * Whole files: see contents.h. They are read in parts that are let go of, so that large ones do not fill the memory.
 */
#include "file/contents.h"

#include <string.h>
#include <unistd.h>
#include "file/input.h"

enum { COMPARED_BYTES = 2 * 1024 * 1024 };

/* Opens what may be somebody else's: *opened is false where we are not allowed to or it is gone. */
static nt_status open_foreign(nt_file *file, const char *path, bool *opened, nt_error *error)
{
	*opened = false;
	if (access(path, R_OK) != 0)
		return NT_OK;
	const nt_status status = nt_file_open_untraced(file, path, error);
	*opened = status == NT_OK;
	return status;
}

nt_status nt_same_bytes(const char *a, const char *b, bool *same, nt_error *error)
{
	nt_file x, y;
	bool opened;
	*same = false;
	nt_status status = open_foreign(&x, a, &opened, error);
	if (!opened)
		return status;
	status = open_foreign(&y, b, &opened, error);
	if (opened) {
		*same = x.size == y.size;
		for (size_t at = 0, part; *same && at < x.size; at += part) {
			part = x.size - at < COMPARED_BYTES ? x.size - at : COMPARED_BYTES;
			nt_file_fetch(&x, at, part);
			nt_file_fetch(&y, at, part);
			*same = memcmp(x.data + at, y.data + at, part) == 0;
			nt_file_release(&x, at, part);
			nt_file_release(&y, at, part);
		}
		nt_file_close(&y);
	}
	nt_file_close(&x);
	return status;
}

nt_status nt_digest_of_file(const char *path, char text[NT_DIGEST_TEXT], nt_error *error)
{
	nt_file file;
	bool opened;
	text[0] = '\0';
	const nt_status status = open_foreign(&file, path, &opened, error);
	if (!opened)
		return status;
	nt_digest *digest = nt_digest_create();
	for (size_t at = 0, part; digest && at < file.size; at += part) {
		part = file.size - at < COMPARED_BYTES ? file.size - at : COMPARED_BYTES;
		nt_file_fetch(&file, at, part);
		nt_digest_add(digest, file.data + at, part);
		nt_file_release(&file, at, part);
	}
	nt_file_close(&file);
	if (digest)
		nt_digest_text(digest, text);
	nt_digest_free(digest);
	return digest ? NT_OK : nt_fail_memory(error);
}

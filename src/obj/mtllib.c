/* SPDX-License-Identifier: MIT */
/*
 * MTL: the files that mtllib statements name. A library that is not there, or is no text, is a finding: meshes can do
 * without.
 */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "file/input.h"
#include "file/path.h"
#include "obj/parts.h"

/* Arguments of reading the libraries that mtllib statements name. */
typedef struct request {
	nt_scene *scene;
	const nt_read_options *options;
	size_t line;
	nt_mtl *mtl;
	nt_error *error;
} request;

/* Why a file name may not be followed, NULL where it may. */
static const char *outside_reason(const char *name)
{
	if (name[0] == '/')
		return "an absolute path, which is followed only with --outside=yes";
	if (((name[0] | 0x20) >= 'a' && (name[0] | 0x20) <= 'z') && name[1] == ':')
		return "a path with a drive letter";
	if (nt_uri_has_parent_step(name))
		return "leaves the folder of the OBJ, which is followed only with --outside=yes";
	return NULL;
}

/* Opens a library; *reason, which may be the error's message, says why it is done without. */
static nt_status open_library(const request *q, const char *name, const char *path, nt_file *file,
	const char **reason, nt_error *error)
{
	const bool confined = q->options->outside != NT_OUTSIDE_YES;
	bool inside = true;
	*reason = !*name ? "no file name"
		: nt_name_is_too_long(name) ? "a name that is too long for any file"
		: confined ? outside_reason(name) : NULL;
	if (*reason)
		return NT_OK;
	nt_buffer folder = {0};
	nt_status status = confined ? nt_link_folder(&folder, q->scene->path, error) : NT_OK;
	if (!status && confined)
		status = nt_path_stays_inside(folder.data, name, &inside, error);
	nt_buffer_free(&folder);
	if (!status && !inside)
		*reason = "leaves the folder of the OBJ by a symbolic link, which is followed only "
			  "with --outside=yes";
	else if (!status)
		status = nt_file_open(file, path, NT_NAMED_BY_DOCUMENT, error);
	if (status != NT_ERROR_MISSING)
		return status;
	*reason = error->message;
	return NT_OK;
}

/* Notes that a file is read; *before: it has been. */
static nt_status note_file(const request *q, const nt_file *file, bool *before)
{
	const size_t count = q->mtl->files.count;
	const nt_file_id id = {file->device, file->inode};
	const uint32_t number = nt_key_add(&q->mtl->files, &id, sizeof id);
	*before = number != count;
	return number != UINT32_MAX ? NT_OK : nt_fail_memory(q->error);
}

/* Reads one library; what cannot be read is reported unless `quiet`. *found says whether it was. */
static nt_status read_library(const request *q, const char *text, size_t length, bool quiet,
	bool *found)
{
	*found = false;
	const char *name = nt_mtl_file_name(&q->scene->arena, text, text + length);
	nt_buffer beside = {0};
	nt_path_beside(&beside, q->scene->path, name ? name : "");
	const char *path = name && !beside.failed ? nt_arena_text(&q->scene->arena, beside.data, beside.size) : NULL;
	nt_buffer_free(&beside);
	if (!path)
		return nt_fail_memory(q->error);
	const char *reason;
	nt_file file;
	nt_error failure;
	nt_status status = open_library(q, name, path, &file, &reason, &failure);
	if (status)
		*q->error = failure;
	if (status)
		return status;
	*found = !reason;
	bool before = false;
	if (*found)
		status = note_file(q, &file, &before);
	if (*found && !status && !before) {
		if (file.size && memchr(file.data, '\0', file.size))
			reason = "a byte 0 in it, expected text";
		else
			status = nt_mtl_parse(q->scene, path, file.data, file.size, q->mtl, q->error);
	}
	if (*found)
		nt_file_close(&file);
	if (reason && !(quiet && !*found)) {
		const nt_place place = nt_line_place(q->scene->path, q->line);
		nt_finding_add(&q->scene->findings, NT_CODE_MTL_MISSING, &place, 1, "%.*s: %.*s",
			NT_CUT(120, name), NT_CUT(120, reason));
		q->mtl->incomplete = true;
	}
	return status;
}

/* The end of the first of several names: behind ".mtl" before a blank. */
static size_t first_name_length(const char *text, size_t length)
{
	for (size_t i = 0; i + 4 < length; i++)
		if (strncasecmp(text + i, ".mtl", 4) == 0 && is_blank(text[i + 4]))
			return i + 4;
	return length;
}

nt_status nt_mtl_read(nt_scene *scene, const char *names, size_t length, size_t line,
	const nt_read_options *options, nt_mtl *mtl, nt_error *error)
{
	const request q = {scene, options, line, mtl, error};
	/* The format allows several names, exporters write single names with blanks: one is tried first. */
	const bool several = first_name_length(names, length) < length;
	bool found;
	nt_status status = read_library(&q, names, length, several, &found);
	if (!several || found)
		return status;
	while (!status && length) {
		const size_t first = first_name_length(names, length);
		status = read_library(&q, names, first, false, &found);
		names += first;
		length -= first;
		while (length && is_blank(*names)) {
			names++;
			length--;
		}
	}
	return status;
}

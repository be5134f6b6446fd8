/* SPDX-License-Identifier: MIT */
/*
 * Records: see record.h. The lines are in record_file.c; here is what they say, and whether it still holds.
 */
#include "batch/record.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/buffer.h"
#include "batch/record_file.h"
#include "file/input.h"
#include "file/lookup.h"
#include "file/relative_path.h"
#include "file/uri.h"
#include "json/json.h"
#include "nmtan.h"
#include "report/render/words.h"

/* A file system's clock ticks every 10 milliseconds or faster, but where it keeps no fractions of a second: there
 * every two (FAT). A file that changed so shortly before it was read may have changed after that unseen. */
static const int64_t fine_tick = 20 * 1000000, coarse_tick = INT64_C(2000) * 1000000;

static const char line_begin[] = "{\"output\":\"";

/* An input's, an output's, and those of two sidecars. */
enum { KNOWN_FOLDERS = 4 };

struct nt_record {
	nt_record_file file;
	char *folder; /* absolute, links resolved */
	pthread_mutex_t lock; /* of what follows */
	struct {
		char *spelled, *real;
	} known[KNOWN_FOLDERS]; /* folders as they were spelled lately, and where they are */
	size_t oldest;
};

/* ---- names ---- */

/* What is below a file, and so will never be there, is where it is spelled. */
static nt_status find_folder(nt_buffer *folder, const char *path, nt_error *error)
{
	nt_status status = nt_link_folder(folder, path, error);
	if (status == NT_ERROR_MISSING) {
		folder->size = 0;
		status = nt_path_absolute(folder, path, error);
		const char *slash = status ? NULL : strrchr(folder->data, '/');
		if (slash && slash > folder->data)
			folder->data[folder->size = (size_t)(slash - folder->data)] = '\0';
	}
	if (status)
		nt_buffer_free(folder);
	return status;
}

/* Which of the known folders has this spelling; KNOWN_FOLDERS: none. */
static size_t find_known(const nt_record *record, const char *path, size_t length)
{
	size_t i = 0;
	while (i < KNOWN_FOLDERS && !(record->known[i].spelled && strlen(record->known[i].spelled) == length &&
					     memcmp(record->known[i].spelled, path, length) == 0))
		i++;
	return i;
}

/* Looks where a folder is, and forgets another one. */
static nt_status make_known(nt_record *record, const char *path, size_t length, size_t *found, nt_error *error)
{
	nt_buffer real = {0};
	const nt_status status = find_folder(&real, path, error);
	char *spelled = status ? NULL : strndup(path, length);
	if (!spelled) {
		nt_buffer_free(&real);
		return status ? status : nt_fail_memory(error);
	}
	*found = record->oldest++ % KNOWN_FOLDERS;
	free(record->known[*found].spelled);
	free(record->known[*found].real);
	record->known[*found].spelled = spelled;
	record->known[*found].real = real.data;
	return NT_OK;
}

/* Where the folder of a path is; neighbours mostly have the same. Appended. */
static nt_status append_folder(nt_record *record, const char *path, nt_buffer *real, nt_error *error)
{
	const char *slash = strrchr(path, '/');
	const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
	pthread_mutex_lock(&record->lock);
	size_t at = find_known(record, path, length);
	const nt_status status = at < KNOWN_FOLDERS ? NT_OK : make_known(record, path, length, &at, error);
	if (!status)
		nt_buffer_text(real, record->known[at].real);
	pthread_mutex_unlock(&record->lock);
	return status;
}

/* Appends the URI of a file from the record's folder on. */
static nt_status append_uri(nt_record *record, const char *path, nt_buffer *uri, nt_error *error)
{
	nt_buffer real = {0};
	const char *slash = strrchr(path, '/');
	nt_status status = append_folder(record, path, &real, error);
	if (!status) {
		nt_buffer_format(&real, "%s%s", real.size > 1 ? "/" : "", slash ? slash + 1 : path);
		if (!real.failed)
			nt_link_uri(uri, record->folder, real.data);
		if (real.failed || uri->failed)
			status = nt_fail_memory(error);
	}
	nt_buffer_free(&real);
	return status;
}

/* ---- what a line says ---- */

typedef struct line_file {
	nt_buffer path; /* that can be opened */
	uint64_t size, modified, noted;
	const char *digest; /* NULL: none; in the line */
} line_file;

static bool read_path(const nt_record *record, const nt_json_value *uri, nt_buffer *path)
{
	size_t length;
	const char *text = nt_json_get_string(uri, &length);
	path->size = 0;
	nt_buffer_format(path, "%s/", record->folder);
	if (text)
		nt_uri_append_decoded(path, text, length);
	return text != NULL;
}

static bool read_file(const nt_record *record, const nt_json_value *value, line_file *file)
{
	file->digest = nt_json_get_string(nt_json_find(value, "xxh128"), NULL);
	return read_path(record, nt_json_find(value, "uri"), &file->path) &&
	       nt_json_get_uint64(nt_json_find(value, "bytes"), &file->size) &&
	       nt_json_get_uint64(nt_json_find(value, "modified"), &file->modified) &&
	       nt_json_get_uint64(nt_json_find(value, "noted"), &file->noted);
}

static bool is_text(const nt_json_value *value, const char *expected)
{
	const char *text = nt_json_get_string(value, NULL);
	return text && strcmp(text, expected) == 0;
}

/* Of a file that was read: who changes it again has no reason to wait. */
static bool may_have_changed_unseen(uint64_t modified, uint64_t noted)
{
	const int64_t tick = modified % 1000000000 ? fine_tick : coarse_tick;
	return (int64_t)(noted - modified) < tick;
}

/* ---- looking ---- */

typedef struct look {
	const nt_record *record;
	const nt_making *making;
	nt_trace *trace;
	nt_error *error;
	line_file file;
} look;

static nt_status has_digest(const line_file *file, bool *has, nt_error *error)
{
	char digest[NT_DIGEST_TEXT];
	const nt_status status = nt_digest_of_file(file->path.data, digest, error);
	*has = !status && file->digest && strcmp(digest, file->digest) == 0;
	return status;
}

/* Whether a file is as it was; `info` receives how it is. `read`: it is one that was read. */
static nt_status is_same(look *l, bool read, struct stat *info, bool *same)
{
	const line_file *file = &l->file;
	*same = false;
	if (file->path.failed)
		return nt_fail_memory(l->error);
	nt_status status = nt_lookup_found(file->path.data, info, same, l->error);
	if (status || !*same)
		return status;
	*same = (uint64_t)info->st_size == file->size;
	const bool by_content = l->making->by == NT_UPDATE_BY_CONTENT && file->digest;
	if (!by_content)
		*same = *same && (uint64_t)nt_trace_modified(info) == file->modified;
	if (*same && (by_content || (read && may_have_changed_unseen(file->modified, file->noted))))
		status = has_digest(file, same, l->error);
	return status;
}

/* Whether a file that was read is one that was written, so that it is judged as that. */
static bool is_written_too(const nt_json_value *line, const nt_json_value *file)
{
	const nt_json_value *written = nt_json_find(line, "written");
	for (size_t i = 0; i < nt_json_count(written); i++)
		if (nt_json_equal(nt_json_find(nt_json_at(written, i), "uri"), nt_json_find(file, "uri")))
			return true;
	return false;
}

static nt_status look_at_read(look *l, const nt_json_value *line, bool *same)
{
	const nt_json_value *read = nt_json_find(line, "read");
	nt_status status = NT_OK;
	*same = nt_json_count(read) > 0;
	for (size_t i = 0; i < nt_json_count(read) && *same && !status; i++) {
		const nt_json_value *file = nt_json_at(read, i);
		struct stat info = l->making->input_info;
		*same = read_file(l->record, file, &l->file);
		if (*same && !is_written_too(line, file))
			status = is_same(l, true, &info, same);
		/* the first one is the input, by whatever name */
		if (*same && i == 0)
			*same = nt_same_file(&info, &l->making->input_info);
		if (*same && !status && l->trace)
			nt_trace_read(i == 0 ? l->making->input : l->file.path.data, &info);
	}
	return status;
}

static nt_status look_at_written(look *l, const nt_json_value *line, bool *same)
{
	const nt_json_value *written = nt_json_find(line, "written");
	nt_status status = NT_OK;
	*same = nt_json_count(written) > 0;
	for (size_t i = 0; i < nt_json_count(written) && *same && !status; i++) {
		struct stat info;
		*same = read_file(l->record, nt_json_at(written, i), &l->file);
		if (*same)
			status = is_same(l, false, &info, same);
		if (*same && !status && l->trace)
			nt_trace_written(l->file.path.data, NULL, &info);
	}
	return status;
}

static nt_status look_at_missing(look *l, const nt_json_value *line, bool *same)
{
	const nt_json_value *missing = nt_json_find(line, "missing");
	nt_status status = NT_OK;
	*same = true;
	for (size_t i = 0; i < nt_json_count(missing) && *same && !status; i++) {
		struct stat info;
		bool found;
		*same = read_path(l->record, nt_json_at(missing, i), &l->file.path);
		if (l->file.path.failed)
			return nt_fail_memory(l->error);
		if (*same)
			status = nt_lookup_found(l->file.path.data, &info, &found, l->error);
		*same = *same && !status && !found;
	}
	return status;
}

static nt_status look_at(look *l, const nt_json_value *line, bool *same)
{
	*same = is_text(nt_json_find(line, "nmtan"), nmtan_version()) &&
		is_text(nt_json_find(line, "options"), l->making->options);
	nt_status status = NT_OK;
	if (*same)
		status = look_at_read(l, line, same);
	if (!status && *same)
		status = look_at_missing(l, line, same);
	if (!status && *same)
		status = look_at_written(l, line, same);
	nt_buffer_free(&l->file.path);
	return status;
}

nt_status nt_record_look(nt_record *record, const nt_making *making, nt_freshness *freshness, nt_trace *trace,
	nt_error *error)
{
	nt_buffer key = {0};
	nt_error ignored;
	size_t length;
	*freshness = NT_FRESH_UNKNOWN;
	nt_status status = append_uri(record, making->output, &key, error);
	const char *text = status ? NULL : nt_record_file_find(&record->file, key.data, &length);
	nt_buffer_free(&key);
	if (!text)
		return status;
	nt_json *line = NULL;
	*freshness = NT_FRESH_STALE;
	if (nt_json_parse(&line, text, length, NULL, &ignored))
		return ignored.status == NT_ERROR_MEMORY ? nt_fail_memory(error) : NT_OK;
	bool same = false;
	look l = {.record = record, .making = making, .trace = trace, .error = error};
	nt_trace *outer = nt_trace_use(trace);
	status = look_at(&l, nt_json_root(line), &same);
	nt_trace_use(outer);
	nt_json_free(line);
	if (!status && trace && trace->failed)
		status = nt_fail_memory(error);
	if (!status && same)
		*freshness = NT_FRESH_CURRENT;
	return status;
}

/* ---- appending ---- */

/* The digest of a file that is still as it was noted; *has is false where it is not. */
static nt_status digest_of(const nt_trace_file *file, char digest[NT_DIGEST_TEXT], bool *has, nt_error *error)
{
	const char *path = file->present ? file->present : file->path;
	struct stat info;
	const nt_status status = nt_digest_of_file(path, digest, error);
	*has = !status && digest[0] && stat(path, &info) == 0 && (uint64_t)info.st_size == file->size &&
		nt_trace_modified(&info) == file->modified;
	return status;
}

static nt_status append_file(nt_record *record, const nt_trace_file *file, nt_update_by by, nt_buffer *line,
	bool *known, nt_error *error)
{
	char digest[NT_DIGEST_TEXT];
	nt_buffer_text(line, "{\"uri\":\"");
	nt_status status = append_uri(record, file->path, line, error);
	nt_buffer_format(line, "\",\"bytes\":%" PRIu64 ",\"modified\":%" PRId64 ",\"noted\":%" PRId64, file->size,
		file->modified, file->noted);
	if (!status && (by == NT_UPDATE_BY_CONTENT || (file->kind == NT_TRACE_READ &&
			       may_have_changed_unseen((uint64_t)file->modified, (uint64_t)file->noted)))) {
		status = digest_of(file, digest, known, error);
		if (!status && *known)
			nt_buffer_format(line, ",\"xxh128\":\"%s\"", digest);
	}
	nt_buffer_text(line, "}");
	return status;
}

static nt_status append_files(nt_record *record, const nt_making *making, const nt_trace *trace, nt_trace_kind kind,
	nt_buffer *line, bool *known, nt_error *error)
{
	nt_status status = NT_OK;
	const char *comma = "";
	for (size_t i = 0; i < trace->count && !status && *known; i++) {
		const nt_trace_file *file = &trace->files[i];
		if (file->kind != kind)
			continue;
		nt_buffer_text(line, comma);
		comma = ",";
		if (kind == NT_TRACE_MISSING) {
			nt_buffer_text(line, "\"");
			status = append_uri(record, file->path, line, error);
			nt_buffer_text(line, "\"");
		} else {
			status = append_file(record, file, making->by, line, known, error);
		}
	}
	return status;
}

/* Of files that changed while they were read the line says that nothing was written, so that it never holds: without a
 * line the times would decide. */
static nt_status make_line(nt_record *record, const nt_making *making, const nt_trace *trace, nt_buffer *line,
	nt_error *error)
{
	bool is_known = !trace->unsure, *known = &is_known;
	nt_buffer_text(line, line_begin);
	nt_status status = append_uri(record, making->output, line, error);
	nt_buffer_format(line, "\",\"nmtan\":\"%s\",\"options\":", nmtan_version());
	nt_json_string(making->options, line);
	nt_buffer_text(line, ",\"read\":[");
	if (!status)
		status = append_files(record, making, trace, NT_TRACE_READ, line, known, error);
	nt_buffer_text(line, "],\"missing\":[");
	if (!status)
		status = append_files(record, making, trace, NT_TRACE_MISSING, line, known, error);
	nt_buffer_text(line, "],\"written\":[");
	const size_t begin = line->size;
	if (!status)
		status = append_files(record, making, trace, NT_TRACE_WRITTEN, line, known, error);
	if (!*known && !line->failed)
		line->size = begin;
	nt_buffer_text(line, "]}\n");
	return status || !line->failed ? status : nt_fail_memory(error);
}

nt_status nt_record_append(nt_record *record, const nt_making *making, const nt_trace *trace, nt_error *error)
{
	nt_buffer line = {0};
	nt_status status = make_line(record, making, trace, &line, error);
	if (!status)
		status = nt_record_file_append(&record->file, line.data, line.size, error);
	nt_buffer_free(&line);
	return status;
}

/* ---- opening ---- */

nt_status nt_record_open(nt_record **record, const char *path, bool tidy, nt_error *error)
{
	nt_buffer folder = {0};
	nt_record *made = nt_calloc(1, sizeof *made);
	if (!made)
		return nt_fail_memory(error);
	pthread_mutex_init(&made->lock, NULL);
	nt_status status = nt_link_folder(&folder, path, error);
	made->folder = folder.data;
	if (!status)
		status = nt_record_file_open(&made->file, path, line_begin, tidy, error);
	if (status)
		nt_record_close(made);
	else
		*record = made;
	return status;
}

void nt_record_close(nt_record *record)
{
	if (!record)
		return;
	nt_record_file_close(&record->file);
	pthread_mutex_destroy(&record->lock);
	free(record->folder);
	for (size_t i = 0; i < KNOWN_FOLDERS; i++) {
		free(record->known[i].spelled);
		free(record->known[i].real);
	}
	free(record);
}

/* SPDX-License-Identifier: MIT */
/*
 * Doing only what is needed: see batch.h. A look notes in the trace what it finds, as a run does, so that one function
 * writes the lines of both.
 */
#include "batch/batch.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "batch/inside.h"
#include "file/input.h"
#include "file/path.h"
#include "json/json.h"
#include "nmtan.h"
#include "report/render/render.h"

static const char record_name[] = ".nmtan-record", files_begin[] = ",\"files\":[";

/* By nt_trace_kind; by 1 + nt_severity. */
static const char *const kinds[] = {"read", "missing", "written", "searched", "link", "outside"};
static const char *const verdicts[] = {"none", "info", "warning", "error"};
enum { KINDS = sizeof kinds / sizeof *kinds, VERDICTS = sizeof verdicts / sizeof *verdicts };

typedef struct nt_open_record {
	nt_record file;
	nt_buffer folder;      /* the record's, absolute, links resolved; "" is the root */
	size_t spelled_length; /* of the folder in the record's path, with the slash */
	nt_buffer renewed;     /* lines */
	size_t looked;         /* outputs of the record that this run has looked at */
} open_record;

struct nt_update {
	nt_update_options options;
	nt_buffer current;    /* folder; "" is the root */
	pthread_mutex_t lock; /* of what follows, and of what records have beside their file */
	open_record **records;
	size_t capacity;
	nt_name_table paths; /* of the records */
};

/* ---- names ---- */

/* A path without "./" before it. */
static const char *without_dot(const char *path)
{
	while (path[0] == '.' && path[1] == '/')
		path += 1 + strspn(path + 1, "/");
	return path;
}

/* Appends the URI of a file from the record's folder on. A step ".." stays: it may be behind a link. */
static void append_uri(const nt_update *update, const open_record *record, const char *path, nt_buffer *uri)
{
	const size_t spelled = record->spelled_length;
	path = without_dot(path);
	if (spelled ? strncmp(path, record->file.path, spelled) == 0 : path[0] != '/') {
		nt_uri_append_path(uri, path + spelled);
		return;
	}
	nt_buffer whole = {0};
	nt_buffer_format(&whole, "%s%s%s", path[0] == '/' ? "" : update->current.data, path[0] == '/' ? "" : "/", path);
	if (!whole.failed)
		nt_link_uri(uri, record->folder.size ? record->folder.data : "/", whole.data);
	nt_buffer_free_into(&whole, uri);
}

/* The path, which can be opened, of a URI. */
static bool read_path(const open_record *record, const nt_json_value *uri, nt_buffer *path)
{
	size_t length;
	const char *text = nt_json_get_string(uri, &length);
	path->size = 0;
	nt_buffer_format(path, "%s/", record->folder.data);
	if (text)
		nt_uri_append_decoded(path, text, length);
	return text && !path->failed;
}

/* A path below the record's folder becomes what the run calls it, as the record's own name is spelled. */
static void spell(const open_record *record, nt_buffer *path)
{
	const char *rest = path->data + record->folder.size + 1;
	nt_buffer spelled = {0};
	if (!record->spelled_length || nt_uri_has_parent_step(rest))
		return;
	nt_buffer_format(&spelled, "%.*s%s", (int)record->spelled_length, record->file.path, rest);
	if (!spelled.failed) {
		nt_buffer_free(path);
		*path = spelled;
	}
}

/* ---- records ---- */

static void close_record(open_record *record)
{
	nt_error ignored; /* without these lines more is read another time, nothing else */
	if (record->renewed.size && !record->renewed.failed)
		nt_record_append(&record->file, record->renewed.data, record->renewed.size, &ignored);
	nt_buffer_free(&record->renewed);
	nt_buffer_free(&record->folder);
	nt_record_close(&record->file);
	free(record);
}

/* The record of a path, opened by the first who asks for it. */
static nt_status get(nt_update *update, const char *path, open_record **found, nt_error *error)
{
	path = without_dot(path);
	const uint32_t known = nt_name_find(&update->paths, path, strlen(path));
	if (known != UINT32_MAX) {
		*found = update->records[known];
		return NT_OK;
	}
	open_record *record = nt_calloc(1, sizeof *record);
	if (!record)
		return nt_fail_memory(error);
	nt_status status = nt_link_folder(&record->folder, path, error);
	if (record->folder.size == 1)
		record->folder.data[record->folder.size = 0] = '\0';
	record->spelled_length = nt_folder_length(path);
	if (!status)
		status = nt_record_open(&record->file, path, !update->options.dry_run, error);
	const size_t count = update->paths.count + 1;
	if (!status && (!nt_grow((void **)&update->records, &update->capacity, count, sizeof record) ||
		nt_name_add(&update->paths, record->file.path, strlen(path)) == UINT32_MAX))
		status = nt_fail_memory(error);
	if (status)
		close_record(record);
	else
		update->records[count - 1] = *found = record;
	return status;
}

static nt_status get_of_output(nt_update *update, const char *output, open_record **record, nt_error *error)
{
	const nt_update_options *o = &update->options;
	/* of a folder, named with its slash or by nothing */
	const char *folder = o->folder ? o->folder : output;
	const size_t length = o->folder ? strlen(folder) : nt_folder_length(output);
	nt_buffer path = {0};
	if (o->record)
		nt_buffer_text(&path, o->record);
	else
		nt_buffer_format(&path, "%.*s%s%s", (int)length, folder,
			length && folder[length - 1] != '/' ? "/" : "", record_name);
	pthread_mutex_lock(&update->lock);
	const nt_status status = path.failed ? nt_fail_memory(error) : get(update, path.data, record, error);
	pthread_mutex_unlock(&update->lock);
	nt_buffer_free(&path);
	return status;
}

nt_status nt_update_begin(nt_update **update, const nt_update_options *options, nt_error *error)
{
	open_record *record;
	*update = nt_calloc(1, sizeof **update);
	if (!*update)
		return nt_fail_memory(error);
	(*update)->options = *options;
	pthread_mutex_init(&(*update)->lock, NULL);
	nt_status status = nt_path_absolute(&(*update)->current, ".", error);
	if ((*update)->current.size == 1)
		(*update)->current.data[(*update)->current.size = 0] = '\0';
	/* the only one can be refused before anything runs; the folder of -d may be still to come, in a dry run */
	if (!status && options->record) {
		struct stat info;
		char folder[PATH_MAX];
		status = nt_lookup(nt_folder_of(options->record, folder), &info, error);
	}
	return status || (!options->record && !options->folder) ? status : get_of_output(*update, "", &record, error);
}

void nt_update_end(nt_update *update)
{
	if (!update)
		return;
	for (size_t i = 0; i < update->paths.count; i++)
		close_record(update->records[i]);
	free(update->records);
	nt_buffer_free(&update->current);
	nt_name_table_free(&update->paths);
	pthread_mutex_destroy(&update->lock);
	free(update);
}

/* Whether a line's output is there, and its input is not. */
static bool is_left_over(const open_record *record, const nt_json_value *line, nt_buffer *output)
{
	nt_buffer input = {0};
	struct stat info;
	const nt_json_value *files = nt_json_find(line, "files"), *source = NULL;
	for (size_t i = 0; !source && i < nt_json_count(files); i++)
		source = nt_json_find(nt_json_at(files, i), kinds[NT_TRACE_READ]);
	const bool left = read_path(record, nt_json_find(line, "output"), output) &&
		read_path(record, source, &input) && stat(output->data, &info) == 0 &&
		stat(input.data, &info) != 0 && errno == ENOENT;
	nt_buffer_free(&input);
	return left;
}

size_t nt_update_left_over(const nt_update *update, nt_buffer *first)
{
	size_t count = 0;
	nt_buffer output = {0}, name = {0};
	for (size_t i = 0; update && i < update->paths.count; i++) {
		const open_record *record = update->records[i];
		const nt_record *file = &record->file;
		for (size_t k = 0; k < file->outputs.count && record->looked < file->outputs.count; k++) {
			nt_json *line;
			nt_error ignored;
			if (nt_json_parse(&line, file->lines[k].text, file->lines[k].length, NULL, &ignored))
				continue;
			if (is_left_over(record, nt_json_root(line), &output)) {
				name.size = 0;
				nt_buffer_format(&name, "%.*s%s", (int)record->spelled_length, file->path,
					output.data + record->folder.size + 1);
				/* lines are in the order in which threads were done */
				if (!name.failed && (count == 0 || strcmp(name.data, first->data) < 0)) {
					first->size = 0;
					nt_buffer_text(first, name.data);
				}
				count++;
			}
			nt_json_free(line);
		}
	}
	nt_buffer_free(&output);
	nt_buffer_free(&name);
	return count;
}

/* ---- writing ---- */

/* A file system's clock ticks every 10 milliseconds or faster, but where it keeps no fractions of a second: there
 * every two (FAT). A file that changed so shortly before it was read may have changed after that unseen. */
static bool is_recent(int64_t changed, int64_t noted)
{
	static const int64_t fine_tick = 20 * 1000000, coarse_tick = INT64_C(2000) * 1000000;
	return noted - changed < (changed % 1000000000 ? fine_tick : coarse_tick);
}

static void append_times(nt_buffer *text, int64_t modified, int64_t changed, uint64_t inode)
{
	nt_buffer_format(text, ",\"modified\":%" PRIu64 ",\"changed\":%" PRIu64 ",\"inode\":%" PRIu64,
		(uint64_t)modified, (uint64_t)changed, inode);
}

/* Appends how a file was when it was noted. False: it is another one now. */
static bool append_state(nt_buffer *text, const nt_trace_file *file, bool by_content, bool recent)
{
	char digest[NT_DIGEST_TEXT] = "";
	struct stat info;
	nt_error ignored;
	const bool is_written = file->kind == NT_TRACE_WRITTEN, has_digest = by_content || (recent && !is_written);
	if (has_digest && (nt_digest_of_file(file->path, digest, &ignored) || !digest[0]))
		return false;
	/* renaming changes the inode's time; of another size the line is not true */
	if (stat(file->path, &info) != 0 || info.st_ino != file->inode || nt_trace_modified(&info) != file->modified ||
		(!is_written && nt_trace_changed(&info) != file->changed))
		return false;
	nt_buffer_format(text, ",\"bytes\":%" PRIu64, file->size);
	if (has_digest)
		nt_buffer_format(text, ",\"xxh128\":\"%s\"", digest);
	if (!by_content)
		append_times(text, file->modified, nt_trace_changed(&info), file->inode);
	return true;
}

static bool is_written_too(const nt_trace *trace, const char *path)
{
	for (size_t i = trace->count; i-- > 0 && trace->files[i].kind == NT_TRACE_WRITTEN;)
		if (strcmp(without_dot(trace->files[i].path), without_dot(path)) == 0)
			return true;
	return false;
}

/* Appends what a run has met, and ends the line. False: files changed meanwhile, and nobody knows what was read. */
static bool append_files(const nt_update *update, const open_record *record, const nt_trace *trace, nt_buffer *line)
{
	nt_buffer_text(line, files_begin);
	for (size_t i = 0; i < trace->count; i++) {
		const nt_trace_file *file = &trace->files[i];
		const bool by_content = update->options.by == NT_UPDATE_BY_CONTENT,
			   recent = is_recent(file->modified, file->noted) || is_recent(file->changed, file->noted);
		nt_buffer_format(line, "%s{\"%s\":\"", i ? "," : "", kinds[file->kind]);
		append_uri(update, record, file->path, line);
		nt_buffer_text(line, "\"");
		if (file->found) {
			nt_buffer_format(line, ",\"%s\":\"", file->kind == NT_TRACE_SEARCHED ? "found" : "to");
			if (file->kind == NT_TRACE_LINK)
				append_uri(update, record, file->found, line);
			else
				nt_uri_append_path(line, file->found);
			nt_buffer_text(line, "\"");
		}
		if (file->kind == NT_TRACE_SEARCHED && !by_content && !recent)
			append_times(line, file->modified, file->changed, file->inode);
		const bool has_state = file->kind == NT_TRACE_WRITTEN ||
			(file->kind == NT_TRACE_READ && !is_written_too(trace, file->path));
		if (has_state && !append_state(line, file, by_content, recent))
			return false;
		nt_buffer_text(line, "}");
	}
	nt_buffer_text(line, "]");
	nt_record_end(line);
	return !line->failed;
}

nt_status nt_update_done(nt_update_job *job, bool made, const nt_trace *trace, nt_error *error)
{
	const nt_update *update = job->update;
	nt_buffer line = {0};
	nt_status status = NT_OK;
	if (made && job->record && !update->options.dry_run) {
		nt_buffer_text(&line, NT_RECORD_BEGIN);
		append_uri(update, job->record, job->output, &line);
		nt_put(&line, NT_JSON, "','nmtan':%s,'options':%s", nmtan_version(),
			job->options.data ? job->options.data : "");
		if (update->options.judging)
			nt_put(&line, NT_JSON, ",'judged':%s,'judging':%s", verdicts[1 + job->worst],
				update->options.judging);
		if (job->keeps_wrong)
			nt_buffer_text(&line, ",\"wrong\":1");
		/* without a line the output is made again, nothing else */
		if (append_files(update, job->record, trace, &line))
			status = nt_record_append(&job->record->file, line.data, line.size, error);
	}
	nt_buffer_free(&line);
	nt_buffer_free(&job->options);
	return status;
}

/* ---- looking ---- */

typedef struct look {
	const nt_update_job *job;
	nt_buffer input; /* its URI */
	bool found_input;
	nt_buffer path; /* of the file in question, as it can be opened */
	bool renews;    /* the line would be another one now: a digest is needed no more, or still to be noted */
} look;

static bool is_text(const nt_json_value *value, const char *expected)
{
	const char *text = nt_json_get_string(value, NULL);
	return text && strcmp(text, expected) == 0;
}

/* Whether the times of a file or folder are those of a line. */
static bool has_times(const nt_json_value *file, const struct stat *info)
{
	uint64_t modified, changed, inode;
	return nt_json_find_uint64(file, "modified", &modified) && nt_json_find_uint64(file, "changed", &changed) &&
		nt_json_find_uint64(file, "inode", &inode) && modified == (uint64_t)nt_trace_modified(info) &&
		changed == (uint64_t)nt_trace_changed(info) && inode == info->st_ino;
}

static bool is_same_file(look *l, const nt_json_value *file, const char *path, const struct stat *info)
{
	const nt_json_value *digest = nt_json_find(file, "xxh128"), *modified = nt_json_find(file, "modified");
	char now[NT_DIGEST_TEXT];
	nt_error ignored;
	uint64_t bytes;
	if (!nt_json_find_uint64(file, "bytes", &bytes) || bytes != (uint64_t)info->st_size)
		return false;
	if (digest && (nt_digest_of_file(path, now, &ignored) || !is_text(digest, now)))
		return false;
	l->renews |= l->job->update->options.by == NT_UPDATE_BY_CONTENT ? modified != NULL : digest != NULL;
	return modified ? has_times(file, info) : digest != NULL;
}

static bool is_still_there(look *l, const nt_json_value *file, const char *uri)
{
	struct stat info = l->job->input_info;
	const bool written = nt_json_find(file, kinds[NT_TRACE_WRITTEN]) != NULL,
		   is_input = !written && strcmp(uri, l->input.data) == 0;
	l->found_input |= is_input;
	if (!is_input && stat(l->path.data, &info) != 0)
		return false;
	if ((written || nt_json_find(file, "bytes")) && !is_same_file(l, file, l->path.data, &info))
		return false;
	nt_trace_note(written ? NT_TRACE_WRITTEN : NT_TRACE_READ, is_input ? l->job->input : l->path.data, NULL, &info);
	return true;
}

static bool is_still_missing(look *l, const nt_json_value *file, const char *uri)
{
	struct stat info;
	(void)file, (void)uri;
	if (stat(l->path.data, &info) == 0 ? S_ISREG(info.st_mode) : errno != ENOENT && errno != ENOTDIR)
		return false;
	nt_trace_note(NT_TRACE_MISSING, l->path.data, NULL, NULL);
	return true;
}

/* Whether a search would find what it has found. */
static bool is_still_found(look *l, const nt_json_value *file, const char *uri)
{
	const nt_json_value *found = nt_json_find(file, "found");
	const size_t folder = nt_folder_length(l->path.data), name_length = l->path.size - folder;
	struct stat info;
	nt_buffer name = {0};
	nt_error ignored;
	char *entry = NULL;
	(void)uri;
	l->path.data[folder - 1] = '\0';
	const bool known = stat(folder > 1 ? l->path.data : "/", &info) == 0 && has_times(file, &info);
	bool same = known || !nt_lookup_any_case(l->path.data, l->path.data + folder, name_length, &entry, &ignored);
	l->path.data[folder - 1] = '/';
	if (known) {
		size_t length = 0;
		const char *text = nt_json_get_string(found, &length);
		if (text)
			nt_uri_append_decoded(&name, text, length);
		same = !name.failed;
		nt_trace_note(NT_TRACE_SEARCHED, l->path.data, text ? name.data : NULL, &info);
	} else if (same) {
		l->renews |= l->job->update->options.by == NT_UPDATE_BY_TIME;
		nt_uri_append_path(&name, entry ? entry : "");
		same = !name.failed && (found ? entry && is_text(found, name.data) : !entry);
	}
	nt_buffer_free(&name);
	free(entry);
	return same;
}

static bool is_still_linked(look *l, const nt_json_value *file, const char *uri)
{
	const nt_json_value *to = nt_json_find(file, "to");
	nt_buffer real = {0}, now = {0};
	nt_error ignored;
	(void)uri;
	const bool is_there = nt_path_real(&real, l->path.data, &ignored) == NT_OK;
	if (is_there)
		append_uri(l->job->update, l->job->record, real.data, &now);
	const bool same = to ? is_there && !now.failed && is_text(to, now.data)
		: !is_there && ignored.status == NT_ERROR_MISSING;
	nt_buffer_free(&real);
	nt_buffer_free(&now);
	return same;
}

static bool is_still_outside(look *l, const nt_json_value *file, const char *uri)
{
	nt_buffer name = {0}, folder = {0};
	nt_error ignored;
	bool inside = true;
	size_t length;
	(void)uri;
	const char *text = nt_json_find_string(file, "to", &length);
	nt_uri_append_decoded(&name, text ? text : "", text ? length : 0);
	bool asked = text && !name.failed && name.size < l->path.size;
	if (asked) {
		l->path.data[l->path.size - name.size - 1] = '\0';
		asked = !nt_path_real(&folder, l->path.data, &ignored) &&
			!nt_path_stays_inside(folder.data, name.data, &inside, &ignored);
	}
	nt_buffer_free(&name);
	nt_buffer_free(&folder);
	return asked && !inside;
}

/* Whether the findings would let a run pass, as far as the line tells. */
static bool passes(const nt_update_options *options, const nt_json_value *line)
{
	int severity = -1;
	if (!options->judging || options->least_failure >= VERDICTS - 1)
		return true;
	while (severity < options->least_failure && !is_text(nt_json_find(line, "judged"), verdicts[1 + severity]))
		severity++;
	return severity < options->least_failure && is_text(nt_json_find(line, "judging"), options->judging);
}

/* Whether all is as a line says. */
static bool holds(look *l, const nt_json_value *line)
{
	static bool (*const is_still[])(look *l, const nt_json_value *file, const char *uri) = {is_still_there,
		is_still_missing, is_still_there, is_still_found, is_still_linked, is_still_outside};
	const nt_json_value *files = nt_json_find(line, "files");
	bool same = is_text(nt_json_find(line, "nmtan"), nmtan_version()) &&
		is_text(nt_json_find(line, "options"), l->job->options.data) && passes(&l->job->update->options, line);
	append_uri(l->job->update, l->job->record, l->job->input, &l->input);
	same &= !l->input.failed;
	for (size_t i = 0; i < nt_json_count(files) && same; i++) {
		const nt_json_value *file = nt_json_at(files, i);
		size_t kind = 0;
		while (kind < KINDS && !nt_json_find(file, kinds[kind]))
			kind++;
		const nt_json_value *uri = kind < KINDS ? nt_json_find(file, kinds[kind]) : NULL;
		same = read_path(l->job->record, uri, &l->path);
		if (same)
			spell(l->job->record, &l->path);
		same = same && is_still[kind](l, file, nt_json_get_string(uri, NULL));
	}
	return same && l->found_input;
}

/* Notes the line of an output with the times that its files have now, if that is another one. */
static void renew(const nt_update_job *job, const nt_name *line, const nt_trace *trace)
{
	open_record *record = job->record;
	const char *files = memmem(line->text, line->length, files_begin, strlen(files_begin));
	nt_buffer text = {0};
	nt_buffer_append(&text, line->text, files ? (size_t)(files - line->text) : 0);
	if (files && append_files(job->update, record, trace, &text) &&
		(text.size - 1 != line->length || memcmp(text.data, line->text, line->length) != 0)) {
		pthread_mutex_lock(&job->update->lock);
		nt_buffer_append(&record->renewed, text.data, text.size);
		pthread_mutex_unlock(&job->update->lock);
	}
	nt_buffer_free(&text);
}

static bool is_current(nt_update_job *job, const nt_name *line, nt_trace *trace)
{
	nt_json *json;
	nt_error ignored;
	look l = {.job = job};
	if (nt_json_parse(&json, line->text, line->length, NULL, &ignored))
		return false;
	nt_trace *outer = nt_trace_use(trace);
	const bool current = holds(&l, nt_json_root(json)) && !trace->failed;
	job->keeps_wrong = current && nt_json_find(nt_json_root(json), "wrong");
	nt_trace_use(outer);
	if (current && l.renews && !job->update->options.dry_run)
		renew(job, line, trace);
	nt_json_free(json);
	nt_buffer_free(&l.input);
	nt_buffer_free(&l.path);
	return current;
}

/* Appends what shapes the output: the options, and from the record's folder on, with which they may be moved, the files
 * that they name and the root of a tree, which images may lie below. */
static nt_status spell_options(nt_update_job *job, const nt_settings *settings, nt_error *error)
{
	const char *folder = job->record->folder.data;
	nt_buffer root = {0};
	nt_status status = settings->root ? nt_path_absolute(&root, settings->root, error) : NT_OK;
	nt_buffer_text(&job->options, job->update->options.options);
	for (size_t i = 0; i < NT_GIVEN_COUNT + settings->texture_path_count; i++) {
		const char *path = i < NT_GIVEN_COUNT ? settings->given_maps[i]
			: settings->texture_paths[i - NT_GIVEN_COUNT];
		if (path) {
			nt_buffer_text(&job->options, i < NT_GIVEN_COUNT ? " at " : " in ");
			append_uri(job->update, job->record, path, &job->options);
		}
	}
	if (settings->root && !status) {
		nt_buffer_format(&job->options, "%s--keep-tree=", job->options.size ? " " : "");
		/* the final slash keeps the name of a root above the record out of the URI: moving changes that name */
		nt_buffer_text(&root, root.data[root.size - 1] == '/' ? "" : "/");
		if (!root.failed)
			nt_link_uri(&job->options, *folder ? folder : "/", root.data);
	}
	const bool failed = root.failed || job->options.failed;
	nt_buffer_free(&root);
	return status || !failed ? status : nt_fail_memory(error);
}

nt_status nt_update_look(nt_update *update, const char *input, const char *output, nt_update_job *job,
	nt_settings *settings, bool *current, nt_trace *trace, nt_error *error)
{
	const nt_update_options *o = &update->options;
	struct stat info;
	nt_buffer key = {0};
	*job = (nt_update_job){.update = update, .input = input, .output = output, .worst = -1};
	*current = false;
	/* regular files have records; the output need not be there yet */
	const bool made = strcmp(output, "-") != 0 && stat(output, &info) == 0;
	if (strcmp(input, "-") == 0 || strcmp(output, "-") == 0 || stat(input, &job->input_info) != 0 ||
		!S_ISREG(job->input_info.st_mode) || (made && !S_ISREG(info.st_mode)))
		return NT_OK;
	nt_status status = get_of_output(update, output, &job->record, error);
	if (!status)
		status = spell_options(job, settings, error);
	if (status)
		return status;
	append_uri(update, job->record, output, &key);
	const bool looks = o->look && made && !key.failed;
	const nt_name *line = looks ? nt_record_find(&job->record->file, &key) : NULL;
	if (line) {
		pthread_mutex_lock(&update->lock);
		job->record->looked++;
		pthread_mutex_unlock(&update->lock);
		*current = is_current(job, line, trace);
	}
	nt_buffer_free(&key);
	if (o->look && settings->equal == NT_EQUAL_REPLACE)
		settings->equal = made && !line ? NT_EQUAL_TOUCH : NT_EQUAL_KEEP;
	return NT_OK;
}

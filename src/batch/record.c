/* SPDX-License-Identifier: MIT */
/*
 * Records: see record.h. The lines are in record_file.c; here is what they say, and whether it still holds.
 */
#include "batch/record.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/buffer.h"
#include "batch/record_file.h"
#include "file/input.h"
#include "file/lookup.h"
#include "file/relative_path.h"
#include "file/uri.h"
#include "file/way.h"
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
	bool tidy;
	pthread_mutex_t lock; /* of what follows */
	struct {
		char *spelled, *real;
		nt_buffer links; /* on the way to it, as in a line, each with a comma behind */
	} known[KNOWN_FOLDERS];	 /* folders as they were spelled lately, and where they are */
	size_t oldest;
	nt_buffer renewed; /* lines */
	size_t looked;     /* outputs of the record that this run has looked at */
};

/* ---- names ---- */

typedef struct link_list {
	const nt_record *record;
	nt_buffer text;
} link_list;

static void add_link(void *user, const char *path, const char *target)
{
	link_list *list = user;
	nt_buffer_text(&list->text, "{\"uri\":\"");
	nt_link_uri(&list->text, list->record->folder, path);
	nt_buffer_text(&list->text, "\",\"to\":\"");
	nt_uri_append_path(&list->text, target);
	nt_buffer_text(&list->text, "\"},");
}

/* Looks where a folder is, and forgets another one. */
static nt_status make_known(nt_record *record, const char *path, size_t length, size_t *found, nt_error *error)
{
	nt_buffer real = {0};
	link_list links = {.record = record};
	char *spelled = strndup(path, length);
	nt_status status = spelled ? nt_way_follow(&real, spelled, add_link, &links, error)
				   : nt_fail_memory(error);
	if (!status && links.text.failed)
		status = nt_fail_memory(error);
	if (status) {
		free(spelled);
		nt_buffer_free(&real);
		nt_buffer_free(&links.text);
		return status;
	}
	*found = record->oldest++ % KNOWN_FOLDERS;
	free(record->known[*found].spelled);
	free(record->known[*found].real);
	nt_buffer_free(&record->known[*found].links);
	record->known[*found].spelled = spelled;
	record->known[*found].real = real.data;
	record->known[*found].links = links.text;
	return NT_OK;
}

/* Adds those that are not there yet. */
static void append_links(nt_buffer *links, const nt_buffer *more)
{
	for (const char *link = more->data; link && *link;) {
		const char *end = strchr(link, ',');
		while (end[-1] != '}') /* between the members */
			end = strchr(end + 1, ',');
		const size_t length = (size_t)(end - link) + 1;
		if (!links->data || !memmem(links->data, links->size, link, length))
			nt_buffer_append(links, link, length);
		link += length;
	}
}

/* The folder of a path; neighbours mostly have the same. Appended, as are the links on the way (NULL: not
 * wanted). */
static nt_status append_folder(
	nt_record *record, const char *path, nt_buffer *real, nt_buffer *links, nt_error *error)
{
	const char *slash = strrchr(path, '/');
	const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
	pthread_mutex_lock(&record->lock);
	size_t at = 0;
	while (at < KNOWN_FOLDERS && !(record->known[at].spelled && strlen(record->known[at].spelled) == length &&
					     memcmp(record->known[at].spelled, path, length) == 0))
		at++;
	const nt_status status = at < KNOWN_FOLDERS ? NT_OK : make_known(record, path, length, &at, error);
	if (!status)
		nt_buffer_text(real, record->known[at].real);
	if (!status && links)
		append_links(links, &record->known[at].links);
	pthread_mutex_unlock(&record->lock);
	return status;
}

/* Appends the URI of a file from the record's folder on. */
static nt_status append_uri(
	nt_record *record, const char *path, nt_buffer *uri, nt_buffer *links, nt_error *error)
{
	nt_buffer real = {0};
	const char *slash = strrchr(path, '/');
	nt_status status = append_folder(record, path, &real, links, error);
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

/* How a file or folder was. */
typedef struct state {
	uint64_t modified, changed, inode, noted;
} state;

typedef struct line_file {
	nt_buffer path; /* that can be opened */
	uint64_t size;
	state state;
	const char *digest; /* in the line */
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

static bool read_state(const nt_json_value *value, state *then)
{
	return nt_json_get_uint64(nt_json_find(value, "modified"), &then->modified) &&
	       nt_json_get_uint64(nt_json_find(value, "changed"), &then->changed) &&
	       nt_json_get_uint64(nt_json_find(value, "inode"), &then->inode) &&
	       nt_json_get_uint64(nt_json_find(value, "noted"), &then->noted);
}

static bool read_file(const nt_record *record, const nt_json_value *value, line_file *file)
{
	file->digest = nt_json_get_string(nt_json_find(value, "xxh128"), NULL);
	return file->digest && read_path(record, nt_json_find(value, "uri"), &file->path) &&
	       nt_json_get_uint64(nt_json_find(value, "bytes"), &file->size) &&
	       read_state(value, &file->state);
}

/* ---- sealing ---- */

static const char seal_begin[] = ",\"sum\":\"";
enum { SEAL_BYTES = sizeof seal_begin - 1 + NT_DIGEST_TEXT - 1 + 2 };

static bool digest_of_text(const char *text, size_t size, char digest[NT_DIGEST_TEXT])
{
	nt_digest *d = nt_digest_create();
	if (!d)
		return false;
	nt_digest_add(d, text, size);
	nt_digest_text(d, digest);
	nt_digest_free(d);
	return true;
}

/* Ends an object that lacks its last brace with a digest of itself: of a line that somebody damaged nothing holds. */
static nt_status seal(nt_buffer *line, nt_error *error)
{
	char digest[NT_DIGEST_TEXT];
	if (line->failed || !digest_of_text(line->data, line->size, digest))
		return nt_fail_memory(error);
	nt_buffer_format(line, "%s%s\"}\n", seal_begin, digest);
	return line->failed ? nt_fail_memory(error) : NT_OK;
}

/* A line that was cut off must not take the place of a whole one. */
static bool is_whole(const char *line, size_t length)
{
	return length > SEAL_BYTES && memcmp(line + length - SEAL_BYTES, seal_begin, sizeof seal_begin - 1) == 0;
}

/* Whether a line is whole: it ends with the digest of its bytes. */
static nt_status is_sealed(const char *line, size_t length, bool *is, nt_error *error)
{
	char digest[NT_DIGEST_TEXT];
	const size_t size = length - SEAL_BYTES;
	*is = false;
	if (!digest_of_text(line, size, digest))
		return nt_fail_memory(error);
	*is = memcmp(line + size + sizeof seal_begin - 1, digest, NT_DIGEST_TEXT - 1) == 0;
	return NT_OK;
}

static bool is_text(const nt_json_value *value, const char *expected)
{
	const char *text = nt_json_get_string(value, NULL);
	return text && strcmp(text, expected) == 0;
}

static bool is_recent(uint64_t changed, uint64_t noted)
{
	const int64_t tick = changed % 1000000000 ? fine_tick : coarse_tick;
	return (int64_t)(noted - changed) < tick;
}

/* An input may have been modified again within the same clock tick; compare digests. */
static bool may_have_changed_unseen(const state *then)
{
	return is_recent(then->modified, then->noted) || is_recent(then->changed, then->noted);
}

static state state_of(const struct stat *info)
{
	return (state){(uint64_t)nt_trace_modified(info), (uint64_t)nt_trace_changed(info),
		(uint64_t)info->st_ino, (uint64_t)nt_trace_now()};
}

/* ---- looking ---- */

typedef struct look {
	nt_record *record;
	const nt_making *making;
	nt_trace *trace;
	nt_error *error;
	nt_json *line;
	bool renewed; /* the line has been changed */
	line_file file;
} look;

/* Notes the new state of a file whose bytes are the same. */
static void renew(look *l, nt_json_value *value, const state *now)
{
	nt_json_set_uint64(l->line, nt_json_put(l->line, value, "modified"), now->modified);
	nt_json_set_uint64(l->line, nt_json_put(l->line, value, "changed"), now->changed);
	nt_json_set_uint64(l->line, nt_json_put(l->line, value, "inode"), now->inode);
	nt_json_set_uint64(l->line, nt_json_put(l->line, value, "noted"), now->noted);
	l->renewed = true;
}

/* Whether a file is as it was; `info` receives how it is. `read`: it is one that was read. */
static nt_status is_same(look *l, nt_json_value *value, bool read, struct stat *info, bool *same)
{
	const line_file *file = &l->file;
	*same = false;
	if (file->path.failed)
		return nt_fail_memory(l->error);
	nt_status status = nt_lookup_found(file->path.data, info, same, l->error);
	if (status || !*same)
		return status;
	const state now = state_of(info);
	const bool by_content = l->making->by == NT_UPDATE_BY_CONTENT,
		   touched = now.modified != file->state.modified;
	const bool unsure = now.changed != file->state.changed || now.inode != file->state.inode ||
			    (read && may_have_changed_unseen(&file->state));
	*same = (uint64_t)info->st_size == file->size && (by_content || !touched);
	if (*same && (by_content || unsure)) {
		char digest[NT_DIGEST_TEXT];
		status = nt_digest_of_file(file->path.data, digest, l->error);
		*same = !status && strcmp(digest, file->digest) == 0;
	}
	if (*same && !status && (touched || unsure))
		renew(l, value, &now);
	return status;
}

/* ---- what lists of a line have ---- */

static nt_status look_at_read(look *l, nt_json_value *file, bool first, bool *same)
{
	const nt_json_value *written = nt_json_find(nt_json_root(l->line), "written");
	struct stat info = l->making->input_info;
	nt_status status = NT_OK;
	bool is_written = false; /* too, so that it is judged as that */
	for (size_t i = 0; i < nt_json_count(written) && !is_written; i++)
		is_written = nt_json_equal(nt_json_find(nt_json_at(written, i), "uri"), nt_json_find(file, "uri"));
	*same = read_file(l->record, file, &l->file);
	if (*same && !is_written)
		status = is_same(l, file, true, &info, same);
	/* the first one is the input, by whatever name */
	if (*same && first)
		*same = nt_same_file(&info, &l->making->input_info);
	if (*same && !status && l->trace)
		nt_trace_read(first ? l->making->input : l->file.path.data, &info);
	return status;
}

static nt_status look_at_written(look *l, nt_json_value *file, bool first, bool *same)
{
	struct stat info;
	nt_status status = NT_OK;
	(void)first;
	*same = read_file(l->record, file, &l->file);
	if (*same)
		status = is_same(l, file, false, &info, same);
	if (*same && !status && l->trace)
		nt_trace_written(l->file.path.data, NULL, &info);
	return status;
}

static nt_status look_at_missing(look *l, nt_json_value *uri, bool first, bool *same)
{
	struct stat info;
	bool found = false;
	nt_status status = NT_OK;
	(void)first;
	*same = read_path(l->record, uri, &l->file.path);
	if (l->file.path.failed)
		return nt_fail_memory(l->error);
	if (*same)
		status = nt_lookup_found(l->file.path.data, &info, &found, l->error);
	*same = *same && !status && !(found && S_ISREG(info.st_mode));
	if (*same && found && l->trace)
		nt_trace_missing(l->file.path.data);
	return status;
}

static nt_status look_at_link(look *l, nt_json_value *link, bool first, bool *same)
{
	char text[PATH_MAX];
	nt_buffer target = {0};
	(void)first;
	*same = read_path(l->record, nt_json_find(link, "uri"), &l->file.path);
	const ssize_t size = *same && !l->file.path.failed ? readlink(l->file.path.data, text, sizeof text - 1) : -1;
	if (size >= 0) {
		text[size] = '\0';
		nt_uri_append_path(&target, text);
	}
	*same = size >= 0 && !target.failed && is_text(nt_json_find(link, "to"), target.data);
	const bool failed = target.failed || l->file.path.failed;
	nt_buffer_free(&target);
	return failed ? nt_fail_memory(l->error) : NT_OK;
}

/* Whether a search would find what it has found. */
static nt_status look_at_search(look *l, nt_json_value *search, bool first, bool *same)
{
	struct stat info = {0};
	state then;
	(void)first;
	*same = read_path(l->record, nt_json_find(search, "uri"), &l->file.path);
	if (!*same || l->file.path.failed)
		return *same ? nt_fail_memory(l->error) : NT_OK;
	char *slash = strrchr(l->file.path.data, '/'), *entry = NULL;
	const char *found = nt_json_get_string(nt_json_find(search, "found"), NULL);
	*slash = '\0';
	if (stat(slash > l->file.path.data ? l->file.path.data : "/", &info) != 0)
		info = (struct stat){0};
	const state now = state_of(&info);
	*same = read_state(search, &then);
	nt_status status = NT_OK;
	if (*same && (now.modified != then.modified || now.changed != then.changed ||
			     now.inode != then.inode || may_have_changed_unseen(&then))) {
		nt_buffer name = {0};
		status = nt_lookup_any_case(
			l->file.path.data, slash + 1, strlen(slash + 1), &entry, l->error);
		nt_uri_append_path(&name, entry ? entry : "");
		if (!status && name.failed)
			status = nt_fail_memory(l->error);
		*same = !status && (found ? entry && strcmp(name.data, found) == 0 : !entry);
		if (*same)
			renew(l, search, &now);
		nt_buffer_free(&name);
	}
	*slash = '/';
	nt_trace_searched(l->file.path.data, entry, &info);
	free(entry);
	return status;
}

static const char *const verdicts[] = {"none", "info", "warning", "error"}; /* by 1 + nt_severity */
enum { VERDICTS = sizeof verdicts / sizeof *verdicts };

/* Whether the findings would let a run pass, as far as the line tells. */
static bool passes(const nt_making *making, const nt_json_value *line)
{
	int severity = -1;
	if (!making->judging || making->least_failure >= VERDICTS - 1)
		return true;
	while (severity < making->least_failure && !is_text(nt_json_find(line, "judged"), verdicts[1 + severity]))
		severity++;
	return severity < making->least_failure && is_text(nt_json_find(line, "judging"), making->judging);
}

static nt_status look_at(look *l, const nt_json_value *line, bool *same)
{
	static const struct {
		const char *key;
		size_t least;
		nt_status (*look_at_one)(look *l, nt_json_value *value, bool first, bool *same);
	} lists[] = {{"read", 1, look_at_read}, {"links", 0, look_at_link}, {"missing", 0, look_at_missing},
		{"searched", 0, look_at_search}, {"written", 1, look_at_written}};
	nt_status status = NT_OK;
	*same = is_text(nt_json_find(line, "nmtan"), nmtan_version()) &&
		is_text(nt_json_find(line, "options"), l->making->options) && passes(l->making, line);
	for (size_t k = 0; k < sizeof lists / sizeof *lists && *same && !status; k++) {
		nt_json_value *list = nt_json_find(line, lists[k].key);
		*same = list && nt_json_count(list) >= lists[k].least;
		for (size_t i = 0; i < nt_json_count(list) && *same && !status; i++)
			status = lists[k].look_at_one(l, nt_json_at(list, i), i == 0, same);
	}
	nt_buffer_free(&l->file.path);
	return status;
}

/* For nt_record_close(). */
static nt_status keep_renewed(look *l)
{
	nt_buffer text = {0};
	nt_json_remove(l->line, nt_json_root(l->line), "sum");
	nt_status status = nt_json_dump(l->line, &text, l->error);
	if (!status && text.size) {
		text.size--;
		status = seal(&text, l->error);
	}
	pthread_mutex_lock(&l->record->lock);
	if (!status)
		nt_buffer_append(&l->record->renewed, text.data, text.size);
	if (!status && l->record->renewed.failed)
		status = nt_fail_memory(l->error);
	pthread_mutex_unlock(&l->record->lock);
	nt_buffer_free(&text);
	return status;
}

nt_status nt_record_look(nt_record *record, nt_making *making, nt_freshness *freshness,
	nt_trace *trace, nt_error *error)
{
	nt_buffer key = {0};
	nt_error ignored;
	size_t length;
	*freshness = NT_FRESH_UNKNOWN;
	nt_status status = append_uri(record, making->output, &key, NULL, error);
	const char *text = status ? NULL : nt_record_file_find(&record->file, key.data, &length);
	nt_buffer_free(&key);
	if (!text)
		return status;
	pthread_mutex_lock(&record->lock);
	record->looked++;
	pthread_mutex_unlock(&record->lock);
	*freshness = NT_FRESH_STALE;
	bool same;
	status = is_sealed(text, length, &same, error);
	if (status || !same)
		return status;
	look l = {.record = record, .making = making, .trace = trace, .error = error};
	if (nt_json_parse(&l.line, text, length, NULL, &ignored))
		return ignored.status == NT_ERROR_MEMORY ? nt_fail_memory(error) : NT_OK;
	nt_trace *outer = nt_trace_use(trace);
	status = look_at(&l, nt_json_root(l.line), &same);
	nt_trace_use(outer);
	if (!status && same && l.renewed && record->tidy)
		status = keep_renewed(&l);
	making->keeps_wrong = same && nt_json_find(nt_json_root(l.line), "wrong");
	nt_json_free(l.line);
	if (!status && trace && trace->failed)
		status = nt_fail_memory(error);
	if (!status && same)
		*freshness = NT_FRESH_CURRENT;
	return status;
}

/* Whether a line's output is there, and its input is not. */
static bool is_left_over(const nt_record *record, const nt_json_value *line, nt_buffer *output)
{
	nt_buffer input = {0};
	struct stat info;
	const nt_json_value *source = nt_json_at(nt_json_find(line, "read"), 0);
	const bool left = read_path(record, nt_json_find(line, "output"), output) &&
		read_path(record, nt_json_find(source, "uri"), &input) && !output->failed && !input.failed &&
		stat(output->data, &info) == 0 && stat(input.data, &info) != 0 && errno == ENOENT;
	nt_buffer_free(&input);
	return left;
}

size_t nt_record_left_over(nt_record *record, const char *path, nt_buffer *first)
{
	const nt_record_file *file = &record->file;
	const char *slash = strrchr(path, '/');
	const size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
	size_t count = 0;
	for (size_t i = 0; i < file->line_count && record->looked < file->line_count; i++) {
		nt_json *line;
		nt_error ignored;
		nt_buffer output = {0};
		if (nt_json_parse(&line, file->text + file->lines[i].offset, file->lines[i].length, NULL, &ignored))
			continue;
		const bool left = is_left_over(record, nt_json_root(line), &output);
		const char *name = left ? output.data + strlen(record->folder) + 1 : "";
		count += left;
		/* lines are in the order in which threads were done */
		if (left && !first->failed && (count == 1 || strcmp(name, first->data + folder) < 0)) {
			first->size = 0;
			nt_buffer_append(first, path, folder);
			nt_buffer_text(first, name);
		}
		nt_buffer_free(&output);
		nt_json_free(line);
	}
	return count;
}

/* ---- appending ---- */

/* The digest of a file that is still as it was noted; *has is false where it is not. */
static nt_status digest_of(const nt_trace_file *file, char digest[NT_DIGEST_TEXT], bool *has, nt_error *error)
{
	const char *path = file->present ? file->present : file->path;
	struct stat info;
	const nt_status status = nt_digest_of_file(path, digest, error);
	*has = !status && digest[0] && stat(path, &info) == 0 && (uint64_t)info.st_size == file->size &&
		(uint64_t)info.st_ino == file->inode && nt_trace_modified(&info) == file->modified &&
		nt_trace_changed(&info) == file->changed;
	return status;
}

/* A line on its way. */
typedef struct writing {
	nt_record *record;
	const nt_trace *trace;
	nt_error *error;
	nt_buffer text, links;
	bool known; /* the bytes of all files */
} writing;

static nt_status append_file(writing *w, const nt_trace_file *file)
{
	char digest[NT_DIGEST_TEXT];
	nt_buffer *text = &w->text;
	nt_buffer_text(text, "{\"uri\":\"");
	nt_status status = append_uri(w->record, file->path, text,
		file->kind == NT_TRACE_WRITTEN ? NULL : &w->links, w->error);
	if (file->kind != NT_TRACE_SEARCHED)
		nt_buffer_format(text, "\",\"bytes\":%" PRIu64, file->size);
	else
		nt_buffer_text(text, "\"");
	nt_buffer_format(text,
		",\"modified\":%" PRId64 ",\"changed\":%" PRId64 ",\"inode\":%" PRIu64
		",\"noted\":%" PRId64,
		file->modified, file->changed, file->inode, file->noted);
	if (file->found) {
		nt_buffer_text(text, ",\"found\":\"");
		nt_uri_append_path(text, file->found);
		nt_buffer_text(text, "\"");
	}
	if (!status && file->kind != NT_TRACE_SEARCHED) {
		status = digest_of(file, digest, &w->known, w->error);
		if (digest[0])
			nt_buffer_format(text, ",\"xxh128\":\"%s\"", digest);
	}
	nt_buffer_text(text, "}");
	return status;
}

static nt_status append_files(writing *w, const char *key, nt_trace_kind kind)
{
	const nt_trace *trace = w->trace;
	nt_status status = NT_OK;
	const char *comma = "";
	nt_buffer_format(&w->text, ",\"%s\":[", key);
	const size_t begin = w->text.size;
	for (size_t i = 0; i < trace->count && !status && w->known; i++) {
		const nt_trace_file *file = &trace->files[i];
		if (file->kind != kind)
			continue;
		nt_buffer_text(&w->text, comma);
		comma = ",";
		if (kind == NT_TRACE_MISSING) {
			nt_buffer_text(&w->text, "\"");
			status = append_uri(w->record, file->path, &w->text, &w->links, w->error);
			nt_buffer_text(&w->text, "\"");
		} else {
			status = append_file(w, file);
		}
	}
	if (!w->known && kind == NT_TRACE_WRITTEN && !w->text.failed)
		w->text.size = begin;
	nt_buffer_text(&w->text, "]");
	return status;
}

/* The links that decided something, without a file that was read. */
static nt_status find_ways(writing *w)
{
	const nt_trace *trace = w->trace;
	nt_buffer real = {0};
	nt_status status = NT_OK;
	for (size_t i = 0; i < trace->count && !status; i++) {
		if (trace->files[i].kind != NT_TRACE_WAY)
			continue;
		nt_buffer path = {0};
		nt_buffer_format(&path, "%s/", trace->files[i].path);
		status = path.failed
				 ? nt_fail_memory(w->error)
				 : append_folder(w->record, path.data, &real, &w->links, w->error);
		nt_buffer_free(&path);
	}
	nt_buffer_free(&real);
	return status;
}

/* If files changed while they were read, the line says that nothing was written, so that it never holds. */
static nt_status make_line(writing *w, const nt_making *making)
{
	static const struct {
		const char *key;
		nt_trace_kind kind;
	} lists[] = {{"read", NT_TRACE_READ}, {"missing", NT_TRACE_MISSING},
		{"searched", NT_TRACE_SEARCHED}, {"written", NT_TRACE_WRITTEN}};
	nt_buffer *text = &w->text;
	nt_buffer_text(text, line_begin);
	nt_status status = append_uri(w->record, making->output, text, NULL, w->error);
	nt_buffer_format(text, "\",\"nmtan\":\"%s\",\"options\":", nmtan_version());
	nt_json_string(making->options, text);
	for (size_t i = 0; i < sizeof lists / sizeof *lists && !status; i++)
		status = append_files(w, lists[i].key, lists[i].kind);
	if (!status)
		status = find_ways(w);
	/* each has a comma behind it */
	nt_buffer_format(text, ",\"links\":[%.*s]", w->links.size ? (int)w->links.size - 1 : 0,
		w->links.size ? w->links.data : "");
	if (!status && w->links.failed)
		status = nt_fail_memory(w->error);
	return status ? status : seal(text, w->error);
}

nt_status nt_record_append(nt_record *record, const nt_making *making, const nt_trace *trace, nt_buffer *line,
	nt_error *error)
{
	writing w = {.record = record, .trace = trace, .error = error, .known = true};
	nt_status status = make_line(&w, making);
	if (!status)
		status = nt_record_file_append(&record->file, w.text.data, w.text.size, error);
	nt_buffer_free(line);
	*line = w.text;
	nt_buffer_free(&w.links);
	return status;
}

static void put_text(nt_json *json, const char *key, const char *text)
{
	nt_json_set_string(json, nt_json_put(json, nt_json_root(json), key), text, strlen(text));
}

void nt_record_placed(nt_record *record, const nt_making *making, const nt_buffer *line, const nt_trace *trace)
{
	nt_error ignored; /* without the new state more is read another time, nothing else */
	look l = {.record = record, .error = &ignored};
	if (!line->size || nt_json_parse(&l.line, line->data, line->size - 1, NULL, &ignored))
		return;
	nt_json_value *written = nt_json_find(nt_json_root(l.line), "written");
	for (size_t i = 0, at = 0; i < trace->count && at < nt_json_count(written); i++) {
		const nt_trace_file *file = &trace->files[i];
		struct stat info;
		if (file->kind != NT_TRACE_WRITTEN)
			continue;
		/* unless somebody else was faster */
		if (stat(file->path, &info) == 0 && (uint64_t)info.st_ino == file->inode &&
			(uint64_t)info.st_size == file->size && nt_trace_modified(&info) == file->modified) {
			const state now = state_of(&info);
			renew(&l, nt_json_at(written, at), &now);
		}
		at++;
	}
	if (making->keeps_wrong)
		nt_json_set_uint64(l.line, nt_json_put(l.line, nt_json_root(l.line), "wrong"), 1);
	if (making->judging) {
		put_text(l.line, "judged", verdicts[1 + making->worst]);
		put_text(l.line, "judging", making->judging);
	}
	if (l.renewed || making->judging || making->keeps_wrong)
		keep_renewed(&l);
	nt_json_free(l.line);
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
	made->tidy = tidy;
	if (!status)
		status = nt_record_file_open(&made->file, path, line_begin, is_whole, tidy, error);
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
	nt_error ignored; /* without these lines more is read another time, nothing else */
	if (record->renewed.size && !record->renewed.failed)
		nt_record_file_append(
			&record->file, record->renewed.data, record->renewed.size, &ignored);
	nt_buffer_free(&record->renewed);
	nt_record_file_close(&record->file);
	pthread_mutex_destroy(&record->lock);
	free(record->folder);
	for (size_t i = 0; i < KNOWN_FOLDERS; i++) {
		free(record->known[i].spelled);
		free(record->known[i].real);
		nt_buffer_free(&record->known[i].links);
	}
	free(record);
}

/* SPDX-License-Identifier: MIT */
/*
 * Names of sidecars, and owners of files.
 *
 * A sidecar wants the name that the writer gave it ("a.bin" of a.gltf, an image's own). If the name is free, it gets
 * it. If a file of the same bytes has it, that file is used as it is, so that a map that many documents share is
 * there once. If another file has it:
 *
 * - A buffer replaces it if the previous main file at that very path refers to it and it is provably ours: the main
 *   file records the digest of the bytes that we wrote (nt_sink_digest), and the file still has that digest. A staging
 *   main file (commit.c) refers to staging names; it counts as referring to the final names too, and records the digest
 *   of what was there.
 * - Everything else is somebody else's and stays. The new file's name is made from its own bytes
 *   ("a-0123456789abcdef.bin"), so that the same result has the same name in every run and nothing piles up.
 *
 * In place nothing but the document is replaced, so there the second rule is the only one. An image may serve
 * documents that we know nothing of, so it is never replaced either. A buffer that was used as it is gets a digest in
 * the main file only if the previous one had it: otherwise the next run would take somebody's file for ours.
 */
#include "file/output_parts.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/memory.h"
#include "file/input.h"

/* A name's length in any file system; the digits of a digest that a name has. */
enum { MOST_NAME_BYTES = 255, NAME_ROOM = 1024, NAME_DIGITS = 16 };

static const char of_content[] = "-", for_the_time_being[] = ".new-";

/* ---- files ---- */

nt_file_state nt_state_of(const struct stat *status)
{
	return (nt_file_state){nt_file_id_of(status), status->st_size, status->st_mtim};
}

bool nt_state_is(const char *path, const nt_file_state *state)
{
	struct stat status;
	return stat(path, &status) == 0 && nt_same_id(nt_file_id_of(&status), state->id) &&
	       status.st_size == state->size && status.st_mtim.tv_sec == state->modified.tv_sec &&
	       status.st_mtim.tv_nsec == state->modified.tv_nsec;
}

bool nt_output_is_protected(const nt_output *output, const struct stat *status, const nt_protected_file **file)
{
	static const nt_protected_file elsewhere = {.path = NULL};
	const nt_file_id id = nt_file_id_of(status);
	const uint32_t number = nt_key_find(&output->guards, &id, sizeof id);
	*file = number != UINT32_MAX ? &output->guarded[number] : &elsewhere;
	return number != UINT32_MAX || nt_trace_is_read_elsewhere(status);
}

/* ---- names ---- */

/* "STEM" + infix + the digest's first digits + "-number" + ".ENDING"; a long stem is cut between characters. The system
 * refuses a name that is too long all the same. */
static void make_name(char made[NAME_ROOM], const char *name, const char *infix, const char *digest, unsigned number)
{
	char inserted[48];
	const char *dot = strrchr(name, '.');
	const char *ending = dot && dot != name ? dot : name + strlen(name);
	const int length = number ? snprintf(inserted, sizeof inserted, "%s%.*s-%u", infix, NAME_DIGITS, digest, number)
				  : snprintf(inserted, sizeof inserted, "%s%.*s", infix, NAME_DIGITS, digest);
	const size_t others = (size_t)length + strlen(ending);
	size_t stem = (size_t)(ending - name);
	if (others < MOST_NAME_BYTES && stem + others > MOST_NAME_BYTES) {
		stem = MOST_NAME_BYTES - others;
		while (stem > 1 && ((unsigned char)name[stem] & 0xC0) == 0x80)
			stem--;
	}
	snprintf(made, NAME_ROOM, "%.*s%s%s", (int)stem, name, inserted, ending);
}

static void append_name(nt_buffer *text, const char *name, const char *infix, const char *digest, unsigned number)
{
	char made[NAME_ROOM];
	make_name(made, name, infix, digest, number);
	nt_buffer_text(text, made);
}

static bool is_name(const char *candidate, const char *name, const char *infix, const char *digest)
{
	char made[NAME_ROOM];
	make_name(made, name, infix, digest, 0);
	return strcmp(made, candidate) == 0;
}

const char *nt_sink_name(const nt_sink *sink, bool staging)
{
	return nt_last_part(staging && sink->staging ? sink->staging : sink->target);
}

/* ---- whose file ---- */

static const char *keep(nt_output *output, const char *text)
{
	return text ? nt_arena_text(&output->texts, text, strlen(text)) : NULL;
}

nt_status nt_output_add_ownership(nt_output *output, const char *name, const char *digest, const char *before,
	nt_error *error)
{
	const nt_ownership record = {keep(output, name), keep(output, digest), keep(output, before)};
	if (!record.name || !record.digest || (before && !record.before) ||
		!nt_grow((void **)&output->ownership, &output->ownership_capacity, output->ownership_count + 1,
			sizeof record))
		return nt_fail_memory(error);
	output->ownership[output->ownership_count++] = record;
	return NT_OK;
}

/* Asks the previous main file, once. */
static nt_status know_ownership(nt_output *output, nt_error *error)
{
	if (output->ownership_known || !output->options.find_ownership || !output->main || !output->main->target)
		return NT_OK;
	output->ownership_known = true;
	struct stat status;
	if (stat(output->main->path, &status) != 0 || !S_ISREG(status.st_mode))
		return NT_OK;
	return output->options.find_ownership(output, output->main->path, error);
}

/* Whether the previous main file says that the file `name` is ours if it has this digest; for any digest where that is
 * NULL. */
static bool is_owned(const nt_output *output, const char *name, const char *digest)
{
	for (size_t i = 0; i < output->ownership_count; i++) {
		const nt_ownership *record = &output->ownership[i];
		const bool itself = strcmp(record->name, name) == 0;
		const bool on_the_way = !itself && record->before &&
			is_name(record->name, name, for_the_time_being, record->digest);
		if ((itself || on_the_way) && (!digest || strcmp(record->digest, digest) == 0))
			return true;
		if (on_the_way && strcmp(record->before, digest) == 0)
			return true;
	}
	return false;
}

/* Whether the file that has a buffer's name may be replaced; its digest in sink->before then. */
static nt_status may_replace(nt_output *output, nt_sink *sink, bool *may, nt_error *error)
{
	struct stat status;
	const nt_protected_file *ignored;
	*may = false;
	if (sink->role != NT_ROLE_BUFFER || !output->main || output->main->in_place ||
		lstat(sink->path, &status) != 0 || !S_ISREG(status.st_mode) ||
		nt_output_is_protected(output, &status, &ignored))
		return NT_OK;
	const char *name = nt_last_part(sink->path);
	nt_status result = know_ownership(output, error);
	if (result || !is_owned(output, name, NULL))
		return result;
	sink->there = nt_state_of(&status);
	result = nt_digest_of_file(sink->path, sink->before, error);
	*may = !result && sink->before[0] && is_owned(output, name, sink->before);
	if (!*may) {
		sink->there = (nt_file_state){.size = 0};
		sink->before[0] = '\0';
	}
	return result;
}

static bool has_name(const nt_sink *sink, const char *name)
{
	return strcmp(nt_last_part(nt_sink_is_sidecar(sink) ? sink->target : sink->path), name) == 0;
}

nt_status nt_output_note_name(nt_output *output, nt_sink *sink, const char *path, nt_error *error)
{
	const char *name = nt_last_part(path);
	if (!nt_grow((void **)&output->named, &output->named_capacity, output->named_count + 1, sizeof(nt_sink *)) ||
		!nt_hash_index_add(&output->names, nt_hash_name(0, name), (uint32_t)output->named_count))
		return nt_fail_memory(error);
	output->named[output->named_count++] = sink;
	return NT_OK;
}

/* Whether a sidecar of this set is called so. */
static bool is_used(const nt_output *output, const char *name)
{
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i; (i = nt_hash_index_next(&output->names, nt_hash_name(0, name), &at)) != UINT32_MAX;)
		if (nt_sink_is_sidecar(output->named[i]) && has_name(output->named[i], name))
			return true;
	return false;
}

/* The digest of a file that may be removed: none of this set's, neither guarded nor a link. False: it may not. */
static bool find_unused(const nt_output *output, const char *path, char digest[NT_DIGEST_TEXT])
{
	struct stat status;
	const nt_protected_file *file;
	nt_error ignored;
	return !is_used(output, nt_last_part(path)) && lstat(path, &status) == 0 && S_ISREG(status.st_mode) &&
	       !nt_output_is_protected(output, &status, &file) && !nt_digest_of_file(path, digest, &ignored);
}

/* Whether an ownership record is of a file that an earlier run made in place of the name that a buffer wants. */
static bool is_made_for(const nt_ownership *record, const nt_sink *sink)
{
	return sink->role == NT_ROLE_BUFFER &&
		is_name(record->name, nt_last_part(sink->path), of_content, record->digest);
}

/* Removes the file of these bytes that was made in place of the wanted name, if it has them still. */
static void remove_made(const nt_output *output, const nt_sink *sink, const char *digest)
{
	nt_buffer path = {0};
	char text[NT_DIGEST_TEXT];
	nt_path_beside(&path, sink->path, "");
	append_name(&path, nt_last_part(sink->path), of_content, digest, 0);
	if (!path.failed && find_unused(output, path.data, text) && strcmp(text, digest) == 0)
		unlink(path.data);
	nt_buffer_free(&path);
}

void nt_output_remove_superseded(const nt_output *output)
{
	for (size_t i = 0; i < output->ownership_count && !output->main->in_place; i++)
		for (const nt_sink *sink = output->first; sink; sink = sink->next) {
			const nt_ownership *record = &output->ownership[i];
			if (!is_made_for(record, sink))
				continue;
			remove_made(output, sink, record->digest);
			if (record->before) /* of a run that was killed */
				remove_made(output, sink, record->before);
		}
}

/* So that a later run can go on with the removal if this one is cut short, the staging main file says what goes. */
static void note_superseded(const nt_output *output, nt_sink *sink)
{
	for (size_t i = 0; i < output->ownership_count && !output->main->in_place; i++) {
		const nt_ownership *record = &output->ownership[i];
		if (is_made_for(record, sink) && strcmp(record->name, nt_last_part(sink->target)) != 0)
			snprintf(sink->before, sizeof sink->before, "%s", record->digest);
	}
}

/* ---- what killed runs left ---- */

/* The names in a folder, each with a NUL behind it; `staging`: only those of files for the time being. */
static void list_folder(const char *folder, bool staging, nt_buffer *names)
{
	DIR *dir = opendir(folder);
	for (const struct dirent *e; dir && (e = readdir(dir));)
		if (!staging || strstr(e->d_name, for_the_time_being))
			nt_buffer_append(names, e->d_name, strlen(e->d_name) + 1);
	if (dir)
		closedir(dir);
}

/* Whether a file has the name that a sidecar of this set has for the time being, by its own bytes. */
static bool is_staging(const nt_output *output, const char *path)
{
	char digest[NT_DIGEST_TEXT];
	if (!find_unused(output, path, digest))
		return false;
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		if (sink->role == NT_ROLE_BUFFER && is_name(nt_last_part(path), nt_last_part(sink->path),
			for_the_time_being, digest))
			return true;
	return false;
}

/* Whether a document refers to a file as its own. A file that cannot be read may do so. */
static bool is_owner(const nt_output *output, const char *path, const char *name)
{
	nt_output other = {0};
	nt_error ignored;
	const bool is = output->options.find_ownership(&other, path, &ignored) || is_owned(&other, name, NULL);
	free(other.ownership);
	nt_arena_free(&other.texts);
	return is;
}

/* Only documents that are called as the main file but for the ending, which may be none, have sidecars of these names.
 * The main file is one of them. */
static bool is_needed(const nt_output *output, const char *folder, const char *name)
{
	const char *main = nt_last_part(output->main->path), *dot = strrchr(main, '.');
	const size_t stem = dot ? (size_t)(dot - main) : strlen(main);
	nt_buffer names = {0}, path = {0};
	list_folder(folder, false, &names);
	bool needed = names.failed;
	for (size_t at = 0; at < names.size && !needed; at += strlen(names.data + at) + 1) {
		const char *other = names.data + at;
		struct stat status;
		if (strncmp(other, main, stem) != 0 || (other[stem] && other[stem] != '.') ||
			strstr(other + stem, for_the_time_being))
			continue;
		path.size = 0;
		nt_buffer_format(&path, "%s%s", folder, other);
		needed = path.failed || (stat(path.data, &status) == 0 && S_ISREG(status.st_mode) &&
			is_owner(output, path.data, name));
	}
	nt_buffer_free(&names);
	nt_buffer_free(&path);
	return needed;
}

void nt_output_remove_stale_staging(const nt_output *output)
{
	/* those of the latest folder: listed once, or a batch would list it for each of its files */
	static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
	static struct stat listed;
	static nt_buffer names;
	nt_buffer folder = {0}, path = {0};
	struct stat status;
	const size_t length = nt_folder_length(output->main->path);
	nt_buffer_append(&folder, length ? output->main->path : "./", length ? length : 2);
	pthread_mutex_lock(&lock);
	if (!folder.failed && stat(folder.data, &status) == 0 && !nt_same_file(&status, &listed)) {
		nt_buffer_free(&names);
		listed = status;
		list_folder(folder.data, true, &names);
	}
	for (size_t at = 0; !folder.failed && at < names.size; at += strlen(names.data + at) + 1) {
		path.size = 0;
		nt_buffer_format(&path, "%s%s", folder.data, names.data + at);
		if (!path.failed && is_staging(output, path.data) && !is_needed(output, folder.data, names.data + at))
			unlink(path.data);
	}
	pthread_mutex_unlock(&lock);
	nt_buffer_free(&folder);
	nt_buffer_free(&path);
}

/* ---- choosing ---- */

typedef enum verdict { FREE, EQUAL, OTHER } verdict;

/* Another file of the set with that name: the main file, or a sidecar that has chosen it. */
static const nt_sink *find_in_set(const nt_output *output, const nt_sink *sink, const char *name)
{
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i; (i = nt_hash_index_next(&output->names, nt_hash_name(0, name), &at)) != UINT32_MAX;)
		if (output->named[i] != sink && has_name(output->named[i], name))
			return output->named[i];
	return NULL;
}

/* The file that has a name now. `state` receives that of an EQUAL file. */
static nt_status look(const nt_output *output, const nt_sink *sink, const char *path, verdict *found,
	nt_file_state *state, nt_error *error)
{
	const char *mine = nt_temporary_path(sink->temporary), *theirs = path;
	const nt_sink *other = find_in_set(output, sink, nt_last_part(path));
	struct stat status;
	*found = OTHER;
	if (other && !nt_sink_is_sidecar(other))
		return NT_OK;
	if (other && other->temporary)
		theirs = nt_temporary_path(other->temporary);
	if (lstat(theirs, &status) != 0) {
		*found = FREE;
		return errno == ENOENT ? NT_OK : nt_sink_fail(error, path, errno);
	}
	/* a link to nowhere, or to what cannot be looked at, is somebody's all the same */
	if (stat(theirs, &status) != 0 || !S_ISREG(status.st_mode) || (uint64_t)status.st_size != sink->size)
		return NT_OK;
	bool same;
	const nt_status result = nt_same_bytes(mine, theirs, &same, error);
	if (result)
		return result;
	if (same)
		*state = nt_state_of(&status);
	*found = same ? EQUAL : OTHER;
	return NT_OK;
}

/* The first name made of infix and digest that is free or has these bytes, which then stay. */
static nt_status find_name(nt_output *output, nt_sink *sink, const char *infix, const char **path,
	nt_file_state *state, nt_error *error)
{
	nt_buffer text = {0};
	nt_status status = NT_OK;
	verdict found = OTHER;
	for (unsigned number = 0; !status && found == OTHER; number++) {
		text.size = 0;
		nt_path_beside(&text, sink->path, "");
		append_name(&text, nt_last_part(sink->path), infix, sink->text, number);
		status = text.failed ? nt_fail_memory(error) : look(output, sink, text.data, &found, state, error);
	}
	sink->stays = found == EQUAL;
	*path = status ? NULL : keep(output, text.data);
	nt_buffer_free(&text);
	return status || *path ? status : nt_fail_memory(error);
}

static nt_status choose(nt_output *output, nt_sink *sink, nt_error *error)
{
	bool may = false;
	verdict found;
	nt_file_state ignored;
	nt_status status = look(output, sink, sink->path, &found, &sink->there, error);
	sink->target = sink->path;
	sink->stays = found == EQUAL;
	if (status || found != OTHER)
		return status;
	/* the name is somebody's who is not us, or ours to replace */
	status = may_replace(output, sink, &may, error);
	if (status)
		return status;
	if (may)
		return find_name(output, sink, for_the_time_being, &sink->staging, &ignored, error);
	status = find_name(output, sink, of_content, &sink->target, &sink->there, error);
	if (!status && output->main)
		note_superseded(output, sink);
	return status;
}

/* A file that is there is ours if the previous main file says so; one of this set, if that is. */
static nt_status check_used(nt_output *output, nt_sink *sink, nt_error *error)
{
	const char *name = nt_last_part(sink->target);
	const nt_sink *other = find_in_set(output, sink, name);
	sink->is_of_set = other && nt_sink_is_sidecar(other) && strcmp(nt_sink_name(other, false), name) == 0;
	if (other) {
		sink->ours = other->ours;
		return NT_OK;
	}
	if (sink->role != NT_ROLE_BUFFER)
		return NT_OK;
	const nt_status status = know_ownership(output, error);
	sink->ours = is_owned(output, name, sink->text);
	return status;
}

nt_status nt_output_settle(nt_output *output, nt_sink *sink, nt_error *error)
{
	if (sink->settled)
		return NT_OK;
	nt_digest_text(sink->digest, sink->text);
	if (sink->dry) {
		sink->settled = sink->ours = true;
		sink->target = sink->path;
		return nt_output_note_name(output, sink, sink->target, error);
	}
	nt_status status = nt_sink_flush(sink, error);
	if (!status)
		status = choose(output, sink, error);
	if (status)
		return nt_error_in_file(error, sink->path);
	sink->ours = true;
	if (sink->stays && !sink->staging)
		status = check_used(output, sink, error);
	sink->settled = true;
	/* nothing is written to it any more: of many, only the lists take memory and descriptors */
	nt_digest_free(sink->digest);
	free(sink->buffer);
	sink->digest = NULL;
	sink->buffer = NULL;
	if (!status)
		status = nt_output_note_name(output, sink, sink->target, error);
	if (!status && nt_temporary_is_led(sink->temporary))
		status = nt_sink_finish(sink, output->options.sync, error);
	return status;
}

bool nt_output_has_staging(const nt_output *output)
{
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		if (sink->before[0])
			return true;
	return false;
}

const char *nt_sink_digest(const nt_sink *sink)
{
	return sink->ours && sink->role == NT_ROLE_BUFFER ? sink->text : NULL;
}

const char *nt_sink_digest_before(const nt_sink *sink)
{
	return sink->before[0] ? sink->before : NULL;
}

/* SPDX-License-Identifier: MIT */
/*
 * Which files a run of many is about: see batch.h.
 */
#include "batch/batch.h"

#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/hash_index.h"
#include "base/text.h"
#include "file/input.h"
#include "file/path.h"
#include "format/format.h"
#include "pipeline/run.h"

/* A look through one folder and those below. */
typedef struct walk {
	nt_inputs *inputs;
	const nt_folder_rules *rules;
	nt_error *error;
	const char *root;        /* the folder that was named */
	size_t root_length;      /* of the path up to and with the slash behind the folder that was named */
	size_t file_count, mesh_count; /* looked at */
	bool has_excluded; /* a folder */
	struct stat leave_out;
	bool has_leave_out;
} walk;

/* Takes a name that stays. */
static nt_status add(nt_inputs *inputs, const char *name, const char *root, nt_error *error)
{
	const size_t count = inputs->count + 1;
	if (!name || !nt_grow((void **)(uintptr_t)&inputs->names, &inputs->capacity, count, sizeof *inputs->names) ||
		!nt_grow((void **)(uintptr_t)&inputs->roots, &inputs->root_capacity, count, sizeof *inputs->roots))
		return nt_fail_memory(error);
	inputs->roots[inputs->count] = root;
	inputs->names[inputs->count++] = name;
	return NT_OK;
}

static nt_status fail_folder(const char *path, int number, nt_error *error)
{
	if (number == ENOMEM)
		return nt_fail_memory(error);
	return nt_fail_file(error, NT_ERROR_IO, path, "cannot read the folder: %s", strerror(number));
}

/* ---- what is taken ---- */

static bool matches(const char *const *patterns, size_t count, const char *below)
{
	const char *slash = strrchr(below, '/');
	for (size_t i = 0; i < count; i++)
		if (fnmatch(patterns[i], strchr(patterns[i], '/') || !slash ? below : slash + 1, 0) == 0)
			return true;
	return false;
}

/* ---- folders ---- */

static int is_named(const struct dirent *entry)
{
	return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

static int compare_names(const struct dirent **a, const struct dirent **b)
{
	return strcmp((*a)->d_name, (*b)->d_name);
}

static nt_status look_through(walk *w, nt_buffer *path);

/* Takes the file or folder `path` within a folder. It passes over a name that vanished meanwhile, or is neither file
 * nor folder. */
static nt_status visit(walk *w, nt_buffer *path)
{
	struct stat info;
	const char *below = path->data + w->root_length;
	if (lstat(path->data, &info) != 0)
		return errno == ENOENT ? NT_OK : fail_folder(path->data, errno, w->error);
	const nt_folder_rules *rules = w->rules;
	w->file_count += !S_ISDIR(info.st_mode);
	w->mesh_count += !S_ISDIR(info.st_mode) && nt_format_of_path(below);
	if (matches(rules->exclude, rules->exclude_count, below)) {
		w->has_excluded |= S_ISDIR(info.st_mode);
		return NT_OK;
	}
	if (S_ISDIR(info.st_mode)) {
		const bool left_out = w->has_leave_out && nt_same_file(&info, &w->leave_out);
		return left_out ? NT_OK : look_through(w, path);
	}
	if (!nt_format_of_path(below) ||
		(rules->include_count && !matches(rules->include, rules->include_count, below)))
		return NT_OK;
	const bool leads_nowhere = S_ISLNK(info.st_mode) && stat(path->data, &info) != 0;
	if (leads_nowhere && (errno == EIO || errno == ENOMEM))
		return fail_folder(path->data, errno, w->error);
	/* its run fails, and says why; Emacs locks a file by such a link */
	if (leads_nowhere ? strncmp(nt_last_part(below), ".#", 2) == 0 : !S_ISREG(info.st_mode))
		return NT_OK;
	return add(w->inputs, nt_arena_text(&w->inputs->arena, path->data, path->size), w->root, w->error);
}

static nt_status look_through(walk *w, nt_buffer *path)
{
	struct dirent **entries;
	const int count = scandir(path->data, &entries, is_named, compare_names);
	if (count < 0)
		return fail_folder(path->data, errno, w->error);
	nt_status status = NT_OK;
	const size_t length = path->size;
	for (int i = 0; i < count; i++) {
		if (!status) {
			if (path->data[length - 1] != '/')
				nt_buffer_text(path, "/");
			nt_buffer_text(path, entries[i]->d_name);
			status = path->failed ? nt_fail_memory(w->error) : visit(w, path);
			path->size = length;
			path->data[length] = '\0';
		}
		free(entries[i]);
	}
	free(entries);
	return status;
}

/* A pattern with a slip of the pen must not pass for a folder in which all is well. */
static void note_nothing(walk *w)
{
	const nt_folder_rules *rules = w->rules;
	nt_error *nothing = &w->inputs->nothing;
	if (nothing->status)
		return;
	if (!w->mesh_count)
		nt_fail_file(nothing, NT_ERROR_IO, w->root,
			"no mesh is in it or below it (.obj .ply .gltf .glb .drc)%s; files looked at: %zu",
			w->has_excluded ? " outside of folders that --exclude takes out" : "", w->file_count);
	else if (rules->include_count)
		nt_fail_file(nothing, NT_ERROR_IO, w->root, "no file matches --include='%s'%s%s; meshes looked at: %zu",
			rules->include[0], rules->include_count > 1 ? " or another pattern" : "",
			rules->exclude_count ? " and no --exclude" : "", w->mesh_count);
	else
		nt_fail_file(nothing, NT_ERROR_IO, w->root, "--exclude takes out every mesh; meshes looked at: %zu",
			w->mesh_count);
}

/* ---- names ---- */

nt_status nt_inputs_add(nt_inputs *inputs, const char *name, const nt_folder_rules *rules, nt_error *error)
{
	struct stat info;
	bool found = false;
	nt_status status = rules->recursive ? nt_lookup_found(name, &info, &found, error) : NT_OK;
	if (status)
		return status;
	if (!found || !S_ISDIR(info.st_mode))
		return add(inputs, name, NULL, error);
	walk w = {.inputs = inputs, .rules = rules, .root = name, .error = error};
	if (rules->leave_out)
		status = nt_lookup_found(rules->leave_out, &w.leave_out, &w.has_leave_out, error);
	if (status)
		return status;
	nt_buffer path = {0};
	nt_buffer_text(&path, name);
	w.root_length = path.size + (path.size > 0 && name[path.size - 1] != '/');
	const size_t before = inputs->count;
	status = path.failed ? nt_fail_memory(error) : look_through(&w, &path);
	if (!status && inputs->count == before)
		note_nothing(&w);
	nt_buffer_free(&path);
	return status;
}

/* Reads a list in the time that an input has. */
static nt_status read_list(nt_file *file, const char *path, double seconds, nt_error *error)
{
	nt_timer timer;
	nt_status status = nt_timer_begin(&timer, seconds, NULL, NULL)
		? nt_file_open(file, path, NT_NAMED_BY_USER, error)
		: nt_fail_memory(error);
	if (nt_timer_end(&timer) && status == NT_ERROR_MEMORY)
		status = nt_fail_file(error, NT_ERROR_LIMIT, path, "not read after --max-seconds=%.9g", seconds);
	return status;
}

nt_status nt_inputs_add_list(nt_inputs *inputs, const char *path, double seconds, const nt_folder_rules *rules,
	nt_error *error)
{
	nt_file file;
	nt_status status = read_list(&file, path, seconds, error);
	if (status)
		return status;
	const char *text = (const char *)file.data;
	/* as find -print0 has it; no name contains one */
	const char separator = file.size && memchr(text, '\0', file.size) ? '\0' : '\n';
	for (size_t at = 0; at < file.size && !status;) {
		const char *end = memchr(text + at, separator, file.size - at);
		const size_t length = end ? (size_t)(end - text) - at : file.size - at;
		const bool dash = length == 1 && text[at] == '-';
		const char *name = nt_arena_text(&inputs->arena, dash ? "./-" : text + at, dash ? 3 : length);
		if (length)
			status = name ? nt_inputs_add(inputs, name, rules, error) : nt_fail_memory(error);
		at += length + 1;
	}
	nt_file_close(&file);
	return status;
}

nt_status nt_inputs_drop_repeated(nt_inputs *inputs, nt_error *error)
{
	nt_name_table seen = {0};
	nt_arena texts = {0};
	nt_buffer current = {0}, path = {0};
	size_t kept = 0;
	bool made = true;
	/* where the folder has no name, all relative names will fail */
	if (nt_path_absolute(&current, ".", error))
		return error->status == NT_ERROR_MEMORY ? error->status : NT_OK;
	for (size_t i = 0; i < inputs->count && made; i++) {
		const size_t before = seen.count;
		path.size = 0;
		nt_path_join(&path, current.data, inputs->names[i]);
		const char *text = path.failed ? NULL : nt_arena_text(&texts, path.data, path.size);
		made = text && nt_name_add(&seen, text, path.size) != UINT32_MAX;
		if (seen.count == before)
			continue;
		inputs->roots[kept] = inputs->roots[i];
		inputs->names[kept++] = inputs->names[i];
	}
	inputs->count = made ? kept : inputs->count;
	nt_name_table_free(&seen);
	nt_arena_free(&texts);
	nt_buffer_free(&current);
	nt_buffer_free(&path);
	return made ? NT_OK : nt_fail_memory(error);
}

void nt_inputs_free(nt_inputs *inputs)
{
	nt_arena_free(&inputs->arena);
	free(inputs->names);
	free(inputs->roots);
	*inputs = (nt_inputs){0};
}

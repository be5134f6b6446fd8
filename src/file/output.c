/* SPDX-License-Identifier: MIT */
/*
 * Output sets: see output.h. Everything that can be refused is refused when a file is added, before a
 * byte is written: a folder that is missing, a target that is a directory, an input or a file that
 * must stay.
 *
 * A target that is a symbolic link keeps being one: the file it points to is replaced.
 */
#include "file/output_parts.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/memory.h"
#include "ext/module.h"
#include "file/input.h"

nt_status nt_output_create(nt_output **output, const nt_output_options *options, nt_error *error)
{
	*output = nt_calloc(1, sizeof **output);
	if (!*output)
		return nt_fail_memory(error);
	if (options)
		(*output)->options = *options;
	return NT_OK;
}

nt_status nt_output_protect(nt_output *output, const char *path, const char *way_out, nt_error *error)
{
	struct stat status;
	const bool known = strcmp(path, "-") == 0 ? fstat(STDIN_FILENO, &status) == 0
						  : stat(path, &status) == 0;
	/* what is not there cannot be overwritten, what is no regular file is not replaced */
	if (!known || !S_ISREG(status.st_mode))
		return NT_OK;
	const nt_file_id id = nt_file_id_of(&status);
	const size_t count = output->guards.count;
	const char *copy = nt_arena_text(&output->texts, path, strlen(path));
	const uint32_t number = copy && nt_grow((void **)&output->guarded, &output->guarded_capacity, count + 1,
		sizeof *output->guarded) ? nt_key_add(&output->guards, &id, sizeof id) : UINT32_MAX;
	if (number == count)
		output->guarded[number] = (nt_protected_file){copy, way_out};
	return number != UINT32_MAX ? NT_OK : nt_fail_memory(error);
}

/* ---- adding ---- */

nt_status nt_output_check_clobber(const nt_output_options *options, const char *path, nt_error *error)
{
	struct stat status;
	return options->no_clobber && stat(path, &status) == 0 && S_ISREG(status.st_mode) ?
		nt_sink_refuse_existing(error, path) : NT_OK;
}

static bool is_in_place(const nt_output_options *options, const struct stat *status)
{
	struct stat input;
	return options->in_place && stat(options->in_place, &input) == 0 && nt_same_file(&input, status);
}

/* Refuses a file that is meant to stay as it is. */
static nt_status refuse_in_place(const char *path, const struct stat *status, nt_error *error)
{
	const char *refusal = nt_in_place_refusal(path, status);
	if (!refusal)
		return NT_OK;
	return nt_fail_file(error, NT_ERROR_IO, path, "refusing to write in place: %s", refusal);
}

nt_status nt_output_check_in_place(const nt_output_options *options, const char *path, nt_error *error)
{
	struct stat status;
	return stat(path, &status) == 0 && S_ISREG(status.st_mode) && is_in_place(options, &status) ?
		refuse_in_place(path, &status, error) : NT_OK;
}

bool nt_output_is_in_place(const nt_output *output, const char *path)
{
	struct stat status;
	return output->options.in_place && stat(path, &status) == 0 && is_in_place(&output->options, &status);
}

void nt_output_leave(nt_output *output)
{
	struct stat status;
	if (output->options.result)
		output->options.result->left = true;
	if (!output->main && output->options.in_place && stat(output->options.in_place, &status) == 0)
		nt_trace_note(NT_TRACE_WRITTEN, output->options.in_place, NULL, &status);
}

/* Refuses a target that exists and has to stay. */
static nt_status check_existing(const nt_output *output, nt_sink *sink, const struct stat *status, nt_error *error)
{
	const nt_protected_file *file;
	if (S_ISDIR(status->st_mode))
		return nt_fail_file(error, NT_ERROR_IO, sink->path, "cannot write: it is a directory");
	const bool is_protected = nt_output_is_protected(output, status, &file);
	if (is_protected && !file->path)
		return nt_fail_file(error, NT_ERROR_IO, sink->path,
			"refusing to write: another input of this run is made from it");
	if (is_protected)
		return nt_fail_file(error, NT_ERROR_IO, sink->path,
			"refusing to write: it is the same file as the input %s%s%s",
			strcmp(file->path, "-") == 0 ? "(standard input)" : file->path,
			file->way_out ? "; " : "", file->way_out ? file->way_out : "");
	if (!S_ISREG(status->st_mode))
		return NT_OK;
	if (output->options.no_clobber)
		return nt_sink_refuse_existing(error, sink->path);
	sink->in_place = is_in_place(&output->options, status);
	return sink->in_place ? refuse_in_place(sink->path, status, error) : NT_OK;
}

/* Sidecars have the lock of their main file: sets may have more files than a process may have open. A main file that is
 * a link may lead to another folder, in which nobody looks for that lock: then a file beside them has it. */
static int create_temporary(nt_output *output, nt_sink *sink, const char *beside)
{
	const nt_sink *main = nt_sink_is_sidecar(sink) ? output->main : NULL;
	const nt_temporary *leader = main ? main->temporary : NULL;
	struct stat info;
	if (leader && lstat(main->path, &info) == 0 && S_ISLNK(info.st_mode)) {
		/* without one it has a lock of its own */
		if (!output->leader)
			nt_temporary_create(beside, 0600, NULL, &output->leader);
		leader = output->leader;
	}
	return nt_temporary_create(beside, sink->in_place ? 0600 : 0666, leader, &sink->temporary);
}

static nt_status refuse_folder(const char *path, const char *folder, nt_error *error)
{
	return nt_fail_file(error, NT_ERROR_IO, path, "cannot write: there is no folder \"%s\"", folder);
}

nt_status nt_output_check_folder(const char *path, nt_error *error)
{
	char folder[PATH_MAX];
	nt_folder_of(path, folder);
	return nt_is_folder(folder) ? NT_OK : refuse_folder(path, folder, error);
}

/* Creates the temporary beside a path and explains why it cannot. */
static nt_status open_temporary(nt_output *output, nt_sink *sink, const char *beside, nt_error *error)
{
	char text[PATH_MAX];
	const char *folder = nt_folder_of(beside, text);
	sink->fd = create_temporary(output, sink, beside);
	const int number = errno;
	if (sink->fd >= 0) {
		nt_temporaries_clean(folder);
		return NT_OK;
	}
	if (number == ENOMEM) {
		nt_fail_memory(error);
		return nt_error_in_file(error, sink->path);
	}
	if (number != ENOENT && number != ENOTDIR)
		return nt_fail_file(error, NT_ERROR_IO, sink->path, "cannot create a file in the folder \"%s\": %s",
			folder, strerror(number));
	if (!nt_is_folder(folder))
		return refuse_folder(sink->path, folder, error);
	return nt_fail_file(error, NT_ERROR_IO, sink->path, /* as those of /proc */
		"cannot write: the folder \"%s\" takes no new files", folder);
}

bool nt_output_is_stream(const char *path)
{
	struct stat status;
	return strcmp(path, "-") == 0 ||
		(stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode));
}

/* Whether a path is taken, and by what. A link that leads nowhere, or round in a circle, is refused: what it stands for
 * is not known. */
static nt_status look_at(const char *path, struct stat *status, bool *exists, nt_error *error)
{
	struct stat link;
	*exists = lstat(path, &link) == 0;
	const bool is_link = *exists && S_ISLNK(link.st_mode);
	if (*exists && !is_link)
		*status = link;
	if (is_link)
		*exists = stat(path, status) == 0;
	if (*exists)
		return NT_OK;
	const int number = errno;
	if (is_link && (number == ENOENT || number == ENOTDIR))
		return nt_fail_file(error, NT_ERROR_IO, path,
			"refusing to write: it is a symbolic link that leads nowhere");
	if (number == ELOOP)
		return nt_fail_file(error, NT_ERROR_IO, path,
			"refusing to write: it is a symbolic link that leads back to itself");
	return number == ENOENT || number == ENOTDIR ? NT_OK : nt_sink_fail(error, path, number);
}

static nt_status open_main(nt_output *output, nt_sink *sink, nt_error *error)
{
	if (strcmp(sink->path, "-") == 0) {
		sink->fd = STDOUT_FILENO;
		sink->shared_fd = true;
		return NT_OK;
	}
	struct stat status;
	bool exists;
	nt_status checked = look_at(sink->path, &status, &exists, error);
	if (!checked && exists)
		checked = check_existing(output, sink, &status, error);
	if (checked)
		return checked;
	if (exists)
		sink->there = nt_state_of(&status);
	if (exists && !S_ISREG(status.st_mode)) {
		if (sink->dry)
			return NT_OK;
		sink->fd = open(sink->path, O_WRONLY | O_CLOEXEC);
		return sink->fd < 0 ? nt_sink_fail(error, sink->path, errno) : NT_OK;
	}
	char *real = exists ? realpath(sink->path, NULL) : NULL;
	const int number = errno;
	sink->target = real ? nt_arena_text(&output->texts, real, strlen(real)) : sink->path;
	free(real);
	if (!sink->target || (exists && !real))
		return nt_sink_fail(error, sink->path, sink->target ? number : ENOMEM);
	return sink->dry ? NT_OK : open_temporary(output, sink, sink->target, error);
}

static void free_sink(nt_sink *sink)
{
	if (sink->fd >= 0 && !sink->shared_fd && !sink->temporary)
		close(sink->fd);
	nt_temporary_discard(sink->temporary);
	nt_digest_free(sink->digest);
	free(sink->buffer);
	free(sink);
}

static nt_status open_sink(nt_output *output, nt_sink *sink, nt_error *error)
{
	if (nt_sink_is_sidecar(sink)) {
		sink->digest = nt_digest_create();
		if (!sink->digest)
			return nt_fail_memory(error);
		return sink->dry ? NT_OK : open_temporary(output, sink, sink->path, error);
	}
	if (sink->role != NT_ROLE_STAGING)
		return open_main(output, sink, error);
	/* the same file as the main file, so it was checked with that */
	sink->target = output->main->target;
	return open_temporary(output, sink, sink->target, error);
}

static void append_sink(nt_output *output, nt_sink *sink)
{
	if (output->last)
		output->last->next = sink;
	else
		output->first = sink;
	output->last = sink;
	if (sink->role == NT_ROLE_MAIN)
		output->main = sink;
	if (sink->role == NT_ROLE_STAGING)
		output->staging = sink;
}

nt_status nt_output_add(nt_output *output, const char *path, nt_role role, nt_sink **sink, nt_error *error)
{
	nt_sink *added = nt_calloc(1, sizeof *added);
	if (!added)
		return nt_fail_memory(error);
	added->fd = -1;
	added->role = role;
	added->dry = output->options.dry_run;
	added->path = nt_arena_text(&output->texts, path, strlen(path));
	added->buffer = nt_alloc(NT_SINK_BUFFER_BYTES, 1);
	nt_status status = added->path && added->buffer ? open_sink(output, added, error)
							: nt_fail_memory(error);
	if (!status && !nt_sink_is_sidecar(added) && added->target)
		status = nt_output_note_name(output, added, added->path, error);
	if (status) {
		free_sink(added);
		return status;
	}
	append_sink(output, added);
	*sink = added;
	return NT_OK;
}

/* ---- looking ---- */

nt_status nt_output_written(nt_output *output, const char *path, const char **temporary,
	nt_error *error)
{
	*temporary = NULL;
	/* sidecars are in the folder of the main file, however their writers spell that */
	const size_t folder = nt_folder_length(path);
	const char *main = output->main ? output->main->path : path;
	const bool beside = nt_folder_length(main) == folder && strncmp(main, path, folder) == 0;
	for (nt_sink *sink = output->first; sink; sink = sink->next) {
		const bool found = nt_sink_is_sidecar(sink)
			? beside && sink->settled && strcmp(nt_sink_name(sink, false), nt_last_part(path)) == 0
			: sink->role == NT_ROLE_MAIN && strcmp(sink->path, path) == 0;
		if (!found || !sink->temporary)
			continue;
		*temporary = nt_temporary_path(sink->temporary);
		return nt_sink_flush(sink, error);
	}
	return NT_OK;
}

uint64_t nt_output_size(const nt_output *output)
{
	uint64_t size = 0;
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		size += sink->role == NT_ROLE_STAGING ? 0 : sink->size;
	return size;
}

uint64_t nt_output_copied(const nt_output *output)
{
	uint64_t size = 0;
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		size += sink->role == NT_ROLE_STAGING ? 0 : sink->copied;
	return size;
}

/* ---- the end ---- */

void nt_output_note(nt_output *output, const char *format, ...)
{
	if (!output->options.result)
		return;
	char text[1024];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(text, sizeof text, format, arguments);
	va_end(arguments);
	nt_buffer_text(&output->options.result->note, text);
}

/* Notes sidecars that got another name than they asked for. nt_output_place() allocates for everything that it may add
 * before it places anything. */
static nt_status note_names(const nt_output *output, nt_error *error)
{
	enum { NAMES_SHOWN = 3, OTHER_WORDS = 200 };
	nt_buffer *note = output->options.result ? &output->options.result->note : NULL;
	size_t count = 0, later = 0;
	for (const nt_sink *sink = output->first; sink && note; sink = sink->next) {
		const char *wanted = nt_last_part(sink->path);
		if (nt_sink_is_sidecar(sink) && strcmp(wanted, nt_sink_name(sink, false)) != 0 &&
			count++ < NAMES_SHOWN)
			nt_buffer_format(note, "; %s is another file, so ours is %s", wanted,
				nt_sink_name(sink, false));
		if (sink->staging)
			later += strlen(nt_sink_name(sink, false)) + strlen(nt_sink_name(sink, true)) + OTHER_WORDS;
	}
	if (count > NAMES_SHOWN)
		nt_buffer_format(note, "; %zu more names were taken", count - NAMES_SHOWN);
	return !note || (nt_buffer_reserve(note, later) && !note->failed) ? NT_OK : nt_fail_memory(error);
}

/* A main file that would only be replaced by its own bytes stays, if that is wanted. */
static nt_status leave_equal(nt_output *output, nt_error *error)
{
	nt_sink *main = output->main;
	const nt_equal_choice choice = main && main->in_place ? NT_EQUAL_KEEP : output->options.equal;
	if (!main || !main->temporary || choice == NT_EQUAL_REPLACE)
		return NT_OK;
	bool same;
	struct stat there;
	if (stat(main->target, &there) != 0 || (uintmax_t)there.st_size != main->size)
		return NT_OK;
	const nt_status status =
		nt_same_bytes(nt_temporary_path(main->temporary), main->target, &same, error);
	/* what may not be touched is replaced */
	if (!status && same && (choice == NT_EQUAL_KEEP || utimensat(AT_FDCWD, main->target, NULL, 0) == 0)) {
		main->stays = true; /* its lock is that of the sidecars */
		nt_output_leave(output);
	}
	return status;
}

/* The present name of a complete file of the set. */
static const char *present_path(const nt_sink *sink)
{
	return sink->temporary && !sink->stays ? nt_temporary_path(sink->temporary) : nt_sink_place(sink);
}

nt_status nt_output_commit(nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (nt_sink *sink = output->first; sink && !status; sink = sink->next) {
		if (nt_sink_is_sidecar(sink))
			status = nt_output_settle(output, sink, error);
		/* until now it was what others could read, whatever became of the file that is used */
		if (sink->stays && sink->temporary) {
			nt_temporary_discard(sink->temporary);
			sink->temporary = NULL;
			sink->fd = -1;
		}
		if (!status && sink->in_place && sink->temporary)
			status = nt_keep_attributes(sink->fd, sink->target, error);
		if (!status)
			status = nt_sink_finish(sink, output->options.sync, error);
	}
	if (!status)
		status = leave_equal(output, error);
	if (!status && !output->options.dry_run) {
		/* under the names that they are going to have: renaming and linking keep size and time */
		struct stat info;
		for (const nt_sink *sink = output->first; sink; sink = sink->next)
			if (sink->target && sink->role != NT_ROLE_STAGING && stat(present_path(sink), &info) == 0)
				nt_trace_note(NT_TRACE_WRITTEN, nt_sink_is_sidecar(sink) ? sink->target : sink->path,
					NULL, &info);
		if (output->options.placing)
			status = output->options.placing(output->options.placing_user, error);
	}
	if (!status && !output->options.dry_run)
		status = note_names(output, error);
	if (!status && !output->options.dry_run)
		status = nt_output_place(output, error);
	nt_output_abort(output);
	return status;
}

void nt_output_abort(nt_output *output)
{
	if (!output)
		return;
	for (nt_sink *sink = output->first; sink;) {
		nt_sink *next = sink->next;
		free_sink(sink);
		sink = next;
	}
	nt_temporary_discard(output->leader);
	free(output->named);
	nt_hash_index_free(&output->names);
	nt_key_set_free(&output->guards);
	free(output->ownership);
	free(output->guarded);
	nt_arena_free(&output->texts);
	free(output);
}

nt_status nt_output_end(nt_output *output, nt_status status, nt_error *error)
{
	if (!status)
		return nt_output_commit(output, error);
	nt_output_abort(output);
	return status;
}

static void (*end_process)(void);

static void remove_and_end(void)
{
	nt_temporaries_remove_all();
	end_process();
}

void nt_output_catch_exhaustion(void (*end)(void))
{
	end_process = end;
	nt_on_exhausted(remove_and_end);
}

static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
static struct sigaction actions_before[sizeof faults / sizeof *faults];
static void (*end_changed)(const char *path, const char *change);

static void end_if_changed(int number, siginfo_t *info, void *context)
{
	(void)context;
	static atomic_flag ending = ATOMIC_FLAG_INIT;
	const char *path, *change = nt_watch_any_change(&path);
	if (change) {
		while (atomic_flag_test_and_set(&ending))
			pause(); /* another thread is about it */
		nt_temporaries_remove_all();
		end_changed(path, change);
	}
	for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
		if (faults[i] == number)
			sigaction(number, &actions_before[i], NULL);
	/* an instruction runs into it once more, a process that sent it does not */
	if (info->si_code <= 0)
		raise(number);
}

void nt_output_catch_faults(void (*end)(const char *path, const char *change))
{
	end_changed = end;
	struct sigaction action = {.sa_sigaction = end_if_changed, .sa_flags = SA_SIGINFO};
	sigemptyset(&action.sa_mask);
	for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
		sigaction(faults[i], &action, &actions_before[i]);
}

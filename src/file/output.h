/* SPDX-License-Identifier: MIT */
/*
 * Output sets: one main file and its sidecars (the .bin of a .gltf, copied images), which appear together or not at
 * all.
 *
 * All files are written to temporary files beside their targets. A sidecar gets its name when its bytes are known
 * (nt_output_settle), then the main file is written, which holds those names, and nt_output_commit() puts everything
 * in place; abort, or a signal, removes it. sidecar.c chooses a sidecar's name and says what it may replace; commit.c
 * has the order of the steps, and what a crash leaves after each. Outputs that are pipes or devices, and "-", are
 * written through.
 */
#ifndef NT_FILE_OUTPUT_H
#define NT_FILE_OUTPUT_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include "base/text.h"
#include "file/input.h"

typedef struct nt_output nt_output;
typedef struct nt_sink nt_sink;

typedef enum nt_role {
	NT_ROLE_MAIN,    /* named by the user; a set has one */
	NT_ROLE_STAGING, /* the main file once more, with the staging names of sidecars */
	NT_ROLE_BUFFER,  /* a sidecar of this main file: it may replace one that an earlier run made for it */
	NT_ROLE_IMAGE    /* a sidecar that other documents may share: never replaced, never removed */
} nt_role;

/* The outcome of a set, beyond its status. */
typedef struct nt_output_result {
	bool again;     /* the commit failed because a name was taken meanwhile: with the names chosen anew it
	                   would not */
	bool left;      /* all files had these bytes already and were left as they are */
	nt_buffer note; /* which sidecars do not have their own names, and why: "; ..." */
} nt_output_result;

/* Treatment of a main file that has the bytes of its replacement already. In place it always stays. */
typedef enum nt_equal_choice {
	NT_EQUAL_REPLACE,
	NT_EQUAL_KEEP, /* with its inode and its time of change */
	NT_EQUAL_TOUCH /* with its inode; it counts as changed now */
} nt_equal_choice;

typedef struct nt_output_options {
	bool no_clobber; /* refuse to replace an existing file */
	nt_equal_choice equal;
	bool sync;       /* whatever a power cut leaves, the main file is whole: files and folders are synchronised */
	bool dry_run;    /* refuse what would be refused, count what would be written, write nothing */
	const char *in_place; /* this file may be replaced by a main file, and keeps its mode, owner and
	                         attributes; NULL: none */
	nt_output_result *result; /* NULL: not wanted */
	/* Calls nt_output_add_ownership() for each ownership record in the main file at `path`, which is about to
	 * be replaced; NULL: there are none. Returns NT_OK, also when the file cannot be read, or NT_ERROR_MEMORY. */
	nt_status (*find_ownership)(nt_output *output, const char *path, nt_error *error);
	/* Called by nt_output_commit() when every file is complete, in the trace and about to take its name. Then
	 * nothing takes a name if this fails. NULL: nobody wants to know. */
	nt_status (*placing)(void *user, nt_error *error);
	void *placing_user;
} nt_output_options;

/* Starts an output set. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_output_create(nt_output **output, const nt_output_options *options, nt_error *error);

/* Names a file that must not be written: the input ("-" too) and every file the input refers to. Files that do
 * not exist are ignored. To write in place, do not name the input. way_out: what the refusal advises; NULL: nothing. */
nt_status nt_output_protect(nt_output *output, const char *path, const char *way_out, nt_error *error);

/* With no_clobber, refuses a main file that exists, as nt_output_add() does: for callers that have not read anything
 * yet. */
nt_status nt_output_check_clobber(const nt_output_options *options, const char *path, nt_error *error);

/* Refuses what nt_output_add() refuses in place: for callers that know that the file will change, before they solve. */
nt_status nt_output_check_in_place(const nt_output_options *options, const char *path, nt_error *error);

/*
 * Adds a file to the set; "-" is standard output. The sink belongs to the set.
 *
 * A main file is refused where its path is a directory, a symbolic link that leads nowhere, a protected file or, with
 * no_clobber, an existing file; in place also one that is read-only or has further hard links. A missing folder is
 * refused for any role. Sidecars come after their main file.
 */
nt_status nt_output_add(nt_output *output, const char *path, nt_role role, nt_sink **sink, nt_error *error);

/* Refuses a path whose folder is not there: for callers that add it at the end of a run. */
nt_status nt_output_check_folder(const char *path, nt_error *error);

/* Whether an output of this path has no files beside it: standard output ("-"), a pipe or a device. */
bool nt_output_is_stream(const char *path);

/* Whether this path is the file that is replaced in place; and that it needs no change, so that it is not even
 * added. */
bool nt_output_is_in_place(const nt_output *output, const char *path);
void nt_output_leave(nt_output *output);

/* Adds an ownership record: the main file that is about to be replaced refers to a sidecar `name` in its folder, which
 * we made with this digest. `before`: digest of the file that an interrupted run was replacing; NULL: none. */
nt_status nt_output_add_ownership(nt_output *output, const char *name, const char *digest, const char *before,
	nt_error *error);

/* Ends the writing of a sidecar and chooses its name. */
nt_status nt_output_settle(nt_output *output, nt_sink *sink, nt_error *error);

/* Whether a settled sidecar takes the place of another file. Then the main file is to be written twice: as
 * NT_ROLE_STAGING with staging names, and as NT_ROLE_MAIN. */
bool nt_output_has_staging(const nt_output *output);

/* By which name in its folder the main file refers to a settled sidecar. */
const char *nt_sink_name(const nt_sink *sink, bool staging);

/* The ownership record of a settled sidecar: the digest (ext/linked.h) of its bytes, NULL if it is not ours, and the
 * digest of the file that it replaces, NULL if there is none. */
const char *nt_sink_digest(const nt_sink *sink);
const char *nt_sink_digest_before(const nt_sink *sink);

/* Says before the first byte how many there will be: a large file gets its room on the disk at once where that can be
 * had. Neither less nor more is an error. */
void nt_sink_expect(nt_sink *sink, uint64_t size);

/* Appends bytes. Small writes are buffered, large ones go straight to the file. */
nt_status nt_sink_write(nt_sink *sink, const void *bytes, size_t size, nt_error *error);

/* Appends a range of an input. */
nt_status nt_sink_copy(nt_sink *sink, const nt_file *from, size_t offset, size_t size, nt_error *error);

/* Flushes the file of the set that will have the name `path` and says where it is for the time being; NULL when
 * the set has no such file or writes it through. */
nt_status nt_output_written(nt_output *output, const char *path, const char **temporary,
	nt_error *error);

/* Adds to nt_output_result.note, if that is wanted; begins with "; " or goes on. */
void nt_output_note(nt_output *output, const char *format, ...) NT_PRINTF(2, 3);

/* Bytes written to all files of the set so far, the staging one not counted. */
uint64_t nt_output_size(const nt_output *output);

/* Bytes of them that came from an input file as they are (nt_sink_copy). */
uint64_t nt_output_copied(const nt_output *output);

/* Puts every file in place; on failure the main file and what it refers to are what they were. The set is freed
 * either way. */
nt_status nt_output_commit(nt_output *output, nt_error *error);

/* The same if all of it was written; else aborts the set and returns what the writing did. */
nt_status nt_output_end(nt_output *output, nt_status status, nt_error *error);

/* Makes the name of a file or folder lasting: the folder that it is in onto the disk. Folders that cannot be
 * synchronised are passed over. */
nt_status nt_output_sync_name(const char *path, nt_error *error);

/* Removes the temporary files and frees the set; NULL is allowed. */
void nt_output_abort(nt_output *output);

/* Has the temporary files removed and `end` called, which must not return, where the process cannot go on for want of
 * memory. */
void nt_output_catch_exhaustion(void (*end)(void));

/* The same for a fault of the process (SIGSEGV and such) while an input that is mapped has changed, which is where it
 * comes from then: indices, say, are other ones than those that were checked. `end` gets the file's name and what
 * happened to it, in a signal handler. Any other fault ends the process as before. */
void nt_output_catch_faults(void (*end)(const char *path, const char *change));

/* ---- Base64 (RFC 4648): sink.c ---- */

/* Into a sink, piece by piece, for data URIs that are larger than one would like to hold in memory, and small ones into
 * memory. */

/* Zeroed but for the sink. */
typedef struct nt_base64 {
	nt_sink *sink;
	unsigned char rest[3]; /* bytes that do not fill a group yet */
	unsigned rest_count;
} nt_base64;

nt_status nt_base64_write(nt_base64 *base64, const void *bytes, size_t size, nt_error *error);

/* Writes the last group with its padding. */
nt_status nt_base64_end(nt_base64 *base64, nt_error *error);

/* How many characters that many bytes become; bytes below 2^62. */
static inline uint64_t nt_base64_length(uint64_t bytes)
{
	return (bytes + 2) / 3 * 4;
}

/* Appends the text of `size` bytes, padded. */
void nt_base64_append(nt_buffer *buffer, const void *bytes, size_t size);

/* ---- temporary files: temporary.c ---- */

/* A signal removes them, or, where nothing could (SIGKILL, a power cut), a later run. A file is on the list from the
 * moment it exists until it has its name or is gone, without a gap in between. */

typedef struct nt_temporary nt_temporary;

/* Creates a new file beside `target`, open for reading and writing; its mode is less the umask. The folder is the one
 * that has the path now, wherever that is moved. `leader`: another one of that folder, whose lock will do for both, so
 * that nt_temporary_close() is allowed; it has to be discarded later. NULL: none. Returns its descriptor,
 * which nt_temporary_discard() closes; -1 with errno set otherwise (ENOMEM included). */
int nt_temporary_create(const char *target, unsigned mode, const nt_temporary *leader, nt_temporary **temporary);

/* Closes the descriptor of a file that has a leader: of many files, few are open. False, with errno: the system had not
 * written all of it. */
bool nt_temporary_close(nt_temporary *temporary);

/* Whether its descriptor may be closed. */
bool nt_temporary_is_led(const nt_temporary *temporary);

/* A second name beside `target` for the file `from`. False, with errno, where the file system has no links. */
bool nt_temporary_link(const char *from, const char *target, nt_temporary **temporary);

/* Its place. */
const char *nt_temporary_path(const nt_temporary *temporary);

/* The name of a file's leader, which is in the same folder; false: it has none. */
enum { NT_TEMPORARY_NAME = 160 };
bool nt_temporary_leader_of(const char *name, char leader[NT_TEMPORARY_NAME]);

/* Whether a name is that of a temporary file, and its owner, if it still runs, has a lock that this process meets: on a
 * disk of this machine alone (`local`), or of this boot. */
bool nt_temporary_is_lockable(const char *name, bool local);

/* Removes stale temporary files from a folder, which each process looks through once. A failure does not matter: the
 * next run looks again. */
void nt_temporaries_clean(const char *folder);

/* Between hold and release no signal ends the process, so that the steps of a set happen all or not at all. Several
 * threads may hold. `before` keeps the thread's signals. */
void nt_temporaries_hold(sigset_t *before);
void nt_temporaries_release(const sigset_t *before);

/* Gives the file the name that ends `target`, in its folder; while held. `replace`: an existing file may go; otherwise
 * that is EEXIST. On failure errno is set and the file stays what it was. */
bool nt_temporary_rename(nt_temporary *temporary, const char *target, bool replace);

/* Takes that name away again. */
void nt_temporary_remove_name(const nt_temporary *temporary, const char *target);

/* Frees the entry and removes the file, where it has not been renamed. NULL is allowed. */
void nt_temporary_discard(nt_temporary *temporary);

/* Removes the temporary files of all sets, for a process that ends: what is on its way to its place gets there first,
 * and nothing sets out any more. Safe in a signal handler. */
void nt_temporaries_remove_all(void);

/* Makes SIGINT, SIGTERM and SIGHUP remove the temporary files and call `tell` (NULL: nothing), in the handler, before
 * they end the process, and turns SIGPIPE into a write error. Called once by the front end. */
void nt_temporaries_catch_signals(void (*tell)(void));

#endif

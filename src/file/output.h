/* SPDX-License-Identifier: MIT */
/*
 * Output sets: one main file and its sidecars (the .bin of a .gltf, copied images), which appear together or not at
 * all.
 *
 * All files are written to temporary files beside their targets. A sidecar gets its name when its bytes are known
 * (nt_output_settle), then the main file is written, which holds those names, and nt_output_commit() puts everything in
 * place; abort, or a signal, removes it. sidecar.c chooses a sidecar's name and says what it may replace; commit.c
 * has the order of the steps, and what a crash leaves after each. Outputs that are pipes or devices, and "-", are
 * written through.
 */
#ifndef NT_FILE_OUTPUT_H
#define NT_FILE_OUTPUT_H

#include "base/text.h"
#include "file/input.h"

typedef struct nt_output nt_output;
typedef struct nt_sink nt_sink;

typedef enum nt_role {
	NT_ROLE_MAIN,    /* named by the user. Further ones stand for themselves and are placed before the first */
	NT_ROLE_STAGING, /* the first main file once more, with the staging names of sidecars */
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
	/* Called by nt_output_commit() when every file is complete, noted (trace.h) and about to take its name. Then
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
 * A main file is refused where its path is a directory, a symbolic link that leads nowhere, a protected file, a
 * main file of this set or, with no_clobber, an existing file; in place also one that is read-only or has further
 * hard links. A missing folder is refused for any role. Sidecars come after their main file.
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

/* The ownership record of a settled sidecar: the digest (ext/digest.h) of its bytes, NULL if it is not ours, and the
 * digest of the file that it replaces, NULL if there is none. */
const char *nt_sink_digest(const nt_sink *sink);
const char *nt_sink_digest_before(const nt_sink *sink);

/* The staging name of data for `name`: "a.new-0123456789abcdef.bin" for "a.bin".
 * Appended. */
void nt_output_staging_name(nt_buffer *text, const char *name, const char *digest);

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

#endif

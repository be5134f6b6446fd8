/* SPDX-License-Identifier: MIT */
/*
 * Shared by the files of an output set's implementation: sink.c writes bytes, sidecar.c chooses names, same_file.c
 * keeps what a file in place has, commit.c puts things in place, output.c is above them.
 */
#ifndef NT_FILE_OUTPUT_PARTS_H
#define NT_FILE_OUTPUT_PARTS_H

#include <sys/stat.h>
#include "base/hash_index.h"
#include "base/memory.h"
#include "file/input.h"
#include "file/output.h"
#include "file/path.h"

/* One state of one file; it has changed when any of it differs. */
typedef struct nt_file_state {
	nt_file_id id;
	off_t size;
	struct timespec modified;
} nt_file_state;

/* Buffer of a sink: the page cache takes a megabyte at a time in larger pages than a quarter of one. */
enum { NT_SINK_BUFFER_BYTES = 1024 * 1024 };

struct nt_sink {
	nt_sink *next;            /* in the order of adding */
	nt_temporary *temporary;  /* NULL: written through, or not needed any more */
	int fd;
	nt_role role;
	bool shared_fd;           /* standard output: not ours to close */
	bool dry;                 /* counts bytes and drops them */
	bool in_place;            /* the main file: it is the input's */
	bool placed;              /* its temporary file has a name */
	uint64_t size;
	uint64_t copied; /* of them from an input file as they are */
	size_t used;              /* bytes in buffer */
	unsigned char *buffer;
	nt_digest *digest;        /* of all bytes; sidecars only */
	/* texts are the set's */
	const char *path;         /* as the caller named it */
	const char *target;       /* where it goes: where symbolic links lead, or a settled sidecar's name; NULL when
	                             written through */
	bool stays;               /* the name that it gets has a file of its bytes, which is used */
	nt_file_state there;      /* what has the target, of a main file: had when it was added; zeroed: nothing */
	/* of a settled sidecar */
	bool settled, ours, is_of_set; /* is_of_set: the file that is used is another one of this very set */
	const char *staging;      /* the name for a time of one that replaces what is there; NULL: it does not */
	char text[NT_DIGEST_TEXT], before[NT_DIGEST_TEXT]; /* before: of what is replaced, or superseded; "": nothing */
};

typedef struct nt_protected_file {
	const char *path;
	const char *way_out; /* a constant; NULL: none */
} nt_protected_file;

typedef struct nt_ownership {
	const char *name, *digest, *before; /* before: may be NULL */
} nt_ownership;

struct nt_output {
	nt_output_options options;
	nt_arena texts;
	nt_sink *first, *last, *main, *staging;
	nt_temporary *leader; /* has the lock of the sidecars if the main file is a link; NULL: not yet */
	nt_sink **named; /* by the names that they have or will have */
	size_t named_count, named_capacity;
	nt_hash_index names;
	nt_key_set guards; /* of nt_file_id */
	nt_protected_file *guarded; /* [guards.count] */
	size_t guarded_capacity;
	nt_ownership *ownership; /* what the previous main file records */
	size_t ownership_count, ownership_capacity;
	bool ownership_known;
};

/* ---- sink.c ---- */

nt_status nt_sink_fail(nt_error *error, const char *path, int number);
nt_status nt_sink_refuse_existing(nt_error *error, const char *path);
nt_status nt_sink_flush(nt_sink *sink, nt_error *error);

/* Flushes, synchronises where that is asked for, and closes; a second call does nothing. */
nt_status nt_sink_finish(nt_sink *sink, bool sync, nt_error *error);

/* ---- sidecar.c ---- */

static inline bool nt_sink_is_sidecar(const nt_sink *sink)
{
	return sink->role == NT_ROLE_BUFFER || sink->role == NT_ROLE_IMAGE;
}

nt_file_state nt_state_of(const struct stat *status);

/* Whether a path, links followed, still is the file in that state. */
bool nt_state_is(const char *path, const nt_file_state *state);

/* The path of a settled sidecar once the main file is placed for the first time. */
static inline const char *nt_sink_place(const nt_sink *sink)
{
	return sink->staging ? sink->staging : sink->target;
}

/* Notes a name that a file of the set has. */
nt_status nt_output_note_name(nt_output *output, nt_sink *sink, const char *path, nt_error *error);

/* `file`: its path is NULL where another run of the batch has read it. */
bool nt_output_is_protected(const nt_output *output, const struct stat *status, const nt_protected_file **file);

/* Removes files of ours that were named by their bytes, to which nothing refers any more once the set is in place. */
void nt_output_remove_superseded(const nt_output *output);

/* Removes what killed runs left under staging names of the sidecars of this set, which is in place, if no document
 * beside it needs that. Nobody else may be placing files in the folder. */
void nt_output_remove_stale_staging(const nt_output *output);

/* ---- same_file.c ---- */

/* Why a file may not be replaced in place; NULL: it may. */
const char *nt_in_place_refusal(const char *path, const struct stat *status);

/* Gives a new file mode, owner, attributes and access lists of the one it is going to replace. */
nt_status nt_keep_attributes(int fd, const char *target, nt_error *error);

/* ---- commit.c ---- */

nt_status nt_output_place(nt_output *output, nt_error *error);

#endif

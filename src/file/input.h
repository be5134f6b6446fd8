/* SPDX-License-Identifier: MIT */
/*
 * Reading: the bytes of a file, the looking for files, the trace of what a run has read and written, and the types of
 * images. Outputs are in output.h.
 */
#ifndef NT_FILE_INPUT_H
#define NT_FILE_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include "base/hash_index.h"
#include "base/text.h"
#include "ext/linked.h"

/* ---- looking for files: trace.c ---- */

/* If a file is missing, a reader may go on; if the system cannot tell, that is an error and never counts as missing. */

/*
 * The status for an errno of looking for a file: NT_ERROR_MISSING for ENOENT and ENOTDIR, and for names that are longer
 * than any file's, or are a folder's; NT_ERROR_MEMORY; else NT_ERROR_IO. The error names the path.
 */
nt_status nt_lookup_failed(const char *path, int number, nt_error *error);

/* Whether a name is longer than any path that the system takes. A function that follows a name step by step asks this
 * first: the steps of a long one take quadratic time. */
bool nt_name_is_too_long(const char *name);

/* stat(). Returns NT_OK or what nt_lookup_failed() says. */
nt_status nt_lookup(const char *path, struct stat *info, nt_error *error);

/* The same, where a file that is missing is no fault and leaves the error alone: *found says which. */
nt_status nt_lookup_found(const char *path, struct stat *info, bool *found, nt_error *error);

/* The entry of a folder that is called `name` in some case (of ASCII), the first in the order of bytes; free(*entry).
 * NULL: there is none, or no such folder. Noted as a search. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_lookup_any_case(
	const char *folder, const char *name, size_t length, char **entry, nt_error *error);

/* Which file it is, by whatever name. Zeroed: none. */
typedef struct nt_file_id {
	uint64_t device, inode;
} nt_file_id;

static inline nt_file_id nt_file_id_of(const struct stat *info)
{
	return (nt_file_id){(uint64_t)info->st_dev, (uint64_t)info->st_ino};
}

static inline bool nt_same_id(nt_file_id a, nt_file_id b)
{
	return a.device == b.device && a.inode == b.inode;
}

static inline bool nt_same_file(const struct stat *a, const struct stat *b)
{
	return nt_same_id(nt_file_id_of(a), nt_file_id_of(b));
}

/* ---- a file's bytes, mapped: input.c ---- */

/* An input's bytes. */
typedef struct nt_file {
	const unsigned char *data; /* never NULL after success */
	size_t size;
	bool mapped; /* else malloc'ed, unless it is borrowed */
	bool borrowed;
	int watch;   /* of a mapped file: see nt_watch_begin() */
	int fd;      /* of a mapped file, -1 otherwise */
	uint64_t device, inode; /* which file it is; 0, 0 for standard input */
} nt_file;

/* The one who names a file. */
typedef enum nt_naming {
	NT_NAMED_BY_USER,     /* "-" is standard input; a pipe is read to its end */
	NT_NAMED_BY_DOCUMENT, /* only regular files, for which nobody waits; "-" is a file that is called so */
	NT_NAMED_BY_US        /* no source of what is made, such as an output that is compared: not in the trace */
} nt_naming;

/* Maps a file, or reads it where it cannot be mapped; devices have no end and are refused. If a checkout has only the
 * pointer by which Git LFS stands for the file, NT_ERROR_MISSING says so, but for files of ours. The error carries the
 * name. Returns NT_OK, NT_ERROR_MISSING, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_file_open(nt_file *file, const char *path, nt_naming naming, nt_error *error);

bool nt_is_folder(const char *path);

void nt_file_close(nt_file *file);

/* Bytes of the caller, as a file. */
nt_file nt_file_of_bytes(const unsigned char *bytes, size_t size);

/* Lets go of the pages of a range of a mapped file, so that a file that is copied does not fill the memory. Nothing is
 * lost: what is read afterwards comes back. For files that are not mapped, and kernels that cannot, nothing happens. */
void nt_file_release(const nt_file *file, size_t offset, size_t size);

/* Whether the file is as long as when it was opened: reading what is gone gives zeros. */
bool nt_file_is_intact(const nt_file *file);

/* Whether path names the file that was opened. */
bool nt_file_is(const nt_file *file, const char *path);

/* ---- files that may be somebody else's ---- */

/* Whether two files hold the same bytes. False too where one of them cannot be read; NT_ERROR_MEMORY or
 * NT_ERROR_IO where that is the system's fault. */
nt_status nt_same_bytes(const char *a, const char *b, bool *same, nt_error *error);

/* The digest of a file's bytes; empty where it cannot be read. Returns as nt_same_bytes(). */
nt_status nt_digest_of_file(const char *path, char text[NT_DIGEST_TEXT], nt_error *error);

/* ---- files that another process changes meanwhile: watch.c ---- */

/*
 * Detects that another process changed a mapped file while it was read (by its time of modification), so that the
 * result is not used.
 *
 * If a file becomes shorter, reading the missing pages raises SIGBUS, which would end the process; here they become
 * zeros, and the reader goes on. If checked values are zeros later and that is a fault, nt_output_catch_faults()
 * reports it.
 *
 * A file belongs to the thread that opened it. Threads that help this one may read it too.
 */

/* Watches a map of a whole file, named by `path`, whose status was taken before it was mapped; a number for
 * nt_watch_end(). Below 0: too many are watched, so that the file has to be read instead. */
int nt_watch_begin(const void *map, const struct stat *status, int fd, const char *path);

/* To be called before the file is closed, and after its map is gone. */
void nt_watch_end(int watch);

/* Forgets what this thread has read so far, but for files that are open. */
void nt_watch_forget(void);

/* Returns NT_ERROR_IO, with the name, if a file that this thread opened has changed; else NT_OK. */
nt_status nt_watch_check(nt_error *error);

/* The change of the first open file that has changed, and its name; NULL: none has. Safe in a signal
 * handler. */
const char *nt_watch_any_change(const char **path);

/* Whether a file has become shorter. */
bool nt_watch_is_shortened(int watch);

/* For bytes that a system call could not read (EFAULT): reads them as a program does. True when they were in a
 * watched map and can be read now. */
bool nt_watch_touch(const void *bytes, size_t size);

/* ---- the trace: trace.c ---- */

/*
 * Files that a run reads and writes, noted by those that do it: nt_file_open() and the looking for files
 * note what is read and what is missing, nt_output_commit() what is written. The caller of a run sets the trace of
 * its thread; functions in between need no argument for it.
 *
 * A later run can tell by it whether it would read the same: nothing that decides on a file goes unnoted.
 */

typedef enum nt_trace_kind {
	NT_TRACE_READ,
	NT_TRACE_MISSING, /* it was looked for, and would have been read as a regular file */
	NT_TRACE_WRITTEN,
	NT_TRACE_SEARCHED, /* its folder was searched for its name in any case */
	NT_TRACE_LINK,     /* by links on its way, it is another path */
	NT_TRACE_OUTSIDE   /* by links on its way, it leaves a folder */
} nt_trace_kind;

/* A file as it was when it was opened, or as it will be when its set is in place; or a folder as it was searched. */
typedef struct nt_trace_file {
	char *path; /* as the run named it: relative to the current folder, or absolute */
	nt_trace_kind kind;
	char *found; /* SEARCHED: the entry that has the name; LINK: the path; NULL: none. OUTSIDE: the name
	                in the folder */
	uint64_t size, inode;      /* 0 for what is missing */
	int64_t modified, changed; /* nanoseconds since 1970: last change of the bytes, and of the inode */
	int64_t noted;             /* when it was noted */
} nt_trace_file;

/* Which files the runs of a batch have read, so that none of them overwrites what another one reads. Zeroed: none. */
typedef struct nt_readers {
	nt_key_set files;  /* of nt_file_id */
	unsigned *readers; /* of each; 0: several */
	size_t capacity;
	unsigned runs;
} nt_readers;

void nt_readers_free(nt_readers *readers);

/* Zeroed: empty. A file is in it once for each kind, in the order of first use. */
typedef struct nt_trace {
	nt_trace_file *files;
	size_t count, capacity;
	nt_hash_index index;
	bool failed; /* memory ran out: something is not in it */
	nt_readers *readers; /* NULL: nobody wants to know; else what is read is there, too, */
	unsigned reader;     /* as read by this one */
} nt_trace;

/* Shares what the trace notes as read from now on. Once for each run. */
void nt_trace_share(nt_trace *trace, nt_readers *readers);

/* Whether a run that shares with that of the trace that is used has read a file. */
bool nt_trace_is_read_elsewhere(const struct stat *info);

/* From now on this thread notes in `trace`; NULL: nowhere. Returns what it noted in before. Several threads may note
 * in one trace: each that helps a run and opens files has to be lent it. */
nt_trace *nt_trace_use(nt_trace *trace);

/* Notes one. A file that is about to be written has its `info` already. A search has that of the folder in which it
 * looked for the last part of `path`; a link and a file that is missing have none. Nothing happens if no trace is used.
 */
void nt_trace_note(nt_trace_kind kind, const char *path, const char *found, const struct stat *info);

/* Times in nanoseconds since 1970: of the last change of a file's bytes, and of its inode. */
int64_t nt_trace_modified(const struct stat *info);
int64_t nt_trace_changed(const struct stat *info);

/* Forgets what was written, for a run that is to be done again. */
void nt_trace_forget_written(nt_trace *trace);

void nt_trace_free(nt_trace *trace);

/* ---- types of image files: image_type.c ---- */

/* They are told by the first bytes. glTF carries some; the others are known so that they can be converted or named. */

typedef enum nt_image_type {
	NT_IMAGE_OTHER,
	NT_IMAGE_PNG, /* these four glTF carries */
	NT_IMAGE_JPEG,
	NT_IMAGE_KTX2,
	NT_IMAGE_WEBP,
	NT_IMAGE_TGA,
	NT_IMAGE_BMP,
	NT_IMAGE_PSD,
	NT_IMAGE_HDR,
	NT_IMAGE_TIFF,
	NT_IMAGE_EXR
} nt_image_type;

/* A TGA has no signature; it is told by a header that no other format here has. */
nt_image_type nt_image_type_of_bytes(const unsigned char *bytes, size_t size);

/* By the extension of a name, in any case: for files that are not there. */
nt_image_type nt_image_type_of_name(const char *name);

/* "PNG"; for NT_IMAGE_OTHER "unknown". */
const char *nt_image_type_name(nt_image_type type);

/* Whether a glTF can refer to it, by itself or with an extension. */
bool nt_image_is_carried(nt_image_type type);

/* "image/png"; NULL where glTF does not carry it. */
const char *nt_image_media_type(nt_image_type type);

/* The glTF extension through which a texture refers to such an image; NULL: the core does. */
const char *nt_image_extension(nt_image_type type);

/* Width and height of a PNG, JPEG, WebP, TGA, BMP, PSD, HDR or TIFF, as its header says; false, and both
 * 0, for other types, damaged headers and images without pixels. */
bool nt_image_size(const unsigned char *bytes, size_t size, uint32_t pixels[2]);

/* The pixels that a decoder goes over: those of a JPEG of several scans once for each, those of a TIFF with all of its
 * tiles. 0: not known. */
uint64_t nt_image_work(const unsigned char *bytes, size_t size);

#endif

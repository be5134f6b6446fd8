/* SPDX-License-Identifier: MIT */
/*
 * Files: inputs are mapped, outputs appear whole or not at all.
 *
 * An output set is one main file and its companions (the .bin of a .gltf, copied images). All are
 * written to temporary files beside their targets; commit gives them their names, companions first and
 * the main file last; abort, or a signal, removes them. Outputs that are pipes or devices, and "-", are
 * written through.
 */
#ifndef NT_FILE_INPUT_H
#define NT_FILE_INPUT_H

#include "base/error.h"

/* An input's bytes. */
typedef struct nt_file {
	const unsigned char *data; /* never NULL after success */
	size_t size;
	bool mapped; /* else malloc'ed */
	int fd;      /* of a mapped file, -1 otherwise */
	uint64_t device, inode; /* which file it is; 0, 0 for standard input */
} nt_file;

/* Maps a file, or reads standard input when path is "-" or the file is a pipe. The error carries the
 * name. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_file_open(nt_file *file, const char *path, nt_error *error);
void nt_file_close(nt_file *file);

/* Says that bytes of a mapped file will hardly be read again: their pages no longer count as memory of this
 * process, and come back when they are read all the same. What is not in the map is left alone. */
void nt_file_forget(const nt_file *file, const void *bytes, size_t size);

/* Brings the pages of a range of a mapped file in at once, which costs less than a fault for every few of them,
 * and lets go of them again, so that a file that is copied does not fill the memory. Nothing is lost: what is
 * read afterwards comes back. For files that are not mapped, and kernels that cannot, nothing happens. */
void nt_file_fetch(const nt_file *file, size_t offset, size_t size);
void nt_file_release(const nt_file *file, size_t offset, size_t size);

/* Whether path names the file that was opened. */
bool nt_file_is(const nt_file *file, const char *path);

typedef struct nt_output nt_output;
typedef struct nt_sink nt_sink;

typedef struct nt_output_options {
	bool no_clobber; /* refuse to replace an existing file */
	bool sync;       /* fsync before the renames */
	bool dry_run;    /* refuse what would be refused, count what would be written, write nothing */
} nt_output_options;

/* Starts an output set. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_output_create(nt_output **output, const nt_output_options *options, nt_error *error);

/* Names a file that must not be written: the input ("-" too) and every file the input refers to. Files that do
 * not exist are ignored. To write in place, do not name the input. way_out: what the refusal advises; NULL: nothing. */
nt_status nt_output_protect(nt_output *output, const char *path, const char *way_out, nt_error *error);

/* Adds a file to the set; "-" is standard output. The first file added with main = true gets its name last. A
 * directory, a missing folder, a protected file, the same name twice and, with no_clobber, an existing file are
 * errors. The sink belongs to the set. */
nt_status nt_output_add(nt_output *output, const char *path, bool main, nt_sink **sink,
	nt_error *error);

/* Appends bytes. Small writes are buffered, large ones go straight to the file. */
nt_status nt_sink_write(nt_sink *sink, const void *bytes, size_t size, nt_error *error);

/* Appends a range of an input: by copy_file_range where the kernel can and the pages of both
 * files meet, else like nt_sink_write. */
nt_status nt_sink_copy(nt_sink *sink, const nt_file *from, size_t offset, size_t size,
	nt_error *error);

/* Flushes the file of the set that was added under `path` and says where it is for the time being; NULL when
 * the set has no such file or writes it through. */
nt_status nt_output_written(nt_output *output, const char *path, const char **temporary,
	nt_error *error);

/* Bytes written to all files of the set so far. */
uint64_t nt_output_size(const nt_output *output);

/* Bytes of them that came from an input file as they are (nt_sink_copy). */
uint64_t nt_output_copied(const nt_output *output);

/* Gives every file its name, in order; on failure everything is removed as by nt_output_abort. The set is freed
 * either way. */
nt_status nt_output_commit(nt_output *output, nt_error *error);

/* Removes the temporary files and frees the set; NULL is allowed. */
void nt_output_abort(nt_output *output);

/* Makes SIGINT, SIGTERM and SIGHUP remove the temporary files before they end the process, and turns SIGPIPE
 * into a write error. Called once by the front end. */
void nt_output_catch_signals(void);

#endif

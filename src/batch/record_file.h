/* SPDX-License-Identifier: MIT */
/*
 * The file of a record: lines with a key, of which the last of each key counts, that several processes append to.
 */
#ifndef NT_BATCH_RECORD_FILE_H
#define NT_BATCH_RECORD_FILE_H

#include "base/buffer.h"
#include "base/hash_index.h"

/* One line; it begins with the file's prefix, then comes the key up to a quotation mark. */
typedef struct nt_record_line {
	size_t offset, length, key_length; /* in the text; the key begins behind the prefix */
} nt_record_line;

typedef struct nt_record_file {
	char *path;
	const char *prefix; /* a constant */
	bool (*is_whole)(const char *line, size_t length); /* NULL: every line is */
	char *text;         /* as it was when it was read */
	size_t size;
	nt_record_line *lines; /* the last of each key */
	size_t line_count, line_capacity, superseded_count;
	nt_hash_index index;
} nt_record_file;

/* Reads a file, which need not be there. Lines that do not begin with the prefix or are not whole are passed over. With
 * `tidy`, where many lines are superseded, the others are written anew. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY;
 * close it after failure, too. */
nt_status nt_record_file_open(nt_record_file *file, const char *path, const char *prefix,
	bool (*is_whole)(const char *line, size_t length), bool tidy, nt_error *error);
void nt_record_file_close(nt_record_file *file);

/* The last line with a key when the file was read; NULL: none. */
const char *nt_record_file_find(const nt_record_file *file, const char *key, size_t *length);

/* Appends whole lines, each with its line feed, in one piece, even if others append. */
nt_status nt_record_file_append(const nt_record_file *file, const void *lines, size_t size, nt_error *error);

#endif

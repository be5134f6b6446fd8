/* SPDX-License-Identifier: MIT */
/*
 * The file of a record (update.h): a line for each time that an output was made, to which several processes append.
 *
 * A line begins with {"output":" and the output's name, and ends with a hash of what is before: ,"sum":"..."}. One
 * that does not is damaged, or half a line of a process that was killed, and does not count. The last line of an output
 * does.
 */
#ifndef NT_BATCH_RECORD_H
#define NT_BATCH_RECORD_H

#include "base/hash_index.h"
#include "base/text.h"

typedef struct nt_record {
	char *path;
	char *text; /* as it was when it was read, with a NUL behind it */
	size_t size;
	nt_name_table outputs; /* URIs */
	nt_name *lines;        /* the last of each, without its line feed */
	size_t line_capacity, superseded_count;
} nt_record;

/* Reads a file, which need not be there. With `writes`, fails if it cannot be written; if many lines are superseded,
 * the others are written anew. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY; close it after failure, too. */
nt_status nt_record_open(nt_record *record, const char *path, bool writes, nt_error *error);
void nt_record_close(nt_record *record);

/* The line of an output; NULL: none. */
const nt_name *nt_record_find(const nt_record *record, const nt_buffer *output);

/* A line begins so, and goes on with the output's URI. */
#define NT_RECORD_BEGIN "{\"output\":\""

/* Appends what a line ends with. */
void nt_record_end(nt_buffer *line);

/* Appends whole lines in one piece, even if others append. */
nt_status nt_record_append(const nt_record *record, const void *lines, size_t size, nt_error *error);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The inside of this room: the file of a record, and the memory that jobs share.
 */
#ifndef NT_BATCH_INSIDE_H
#define NT_BATCH_INSIDE_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include "base/hash_index.h"
#include "base/text.h"
#include "pipeline/run.h"

/* ---- the file of a record: record.c ---- */

/*
 * A line for each time that an output was made, to which several processes append.
 *
 * A line begins with {"output":" and the output's name, and ends with a hash of what is before: ,"sum":"..."}. One
 * that does not is damaged, or half a line of a process that was killed, and does not count. The last line of an
 * output does.
 */

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

/* ---- a bound of memory that jobs share: gate.c ---- */

/* Each waits until what it needs is free; and a guess of that. */

typedef struct nt_gate {
	uint64_t limit; /* bytes */
	pthread_mutex_t lock; /* of what follows */
	pthread_cond_t changed;
	uint64_t used;
	uint64_t arrived, entered; /* so many: who comes first enters first */
} nt_gate;

/* With a limit of 0, jobs run one at a time. */
void nt_gate_init(nt_gate *gate, uint64_t limit);
void nt_gate_end(nt_gate *gate);

/* Waits until `need` bytes of the limit are free, and takes them. If `need` is above the limit, waits until all is
 * free, takes all and returns true: the job runs alone. */
bool nt_gate_enter(nt_gate *gate, uint64_t need);

/* Gives back what the same need took. */
void nt_gate_leave(nt_gate *gate, uint64_t need);

/* How many bytes a run will probably need, rather more than less, guessed from its input before it runs; UINT64_MAX if
 * that is no regular file; 0 if it cannot be examined, which its run will report. If the size alone shows that the need
 * is at most `enough`, the file is not opened. */
uint64_t nt_need_of(const char *input, const nt_settings *settings, uint64_t enough);

#endif

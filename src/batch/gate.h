/* SPDX-License-Identifier: MIT */
/*
 * A bound of memory that jobs share: each waits until what it needs is free; and a guess of that.
 */
#ifndef NT_BATCH_GATE_H
#define NT_BATCH_GATE_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#include "pipeline/run.h"

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

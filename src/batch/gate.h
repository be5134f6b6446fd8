/* SPDX-License-Identifier: MIT */
/*
 * A bound of memory that jobs share: each waits until what it needs is free.
 */
#ifndef NT_BATCH_GATE_H
#define NT_BATCH_GATE_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

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

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A bound of memory: see gate.h. First come, first served, so that small jobs do not keep a large one waiting for ever.
 */
#include "batch/gate.h"

void nt_gate_init(nt_gate *gate, uint64_t limit)
{
	*gate = (nt_gate){.limit = limit ? limit : 1, .lock = PTHREAD_MUTEX_INITIALIZER,
		.changed = PTHREAD_COND_INITIALIZER};
}

void nt_gate_end(nt_gate *gate)
{
	pthread_cond_destroy(&gate->changed);
	pthread_mutex_destroy(&gate->lock);
}

static uint64_t share_of(const nt_gate *gate, uint64_t need)
{
	return need < gate->limit ? need : gate->limit;
}

bool nt_gate_enter(nt_gate *gate, uint64_t need)
{
	const uint64_t share = share_of(gate, need);
	pthread_mutex_lock(&gate->lock);
	const uint64_t turn = gate->arrived++;
	while (gate->entered != turn || share > gate->limit - gate->used)
		pthread_cond_wait(&gate->changed, &gate->lock);
	gate->entered++;
	gate->used += share;
	pthread_cond_broadcast(&gate->changed); /* the next in turn may fit, too */
	pthread_mutex_unlock(&gate->lock);
	return need > gate->limit;
}

void nt_gate_leave(nt_gate *gate, uint64_t need)
{
	pthread_mutex_lock(&gate->lock);
	gate->used -= share_of(gate, need);
	pthread_cond_broadcast(&gate->changed);
	pthread_mutex_unlock(&gate->lock);
}

/* SPDX-License-Identifier: MIT */
/*
 * How much memory a run will probably need, rather more than less, guessed from its input before it runs.
 */
#ifndef NT_BATCH_NEED_H
#define NT_BATCH_NEED_H

#include <stdint.h>

#include "pipeline/settings.h"

/* In bytes. Of what is no regular file, UINT64_MAX; 0 for what cannot be looked at, as its run will say. Where the size
 * alone shows that it is `enough` at most, nothing is opened. */
uint64_t nt_need_of(const char *input, const nt_settings *settings, uint64_t enough);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * How much memory a run will probably need, rather more than less, guessed from its input before it runs.
 */
#ifndef NT_BATCH_NEED_H
#define NT_BATCH_NEED_H

#include <stdint.h>

#include "pipeline/settings.h"

/* In bytes; UINT64_MAX if the input is no regular file; 0 if it cannot be examined, which its run will report. If the
 * size alone shows that the need is at most `enough`, the file is not opened. */
uint64_t nt_need_of(const char *input, const nt_settings *settings, uint64_t enough);

#endif

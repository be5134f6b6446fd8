/* SPDX-License-Identifier: MIT */
/*
 * How much memory this process may take.
 */
#ifndef NT_BASE_AVAILABLE_H
#define NT_BASE_AVAILABLE_H

#include <stdint.h>

/* Bytes that the system could give without swapping (MemAvailable), but at most what the control groups of this process
 * (memory.max; memory.limit_in_bytes of version 1) and its address space (ulimit -v) are limited to; UINT64_MAX where
 * nothing says. Page cache counts as available, so this is a guess about what others do. */
uint64_t nt_memory_available(void);

/* The part of it that is about control groups: `list` is /proc/self/cgroup, `root` /sys/fs/cgroup. */
uint64_t nt_memory_of_groups(const char *list, const char *root);

#endif

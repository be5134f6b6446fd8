/* SPDX-License-Identifier: MIT */
/*
 * The core's table on real meshes, beside native peers.
 */
#ifndef NT_BENCH_CORE_REAL_H
#define NT_BENCH_CORE_REAL_H

#include <stddef.h>

/*
 * Prints a table in Markdown.
 *
 *   files   [count] PLY files, see models_make()
 *   folder  of the native peers, see native_open()
 */
void core_real_table(char *const *files, size_t count, const char *folder);

#endif

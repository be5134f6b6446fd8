/* SPDX-License-Identifier: MIT */
/*
 * Bytes that were made and wait to be written: large ones in a file without a name, so that they take no memory. All of
 * a spill are in one file. Several threads may add.
 */
#ifndef NT_FILE_SPILL_H
#define NT_FILE_SPILL_H

#include <stdbool.h>
#include <stddef.h>

typedef struct nt_spill nt_spill;

/* Its file is made beside `target` when it is needed; NULL: there is none, all stays in memory. The text stays. NULL:
 * out of memory. */
nt_spill *nt_spill_create(const char *target);
void nt_spill_free(nt_spill *spill); /* NULL is allowed; every block is gone then */

/* Takes a malloc'ed block, and gives the same bytes where they are now: in the file, mapped, or, where they are few or
 * no file can be had, in the block. Until nt_spill_free(). NULL: out of memory, and the block is the caller's. */
const unsigned char *nt_spill_take(nt_spill *spill, unsigned char *bytes, size_t size);

/* Says that a block will hardly be read again: where it is mapped it no longer counts as memory. */
void nt_spill_forget(const nt_spill *spill, const unsigned char *bytes);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Structs of nmtan.h: of another version, and the sums of counts.
 */
#ifndef NT_BASE_STRUCTS_H
#define NT_BASE_STRUCTS_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include "nmtan.h"

/* ---- structs that grow ---- */

/* They begin with their size in bytes, as the caller's compiler saw it. Callers and library may be of different
 * versions; here they meet. */

/* Copies a caller's struct into ours of our_bytes. Members that the caller does not have become zero, which is
 * their default. False where the size is 0, no multiple of sizeof(size_t) or absurd, or where bytes
 * that we do not know are not zero: the caller asks for what we cannot do. */
bool nt_struct_read_other(void *ours, size_t our_bytes, const void *given);

/* The same: nearly all structs have our size. */
static inline bool nt_struct_read(void *ours, size_t our_bytes, const void *given)
{
	size_t bytes;
	memcpy(&bytes, given, sizeof bytes);
	if (bytes != our_bytes)
		return nt_struct_read_other(ours, our_bytes, given);
	memcpy(ours, given, our_bytes);
	return true;
}

/* Copies ours over a struct that nt_struct_read() has accepted, as far as both reach. The caller's size stays. */
void nt_struct_write(void *given, const void *ours, size_t our_bytes);

/* ---- counts ---- */

/* Adds the counts of another solve, or of a part of the same. */
void nt_counts_add(nmtan_counts *sum, const nmtan_counts *part);

/* All corners that were repaired, whatever was wrong with them. */
size_t nt_counts_repaired(const nmtan_counts *counts);

#endif

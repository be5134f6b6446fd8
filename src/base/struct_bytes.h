/* SPDX-License-Identifier: MIT */
/*
 * Structs that grow: nmtan.h's begin with their size in bytes, as the caller's compiler saw it. Callers and
 * library may be of different versions; here they meet.
 */
#ifndef NT_BASE_STRUCT_BYTES_H
#define NT_BASE_STRUCT_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

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

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Structs that grow: see structs.h. The rule is that of Linux's copy_struct_from_user().
 */
#include "base/structs.h"

/* Far more than any struct will ever need: what is larger has not been initialised, and its tail may not be
 * there to be looked at. */
enum { MOST_BYTES = 4096 };

bool nt_struct_read_other(void *ours, size_t our_bytes, const void *given)
{
	size_t bytes;
	memcpy(&bytes, given, sizeof bytes);
	if (bytes == 0 || bytes % sizeof bytes != 0 || bytes > MOST_BYTES)
		return false;
	const char *members = given;
	for (size_t i = our_bytes; i < bytes; i++)
		if (members[i] != 0)
			return false;
	const size_t shared = bytes < our_bytes ? bytes : our_bytes;
	memcpy(ours, given, shared);
	memset((char *)ours + shared, 0, our_bytes - shared);
	memcpy(ours, &our_bytes, sizeof our_bytes);
	return true;
}

void nt_struct_write(void *given, const void *ours, size_t our_bytes)
{
	size_t bytes;
	memcpy(&bytes, given, sizeof bytes);
	const size_t shared = bytes < our_bytes ? bytes : our_bytes;
	memcpy((char *)given + sizeof bytes, (const char *)ours + sizeof bytes, shared - sizeof bytes);
}

/* SPDX-License-Identifier: MIT */
/*
 * Growing bytes: text that is built piece by piece, and small binary blocks. A failed allocation is
 * remembered, so that a long run of appends needs one check at its end.
 */
#ifndef NT_BASE_BUFFER_H
#define NT_BASE_BUFFER_H

#include <string.h>
#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_buffer {
	char *data; /* NULL while empty; a NUL follows the last byte otherwise */
	size_t size;
	size_t capacity;
	bool failed; /* an append ran out of memory; data holds what came before */
} nt_buffer;

void nt_buffer_append(nt_buffer *buffer, const void *bytes, size_t size);

/* Here, so that the length of a literal is known. */
static inline void nt_buffer_text(nt_buffer *buffer, const char *text)
{
	nt_buffer_append(buffer, text, strlen(text));
}

void nt_buffer_format(nt_buffer *buffer, const char *format, ...) NT_PRINTF(2, 3);

/* Appends text that may come from a file. Bytes of what must not reach a terminal (nt_utf8_is_unsafe()) become \x1b. */
void nt_buffer_clean(nt_buffer *buffer, const char *text);

/* Appends `size` bytes and returns where they begin, not cleared; NULL when out of memory. The pointer is
 * valid until the next append. */
void *nt_buffer_extend(nt_buffer *buffer, size_t size);

/* Room for `size` bytes more, so that appending them cannot fail. False when out of memory. */
bool nt_buffer_reserve(nt_buffer *buffer, size_t size);

void nt_buffer_free(nt_buffer *buffer);

/* Frees a buffer whose bytes have gone into another one, which takes over that it failed. */
void nt_buffer_free_into(nt_buffer *buffer, nt_buffer *other);

#ifdef __cplusplus
}
#endif

#endif

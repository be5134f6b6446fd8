/* SPDX-License-Identifier: MIT */
/*
 * A digest of bytes that come piece by piece: XXH3 with 128 bits, as `xxhsum -H2` prints it. It tells files apart
 * that differ by accident or by another run; it is no proof against somebody who wants two files to have the same.
 */
#ifndef NT_EXT_DIGEST_H
#define NT_EXT_DIGEST_H

#include <stddef.h>

typedef struct nt_digest nt_digest;

/* Room for the text of a digest: 32 digits and a NUL. */
enum { NT_DIGEST_TEXT = 33 };

/* A digest of no bytes yet; NULL: out of memory. */
nt_digest *nt_digest_create(void);

/* NULL is allowed. */
void nt_digest_free(nt_digest *digest);

void nt_digest_add(nt_digest *digest, const void *bytes, size_t size);

/* The digest of all bytes so far, as lower-case hexadecimal digits. */
void nt_digest_text(const nt_digest *digest, char text[NT_DIGEST_TEXT]);

#endif

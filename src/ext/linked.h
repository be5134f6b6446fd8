/* SPDX-License-Identifier: MIT */
/*
 * Libraries that are in the program itself, behind C: decimal numbers, digests, Deflate.
 */
#ifndef NT_EXT_LINKED_H
#define NT_EXT_LINKED_H

#include <stddef.h>
#include "base/text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- decimal numbers, by fast_float and the C++ library: number.cpp ---- */

/* They are correctly rounded, and independent of the locale. */

/* Reads a number at [begin, end): optional sign ('+' too), digits, point, exponent, inf, nan. Returns
 * where it ends, NULL when there is no number. Overflow gives infinity, underflow zero. */
const char *nt_read_float(const char *begin, const char *end, float *value);
const char *nt_read_double(const char *begin, const char *end, double *value);

/* Writes the shortest decimal text that reads back as the same float ("nan", "inf" and "-inf" where it
 * is no number), without a final NUL. Returns where it ends; text has room for NT_FLOAT_TEXT - 1 bytes. */
#define NT_FLOAT_TEXT 24
char *nt_write_float(char *text, float value);

/* The same as JSON, of the shortest text of a float and of a double: with a point or an exponent always, 0.8,
 * 1.0, 1e-05, 1.5e+20; and null where it is no number. text has room for NT_NUMBER_TEXT bytes. */
#define NT_NUMBER_TEXT 32
char *nt_write_json_float(char *text, float value);
char *nt_write_json_double(char *text, double value);

/* ---- digests of bytes that come piece by piece, by xxHash ---- */

/* XXH3 with 128 bits, as `xxhsum -H2` prints it. It tells files apart that differ by accident or by another run; it is
 * no proof against somebody who wants two files to have the same. */

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

/* ---- Deflate without a header, by libdeflate ---- */

/* A browser's DecompressionStream("deflate-raw") reads it. */

/* Appends `size` bytes, compressed; out->failed tells of exhausted memory. */
void nt_deflate(const void *bytes, size_t size, nt_buffer *out);

/* ---- which they are ---- */

/* A foreign library that is in the tool itself, and in no module. licences.sh collects their licences, which are
 * installed with it. */
typedef struct nt_linked_library {
	const char *name, *version; /* version NULL: the library does not say */
	const char *licence;        /* an SPDX expression */
} nt_linked_library;

/* All of them, by name. */
const nt_linked_library *nt_linked_libraries(size_t *count);

#ifdef __cplusplus
}
#endif

#endif

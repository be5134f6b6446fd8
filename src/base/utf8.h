/* SPDX-License-Identifier: MIT */
/*
 * Which bytes are UTF-8: names in files may be anything.
 */
#ifndef NT_BASE_UTF8_H
#define NT_BASE_UTF8_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The length of the sequence at the beginning of `text`, 0 where it is none (RFC 3629, table of section 4: no
 * overlong forms, no surrogates, nothing above U+10FFFF). size: of the text, above 0; SIZE_MAX: a NUL ends it. */
size_t nt_utf8_length(const char *text, size_t size);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Which bytes are UTF-8: names in files may be anything.
 */
#ifndef NT_BASE_UTF8_H
#define NT_BASE_UTF8_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The length of the sequence at the beginning of `text`, 0 where it is none (RFC 3629, table of section 4: no
 * overlong forms, no surrogates, nothing above U+10FFFF). size: of the text, above 0; SIZE_MAX: a NUL ends it. */
size_t nt_utf8_length(const char *text, size_t size);

/* Whether the sequence of `length` bytes at `text` must not reach a terminal or a page as it is: controls (C0, DEL,
 * C1), what turns the direction of the text around it (U+202A to U+202E, U+2066 to U+2069), separators of lines
 * (U+2028, U+2029), and U+FFFE and U+FFFF, which XML excludes. length 0, that it is no UTF-8, counts too. */
bool nt_utf8_is_unsafe(const char *text, size_t length);

/* How many bytes of a text, at most `most`, end where a sequence ends; and of one of `length` bytes. */
size_t nt_utf8_cut(const char *text, size_t most);
size_t nt_utf8_cut_of(const char *text, size_t length, size_t most);

/* A text for "%.*s", at most so many bytes of it: a name in a message. It is a macro as it is two arguments. */
#define NT_CUT(most, text) (int)nt_utf8_cut((text), (most)), (text)
#define NT_CUT_OF(most, length, text) (int)nt_utf8_cut_of((text), (length), (most)), (text)

/* Copies a text, or of one without room for all its end, which begins with "..." and where a sequence does. */
void nt_utf8_keep_end(char *to, size_t room, const char *text);

/* As vsnprintf(), but a text without room for all ends where a sequence ends. */
void nt_utf8_format(char *to, size_t room, const char *format, va_list arguments);

/* Puts question marks where it must not, in place; for a signal handler too. */
void nt_utf8_mask(char *text);

#ifdef __cplusplus
}
#endif

#endif

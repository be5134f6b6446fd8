/* SPDX-License-Identifier: MIT */
/*
 * Texts: which bytes are UTF-8, errors with their place, and what is built piece by piece.
 */
#ifndef NT_BASE_TEXT_H
#define NT_BASE_TEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include "nmtan.h"

#ifdef __cplusplus
extern "C" { /* for src/ext */
#endif

/* ---- UTF-8: names in files may be anything ---- */

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

/* ---- errors ---- */

/* One error with its place. The function that finds a fault fills the error, everyone above passes it on untouched, the
 * command line prints it. */

/* Faults of files and command lines, beside what nmtan.h knows of arrays. The compute library returns nmtan_status;
 * what reads, writes or is told by a user returns nt_status, whose first values are those of nmtan_status; the compiler
 * keeps the two apart (-Wenum-conversion). */
typedef enum nt_status {
	NT_OK = NMTAN_OK,
	NT_ERROR_ARGUMENT = NMTAN_ERROR_ARGUMENT,
	NT_ERROR_INDEX = NMTAN_ERROR_INDEX,
	NT_ERROR_FACE_SIZE = NMTAN_ERROR_FACE_SIZE,
	NT_ERROR_TOO_LARGE = NMTAN_ERROR_TOO_LARGE,
	NT_ERROR_MEMORY = NMTAN_ERROR_MEMORY,
	NT_ERROR_CAPACITY = NMTAN_ERROR_CAPACITY,
	/* far above, so that nmtan_status may grow */
	NT_ERROR_USAGE = 64,  /* command line: wrong or contradictory words */
	NT_ERROR_IO,          /* a file cannot be read or written */
	NT_ERROR_MISSING,     /* a file is not there; to users the same as NT_ERROR_IO */
	NT_ERROR_INPUT,       /* a file breaks the rules of its format */
	NT_ERROR_UNSUPPORTED, /* a file is sound but uses something that nmtan does not do */
	NT_ERROR_MODULE,      /* a part of nmtan that is needed is not installed, or not the right one */
	NT_ERROR_LIMIT,       /* more would be needed than the user allows */
	NT_ERROR_INTERNAL     /* our mistake */
} nt_status;

/* The status of a call into the compute library. */
static inline nt_status nt_status_of(nmtan_status status)
{
	return (nt_status)status;
}

/* Static English text for a status, "unknown status" for any other number. Never NULL. */
const char *nt_status_text(nt_status status);

/* A place in an input. Parts that are unknown are zero, NT_NO_OFFSET or empty. */
typedef struct nt_place {
	char file[512];     /* name as the user gave it, or as the input refers to it */
	size_t line;        /* 1-based, text formats */
	uint64_t offset;    /* byte offset in the file, binary formats; NT_NO_OFFSET when unknown */
	char pointer[256];  /* JSON pointer (RFC 6901), glTF */
	char object[256];   /* mesh, primitive and material in words, as in `mesh "head", primitive 2` */
} nt_place;

#define NT_NO_OFFSET UINT64_MAX

/* A place whose texts, "" where unknown, are somewhere else: a place has room for all texts, which a hundred thousand
 * findings do not need. */
typedef struct nt_place_view {
	const char *file, *pointer, *object;
	size_t line;
	uint64_t offset;
} nt_place_view;

typedef struct nt_error {
	nt_status status;
	char message[768]; /* one sentence without a full stop: what was found, what was expected */
	nt_place place;
} nt_error;

#if defined(__GNUC__)
#define NT_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define NT_PRINTF(format_index, first)
#endif

/* Empties an error or a place. */
void nt_error_clear(nt_error *error);
void nt_place_clear(nt_place *place);

/* The texts are the place's own. */
nt_place_view nt_view_place(const nt_place *place);

/* Fills an error: status and message. The place is cleared. Returns status, so that a caller can write
 * `return nt_fail(error, ...)`. error may be NULL. */
nt_status nt_fail(nt_error *error, nt_status status, const char *format, ...) NT_PRINTF(3, 4);

/* The same with the name of a file; error may not be NULL. */
nt_status nt_fail_file(nt_error *error, nt_status status, const char *file, const char *format, ...) NT_PRINTF(4, 5);

/* The same with a line, a byte offset or a JSON pointer. The name of the file is set by the caller that knows
 * it (nt_error_in_file). */
nt_status nt_fail_line(nt_error *error, nt_status status, size_t line, const char *format, ...)
	NT_PRINTF(4, 5);
nt_status nt_fail_offset(nt_error *error, nt_status status, uint64_t offset, const char *format,
	...) NT_PRINTF(4, 5);
nt_status nt_fail_pointer(nt_error *error, nt_status status, const char *pointer,
	const char *format, ...) NT_PRINTF(4, 5);

/* Status NT_ERROR_MEMORY with the usual sentence. */
nt_status nt_fail_memory(nt_error *error);

/* NT_ERROR_LIMIT and the sentence that names --max-memory, under whose limit there was no memory. */
nt_status nt_fail_memory_limit(uint64_t most_bytes, nt_error *error);

/* Names the file of an error, unless a deeper place already did. Returns error->status. */
nt_status nt_error_in_file(nt_error *error, const char *file);

/* The same for an output, where "-" is standard output. */
nt_status nt_error_in_output(nt_error *error, const char *file);

/* ---- buffers ---- */

/* Text that is built piece by piece, and small binary blocks. A failed allocation is remembered, so that a long run of
 * appends needs one check at its end. */

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

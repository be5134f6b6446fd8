/* SPDX-License-Identifier: MIT */
/*
 * One error with its place. The function that finds a fault fills the error, everyone above passes it
 * on untouched, the command line prints it.
 */
#ifndef NT_BASE_ERROR_H
#define NT_BASE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/utf8.h"
#include "nmtan.h"

#ifdef __cplusplus
extern "C" { /* for src/ext */
#endif

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

#ifdef __cplusplus
}
#endif
#endif

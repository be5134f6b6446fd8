/* SPDX-License-Identifier: MIT */
/*
 * Faults of files and command lines, beside what nmtan.h knows of arrays.
 *
 * The compute library returns nmtan_status. Everything that reads, writes or is told by a user returns
 * nt_status, whose first values are those of nmtan_status; the compiler keeps the two apart (-Wenum-conversion).
 */
#ifndef NT_BASE_STATUS_H
#define NT_BASE_STATUS_H

#include "nmtan.h"

#ifdef __cplusplus
extern "C" { /* for src/ext */
#endif

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

#ifdef __cplusplus
}
#endif
#endif

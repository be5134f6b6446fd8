/* SPDX-License-Identifier: MIT */
/*
 * Messages between the driver (sweep.c) and the library that it preloads into the tool (faulty.c), through a
 * file that both map.
 */
#ifndef NT_FAULTY_H
#define NT_FAULTY_H

#include <stdbool.h>
#include <stddef.h>

/* Name of the variable that names the file. */
#define FAULTY_FILE "NT_FAULTY_FILE"

typedef enum faulty_kind {
	FAULTY_MEMORY,
	FAULTY_CALLS,
	FAULTY_SHORTEN /* the n-th system call succeeds, but a file has become empty before it */
} faulty_kind;

typedef struct faulty {
	faulty_kind kind;
	size_t target; /* the number of the call that fails, from 0; SIZE_MAX: none */
	bool onwards;  /* and of all later ones */
	int number;    /* errno, of FAULTY_CALLS */
	char shortened[512]; /* the file, of FAULTY_SHORTEN */
	size_t count;  /* calls seen so far */
	bool fired;
	char name[32]; /* of the function that failed first */
} faulty;

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The foreign libraries that are in the tool itself, and in no module. What their licences say is installed with it:
 * licences.sh.
 */
#ifndef NT_EXT_LINKED_H
#define NT_EXT_LINKED_H

#include <stddef.h>

typedef struct nt_linked_library {
	const char *name, *version; /* version NULL: the library does not say */
	const char *licence;        /* an SPDX expression */
} nt_linked_library;

/* All of them, by name. */
const nt_linked_library *nt_linked_libraries(size_t *count);

#endif

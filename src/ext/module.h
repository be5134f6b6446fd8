/* SPDX-License-Identifier: MIT */
/*
 * Modules: foreign libraries behind tables of functions (tables.h), in shared objects of their own that are opened when
 * an input needs them. A module is looked for in the folder of the running program, then in the folder where it
 * was installed (LIBDIR/nmtan); never in the working folder, nor where the environment says. The system finds the
 * library that it needs. Once open, it stays so.
 *
 * Threads may use all of it at once.
 */
#ifndef NT_EXT_MODULE_H
#define NT_EXT_MODULE_H

#include "base/text.h"

typedef enum nt_module {
	NT_MODULE_DRACO,
	NT_MODULE_MESHOPT,
	NT_MODULE_OPENMESH,
	NT_MODULE_TINYGLTF,
	NT_MODULE_PNG,
	NT_MODULE_TIFF,
	NT_MODULE_WEBP,
	NT_MODULE_COUNT
} nt_module;

/*
 * The table of a module, opened if it is not yet; NULL if that fails, with the status in *status: NT_ERROR_MODULE
 * (it is not there, is of another version, or its library is not there), NT_ERROR_IO or NT_ERROR_MEMORY.
 */
const void *nt_module_open(nt_module module, nt_status *status, nt_error *error);

/* One line about a module: the library behind it and its licence, or why it cannot be opened. */
void nt_module_describe(nt_module module, char *line, size_t size);

/* A foreign library that is in the tool itself, and in no module. licences.sh collects their licences, which are
 * installed with it. */
typedef struct nt_linked_library {
	const char *name, *version; /* version NULL: the library does not say */
	const char *licence;        /* an SPDX expression */
} nt_linked_library;

/* All of them, by name. */
const nt_linked_library *nt_linked_libraries(size_t *count);

#endif

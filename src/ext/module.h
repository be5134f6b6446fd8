/* SPDX-License-Identifier: MIT */
/*
 * Modules: foreign libraries behind tables of functions (tables.h), in shared objects of their own that are opened
 * when an input needs them. A module is looked for in the folder of the running program, then in the folder where it
 * was installed (LIBDIR/nmtan); never in the working folder, nor where the environment says. The system finds the
 * library that it needs. Once open, it stays so.
 *
 * Threads may use all of it at once.
 */
#ifndef NT_EXT_MODULE_H
#define NT_EXT_MODULE_H

#include <stdbool.h>
#include "base/text.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* ---- memory for C++ libraries when malloc has none left: reserve.cpp ---- */

/* They do not fail safely then: destructors (nlohmann's) allocate and end the process, streams lose text, assertions
 * see half-made values. So between nt_reserve_begin() and nt_reserve_end() an allocation that malloc refuses comes from
 * a block that the process has from its start, and it is remembered that it was needed: the caller lets the library
 * come to its end and reports NT_ERROR_MEMORY then. Only when the block is used up is bad_alloc thrown; a part of it is
 * kept for what runs meanwhile. */

/* The program's own, for modules too. */
#define NT_RESERVE __attribute__((visibility("default")))

/* They nest, each within one thread. */
NT_RESERVE void nt_reserve_begin(void);
NT_RESERVE void nt_reserve_end(void);

/* Whether malloc refused anything in this thread since the outermost begin. */
NT_RESERVE bool nt_reserve_was_needed(void);

/* Functions of the C++ library. The program has none until a module brings them. */
typedef struct nt_cxx {
	void (*throw_bad_alloc)(void);
	bool (*is_unwinding)(void);
	void (*on_terminate)(void (*look)(bool of_bad_alloc)); /* calls it before C++ ends the process */
} nt_cxx;

/* For the module that brings one; those of later modules are the same and not needed. */
void nt_reserve_serve(const nt_cxx *cxx);

/* Calls `end`, which must not return and gets no memory, where C++ would abort the process for want of memory: in a
 * destructor or an assertion, after the block was used up. Other aborts stay what they are. */
void nt_on_exhausted(void (*end)(void));

#ifdef __cplusplus
}
#endif

#endif

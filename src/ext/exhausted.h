/* SPDX-License-Identifier: MIT */
/*
 * The end of the process, where a C++ library leaves nothing else: it ran out of memory in a destructor or an
 * assertion, after what reserve.hpp keeps for it was used up.
 */
#ifndef NT_EXT_EXHAUSTED_H
#define NT_EXT_EXHAUSTED_H

#ifdef __cplusplus
extern "C" {
#endif

/* Calls `end`, which must not return and gets no memory, where C++ would abort the process for want of memory. Other
 * aborts stay what they are. */
void nt_on_exhausted(void (*end)(void));

#ifdef __cplusplus
}
#endif
#endif

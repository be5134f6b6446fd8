/* SPDX-License-Identifier: MIT */
/*
 * Damaged files from whole ones: bytes changed, pieces cut out, and numbers and words of the text that a
 * format has (the JSON of glTF, the lines of OBJ, the header of PLY) exchanged for nasty ones. The same
 * seed gives the same damage everywhere.
 */
#ifndef NT_SUPPORT_MUTATE_H
#define NT_SUPPORT_MUTATE_H

#include <stddef.h>
#include <stdint.h>

enum { MUTATE_ROOM = 64 }; /* bytes by which one call can make a file longer */

/* Damages `size` > 0 bytes in a block with room for MUTATE_ROOM more. Returns the new size. */
size_t mutate(char *file, size_t size, uint32_t *seed);

/* A number below `limit`; 0 where that is 0. */
uint32_t mutate_random(uint32_t *seed, uint32_t limit);

#endif

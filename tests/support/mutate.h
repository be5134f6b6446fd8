/* SPDX-License-Identifier: MIT */
/*
 * Damaged files from whole ones. In a JSON document, also of a .glb, mutations exchange numbers, strings and whole
 * values, remove, double, move and add members and elements, and change bytes within data URIs: the result can be
 * parsed if the input could. In any file they change bytes and cut pieces out. The same seed gives the same damage
 * everywhere.
 */
#ifndef NT_SUPPORT_MUTATE_H
#define NT_SUPPORT_MUTATE_H

#include <stddef.h>
#include <stdint.h>

enum { MUTATE_ROOM = 1024 }; /* bytes by which one call of mutate() can make a file longer */

/* Damages `size` > 0 bytes in a block with room for MUTATE_ROOM more. Returns the new size. */
size_t mutate(char *file, size_t size, uint32_t *seed);

/* Changes `size` bytes of JSON in a block of `room` bytes. Returns the new size; 0: this is no JSON, or is too deep. */
size_t mutate_json(char *text, size_t size, size_t room, uint32_t *seed);

/* The same for a .glb: its JSON, or the bytes behind it; the lengths follow. 0: this is no .glb. */
size_t mutate_glb(char *file, size_t size, size_t room, uint32_t *seed);

/* A number below `limit`; 0 where that is 0. */
uint32_t mutate_random(uint32_t *seed, uint32_t limit);

#endif

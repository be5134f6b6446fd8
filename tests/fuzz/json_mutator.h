/* SPDX-License-Identifier: MIT */
/*
 * Other documents from a JSON document: numbers, strings and whole values are exchanged, members and elements removed,
 * doubled, moved and added, bytes within data URIs changed. The result can be parsed if the input could.
 */
#ifndef NT_FUZZ_JSON_MUTATOR_H
#define NT_FUZZ_JSON_MUTATOR_H

#include <stddef.h>
#include <stdint.h>

/* Changes `size` bytes of JSON in a block of `room` bytes. Returns the new size; 0: this is no JSON, or is too deep. */
size_t mutate_json(char *text, size_t size, size_t room, uint32_t *seed);

/* The same for a .glb: its JSON, or the bytes behind it; the lengths follow. 0: this is no .glb. */
size_t mutate_glb(char *file, size_t size, size_t room, uint32_t *seed);

#endif

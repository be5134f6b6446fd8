/* SPDX-License-Identifier: MIT */
/*
 * Images: what is decoded is grey or not as its samples say, and comes back from a PNG of it as it was.
 */
#ifndef NT_FUZZ_IMAGE_H
#define NT_FUZZ_IMAGE_H

#include <stddef.h>
#include <stdint.h>

void fuzz_image(const uint8_t *bytes, size_t size);

/* As libFuzzer does; the check sums of a PNG follow. */
size_t mutate_image(char *bytes, size_t size, size_t room, uint32_t *seed);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * How the work of something grows with its size, whatever the machine and a sanitizer make of each step.
 */
#ifndef NT_TEST_GROWTH_H
#define NT_TEST_GROWTH_H

#include <stdbool.h>
#include <stddef.h>

/* Prepares, does and undoes work of a size; returns the processor's seconds that the work itself took. */
typedef double (*growth_work)(size_t size);

/* Whether eight times the size takes less than 36 times as long: 8 where time is linear, 64 where it is quadratic.
 * Other load only adds to a time, so that the shortest of several counts; it is over as soon as they say yes. */
bool grows_slowly(growth_work work, size_t size);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Shared by programs that measure: time, angles, quantiles. Out of memory they end.
 */
#ifndef NT_MEASURE_H
#define NT_MEASURE_H

#include <stddef.h>
#include <stdio.h>

/* The system's name of the processor. */
const char *measure_processor(void);

/* Seconds of the wall's clock. */
double measure_seconds(void);

/* Seconds that this thread has had a processor: what else the machine does matters less. */
double measure_thread_seconds(void);

/* The angle in degrees between a tangent and an exact direction; 180 where it is none. */
double measure_degrees(const float *tangent, const double *exact);

/* For qsort. */
int measure_compare(const void *a, const void *b);

/* count rows of size bytes, zeroed; never NULL. */
void *measure_room(size_t count, size_t size);

/* A file in a folder. One that cannot be written ends the program, one that cannot be read is NULL. */
FILE *measure_open(const char *folder, const char *name, const char *mode);

/* Values, collected one by one, and what becomes of them: NaN where there are none. */
typedef struct measure_pool {
	double *values;
	size_t count, capacity;
	double median, high, worst; /* high: 99.9 % */
} measure_pool;

void measure_pool_add(measure_pool *pool, double value);

/* Fills in the quantiles and forgets the values. */
void measure_pool_finish(measure_pool *pool);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Tangents as a view holds them to which meshoptimizer's filters are applied: see tangent_filter.c.
 */
#ifndef NT_GLTF_TANGENT_FILTER_H
#define NT_GLTF_TANGENT_FILTER_H

#include "gltf/quantize.h"

/* Filters of numbers on their way into a view. */
typedef struct nt_tangent_filter {
	nt_precision precision;
	const char *filter; /* NONE; of integers OCTAHEDRAL, of floats EXPONENTIAL; NULL: NONE, too */
	int bits;           /* of a component before the filter: 2 to 8 of bytes, to 16 of shorts, to 23 of floats */
} nt_tangent_filter;

/*
 * Rounds tangents to what the integers or the filter can say, as nt_precision_round() does; afterwards they hold what a
 * reader will decode. w is +-1 exactly.
 *
 *   tangents  [count][4]
 *   stored  [count * nt_precision_bytes()], what the filter will be applied to
 *   values  the same size, what it gives; may be `stored` where there is none
 *   cost  may be NULL
 *
 * Returns NT_OK or what opening the module of meshoptimizer gives.
 */
nt_status nt_tangents_store(const nt_tangent_filter *filter, float *tangents, size_t count, unsigned char *stored,
	unsigned char *values, nt_rounding *cost, nt_error *error);

/* By how much storing may change a component: nt_morph_least(). */
float nt_tangent_filter_least(const nt_tangent_filter *filter);

/* The bits that elements before a filter have, 0: none that make sense. elements: [count], `stride` bytes apart, each
 * of `components` numbers of a type. */
int nt_filter_bits(const char *filter, const unsigned char *elements, size_t count, size_t stride, int component_type,
	unsigned components);

#endif

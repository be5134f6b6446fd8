/* SPDX-License-Identifier: MIT */
/*
 * The fast path's data of a welded vertex: the sum over its corners of one orientation, and bits that say
 * whether that sum is what the groups of the definition would give.
 */
#ifndef NT_TANGENT_FAST_RECORD_H
#define NT_TANGENT_FAST_RECORD_H

#include <stdint.h>
#include <string.h>
#include "tangent/solve.h"

/* Sum over the corners of one orientation at a vertex; later its result. `state` is a set of bits that
 * each corner may only clear: what is left holds for all of them. */
typedef struct nt_record {
	float x, y, z;
	uint32_t state;
} nt_record;

/* The sums behind the optional outputs. */
typedef struct nt_record_more {
	float x, y, z, angle; /* bitangent; sum of the weights */
	float mag_s, mag_t;
	float unused[2];
} nt_record_more;

/* Bits of nt_record.state while it is a sum. All states carry NT_STATE_BASE, which makes them normal
 * floats: the lane takes part in the addition of its record, and a denormal may cost 100 cycles. */
enum {
	NT_STATE_SOUND = 1 << 0,    /* every value met was well inside float's range */
	NT_STATE_EMPTY = 1 << 1,    /* no corner was added */
	NT_STATE_NO_ANY = 1 << 2,   /* no triangle without a frame touches the vertex */
	NT_STATE_LOCAL = 1 << 3,    /* the order in which groups are seeded does not matter */
	NT_STATE_U = 0xf300,        /* one bit for each half-space that all u directions lie in; zero lies in all */
	NT_STATE_V = 0x0cf0,        /* the same for v; which is which, state_of() in lanes.h knows */
	NT_STATE_ALL = 0xffff,
	NT_STATE_BASE = 0x40000000
};

/* nt_record.state when settled: the sign as a float, or one of these. */
#define NT_RESULT_PLUS 0x3f800000u    /* 1.0f */
#define NT_RESULT_MINUS 0xbf800000u   /* -1.0f */
#define NT_RESULT_NONE 0u             /* no corner has this orientation */
#define NT_RESULT_COMPLEX 0x40000000u /* ask complex.c; no other state has this bit */

/* Beside a sign, where the solve repairs: the record is the result, but tangent/usable.c would not accept it, or not
 * that of the vertex's other orientation. */
#define NT_RESULT_UNUSABLE NT_W_OPEN

/* Beside NT_RESULT_COMPLEX: the sums have nothing extreme and do not split, so that an orientation with one group has
 * the record as its result; and that is not unusable, where the solve repairs. */
#define NT_RESULT_SUM 0x20000000u

/* Beside it: a hub, or an edge at the vertex occurs twice in one direction, so that pairs depend on order. */
#define NT_RESULT_TANGLED 0x10000000u

/* Beside it, in the lowest bits: how many corners the vertex has, a hub those of degenerate triangles too; where
 * complex.c has seen the vertex, NT_RESULT_PLACED and the place of its next corner. */
#define NT_RESULT_PLACED 0x80000000u
#define NT_RESULT_NUMBER (((uint32_t)1 << 28) - 1)

/* The words of a record on their way: loaded and stored at once, if the compiler has vectors. */
#if NT_VECTORS
typedef float nt_float4 __attribute__((vector_size(16)));
typedef int nt_int4 __attribute__((vector_size(16)));

static inline nt_int4 nt_and4(nt_int4 a, nt_int4 b)
{
	return a & b;
}

static inline nt_int4 nt_or4(nt_int4 a, nt_int4 b)
{
	return a | b;
}

static inline uint32_t nt_state4(nt_int4 a)
{
	return (uint32_t)a[3];
}

/* Adds the sum, and keeps the bits of the state that both have. */
static inline void nt_record_add(nt_record *record, nt_int4 add)
{
	nt_float4 old;
	memcpy(&old, record, sizeof old);
	const nt_int4 sum = (nt_int4)(old + (nt_float4)add), both = (nt_int4)old & add;
	const nt_int4 result = __builtin_shufflevector(sum, both, 0, 1, 2, 7);
	memcpy(record, &result, sizeof result);
}
#else
typedef struct nt_int4 {
	int32_t x, y, z, state;
} nt_int4;

static inline nt_int4 nt_and4(nt_int4 a, nt_int4 b)
{
	return (nt_int4){a.x & b.x, a.y & b.y, a.z & b.z, a.state & b.state};
}

static inline nt_int4 nt_or4(nt_int4 a, nt_int4 b)
{
	return (nt_int4){a.x | b.x, a.y | b.y, a.z | b.z, a.state | b.state};
}

static inline uint32_t nt_state4(nt_int4 a)
{
	return (uint32_t)a.state;
}

static inline void nt_record_add(nt_record *record, nt_int4 add)
{
	nt_record sum;
	memcpy(&sum, &add, sizeof sum);
	record->x += sum.x, record->y += sum.y, record->z += sum.z;
	record->state &= sum.state;
}
#endif

static inline void nt_record_more_add(nt_record_more *record, const nt_record_more *add)
{
	enum { FLOATS = sizeof *record / sizeof(float) };
	float sum[FLOATS], more[FLOATS];
	memcpy(sum, record, sizeof sum);
	memcpy(more, add, sizeof more);
	for (int i = 0; i < FLOATS; i++)
		sum[i] += more[i];
	memcpy(record, sum, sizeof sum);
}

#endif

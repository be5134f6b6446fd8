/* SPDX-License-Identifier: MIT */
/*
 * What sums.c and its passes for one instruction set (sums_kernel.h) share.
 */
#ifndef NT_TANGENT_SUMS_H
#define NT_TANGENT_SUMS_H

#include <stdint.h>
#include "tangent/frames.h"

enum { NT_SUM_LANES = 16 };

/* 16 triangles by component. */
typedef struct nt_sum_block {
	/* in: corner, then position (0 to 2), unit or zero normal (3 to 5), texture coordinates (6, 7) */
	double row[3][8][NT_SUM_LANES];
	/* out: corner, then what is added to nt_frame_sum: u (0 to 2), weights (3), sensitivity (4) */
	double add[3][5][NT_SUM_LANES];
	int64_t sign[NT_SUM_LANES]; /* exact orientation; only where not hard */
	int64_t plain[NT_SUM_LANES]; /* not hard, has area in space, and weight at each corner */
	int64_t hard[NT_SUM_LANES]; /* nothing is known: nt_add_triangle() must do it */
} nt_sum_block;

/* Fills `add`, `sign` and `hard` of a block with the values that nt_add_triangle() gives, bit for bit. */
typedef struct nt_sum_kernels {
	void (*angle)(nt_sum_block *block);
	void (*area)(nt_sum_block *block);
} nt_sum_kernels;

extern const nt_sum_kernels nt_sum_kernels_baseline;
#if defined(__x86_64__)
extern const nt_sum_kernels nt_sum_kernels_avx2, nt_sum_kernels_avx512;
#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The passes of kernel.h and sums_kernel.h for AVX2, without FMA, whose single rounding would change bytes.
 * The Makefile has this file's flags.
 */
#if defined(__x86_64__)
#define NT_KERNEL nt_kernels_avx2
#include "tangent/kernel.h"
#define NT_SUM_KERNEL nt_sum_kernels_avx2
#include "tangent/sums_kernel.h"
#endif

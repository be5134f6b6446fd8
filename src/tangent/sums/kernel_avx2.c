/* SPDX-License-Identifier: MIT */
/*
 * The passes of kernel.h for AVX2. FMA is used where fma() stands in the source, and nowhere else:
 * contraction would change bytes. The Makefile has this file's flags.
 */
#if defined(__x86_64__)
#define NT_SUM_KERNEL nt_sum_kernels_avx2
#include "tangent/sums/kernel.h"
#endif

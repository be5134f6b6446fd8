/* SPDX-License-Identifier: MIT */
/*
 * The passes of kernel.h for what the compiler assumes of every processor: SSE2 on x86-64, NEON on aarch64.
 * The Makefile has this file's flags.
 */
#define NT_SUM_KERNEL nt_sum_kernels_baseline
#include "tangent/sums/kernel.h"

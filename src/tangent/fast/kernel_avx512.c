/* SPDX-License-Identifier: MIT */
/*
 * The passes of kernel.h for AVX-512 F, BW, DQ and VL, in 512-bit vectors.
 * The Makefile has this file's flags.
 */
#if defined(__x86_64__)
#define NT_KERNEL nt_kernels_avx512
#include "tangent/fast/kernel.h"
#endif

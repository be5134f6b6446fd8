/* SPDX-License-Identifier: MIT */
/*
 * The passes of kernel.h for what the compiler assumes of every processor: SSE2 on x86-64, NEON on aarch64.
 * The Makefile has this file's flags.
 */
#define NT_KERNEL nt_kernels_baseline
#include "tangent/fast/kernel.h"

/* SPDX-License-Identifier: MIT */
/*
 * Which instruction sets this processor has. The only place that asks.
 */
#ifndef NT_BASE_CPU_H
#define NT_BASE_CPU_H

#include <stdbool.h>

/* The sets that kernels are compiled for, each in a file of its own. */
typedef enum nt_isa {
	NT_ISA_AUTO = 0, /* the best that the processor has */
	NT_ISA_BASELINE, /* what the compiler assumes: SSE2 on x86-64, NEON on aarch64 */
	NT_ISA_AVX2,
	NT_ISA_AVX512
} nt_isa;

/* Whether this processor and build can run kernels for that set. AUTO and BASELINE: always. */
bool nt_cpu_has(nt_isa isa);

/* The best set this processor can run: never AUTO. */
nt_isa nt_cpu_best(void);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Which instruction sets this processor has, and which kernels it therefore gets. The only place that asks.
 *
 *   AVX-512   F, BW, DQ and VL, which every AVX-512 processor since 2017 has together, and FMA
 *   AVX2      with FMA: every processor of x86-64-v3. FMA is used by name only; contraction would change bytes
 *   baseline  what the compiler assumes of every processor: SSE2 on x86-64, NEON on aarch64
 */
#ifndef NT_BASE_CPU_H
#define NT_BASE_CPU_H

#include <stdbool.h>

/* The sets that kernels are compiled for, each in a file of its own. */
typedef enum nt_isa {
	NT_ISA_AUTO = 0, /* the best that the processor has */
	NT_ISA_BASELINE,
	NT_ISA_AVX2,
	NT_ISA_AVX512
} nt_isa;

/* Whether this processor and build can run kernels for that set. AUTO and BASELINE: always. */
bool nt_cpu_has(nt_isa isa);

/* The best set this processor can run: never AUTO. */
nt_isa nt_cpu_best(void);

/* The address of the table of functions for a set (never AUTO), where TABLE_baseline, TABLE_avx2 and TABLE_avx512
 * are one for each. A macro because tables of several types have such names. */
#if defined(__x86_64__) && !defined(NT_ONE_SET) && defined(NT_NO_AVX512)
#define NT_CPU_TABLE(isa, table) ((isa) == NT_ISA_AVX2 ? &table##_avx2 : &table##_baseline)
#elif defined(__x86_64__) && !defined(NT_ONE_SET)
#define NT_CPU_TABLE(isa, table) \
	((isa) == NT_ISA_AVX512 ? &table##_avx512 : (isa) == NT_ISA_AVX2 ? &table##_avx2 : &table##_baseline)
#else
#define NT_CPU_TABLE(isa, table) ((void)(isa), &table##_baseline)
#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Instruction sets: see cpu.h.
 */
#include "base/cpu.h"

#include "base/compiler.h"

#if defined(__x86_64__)
#include <cpuid.h>

/* FMA, all of `wanted` in leaf 7, and a system that keeps the registers of `saved`. With OSXSAVE there is leaf 7.
 * The compiler's own way asks a dozen times before main(), needed or not, at 10 us each on a virtual machine; that of
 * glibc is in no other library. */
static bool has(unsigned wanted, unsigned saved)
{
	unsigned a, b, c, d;
	__cpuid(1, a, b, c, d);
	if (~c & (bit_FMA | bit_OSXSAVE))
		return false;
	__asm__ volatile("xgetbv" : "=a"(a), "=d"(d) : "c"(0));
	if (~a & saved)
		return false;
	__cpuid_count(7, 0, a, b, c, d);
	return !(~b & wanted);
}
#endif

/* Asked once: on a virtual machine each question takes some microseconds. Threads that ask at the same time find the
 * same. */
nt_isa nt_cpu_best(void)
{
	static nt_isa found = NT_ISA_AUTO;
	nt_isa best = nt_atomic_load(&found, RELAXED);
	if (best != NT_ISA_AUTO)
		return best;
	best = NT_ISA_BASELINE;
#if defined(__x86_64__)
	if (has(bit_AVX2, 0x6))
		best = NT_ISA_AVX2;
#ifndef NT_NO_AVX512
	if (best == NT_ISA_AVX2 && has(bit_AVX512F | bit_AVX512BW | bit_AVX512DQ | bit_AVX512VL, 0xe6))
		best = NT_ISA_AVX512;
#endif
#endif
	nt_atomic_store(&found, best, RELAXED);
	return best;
}

/* Each set has those before it. */
bool nt_cpu_has(nt_isa isa)
{
	return isa <= nt_cpu_best();
}

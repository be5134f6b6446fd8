/* SPDX-License-Identifier: MIT */
/*
 * Instruction sets: see cpu.h.
 */
#include "base/cpu.h"

#include "base/compiler.h"

/* glibc (2.33) tells what its loader has asked the processor already. Asking once more costs 10 us an instruction on a
 * virtual machine, and the compiler's way asks a dozen times before main(), needed or not. */
#if defined(__x86_64__) && !defined(__cplusplus) && __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>

/* As CPU_FEATURE_ACTIVE(), which shifts a signed 1 by 31 places for AVX512VL: a leaf has four registers. */
static bool is_active(unsigned feature)
{
	return __x86_get_cpuid_feature_leaf(feature / 128)->active_array[feature / 32 % 4] >> feature % 32 & 1;
}

#define HAS(feature, name) is_active(x86_cpu_##feature)
#elif defined(__x86_64__)
#define HAS(feature, name) (__builtin_cpu_supports(name) != 0)
#endif

bool nt_cpu_has(nt_isa isa)
{
	switch (isa) {
	case NT_ISA_AUTO:
	case NT_ISA_BASELINE:
		return true;
#if defined(__x86_64__)
	case NT_ISA_AVX2:
		return HAS(AVX2, "avx2") && HAS(FMA, "fma");
	case NT_ISA_AVX512:
		return HAS(AVX512F, "avx512f") && HAS(FMA, "fma") && HAS(AVX512BW, "avx512bw") &&
		       HAS(AVX512DQ, "avx512dq") && HAS(AVX512VL, "avx512vl");
#else
	case NT_ISA_AVX2:
	case NT_ISA_AVX512:
		return false;
#endif
	}
	return false;
}

/* Asked once: that is five calls of another library. Threads that ask at the same time find the same. */
nt_isa nt_cpu_best(void)
{
	static nt_isa found = NT_ISA_AUTO;
	nt_isa best = nt_atomic_load(&found, RELAXED);
	if (best != NT_ISA_AUTO)
		return best;
	best = nt_cpu_has(NT_ISA_AVX512) ? NT_ISA_AVX512 : nt_cpu_has(NT_ISA_AVX2) ? NT_ISA_AVX2 : NT_ISA_BASELINE;
	nt_atomic_store(&found, best, RELAXED);
	return best;
}

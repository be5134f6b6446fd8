/* SPDX-License-Identifier: MIT */
/*
 * Instruction sets: see cpu.h.
 */
#include "base/cpu.h"

bool nt_cpu_has(nt_isa isa)
{
	switch (isa) {
	case NT_ISA_AUTO:
	case NT_ISA_BASELINE:
		return true;
#if defined(__x86_64__)
	case NT_ISA_AVX2:
		return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
	case NT_ISA_AVX512:
		return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx512bw") &&
		       __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
	case NT_ISA_AVX2:
	case NT_ISA_AVX512:
		return false;
#endif
	}
	return false;
}

nt_isa nt_cpu_best(void)
{
	if (nt_cpu_has(NT_ISA_AVX512))
		return NT_ISA_AVX512;
	return nt_cpu_has(NT_ISA_AVX2) ? NT_ISA_AVX2 : NT_ISA_BASELINE;
}

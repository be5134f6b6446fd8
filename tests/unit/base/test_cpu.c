/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "base/cpu.h"

/* Whether Linux names all of them among the flags of the first processor; each with a space on both sides. */
static bool linux_names(const char *const *flags)
{
	char line[8192] = "";
	FILE *f = fopen("/proc/cpuinfo", "r");
	while (f && fgets(line, sizeof line, f) && strncmp(line, "flags", 5) != 0)
		;
	if (f)
		fclose(f);
	for (char *c = line; *c; c++)
		*c = *c == '\n' ? ' ' : *c;
	bool all = true;
	for (size_t i = 0; flags[i]; i++)
		all &= strstr(line, flags[i]) != NULL;
	return all;
}

/* A set that is not told is not used, and nothing but the time would show it. */
TEST(the_kernel_says_the_same)
{
	static const char *const avx2[] = {" avx2 ", " fma ", NULL};
	static const char *const avx512[] = {" avx512f ", " avx512bw ", " avx512dq ", " avx512vl ", " fma ", NULL};
	assert_true(nt_cpu_has(NT_ISA_AUTO) && nt_cpu_has(NT_ISA_BASELINE));
	assert_int_equal(nt_cpu_has(NT_ISA_AVX2), linux_names(avx2));
	assert_int_equal(nt_cpu_has(NT_ISA_AVX512), linux_names(avx512));
	assert_int_equal(nt_cpu_best(),
		linux_names(avx512) ? NT_ISA_AVX512 : linux_names(avx2) ? NT_ISA_AVX2 : NT_ISA_BASELINE);
}

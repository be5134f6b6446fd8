/* SPDX-License-Identifier: MIT */
/*
 * Which instruction sets this processor has. The only place that asks.
 */
#ifndef NT_BASE_CPU_H
#define NT_BASE_CPU_H

#include <stdbool.h>
#include "nmtan.h"

/* Whether this processor and build can run kernels for that set. AUTO and BASELINE: always. */
bool nt_cpu_has(nmtan_isa isa);

/* The best set this processor can run: never AUTO. */
nmtan_isa nt_cpu_best(void);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The methods that are sums of frames in double: see sums.c. They return NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
#ifndef NT_TANGENT_SUMS_SUMS_H
#define NT_TANGENT_SUMS_SUMS_H

#include "tangent/solve.h"

nmtan_status nt_lengyel(const nt_solve *solve);
nmtan_status nt_area(const nt_solve *solve);

/* ill_conditioned receives how many corners have lost more than 24 bits, see nmtan_counts. */
nmtan_status nt_robust(const nt_solve *solve, size_t *ill_conditioned);

#endif

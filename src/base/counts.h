/* SPDX-License-Identifier: MIT */
/*
 * Sums over what solves count.
 */
#ifndef NT_BASE_COUNTS_H
#define NT_BASE_COUNTS_H

#include "nmtan.h"

/* Adds the counts of another solve, or of a part of the same. */
void nt_counts_add(nmtan_counts *sum, const nmtan_counts *part);

/* All corners that were repaired, whatever was wrong with them. */
size_t nt_counts_repaired(const nmtan_counts *counts);

#endif

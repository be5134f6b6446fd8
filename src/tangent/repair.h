/* SPDX-License-Identifier: MIT */
/*
 * Repair: what a method leaves unusable becomes usable.
 */
#ifndef NT_TANGENT_REPAIR_H
#define NT_TANGENT_REPAIR_H

#include "tangent/solve.h"

/*
 * Checks every corner tangent of a solve (usable.h) and counts what the mesh is like; replaces the unusable ones where
 * the solve repairs. Rows that the solve left out (nt_known.ids) stay out.
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_repair(const nt_solve *solve, nmtan_counts *counts);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Repair: what a method leaves unusable becomes usable.
 */
#ifndef NT_TANGENT_REPAIR_H
#define NT_TANGENT_REPAIR_H

#include "tangent/solve.h"

/*
 * Judges every corner tangent of a solve (judge.h) and counts what the mesh is like; with `repair` replaces
 * the unusable ones.
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_repair(const nt_solve *solve, bool repair, nmtan_counts *counts);

#endif

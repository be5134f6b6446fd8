/* SPDX-License-Identifier: MIT */
/*
 * Repair: what a method leaves unusable becomes usable.
 */
#ifndef NT_TANGENT_REPAIR_H
#define NT_TANGENT_REPAIR_H

#include "tangent/solve.h"

/*
 * Judges every corner tangent of a solve and counts what the mesh is like; with `repair` replaces the
 * unusable ones. A tangent is usable when it is finite, of unit length, not parallel to its normal, and
 * its w is the exact orientation of its face and the same on all the face's corners.
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_repair(const nt_solve *solve, bool repair, nmtan_counts *counts);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The passes that need lanes, as plain loops over 16 of them. kernel_*.c include this file once for
 * each instruction set, with NT_KERNEL naming the table of its passes.
 */
#include "tangent/fast/accumulate.h"
#include "tangent/fast/corners.h"
#include "tangent/fast/part_lanes.h"
#include "tangent/fast/settle.h"

const nt_kernels NT_KERNEL = {accumulate, settle, corners, NT_FAST_PATHS ? corner_sums : NULL,
	NT_FAST_PATHS ? part_sums : NULL, NT_FAST_PATHS ? group_results : NULL};

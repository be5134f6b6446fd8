/* SPDX-License-Identifier: MIT */
/*
 * The passes that need lanes, as plain loops over 16 of them. kernel_*.c include this file once for
 * each instruction set, with NT_KERNEL naming the table of its passes.
 */
#include "tangent/fast/accumulate.h"
#include "tangent/fast/corners.h"
#include "tangent/fast/settle.h"

const nt_kernels NT_KERNEL = {kernel_accumulate, kernel_settle, kernel_corners};

/* SPDX-License-Identifier: MIT */
/*
 * The three passes that need lanes, as plain loops over 16 of them. kernel_*.c include this file once for
 * each instruction set, with NT_KERNEL naming the table of its passes.
 */
#include "tangent/kernel_accumulate.h"
#include "tangent/kernel_corners.h"
#include "tangent/kernel_settle.h"

const nt_kernels NT_KERNEL = {accumulate, settle, corners};

/* SPDX-License-Identifier: MIT */
/*
 * See deadline.h.
 */
#include "base/deadline.h"

_Thread_local const nt_deadline *nt_own_deadline;

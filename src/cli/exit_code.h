/* SPDX-License-Identifier: MIT */
/*
 * Exit codes: what a script can tell from a run. Part of the tool's interface; see nmtan.1.
 */
#ifndef NT_CLI_EXIT_CODE_H
#define NT_CLI_EXIT_CODE_H

#include "base/status.h"

enum nt_exit {
	NT_EXIT_DONE = 0,
	NT_EXIT_USAGE = 1,
	NT_EXIT_IO = 2,
	NT_EXIT_INPUT = 3,
	NT_EXIT_INTERNAL = 4, /* out of memory too */
	NT_EXIT_UNSUPPORTED = 5,
	NT_EXIT_FINDINGS = 6
};

/* The exit code of a status. */
int nt_exit_code(nt_status status);

/* Of two exit codes the worse one, in the order 4, 2, 3, 5, 1, 6, 0. */
int nt_exit_worse(int a, int b);

#endif

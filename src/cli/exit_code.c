/* SPDX-License-Identifier: MIT */
/*
 * Exit codes: see exit_code.h.
 */
#include "cli/exit_code.h"

int nt_exit_code(nt_status status)
{
	switch (status) {
	case NT_OK:
		return NT_EXIT_DONE;
	case NT_ERROR_USAGE:
		return NT_EXIT_USAGE;
	case NT_ERROR_IO:
	case NT_ERROR_MISSING:
		return NT_EXIT_IO;
	case NT_ERROR_INPUT:
		return NT_EXIT_INPUT;
	case NT_ERROR_UNSUPPORTED:
	case NT_ERROR_MODULE:
	case NT_ERROR_TOO_LARGE:
		return NT_EXIT_UNSUPPORTED;
	default:
		/* What the compute API refuses, a reader should have refused before: our mistake. */
		return NT_EXIT_INTERNAL;
	}
}

int nt_exit_worse(int a, int b)
{
	static const int worst_first[] = {NT_EXIT_INTERNAL, NT_EXIT_IO, NT_EXIT_INPUT,
		NT_EXIT_UNSUPPORTED, NT_EXIT_USAGE, NT_EXIT_FINDINGS};
	for (unsigned i = 0; i < sizeof worst_first / sizeof *worst_first; i++)
		if (a == worst_first[i] || b == worst_first[i])
			return worst_first[i];
	return NT_EXIT_DONE;
}

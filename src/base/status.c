/* SPDX-License-Identifier: MIT */
/*
 * The words for a status of the tool.
 */
#include "base/text.h"

const char *nt_status_text(nt_status status)
{
	switch (status) {
	case NT_ERROR_USAGE:
		return "wrong usage";
	case NT_ERROR_IO:
		return "cannot read or write";
	case NT_ERROR_MISSING:
		return "no such file";
	case NT_ERROR_INPUT:
		return "invalid input";
	case NT_ERROR_UNSUPPORTED:
		return "unsupported input";
	case NT_ERROR_MODULE:
		return "a module is missing";
	case NT_ERROR_LIMIT:
		return "a limit is reached";
	case NT_ERROR_INTERNAL:
		return "internal error";
	default:
		return nmtan_status_text((nmtan_status)status);
	}
}

/* SPDX-License-Identifier: MIT */
/*
 * The words for a status, and the version: the part of nmtan.h that computes nothing.
 */
#include "base/status.h"

const char *nmtan_status_text(nmtan_status status)
{
	switch (status) {
	case NMTAN_OK:
		return "ok";
	case NMTAN_ERROR_ARGUMENT:
		return "invalid argument";
	case NMTAN_ERROR_INDEX:
		return "index out of range";
	case NMTAN_ERROR_FACE_SIZE:
		return "face with neither 3 nor 4 corners";
	case NMTAN_ERROR_TOO_LARGE:
		return "mesh too large";
	case NMTAN_ERROR_MEMORY:
		return "out of memory";
	}
	return "unknown status";
}

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

const char *nmtan_version(void)
{
	return NMTAN_VERSION_STRING;
}

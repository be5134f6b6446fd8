/* SPDX-License-Identifier: MIT */
/*
 * The words for a status, and the version: the part of nmtan.h that computes nothing.
 */
#include "nmtan.h"

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
	case NMTAN_ERROR_CAPACITY:
		return "no room for the copies of vertices";
	}
	return "unknown status";
}

const char *nmtan_version(void)
{
	return NMTAN_VERSION_STRING;
}

/* SPDX-License-Identifier: MIT */
/*
 * The part of nmtan.h that computes nothing: the words for a status, the version, structs that grow, sums of counts.
 */
#include "base/structs.h"

#include "nmtan.h"

/* ---- words ---- */

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

/* ---- structs that grow ---- */

/* The rule is that of Linux's copy_struct_from_user(). */

/* Far more than any struct will ever need: what is larger has not been initialised, and its tail may not be
 * there to be looked at. */
enum { MOST_BYTES = 4096 };

bool nt_struct_read_other(void *ours, size_t our_bytes, const void *given)
{
	size_t bytes;
	memcpy(&bytes, given, sizeof bytes);
	if (bytes == 0 || bytes % sizeof bytes != 0 || bytes > MOST_BYTES)
		return false;
	const char *members = given;
	for (size_t i = our_bytes; i < bytes; i++)
		if (members[i] != 0)
			return false;
	const size_t shared = bytes < our_bytes ? bytes : our_bytes;
	memcpy(ours, given, shared);
	memset((char *)ours + shared, 0, our_bytes - shared);
	memcpy(ours, &our_bytes, sizeof our_bytes);
	return true;
}

void nt_struct_write(void *given, const void *ours, size_t our_bytes)
{
	size_t bytes;
	memcpy(&bytes, given, sizeof bytes);
	const size_t shared = bytes < our_bytes ? bytes : our_bytes;
	memcpy((char *)given + sizeof bytes, (const char *)ours + sizeof bytes, shared - sizeof bytes);
}

/* ---- counts: the one place outside of nmtan.h that lists them ---- */

void nt_counts_add(nmtan_counts *sum, const nmtan_counts *part)
{
	sum->degenerate_positions += part->degenerate_positions;
	sum->degenerate_texcoords += part->degenerate_texcoords;
	sum->mirrored += part->mirrored;
	sum->stored_differently += part->stored_differently;
	sum->folded_quads += part->folded_quads;
	sum->repaired_zero += part->repaired_zero;
	sum->repaired_not_finite += part->repaired_not_finite;
	sum->repaired_parallel += part->repaired_parallel;
	sum->repaired_sign += part->repaired_sign;
	sum->repaired_unassigned += part->repaired_unassigned;
	sum->repaired_leaning += part->repaired_leaning;
	sum->ill_conditioned += part->ill_conditioned;
	sum->sorted_instead += part->sorted_instead;
	sum->summed_instead += part->summed_instead;
	sum->normals_not_unit += part->normals_not_unit;
}

size_t nt_counts_repaired(const nmtan_counts *counts)
{
	return counts->repaired_zero + counts->repaired_not_finite + counts->repaired_parallel +
	       counts->repaired_sign + counts->repaired_unassigned + counts->repaired_leaning;
}

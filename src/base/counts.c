/* SPDX-License-Identifier: MIT */
/*
 * See structs.h: the one place outside of nmtan.h that lists what is counted.
 */
#include "base/structs.h"

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

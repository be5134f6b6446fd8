/* SPDX-License-Identifier: MIT */
/*
 * The passes of tiny.c that need lanes. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_FEW_LANES_H
#define NT_TANGENT_FAST_FEW_LANES_H

#include "tangent/fast/accumulate.h"
#include "tangent/fast/settle.h"

/* Frames as accumulate() makes them: flags, and what each corner adds, in order. */
static void few_frames(const nt_fast *fast, nt_record *add)
{
	lanes_in in;
	lanes_out out;
	const float offset = nt_stored_v_offset(fast->solve->mesh);
	for (size_t first = 0, count; first < fast->triangle_count; first += count) {
		const size_t left = fast->triangle_count - first;
		count = left < NT_LANES ? left : NT_LANES;
		gather_lanes(fast->rows, fast->triangles.ids + 3 * first, count, lanes_of(count), in.row);
		solve_few(&in, &out, offset, count);
		const bool ordinary = classify_lanes(fast, first, count, &in, &out);
		for (size_t i = 0; i < count; i++)
			for (size_t k = 0; k < 3; k++)
				memcpy(&add[3 * (first + i) + k], out.add[k] + 4 * turned_place(i), sizeof *add);
		for (size_t i = 0; !ordinary && i < count; i++)
			for (size_t k = 0; k < 3 && !out.sound[i]; k++)
				add[3 * (first + i) + k].state = NT_STATE_BASE;
	}
}

/* Results of groups from their sums. A group that is not its sum gets the state NT_RESULT_COMPLEX; one that may not be
 * usable, NT_TRIANGLE_COMPLEX in `orients`. Both arrays have room for whole vectors. */
static void few_results(const nt_fast *fast, const uint32_t *vertices, size_t count, nt_record *results, uint8_t *orients)
{
	for (size_t first = 0; first < count; first += NT_LANES) {
		const size_t left = count - first, used = whole_lanes(left < NT_LANES ? left : NT_LANES);
		record_lanes r;
		float normals[3][NT_LANES];
		uint32_t unusable[NT_LANES] = {0};
		load_records(results + first, used, &r);
		normalise_records(used, &r);
		memset(normals, 0, sizeof normals);
		for (size_t i = 0; i < used; i++) {
			const size_t g = first + turned_place(i);
			const float *n = fast->rows[vertices[g < count ? g : count - 1]].normal;
			normals[0][i] = n[0], normals[1][i] = n[1], normals[2][i] = n[2];
		}
		leave_unusable(normals, &r, unusable, used);
		for (size_t i = 0; i < used; i++) {
			const size_t g = first + turned_place(i);
			const uint32_t sign = orients[g] & NT_TRIANGLE_ORIENT ? NT_RESULT_PLUS : NT_RESULT_MINUS;
			r.state[i] = r.sound[i] ? sign : NT_RESULT_COMPLEX;
			orients[g] = (uint8_t)(orients[g] | (r.sound[i] && !unusable[i] ? 0 : NT_TRIANGLE_COMPLEX));
		}
		store_records(results + first, 1, used, used, &r);
	}
}

#endif

/* SPDX-License-Identifier: MIT */
/*
 * The passes of tiny.c that need lanes. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_FEW_LANES_H
#define NT_TANGENT_FAST_FEW_LANES_H

#include "tangent/fast/accumulate.h"
#include "tangent/fast/settle.h"

/* Triangles [first, first + count), at most NT_LANES, as accumulate() solves them. */
static void __attribute__((noinline)) solve_some(const nt_fast *fast, size_t first, size_t count, float offset,
	nt_record *add, nt_frames *frames)
{
	lanes_in in;
	lanes_out out;
	gather_lanes(fast->rows, fast->triangles.ids + 3 * first, count, whole_lanes(count), in.row);
	solve_lanes_plain(&in, &out, offset, count);
	const bool ordinary = classify_lanes(fast, first, count, &in, &out);
	for (size_t c = 0; c < 3; c++) { /* as a whole it would be copied by "rep movs", which takes long to begin */
		memcpy(frames->u[c], out.frames.u[c], sizeof out.frames.u[c]);
		memcpy(frames->v[c], out.frames.v[c], sizeof out.frames.v[c]);
	}
	for (size_t i = 0; i < count; i++)
		for (size_t k = 0; k < 3; k++)
			memcpy(&add[3 * i + k], out.add[k] + 4 * turned_place(i), sizeof *add);
	for (size_t i = 0; !ordinary && i < count; i++)
		for (size_t k = 0; k < 3 && !out.sound[i]; k++)
			add[3 * i + k].state = NT_STATE_BASE;
}

/* Frames: flags, and what each corner adds, in order, and one record more. */
static void few_frames(const nt_fast *fast, nt_record *add, nt_frames *frames)
{
	lanes_out out;
	const float offset = nt_stored_v_offset(fast->solve->mesh);
	for (size_t first = 0, count; first < fast->triangle_count; first += count) {
		const size_t left = fast->triangle_count - first;
		count = left < NT_LANES ? left : NT_LANES;
		const uint32_t *ids = fast->triangles.ids + 3 * first;
		if (count <= 4 && offset == 0.0f &&
			solve_four(fast->rows, ids, count, add + 3 * first, frames + first / NT_LANES, &out))
			classify_plain(fast->flags + first, count, &out);
		else
			solve_some(fast, first, count, offset, add + 3 * first, frames + first / NT_LANES);
	}
}

/* Sums of groups and normals by component, in turned places. */
static inline void load_groups(const nt_record *results, const float *const *normals_at, size_t used, record_lanes *r,
	float normals[3][NT_LANES])
{
	load_records(results, used, r);
	for (size_t i = 0; i < used; i += WIDTH) {
		lanes four[4];
		for (size_t j = 0; j < 4; j++)
			four[j] = load_parts(normals_at + i + j * (WIDTH / 4));
		turn(four);
		for (size_t c = 0; c < 3; c++)
			memcpy(normals[c] + i, &four[c], sizeof *four);
	}
}

/* The same for four, in order. */
static inline void load_four_groups(const nt_record *results, const float *const *normals_at, record_lanes *r,
	float normals[3][NT_LANES])
{
	nt_float4 sums[4], rows[4];
	memcpy(sums, results, sizeof sums);
	for (size_t i = 0; i < 4; i++)
		memcpy(&rows[i], normals_at[i], sizeof *rows);
	turn_four(sums);
	turn_four(rows);
	memcpy(r->x, &sums[0], sizeof *sums);
	memcpy(r->y, &sums[1], sizeof *sums);
	memcpy(r->z, &sums[2], sizeof *sums);
	memcpy(r->state, &sums[3], sizeof *sums);
	for (size_t c = 0; c < 3; c++)
		memcpy(normals[c], &rows[c], sizeof *rows);
	read_states(4, r);
}

static inline void store_four_groups(const record_lanes *r, nt_record *results)
{
	nt_float4 rows[4];
	memcpy(&rows[0], r->x, sizeof *rows);
	memcpy(&rows[1], r->y, sizeof *rows);
	memcpy(&rows[2], r->z, sizeof *rows);
	memcpy(&rows[3], r->state, sizeof *rows);
	turn_four(rows);
	memcpy(results, rows, sizeof rows);
}

/* Up to `used` groups: whole vectors, or `four` in vectors of four. */
static inline __attribute__((always_inline)) void finish_groups(const nt_weld_row *rows,
	const uint32_t *vertices, size_t count, size_t used, bool four, nt_record *results)
{
	const float *normals_at[NT_LANES];
	float normals[3][NT_LANES];
	uint32_t unusable[NT_LANES];
	record_lanes r;
	for (size_t i = 0; i < used; i++)
		normals_at[i] = rows[vertices[i < count ? i : count - 1]].normal;
	if (four)
		load_four_groups(results, normals_at, &r, normals);
	else
		load_groups(results, normals_at, used, &r, normals);
	normalise_records(used, &r);
	find_unusable(normals, &r, unusable, used);
	for (size_t i = 0; i < used; i++)
		r.state[i] = r.sound[i] ? NT_RESULT_PLUS | unusable[i] : NT_RESULT_COMPLEX | NT_RESULT_UNUSABLE;
	if (four)
		store_four_groups(&r, results);
	else
		store_records(results, 1, used, used, &r, r.state);
}

/* Results of groups from their sums. One that is its sum has the state NT_RESULT_PLUS, whatever its orientation, and
 * NT_RESULT_UNUSABLE where it is that; others have NT_RESULT_COMPLEX and NT_RESULT_UNUSABLE. There is room for whole
 * vectors, which hold sums throughout. */
static void few_results(const nt_weld_row *rows, const uint32_t *vertices, size_t count, nt_record *results)
{
	if (WIDTH > 4 && count > 0 && count <= 4) {
		finish_groups(rows, vertices, count, 4, true, results);
		return;
	}
	for (size_t first = 0; first < count; first += NT_LANES) {
		const size_t left = count - first < NT_LANES ? count - first : NT_LANES;
		finish_groups(rows, vertices + first, left, whole_lanes(left), false, results + first);
	}
}

#endif

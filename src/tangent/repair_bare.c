/* SPDX-License-Identifier: MIT */
/*
 * Repair where there is nothing around: bare vertices, which only triangles without a UV area have, and meshes in which
 * no triangle has such an area. A corner takes what a usable corner of its triangle has, or what its normal says, both
 * in lanes (across.c).
 */
#include "tangent/repair_parts.h"

#include "base/counts.h"
#include "tangent/across.h"

/* The next triangle from t on that has one of these flags; the mesh's number of faces: none. */
static inline size_t next_flagged(const nt_repair_state *r, size_t t, unsigned flags)
{
	return nt_next_flagged(r->solve->known->flags, t, r->solve->mesh->face_count, flags);
}

/* Bare vertices */

/* Whether the method tells which vertices have a result: those without one are bare, but for those of triangles that
 * have an orientation though they gave nothing. These are marked. */
static bool tell_bare(const nt_repair_state *r)
{
	const nt_known *known = r->solve->known;
	if (r->solve->mesh->face_sizes || !known || !known->judged)
		return false;
	const unsigned open = known->doubtful | known->degenerate;
	for (size_t t = next_flagged(r, 0, open); t < r->solve->mesh->face_count; t = next_flagged(r, t + 1, open))
		for (size_t c = 3 * t; c < 3 * t + 3 && nt_orientation_of(r, t, 3 * t); c++)
			r->ids[r->welded[c]] = NT_NOT_BARE;
	return true;
}

/* Triangles whose unusable corners are all bare, and bare vertices that are new. A word of faulty bits is added while
 * no more than half is used; one more than counts may be written. */
enum { BARE_LISTED = 2 * 64 };
typedef struct bare_list {
	uint32_t alone[BARE_LISTED + 1];       /* triangles without a usable corner */
	nt_beside beside[2 * BARE_LISTED + 1]; /* unusable corners of others, and the first usable one of the
	                                          triangle */
	uint32_t fresh[3 * BARE_LISTED];       /* vertices of the mesh, whose numbers go down from `next` */
	size_t alone_count, beside_count, fresh_count, next;
} bare_list;

/* Whether a triangle gave something to a welded vertex. */
static bool has_result(const nt_known *known, uint32_t vertex)
{
	bool has = false;
	for (int side = 0; side < 2; side++)
		has |= known->rows[side] && known->rows[side][known->row_step * vertex + 3] != 0.0f;
	return has;
}

/* Numbers the vertex of an unusable corner, open or bare. */
static void number_listed(nt_repair_state *r, size_t c, bare_list *list)
{
	uint32_t *id = &r->ids[r->welded[c]];
	if (*id == NT_NOT_BARE || has_result(r->solve->known, r->welded[c])) {
		nt_number_open(r, c);
		return;
	}
	*id = (uint32_t)--r->first_bare;
	list->fresh[list->fresh_count++] = (uint32_t)nt_vertex_of(r->solve->mesh, c);
}

/* Lists a faulty triangle; false: some of its unusable corners are not bare. Which corners are unusable is as good as
 * random: there is a branch for vertices alone that are new. */
static inline bool list_bare(nt_repair_state *r, size_t t, bare_list *list)
{
	const uint32_t first = (uint32_t)(3 * t);
	unsigned lacking = 0, open = 0;
#pragma GCC unroll 3
	for (uint32_t k = 0; k < 3; k++) {
		const unsigned lacks = !nt_is_usable(r->solve, first + k);
		const uint32_t *id = &r->ids[r->welded[first + k]];
		if (lacks & (*id >= NT_NOT_BARE))
			number_listed(r, first + k, list);
		lacking |= lacks << k;
		open |= lacks & (*id < r->first_bare);
	}
	if (open)
		return false;
	const unsigned alone = lacking == 7, usable = ~lacking & 7;
	list->alone[list->alone_count] = (uint32_t)t;
	list->alone_count += alone;
	const uint32_t from = first + (uint32_t)__builtin_ctz(usable | 8),
		last = first + (usable >> 2 ? 2 : usable >> 1);
#pragma GCC unroll 3
	for (uint32_t k = 0; k < 3; k++) {
		list->beside[list->beside_count] = (nt_beside){first + k, from, last};
		list->beside_count += lacking >> k & 1 & ~alone;
	}
	return true;
}

/* Gives a corner a tangent and its sign, which are no average: [4]. */
static inline void write_row(const nt_solve *solve, size_t c, const float *row)
{
	if (solve->faults || solve->bitangents || solve->magnitudes) {
		if (solve->faults)
			solve->faults[c] |= NMTAN_FAULT_NO_AVERAGE;
		nt_repair_corner(solve, c, row, row[3]);
		return;
	}
	memcpy(solve->tangents + 4 * c, row, 4 * sizeof *row);
}

/* A corner for which the first usable one of its triangle has no part across the normal. */
static void repair_parallel(const nt_repair_state *r, nt_beside at)
{
	const nt_solve *solve = r->solve;
	const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, at.corner));
	float row[4];
	nt_dvec3 t;
	memcpy(row, nt_bare_tangent(r, r->ids[r->welded[at.corner]]), sizeof row);
	if (at.last != at.from && nt_borrow(solve, at.last, n, &t))
		nt_dvec3_store(t, row);
	row[3] = solve->tangents[4 * at.from + 3];
	write_row(solve, at.corner, row);
}

/* The tangents at bare vertices that are new. */
static void find_bare_tangents(const nt_repair_state *r, bare_list *list)
{
	float across[NT_ACROSS_LANES][4];
	for (size_t i = 0; i < list->fresh_count; i += NT_ACROSS_LANES) {
		const size_t left = list->fresh_count - i, count = left < NT_ACROSS_LANES ? left : NT_ACROSS_LANES;
		nt_perpendiculars(r->solve->mesh, 0, list->fresh + i, count, across);
		for (size_t k = 0; k < count; k++)
			memcpy(nt_bare_tangent(r, --list->next), across[k], sizeof *across);
	}
}

/* Triangles without a usable corner: each corner has its vertex's tangent. */
static void repair_alone(const nt_repair_state *r, const bare_list *list)
{
	for (size_t i = 0; i < list->alone_count; i++)
		for (size_t c = 3 * (size_t)list->alone[i]; c < 3 * (size_t)list->alone[i] + 3; c++)
			write_row(r->solve, c, nt_bare_tangent(r, r->ids[r->welded[c]]));
}

/* Corners beside a usable one, whose tangent they have. */
static void repair_beside(const nt_repair_state *r, const bare_list *list)
{
	const nt_solve *solve = r->solve;
	float across[NT_ACROSS_LANES][4];
	for (size_t i = 0; i < list->beside_count; i += NT_ACROSS_LANES) {
		const size_t left = list->beside_count - i, count = left < NT_ACROSS_LANES ? left : NT_ACROSS_LANES;
		nt_borrow_tangents(solve->mesh, solve->tangents, list->beside + i, count, across);
		for (size_t k = 0; k < count; k++) {
			if (across[k][3] != 0.0f)
				write_row(solve, list->beside[i + k].corner, across[k]);
			else
				repair_parallel(r, list->beside[i + k]);
		}
	}
}

static void repair_listed(const nt_repair_state *r, bare_list *list)
{
	find_bare_tangents(r, list);
	repair_alone(r, list);
	repair_beside(r, list);
	list->alone_count = list->beside_count = list->fresh_count = 0;
}

bool nt_repair_bare(nt_repair_state *r)
{
	if (!tell_bare(r))
		return false;
	const size_t words = (r->solve->mesh->face_count + 63) / 64;
	bare_list list;
	list.alone_count = list.beside_count = list.fresh_count = 0;
	list.next = r->first_bare;
	for (size_t word = 0; word < words; word++) {
		uint64_t left = r->faulty[word];
		for (uint64_t bits = left; bits; bits &= bits - 1)
			if (list_bare(r, 64 * word + (size_t)__builtin_ctzll(bits), &list))
				left &= ~(bits & -bits);
		r->faulty[word] = left;
		if (list.alone_count > BARE_LISTED / 2 || list.beside_count > BARE_LISTED ||
			list.fresh_count > 3 * BARE_LISTED / 2)
			repair_listed(r, &list);
	}
	repair_listed(r, &list);
	return true;
}

/* Nothing around any vertex */

/* Whether all corners are unusable, and no face has an orientation, as in meshes that nobody has unwrapped. */
static bool is_hopeless(const nt_solve *solve, const nmtan_counts *counts)
{
	size_t c = nt_counts_repaired(counts) == solve->corner_count ? 0 : solve->corner_count + 1;
	while (c < solve->corner_count && signbit(solve->tangents[4 * c + 3]))
		c++;
	return c == solve->corner_count;
}

/* Whether a normal has a -0, in which equal vertices may differ: then the first of them decides. */
static bool has_negative_zero(const float *n)
{
	return (n[0] == 0.0f && signbit(n[0])) || (n[1] == 0.0f && signbit(n[1])) || (n[2] == 0.0f && signbit(n[2]));
}

/* `done` becomes false, too, where normals are not enough, or not less work. */
nmtan_status nt_repair_by_normals(const nt_solve *solve, const nmtan_counts *counts, bool *done)
{
	const nmtan_mesh *mesh = solve->mesh;
	const size_t count = mesh->indices ? mesh->vertex_count : solve->corner_count;
	*done = false;
	if (!is_hopeless(solve, counts) || count > solve->corner_count)
		return NMTAN_OK;
	float (*tangents)[4] = nt_scratch_alloc(solve->scratch, count + NT_ACROSS_LANES, sizeof *tangents);
	if (!tangents)
		return NMTAN_ERROR_MEMORY;
	for (size_t v = 0; v < count; v++)
		if (has_negative_zero(nt_normal(mesh, v)))
			return NMTAN_OK;
	for (size_t v = 0; v < count; v += NT_ACROSS_LANES)
		nt_perpendiculars(mesh, v, NULL, count - v < NT_ACROSS_LANES ? count - v : NT_ACROSS_LANES,
			tangents + v);
	for (size_t c = 0; c < solve->corner_count; c++)
		write_row(solve, c, tangents[nt_vertex_of(mesh, c)]);
	*done = true;
	return NMTAN_OK;
}

/* SPDX-License-Identifier: MIT */
/*
 * Repair: what is around open vertices, for each orientation the sum over the triangles there and the first usable
 * corner. Each triangle is visited once, whichever of its vertices asks for it.
 */
#include "tangent/repair_parts.h"

/* Adds a face of 3 or 4 corners with an open vertex to what is around these. */
static inline void visit_face(const nt_repair_state *r, size_t face, size_t first, unsigned size)
{
	const nt_solve *solve = r->solve;
	nt_surroundings *around[4]; /* of its vertices; NULL: not open */
	for (size_t k = 0; k < size; k++) {
		around[k] = nt_is_open(r, first + k) ? &r->around[r->ids[r->welded[first + k]]] : NULL;
		const float w = around[k] ? nt_corner_tangent(solve, first + k)[3] : 0.0f;
		if (w != 0.0f && around[k]->usable[w > 0.0f] == NT_NO_ID)
			around[k]->usable[w > 0.0f] = (uint32_t)(first + k);
	}
	const int orientation = nt_orientation_of(r, face, first);
	if (!orientation)
		return; /* no triangle of it has a frame */
	uint32_t corners[2][3] = {{(uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2}};
	const unsigned count = size == 3 ? 1 : nt_face_triangles(solve->mesh, face, first, corners);
	for (unsigned i = 0; i < count; i++) {
		nt_frame_sum *to[3];
		nt_dvec3 normals[3];
		for (int k = 0; k < 3; k++) {
			nt_surroundings *at = around[corners[i][k] - first];
			to[k] = at ? &at->sums[orientation > 0] : NULL;
			normals[k] = at ? at->normal : (nt_dvec3){0, 0, 0};
		}
		nt_add_triangle(solve->mesh, NT_WEIGHT_ANGLE, corners[i], normals, to);
	}
}

/* Sums become answers. */
static void answer(const nt_solve *solve, nt_surroundings *around)
{
	const nt_dvec3 n = around->normal;
	nt_answers a = {0};
	for (int side = 0; side < 2; side++) {
		const bool weighs = around->sums[side].weights > 0.0, usable = around->usable[side] != NT_NO_ID;
		nt_dvec3 t;
		a.there[side] = usable || weighs;
		a.averaged[side] = weighs && nt_sum_tangent(&around->sums[side], n, &t);
		a.borrowed[side] = !a.averaged[side] && usable && nt_borrow(solve, around->usable[side], n, &t);
		if (a.averaged[side] || a.borrowed[side])
			nt_dvec3_store(t, a.tangents[side]);
	}
	nt_dvec3_store(nt_dvec3_perpendicular(n), a.perpendicular);
	around->answers = a;
}

/* Whether the triangle with that first corner is to be visited; without a branch. */
static inline bool is_near(const nt_repair_state *r, size_t first)
{
	const bool a = nt_is_open(r, first), b = nt_is_open(r, first + 1), c = nt_is_open(r, first + 2);
	return a | b | c;
}

/* Which triangles of a word of flags may have an open vertex. */
static uint64_t find_candidates(const nt_repair_state *r, bool among_suspects, size_t first, size_t count)
{
	const nt_known *known = r->solve->known;
	if (!among_suspects)
		return UINT64_MAX >> (NT_FLAG_WORD - count);
	/* where no row is marked, open vertices are complex ones, or those of doubtful and degenerate triangles: flat
	 * triangles around them have another bit of `suspect`, too, or give nothing */
	const unsigned flat = known->judged && !known->open ? known->flat : 0;
	size_t others;
	return nt_flagged(known->flags + first, count, (uint8_t)(known->suspect & ~flat), known->positive, &others);
}

/* Positions and texture coordinates are prefetched: their cache misses took a twelfth of all visits. */
static void visit_listed(const nt_repair_state *r, const uint32_t *triangles, size_t count)
{
	const nmtan_mesh *mesh = r->solve->mesh;
	for (size_t i = 0; i < count; i++)
		for (size_t c = 3 * (size_t)triangles[i]; c < 3 * (size_t)triangles[i] + 3; c++) {
			__builtin_prefetch(nt_position(mesh, nt_vertex_of(mesh, c)));
			__builtin_prefetch(nt_texcoord(mesh, nt_vertex_of(mesh, c)));
		}
	for (size_t i = 0; i < count; i++)
		visit_face(r, triangles[i], 3 * (size_t)triangles[i], 3);
}

/* Visits the triangles with an open vertex. They are listed first: which of the candidates they are is as good as
 * random. */
static void visit_triangles(const nt_repair_state *r, bool among_suspects)
{
	enum { LISTED = 4 * NT_FLAG_WORD };
	const size_t total = r->solve->mesh->face_count;
	uint32_t near[LISTED];
	size_t listed = 0;
	for (size_t first = 0; first < total; first += NT_FLAG_WORD) {
		const size_t count = total - first < NT_FLAG_WORD ? total - first : NT_FLAG_WORD;
		for (uint64_t bits = find_candidates(r, among_suspects, first, count); bits; bits &= bits - 1) {
			const size_t t = first + (size_t)__builtin_ctzll(bits);
			near[listed] = (uint32_t)t;
			listed += is_near(r, 3 * t);
		}
		if (listed <= LISTED - NT_FLAG_WORD && first + count < total)
			continue;
		visit_listed(r, near, listed);
		listed = 0;
	}
}

/* The same where there are quads, or where the list is not worth its bytes. */
static void visit_faces(const nt_repair_state *r)
{
	const nmtan_mesh *mesh = r->solve->mesh;
	for (size_t face = 0, first = 0; face < mesh->face_count; first += nt_face_size(mesh, face++))
		if (is_near(r, first) || (nt_face_size(mesh, face) == 4 && nt_is_open(r, first + 3)))
			visit_face(r, face, first, nt_face_size(mesh, face));
}

void nt_look_around(const nt_repair_state *r, bool among_suspects)
{
	if (r->id_count == 0)
		return;
	if (r->solve->mesh->face_sizes || !NT_SHORT_WAYS)
		visit_faces(r);
	else
		visit_triangles(r, among_suspects);
	for (size_t i = 0; i < r->id_count; i++)
		answer(r->solve, &r->around[i]);
}

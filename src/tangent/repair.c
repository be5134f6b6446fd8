/* SPDX-License-Identifier: MIT */
/*
 * Repair: see frames.h.
 *
 * The check (usable.c) finds nothing on most meshes, and then nothing is done here. If it finds something, it has
 * marked the corners concerned with w = 0. They are collected by welded vertex, the triangles around these vertices
 * are visited once, and each corner gets, in this order:
 *
 *   1 the robust average of the triangles of its face's orientation around its vertex: the exact value of what the
 *     methods approximate
 *   2 a usable tangent at the same vertex, in a face of the same orientation
 *   3 one of the same face
 *   4 where its face has no orientation of its own, 1 or 2 of the other orientation
 *   5 a unit vector perpendicular to the normal
 *
 * A face without orientation takes that of its usable corners, or of its vertices' neighbourhoods. Usable tangents
 * keep their bytes.
 *
 * Apart from what is faulty this costs one look at the numbers of each triangle's vertices.
 */
#include "tangent/frames.h"

#include <math.h>
#include <string.h>
#include "base/parallel.h"
#include "base/structs.h"
#include "topology/corners.h"

/* Faces that share a word of faulty bits, and open vertices, or faces, for which a thread more pays. */
enum { WORD = 64, GRAIN = 1 << 9 };

/* Sums at a vertex and its usable corners, for orientation -1 and +1. */
typedef struct neighbour_answers {
	float tangents[2][3], perpendicular[3]; /* unit; perpendicular to the normal */
	bool averaged[2], borrowed[2];          /* 1 or 2 of the list above; neither: there is no tangent */
	bool there[2];                          /* triangles or usable corners */
} neighbour_answers;

/* Triangles and usable corners at a vertex with an unusable corner, for orientation -1 and +1. */
typedef struct neighbourhood {
	const float *given; /* the normal of the first unusable corner */
	nt_dvec3 normal;    /* the same; unit or zero */
	uint32_t usable[2]; /* the first usable corners, or NT_NO_ID */
	union {
		nt_frame_sum sums[2]; /* until all triangles are visited */
		neighbour_answers answers;
	};
} neighbourhood;

/* A repair. Welded vertices with an unusable corner are open. */
typedef struct repair_state {
	const nt_solve *solve;
	const uint64_t *faulty; /* a bit for each face */
	const uint32_t *welded; /* [corner_count] */
	size_t welded_count;
	uint8_t *open;          /* [welded_count] whether a vertex is */
	uint32_t *ids;          /* [welded_count] numbers of open vertices */
	size_t id_count;
	neighbourhood *neighbourhoods; /* [id_count], with room for as many as there can be */
} repair_state;

/* Whether a corner's vertex is open. */
static bool is_open(const repair_state *r, size_t c)
{
	return r->open[r->welded[c]];
}

/* Whether a corner of a faulty face or of a quad is usable: their rows are there. */
static bool is_usable(const nt_solve *solve, size_t c)
{
	uint32_t w;
	memcpy(&w, &solve->tangents[4 * c + 3], sizeof w);
	return w << 1;
}

/* The exact orientation of a face with that first corner, by what is known of it. A quad that is folded evenly has that
 * of its usable corners. */
static int orientation_of(const repair_state *r, size_t face, size_t first)
{
	const nmtan_mesh *mesh = r->solve->mesh;
	int known;
	if (!mesh->face_sizes && nt_knows_orientation(r->solve->known, face, &known))
		return known;
	const size_t faulty = r->faulty[face / WORD] >> face % WORD & 1 ? nt_face_size(mesh, face) : 0;
	for (size_t c = first; c < first + faulty; c++)
		if (!is_usable(r->solve, c) && signbit(r->solve->tangents[4 * c + 3]))
			return 0;
	nt_fold fold;
	const int orientation = nt_face_orientation(mesh, face, first, true, &fold);
	for (size_t c = first; fold == NT_FOLDED_EVENLY && c < first + 4; c++)
		if (is_usable(r->solve, c))
			return (int)r->solve->tangents[4 * c + 3];
	return orientation;
}

/* Rounds an answer to floats; false: it is not usable beside the normal as it is given. A direction that runs along the
 * normal, but for noise, may come out of the sums as one across it. */
static bool store_answer(const neighbourhood *at, nt_dvec3 answer, float tangent[3])
{
	nt_dvec3_store(answer, tangent);
	return nt_is_frame(tangent, at->given);
}

/* A usable corner's tangent, perpendicular to the normal; false: it has no such part. */
static bool borrow_tangent(const nt_solve *solve, uint32_t c, const neighbourhood *at, float tangent[3])
{
	nt_dvec3 t = nt_dvec3_reject(at->normal, nt_dvec3_load(nt_corner_tangent(solve, c)));
	return nt_dvec3_dot(t, t) > NT_PARALLEL_SINE_SQUARED && nt_dvec3_normalise(&t) && store_answer(at, t, tangent);
}

/* Gives a corner the tangent t and its sign. */
static void write_corner(const nt_solve *solve, size_t c, const float *t, float w)
{
	const float tangent[4] = {t[0], t[1], t[2], w};
	memcpy(solve->tangents + 4 * c, tangent, sizeof tangent);
	if (solve->bitangents) {
		const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c));
		const nt_dvec3 b = nt_dvec3_scale(w, nt_dvec3_cross(n, nt_dvec3_load(tangent)));
		nt_dvec3_store(b, solve->bitangents + 3 * c);
	}
	if (solve->magnitudes)
		solve->magnitudes[2 * c] = solve->magnitudes[2 * c + 1] = 1.0f;
}

/* Faults */

/* A faulty face. */
typedef struct place {
	size_t face, first; /* its first corner */
} place;

/* The next faulty face from at->face on; false: there is none. */
static bool find_faulty(const repair_state *r, place *at)
{
	const nmtan_mesh *mesh = r->solve->mesh;
	size_t face = at->face;
	while (face < mesh->face_count) {
		const uint64_t left = r->faulty[face / WORD] >> face % WORD;
		if (left) {
			face += (size_t)nt_trailing_zeros(left);
			break;
		}
		face = (face / WORD + 1) * WORD;
	}
	if (face >= mesh->face_count)
		return false;
	if (!mesh->face_sizes)
		at->first = 3 * face;
	for (; mesh->face_sizes && at->face < face; at->face++)
		at->first += mesh->face_sizes[at->face];
	at->face = face;
	return true;
}

static void step_over(const repair_state *r, place *at)
{
	at->first += nt_face_size(r->solve->mesh, at->face++);
}

/* The welded vertices of all corners: the method's, if it tells. */
static nmtan_status weld(repair_state *r)
{
	const nt_solve *solve = r->solve;
	if (solve->known && solve->known->welded) {
		r->welded = solve->known->welded;
		r->welded_count = solve->known->welded_count;
		return NMTAN_OK;
	}
	uint32_t *own = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *own);
	r->welded = own;
	return own ? nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, own, &r->welded_count)
		   : NMTAN_ERROR_MEMORY;
}

/* Numbers the welded vertices that have an unusable corner. Equal vertices of the mesh have equal normals, so a unit
 * normal is made once for all corners at a vertex. */
static nmtan_status number_vertices(repair_state *r, size_t unusable)
{
	const nt_solve *solve = r->solve;
	const size_t most = unusable < r->welded_count ? unusable : r->welded_count;
	r->open = nt_scratch_alloc(solve->scratch, r->welded_count, 1);
	r->ids = nt_scratch_alloc(solve->scratch, r->welded_count, sizeof *r->ids);
	r->neighbourhoods = nt_scratch_alloc(solve->scratch, most, sizeof *r->neighbourhoods);
	if (!r->open || !r->ids || !r->neighbourhoods)
		return NMTAN_ERROR_MEMORY;
	memset(r->open, 0, r->welded_count);
	for (place at = {0, 0}; find_faulty(r, &at); step_over(r, &at))
		for (size_t c = at.first; c < at.first + nt_face_size(solve->mesh, at.face); c++) {
			if (is_open(r, c) || is_usable(solve, c))
				continue;
			const size_t vertex = nt_vertex_of(solve->mesh, c);
			r->open[r->welded[c]] = true;
			r->ids[r->welded[c]] = (uint32_t)r->id_count;
			neighbourhood *open = &r->neighbourhoods[r->id_count++];
			memset(open, 0, sizeof *open);
			open->given = nt_normal(solve->mesh, vertex);
			open->normal = nt_unit_normal(solve->mesh, vertex);
			open->usable[0] = open->usable[1] = NT_NO_ID;
		}
	return NMTAN_OK;
}

/* Neighbourhoods */

/* Neighbourhoods [begin, begin + count) of a thread. */
typedef struct share {
	const repair_state *repair;
	uint32_t begin, count;
} share;

/* Adds a face of 3 or 4 corners to the neighbourhoods of its open vertices, as far as they are a thread's. */
static void visit_face(const share *s, size_t face, size_t first, unsigned size)
{
	const repair_state *r = s->repair;
	const nt_solve *solve = r->solve;
	neighbourhood *of[4]; /* its vertices; NULL: not open */
	bool any = false;
	for (size_t k = 0; k < size; k++) {
		const uint32_t id = is_open(r, first + k) ? r->ids[r->welded[first + k]] : NT_NO_ID;
		of[k] = id - s->begin < s->count ? &r->neighbourhoods[id] : NULL;
		any |= of[k] != NULL;
		const float w = of[k] ? nt_corner_tangent(solve, first + k)[3] : 0.0f;
		if (w != 0.0f && of[k]->usable[w > 0.0f] == NT_NO_ID)
			of[k]->usable[w > 0.0f] = (uint32_t)(first + k);
	}
	const int orientation = any ? orientation_of(r, face, first) : 0;
	if (!orientation)
		return; /* no triangle of it has a frame */
	uint32_t corners[2][3] = {{(uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2}};
	const unsigned count = size == 3 ? 1 : nt_face_triangles(solve->mesh, face, first, corners);
	for (unsigned i = 0; i < count; i++) {
		nt_frame_sum *to[3];
		nt_dvec3 normals[3];
		for (int k = 0; k < 3; k++) {
			neighbourhood *at = of[corners[i][k] - first];
			to[k] = at ? &at->sums[orientation > 0] : NULL;
			normals[k] = at ? at->normal : (nt_dvec3){0, 0, 0};
		}
		nt_add_triangle(solve->mesh, NT_WEIGHT_ANGLE, corners[i], normals, to);
	}
}

/* Sums become answers. */
static void answer(const nt_solve *solve, neighbourhood *at)
{
	neighbour_answers a = {0};
	for (int side = 0; side < 2; side++) {
		const bool weighs = at->sums[side].weights > 0.0, usable = at->usable[side] != NT_NO_ID;
		nt_dvec3 t;
		a.there[side] = usable || weighs;
		a.averaged[side] = weighs && nt_sum_tangent(&at->sums[side], at->normal, &t) &&
				   store_answer(at, t, a.tangents[side]);
		a.borrowed[side] = !a.averaged[side] && usable &&
				   borrow_tangent(solve, at->usable[side], at, a.tangents[side]);
	}
	nt_dvec3_store(nt_dvec3_perpendicular(at->normal), a.perpendicular);
	at->answers = a;
}

/* Visits the faces with an open vertex. Most have none, so that triangles have a loop of their own. */
static void visit_faces(const share *s)
{
	const repair_state *r = s->repair;
	const nmtan_mesh *mesh = r->solve->mesh;
	const uint8_t *const open = r->open;
	const uint32_t *v = r->welded;
	for (size_t face = 0; !mesh->face_sizes && face < mesh->face_count; face++, v += 3)
		if (NT_EXPECT(open[v[0]] | open[v[1]] | open[v[2]], 0))
			visit_face(s, face, 3 * face, 3);
	for (size_t face = 0, first = 0; mesh->face_sizes && face < mesh->face_count;
		first += mesh->face_sizes[face++]) {
		const uint32_t *corners = r->welded + first;
		const unsigned size = mesh->face_sizes[face];
		if (open[corners[0]] | open[corners[1]] | open[corners[2]] | (size == 4 && open[corners[3]]))
			visit_face(s, face, first, size);
	}
}

/* Finds the answers of open vertices [begin, end). */
static void visit_neighbourhoods(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const repair_state *r = context;
	const share s = {r, (uint32_t)begin, (uint32_t)(end - begin)};
	visit_faces(&s);
	for (size_t i = begin; i < end; i++)
		answer(r->solve, &r->neighbourhoods[i]);
}

/* Repairs */

/* A faulty face. */
typedef struct face {
	size_t first, size; /* its corners */
	bool usable[4];
	int orientation, side;
} face;

static const neighbourhood *neighbourhood_of(const repair_state *r, size_t c)
{
	return &r->neighbourhoods[r->ids[r->welded[c]]];
}

/* The best tangent that can be had at an unusable corner c of a face; it may lie in `own`. */
static const float *best_tangent(const repair_state *r, const face *f, size_t c, float own[3])
{
	const nt_solve *solve = r->solve;
	const neighbourhood *at = neighbourhood_of(r, c);
	const neighbour_answers *a = &at->answers;
	if (solve->faults && !a->averaged[f->side])
		solve->faults[c] |= NMTAN_FAULT_NO_AVERAGE;
	if (a->averaged[f->side] || a->borrowed[f->side])
		return a->tangents[f->side];
	for (size_t k = 0; k < f->size; k++)
		if (f->usable[k] && borrow_tangent(solve, (uint32_t)(f->first + k), at, own))
			return own;
	const bool other = !f->orientation && (a->averaged[!f->side] || a->borrowed[!f->side]);
	return other ? a->tangents[!f->side] : a->perpendicular;
}

/* The side of a face without orientation: that of a usable corner, all of which agree; else that of most of its
 * vertices' neighbourhoods; else that of the first usable corner in these; +1 where there is none. */
static int choose_side(const repair_state *r, const face *f)
{
	int votes = 0, nearest = 1;
	uint32_t least = NT_NO_ID;
	for (size_t k = 0; k < f->size; k++)
		if (f->usable[k])
			return r->solve->tangents[4 * (f->first + k) + 3] > 0.0f;
	for (size_t k = 0; k < f->size; k++) {
		const neighbourhood *at = neighbourhood_of(r, f->first + k);
		votes += at->answers.there[1] - at->answers.there[0];
		for (int side = 0; side < 2; side++) {
			nearest = at->usable[side] < least ? side : nearest;
			least = at->usable[side] < least ? at->usable[side] : least;
		}
	}
	return votes ? votes > 0 : nearest;
}

/* Repairs one face. It reads usable corners of the face and of neighbourhoods, which nobody writes: the order of
 * corners and of faces does not matter. */
static void repair_face(const repair_state *r, size_t number, size_t first)
{
	face f = {.first = first, .size = nt_face_size(r->solve->mesh, number)};
	for (size_t k = 0; k < f.size; k++)
		f.usable[k] = is_usable(r->solve, first + k);
	f.orientation = orientation_of(r, number, first);
	f.side = f.orientation ? f.orientation > 0 : choose_side(r, &f);
	for (size_t k = 0; k < f.size; k++) {
		float own[3];
		if (!f.usable[k])
			write_corner(r->solve, first + k, best_tangent(r, &f, first + k, own),
				f.side ? 1.0f : -1.0f);
	}
}

/* Repairs the faces of words [begin, end). */
static void repair_faces(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const repair_state *r = context;
	place at = {WORD * begin, r->solve->mesh->face_sizes ? nt_first_corner(r->solve->mesh, WORD * begin) : 0};
	for (; find_faulty(r, &at) && at.face < WORD * end; step_over(r, &at))
		repair_face(r, at.face, at.first);
}

/* The part that nearly all meshes do not need: not in line, since it saves many registers. */
static nmtan_status NT_NOINLINE repair(const nt_solve *solve, const nmtan_counts *counts,
	const uint64_t *faulty)
{
	repair_state r = {.solve = solve, .faulty = faulty};
	nmtan_status status = weld(&r);
	if (!status)
		status = number_vertices(&r, nt_counts_repaired(counts));
	if (status)
		return status;
	nt_parallel_ranges(solve->threads, r.id_count, GRAIN, visit_neighbourhoods, &r);
	nt_parallel_ranges(solve->threads, (solve->mesh->face_count + WORD - 1) / WORD, GRAIN / WORD, repair_faces, &r);
	return NMTAN_OK;
}

/* No triangle has a tangent, nor an orientation: every corner gets 5, and is counted as it would be one by one. */
static nmtan_status repair_flat(const nt_solve *solve, nmtan_counts *counts)
{
	const nt_known *known = solve->known;
	float (*made)[4] = nt_scratch_alloc(solve->scratch, known->welded_count, sizeof *made);
	if (!made)
		return NMTAN_ERROR_MEMORY;
	memset(made, 0, known->welded_count * sizeof *made);
	*counts = (nmtan_counts){.degenerate_texcoords = solve->mesh->face_count,
		.repaired_unassigned = solve->corner_count};
	for (size_t t = 0; t < solve->mesh->face_count; t++)
		counts->degenerate_positions += (known->flags[t] & known->degenerate) != 0;
	for (size_t c = 0; c < solve->corner_count; c++) {
		float *tangent = made[known->welded[c]];
		if (tangent[3] == 0.0f) {
			const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c));
			nt_dvec3_store(nt_dvec3_perpendicular(n), tangent);
			tangent[3] = 1.0f;
		}
		if (solve->bitangents || solve->magnitudes)
			write_corner(solve, c, tangent, 1.0f);
		else
			memcpy(solve->tangents + 4 * c, tangent, sizeof *made);
		if (solve->faults)
			solve->faults[c] |= NMTAN_FAULT_UNASSIGNED | NMTAN_FAULT_NO_AVERAGE;
	}
	return NMTAN_OK;
}

nmtan_status nt_repair(const nt_solve *solve, nmtan_counts *counts)
{
	if (solve->repair && solve->known && solve->known->all_flat)
		return repair_flat(solve, counts);
	uint64_t *faulty = NULL;
	const nmtan_status status = nt_find_unusable(solve, counts, &faulty);
	return status || !faulty ? status : repair(solve, counts, faulty);
}

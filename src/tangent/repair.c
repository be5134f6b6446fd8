/* SPDX-License-Identifier: MIT */
/*
 * Repair: see repair.h.
 *
 * The check (usable.c) finds nothing on most meshes, and then nothing is done here. Where it finds something it has
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
 * A face without orientation takes that of its usable corners, or of what is around its vertices. What is usable
 * keeps its bytes.
 *
 * Around most vertices of triangles without a UV area there is nothing at all, and the method tells (bare vertices).
 * Where all unusable corners of a triangle are bare, it is mended before anything is visited, many at a time: across.c.
 *
 * Apart from what is faulty this costs one look at the numbers of each triangle's vertices.
 */
#include "tangent/repair.h"

#include <math.h>
#include <string.h>
#include "base/counts.h"
#include "tangent/across.h"
#include "tangent/frames.h"
#include "tangent/usable.h"
#include "topology/corners.h"

/* What the sums at a vertex and its usable corners come to, for orientation -1 and +1: 1 or 2 of the list above. */
typedef struct answers {
	float tangents[2][3], perpendicular[3]; /* unit; perpendicular to the normal */
	bool averaged[2], borrowed[2];          /* 1; 2; neither: there is no tangent */
	bool there[2];                          /* triangles or usable corners */
} answers;

/* What is around a vertex with an unusable corner, for orientation -1 and +1. */
typedef struct surroundings {
	nt_dvec3 normal;    /* unit or zero: of the first unusable corner */
	uint32_t usable[2]; /* the first usable corners, or NT_NO_ID */
	union {
		nt_frame_sum sums[2]; /* until all around is visited */
		answers answers;
	};
} surroundings;

/* Vertices with an unusable corner are touched. Of a bare one it is known that there is nothing around it. */
typedef struct patient {
	const nt_solve *solve;
	uint64_t *faulty;       /* a bit for each face; cleared where it was mended with what is bare */
	const uint32_t *welded; /* [corner_count] */
	size_t welded_count;
	uint32_t *ids;          /* [welded_count] numbers of touched vertices, or one of those below */
	size_t id_count;        /* of those that are not bare: numbers below it */
	bool among_suspects;    /* all triangles with a touched vertex are suspects */
	surroundings *around;   /* [id_count], with room for as many as there can be */
	size_t first_bare;      /* number of a bare vertex: these are counted from the end of that room */
} patient;

/* In a number's stead, beside NT_NO_ID, and above all numbers: not touched, and not bare either. */
#define NOT_BARE (NT_NO_ID - 1)

static unsigned has_bit(const uint64_t *bits, size_t i)
{
	return bits[i / 64] >> i % 64 & 1;
}

/* Whether a corner's vertex is touched, and not bare. */
static inline bool is_open(const patient *p, size_t c)
{
	return p->ids[p->welded[c]] < p->id_count;
}

/* Whether that of a corner to be mended is bare. */
static bool is_bare(const patient *p, size_t c)
{
	return NT_SHORT_WAYS && !is_open(p, c);
}

static const surroundings *around_corner(const patient *p, size_t c)
{
	return &p->around[p->ids[p->welded[c]]];
}

/* The tangent at a bare vertex, perpendicular to its normal, by the vertex's number: [3]. */
static float *bare_tangent(const patient *p, size_t number)
{
	return (float *)p->around + 4 * number;
}

/* Whether a corner of a faulty face is usable. Such a face is a suspect: its rows are there. */
static bool is_usable(const nt_solve *solve, size_t c)
{
	uint32_t w;
	memcpy(&w, &solve->tangents[4 * c + 3], sizeof w);
	return w << 1;
}

/* The exact orientation of a face, by what is known of it. */
static inline int orientation_of(const patient *p, size_t face, size_t first)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	int known;
	if (!mesh->face_sizes && nt_knows_orientation(p->solve->known, face, &known))
		return known;
	const size_t faulty = has_bit(p->faulty, face) ? nt_face_size(mesh, face) : 0;
	for (size_t c = first; c < first + faulty; c++)
		if (!is_usable(p->solve, c) && signbit(p->solve->tangents[4 * c + 3]))
			return 0;
	return nt_face_orientation(mesh, face, first, true, NULL);
}

/* The next triangle from t on that has one of these flags; the mesh's number of faces: none. */
static inline size_t next_flagged(const patient *p, size_t t, unsigned flags)
{
	return nt_next_flagged(p->solve->known->flags, t, p->solve->mesh->face_count, flags);
}

/* Faults */

/* A faulty face. */
typedef struct place {
	size_t face, first; /* its first corner */
} place;

/* The next faulty face from at->face on; false: there is none. */
static bool find_faulty(const patient *p, place *at)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	size_t face = at->face;
	while (face < mesh->face_count) {
		const uint64_t left = p->faulty[face / 64] >> face % 64;
		if (left) {
			face += (size_t)__builtin_ctzll(left);
			break;
		}
		face = (face / 64 + 1) * 64;
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

static void step_over(const patient *p, place *at)
{
	at->first += nt_face_size(p->solve->mesh, at->face++);
}

/* The welded vertices of all corners: the method's, if it tells. */
static nmtan_status weld(patient *p)
{
	const nt_solve *solve = p->solve;
	if (solve->known && solve->known->welded) {
		p->welded = solve->known->welded;
		p->welded_count = solve->known->welded_count;
		return NMTAN_OK;
	}
	uint32_t *own = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *own);
	p->welded = own;
	return own ? nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, own, &p->welded_count)
		   : NMTAN_ERROR_MEMORY;
}

/* Whether vertices without a result are bare, for the method tells them: but for those of faces that have an
 * orientation, though they gave nothing, which are noted. */
static bool tell_bare(const patient *p)
{
	const nt_known *known = p->solve->known;
	if (!NT_SHORT_WAYS || p->solve->mesh->face_sizes || !known || !known->judged)
		return false;
	const unsigned open = known->doubtful | known->degenerate;
	for (size_t t = next_flagged(p, 0, open); t < p->solve->mesh->face_count; t = next_flagged(p, t + 1, open))
		for (size_t c = 3 * t; c < 3 * t + 3 && orientation_of(p, t, 3 * t); c++)
			p->ids[p->welded[c]] = NOT_BARE;
	return true;
}

static nmtan_status begin_numbers(patient *p, size_t unusable)
{
	const nt_solve *solve = p->solve;
	const size_t most = unusable < p->welded_count ? unusable : p->welded_count;
	p->ids = nt_scratch_alloc(solve->scratch, p->welded_count, sizeof *p->ids);
	p->around = nt_scratch_alloc(solve->scratch, most, sizeof *p->around);
	if (!p->ids || !p->around)
		return NMTAN_ERROR_MEMORY;
	p->first_bare = most * (sizeof *p->around / (4 * sizeof(float)));
	memset(p->ids, 0xff, p->welded_count * sizeof *p->ids);
	return NMTAN_OK;
}

/* Numbers the vertex of a corner that is not bare. Equal vertices of the mesh have equal normals: what is asked for at
 * many corners is made once. */
static void number_open(patient *p, size_t c)
{
	const uint32_t id = (uint32_t)p->id_count++;
	const nt_dvec3 n = nt_unit_normal(p->solve->mesh, nt_vertex_of(p->solve->mesh, c));
	p->around[id] = (surroundings){.normal = n, .usable = {NT_NO_ID, NT_NO_ID}};
	p->ids[p->welded[c]] = id;
}

/* Numbers the welded vertices that have an unusable corner. */
static void number_vertices(patient *p)
{
	for (place at = {0, 0}; find_faulty(p, &at); step_over(p, &at))
		for (size_t c = at.first; c < at.first + nt_face_size(p->solve->mesh, at.face); c++)
			if (p->ids[p->welded[c]] == NT_NO_ID && !is_usable(p->solve, c))
				number_open(p, c);
}

/* What is around */

/* Adds a face of 3 or 4 corners with a touched vertex to what is around these. */
static inline void visit_face(const patient *p, size_t face, size_t first, unsigned size)
{
	const nt_solve *solve = p->solve;
	surroundings *around[4]; /* of its vertices; NULL: not touched, or bare */
	for (size_t k = 0; k < size; k++) {
		around[k] = is_open(p, first + k) ? &p->around[p->ids[p->welded[first + k]]] : NULL;
		const float w = around[k] ? nt_corner_tangent(solve, first + k)[3] : 0.0f;
		if (w != 0.0f && around[k]->usable[w > 0.0f] == NT_NO_ID)
			around[k]->usable[w > 0.0f] = (uint32_t)(first + k);
	}
	const int orientation = orientation_of(p, face, first);
	if (!orientation)
		return; /* no triangle of it has a frame */
	uint32_t corners[2][3] = {{(uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2}};
	const unsigned count = size == 3 ? 1 : nt_face_triangles(solve->mesh, face, first, corners);
	for (unsigned i = 0; i < count; i++) {
		nt_frame_sum *to[3];
		nt_dvec3 normals[3];
		for (int k = 0; k < 3; k++) {
			surroundings *at = around[corners[i][k] - first];
			to[k] = at ? &at->sums[orientation > 0] : NULL;
			normals[k] = at ? at->normal : (nt_dvec3){0, 0, 0};
		}
		nt_add_triangle(solve->mesh, NT_WEIGHT_ANGLE, corners[i], normals, to);
	}
}

/* A usable corner's tangent, perpendicular to n; false where it has no such part. */
static bool borrow(const nt_solve *solve, uint32_t c, nt_dvec3 n, nt_dvec3 *tangent)
{
	*tangent = nt_dvec3_reject(n, nt_dvec3_load(nt_corner_tangent(solve, c)));
	return nt_dvec3_dot(*tangent, *tangent) > NT_PARALLEL_SINE_SQUARED && nt_dvec3_normalise(tangent);
}

static void answer(const nt_solve *solve, surroundings *around)
{
	const nt_dvec3 n = around->normal;
	answers a = {0};
	for (int side = 0; side < 2; side++) {
		const bool weighs = around->sums[side].weights > 0.0, usable = around->usable[side] != NT_NO_ID;
		nt_dvec3 t;
		a.there[side] = usable || weighs;
		a.averaged[side] = weighs && nt_sum_tangent(&around->sums[side], n, &t);
		a.borrowed[side] = !a.averaged[side] && usable && borrow(solve, around->usable[side], n, &t);
		if (a.averaged[side] || a.borrowed[side])
			nt_dvec3_store(t, a.tangents[side]);
	}
	nt_dvec3_store(nt_dvec3_perpendicular(n), a.perpendicular);
	around->answers = a;
}

/* Whether the triangle with that first corner is to be visited; without a branch. */
static inline bool is_near(const patient *p, size_t first)
{
	const bool a = is_open(p, first), b = is_open(p, first + 1), c = is_open(p, first + 2);
	return a | b | c;
}

/* Which triangles of a word of flags may have a touched vertex. */
static uint64_t find_candidates(const patient *p, size_t first, size_t count)
{
	const nt_known *known = p->solve->known;
	if (!p->among_suspects)
		return UINT64_MAX >> (NT_FLAG_WORD - count);
	/* where no row is marked, open vertices are complex ones, or those of doubtful and degenerate triangles: flat
	 * triangles around them have another bit of `suspect`, too, or give nothing */
	const unsigned flat = known->judged && !known->open ? known->flat : 0;
	size_t others;
	return nt_flagged(known->flags + first, count, (uint8_t)(known->suspect & ~flat), known->positive, &others);
}

/* What triangles have is asked for first: cache misses took a twelfth of all visits of ogre. */
static void visit_listed(const patient *p, const uint32_t *triangles, size_t count)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	for (size_t i = 0; i < count; i++)
		for (size_t c = 3 * (size_t)triangles[i]; c < 3 * (size_t)triangles[i] + 3; c++) {
			__builtin_prefetch(nt_position(mesh, nt_vertex_of(mesh, c)));
			__builtin_prefetch(nt_texcoord(mesh, nt_vertex_of(mesh, c)));
		}
	for (size_t i = 0; i < count; i++)
		visit_face(p, triangles[i], 3 * (size_t)triangles[i], 3);
}

/* Visits the triangles with a touched vertex. They are listed first: which of the candidates they are is as good as
 * random. */
static void visit_triangles(const patient *p)
{
	enum { LISTED = 4 * NT_FLAG_WORD };
	const size_t total = p->solve->mesh->face_count;
	uint32_t near[LISTED];
	size_t listed = 0;
	for (size_t first = 0; first < total; first += NT_FLAG_WORD) {
		const size_t count = total - first < NT_FLAG_WORD ? total - first : NT_FLAG_WORD;
		for (uint64_t bits = find_candidates(p, first, count); bits; bits &= bits - 1) {
			const size_t t = first + (size_t)__builtin_ctzll(bits);
			near[listed] = (uint32_t)t;
			listed += is_near(p, 3 * t);
		}
		if (listed <= LISTED - NT_FLAG_WORD && first + count < total)
			continue;
		visit_listed(p, near, listed);
		listed = 0;
	}
}

static void visit_faces(const patient *p)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	for (size_t face = 0, first = 0; face < mesh->face_count; first += nt_face_size(mesh, face++))
		if (is_near(p, first) || (nt_face_size(mesh, face) == 4 && is_open(p, first + 3)))
			visit_face(p, face, first, nt_face_size(mesh, face));
}

static void look_around(const patient *p)
{
	if (p->id_count == 0)
		return;
	if (p->solve->mesh->face_sizes || !NT_SHORT_WAYS)
		visit_faces(p);
	else
		visit_triangles(p);
	for (size_t i = 0; i < p->id_count; i++)
		answer(p->solve, &p->around[i]);
}

/* Mending */

/* A faulty face. */
typedef struct face {
	size_t first, size; /* its corners */
	bool usable[4];
	int orientation, side;
} face;

/* The best tangent that can be had at an unusable corner c of a face; it may lie in `own`. */
static const float *best_tangent(const patient *p, const face *f, size_t c, float own[3])
{
	const nt_solve *solve = p->solve;
	const answers *a = is_bare(p, c) ? NULL : &around_corner(p, c)->answers;
	if (solve->faults && !(a && a->averaged[f->side]))
		solve->faults[c] |= NMTAN_FAULT_NO_AVERAGE;
	if (a && (a->averaged[f->side] || a->borrowed[f->side]))
		return a->tangents[f->side];
	for (size_t k = 0; k < f->size; k++) {
		nt_dvec3 t;
		if (f->usable[k] && borrow(solve, (uint32_t)(f->first + k),
					    nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c)), &t)) {
			nt_dvec3_store(t, own);
			return own;
		}
	}
	if (!a)
		return bare_tangent(p, p->ids[p->welded[c]]);
	const bool other = !f->orientation && (a->averaged[!f->side] || a->borrowed[!f->side]);
	return other ? a->tangents[!f->side] : a->perpendicular;
}

/* The side of a face without orientation: that of a usable corner, all of which agree; else what most of its vertices
 * have around them; of the first usable corner around where that is even; +1 where there is nothing. */
static int choose_side(const patient *p, const face *f)
{
	int votes = 0, nearest = 1;
	uint32_t least = NT_NO_ID;
	for (size_t k = 0; k < f->size; k++)
		if (f->usable[k])
			return p->solve->tangents[4 * (f->first + k) + 3] > 0.0f;
	for (size_t k = 0; k < f->size; k++) {
		if (is_bare(p, f->first + k))
			continue;
		const surroundings *around = around_corner(p, f->first + k);
		votes += around->answers.there[1] - around->answers.there[0];
		for (int side = 0; side < 2; side++) {
			nearest = around->usable[side] < least ? side : nearest;
			least = around->usable[side] < least ? around->usable[side] : least;
		}
	}
	return votes ? votes > 0 : nearest;
}

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

/* Repairs one face. What is read of its own corners and of those around are usable ones, which are never written: the
 * order of corners and of faces does not matter. */
static void mend_face(const patient *p, size_t number, size_t first)
{
	face f = {.first = first, .size = nt_face_size(p->solve->mesh, number), .orientation = orientation_of(p, number, first)};
	for (size_t k = 0; k < f.size; k++)
		f.usable[k] = is_usable(p->solve, first + k);
	f.side = f.orientation ? f.orientation > 0 : choose_side(p, &f);
	for (size_t k = 0; k < f.size; k++) {
		float own[3];
		if (!f.usable[k])
			write_corner(p->solve, first + k, best_tangent(p, &f, first + k, own), f.side ? 1.0f : -1.0f);
	}
}

/* Triangles with nothing around */

/* Triangles whose unusable corners are all bare, and bare vertices that are new. A word of faulty bits is added while
 * no more than half is used; one more than counts may be written. */
enum { BARE_LISTED = 2 * 64 };
typedef struct bare_list {
	uint32_t alone[BARE_LISTED + 1];       /* triangles without a usable corner */
	nt_beside beside[2 * BARE_LISTED + 1]; /* unusable corners of others, and the first usable one of the triangle */
	uint32_t fresh[3 * BARE_LISTED];       /* vertices of the mesh, whose numbers go down from `next` */
	size_t alone_count, beside_count, fresh_count, next;
} bare_list;

static bool has_result(const nt_known *known, uint32_t vertex)
{
	bool has = false;
	for (int side = 0; side < 2; side++)
		has |= known->rows[side] && known->rows[side][known->row_step * vertex + 3] != 0.0f;
	return has;
}

/* Numbers the vertex of an unusable corner. */
static void number_listed(patient *p, size_t c, bare_list *list)
{
	uint32_t *id = &p->ids[p->welded[c]];
	if (*id == NOT_BARE || has_result(p->solve->known, p->welded[c])) {
		number_open(p, c);
		return;
	}
	*id = (uint32_t)--p->first_bare;
	list->fresh[list->fresh_count++] = (uint32_t)nt_vertex_of(p->solve->mesh, c);
}

/* Lists a faulty triangle; false: some of its unusable corners are not bare. Which corners are unusable is as good as
 * random: there is a branch for vertices alone that are new. */
static inline bool list_bare(patient *p, size_t t, bare_list *list)
{
	const uint32_t first = (uint32_t)(3 * t);
	unsigned lacking = 0, open = 0;
#pragma GCC unroll 3
	for (uint32_t k = 0; k < 3; k++) {
		const unsigned lacks = !is_usable(p->solve, first + k);
		const uint32_t *id = &p->ids[p->welded[first + k]];
		if (lacks & (*id >= NOT_BARE))
			number_listed(p, first + k, list);
		lacking |= lacks << k;
		open |= lacks & (*id < p->first_bare);
	}
	if (open)
		return false;
	const unsigned alone = lacking == 7, usable = ~lacking & 7;
	list->alone[list->alone_count] = (uint32_t)t;
	list->alone_count += alone;
	const uint32_t from = first + (uint32_t)__builtin_ctz(usable | 8), last = first + (usable >> 2 ? 2 : usable >> 1);
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
		write_corner(solve, c, row, row[3]);
		return;
	}
	memcpy(solve->tangents + 4 * c, row, 4 * sizeof *row);
}

/* A corner for which the first usable one of its triangle has no part across the normal. */
static void mend_parallel(const patient *p, nt_beside at)
{
	const nt_solve *solve = p->solve;
	const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, at.corner));
	float row[4];
	nt_dvec3 t;
	memcpy(row, bare_tangent(p, p->ids[p->welded[at.corner]]), sizeof row);
	if (at.last != at.from && borrow(solve, at.last, n, &t))
		nt_dvec3_store(t, row);
	row[3] = solve->tangents[4 * at.from + 3];
	write_row(solve, at.corner, row);
}

static void mend_listed(const patient *p, bare_list *list)
{
	const nt_solve *solve = p->solve;
	float across[NT_ACROSS_LANES][4];
	for (size_t i = 0; i < list->fresh_count; i += NT_ACROSS_LANES) {
		const size_t left = list->fresh_count - i, count = left < NT_ACROSS_LANES ? left : NT_ACROSS_LANES;
		nt_perpendiculars(solve->mesh, 0, list->fresh + i, count, across);
		for (size_t k = 0; k < count; k++)
			memcpy(bare_tangent(p, --list->next), across[k], sizeof *across);
	}
	for (size_t i = 0; i < list->alone_count; i++)
		for (size_t c = 3 * list->alone[i]; c < 3 * (size_t)list->alone[i] + 3; c++)
			write_row(solve, c, bare_tangent(p, p->ids[p->welded[c]]));
	for (size_t i = 0; i < list->beside_count; i += NT_ACROSS_LANES) {
		const size_t left = list->beside_count - i, count = left < NT_ACROSS_LANES ? left : NT_ACROSS_LANES;
		nt_borrow_tangents(solve->mesh, solve->tangents, list->beside + i, count, across);
		for (size_t k = 0; k < count; k++) {
			if (across[k][3] != 0.0f)
				write_row(solve, list->beside[i + k].corner, across[k]);
			else
				mend_parallel(p, list->beside[i + k]);
		}
	}
	list->alone_count = list->beside_count = list->fresh_count = 0;
}

/* Mends the triangles whose unusable corners are all bare: without an orientation, for a bare vertex has none around
 * it, they take what a usable corner has, or what normals say. */
static void mend_bare(patient *p)
{
	const size_t words = (p->solve->mesh->face_count + 63) / 64;
	bare_list list;
	list.alone_count = list.beside_count = list.fresh_count = 0;
	list.next = p->first_bare;
	for (size_t word = 0; word < words; word++) {
		uint64_t left = p->faulty[word];
		for (uint64_t bits = left; bits; bits &= bits - 1)
			if (list_bare(p, 64 * word + (size_t)__builtin_ctzll(bits), &list))
				left &= ~(bits & -bits);
		p->faulty[word] = left;
		if (list.alone_count > BARE_LISTED / 2 || list.beside_count > BARE_LISTED || list.fresh_count > 3 * BARE_LISTED / 2)
			mend_listed(p, &list);
	}
	mend_listed(p, &list);
}

/* Where there is nothing to repair from */

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

/* Gives each corner what its normal alone says, without a look at what is around; `done` becomes false where that is
 * not enough, or not less work. */
static nmtan_status mend_by_normals(const nt_solve *solve, bool *done)
{
	const nmtan_mesh *mesh = solve->mesh;
	const size_t count = mesh->indices ? mesh->vertex_count : solve->corner_count;
	*done = false;
	if (count > solve->corner_count)
		return NMTAN_OK;
	float (*tangents)[4] = nt_scratch_alloc(solve->scratch, count + NT_ACROSS_LANES, sizeof *tangents);
	if (!tangents)
		return NMTAN_ERROR_MEMORY;
	for (size_t v = 0; v < count; v++)
		if (has_negative_zero(nt_normal(mesh, v)))
			return NMTAN_OK;
	for (size_t v = 0; v < count; v += NT_ACROSS_LANES)
		nt_perpendiculars(mesh, v, NULL, count - v < NT_ACROSS_LANES ? count - v : NT_ACROSS_LANES, tangents + v);
	for (size_t c = 0; c < solve->corner_count; c++)
		write_row(solve, c, tangents[nt_vertex_of(mesh, c)]);
	*done = true;
	return NMTAN_OK;
}

/* What nearly all meshes do not need: not in line, since it saves many registers. */
static nmtan_status __attribute__((noinline)) mend(const nt_solve *solve, const nmtan_counts *counts, uint64_t *faulty)
{
	patient p = {.solve = solve, .faulty = faulty};
	nmtan_status status = NMTAN_OK;
	bool done = false;
	if (NT_SHORT_WAYS && is_hopeless(solve, counts))
		status = mend_by_normals(solve, &done);
	if (status || done || (status = weld(&p)) || (status = begin_numbers(&p, nt_counts_repaired(counts))))
		return status;
	if (tell_bare(&p))
		mend_bare(&p);
	else
		number_vertices(&p);
	p.among_suspects = solve->known && solve->known->around && counts->repaired_sign == 0;
	look_around(&p);
	for (place at = {0, 0}; find_faulty(&p, &at); step_over(&p, &at))
		mend_face(&p, at.face, at.first);
	return NMTAN_OK;
}

nmtan_status nt_repair(const nt_solve *solve, nmtan_counts *counts)
{
	uint64_t *faulty = NULL;
	const nmtan_status status = nt_find_unusable(solve, counts, &faulty);
	return status || !faulty ? status : mend(solve, counts, faulty);
}

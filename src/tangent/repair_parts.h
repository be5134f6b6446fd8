/* SPDX-License-Identifier: MIT */
/*
 * What the files of the repair share: repair.c, which has the order of things, repair_around.c, which finds what is
 * around a vertex, and repair_bare.c, for corners around which there is nothing. For these files only.
 */
#ifndef NT_TANGENT_REPAIR_PARTS_H
#define NT_TANGENT_REPAIR_PARTS_H

#include <math.h>
#include <string.h>
#include "tangent/frames.h"
#include "tangent/usable.h"
#include "topology/corners.h"

/* What the sums at a vertex and its usable corners come to, for orientation -1 and +1. */
typedef struct nt_answers {
	float tangents[2][3], perpendicular[3]; /* unit; perpendicular to the normal */
	bool averaged[2], borrowed[2];          /* 1 or 2 of the list in repair.c; neither: there is no tangent */
	bool there[2];                          /* triangles or usable corners */
} nt_answers;

/* What is around a vertex with an unusable corner, for orientation -1 and +1. */
typedef struct nt_surroundings {
	nt_dvec3 normal;    /* unit or zero: of the first unusable corner */
	uint32_t usable[2]; /* the first usable corners, or NT_NO_ID */
	union {
		nt_frame_sum sums[2]; /* until all around is visited */
		nt_answers answers;
	};
} nt_surroundings;

/* A repair. Vertices with an unusable corner are touched. Of a bare one it is known that there is nothing around it;
 * the others are open. */
typedef struct nt_repair_state {
	const nt_solve *solve;
	uint64_t *faulty;       /* a bit for each face; cleared where repair_bare.c was enough */
	const uint32_t *welded; /* [corner_count] */
	size_t welded_count;
	uint32_t *ids;          /* [welded_count] numbers of touched vertices, NT_NO_ID or NT_NOT_BARE */
	size_t id_count;        /* of open vertices, whose numbers are below it */
	nt_surroundings *around; /* [id_count], with room for as many as there can be */
	size_t first_bare;      /* from here on: numbers of bare vertices, given downwards from the end of that room */
} nt_repair_state;

/* In a number's stead, beside NT_NO_ID, and above all numbers: not touched, and not bare either. */
#define NT_NOT_BARE (NT_NO_ID - 1)

/* Whether a corner's vertex is open. */
static inline bool nt_is_open(const nt_repair_state *r, size_t c)
{
	return r->ids[r->welded[c]] < r->id_count;
}

/* Whether that of an unusable corner is bare. */
static inline bool nt_is_bare(const nt_repair_state *r, size_t c)
{
	return NT_SHORT_WAYS && !nt_is_open(r, c);
}

/* The tangent at a bare vertex, perpendicular to its normal, by the vertex's number: [4], w = 1. */
static inline float *nt_bare_tangent(const nt_repair_state *r, size_t number)
{
	return (float *)r->around + 4 * number;
}

/* Whether a corner of a faulty face is usable. Such a face is a suspect: its rows are there. */
static inline bool nt_is_usable(const nt_solve *solve, size_t c)
{
	uint32_t w;
	memcpy(&w, &solve->tangents[4 * c + 3], sizeof w);
	return w << 1;
}

/* The exact orientation of a face with that first corner, by what is known of it. */
static inline int nt_orientation_of(const nt_repair_state *r, size_t face, size_t first)
{
	const nmtan_mesh *mesh = r->solve->mesh;
	int known;
	if (!mesh->face_sizes && nt_knows_orientation(r->solve->known, face, &known))
		return known;
	const size_t faulty = r->faulty[face / 64] >> face % 64 & 1 ? nt_face_size(mesh, face) : 0;
	for (size_t c = first; c < first + faulty; c++)
		if (!nt_is_usable(r->solve, c) && signbit(r->solve->tangents[4 * c + 3]))
			return 0;
	return nt_face_orientation(mesh, face, first, true, NULL);
}

/* Makes the vertex of a corner an open one. Equal vertices of the mesh have equal normals: what is asked for at many
 * corners is made once. */
static inline void nt_number_open(nt_repair_state *r, size_t c)
{
	const uint32_t id = (uint32_t)r->id_count++;
	const nt_dvec3 n = nt_unit_normal(r->solve->mesh, nt_vertex_of(r->solve->mesh, c));
	r->around[id] = (nt_surroundings){.normal = n, .usable = {NT_NO_ID, NT_NO_ID}};
	r->ids[r->welded[c]] = id;
}

/* A usable corner's tangent, perpendicular to n; false where it has no such part. */
static inline bool nt_borrow(const nt_solve *solve, uint32_t c, nt_dvec3 n, nt_dvec3 *tangent)
{
	*tangent = nt_dvec3_reject(n, nt_dvec3_load(nt_corner_tangent(solve, c)));
	return nt_dvec3_dot(*tangent, *tangent) > NT_PARALLEL_SINE_SQUARED && nt_dvec3_normalise(tangent);
}

/* Gives a corner the tangent t and its sign. */
static inline void nt_repair_corner(const nt_solve *solve, size_t c, const float *t, float w)
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

/* Finds what is around open vertices: `answers`.
 *
 *   among_suspects   all triangles with an open vertex are suspects
 */
void nt_look_around(const nt_repair_state *r, bool among_suspects);

/* Numbers touched vertices, and repairs faulty triangles whose unusable corners are all bare; false, with nothing done:
 * the method does not tell which vertices are bare. */
bool nt_repair_bare(nt_repair_state *r);

/* Where no face has an orientation and no corner is usable: gives each corner what its normal alone says. `done`
 * receives whether all is repaired. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_repair_by_normals(const nt_solve *solve, const nmtan_counts *counts, bool *done);

#endif

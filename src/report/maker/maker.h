/* SPDX-License-Identifier: MIT */
/*
 * Finds the method that made a mesh's tangents, and the quads on which it did.
 */
#ifndef NT_REPORT_MAKER_MAKER_H
#define NT_REPORT_MAKER_MAKER_H

#include "api/tangents.h"
#include "base/text.h"
#include "scene/scene.h"

/* ---- quads of which a mesh has the halves: quads.c ---- */

/* Bakers solve quads, and files have triangles. The solve takes them (nt_implementation in api/tangents.h); all else
 * keeps to the triangles. */

/* Pairs the triangles of a mesh in their order, each with the next one if both make a quad, of the two forms that one
 * program writes; corners are compared by position, normal and texture coordinates. With `polygons` only triangles that
 * FB_ngon_encoding has as one polygon of four corners: two, not more, whose first index is the same.
 *
 *   halves   [face_count] receives an nt_half for each
 *
 * Returns how many quads there are. */
size_t nt_pair_quads(const nt_mesh *mesh, bool polygons, uint8_t *halves);

/* The orientation that MikkTSpace gives both halves of a quad, here by their texture coordinates or of triangle t: that
 * of the larger one. NT_FOLDED_EITHER: they are equal in size, so that it depends on the diagonal along which a program
 * cuts. 0: triangle t is no half (halves may be NULL), or the halves have one orientation, or one has none. */
enum { NT_FOLDED_EITHER = 2 };
int nt_orientation_of_halves(const float *const uv[2][3]);
int nt_folded_orientation(const nt_mesh *mesh, const uint8_t *halves, size_t t);

/* Whether triangle t is half of a folded quad that MikkTSpace may give this sign. */
bool nt_is_folded_sign(const nt_mesh *mesh, const uint8_t *halves, size_t t, int sign);

/* Whether w of a folded quad, cut into these corners, is that which MikkTSpace gives both halves. */
bool nt_has_sign_of_quad(const nt_mesh *mesh, const uint32_t corners[2][3]);

/* ---- the method that made the tangents: maker.c ---- */

/* They are compared with those of the methods that engines and exporters use. */

/* From this share of the corners on, tangents are those of a method. */
#define NT_MAKER_SHARE 0.99

/* A method on faces. */
typedef struct nt_maker {
	bool known;           /* false: it is none of the methods */
	nmtan_method method;
	bool quads;           /* on quads whose halves the file has */
	bool inverted;        /* w is, nearly everywhere, the other one than nmtan's */
	bool untransformed;   /* of texture coordinates that the material's transform did not turn */
	bool across;          /* known away from the primitive's border alone: of the whole glTF mesh */
	double agreement;     /* share of the corners whose tangent is within `degrees` */
	double degrees;       /* 0.1, or what the tangents' precision allows */
	double most_degrees;  /* that 99 % of the corners are off at most */
	double off_mikktspace; /* most_degrees of MikkTSpace on triangles */
	bool last;            /* of those that were tried */
} nt_maker;

/* Which corners of a mesh with siblings are at its border: the triangles around the corner's vertex, welded as
 * MikkTSpace does, are not a closed fan, so that some of them may be another primitive's. border
 * [nt_bit_words(corner_count)] receives bits. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_maker_border(const nt_mesh *mesh, uint64_t *border);

/* Compares a mesh's own tangents with those of a maker, whose method and quads are given and whose other members are
 * filled. `halves` [face_count]: enum nt_half, where quads is set; `border` of nt_maker_border(); NULL: no corner.
 * If those at the border disagree and the others agree, only the others count. `fresh` [corner_count][4] receives the
 * maker's tangents. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_maker_compare(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker);

/* Finds the maker of a mesh's own tangents: the first of MikkTSpace as published and sorted, area, lengyel and robust,
 * each on triangles and on quads, with which most corners agree, if these are NT_MAKER_SHARE of all. If nearly all
 * agree, no other is tried; if none is it, each corner may have MikkTSpace's tangent of triangles or of quads; if a
 * texture transform turns the mesh's coordinates, all are tried on those of the file. `halves` [face_count]: enum
 * nt_half; NULL: no quads; `border` as above. `fresh` receives the tangents of the last one that is tried. Returns
 * NT_OK or NT_ERROR_MEMORY. */
nt_status nt_find_maker(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker);

/* Says who it is, if that is known: "MikkTSpace, on quads". */
void nt_maker_text(const nt_maker *maker, nt_buffer *out);

/* Whether it is MikkTSpace, whichever w it has. */
bool nt_maker_is_mikktspace(const nt_maker *maker);

#endif

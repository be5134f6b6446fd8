/* SPDX-License-Identifier: MIT */
/*
 * The method that made a mesh's tangents: they are compared with those of the methods that engines and exporters use.
 */
#ifndef NT_REPORT_MAKER_MAKER_H
#define NT_REPORT_MAKER_MAKER_H

#include "base/text.h"
#include "scene/scene.h"

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
 * agree, no other is tried; if none is it and a texture transform turns the mesh's coordinates, all are tried on
 * those of the file. `halves` [face_count]: enum nt_half; NULL: no quads; `border` as above. `fresh` receives the
 * tangents of the last one that is tried. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_find_maker(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker);

/* Says who it is, if that is known: "MikkTSpace, on quads". */
void nt_maker_text(const nt_maker *maker, nt_buffer *out);

/* Whether it is MikkTSpace, whichever w it has. */
bool nt_maker_is_mikktspace(const nt_maker *maker);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Quads of which a mesh has the halves: bakers solve quads, and files have triangles. The solve takes them
 * (nt_implementation in api/tangents.h); all else keeps to the triangles.
 */
#ifndef NT_REPORT_MAKER_QUADS_H
#define NT_REPORT_MAKER_QUADS_H

#include "api/tangents.h"
#include "scene/scene.h"

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

#endif

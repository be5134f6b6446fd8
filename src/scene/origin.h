/* SPDX-License-Identifier: MIT */
/*
 * Positions that float cannot hold: coordinates of a map projection, or of a scan in them. At 5 400 000 the floats are
 * half a unit apart, so that an edge of 2 cm bends or collapses, and normals and tangents with it.
 *
 * The rule: if rounding to float moves vertices by more than a hundredth of the median edge, positions are stored as
 * float(double - origin), if fewer are moved then; the origin goes into the matrices of the scene's instances. It is
 * the centre of the box of all vertices, rounded to the power of ten that half of the box's longest side has. One file
 * has one origin.
 *
 * A file that needs none of it pays for the largest of its coordinates, and for NT_ORIGIN_TRIED edges. Only if those
 * are suspicious, a reader reads the positions once more, as doubles.
 */
#ifndef NT_SCENE_ORIGIN_H
#define NT_SCENE_ORIGIN_H

#include <math.h>
#include "scene/scene.h"

/* Edges, taken evenly from the faces: so many for the suspicion, and for the median. */
enum { NT_ORIGIN_TRIED = 256, NT_ORIGIN_SAMPLED = 4096 };

/* Positions as the source has them. */
typedef struct nt_exact {
	const double *positions; /* [vertex_count][3] */
	size_t vertex_count;
	double *edges;           /* [edge_count] lengths, in any order, above 0; they are sorted */
	size_t edge_count;
	bool stored;    /* the output has these doubles all the same */
	bool needless;  /* and nothing of it is computed of the floats */
} nt_exact;

/* The larger of `largest` and of the absolute values of some floats. */
float nt_largest_of(const float *values, size_t count, float largest);

/* The length of an edge: in doubles, if there are any. */
double nt_edge_length(const float *positions, const double *exact, size_t a, size_t b);

/* Half of the step between floats at a coordinate: what rounding moves it by at most; 0 of infinity. */
double nt_float_rounding(float largest);

/* Whether the rounding of the largest coordinate is more than a hundredth of the median of some edges. The median may
 * be `doubt` times too long: NT_ORIGIN_DOUBT, if it is of few edges, measured in float. */
enum { NT_ORIGIN_DOUBT = 4 };
bool nt_origin_is_suspected(float largest, const double *edges, size_t edge_count, double doubt);

/* Whether a reader has to read doubles whatever its floats look like. */
static inline bool nt_origin_is_given(const nt_origin *wished)
{
	return wished->choice == NT_ORIGIN_GIVEN && (wished->at[0] != 0 || wished->at[1] != 0 || wished->at[2] != 0);
}

/* Whether the scene's positions are relative to an origin. */
static inline bool nt_scene_has_origin(const nt_scene *scene)
{
	return scene->origin[0] != 0 || scene->origin[1] != 0 || scene->origin[2] != 0;
}

/* The matrix of an instance that stands where the source has it. */
static inline void nt_origin_matrix(const nt_scene *scene, double matrix[16])
{
	for (int i = 0; i < 16; i++)
		matrix[i] = i % 5 == 0;
	for (int i = 0; i < 3; i++)
		matrix[12 + i] = scene->origin[i];
}

/* Follows the rule or the user's wish: sets scene->origin and scene->positions_rounded, stores `positions` anew if
 * there is an origin, and adds POS_ORIGIN and POS_ROUNDED. */
void nt_origin_settle(nt_scene *scene, const nt_origin *wished, const nt_exact *exact, float *positions);

/* Writes an origin as --origin takes it, "431236,5412347,101". */
enum { NT_ORIGIN_TEXT = 96 };
const char *nt_origin_text(const double origin[3], char text[NT_ORIGIN_TEXT]);

#endif

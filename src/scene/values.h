/* SPDX-License-Identifier: MIT */
/*
 * Values on their way between a source and a scene: colours, positions that float cannot hold, polygons, texture
 * coordinates that are transformed, tangents of morph targets.
 */
#ifndef NT_SCENE_VALUES_H
#define NT_SCENE_VALUES_H

#include <math.h>
#include "base/text.h"
#include "scene/scene.h"

/* ---- sRGB and linear light: values.c ---- */

/*
 * OBJ and PLY have colours as they are shown, sRGB; scenes and glTF linear ones. IEC 61966-2-1:
 *
 *     linear = c / 12.92 for c <= 0.04045, else ((c + 0.055) / 1.055)^2.4
 */

/* The linear values of bytes, which most colours are. */
typedef struct nt_srgb {
	float linear[256];
} nt_srgb;

void nt_srgb_init(nt_srgb *srgb);

/* Both ways. Finite values stay finite, at most FLT_MAX either way; others stay as they are. */
float nt_linear_from_srgb(const nt_srgb *srgb, float value);
float nt_srgb_from_linear(float value);

/* The byte that has exactly this linear value; -1: none. */
int nt_srgb_byte(const nt_srgb *srgb, float linear);

/* Makes a colour white that is not finite; whether it was such a one. */
bool nt_color_mend(float color[4]);

/* Makes linear colours of a mesh's [count][4]; alpha stays. Colours that are not finite become white, and a finding. */
void nt_linearise(nt_scene *scene, nt_mesh *mesh, size_t count);

/* ---- positions that float cannot hold: origin.c ---- */

/*
 * Coordinates of a map projection, or of a scan in them. At 5 400 000 the floats are
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

/* ---- polygons of five and more corners: polygon.c ---- */

/*
 * Triangulates one by ear clipping in its own plane.
 *
 *   points     positions
 *   vertices   [count] which of them its corners are, in order; NULL: the first ones
 *   count      at least 3
 *   triangles  [3 * (count - 2)] receives corner numbers of the polygon, each triangle wound as it is
 *   sound      receives false when no proper triangulation was found (self-intersecting, collinear,
 *              not finite): it is then finished somehow, still with count - 2 triangles
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_polygon_triangulate(const float (*points)[3], const uint32_t *vertices, size_t count, uint32_t *triangles,
	bool *sound);

/* ---- texture coordinates as a sampler sees them, which tangents therefore follow: values.c ---- */

/* KHR_texture_transform, or -s and -o of MTL, with v up: (u, v) is scaled, turned counterclockwise, moved. */
typedef struct nt_uv_transform {
	double rotation, scale[2], offset[2];
} nt_uv_transform;

/*
 * Gives a mesh with texcoords its solve_texcoords, in the arena, and solve_sign: scaled and turned, rounded to float
 * once. The offset moves all triangles alike, so that no tangent knows of it.
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_mesh_transform(nt_mesh *mesh, const nt_uv_transform *transform, nt_arena *arena, nt_error *error);

/* ---- tangents that morph targets give to vertices: values.c ---- */

typedef struct nt_morph_tangents {
	uint32_t *class_of; /* [vertex_count + split.source_count] of the mesh; NT_NONE: no corner has the vertex, and
	                       no target turns it */
	uint32_t *parent;   /* [class_count] a smaller number, or itself */
	size_t class_count;
	uint32_t *words;    /* [word_count] of each target: [row_count] classes, unless these are all that it has, then
	                       [row_count][3] floats */
	size_t word_count;
	size_t user_count;  /* meshes that have them, since geometry is shared, and a verification of the output */
	size_t reader_count; /* of these, the ones of the tangent set that is written */
	size_t *rows;       /* while a target of that set is read: as nt_morph_find_rows() has them; NULL: not yet */
} nt_morph_tangents;

/* The tangents of a mesh as its m-th target moves it: [vertex_count + split.source_count][3]. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_morph_read(const nt_mesh *mesh, size_t m, float *tangents);

/* The same by vertex. at: [class_count] receives the word of each class's tangent in the m-th target; SIZE_MAX: it has
 * the base's. */
void nt_morph_find_rows(const nt_mesh *mesh, size_t m, size_t *at);

/* The three floats of a vertex. */
static inline const void *nt_morph_row(const nt_mesh *mesh, const size_t *at, size_t vertex)
{
	const uint32_t k = mesh->morph_tangents->class_of[vertex];
	return k != NT_NONE && at[k] != SIZE_MAX ? (const void *)(mesh->morph_tangents->words + at[k])
						 : mesh->split.vertex_tangents + 4 * vertex;
}

/* Nobody will read targets up to the m-th again: their memory goes. */
void nt_morph_drop(const nt_mesh *mesh, size_t m);

#endif

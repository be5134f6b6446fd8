/* SPDX-License-Identifier: MIT */
/*
 * Shared by the checks of one mesh: the surface, what is known so far, and how occurrences are tallied
 * into findings. A check goes over its elements, tallies what it finds and reports the tally once.
 */
#ifndef NT_REPORT_CHECK_H
#define NT_REPORT_CHECK_H

#include <math.h>
#include "report/report.h"
#include "report/surface/surface.h"

static const double NT_DEGREES = 57.29577951308232; /* of a radian */

/* Whose tangents are checked: the input's, or, on conversion, the result. */
typedef enum nt_stored {
	NT_STORED_NONE,
	NT_STORED_AUTHORED, /* mesh->tangents */
	NT_STORED_CORNERS,  /* mesh->corner_tangents */
	NT_STORED_SPLIT     /* mesh->split.vertex_tangents */
} nt_stored;

/* A side at the rim of an object, its ends ascending by position. across.c */
typedef struct nt_rim_side {
	uint64_t key;            /* of positions and texture coordinates at its ends */
	uint32_t mesh, side, face; /* side: of the mesh as a surface */
	uint32_t ends[2];        /* vertices of the mesh */
	int orientation;         /* of the triangle: 1 or -1 */
} nt_rim_side;

typedef struct nt_rims {
	nt_rim_side *sides;
	size_t count, capacity;
	bool met[2]; /* [orientation > 0] whether a side has it */
} nt_rims;

typedef struct nt_check {
	const nt_scene *scene;
	const nt_report_options *options;
	nt_report *report;
	nt_error *error;          /* of the one check whose faults have words: seams.c */
	size_t *finding_capacity;
	nt_rims *rims;         /* of all objects of an OBJ */
	nt_others *others;     /* of all that are checked */
	nt_scratch *scratch; /* of this mesh */

	uint32_t mesh_index;
	size_t alike;             /* meshes that the findings of this one hold for, itself included */
	bool untextured;          /* all of these are: see nt_mesh */
	const nt_mesh *mesh;
	nt_report_mesh *facts;
	nt_surface surface;
	double total_area;
	nt_stored stored;
	const uint8_t *halves;    /* [triangle_count] enum nt_half: the faces that its tangents are of; NULL:
	                             triangles */
	const uint64_t *elsewhere; /* [corner_count] bits: corners whose tangents are the whole glTF mesh's, of which
	                             this is one primitive; NULL: none */

	/* by edges.c */
	nt_edges boundary, mirrors; /* edges of one side; edges whose triangles are wound differently in UV space */
	nt_edges hard;            /* other normals and the same texture coordinates on both sides */
	uint32_t *islands;        /* [triangle_count] NT_NONE: has no edges */
	uint32_t *patches;        /* [triangle_count] parents of what is connected in UV space and of one orientation;
	                             NULL: there is but one */
	uint64_t *flipped, *twins; /* by flips.c: [triangle_count] bits; NULL: none. Twins are mirrored triangles of
	                             mixed islands that lie point by point on an unmirrored one, in space too */
	bool failed;              /* out of memory while reporting */
} nt_check;

/* Occurrences of one finding. Start with {.code = ...}. */
typedef struct nt_tally {
	nt_code code;
	size_t count;
	unsigned spot_count;
	nt_spot spots[NT_SPOT_COUNT];
	nt_box box;
	nt_number numbers[NT_NUMBER_COUNT];
	unsigned number_count;
	uint32_t seam, island; /* one more than the index; 0: none */
	const char *repair;    /* options that repair this one; NULL: those of the table */
	double rank;           /* among findings of its code: greater ones come first */
	double share;          /* of the mesh that it concerns; 0: as many triangles as it has occurrences */
	double area;           /* for the check alone: of the triangles that it concerns */
} nt_tally;

/* Findings of a check in a part of the mesh. */
enum { NT_PART_TALLIES = 5, NT_PART_SUMS = 9 };
typedef struct nt_part {
	nt_tally tallies[NT_PART_TALLIES];
	double sums[NT_PART_SUMS];
	double greatest[2]; /* -INFINITY at first */
} nt_part;

/* Looks at the items [begin, end). Calls of one slot, which is below the number of threads, follow each other. */
typedef void nt_part_check(void *context, size_t begin, size_t end, unsigned slot, nt_part *part);

/* Calls part_check for parts of `size` of all `count` items, in several threads, with tallies of the codes. `all`
 * receives what they found together, in the order of the parts: threads do not show. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_check_parts(const nt_check *check, size_t count, size_t size, const nt_code *codes, size_t code_count,
	nt_part_check *part_check, void *context, nt_part *all);

/* Each counts one occurrence. value is the number that was checked, or NAN. */
void nt_tally_triangle(const nt_check *check, nt_tally *tally, size_t triangle, double value);
void nt_tally_side(const nt_check *check, nt_tally *tally, uint32_t side, double value);
/* The edge of a triangle of a mesh whose surface is not there. */
void nt_tally_edge(const nt_check *check, nt_tally *tally, uint32_t triangle, uint32_t face, const uint32_t ends[2],
	double value);
void nt_tally_vertex(const nt_check *check, nt_tally *tally, uint32_t vertex, double value);

/* A number behind the finding. */
void nt_tally_number(nt_tally *tally, const char *name, double value);

/* Makes a finding of the tally unless it is empty or ignored. detail_format may be NULL. */
void nt_check_report_as(nt_check *check, const nt_tally *tally, nt_severity severity, const char *detail_format, ...)
	NT_PRINTF(4, 5);

/* The same with the severity of the table. */
#define nt_check_report(check, tally, ...) \
	nt_check_report_as(check, tally, nt_code_info((tally)->code)->severity, __VA_ARGS__)

/* Whether what is judged is what a conversion writes, and in which format it is. */
static inline bool nt_is_written(const nt_check *check)
{
	return check->options->written != NT_FORMAT_UNKNOWN;
}

static inline bool nt_is_gltf(const nt_check *check)
{
	return nt_format_is_gltf(nt_is_written(check) ? check->options->written : check->scene->format);
}

/* The orientation that a triangle has for its surroundings: none where it is flipped. */
static inline int nt_settled_orientation(const nt_check *check, size_t triangle)
{
	return check->flipped && nt_bit(check->flipped, triangle) ? 0 : check->surface.orientation[triangle];
}

/* The orientation that both halves of a folded quad may have: see nt_folded_orientation(). */
int nt_quad_orientation(const nt_check *check, size_t triangle);

static inline bool nt_needs_tangents(const nt_check *check)
{
	return nt_mesh_needs_tangents(check->mesh, nt_is_gltf(check));
}

/* The severity of a finding in texture coordinates: an info if no material needs tangents. */
static inline nt_severity nt_texcoord_severity(const nt_check *check, nt_severity severity)
{
	return nt_needs_tangents(check) ? severity : NT_SEVERITY_INFO;
}

/* The same of a fault in texture coordinates that nobody sees either where it is up to a thousandth of the mesh. */
static inline nt_severity nt_area_severity(const nt_check *check, double area)
{
	const bool small = check->total_area > 0.0 && area <= 0.001 * check->total_area;
	return nt_texcoord_severity(check, small ? NT_SEVERITY_INFO : NT_SEVERITY_WARNING);
}

/* Whether somebody may see a fault of that area. Needles that fill T-junctions are below a hundred-thousandth of the
 * mesh's area; on a texture of 2048 x 2048 that is some forty texels. */
static inline bool nt_is_visible(const nt_check *check, double area)
{
	return area >= 1e-5 * check->total_area;
}

/* The vertex as the source numbers it: copies that making normals appended are mapped back. */
static inline uint32_t nt_source_vertex(const nt_mesh *mesh, uint32_t vertex)
{
	return nt_mesh_pool_vertex(mesh, mesh->vertex_sources && vertex >= mesh->source_vertex_count
		? mesh->vertex_sources[vertex - mesh->source_vertex_count]
		: vertex);
}

/* Texture coordinates as the source has them: v down in glTF. */
static inline void nt_source_texcoord(const nt_scene *scene, const float *texcoord, float out[2])
{
	const bool v_down = nt_format_is_gltf(scene->format);
	out[0] = texcoord[0];
	out[1] = v_down ? 0.0f - texcoord[1] : texcoord[1];
}

/* The same of a range. */
static inline void nt_source_range(const nt_scene *scene, float minimum[2], float maximum[2])
{
	if (nt_format_is_gltf(scene->format)) {
		const float v = minimum[1];
		minimum[1] = 0.0f - maximum[1];
		maximum[1] = 0.0f - v;
	}
}

/* Which of the stored tangents a corner has; the mesh has some. */
static inline size_t nt_tangent_index(const nt_check *check, uint32_t corner)
{
	const nt_mesh *mesh = check->mesh;
	if (check->stored == NT_STORED_SPLIT && mesh->split.indices)
		return mesh->split.indices[corner];
	if (check->stored == NT_STORED_CORNERS)
		return corner;
	return mesh->indices ? mesh->indices[corner] : corner;
}

static inline const float *nt_stored_tangents(const nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	return check->stored == NT_STORED_SPLIT ? mesh->split.vertex_tangents
		: check->stored == NT_STORED_CORNERS ? mesh->corner_tangents
						     : mesh->tangents;
}

/* The tangent that is, or will be, stored for a corner. */
static inline const float *nt_stored_tangent(const nt_check *check, uint32_t corner)
{
	return nt_stored_tangents(check) + 4 * nt_tangent_index(check, corner);
}

/* An edge of a seam as it is seen from a point at one of its ends on. seams.c */
nt_seam_edge nt_describe_edge(const nt_check *check, const nt_edge *edge, uint32_t from);

/* The checks, in the order in which they run. */
nt_status nt_check_geometry(nt_check *check); /* geometry.c: the surface's triangles; positions, normals, UV
                                                 triangles */
nt_status nt_check_edges(nt_check *check);    /* edges.c: boundary, non-manifold, winding, islands' numbers */
nt_status nt_check_islands(nt_check *check);  /* islands.c */
nt_status nt_check_flips(nt_check *check);    /* flips.c: called by islands.c, once islands are measured */
nt_status nt_check_seams(nt_check *check);    /* seams.c */
nt_status nt_check_hard_edges(nt_check *check); /* hard_edges.c */
nt_status nt_check_rims(nt_check *check);     /* across.c */
nt_status nt_check_tangents(nt_check *check); /* tangents.c */
nt_status nt_check_growth(nt_check *check);   /* measures.c: shared and copied vertices */
nt_status nt_check_measures(nt_check *check); /* measures.c: density, stretch, costs */

/* Once all meshes are checked: seams between them. across.c */
nt_status nt_check_across(nt_check *check);

/* findings.c. The digest by which a mesh is known if its name changes: of its triangles in space, whatever their order
 * and numbers. Never 0. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_digest_surface(const nt_surface *surface, nt_scratch *scratch, uint64_t *digest);

/* Ends: most severe first, limits, baseline. findings.c */
nt_status nt_report_complete(nt_report *report, const nt_report_options *options);

/* Adds the findings that the scene's stages made. */
nt_status nt_report_add_findings(nt_check *check, const nt_finding_list *findings);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * nmtan.h - tangent frames for normal-mapped meshes: arrays in, arrays out, no files.
 *
 * nmtan_tangents() computes one tangent per face corner, nmtan_split() says which vertices must be
 * duplicated so that every vertex has one tangent, nmtan_vertex_tangents() does both at once, and
 * nmtan_orientation() tells how a triangle's texture coordinates are wound, exactly.
 *
 * The frame: T is a unit vector along which the texture's u grows, N the corner's normal, and the
 * bitangent is B = cross(N, T) * w with w = +1 or -1. Where the normal agrees with the winding, B
 * runs along growing v. V POINTS UP here, as it does in bakers, OBJ and PLY. Texture coordinates of
 * glTF have v pointing down: pass (u, -v), which is exact, and store the w you get.
 *
 * Results: the default method is byte-identical to MikkTSpace (M. Mikkelsen, "Simulation of Wrinkled
 * Surfaces Revisited", 2008, and the reference implementation, with its edge sort completed) wherever
 * MikkTSpace's answer is usable; where it is not, it is repaired (see nmtan_repair). The same input
 * gives the same bytes on every machine, thread count and instruction set. Not promised: the bits of
 * a NaN, with repair off.
 *
 * Memory: nothing is kept after a call except in a workspace. Outputs belong to the caller. Scratch
 * comes from options->allocator, or malloc; it is released before the call returns unless a workspace
 * keeps it warm.
 *
 * Threads: every function may be called from several threads at once, as long as they do not share
 * outputs or a workspace. There is no global state but a pool of threads: the first call that is large enough
 * for options->threads > 1 makes them, later calls in any thread share them, and they sleep in between, with
 * signals blocked. Where none can be made the caller's thread does all. Processes made by fork() may go on
 * calling, whatever their parent was doing.
 *
 * Errors: a status, never an exit, never a message on a stream. After an error the contents of the
 * outputs are unspecified.
 */
#ifndef NMTAN_H
#define NMTAN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NMTAN_VERSION_MAJOR 0
#define NMTAN_VERSION_MINOR 1
#define NMTAN_VERSION_PATCH 0
#define NMTAN_VERSION_STRING "0.1.0"

/* Symbols that the shared library exports. */
#if defined(__GNUC__)
#define NMTAN_API __attribute__((visibility("default")))
#else
#define NMTAN_API
#endif

/* What a call reports. */
typedef enum nmtan_status {
	NMTAN_OK = 0,
	NMTAN_ERROR_ARGUMENT,    /* a required pointer is NULL, a stride or an enum is out of range */
	NMTAN_ERROR_INDEX,       /* an index is not below vertex_count */
	NMTAN_ERROR_FACE_SIZE,   /* a face has neither 3 nor 4 corners */
	NMTAN_ERROR_TOO_LARGE,   /* more than NMTAN_MAX_FACES faces, or a size overflows size_t */
	NMTAN_ERROR_MEMORY       /* the allocator returned NULL */
} nmtan_status;

/* Static English text for a status, "unknown status" for any other number. Never NULL. */
NMTAN_API const char *nmtan_status_text(nmtan_status status);

/* Version of the library that runs, as "0.1.0". */
NMTAN_API const char *nmtan_version(void);

/* Faces of one mesh: 2^29 - 1, the limit of MikkTSpace's corner numbers (face * 4 + corner). */
#define NMTAN_MAX_FACES ((size_t)536870911)

/*
 * For callers that store other texture coordinates than they pass in. What a renderer reads from the file
 * decides which way a triangle is wound; where rounding or a transform lies between that and
 * nmtan_mesh.texcoords, a very thin triangle may be wound differently. Repair then takes the sign of w from
 * the coordinates described here. Nothing else uses them.
 */
typedef struct nmtan_stored_uv {
	/* The float v + v_offset is stored. OBJ's v becomes 1 - v in glTF, which is -(v - 1): -1. The v that was
	 * negated for glTF becomes 1 + v in PLY: 1. 0: v as it stands. Finite. */
	float v_offset;
	/* For texcoords that a transform has scaled and turned (KHR_texture_transform): the coordinates before it, which
	 * the file holds; v_offset applies to these. NULL: nmtan_mesh.texcoords. */
	const float *texcoords; /* [vertex_count][2], v up, tightly packed */
	int mirrored;           /* not 0: the transform reverses the orientation of `texcoords` */
} nmtan_stored_uv;

/*
 * A mesh: faces of 3 or 4 corners over vertices. Corner c of the mesh is corner c - first(f) of its
 * face f, where first(f) is the sum of the sizes of the faces before f; without face_sizes corner
 * 3 * f + k is corner k of triangle f.
 *
 * Attribute arrays hold vertex_count rows; stride_bytes is the distance between rows, a multiple of
 * 4 and at least the row's size; 0 means tightly packed. Any float value is accepted, NaN and
 * infinities too. Normals are used as given and should have unit length.
 */
typedef struct nmtan_mesh {
	size_t face_count;         /* 0 is allowed */
	size_t vertex_count;       /* at most 2^32 - 1 */
	const uint8_t *face_sizes; /* [face_count], each 3 or 4; NULL: all faces are triangles */
	const uint32_t *indices;   /* [corner count] vertex of each corner; NULL: corner c is vertex c */

	const float *positions; /* [vertex_count][3], required */
	size_t position_stride_bytes;
	const float *normals; /* [vertex_count][3], required */
	size_t normal_stride_bytes;
	const float *texcoords; /* [vertex_count][2], v up, required */
	size_t texcoord_stride_bytes;

	const nmtan_stored_uv *stored; /* NULL: texture coordinates are stored as they stand here */
} nmtan_mesh;

/* How the triangles around a vertex are averaged. */
typedef enum nmtan_method {
	NMTAN_METHOD_MIKKTSPACE = 0, /* the standard: angle weights, groups by orientation */
	NMTAN_METHOD_AREA,           /* all triangles of one orientation at a vertex, weighted by corner
	                                angle times the two edge lengths: thin bevels do not tilt the
	                                large faces beside them */
	NMTAN_METHOD_LENGYEL,        /* the same triangles, dP/du added as it is: E. Lengyel, "Computing
	                                Tangent Space Basis Vectors for an Arbitrary Mesh", 2001 */
	NMTAN_METHOD_ROBUST          /* the same triangles with MikkTSpace's angle weights, without
	                                rounding: exact differences and products, sums in double. Each
	                                component of T is within 2^-23 of the exact value of the
	                                formula, but for counts.ill_conditioned corners */
} nmtan_method;

/* What happens to results that a renderer cannot use. */
typedef enum nmtan_repair {
	NMTAN_REPAIR_ON = 0, /* tangents that no triangle gave, that are zero, not unit, not finite, more than
	                        2^-10 off perpendicular to a normal of unit length (|n|^2 within 2^-11 of 1)
	                        or parallel to any other, and w that differs within a triangle or from the
	                        exact orientation are replaced by the nearest usable answer, and counted */
	NMTAN_REPAIR_OFF     /* the method's raw result */
} nmtan_repair;

/* The caller's allocator. Blocks are aligned for any C type, as malloc's are. */
typedef struct nmtan_allocator {
	void *(*allocate)(void *user, size_t size_bytes);           /* NULL result: out of memory */
	void (*release)(void *user, void *block, size_t size_bytes); /* block is never NULL */
	void *user;
} nmtan_allocator;

/* Scratch memory that stays warm between calls. One call at a time may use a workspace. */
typedef struct nmtan_workspace nmtan_workspace;

/* A new, empty workspace that grows on use. allocator may be NULL (malloc) and is copied.
 * Returns NULL when memory is exhausted. */
NMTAN_API nmtan_workspace *nmtan_workspace_create(const nmtan_allocator *allocator);

/* Frees a workspace; NULL is allowed. */
NMTAN_API void nmtan_workspace_destroy(nmtan_workspace *workspace);

/* Where the time of a call went, in seconds of the wall clock. */
typedef struct nmtan_timing {
	double weld;  /* finding equal vertices; 0 where the method does not tell */
	double solve; /* the rest of the method, and repair */
	double split; /* nmtan_vertex_tangents() only */
} nmtan_timing;

/* Options. All zero means the defaults; a NULL pointer to options means the same. */
typedef struct nmtan_options {
	nmtan_method method;
	nmtan_repair repair;
	float angular_threshold_degrees;  /* MikkTSpace's, in (0, 180]; 0: 180, its default. The other
	                                     methods ignore it */
	unsigned threads;                 /* 0: one per processor. Small meshes use one thread anyway */
	const nmtan_allocator *allocator; /* NULL: malloc and free. Ignored when a workspace is given */
	nmtan_timing *timing;             /* NULL, or where nmtan_tangents() and nmtan_vertex_tangents()
	                                     add what their steps took */
	nmtan_workspace *workspace;       /* NULL: scratch is allocated and released by the call */
} nmtan_options;

/* What a solve met and what repair did, in corners unless it says faces. */
typedef struct nmtan_counts {
	size_t degenerate_positions; /* faces with two corners at one position in each half */
	size_t degenerate_texcoords; /* triangles whose exact UV determinant is zero */
	size_t mirrored;             /* triangles whose exact UV determinant is negative (v up) */
	size_t stored_differently;   /* triangles whose orientation changes when v is stored (see
	                                nmtan_stored_uv) */
	size_t folded_quads;         /* quads whose two halves are wound differently in UV space */
	size_t repaired_zero;        /* tangents that were zero or not of unit length */
	size_t repaired_not_finite;
	size_t repaired_parallel;    /* tangents that were parallel to their normal */
	size_t repaired_sign;        /* w changed to the exact orientation or to agree in its triangle */
	size_t repaired_unassigned;  /* corners to which no triangle gave a tangent: MikkTSpace leaves (1, 0, 0)
	                                there */
	size_t repaired_leaning;     /* tangents more than 2^-10 off perpendicular to a normal of unit length */
	size_t ill_conditioned;      /* robust: tangents for which more than 24 bits cancel, in the sum or
	                                because dP/du runs along the normal. They are unit and
	                                perpendicular like all others, their direction is as good as
	                                double arithmetic makes it */
} nmtan_counts;

/* Where results go. Each array has one row per corner, tightly packed. */
typedef struct nmtan_output {
	float *tangents;   /* [corner count][4], required: T and w */
	float *bitangents; /* [corner count][3], may be NULL: MikkTSpace's own bitangent (unit dP/dv,
	                      not cross(N, T) * w); cross(N, T) * w with the other methods and at repaired
	                      corners */
	float *magnitudes; /* [corner count][2], may be NULL: lengths of dP/du and dP/dv as MikkTSpace
	                      reports them; 1 with the other methods and at repaired corners */
} nmtan_output;

/*
 * Computes a tangent for every corner of the mesh.
 *
 *   mesh     required
 *   options  NULL for defaults
 *   output   required; tangents must have room for 4 floats per corner
 *   counts   may be NULL; written by the call
 *
 * Time is linear in the number of corners, whatever the mesh looks like.
 *
 * Returns NMTAN_OK, NMTAN_ERROR_ARGUMENT, NMTAN_ERROR_INDEX, NMTAN_ERROR_FACE_SIZE,
 * NMTAN_ERROR_TOO_LARGE or NMTAN_ERROR_MEMORY.
 */
NMTAN_API nmtan_status nmtan_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nmtan_output *output, nmtan_counts *counts);

/* Where a split goes. */
typedef struct nmtan_split_output {
	uint32_t *indices;    /* [corner count], required: the vertex of each corner after the split. May
	                         be the array that mesh->indices points to */
	uint32_t *sources;    /* [source_capacity]: sources[i] is the vertex of which vertex
	                         vertex_count + i is a copy. Never more than the corner count */
	size_t source_capacity;
	size_t source_count;  /* written by the call: how many vertices were appended */
	float *vertex_tangents; /* [(vertex_count + source_capacity)][4], may be NULL: the tangent of each
	                           vertex after the split. A vertex without corners gets a unit vector
	                           perpendicular to its normal and w = 1 */
} nmtan_split_output;

/*
 * Finds the vertices whose corners have different tangents and gives each further tangent a copy of
 * the vertex. The tangent of a vertex's first corner keeps its index; copies are appended in corner
 * order. Two tangents are the same when their four floats are equal (0 equals -0) or have equal bits.
 *
 *   mesh      required; texcoords may be NULL, normals too where vertex_tangents is NULL
 *   tangents  [corner count][4], required
 *   options   NULL for defaults; allocator and workspace are used
 *   output    required
 *
 * Returns the statuses of nmtan_tangents(), and NMTAN_ERROR_TOO_LARGE when the copies exceed
 * source_capacity or 2^32 - 1 vertices.
 */
NMTAN_API nmtan_status nmtan_split(const nmtan_mesh *mesh, const float *tangents,
	const nmtan_options *options, nmtan_split_output *output);

/*
 * nmtan_tangents() and nmtan_split() in one: the same result in less time and memory, for callers that
 * want vertices.
 *
 *   mesh     required
 *   options  NULL for defaults
 *   output   required; vertex_tangents too. indices may not be the array that mesh->indices points to
 *   counts   may be NULL; written by the call
 *
 * Returns the statuses of nmtan_split().
 */
NMTAN_API nmtan_status nmtan_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	nmtan_split_output *output, nmtan_counts *counts);

/*
 * The exact sign of the determinant (b - a) x (c - a) of three texture coordinates: +1 where they are
 * wound counterclockwise (v up), -1 where clockwise (mirrored), 0 where they are collinear or one of
 * them is not finite. No rounding is involved.
 */
NMTAN_API int nmtan_orientation(const float a[2], const float b[2], const float c[2]);

#ifdef __cplusplus
}
#endif
#endif

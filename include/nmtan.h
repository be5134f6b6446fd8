/* SPDX-License-Identifier: MIT */
/*
 * nmtan.h - tangent frames for normal-mapped meshes: arrays in, arrays out, no files. C11 and C++17.
 *
 * A triangle as glTF has it, v pointing down, in interleaved vertices:
 *
 *     struct vertex {
 *         float position[3], normal[3], texcoord[2];
 *     } vertices[] = {{{0, 0, 0}, {0, 0, 1}, {0, 1}}, {{1, 0, 0}, {0, 0, 1}, {1, 1}}, {{1, 1, 0}, {0, 0, 1}, {1, 0}}};
 *     uint32_t triangles[] = {0, 1, 2}, indices[3], sources[3];
 *     float tangents[3 + 3][4];
 *     nmtan_mesh mesh = NMTAN_MESH_INIT;
 *     mesh.face_count = 1; mesh.vertex_count = 3; mesh.indices = triangles; mesh.v_down = 1;
 *     mesh.positions = vertices->position; mesh.normals = vertices->normal; mesh.texcoords = vertices->texcoord;
 *     mesh.position_stride_bytes = mesh.normal_stride_bytes = mesh.texcoord_stride_bytes = sizeof *vertices;
 *     nmtan_split_output output = NMTAN_SPLIT_OUTPUT_INIT;
 *     output.indices = indices; output.sources = sources; output.source_capacity = 3;
 *     output.vertex_tangents = tangents[0];
 *     nmtan_status status = nmtan_vertex_tangents(&mesh, NULL, &output, NULL);
 *
 * Each vertex has a tangent now: T, of unit length, along which u grows, and w = +1 or -1. The bitangent is
 * B = cross(N, T) * w. Here T is (1, 0, 0) and w is 1. If corners of one vertex need different tangents, as at the
 * edge of mirrored texture, the vertex is copied: output.source_count says how many copies are appended, `sources` of
 * which vertices they are, and `indices` uses them. Append the same copies to all your vertices: nmtan_copy_rows().
 * If vertices have room for their tangents, nmtan_generate() does all of it in place.
 *
 * V POINTS UP unless mesh.v_down says that it points down: up in bakers, OBJ and PLY, down in glTF and most engines'
 * files. Whichever it is, B then runs along growing v of v up, as MikkTSpace, glTF and bakers of normal maps mean it
 * ("green up"); for maps with green down negate w.
 *
 * nmtan_vertex_tangents() gives tangents of vertices, nmtan_tangents() those of the corners of faces; nmtan_split()
 * leads from the second to the first. The end says what all promise: bytes, structs, memory, threads, errors.
 */
#ifndef NMTAN_H
#define NMTAN_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

/* Functions of this header alone, over those of the library. */
#define NMTAN_INLINE static inline

/* Described further down; the first example needs none of them. */
typedef struct nmtan_stored_uv nmtan_stored_uv;
typedef struct nmtan_options nmtan_options;
typedef struct nmtan_counts nmtan_counts;

/* ---- a mesh, and tangents for its vertices ---- */

/* Faces of one mesh: 2^29 - 1, the limit of MikkTSpace's corner numbers (face * 4 + corner). */
#define NMTAN_MAX_FACES ((size_t)536870911)

/*
 * A mesh: faces of 3 or 4 corners over vertices. Corner c of the mesh is corner c - first(f) of its
 * face f, where first(f) is the sum of the sizes of the faces before f; without face_sizes corner
 * 3 * f + k is corner k of triangle f.
 *
 * Attribute arrays hold vertex_count rows; stride_bytes is the distance between rows, a multiple of
 * 4 and at least the row's size; 0 means tightly packed. Any float value is accepted, NaN and
 * infinities too. Normals are used as given and should have unit length: counts.normals_not_unit.
 *
 * OBJ, FBX and USD number normals and texture coordinates apart from positions. If normal_count or texcoord_count is
 * not 0, that array has so many rows of its own, and corner c has row normal_indices[c] of it, or row c where that is
 * NULL; `indices` and vertex_count are those of positions. Vertices come into being then: each combination of rows that
 * a corner uses is one, and mesh->stored may have no texcoords.
 *
 * With repair all corners of a quad have one w, the sign of its UV area. Both triangles of a quad have this sign,
 * unless its outline crosses itself in UV space or is concave there and cut along the outer diagonal: then the
 * smaller one needs the other sign, and nmtan_orientation() tells.
 */
typedef struct nmtan_mesh {
	size_t struct_bytes;       /* sizeof(nmtan_mesh): see "Structs" */
	size_t face_count;         /* 0 is allowed */
	size_t vertex_count;       /* at most 2^32 - 1 */
	const uint8_t *face_sizes; /* [face_count], each 3 or 4; NULL: all faces are triangles */
	const uint32_t *indices;   /* [corner count] vertex of each corner; NULL: corner c is vertex c */

	const float *positions; /* [vertex_count][3], required */
	size_t position_stride_bytes;
	const float *normals; /* [vertex_count][3], required */
	size_t normal_stride_bytes;
	const float *texcoords; /* [vertex_count][2], required */
	size_t texcoord_stride_bytes;

	const nmtan_stored_uv *stored; /* NULL, for nearly all callers: texcoords are stored as they stand */

	size_t v_down;              /* 0: v points up in texcoords; 1: down, as in glTF */
	const uint16_t *indices16;  /* [corner count], in the place of `indices`; NULL: there are none */
	const uint32_t *normal_indices;   /* [corner count] row of normals of each corner; NULL: see above */
	const uint32_t *texcoord_indices; /* [corner count] row of texcoords of each corner */
	size_t normal_count;        /* rows of normals; 0: one for each vertex */
	size_t texcoord_count;      /* rows of texcoords; 0: one for each vertex */
} nmtan_mesh;

#define NMTAN_MESH_INIT \
	{sizeof(nmtan_mesh), 0, 0, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, NULL, 0, NULL, NULL, NULL, 0, 0}

/* The result of a call. Later versions may add values. */
typedef enum nmtan_status {
	NMTAN_OK = 0,
	NMTAN_ERROR_ARGUMENT,  /* a required pointer is NULL; a struct_bytes, a stride, an enum or a number
	                          is out of range; members contradict each other */
	NMTAN_ERROR_INDEX,     /* an index is not below the count of its rows, or without indices there are more
	                          corners than rows */
	NMTAN_ERROR_FACE_SIZE, /* a face has neither 3 nor 4 corners */
	NMTAN_ERROR_TOO_LARGE, /* more than NMTAN_MAX_FACES faces or 2^32 - 1 vertices, with copies too */
	NMTAN_ERROR_MEMORY,    /* the allocator returned NULL, or a size overflows size_t */
	NMTAN_ERROR_CAPACITY   /* source_capacity is too small; source_count is what is needed */
} nmtan_status;

/* Static English text for a status, "unknown status" for any other number. Never NULL. */
NMTAN_API const char *nmtan_status_text(nmtan_status status);

/* Outputs of a split. Nothing is appended past source_capacity; the corner count is always enough. If the mesh has
 * corners alone (see nmtan_mesh) the call makes all vertices: vertex_count counts as 0 here, sources[i] is a corner
 * that vertex i stands for, `indices` is required, copy_counts must be NULL. */
typedef struct nmtan_split_output {
	size_t struct_bytes;  /* sizeof(nmtan_split_output): see "Structs" */
	uint32_t *indices;    /* [corner count]: the vertex of each corner after the split. NULL: no vertex is
	                         split, each has the tangent of its first corner, and what would have been
	                         needed is counted; sources must be NULL then, and source_capacity 0 */
	uint32_t *sources;    /* [source_capacity]: sources[i] is the vertex of which vertex
	                         vertex_count + i is a copy. May be NULL where source_capacity is 0 */
	size_t source_capacity;
	size_t source_count;  /* written by the call: how many vertices were appended; also with
	                         NMTAN_ERROR_CAPACITY, which leaves all else unspecified */
	float *vertex_tangents; /* [vertex_count + source_capacity][4]: the tangent of each vertex after the
	                           split. A vertex without corners gets a unit vector perpendicular to its
	                           normal and w = 1. Required, but for nmtan_split() */
	uint32_t *copy_counts;  /* [vertex_count], may be NULL: how many copies each vertex gets */
	size_t vertex_tangent_stride_bytes; /* from one row of vertex_tangents to the next; 0: tightly packed. If the
	                           tangents lie in your vertices, those of copies are in place already, and copying
	                           whole vertices would overwrite them: use nmtan_copy_rows() */
	size_t split_count;     /* written by the call: vertices whose corners have different tangents */
} nmtan_split_output;

#define NMTAN_SPLIT_OUTPUT_INIT {sizeof(nmtan_split_output), NULL, NULL, 0, 0, NULL, NULL, 0, 0}

/*
 * Computes a tangent for every vertex of the mesh, and finds the vertices that must be copied: nmtan_tangents()
 * and nmtan_split() in one, with the same result in less time and memory.
 *
 *   mesh     required
 *   options  NULL for defaults
 *   output   required; output->vertex_tangents too. output->indices may not be the array that mesh->indices
 *            points to
 *   counts   may be NULL
 *
 * Returns NMTAN_OK, NMTAN_ERROR_ARGUMENT, NMTAN_ERROR_INDEX, NMTAN_ERROR_FACE_SIZE, NMTAN_ERROR_TOO_LARGE,
 * NMTAN_ERROR_MEMORY or NMTAN_ERROR_CAPACITY.
 */
NMTAN_API nmtan_status nmtan_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	nmtan_split_output *output, nmtan_counts *counts);

/* ---- interleaved vertices, in place ---- */

/*
 * Appends copies of rows, after a split: row `row_count + i` becomes a copy of row sources[i], but for kept_bytes bytes
 * from kept_offset on, which stay as they are. These are the tangents, if the split has written them into the rows:
 * a copy has another tangent than its source. kept_bytes 0: whole rows are copied, of any other array of your vertices.
 *
 *   rows         room for row_count + source_count rows of stride_bytes bytes
 *   row_count    of vertices before the split
 *   sources      [source_count] nmtan_split_output.sources
 */
NMTAN_INLINE void nmtan_copy_rows(void *rows, size_t stride_bytes, size_t row_count, const uint32_t *sources,
	size_t source_count, size_t kept_offset, size_t kept_bytes)
{
	const size_t rest = kept_bytes ? kept_offset + kept_bytes : 0;
	unsigned char *to = (unsigned char *)rows + row_count * stride_bytes;
	for (size_t i = 0; i < source_count; i++, to += stride_bytes) {
		const unsigned char *from = (const unsigned char *)rows + sources[i] * stride_bytes;
		if (kept_bytes)
			memcpy(to, from, kept_offset);
		memcpy(to + rest, from + rest, stride_bytes - rest);
	}
}

/* Layout of a vertex: offsets in bytes, multiples of 4 as the stride. Its other bytes are copied with it. This
 * struct does not grow. */
typedef struct nmtan_layout {
	size_t stride_bytes;
	size_t position_offset; /* float[3] */
	size_t normal_offset;   /* float[3], of unit length */
	size_t texcoord_offset; /* float[2] */
	size_t tangent_offset;  /* float[4], written: T and w */
	size_t v_down;          /* 0: v points up in texture coordinates; 1: down, as in glTF */
} nmtan_layout;

/*
 * Computes a tangent for every vertex, in place, and appends the vertices that have to be copied; `indices` then uses
 * the copies.
 *
 *   layout           required
 *   vertices         room for vertex_capacity of them, of which vertex_count are there; an address that floats may have
 *   vertex_capacity  vertex_count and a tenth more is enough for most meshes, vertex_count + index_count for all
 *   indices          [index_count] three for each triangle; NULL: vertices 3 * t to 3 * t + 2 are triangle t, none is
 *                    copied, and index_count is not used
 *   options          NULL for defaults
 *
 * Returns how many vertices there are now. If that is above vertex_capacity, so many are needed: tangents are
 * unspecified, all else is as it was. 0: there are no vertices, or it failed: an argument is wrong (a required pointer,
 * an index, an offset beyond the stride, a count that is no multiple of 3), or memory is exhausted;
 * nmtan_vertex_tangents() tells which. Memory comes from malloc: 4 bytes for each index and each copy.
 */
NMTAN_INLINE size_t nmtan_generate(const nmtan_layout *layout, void *vertices, size_t vertex_count,
	size_t vertex_capacity, uint32_t *indices, size_t index_count, const nmtan_options *options)
{
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	nmtan_split_output output = NMTAN_SPLIT_OUTPUT_INIT;
	const size_t corners = indices ? index_count : vertex_count;
	if (!layout || !vertices || vertex_capacity < vertex_count || corners % 3 || corners > SIZE_MAX / 16 ||
		layout->stride_bytes < 16 || layout->position_offset > layout->stride_bytes - 12 ||
		layout->normal_offset > layout->stride_bytes - 12 ||
		layout->texcoord_offset > layout->stride_bytes - 8 ||
		layout->tangent_offset > layout->stride_bytes - 16 ||
		((layout->position_offset | layout->normal_offset | layout->texcoord_offset |
			layout->tangent_offset) & 3))
		return 0;
	unsigned char *bytes = (unsigned char *)vertices;
	mesh.face_count = corners / 3;
	mesh.vertex_count = vertex_count;
	mesh.indices = indices;
	mesh.positions = (const float *)(const void *)(bytes + layout->position_offset);
	mesh.normals = (const float *)(const void *)(bytes + layout->normal_offset);
	mesh.texcoords = (const float *)(const void *)(bytes + layout->texcoord_offset);
	mesh.position_stride_bytes = mesh.normal_stride_bytes = mesh.texcoord_stride_bytes = layout->stride_bytes;
	mesh.v_down = layout->v_down;
	output.vertex_tangents = (float *)(void *)(bytes + layout->tangent_offset);
	output.vertex_tangent_stride_bytes = layout->stride_bytes;
	const size_t room = vertex_capacity - vertex_count;
	output.source_capacity = !indices ? 0 : room < corners ? room : corners;
	uint32_t *own = NULL;
	if (indices) {
		own = (uint32_t *)malloc((corners + output.source_capacity + 1) * sizeof *own);
		if (!own)
			return 0;
		output.indices = own;
		output.sources = own + corners;
	}
	const nmtan_status status = nmtan_vertex_tangents(&mesh, options, &output, NULL);
	if (!status && own) {
		nmtan_copy_rows(vertices, layout->stride_bytes, vertex_count, output.sources, output.source_count,
			layout->tangent_offset, 4 * sizeof(float));
		memcpy(indices, own, corners * sizeof *indices);
	}
	free(own);
	return !status || status == NMTAN_ERROR_CAPACITY ? vertex_count + output.source_count : 0;
}

/* ---- options, and what is counted ---- */

/* How the triangles around a vertex are averaged. */
typedef enum nmtan_method {
	NMTAN_METHOD_MIKKTSPACE = 0, /* the standard: angle weights, groups by orientation */
	NMTAN_METHOD_AREA,           /* all triangles of one orientation at a vertex, weighted by corner
	                                angle times the two edge lengths: thin bevels do not tilt the
	                                large faces beside them */
	NMTAN_METHOD_LENGYEL,        /* the same triangles, dP/du added as it is: E. Lengyel, "Computing
	                                Tangent Space Basis Vectors for an Arbitrary Mesh", 2001 */
	NMTAN_METHOD_ROBUST,         /* the same triangles with MikkTSpace's angle weights, without
	                                rounding: exact differences and products, sums in double. Each
	                                component of T is within 2^-23 of the exact value of the
	                                formula, but for counts.ill_conditioned corners */
	NMTAN_METHOD_MIKKTSPACE_SORTED /* MikkTSpace with its sort of edges completed, as Blender's and three.js's
	                                rewrites have it: see "Results" */
} nmtan_method;

/* Treatment of results that a renderer cannot use. */
typedef enum nmtan_repair {
	NMTAN_REPAIR_ON = 0, /* tangents that no triangle gave, that are zero, not unit, not finite, more than
	                        2^-10 off perpendicular to a normal of unit length (|n|^2 within 2^-11 of 1)
	                        or parallel to any other, and w that differs within a triangle or from the
	                        exact orientation are replaced by the nearest usable answer, and counted */
	NMTAN_REPAIR_OFF     /* the method's raw result */
} nmtan_repair;

typedef struct nmtan_allocator nmtan_allocator;
typedef struct nmtan_timing nmtan_timing;
typedef struct nmtan_workspace nmtan_workspace;
typedef struct nmtan_jobs nmtan_jobs;

/* If a function takes a pointer to options, NULL means the defaults, which are all zero. */
typedef struct nmtan_options {
	size_t struct_bytes;              /* sizeof(nmtan_options): see "Structs" */
	nmtan_method method;
	nmtan_repair repair;
	float angular_threshold_degrees;  /* MikkTSpace's, in (0, 180]; 0: 180, its default. The other
	                                     methods ignore it */
	unsigned threads;                 /* 0: one per processor. Small meshes use one thread anyway */
	const nmtan_allocator *allocator; /* NULL: malloc and free. Ignored when a workspace is given */
	nmtan_timing *timing;             /* NULL, or where nmtan_tangents() and nmtan_vertex_tangents()
	                                     add what their steps took */
	nmtan_workspace *workspace;       /* NULL: scratch is allocated and released by the call */
	const nmtan_jobs *jobs;           /* NULL: threads of the library's own. Else the caller's */
} nmtan_options;

#define NMTAN_OPTIONS_INIT \
	{sizeof(nmtan_options), NMTAN_METHOD_MIKKTSPACE, NMTAN_REPAIR_ON, 0.0f, 0, NULL, NULL, NULL, NULL}

/* Counts of a solve and its repair, in corners unless it says otherwise. Each call writes it anew. */
typedef struct nmtan_counts {
	size_t struct_bytes;         /* sizeof(nmtan_counts): see "Structs" */
	size_t degenerate_positions; /* faces each triangle of which has two corners at one position */
	size_t degenerate_texcoords; /* triangles whose exact UV determinant is zero */
	size_t mirrored;             /* triangles whose exact UV determinant is negative (v up); of quads those into
	                                which MikkTSpace cuts them */
	size_t stored_differently;   /* triangles whose orientation changes when v is stored (see
	                                nmtan_stored_uv) */
	size_t folded_quads;         /* quads whose outline crosses itself in UV space: cut along either diagonal,
	                                their triangles are wound differently */
	size_t repaired_zero;        /* tangents that were zero or not of unit length */
	size_t repaired_not_finite;
	size_t repaired_parallel;    /* tangents that were parallel to their normal */
	size_t repaired_sign;        /* w changed to the exact orientation or to agree in its triangle */
	size_t repaired_unassigned;  /* corners to which no triangle gave a tangent: MikkTSpace leaves (1, 0, 0)
	                                there */
	size_t repaired_leaning;     /* tangents more than 2^-10 off perpendicular to a normal of unit length */
	size_t ill_conditioned;      /* robust: tangents for which more than 24 bits cancel, in the sum, in an
	                                angle that turns it or because dP/du runs along the normal. They
	                                are unit and perpendicular like all others, their direction is as
	                                good as double arithmetic makes it */
	size_t sorted_instead;       /* 1: the default method gave what NMTAN_METHOD_MIKKTSPACE_SORTED gives, since
	                                the mesh is beyond the limits of "Results" */
	size_t summed_instead;       /* with repair, MikkTSpace's methods: corners of hubs past the bound of
	                                "Work" */
	size_t normals_not_unit;     /* vertices with |n|^2 not within 2^-11 of 1: with repair T is within 2^-10 of
	                                perpendicular to all other normals; to these it is only known not
	                                to be parallel */
} nmtan_counts;

#define NMTAN_COUNTS_INIT {sizeof(nmtan_counts), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}

/* ---- tangents of corners ---- */

/* Bits of nmtan_output.corner_faults. A corner that was repaired has exactly one of the first six, the reason, and
 * may have one of the others. */
typedef enum nmtan_fault {
	NMTAN_FAULT_ZERO = 1,        /* counts.repaired_zero corners have it, and so on */
	NMTAN_FAULT_NOT_FINITE = 2,  /* repaired_not_finite */
	NMTAN_FAULT_PARALLEL = 4,    /* repaired_parallel */
	NMTAN_FAULT_SIGN = 8,        /* repaired_sign */
	NMTAN_FAULT_UNASSIGNED = 16, /* repaired_unassigned */
	NMTAN_FAULT_LEANING = 32,    /* repaired_leaning */
	NMTAN_FAULT_NO_AVERAGE = 64, /* repaired, and the triangles of its orientation around it have no average: the
	                                direction is that of a neighbour, or any across the normal */
	NMTAN_FAULT_ILL_CONDITIONED = 128, /* ill_conditioned; only with the robust method, also with repair off */
	NMTAN_FAULT_SUMMED = 128     /* summed_instead; only with MikkTSpace's methods: the same bit */
} nmtan_fault;

/* Outputs of a solve. Each array has one row per corner, tightly packed, but for tangents with a stride. */
typedef struct nmtan_output {
	size_t struct_bytes; /* sizeof(nmtan_output): see "Structs" */
	float *tangents;     /* [corner count][4], required: T and w */
	float *bitangents;   /* [corner count][3], may be NULL: MikkTSpace's own bitangent (unit dP/dv,
	                        not cross(N, T) * w); cross(N, T) * w with the other methods and at repaired
	                        corners */
	float *magnitudes;   /* [corner count][2], may be NULL: lengths of dP/du and dP/dv as MikkTSpace
	                        reports them; 1 with the other methods and at repaired corners */
	uint8_t *corner_faults; /* [corner count], may be NULL: bits of nmtan_fault, what was wrong with each corner;
	                           0: nothing, and with the default method the bytes are MikkTSpace's */
	size_t tangent_stride_bytes; /* from one row of tangents to the next; 0: tightly packed */
} nmtan_output;

#define NMTAN_OUTPUT_INIT {sizeof(nmtan_output), NULL, NULL, NULL, NULL, 0}

/*
 * Computes a tangent for every corner of the mesh.
 *
 *   mesh     required
 *   options  NULL for defaults
 *   output   required; output->tangents too
 *   counts   may be NULL
 *
 * Returns NMTAN_OK, NMTAN_ERROR_ARGUMENT, NMTAN_ERROR_INDEX, NMTAN_ERROR_FACE_SIZE,
 * NMTAN_ERROR_TOO_LARGE or NMTAN_ERROR_MEMORY.
 */
NMTAN_API nmtan_status nmtan_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nmtan_output *output, nmtan_counts *counts);

/*
 * Finds the vertices whose corners have different tangents and gives each further tangent a copy of
 * the vertex. The tangent of a vertex's first corner keeps its index; copies are appended in corner
 * order. Two tangents are the same when their four floats are equal (0 equals -0) or both NaN.
 *
 *   mesh      required; positions and texcoords may be NULL, normals too where vertex_tangents is NULL
 *   tangents  [corner count][4], tightly packed, required
 *   options   NULL for defaults; allocator and workspace are used
 *   output    required; its indices may be the array that mesh->indices points to
 *
 * Time is linear in the number of corners and copies. Returns the statuses of nmtan_vertex_tangents().
 */
NMTAN_API nmtan_status nmtan_split(const nmtan_mesh *mesh, const float *tangents,
	const nmtan_options *options, nmtan_split_output *output);

/*
 * The exact sign of the determinant (b - a) x (c - a) of three texture coordinates: +1 where they are
 * wound counterclockwise (v up), -1 where clockwise (mirrored), 0 where they are collinear or one of
 * them is not finite. No rounding is involved.
 */
NMTAN_API int nmtan_orientation(const float a[2], const float b[2], const float c[2]);

/* ---- memory, threads, time ---- */

/* The caller's allocator. Both functions are required; blocks are aligned for any C type, as malloc's are.
 * Only the thread that makes the call calls them. This struct does not grow. */
typedef struct nmtan_allocator {
	void *(*allocate)(void *user, size_t size_bytes);           /* NULL result: out of memory */
	void (*release)(void *user, void *block, size_t size_bytes); /* block is never NULL */
	void *user;
} nmtan_allocator;

/* A new, empty workspace: scratch memory that is kept between calls, grows on use, and that one call at a time may use.
 * allocator may be NULL (malloc) and is copied; what its `user` points to must outlive the workspace. Returns NULL when
 * memory is exhausted. */
NMTAN_API nmtan_workspace *nmtan_workspace_create(const nmtan_allocator *allocator);

/* Frees a workspace and all it holds; NULL is allowed. */
NMTAN_API void nmtan_workspace_destroy(nmtan_workspace *workspace);

/* The caller's threads. run() calls job(context, i) once for each i below count, on any threads, several at a time or
 * one after the other, and returns when all have returned. Jobs call neither back nor the allocator; how many there
 * are follows from options->threads, not what they compute. This struct does not grow. */
typedef struct nmtan_jobs {
	void (*run)(void *user, unsigned count, void (*job)(void *context, unsigned i), void *context);
	void *user;
} nmtan_jobs;

/* Ends the library's threads and returns when they have ended. No other call may run; a later one makes new threads. */
NMTAN_API void nmtan_end_threads(void);

/* Time of calls by stage, in seconds of the wall clock. Calls add to it; the caller sets it to zero. */
typedef struct nmtan_timing {
	size_t struct_bytes; /* sizeof(nmtan_timing): see "Structs" */
	double weld;         /* finding equal vertices; 0 where the method does not tell */
	double solve;        /* the rest of the method, and repair */
	double split;        /* nmtan_vertex_tangents() only */
} nmtan_timing;

#define NMTAN_TIMING_INIT {sizeof(nmtan_timing), 0.0, 0.0, 0.0}

/*
 * For callers that store other texture coordinates than they pass in. The values that a renderer reads from the file
 * decide which way a triangle is wound; if rounding or a transform lies between that and nmtan_mesh.texcoords, a very
 * thin triangle may be wound differently. Repair then takes the sign of w from the coordinates described here.
 * Nothing else uses them.
 */
typedef struct nmtan_stored_uv {
	size_t struct_bytes; /* sizeof(nmtan_stored_uv): see "Structs" */

	/* The float v + v_offset is stored, v pointing up; finite. -1: OBJ's v becomes 1 - v in glTF, which is
	 * -(v - 1). 1: the v that was negated for glTF becomes 1 + v in PLY. 0: v as it stands. */
	float v_offset;

	/* For nmtan_mesh.texcoords that a transform has scaled and turned (KHR_texture_transform): the coordinates
	 * before it, to which v_offset applies, and whether the transform reverses their orientation (not 0). */
	int mirrored;
	const float *texcoords; /* [vertex_count][2], v up whatever mesh.v_down is, tightly packed; NULL: no
	                           transform, and `mirrored` is not looked at */
} nmtan_stored_uv;

#define NMTAN_STORED_UV_INIT {sizeof(nmtan_stored_uv), 0.0f, 0, NULL}

/* Version of the library that runs, as "0.1.0". */
NMTAN_API const char *nmtan_version(void);

/*
 * Whether this build, on this processor as it is set now, gives the bytes that "Results" promises: 1, or 0 where it
 * was compiled with flags that reorder floats, where floats are flushed to zero, or out of memory. A few triangles
 * are solved, which takes less than a millisecond.
 */
NMTAN_API int nmtan_self_test(void);

/* ---- the contract ----
 *
 * Results: the default method is byte-identical to MikkTSpace (M. Mikkelsen, "Simulation of Wrinkled
 * Surfaces Revisited", 2008; the reference implementation, mikktspace.c as published) wherever MikkTSpace's answer is
 * usable; where it is not, it is repaired (see nmtan_repair). The same input gives the same bytes on every machine,
 * thread count and instruction set. v_down is exact: the bytes are those of v negated.
 *
 * The sort of edges of mikktspace.c leaves the edges of one vertex unsorted. This moves the tangents at some corners of
 * about one ordinary mesh in a hundred, by up to 90 degrees. Bakers and most engines ship the file as it is; the
 * rewrites of Blender and three.js sort all edges, and so does NMTAN_METHOD_MIKKTSPACE_SORTED. The sort also shifts a
 * 32-bit number right by 32 on ordinary meshes, which C leaves undefined: "as published" means the number itself, which
 * x86 makes of it, on every machine.
 *
 * The default gives the sorted answer, and counts.sorted_instead tells, where what the file gives depends on more than
 * is followed here:
 * - a position of a face is not finite, or a coordinate reaches FLT_MAX / 2 in magnitude: mikktspace.c does not weld
 *   some of these corners;
 * - the triangles have more than 2^28 corners;
 * - mikktspace.c halves a part of the mesh more than 128 times to find equal corners: usual meshes need about 40;
 *   more is needed only by points that are closer together than 2^-40 of the mesh, at distances of many sizes;
 * - its sort looks at each edge more than 64 times on average, which only edges in an order made for it need.
 *
 * Work: time is linear in the number of corners. Thousands of opposite tangents around one vertex make MikkTSpace
 * quadratic; with repair such a vertex of more than 128 corners has one sum past 2^28 products in a mesh and 256 for
 * each corner (counts.summed_instead). Repair off and thresholds below 180 degrees have no bound.
 *
 * Structs: one that begins with struct_bytes may gain members at its end in a later version. Initialise it
 * with its macro (NMTAN_MESH_INIT and so on), or set struct_bytes to its sizeof and all else to zero: zero is
 * the default of every member. A program compiled with an older header passes a smaller struct: the members
 * it lacks have their defaults, and nothing behind struct_bytes is read or written. A program compiled
 * with a newer header passes a larger struct: this works while the bytes that the library does not know are
 * zero; otherwise it asks for what this library cannot do, which is NMTAN_ERROR_ARGUMENT. So is a struct_bytes
 * that is 0, no multiple of sizeof(size_t) or above 4096.
 *
 * Memory: a call keeps no pointer to the caller's data. Inputs are only read. Outputs belong to the
 * caller and have the room that their comments state; they may not overlap inputs or each other unless a
 * comment allows it. Scratch comes from options->allocator, or malloc, but that of a few triangles from the
 * stack; it is released before the call returns, unless a workspace keeps it for the next one.
 *
 * Threads: every function but nmtan_end_threads() may be called from several threads at once, as long as they do not
 * share outputs, counts, timing or a workspace. There is no global state but a pool of threads: the first call that
 * is large enough for options->threads > 1 and has no options->jobs makes them, later calls in any thread share them,
 * and they sleep in between, with signals blocked. They never call the caller's allocator. If none can be made, the
 * caller's thread does all. Processes made by fork() may go on calling, whatever their parent was doing.
 *
 * Errors: a status, never an exit, never a message on a stream. Arguments, faces and indices are checked
 * before anything is computed. After an error the contents of outputs and counts are unspecified (but see
 * NMTAN_ERROR_CAPACITY), scratch is released, and a workspace can be used again.
 *
 * Not promised: the bits of a NaN, with repair off; the bytes of a later version, but for what MikkTSpace
 * determines; anything after an allocator or jobs have thrown or jumped.
 */

#ifdef __cplusplus
}
#endif
#endif

/* SPDX-License-Identifier: MIT */
/*
 * The validation report of one input: what was found, where, and the numbers behind it.
 *
 * nt_report_build() checks a scene whose meshes are loaded and, where it is judged as written, solved and split; the
 * report owns all it holds, so the scene may go. nt_report_write() (report/render/render.h) turns one or many reports
 * into text, JSON and so on. Nothing here prints.
 *
 * Findings are data: one finding per seam, island or group of equal occurrences, with a fingerprint
 * that stays the same when indices change, so that a later run can tell old findings from new ones.
 */
#ifndef NT_REPORT_REPORT_H
#define NT_REPORT_REPORT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/memory.h"
#include "base/text.h"
#include "file/path.h"
#include "report/maker/maker.h"
#include "report/surface/box.h"
#include "scene/finding.h"
#include "scene/scene.h"

/* ---- the table of findings: codes.c ---- */

/* It has one row for each nt_code. It is what --list-codes prints, what man/nmtan-report.5 and
 * data/nmtan-report.schema.json are checked against, and where every writer of reports takes its sentences from. */

/* Actions for a finding. The greatest comes first: what has to be exported again, all else is made
 * from. */
typedef enum nt_advice {
	NT_ADVICE_LOOK,
	NT_ADVICE_CONVERT,
	NT_ADVICE_BAKE,
	NT_ADVICE_FILE, /* one is missing */
	NT_ADVICE_EXPORT
} nt_advice;

typedef struct nt_code_row {
	const char *name;     /* UV_MIRROR_SEAM: what users write */
	nt_severity severity; /* unless --severity, or the finding's own numbers, say otherwise */
	/* The most severe that it gets in a game prop (glTF whose materials use tangents), a scan (no texture
	 * coordinates) and an OBJ without materials: e, w, i, or - where it is not found there. */
	char profiles[4];
	nt_advice advice;
	const char *repair; /* options with which nmtan repairs it, "--fix" for what that does; NULL: it cannot */
	/* One sentence without a full stop. {count} is the number of occurrences, {one|many} chooses by
	 * it, {detail} is the finding's detail; without {detail} a detail that is not empty follows behind
	 * a colon. */
	const char *message;
	const char *meaning; /* what it is and why it matters */
	const char *remedy;  /* what to do about it; the command follows: nt_remedy_text() */
	const char *example; /* the smallest input that shows it */
} nt_code_row;

/* The row of a code; a code that is out of range is our mistake. */
const nt_code_row *nt_code_info(nt_code code);

/* The severity of a scene's finding: its own, or that of the table. */
nt_severity nt_finding_severity(const nt_finding *finding);

/* "info", "warning" or "error". */
const char *nt_severity_name(nt_severity severity);
bool nt_severity_find(const char *name, nt_severity *severity);

/* "if the map was baked with MikkTSpace": else the command of a finding is wrong; NULL: it is always right. */
const char *nt_code_condition(nt_code code);

/* Whether --fix mends it; whether it mends tangents that are there. */
bool nt_code_mends(nt_code code);
bool nt_code_is_of_kept(nt_code code);

/* Appends a word of a shell: as it is if nothing in it is special, else in quotes. False: no terminal takes it. */
bool nt_shell_word(const char *text, nt_buffer *out);

/* Appends a command that a shell takes as it stands: "nmtan --fix in.glb in-repaired.glb". given: options of the user,
 * words of a shell with line ends between them, which the command has too unless `options` say otherwise; NULL: none.
 * output: "": none; NULL: a name beside the input. "IN OUT" stand for names that a terminal does not take, or for an
 * input of NULL. */
void nt_command_text(const char *options, const char *given, const char *input, const char *output, nt_buffer *out);

/* Appends the remedy, and at its end the command with these options; options NULL: there is none here. */
void nt_remedy_text(nt_code code, const char *options, const char *given, const char *input, nt_buffer *out);

/* Appends the sentence of a finding. detail may be NULL. */
void nt_code_sentence(nt_code code, size_t count, const char *detail, nt_buffer *out);

/* Appends what --list-codes prints: one row per code, its severity and its meaning. */
void nt_codes_list(nt_buffer *out);

/* ---- reports ---- */

enum {
	NT_SPOT_COUNT = 8,       /* places that a finding keeps */
	NT_NUMBER_COUNT = 8,     /* numbers that a finding keeps */
	NT_ANGLE_BINS = 6,       /* up to 1, 5, 15, 30, 60, 180 degrees */
	NT_SINGLE_FINDINGS = 1000, /* seams and islands of one code in one mesh before the rest is one finding */
	NT_SEAM_EDGES = 4096     /* edges that are kept of one seam */
};

/* The edges of the bins of nt_report_mesh.angle_histogram. */
extern const double nt_angle_bins[NT_ANGLE_BINS];

/* Earlier findings. */
typedef struct nt_baseline nt_baseline;

/* An image file's bytes, and its media type. */
typedef struct nt_image {
	const unsigned char *bytes;
	size_t size;
	const char *type; /* static */
	const char *file; /* URI of a file, relative to options.page_folder; NULL: none */
	/* The place at which it is looked up: u' = t[0] u + t[1] v + t[2], v' = t[3] u + t[4] v + t[5], v pointing
	 * down. */
	float transform[6];
	bool again; /* a mesh before has the same bytes */
} nt_image;

/* Images of a mesh that a page shows under its islands. */
typedef enum nt_picture { NT_PICTURE_NORMAL, NT_PICTURE_BASE_COLOR, NT_PICTURE_COUNT } nt_picture;

/* Zero-initialised means the defaults. */
typedef struct nt_report_options {
	nt_format written;            /* what is judged is the scene as this format stores it; NT_FORMAT_UNKNOWN: as
	                                 it was read */
	bool ignore[NT_CODE_COUNT];
	uint8_t severity[NT_CODE_COUNT]; /* 0: the table's; else 1 + nt_severity */
	nt_severity min_severity;     /* findings below are not reported */
	size_t max_findings;          /* findings kept, some of each code; 0: all */
	nt_baseline *baseline;        /* NULL: none */
	const nt_shown_paths *paths;  /* how files are named, while the report is there; NULL: as they are spelled */
	bool keep_geometry;           /* for pages and comparisons */
	bool keep_frames;             /* with geometry: the file's tangents, and computed ones, which are solved where
	                                 no stage did */
	bool measures;                /* texel density and stretch of islands, and what splitting costs */
	void *find_user; /* what the next ones get first */
	/* Gives the size of a mesh's normal map in pixels, 0 0 where it is not known. NULL: nobody can. */
	nt_status (*find_map_size)(void *user, const nt_scene *scene, const nt_mesh *mesh, uint32_t pixels[2]);
	/* Gives a copy of an image of a mesh, in the arena, for HTML: no bytes where it has none or one of more
	 * than most_bytes. NULL: nobody can. */
	nt_status (*find_picture)(void *user, nt_arena *arena, const nt_scene *scene, const nt_mesh *mesh,
		nt_picture picture, size_t most_bytes, nt_image *image);
	const char *page_folder;      /* absolute: where an HTML page will be; NULL: nobody knows */
	const char *conversion;       /* options of the conversion that a check judges; NULL: it judges the file */
	const char *given;            /* what a command that repairs a finding repeats: see nt_command_text() */
	bool in_place;                /* outputs replace inputs, and those of commands do */
	unsigned threads;
	nt_quads quads;               /* AUTO: tangents may be of quads */
} nt_report_options;

/* A triangle, an edge or a vertex where something was found. */
typedef struct nt_spot {
	uint32_t triangle;        /* NT_NONE: none. Numbers count after triangulation */
	uint32_t face;            /* the source's face, NT_NONE: none */
	unsigned corner_count;    /* 1, 2 or 3 */
	uint32_t vertices[3];     /* as the source numbers them */
	float positions[3][3];
	float texcoords[3][2];    /* as the source has them */
	bool has_texcoords;
	double value;             /* the number that was checked; NaN: none */
	size_t line;              /* of the face in a text that has lines; 0: unknown */
	const char *source;       /* the face's corners as written, "1/1/1 2/2/1 3/3/1"; NULL: none */
} nt_spot;

typedef struct nt_number {
	const char *name; /* static */
	double value;
} nt_number;

typedef struct nt_report_finding {
	nt_code code;
	nt_severity severity;
	uint32_t mesh;        /* index into the report's meshes, NT_NONE: the file as a whole */
	size_t count;         /* occurrences */
	double rank;          /* among those of its code: greater ones come first */
	size_t order;         /* in which it was found */
	/* The share of the file's triangles that it concerns: all of a texture or material; and the most of findings
	 * of its code and severity. They say which come first. */
	double share, code_share;
	size_t alike;         /* meshes of this geometry that it holds for, the mesh itself included; 0: no mesh */
	const char *message;  /* one sentence */
	bool stays;           /* nothing here repairs it, whatever its code's row says */
	const char *repair;   /* options with which nmtan repairs it: see nt_code_row; NULL: it cannot */
	nt_place_view place;  /* texts in the report's arena */
	const char *file;     /* of the place, as reports show it, if that is not the input; NULL */
	nt_box box;           /* around all occurrences */
	uint64_t fingerprint;
	uint64_t geometry;    /* the same without names; 0: not known */
	bool known;           /* the baseline has it */
	uint32_t noted;       /* index into the scene's findings, NT_NONE: a check found it */
	uint32_t seam;        /* index into the mesh's seams, those of hard edges too; NT_NONE */
	uint32_t island;      /* index into the mesh's islands, NT_NONE */
	nt_number *numbers;   /* [number_count] at most NT_NUMBER_COUNT */
	nt_spot *spots;       /* [spot_count] at most NT_SPOT_COUNT */
	unsigned number_count, spot_count;
	const int8_t *votes;  /* [votes_side][votes_side] as in nt_finding, in the report's arena; NULL: none */
	unsigned votes_side;
} nt_report_finding;

/* One edge of a seam: side 0 is the unmirrored one. Both sides go from the same end to the same end. */
typedef struct nt_seam_edge {
	uint32_t triangles[2];
	uint32_t vertices[2][2]; /* [side][end] as the source numbers them */
	uint32_t output[2][2];   /* after the split; the same where nothing was split */
	float positions[2][3];   /* [end] */
	float texcoords[2][2][2]; /* [side][end] as the source has them */
	float dihedral, tangent_angle; /* degrees; NaN where a triangle has none */
} nt_seam_edge;

typedef struct nt_seam {
	bool closed;
	size_t edge_count;
	nt_seam_edge *edges;   /* [min(edge_count, NT_SEAM_EDGES)] in walking order */
	double length;
	double dihedral[2];       /* least and greatest, degrees; NaN: none */
	double tangent_angle[2];
	uint32_t islands[2];      /* at the first edge: unmirrored, mirrored */
	size_t shared_count;      /* edges whose two sides use the same vertices */
	double frame_angle[2];    /* between tangents at the ends, of the two sides: least and greatest, degrees; NaN */
	size_t same_texel_count;  /* edges along which the two sides look up the same texels */
	size_t unhidden_count;    /* of these, those whose frames differ: see seams.c */
	size_t non_manifold_count;
	bool has_plane;
	double plane[4];          /* a x + b y + c z = d, unit normal */
	char plane_text[64];      /* "x = 0" */
	nt_box box;
} nt_seam;

typedef enum nt_island_kind {
	NT_ISLAND_NORMAL,
	NT_ISLAND_MIRRORED,
	NT_ISLAND_MIXED,
	NT_ISLAND_DEGENERATE
} nt_island_kind;

typedef struct nt_island {
	nt_island_kind kind;
	size_t triangles[3];  /* mirrored, degenerate, normal: [orientation + 1] */
	size_t flipped[3];    /* of these: see flips.c */
	double area;          /* in space */
	double covered;       /* share of the mirrored triangles that lie on unmirrored ones, NaN: none */
	double texel_density[2]; /* texels per unit: median by area, least; NaN: not measured, or the size is
	                            not known */
	double stretch[2];       /* longest to shortest texel: median by area, greatest; NaN: not measured */
	bool overlaps_itself; /* mixed, but the mirrored part lies point by point on the unmirrored one */
	float minimum[2], maximum[2]; /* in the source's UV */
	uint32_t first_triangle;
	nt_box box;
} nt_island;

/* Data for pictures. Everything per vertex or triangle of the mesh as checked. */
typedef struct nt_report_geometry {
	size_t vertex_count, triangle_count;
	float *positions, *normals, *texcoords, *tangents; /* NULL: none. Texcoords as the source has them,
	                                                      tangents with w as the checks see it, v up */
	float *authored;       /* tangents of the input; NULL: none, or not kept. May be `tangents` */
	float *computed;       /* tangents that nmtan computes; NULL: as before */
	uint32_t *indices;     /* [triangle_count][3] */
	int8_t *orientation;   /* [triangle_count] */
	uint32_t *islands;     /* [triangle_count], NT_NONE: none */
} nt_report_geometry;

typedef struct nt_report_mesh {
	const char *name;
	nt_place_view place;
	uint32_t gltf_mesh, gltf_primitive;
	uint32_t same_as;         /* an earlier mesh with the same geometry and uses: what is found there holds
	                             here, and is not said again. Seams, islands and geometry are there; NT_NONE */
	const char *why;          /* why tangents were or were not made */
	unsigned slots;           /* enum nt_slot */
	uint32_t texcoord_set;
	bool has_normals, has_texcoords, checked_tangents;
	bool analysed;            /* false: not triangles, or nothing was loaded */
	uint64_t digest;          /* of its triangles in space, whatever their order; 0: none */

	size_t face_count, triangle_count;
	size_t triangles[3];      /* mirrored, degenerate, normal: [orientation + 1] */
	double areas[3];          /* the same, area in space */
	size_t vertices_before, added_normals, added_mirror, added_direction, vertices_after;
	size_t split_vertices;    /* copies that different tangents take, or would take */
	size_t vertex_bytes;      /* of one copy of a vertex; 0: not measured */
	uint32_t texture_size[2]; /* of the normal map, pixels; 0: not known, or not measured */
	size_t island_kinds[4];   /* by nt_island_kind */
	size_t seam_count, seam_edges;
	double seam_length;
	size_t uv_seam_edges;     /* inner edges where the texture coordinates are cut */
	size_t edge_count, boundary_edges, boundary_loops, boundary_chains, non_manifold_edges,
		inconsistent_edges;
	size_t left_out;          /* triangles at seams and boundaries that OpenMesh could not take */
	double worst_orthogonality; /* degrees from perpendicular; NaN: nothing checked */
	double relative_determinant[3]; /* least, median, greatest; NaN: none */
	nt_maker maker;                /* of the input's tangents; agreement < 0: they were not compared */
	size_t angle_histogram[NT_ANGLE_BINS]; /* corners, against a fresh solve */
	size_t instance_count, negative_instances;
	bool is_scaled;           /* by its first instance, or moved by an origin: lengths and shown places are in the
	                             world */
	double world[16];         /* column-major */

	nt_wrap wrap[2];          /* along u and v: how the sampler repeats what the mesh lies on */
	size_t hard_count;        /* 1: all hard edges, behind the mirror seams */
	nt_seam *seams;           /* [seam_count + hard_count] */
	nt_island *islands;       /* [island_count] */
	size_t island_count;
	nt_box box;
	nt_report_geometry *geometry; /* NULL unless kept */
	nt_image pictures[NT_PICTURE_COUNT]; /* bytes NULL: none, or not kept */
} nt_report_mesh;

/* A place of a mesh as it is shown. */
static inline void nt_world_point(const nt_report_mesh *mesh, const float point[3], double shown[3])
{
	for (int i = 0; i < 3; i++) {
		const double *m = mesh->world + i;
		shown[i] = !mesh->is_scaled ? (double)point[i]
			: m[0] * (double)point[0] + m[4] * (double)point[1] + m[8] * (double)point[2] + m[12];
	}
}

/* The length between two places, as it is shown. */
static inline double nt_world_length(const nt_report_mesh *mesh, const float a[3], const float b[3])
{
	double ends[2][3], square = 0.0;
	nt_world_point(mesh, a, ends[0]);
	nt_world_point(mesh, b, ends[1]);
	for (int i = 0; i < 3; i++)
		square += (ends[1][i] - ends[0][i]) * (ends[1][i] - ends[0][i]);
	return sqrt(square);
}

typedef struct nt_report {
	nt_arena arena;
	const char *path;
	const char *shown;        /* the path as reports show it */
	const nt_shown_paths *paths; /* not owned; NULL: none */
	nt_format format;
	double origin[3];         /* of the scene: positions and boxes are relative to it */
	const char *origin_text;  /* "431236,5412347,101"; NULL: it is 0 */
	const char *conversion, *given; /* as in the options */
	const char *failure;      /* the input could not be checked: why; NULL */
	nt_place_view failure_place;
	nt_report_mesh *meshes;
	size_t mesh_count;
	nt_report_finding *findings; /* new ones first, the most severe, what concerns most; of one code together */
	size_t finding_count;
	size_t new_count;         /* of the findings, those that no baseline knows: the first ones */
	size_t dropped;           /* new findings beyond max_findings */
	size_t dropped_by_code[NT_CODE_COUNT]; /* the same */
	size_t counts[NT_CODE_COUNT]; /* occurrences of all findings, known and dropped ones too, in all meshes alike */
	size_t by_severity[3];    /* findings, dropped ones too, that no baseline knows */
	size_t known[3];          /* by severity: findings that the baseline knows */
	size_t hidden[3];         /* by severity: findings below options.min_severity, which are not here */
	bool compared;            /* there was a baseline */
} nt_report;

/*
 * Checks a scene.
 *
 *   scene    meshes that have positions are checked; its findings become part of the report
 *   options  NULL: defaults
 *   report   receives the report, to be freed with nt_report_free()
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_report_build(const nt_scene *scene, const nt_report_options *options,
	nt_report **report, nt_error *error);

/* A report that says that the input could not be read, and what was found until then (scene: NULL: nothing); NULL when
 * out of memory. */
nt_report *nt_report_of_error(const char *path, const nt_scene *scene, const nt_report_options *options,
	const nt_error *failure);

/* NULL is allowed. */
void nt_report_free(nt_report *report);

/* Whether a finding of a stage is not in a report, since a check finds the same with its places. */
bool nt_is_found_again(const nt_finding *found);

/* The most severe new finding. False when there is none. */
bool nt_report_worst(const nt_report *report, nt_severity *worst);

/* Why no renderer can use a tangent [4] with a normal [3] (NULL: it is not asked for): TAN_NOT_FINITE, TAN_ZERO,
 * TAN_NON_UNIT, TAN_BAD_W and TAN_PARALLEL_NORMAL; 0: one can. */
enum { NT_FAULT_NOT_FINITE = 1, NT_FAULT_ZERO = 2, NT_FAULT_LENGTH = 4, NT_FAULT_W = 8, NT_FAULT_PARALLEL = 16 };
unsigned nt_tangent_faults(const float *tangent, const float *normal);

/* Appends a path as reports show it: see file/path.h. */
void nt_report_show_path(const nt_report *report, const char *path, nt_buffer *out);

/* ---- things of two versions that are the same, by a key, each once: baseline.c ---- */

/* The key of a thing; 0: it has none. */
typedef uint64_t (*nt_key_of)(const void *things, size_t index);

/* A thing that has a key, by its number. */
typedef struct nt_keyed {
	uint64_t key;
	uint32_t index;
} nt_keyed;

/* The partners of new things: an old one of each, UINT32_MAX: none; and whether an old one has a partner. */
typedef struct nt_pairs {
	uint32_t *partners;
	bool *taken;
} nt_pairs;

/* Pairs things by the first of the keys, the rest by the others. False: out of memory. To be freed in either case. */
bool nt_pair(nt_pairs *pairs, const void *old, size_t old_count, const void *new, size_t new_count,
	const nt_key_of keys[2]);

void nt_pairs_free(nt_pairs *pairs);

/* ---- baselines, earlier findings of which new ones are told apart: baseline.c ---- */

typedef struct nt_baseline_entry {
	uint64_t file;                  /* a key of its name as reports show it */
	uint64_t fingerprint, geometry; /* 0: not known; both of the entry that stands for the file */
} nt_baseline_entry;

/* Each entry is one finding, but one of each file: two equal ones excuse two. */
struct nt_baseline {
	nt_baseline_entry *entries; /* [count] by file */
	size_t count;
	nt_keyed *geometries; /* [geometry_count] of entries that have one, ascending */
	size_t geometry_count;
};

/*
 * Reads the findings of a JSON report.
 *
 * Returns NT_OK, NT_ERROR_INPUT when the text is no report of nmtan, or NT_ERROR_MEMORY.
 */
nt_status nt_baseline_read(nt_baseline *baseline, const char *text, size_t size, nt_error *error);

/* Marks the findings that the baseline has. False: out of memory. */
bool nt_baseline_apply(const nt_baseline *baseline, nt_report *report);

void nt_baseline_free(nt_baseline *baseline);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Findings: what was noticed about an input that is no reason to stop. A finding is a code, a place
 * and the numbers behind it. Its severity, sentence, meaning and remedy are in the table of
 * report/codes.c; nothing here formats or prints.
 */
#ifndef NT_SCENE_FINDING_H
#define NT_SCENE_FINDING_H

#include "base/hash_index.h"
#include "base/memory.h"
#include "base/text.h"

typedef enum nt_severity { NT_SEVERITY_INFO, NT_SEVERITY_WARNING, NT_SEVERITY_ERROR } nt_severity;

/* Codes in the order of the table in report/codes.c, which has one row for each and says what they mean.
 * A code's public name is its name here without NT_CODE_. */
typedef enum nt_code {
	/* what readers and writers report */
	NT_CODE_MTL_MISSING,
	NT_CODE_MATERIAL_UNKNOWN,
	NT_CODE_MATERIAL_FIRST,
	NT_CODE_BUFFER_MISSING,
	NT_CODE_IMAGE_MISSING,
	NT_CODE_LINK_LEAVES,
	NT_CODE_IMAGE_TYPE,
	NT_CODE_IMAGE_DAMAGED,
	NT_CODE_IMAGE_ELSEWHERE,
	NT_CODE_IMAGE_CONVERTED,
	NT_CODE_BUMP_AS_NORMAL,
	NT_CODE_NMAP_BESIDE,
	NT_CODE_NMAP_GREEN_DOWN,
	NT_CODE_NMAP_GREEN_MIXED,
	NT_CODE_NMAP_NOT_UNIT,
	NT_CODE_NMAP_BLUE_BELOW_HALF,
	NT_CODE_NMAP_OBJECT_SPACE,
	NT_CODE_NMAP_CONSTANT,
	NT_CODE_NMAP_BANDED,
	NT_CODE_NMAP_SRGB,
	NT_CODE_NMAP_JPEG,
	NT_CODE_NMAP_NOT_EXAMINED,
	NT_CODE_NMAP_NOT_TURNED,
	NT_CODE_NMAP_HEIGHTS,
	NT_CODE_MATERIAL_LOST,
	NT_CODE_MATERIAL_DOUBTFUL,
	NT_CODE_STATEMENT_IGNORED,
	NT_CODE_COLORS_DOUBTFUL,
	NT_CODE_POLYGON_DEGENERATE,
	NT_CODE_POLYGON_CUT,
	NT_CODE_NORMALS_MADE,
	NT_CODE_NORMALS_REPLACED,
	NT_CODE_NORMALS_CANCELLED,
	NT_CODE_NORMALS_NOT_THERE,
	NT_CODE_NORMALS_SCALED,
	NT_CODE_REFERENCE_LOST,
	NT_CODE_EXTENSION_STALE,
	NT_CODE_WELD_LEFT,
	NT_CODE_POLYGONS_DROPPED,
	NT_CODE_DRACO_PLAIN,
	NT_CODE_DRACO_SEQUENTIAL,
	NT_CODE_NOT_VERIFIED,
	NT_CODE_MESH_NOT_READ,
	/* texture coordinates */
	NT_CODE_UV_MIRROR_SEAM,
	NT_CODE_UV_MIRROR_OVERLAP,
	NT_CODE_UV_MIRROR_LONE,
	NT_CODE_UV_MIXED_WINDING_ISLAND,
	NT_CODE_UV_FLIPPED_TRIANGLE,
	NT_CODE_UV_HARD_EDGE,
	NT_CODE_UV_DEGENERATE_TRIANGLE,
	NT_CODE_UV_NEAR_DEGENERATE,
	NT_CODE_UV_FOLDED_QUAD,
	NT_CODE_UV_UNMAPPED,
	NT_CODE_UV_ROUNDED_AWAY,
	NT_CODE_UV_NOT_FINITE,
	NT_CODE_UV_MISSING,
	NT_CODE_UV_NOT_THERE,
	/* positions, normals, connectivity */
	NT_CODE_POS_DEGENERATE_TRIANGLE,
	NT_CODE_POS_NOT_FINITE,
	NT_CODE_POS_ORIGIN,
	NT_CODE_POS_ROUNDED,
	NT_CODE_MESH_NON_MANIFOLD_EDGE,
	NT_CODE_MESH_INCONSISTENT_WINDING,
	NT_CODE_MESH_NORMAL_NON_UNIT,
	NT_CODE_MESH_NORMAL_ZERO,
	NT_CODE_MESH_NORMAL_AGAINST_FACE,
	/* tangents */
	NT_CODE_TAN_MIRROR_SHARED_VERTEX,
	NT_CODE_TAN_MIXED_W_TRIANGLE,
	NT_CODE_TAN_SIGN_MISMATCH,
	NT_CODE_TAN_DIRECTION_MISMATCH,
	NT_CODE_TAN_NOT_ORTHOGONAL,
	NT_CODE_TAN_PARALLEL_NORMAL,
	NT_CODE_TAN_ZERO,
	NT_CODE_TAN_NOT_FINITE,
	NT_CODE_TAN_NON_UNIT,
	NT_CODE_TAN_BAD_W,
	NT_CODE_TAN_MISSING_REQUIRED,
	NT_CODE_TAN_UNUSED,
	NT_CODE_TAN_ACCESSOR,
	NT_CODE_TAN_NO_NORMAL,
	NT_CODE_TAN_NO_UV,
	NT_CODE_TAN_UVSET_CONFLICT,
	NT_CODE_TAN_UV_TRANSFORM_ANIMATED,
	NT_CODE_TAN_MORPH_MISSING,
	NT_CODE_TAN_MORPH_TURNED,
	NT_CODE_TAN_MORPH_HALFWAY,
	NT_CODE_TAN_PRIMITIVE_BORDER,
	NT_CODE_TAN_QUANTIZED,
	NT_CODE_TAN_REPAIRED,
	NT_CODE_TAN_EXISTING_BAD,
	NT_CODE_TAN_EXISTING_REPAIRED,
	NT_CODE_TAN_EXISTING_LEFT,
	NT_CODE_TAN_KEPT_SIGN,
	NT_CODE_TAN_GREEN_PAIR,
	NT_CODE_TAN_MADE_BY,
	NT_CODE_TAN_QUAD_SIGN,
	NT_CODE_TAN_QUADS_LIKELY,
	NT_CODE_TAN_QUADS_NONE,
	NT_CODE_COUNT
} nt_code;

typedef struct nt_finding {
	nt_code code;
	uint8_t severity;    /* 0: the table's; else 1 + nt_severity */
	nt_place_view place; /* of the first occurrence */
	size_t count;        /* occurrences, at least 1 */
	const char *detail;  /* the words that differ from case to case (a file name, a statement); may be
	                        empty */
	const char *repair;  /* options that repair this one; NULL: those of the table */
	bool stays;          /* nothing here repairs this one, whatever the table says */
	const int8_t *votes; /* [votes_side][votes_side] of a normal map's blocks: see image/image.h; NULL: none */
	unsigned votes_side;
	const struct nt_mesh *judged; /* an info unless this mesh needs tangents, which its images may decide later;
	                                 NULL: the severity stays. Ends with the scene */
	const struct nt_mesh *mesh;   /* that it is about, if the place is that of its material; else NULL. The same */
} nt_finding;

typedef struct nt_finding_list {
	nt_finding *items;
	size_t count;
	size_t capacity;
	nt_arena arena;      /* texts of items */
	nt_hash_index known; /* items by code, object and detail */
	bool failed; /* out of memory while adding */
} nt_finding_list;

/* Adds `count` occurrences of a finding; to an earlier one, which keeps its place, if code, file, object and
 * detail are the same. place and detail_format may be NULL. */
void nt_finding_add(nt_finding_list *list, nt_code code, const nt_place *place, size_t count,
	const char *detail_format, ...) NT_PRINTF(5, 6);

/* The same of a finding whose members but for its place are set; texts are copied, `repair` is not. */
void nt_finding_put(nt_finding_list *list, nt_finding finding, const nt_place *place);

/* The same of one that is found alone, with another severity than the table's. */
void nt_finding_add_as(nt_finding_list *list, nt_code code, nt_severity severity, const nt_place *place,
	const char *detail);

/* Findings from number `begin` on are about a mesh, wherever their places are. */
void nt_findings_set_mesh(nt_finding_list *list, size_t begin, const struct nt_mesh *mesh);

void nt_finding_list_free(nt_finding_list *list);

/* The same place with texts in an arena. False: out of memory. */
bool nt_keep_place(nt_arena *arena, const nt_place_view *place, nt_place_view *kept);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Findings: what was noticed about an input that is no reason to stop. A finding is a code, a place
 * and the numbers behind it. Its severity, sentence, meaning and remedy are in the table of
 * report/codes.c; nothing here formats or prints.
 */
#ifndef NT_SCENE_FINDING_H
#define NT_SCENE_FINDING_H

#include "base/error.h"

typedef enum nt_severity { NT_SEVERITY_INFO, NT_SEVERITY_WARNING, NT_SEVERITY_ERROR } nt_severity;

/* Codes in the order of the table in report/codes.c, which has one row for each. */
typedef enum nt_code {
	/* what readers report */
	NT_CODE_MTL_MISSING,           /* a material library cannot be read */
	NT_CODE_MATERIAL_UNKNOWN,      /* usemtl names a material that no library defines */
	NT_CODE_IMAGE_MISSING,         /* an image that the output refers to cannot be read */
	NT_CODE_IMAGE_TYPE,            /* an image type that glTF does not carry */
	NT_CODE_BUMP_AS_NORMAL,        /* map_Bump was taken as a normal map */
	NT_CODE_STATEMENT_IGNORED,     /* statement, element or property that nmtan does not use */
	NT_CODE_POLYGON_DEGENERATE,    /* n-gon that could not be triangulated properly */
	NT_CODE_NORMALS_MADE,          /* normals were missing and have been made */
	NT_CODE_REFERENCE_LOST,        /* something the input refers to did not make it to the output */
	/* texture coordinates and geometry */
	NT_CODE_UV_DEGENERATE_TRIANGLE,
	NT_CODE_POS_DEGENERATE_TRIANGLE,
	NT_CODE_UV_FOLDED_QUAD,        /* the halves of a quad are wound differently in UV space */
	NT_CODE_UV_ROUNDED_AWAY,       /* orientation of triangles changed when v became 1 - v */
	/* tangents */
	NT_CODE_TAN_REPAIRED,          /* tangents the method left unusable were replaced */
	NT_CODE_TAN_NO_NORMAL,         /* tangents are needed but there are no normals */
	NT_CODE_TAN_NO_UV,             /* tangents are needed but there are no texture coordinates */
	NT_CODE_TAN_UVSET_CONFLICT,    /* two slots want different texture coordinates */
	NT_CODE_TAN_UV_TRANSFORM_ANIMATED,
	NT_CODE_TAN_EXISTING_BAD,      /* authored tangents that were kept are invalid */
	NT_CODE_COUNT
} nt_code;

typedef struct nt_finding {
	nt_code code;
	nt_place place;     /* of the first occurrence */
	size_t count;       /* occurrences, at least 1 */
	char detail[256];   /* the words that differ from case to case (a file name, a statement); may be
	                       empty */
} nt_finding;

typedef struct nt_finding_list {
	nt_finding *items;
	size_t count;
	size_t capacity;
	bool failed; /* out of memory while adding */
} nt_finding_list;

/* Adds `count` occurrences of a finding; to an earlier one, which keeps its place, where code, object and
 * detail are the same. place and detail_format may be NULL. */
void nt_finding_add(nt_finding_list *list, nt_code code, const nt_place *place, size_t count,
	const char *detail_format, ...) NT_PRINTF(5, 6);

void nt_finding_list_free(nt_finding_list *list);

#endif

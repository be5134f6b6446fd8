/* SPDX-License-Identifier: MIT */
/*
 * Changes between two versions of an asset: in its tangents, its seams and what is found.
 */
#ifndef NT_REPORT_RENDER_COMPARE_H
#define NT_REPORT_RENDER_COMPARE_H

#include "report/report.h"

/* A corner of both versions is compared where a triangle has the same three positions in both. Index 0 is the old
 * version, 1 the new one, throughout. */
typedef struct nt_mesh_change {
	uint32_t meshes[2];          /* index into each report's meshes; NT_NONE: only the other has it */
	size_t matched;              /* triangles at the same place in both */
	size_t moved_texcoords;      /* corners of these with other texture coordinates */
	size_t compared;             /* corners of these with a tangent in both */
	size_t turned;               /* of these, tangents that turned by more than NT_TURNED_DEGREES */
	size_t reversed;             /* and those whose w has the other sign */
	size_t histogram[NT_ANGLE_BINS]; /* of the compared corners, by nt_angle_bins */
	double worst_degrees;        /* NaN: nothing was compared */
	float worst_position[3];
} nt_mesh_change;

/* Less is what rounding tangents to 16-bit integers does. */
#define NT_TURNED_DEGREES 0.01

typedef struct nt_report_diff {
	const nt_report *reports[2]; /* not owned */
	nt_mesh_change *meshes;      /* those of the new version in its order, then those that are gone */
	size_t mesh_count;
	/* [findings of each report] whether the other version has it too; the reports' order */
	bool *known[2];
	size_t unchanged;            /* findings that both have */
	size_t by_severity[2][3];    /* findings that only one has */
} nt_report_diff;

/*
 * Compares two reports, made with keep_geometry, that stay until the diff is freed.
 *
 * Meshes are the same by name and glTF primitive, else by their triangles, else by their order where they have as many
 * triangles. Findings are the same by fingerprint, else by geometry.
 *
 *   exchange  what a page shows: in the geometry of both reports `authored` becomes the tangents that are compared, and
 *             `computed` those of the other version at the same place, of a vertex's corners the one that turned most;
 *             zero where there is none
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_report_compare(nt_report_diff *diff, nt_report *before, nt_report *after, bool exchange);

/* Zero-initialised is allowed. */
void nt_report_diff_free(nt_report_diff *diff);

#endif

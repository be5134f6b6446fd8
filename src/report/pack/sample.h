/* SPDX-License-Identifier: MIT */
/*
 * A part of a mesh that is small enough for a page: what lies around the findings, grown ring by ring.
 */
#ifndef NT_REPORT_PACK_SAMPLE_H
#define NT_REPORT_PACK_SAMPLE_H

#include "report/report.h"

/* Chooses at most `most` triangles of a mesh with geometry: taken[t] becomes 1 for them, 0 for the others; *count
 * receives how many. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_sample_triangles(const nt_report *report, uint32_t mesh, size_t most, uint8_t *taken, size_t *count);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A part of a mesh that is small enough for a page: all of it where it fits, else what lies around the
 * findings, grown ring by ring until the budget is used.
 */
#ifndef NT_REPORT_RENDER_SAMPLE_H
#define NT_REPORT_RENDER_SAMPLE_H

#include "report/report.h"

typedef struct nt_sample {
	size_t triangle_count, vertex_count;
	uint32_t *indices;  /* [triangle_count][3] into vertices */
	uint32_t *vertices; /* [vertex_count] vertex of the geometry */
	bool whole;         /* nothing was left out */
} nt_sample;

/* Bytes that a triangle and a vertex take on the page before they become text. */
enum { NT_SAMPLE_TRIANGLE_BYTES = 12, NT_SAMPLE_VERTEX_BYTES = 48 };

/* Returns NT_OK or NT_ERROR_MEMORY. The sample is to be freed with nt_sample_free(). */
nt_status nt_sample_make(nt_sample *sample, const nt_report *report, uint32_t mesh,
	size_t budget_bytes);
void nt_sample_free(nt_sample *sample);

/* Bytes that a sample of the whole mesh takes. */
size_t nt_sample_bytes(const nt_report_mesh *mesh);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * Choosing triangles for a page: see sample.h.
 */
#include "report/render/sample.h"

#include <stdlib.h>
#include <string.h>

size_t nt_sample_bytes(const nt_report_mesh *mesh)
{
	const nt_report_geometry *g = mesh->geometry;
	return g ? NT_SAMPLE_TRIANGLE_BYTES * g->triangle_count + NT_SAMPLE_VERTEX_BYTES * g->vertex_count : 0;
}

typedef struct growth {
	const nt_report_geometry *geometry;
	nt_sample *sample;
	uint32_t *number;  /* [vertex_count] in the sample, NT_NONE */
	uint8_t *taken;    /* [triangle_count] */
	size_t bytes, budget;
} growth;

static bool take(growth *w, size_t t)
{
	const uint32_t *corners = w->geometry->indices + 3 * t;
	size_t bytes = NT_SAMPLE_TRIANGLE_BYTES;
	for (int k = 0; k < 3; k++)
		bytes += w->number[corners[k]] == NT_NONE ? NT_SAMPLE_VERTEX_BYTES : 0;
	if (w->taken[t] || w->bytes + bytes > w->budget)
		return false;
	w->taken[t] = 1;
	w->bytes += bytes;
	nt_sample *s = w->sample;
	for (int k = 0; k < 3; k++) {
		if (w->number[corners[k]] == NT_NONE) {
			w->number[corners[k]] = (uint32_t)s->vertex_count;
			s->vertices[s->vertex_count++] = corners[k];
		}
		s->indices[3 * s->triangle_count + (size_t)k] = w->number[corners[k]];
	}
	s->triangle_count++;
	return true;
}

static void take_findings(growth *w, const nt_report *report, uint32_t mesh)
{
	for (size_t i = 0; i < report->issue_count; i++) {
		const nt_issue *issue = &report->issues[i];
		for (unsigned k = 0; k < issue->spot_count && issue->mesh == mesh; k++)
			if (issue->spots[k].triangle != NT_NONE)
				take(w, issue->spots[k].triangle);
	}
	const nt_report_mesh *m = &report->meshes[mesh];
	for (size_t i = 0; i < m->seam_count; i++) {
		const nt_seam *seam = &m->seams[i];
		for (size_t k = 0; k < seam->edge_count && k < NT_SEAM_EDGES; k++) {
			take(w, seam->edges[k].triangles[0]);
			take(w, seam->edges[k].triangles[1]);
		}
	}
	if (w->sample->triangle_count == 0)
		take(w, 0);
}

/* Takes every triangle that touches a vertex of the sample as it is now. */
static bool grow_ring(growth *w)
{
	const nt_report_geometry *g = w->geometry;
	const size_t before = w->sample->triangle_count;
	const uint32_t known = (uint32_t)w->sample->vertex_count;
	for (size_t t = 0; t < g->triangle_count; t++) {
		const uint32_t *corners = g->indices + 3 * t;
		const bool touches = w->number[corners[0]] < known || w->number[corners[1]] < known ||
			w->number[corners[2]] < known;
		if (touches)
			take(w, t);
	}
	return w->sample->triangle_count > before;
}

nt_status nt_sample_make(nt_sample *sample, const nt_report *report, uint32_t mesh,
	size_t budget_bytes)
{
	const nt_report_geometry *g = report->meshes[mesh].geometry;
	*sample = (nt_sample){.indices = nt_alloc(3 * g->triangle_count, sizeof *sample->indices),
		.vertices = nt_alloc(g->vertex_count, sizeof *sample->vertices)};
	growth w = {.geometry = g, .sample = sample, .budget = budget_bytes,
		.number = nt_alloc(g->vertex_count, sizeof *w.number),
		.taken = nt_calloc(g->triangle_count, 1)};
	nt_status status = NT_ERROR_MEMORY;
	if (sample->indices && sample->vertices && w.number && w.taken) {
		memset(w.number, 0xff, g->vertex_count * sizeof *w.number);
		status = NT_OK;
		if (nt_sample_bytes(&report->meshes[mesh]) <= budget_bytes) {
			for (size_t t = 0; t < g->triangle_count; t++)
				take(&w, t);
		} else {
			take_findings(&w, report, mesh);
			while (grow_ring(&w))
				;
		}
		sample->whole = sample->triangle_count == g->triangle_count;
	}
	free(w.number);
	free(w.taken);
	if (status)
		nt_sample_free(sample);
	return status;
}

void nt_sample_free(nt_sample *sample)
{
	free(sample->indices);
	free(sample->vertices);
	*sample = (nt_sample){0};
}

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
	size_t *first;     /* [vertex_count + 1] where a vertex's triangles begin in `around` */
	uint32_t *around;  /* [3 * triangle_count] triangles by vertex */
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
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		for (unsigned k = 0; k < finding->spot_count && finding->mesh == mesh; k++)
			if (finding->spots[k].triangle != NT_NONE)
				take(w, finding->spots[k].triangle);
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

/* Lists the triangles of every vertex. */
static void list_around(growth *w)
{
	const nt_report_geometry *g = w->geometry;
	memset(w->first, 0, (g->vertex_count + 1) * sizeof *w->first);
	for (size_t c = 0; c < 3 * g->triangle_count; c++)
		w->first[g->indices[c] + 1]++;
	for (size_t v = 0; v < g->vertex_count; v++)
		w->first[v + 1] += w->first[v];
	for (size_t c = 0; c < 3 * g->triangle_count; c++)
		w->around[w->first[g->indices[c]]++] = (uint32_t)(c / 3);
	/* filling moved each beginning to its end, which is the next one's beginning */
	memmove(w->first + 1, w->first, g->vertex_count * sizeof *w->first);
	w->first[0] = 0;
}

/* Takes the triangles around each vertex of the sample, in the order in which the vertices came into it: ring
 * after ring around the findings, every triangle looked at three times. */
static void grow_rings(growth *w)
{
	for (size_t i = 0; i < w->sample->vertex_count; i++) {
		const uint32_t vertex = w->sample->vertices[i];
		for (size_t k = w->first[vertex]; k < w->first[vertex + 1]; k++)
			take(w, w->around[k]);
	}
}

static void choose(growth *w, const nt_report *report, uint32_t mesh)
{
	if (nt_sample_bytes(&report->meshes[mesh]) <= w->budget) {
		for (size_t t = 0; t < w->geometry->triangle_count; t++)
			take(w, t);
	} else {
		list_around(w);
		take_findings(w, report, mesh);
		grow_rings(w);
	}
}

nt_status nt_sample_make(nt_sample *sample, const nt_report *report, uint32_t mesh,
	size_t budget_bytes)
{
	const nt_report_geometry *g = report->meshes[mesh].geometry;
	*sample = (nt_sample){.indices = nt_alloc(3 * g->triangle_count, sizeof *sample->indices),
		.vertices = nt_alloc(g->vertex_count, sizeof *sample->vertices)};
	growth w = {.geometry = g, .sample = sample, .budget = budget_bytes,
		.number = nt_alloc(g->vertex_count, sizeof *w.number),
		.taken = nt_calloc(g->triangle_count, 1),
		.first = nt_alloc(g->vertex_count + 1, sizeof *w.first),
		.around = nt_alloc(3 * g->triangle_count, sizeof *w.around)};
	nt_status status = NT_ERROR_MEMORY;
	if (sample->indices && sample->vertices && w.number && w.taken && w.first && w.around) {
		memset(w.number, 0xff, g->vertex_count * sizeof *w.number);
		status = NT_OK;
		choose(&w, report, mesh);
		sample->whole = sample->triangle_count == g->triangle_count;
	}
	free(w.number);
	free(w.taken);
	free(w.first);
	free(w.around);
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

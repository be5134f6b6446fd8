/* SPDX-License-Identifier: MIT */
/*
 * Choosing triangles for a page: see sample.h. Linear in the size of the mesh.
 */
#include "report/pack/sample.h"

#include <stdlib.h>
#include <string.h>

typedef struct growth {
	const nt_report_geometry *geometry;
	uint8_t *taken;    /* [triangle_count] */
	uint8_t *met;      /* [vertex_count] whether the queue has it */
	uint32_t *queue;   /* [vertex_count] vertices in the order in which they were met */
	size_t *first;     /* [vertex_count + 1] where a vertex's triangles begin in `around` */
	uint32_t *around;  /* [3 * triangle_count] triangles by vertex */
	size_t queued, count, most;
} growth;

static void take(growth *w, size_t t)
{
	if (w->taken[t] || w->count == w->most)
		return;
	w->taken[t] = 1;
	w->count++;
	for (int k = 0; k < 3; k++) {
		const uint32_t vertex = w->geometry->indices[3 * t + (size_t)k];
		if (!w->met[vertex])
			w->queue[w->queued++] = vertex;
		w->met[vertex] = 1;
	}
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
	for (size_t i = 0; i < m->seam_count + m->hard_count; i++) {
		const nt_seam *seam = &m->seams[i];
		for (size_t k = 0; k < seam->edge_count && k < NT_SEAM_EDGES; k++) {
			take(w, seam->edges[k].triangles[0]);
			take(w, seam->edges[k].triangles[1]);
		}
	}
	if (w->count == 0)
		take(w, 0);
}

/* Lists the triangles of every vertex. */
static void list_around(growth *w)
{
	const nt_report_geometry *g = w->geometry;
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

/* Ring after ring around the findings, every triangle looked at three times; then, where those are islands of their
 * own, from the first triangle on. */
static void grow_rings(growth *w)
{
	for (size_t i = 0; i < w->queued && w->count < w->most; i++) {
		const uint32_t vertex = w->queue[i];
		for (size_t k = w->first[vertex]; k < w->first[vertex + 1]; k++)
			take(w, w->around[k]);
	}
	for (size_t t = 0; t < w->geometry->triangle_count && w->count < w->most; t++)
		take(w, t);
}

nt_status nt_sample_triangles(const nt_report *report, uint32_t mesh, size_t most, uint8_t *taken, size_t *count)
{
	const nt_report_geometry *g = report->meshes[mesh].geometry;
	growth w = {.geometry = g, .taken = taken, .most = most,
		.met = nt_calloc(g->vertex_count, 1),
		.queue = nt_alloc(g->vertex_count, sizeof *w.queue),
		.first = nt_calloc(g->vertex_count + 1, sizeof *w.first),
		.around = nt_alloc(3 * g->triangle_count, sizeof *w.around)};
	const bool made = w.met && w.queue && w.first && w.around;
	memset(taken, 0, g->triangle_count);
	if (made) {
		list_around(&w);
		take_findings(&w, report, mesh);
		grow_rings(&w);
	}
	*count = w.count;
	free(w.met);
	free(w.queue);
	free(w.first);
	free(w.around);
	return made ? NT_OK : NT_ERROR_MEMORY;
}

/* SPDX-License-Identifier: MIT */
/*
 * Packing a mesh for a page: see pack.h. Neighbours in the order of use lie beside each other, so that differences are
 * small and their high bytes nearly always zero, which deflate makes nothing of. A triangle of a welded mesh takes two
 * to seven bytes for positions and corners (test_pack.c).
 *
 * If a mesh is too large for a page, it gets what lies around the findings, grown ring by ring, in time that is linear
 * in its size.
 */
#include "report/pack/pack.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "ext/linked.h"

enum { POSITION_CODES = 65535, TEXCOORD_CODES = (1 << 18) - 1, DIRECTION_CODES = 2047 };

/* ---- a part of a mesh ---- */

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

static nt_status sample_triangles(const nt_report *report, uint32_t mesh, size_t most, uint8_t *taken, size_t *count)
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

typedef struct packing {
	const nt_report_geometry *geometry;
	const nt_report_mesh *mesh;
	nt_packed *packed;
	bool v_down;            /* of the geometry's texture coordinates */
	uint8_t *taken;         /* [geometry triangle_count]; NULL: all */
	uint32_t *number;       /* [geometry vertex_count] in the page, NT_NONE */
	uint32_t *vertices;     /* [vertex_count] of the geometry */
	uint32_t *triangles;    /* [triangle_count] of the geometry */
	uint32_t *codes;        /* [3 * triangle_count] of the array that is being written; no fewer than vertices */
	nt_buffer raw;
} packing;

/* Appends an array; of one that is empty only that it is. */
static void put_array(packing *p, const char *name, const uint32_t *values, size_t count)
{
	uint32_t all = 0, before = 0;
	for (size_t i = 0; i < count; i++)
		all |= values[i];
	const unsigned planes = all >> 24 ? 4 : all >> 16 ? 3 : all >> 8 ? 2 : 1, shift = 32 - 8 * planes;
	unsigned char *to = count ? nt_buffer_extend(&p->raw, planes * count) : NULL;
	for (size_t i = 0; to && i < count; i++) {
		/* the difference of so many bits, modulo what they hold; of either sign, as zigzag 0 -1 1 -2 2 ... */
		const int32_t difference = (int32_t)((values[i] - before) << shift) >> shift;
		const uint32_t zigzag = (uint32_t)difference << 1 ^ (uint32_t)(difference >> 31);
		before = values[i];
		for (unsigned k = 0; k < planes; k++)
			to[k * count + i] = (unsigned char)(zigzag >> 8 * k);
	}
	p->packed->arrays[p->packed->array_count++] = (nt_packed_array){name, count, count ? planes : 0};
}

/* ---- which triangles and vertices ---- */

static nt_status choose_triangles(packing *p, const nt_report *report, uint32_t mesh, size_t most)
{
	const nt_report_geometry *g = p->geometry;
	size_t count = g->triangle_count;
	nt_status status = NT_OK;
	p->packed->whole = count <= most;
	if (!p->packed->whole) {
		p->taken = nt_alloc(g->triangle_count, 1);
		status = p->taken ? sample_triangles(report, mesh, most, p->taken, &count) : NT_ERROR_MEMORY;
	}
	p->packed->triangle_count = count;
	p->triangles = nt_alloc(count, sizeof *p->triangles);
	if (status || !p->triangles)
		return NT_ERROR_MEMORY;
	count = 0;
	for (size_t t = 0; t < g->triangle_count; t++)
		if (!p->taken || p->taken[t])
			p->triangles[count++] = (uint32_t)t;
	put_array(p, "numbers", p->triangles, p->packed->whole ? 0 : count);
	return NT_OK;
}

static void put_corners(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	uint32_t next = 0;
	memset(p->number, 0xff, g->vertex_count * sizeof *p->number);
	for (size_t c = 0; c < 3 * p->packed->triangle_count; c++) {
		const uint32_t vertex = g->indices[3 * (size_t)p->triangles[c / 3] + c % 3];
		const bool is_new = p->number[vertex] == NT_NONE;
		if (is_new) {
			p->vertices[next] = vertex;
			p->number[vertex] = next;
		}
		p->codes[c] = next - p->number[vertex];
		next += is_new;
	}
	p->packed->vertex_count = next;
	put_array(p, "corners", p->codes, 3 * p->packed->triangle_count);
}

/* ---- numbers of vertices ---- */

static uint32_t quantise(double value, double origin, double step, unsigned most)
{
	const double code = step > 0.0 ? (value - origin) / step + 0.5 : 0.0;
	return code >= most ? most : code > 0.0 ? (uint32_t)code : 0; /* NaN: 0 */
}

/* The range of one component of rows of `width` floats; what is not finite or larger than `most` is passed over. */
static void measure(const packing *p, const float *rows, size_t width, size_t component, float most, double range[2])
{
	range[0] = INFINITY;
	range[1] = -INFINITY;
	for (size_t v = 0; v < p->packed->vertex_count; v++) {
		const float x = rows[width * p->vertices[v] + component];
		if (fabsf(x) <= most) {
			range[0] = x < range[0] ? x : range[0];
			range[1] = x > range[1] ? x : range[1];
		}
	}
	if (range[0] > range[1])
		range[0] = range[1] = 0.0;
}

static void put_positions(packing *p)
{
	static const char *const names[3] = {"x", "y", "z"};
	const float *positions = p->geometry->positions;
	for (size_t axis = 0; axis < 3; axis++) {
		double range[2];
		measure(p, positions, 3, axis, FLT_MAX, range);
		const double step = (range[1] - range[0]) / POSITION_CODES;
		p->packed->position_origin[axis] = range[0];
		p->packed->position_step[axis] = step;
		for (size_t v = 0; v < p->packed->vertex_count; v++)
			p->codes[v] = quantise(positions[3 * (size_t)p->vertices[v] + axis], range[0], step,
				POSITION_CODES);
		put_array(p, names[axis], p->codes, p->packed->vertex_count);
	}
}

/* v becomes one that points down. */
static void put_texcoords(packing *p)
{
	static const char *const names[2] = {"u", "v"};
	const size_t count = p->geometry->texcoords ? p->packed->vertex_count : 0;
	const float *texcoords = p->geometry->texcoords;
	double *origin = p->packed->texcoord_origin, *step = &p->packed->texcoord_step;
	double range[2][2];
	for (size_t axis = 0; axis < 2 && texcoords; axis++)
		measure(p, texcoords, 2, axis, NT_MOST_TEXCOORD, range[axis]);
	if (texcoords) {
		*step = fmax(range[0][1] - range[0][0], range[1][1] - range[1][0]) / TEXCOORD_CODES;
		origin[0] = range[0][0];
		origin[1] = p->v_down ? range[1][0] : 1.0 - range[1][1];
	}
	for (size_t axis = 0; axis < 2; axis++) {
		for (size_t v = 0; v < count; v++) {
			const double x = texcoords[2 * (size_t)p->vertices[v] + axis];
			p->codes[v] = quantise(axis == 1 && !p->v_down ? 1.0 - x : x, origin[axis], *step,
				TEXCOORD_CODES);
		}
		put_array(p, names[axis], p->codes, count);
	}
}

/* Both components of a direction; one without a length is 0 0, which is a direction too. */
static void encode_direction(const float *d, uint32_t codes[2])
{
	const double sum = fabs((double)d[0]) + fabs((double)d[1]) + fabs((double)d[2]);
	double x = d[0] / sum, y = d[1] / sum;
	if (!(sum > 0.0) || !isfinite(sum))
		x = y = 0.0;
	else if (d[2] < 0.0f) {
		const double fold = (1.0 - fabs(y)) * (x < 0.0 ? -1.0 : 1.0);
		y = (1.0 - fabs(x)) * (y < 0.0 ? -1.0 : 1.0);
		x = fold;
	}
	codes[0] = (uint32_t)(DIRECTION_CODES + x * DIRECTION_CODES + 0.5);
	codes[1] = (uint32_t)(DIRECTION_CODES + y * DIRECTION_CODES + 0.5);
}

/* names: of both components of a direction and, of a tangent, of its sign. rows NULL: there are none. */
static void put_directions(packing *p, const float *rows, size_t width, const char *const names[3])
{
	const size_t count = rows ? p->packed->vertex_count : 0;
	for (size_t axis = 0; axis < 2; axis++) {
		for (size_t v = 0; v < count; v++) {
			uint32_t both[2];
			encode_direction(rows + width * p->vertices[v], both);
			p->codes[v] = both[axis];
		}
		put_array(p, names[axis], p->codes, count);
	}
	for (size_t v = 0; v < count && width == 4; v++) {
		const float *t = rows + 4 * (size_t)p->vertices[v];
		const bool there = isfinite(t[0] + t[1] + t[2]) && (t[0] != 0.0f || t[1] != 0.0f || t[2] != 0.0f);
		p->codes[v] = !there ? 0 : t[3] > 0.0f ? 1 : t[3] < 0.0f ? 2 : 0;
	}
	if (width == 4)
		put_array(p, names[2], p->codes, count);
}

/* ---- triangles ---- */

static bool is_finite_triangle(const nt_report_geometry *g, const uint32_t *corners)
{
	for (size_t k = 0; k < 3; k++)
		for (size_t axis = 0; axis < 3; axis++)
			if (!isfinite(g->positions[3 * (size_t)corners[k] + axis]))
				return false;
	return true;
}

static void put_triangles(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	const size_t count = p->packed->triangle_count;
	for (size_t i = 0; i < count; i++) {
		const size_t t = p->triangles[i];
		p->codes[i] = (uint32_t)(g->orientation[t] + 1) |
			(is_finite_triangle(g, g->indices + 3 * t) ? 0 : 4);
	}
	put_array(p, "kinds", p->codes, count);
	for (size_t i = 0; i < count; i++)
		p->codes[i] = g->islands[p->triangles[i]] + 1; /* NT_NONE + 1 is 0 */
	put_array(p, "islands", p->codes, count);
}

/* ---- seams ---- */

/* The corner of a triangle that has these texture coordinates, as the page numbers it; NT_NONE. */
static uint32_t find_corner(const packing *p, uint32_t triangle, const float *texcoord)
{
	const nt_report_geometry *g = p->geometry;
	for (size_t k = 0; k < 3 && triangle < g->triangle_count && g->texcoords; k++) {
		const uint32_t vertex = g->indices[3 * (size_t)triangle + k];
		const float *uv = g->texcoords + 2 * (size_t)vertex;
		if (uv[0] == texcoord[0] && uv[1] == texcoord[1])
			return p->number[vertex];
	}
	return NT_NONE;
}

/* False where the page does not have the edge. */
static bool find_edge(const packing *p, const nt_seam_edge *edge, uint32_t ends[4])
{
	bool found = true;
	for (unsigned side = 0; side < 2; side++)
		for (unsigned end = 0; end < 2; end++) {
			ends[2 * side + end] = find_corner(p, edge->triangles[side], edge->texcoords[side][end]);
			found &= ends[2 * side + end] != NT_NONE;
		}
	return found;
}

static void put_seams(packing *p)
{
	const size_t count = p->mesh->seams ? p->mesh->seam_count + p->mesh->hard_count : 0;
	nt_buffer edges = {0}, ends = {0}; /* of uint32_t */
	p->packed->seam_count = count;
	for (size_t s = 0; s < count; s++) {
		const nt_seam *seam = &p->mesh->seams[s];
		uint32_t found = 0, both[4];
		for (size_t i = 0; i < seam->edge_count && i < NT_SEAM_EDGES; i++) {
			if (!find_edge(p, &seam->edges[i], both))
				continue;
			nt_buffer_append(&ends, both, sizeof both);
			found++;
		}
		nt_buffer_append(&edges, &found, sizeof found);
	}
	put_array(p, "seam_edges", (const uint32_t *)(const void *)edges.data, edges.size / sizeof(uint32_t));
	put_array(p, "seam_ends", (const uint32_t *)(const void *)ends.data, ends.size / sizeof(uint32_t));
	nt_buffer_free_into(&edges, &p->raw);
	nt_buffer_free_into(&ends, &p->raw);
}

/* ---- all of it ---- */

static nt_status pack(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	p->number = nt_alloc(g->vertex_count, sizeof *p->number);
	p->vertices = nt_alloc(g->vertex_count, sizeof *p->vertices);
	p->codes = nt_alloc(3 * p->packed->triangle_count, sizeof *p->codes);
	if (!p->number || !p->vertices || !p->codes)
		return NT_ERROR_MEMORY;
	put_corners(p);
	put_positions(p);
	put_directions(p, g->normals, 3, (const char *const[]){"nx", "ny", NULL});
	put_texcoords(p);
	put_directions(p, g->authored, 4, (const char *const[]){"ax", "ay", "aw"});
	put_directions(p, g->computed, 4, (const char *const[]){"cx", "cy", "cw"});
	put_triangles(p);
	put_seams(p);
	return p->raw.failed ? NT_ERROR_MEMORY : NT_OK;
}

nt_status nt_pack_mesh(nt_packed *packed, const nt_report *report, uint32_t mesh, size_t most)
{
	*packed = (nt_packed){0};
	packing p = {.geometry = report->meshes[mesh].geometry, .mesh = &report->meshes[mesh], .packed = packed,
		.v_down = nt_format_is_gltf(report->format)};
	nt_status status = choose_triangles(&p, report, mesh, most);
	if (!status)
		status = pack(&p);
	if (!status) {
		nt_deflate(p.raw.data, p.raw.size, &packed->bytes);
		status = packed->bytes.failed ? NT_ERROR_MEMORY : NT_OK;
	}
	nt_buffer_free(&p.raw);
	free(p.taken);
	free(p.number);
	free(p.vertices);
	free(p.triangles);
	free(p.codes);
	return status;
}

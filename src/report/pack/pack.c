/* SPDX-License-Identifier: MIT */
/*
 * Packing a mesh for a page: see pack.h. Streams are chosen so that deflate finds what is alike: neighbours in the
 * order of use lie beside each other, so that differences are small and their high bytes nearly always zero. A triangle
 * of a welded mesh takes two to seven bytes for positions and indices (test_pack.c). Memory is some forty bytes a
 * triangle while it runs.
 */
#include "report/pack/pack.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "ext/deflate.h"
#include "report/pack/outline.h"
#include "report/pack/sample.h"
#include "report/pack/varint.h"

enum { POSITION_CODES = 65535, TEXCOORD_CODES = (1 << 18) - 1, DIRECTION_CODES = 2047 };

/* Texture coordinates beyond this are no place in a texture; they would leave the others without precision. */
static const float MOST_TEXCOORD = 1e6f;

typedef struct packing {
	const nt_report_geometry *geometry;
	const nt_report_mesh *mesh;
	nt_packed *packed;
	bool v_down;            /* of the geometry's texture coordinates */
	uint8_t *taken;         /* [geometry triangle_count]; NULL: all */
	uint32_t *number;       /* [geometry vertex_count] in the page, NT_NONE */
	uint32_t *vertices;     /* [vertex_count] of the geometry */
	uint32_t *triangles;    /* [triangle_count] of the geometry */
	nt_buffer raw;
	size_t stream, begin;   /* the stream that is being written */
} packing;

/* Ends a stream: notes its length. */
static void end_stream(packing *p)
{
	const uint32_t size = (uint32_t)(p->raw.size - p->begin);
	for (unsigned i = 0; i < 4 && p->raw.data; i++)
		p->raw.data[4 * p->stream + i] = (char)(size >> 8 * i & 255);
	p->stream++;
	p->begin = p->raw.size;
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
		status = p->taken ? nt_sample_triangles(report, mesh, most, p->taken, &count) : NT_ERROR_MEMORY;
	}
	p->packed->triangle_count = count;
	p->triangles = nt_alloc(count, sizeof *p->triangles);
	if (status || !p->triangles)
		return NT_ERROR_MEMORY;
	count = 0;
	for (size_t t = 0; t < g->triangle_count; t++)
		if (!p->taken || p->taken[t])
			p->triangles[count++] = (uint32_t)t;
	return NT_OK;
}

static void put_indices(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	uint32_t next = 0;
	memset(p->number, 0xff, g->vertex_count * sizeof *p->number);
	for (size_t t = 0; t < p->packed->triangle_count; t++) {
		for (size_t k = 0; k < 3; k++) {
			const uint32_t vertex = g->indices[3 * (size_t)p->triangles[t] + k];
			if (p->number[vertex] == NT_NONE) {
				p->vertices[next] = vertex;
				p->number[vertex] = next++;
				nt_put_varint(0, &p->raw);
			} else {
				nt_put_varint(next - p->number[vertex], &p->raw);
			}
		}
	}
	p->packed->vertex_count = next;
	end_stream(p);
}

/* ---- numbers of vertices ---- */

/* Appends planes of one component: codes[v] is that of the page's vertex v. */
static void put_planes(packing *p, const uint32_t *codes, unsigned planes)
{
	const size_t count = p->packed->vertex_count;
	unsigned char *to = nt_buffer_extend(&p->raw, planes * count);
	uint32_t before = 0;
	for (size_t v = 0; to && v < count; v++) {
		/* the difference of so many bits, modulo what they hold */
		const uint32_t shift = 32 - 8 * planes;
		const uint32_t code = nt_zigzag((uint32_t)((int32_t)((codes[v] - before) << shift) >> shift));
		before = codes[v];
		for (unsigned i = 0; i < planes; i++)
			to[i * count + v] = (unsigned char)(code >> 8 * i);
	}
}

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

static void put_positions(packing *p, uint32_t *codes)
{
	const float *positions = p->geometry->positions;
	for (size_t axis = 0; axis < 3; axis++) {
		double range[2];
		measure(p, positions, 3, axis, FLT_MAX, range);
		const double step = (range[1] - range[0]) / POSITION_CODES;
		p->packed->position_origin[axis] = range[0];
		p->packed->position_step[axis] = step;
		for (size_t v = 0; v < p->packed->vertex_count; v++)
			codes[v] = quantise(positions[3 * (size_t)p->vertices[v] + axis], range[0], step,
				POSITION_CODES);
		put_planes(p, codes, 2);
	}
	end_stream(p);
}

/* v becomes one that points down. */
static void put_texcoords(packing *p, uint32_t *codes)
{
	const float *texcoords = p->geometry->texcoords;
	double *origin = p->packed->texcoord_origin, *step = &p->packed->texcoord_step;
	double range[2][2];
	for (size_t axis = 0; axis < 2 && texcoords; axis++)
		measure(p, texcoords, 2, axis, MOST_TEXCOORD, range[axis]);
	if (texcoords) {
		*step = fmax(range[0][1] - range[0][0], range[1][1] - range[1][0]) / TEXCOORD_CODES;
		origin[0] = range[0][0];
		origin[1] = p->v_down ? range[1][0] : 1.0 - range[1][1];
	}
	for (size_t axis = 0; axis < 2 && texcoords; axis++) {
		for (size_t v = 0; v < p->packed->vertex_count; v++) {
			const double x = texcoords[2 * (size_t)p->vertices[v] + axis];
			codes[v] = quantise(axis == 1 && !p->v_down ? 1.0 - x : x, origin[axis], *step, TEXCOORD_CODES);
		}
		put_planes(p, codes, 3);
	}
	end_stream(p);
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

static void put_directions(packing *p, const float *rows, size_t width, uint32_t *codes)
{
	for (size_t axis = 0; axis < 2 && rows; axis++) {
		for (size_t v = 0; v < p->packed->vertex_count; v++) {
			uint32_t both[2];
			encode_direction(rows + width * p->vertices[v], both);
			codes[v] = both[axis];
		}
		put_planes(p, codes, 2);
	}
}

static void put_tangents(packing *p, const float *tangents, uint32_t *codes)
{
	put_directions(p, tangents, 4, codes);
	for (size_t v = 0; v < p->packed->vertex_count && tangents; v++) {
		const float *t = tangents + 4 * (size_t)p->vertices[v];
		const bool there = isfinite(t[0] + t[1] + t[2]) && (t[0] != 0.0f || t[1] != 0.0f || t[2] != 0.0f);
		const char sign = !there ? 0 : t[3] > 0.0f ? 1 : t[3] < 0.0f ? 2 : 0;
		nt_buffer_append(&p->raw, &sign, 1);
	}
	end_stream(p);
}

static nt_status put_vertices(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	uint32_t *codes = nt_alloc(p->packed->vertex_count, sizeof *codes);
	if (!codes)
		return NT_ERROR_MEMORY;
	put_positions(p, codes);
	put_directions(p, g->normals, 3, codes);
	end_stream(p);
	put_texcoords(p, codes);
	put_tangents(p, g->authored, codes);
	put_tangents(p, g->computed, codes);
	free(codes);
	return NT_OK;
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
		const char kind = (char)((g->orientation[t] + 1) | (is_finite_triangle(g, g->indices + 3 * t) ? 0 : 4));
		nt_buffer_append(&p->raw, &kind, 1);
	}
	end_stream(p);
	uint32_t before = 0;
	for (size_t i = 0; i < count && g->islands; i++) {
		const uint32_t island = g->islands[p->triangles[i]] + 1; /* NT_NONE + 1 is 0 */
		nt_put_varint(nt_zigzag(island - before), &p->raw);
		before = island;
	}
	end_stream(p);
}

/* Outlines of the triangles that are there, with the page's numbers. */
static nt_status put_outlines(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	const size_t vertices = p->packed->vertex_count, triangles = p->packed->triangle_count;
	if (!g->texcoords)
		return NT_OK;
	uint32_t *indices = nt_alloc(3 * triangles, sizeof *indices), *islands = nt_alloc(triangles, sizeof *islands);
	float *texcoords = nt_alloc(2 * vertices, sizeof *texcoords);
	int8_t *orientation = nt_alloc(triangles, 1);
	nt_status status = NT_ERROR_MEMORY;
	if (indices && islands && texcoords && orientation) {
		for (size_t i = 0; i < triangles; i++) {
			const size_t t = p->triangles[i];
			for (size_t k = 0; k < 3; k++)
				indices[3 * i + k] = p->number[g->indices[3 * t + k]];
			islands[i] = g->islands ? g->islands[t] : 0;
			orientation[i] = g->orientation[t];
		}
		for (size_t v = 0; v < vertices; v++)
			memcpy(texcoords + 2 * v, g->texcoords + 2 * (size_t)p->vertices[v], 2 * sizeof *texcoords);
		const nt_outlined outlined = {vertices, triangles, indices, texcoords, orientation, islands};
		status = nt_outline_islands(&outlined, &p->raw);
	}
	free(indices);
	free(islands);
	free(texcoords);
	free(orientation);
	return status;
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

static void put_seam(packing *p, const nt_seam *seam, uint32_t *before)
{
	nt_buffer edges = {0};
	uint32_t count = 0, ends[4];
	for (size_t i = 0; i < seam->edge_count && i < NT_SEAM_EDGES; i++) {
		if (!find_edge(p, &seam->edges[i], ends))
			continue;
		count++;
		for (unsigned k = 0; k < 4; k++) {
			nt_put_varint(nt_zigzag(ends[k] - *before), &edges);
			*before = ends[k];
		}
	}
	nt_put_varint(count, &p->raw);
	nt_buffer_append(&p->raw, edges.data, edges.size);
	nt_buffer_free_into(&edges, &p->raw);
}

static void put_seams_and_numbers(packing *p)
{
	uint32_t before = 0;
	for (size_t i = 0; p->mesh->seams && i < p->mesh->seam_count + p->mesh->hard_count; i++)
		put_seam(p, &p->mesh->seams[i], &before);
	end_stream(p);
	before = 0;
	for (size_t i = 0; i < p->packed->triangle_count && !p->packed->whole; i++) {
		nt_put_varint(p->triangles[i] - before, &p->raw);
		before = p->triangles[i];
	}
	end_stream(p);
}

/* ---- all of it ---- */

static nt_status pack(packing *p)
{
	const nt_report_geometry *g = p->geometry;
	char *lengths = nt_buffer_extend(&p->raw, 4 * NT_STREAM_COUNT);
	p->number = nt_alloc(g->vertex_count, sizeof *p->number);
	p->vertices = nt_alloc(g->vertex_count, sizeof *p->vertices);
	if (!lengths || !p->number || !p->vertices)
		return NT_ERROR_MEMORY;
	p->begin = p->raw.size;
	put_indices(p);
	nt_status status = put_vertices(p);
	if (status)
		return status;
	put_triangles(p);
	status = put_outlines(p);
	end_stream(p);
	if (!status)
		put_seams_and_numbers(p);
	return status || p->raw.failed ? NT_ERROR_MEMORY : NT_OK;
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
		packed->raw_bytes = p.raw.size;
		nt_deflate(p.raw.data, p.raw.size, &packed->bytes);
		status = packed->bytes.failed ? NT_ERROR_MEMORY : NT_OK;
	}
	nt_buffer_free(&p.raw);
	free(p.taken);
	free(p.number);
	free(p.vertices);
	free(p.triangles);
	return status;
}

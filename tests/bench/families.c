/* SPDX-License-Identifier: MIT */
/*
 * Bench meshes: see families.h. All are a torus of rows and columns with a UV seam in both directions, so
 * that no two of its vertices are equal.
 */
#include "families.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "measure.h"

const char *const nt_family_names[NT_FAMILY_COUNT] = {"clean", "noise, mirror seam", "shuffled", "de-indexed",
	"mirrored every 4", "zero-UV 18 %", "collapsed 10 %", "quads", "hubs of 100 000", "collapsed 50 %"};

static float random_float(nt_random *random)
{
	return (float)(2 * nt_random_real(random) - 1);
}

/* Columns of texture: u grows, or runs back and forth over `period` columns, or turns once in the middle. */
static float column_u(nt_family family, size_t column, size_t columns)
{
	if (family == NT_FAMILY_MIRRORED) {
		const size_t at = column % 8;
		return (float)(at < 4 ? at : 8 - at) / 4.0f;
	}
	if (family == NT_FAMILY_NOISE && column > columns / 2)
		return (float)(columns - column) / (float)columns;
	return (float)column / (float)columns;
}

static void torus_vertex(nt_family family, size_t row, size_t rows, size_t column, size_t columns,
	nt_random *random, float *p, float *n, float *t)
{
	const double a = 6.283185307179586 * (double)row / (double)rows;
	const double b = 6.283185307179586 * (double)column / (double)columns;
	const float noise = family == NT_FAMILY_NOISE ? 1.0f : 0.0f;
	n[0] = (float)(cos(a) * cos(b)) + 0.05f * noise * random_float(random);
	n[1] = (float)(cos(a) * sin(b)) + 0.05f * noise * random_float(random);
	n[2] = (float)sin(a) + 0.05f * noise * random_float(random);
	const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	n[0] /= length, n[1] /= length, n[2] /= length;
	const float step = 3.0f / (float)columns;
	p[0] = (float)((2.0 + cos(a)) * cos(b)) + step * noise * random_float(random);
	p[1] = (float)((2.0 + cos(a)) * sin(b)) + step * noise * random_float(random);
	p[2] = (float)sin(a) + step * noise * random_float(random);
	t[0] = column_u(family, column, columns) + 0.2f / (float)columns * noise * random_float(random);
	t[1] = (float)row / (float)rows + 0.2f / (float)rows * noise * random_float(random);
}

static nt_owned make_torus(nt_family family, size_t triangles, nt_random *random)
{
	const size_t columns = (size_t)sqrt((double)triangles / 2.0) + 1;
	const size_t rows = triangles / 2 / columns + 1, cells = rows * columns, vertices = (rows + 1) * (columns + 1);
	const bool quads = family == NT_FAMILY_QUADS;
	nt_owned m = quads ? nt_owned_make_quads(vertices, cells) : nt_owned_make(vertices, 2 * cells);
	for (size_t r = 0; r <= rows; r++)
		for (size_t c = 0; c <= columns; c++) {
			const size_t v = r * (columns + 1) + c;
			torus_vertex(family, r, rows, c, columns, random, m.positions[v], m.normals[v], m.texcoords[v]);
		}
	uint32_t *out = m.indices;
	for (size_t r = 0; r < rows; r++)
		for (size_t c = 0; c < columns; c++) {
			const uint32_t i = (uint32_t)(r * (columns + 1) + c), j = i + 1;
			const uint32_t k = (uint32_t)(j + columns + 1), l = (uint32_t)(i + columns + 1);
			const uint32_t quad[4] = {i, j, k, l}, pair[6] = {i, j, k, i, k, l};
			memcpy(out, quads ? quad : pair, (quads ? 4 : 6) * sizeof *out);
			out += quads ? 4 : 6;
		}
	return m;
}

static void swap(void *a, void *b, size_t size)
{
	unsigned char kept[16];
	memcpy(kept, a, size);
	memcpy(a, b, size);
	memcpy(b, kept, size);
}

static void shuffle(nt_owned *m, nt_random *random)
{
	const size_t vertices = m->mesh.vertex_count;
	uint32_t *place = measure_room(vertices, sizeof *place), *at = measure_room(vertices, sizeof *at);
	for (size_t v = 0; v < vertices; v++)
		at[v] = (uint32_t)v;
	for (size_t i = vertices; i > 1; i--) {
		const size_t j = nt_random_below(random, (uint32_t)i);
		swap(m->positions[i - 1], m->positions[j], 12);
		swap(m->normals[i - 1], m->normals[j], 12);
		swap(m->texcoords[i - 1], m->texcoords[j], 8);
		swap(&at[i - 1], &at[j], sizeof *at);
	}
	for (size_t i = 0; i < vertices; i++)
		place[at[i]] = (uint32_t)i;
	for (size_t c = 0; c < m->corner_count; c++)
		m->indices[c] = place[m->indices[c]];
	for (size_t t = m->mesh.face_count; t > 1; t--)
		swap(m->indices + 3 * (t - 1), m->indices + 3 * (size_t)nt_random_below(random, (uint32_t)t),
			3 * sizeof *m->indices);
	free(place);
	free(at);
}

static void deindex(nt_owned *m)
{
	nt_owned flat = nt_owned_make(m->corner_count, m->mesh.face_count);
	for (size_t c = 0; c < m->corner_count; c++) {
		memcpy(flat.positions[c], m->positions[m->indices[c]], 12);
		memcpy(flat.normals[c], m->normals[m->indices[c]], 12);
		memcpy(flat.texcoords[c], m->texcoords[m->indices[c]], 8);
	}
	flat.mesh.indices = NULL;
	nt_owned_free(m);
	*m = flat;
}

/* Texture coordinates of single triangles onto a point: both of an edge's ends take those of the first. */
static void flatten_uvs(nt_owned *m, nt_random *random)
{
	/* an edge collapses in UV for one vertex in 22: its two triangles lose their area */
	for (size_t t = 0; t < m->mesh.face_count; t += 2)
		if (nt_random_below(random, 22) == 0) {
			const uint32_t *v = m->indices + 3 * t;
			memcpy(m->texcoords[v[1]], m->texcoords[v[0]], 8);
		}
}

/* Behind every n triangles comes one that repeats a corner of the last. */
static void add_collapsed(nt_owned *m, size_t n)
{
	const size_t added = m->mesh.face_count / n;
	uint32_t *indices = measure_room(m->corner_count + 3 * added, sizeof *indices), *out = indices;
	for (size_t t = 0; t < m->mesh.face_count; t++, out += 3) {
		const uint32_t *v = m->indices + 3 * t;
		memcpy(out, v, 3 * sizeof *v);
		if (t % n == n - 1 && t / n < added) {
			out += 3;
			memcpy(out, (uint32_t[3]){v[0], v[0], v[2]}, 3 * sizeof *v);
		}
	}
	free(m->indices);
	m->mesh.indices = m->indices = indices;
	m->mesh.face_count += added;
	m->corner_count += 3 * added;
}

static nt_owned make_hubs(size_t triangles)
{
	const size_t spokes = triangles < 100000 ? triangles : 100000, hubs = triangles / spokes;
	nt_owned m = nt_owned_make(hubs * (spokes + 1), hubs * spokes);
	for (size_t h = 0; h < hubs; h++)
		for (size_t i = 0; i <= spokes; i++) {
			const size_t v = h * (spokes + 1) + i;
			const double a = 6.283185307179586 * (double)i / (double)spokes;
			const float x = i ? (float)cos(a) : 0.0f, y = i ? (float)sin(a) : 0.0f;
			memcpy(m.positions[v], (float[3]){x + 3.0f * (float)h, y, 0.0f}, 12);
			memcpy(m.normals[v], (float[3]){0.0f, 0.0f, 1.0f}, 12);
			memcpy(m.texcoords[v], (float[2]){x, y}, 8);
		}
	for (size_t h = 0; h < hubs; h++)
		for (size_t i = 0; i < spokes; i++) {
			const uint32_t hub = (uint32_t)(h * (spokes + 1)), next = (uint32_t)((i + 1) % spokes);
			const uint32_t corners[3] = {hub, hub + 1 + (uint32_t)i, hub + 1 + next};
			memcpy(m.indices + 3 * (h * spokes + i), corners, sizeof corners);
		}
	return m;
}

nt_owned nt_family_make(nt_family family, size_t triangles)
{
	nt_random random = nt_random_seed(1);
	nt_owned m = family == NT_FAMILY_HUB ? make_hubs(triangles) : make_torus(family, triangles, &random);
	if (family == NT_FAMILY_SHUFFLED)
		shuffle(&m, &random);
	if (family == NT_FAMILY_DEINDEXED)
		deindex(&m);
	if (family == NT_FAMILY_ZERO_UV)
		flatten_uvs(&m, &random);
	if (family == NT_FAMILY_COLLAPSED || family == NT_FAMILY_HALF)
		add_collapsed(&m, family == NT_FAMILY_HALF ? 1 : 10);
	return m;
}

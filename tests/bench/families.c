/* SPDX-License-Identifier: MIT */
/*
 * Bench meshes: see families.h. All are a torus of rows and columns with a UV seam in both directions, so
 * that no two of its vertices are equal.
 */
#include "families.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

const char *const nt_family_names[NT_FAMILY_COUNT] = {"clean", "noise, mirror seam", "shuffled", "de-indexed",
	"mirrored every 4", "zero-UV 18 %", "collapsed 10 %", "quads", "hubs of 100 000", "collapsed 50 %"};

static uint64_t random_state = 1;

static uint32_t random_below(uint32_t count)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 7;
	random_state ^= random_state << 17;
	return (uint32_t)((random_state >> 32) * count >> 32);
}

static float random_float(void)
{
	return (float)random_below(1 << 24) * 0x1p-23f - 1.0f;
}

static int allocate(nt_family_mesh *m, size_t vertices, size_t corners)
{
	m->corner_count = corners;
	m->mesh.struct_bytes = sizeof m->mesh;
	m->mesh.vertex_count = vertices;
	m->positions = malloc(vertices * 12);
	m->normals = malloc(vertices * 12);
	m->texcoords = malloc(vertices * 8);
	m->indices = malloc(corners * sizeof *m->indices);
	return m->positions && m->normals && m->texcoords && m->indices;
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

static void torus_vertex(nt_family family, size_t row, size_t rows, size_t column, size_t columns, float *p,
	float *n, float *t)
{
	const double a = 6.283185307179586 * (double)row / (double)rows;
	const double b = 6.283185307179586 * (double)column / (double)columns;
	const float noise = family == NT_FAMILY_NOISE ? 1.0f : 0.0f;
	n[0] = (float)(cos(a) * cos(b)) + 0.05f * noise * random_float();
	n[1] = (float)(cos(a) * sin(b)) + 0.05f * noise * random_float();
	n[2] = (float)sin(a) + 0.05f * noise * random_float();
	const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	n[0] /= length, n[1] /= length, n[2] /= length;
	const float step = 3.0f / (float)columns;
	p[0] = (float)((2.0 + cos(a)) * cos(b)) + step * noise * random_float();
	p[1] = (float)((2.0 + cos(a)) * sin(b)) + step * noise * random_float();
	p[2] = (float)sin(a) + step * noise * random_float();
	t[0] = column_u(family, column, columns) + 0.2f / (float)columns * noise * random_float();
	t[1] = (float)row / (float)rows + 0.2f / (float)rows * noise * random_float();
}

static int make_torus(nt_family family, size_t triangles, nt_family_mesh *m)
{
	const size_t columns = (size_t)sqrt((double)triangles / 2.0) + 1;
	const size_t rows = triangles / 2 / columns + 1;
	const size_t faces = rows * columns;
	const bool quads = family == NT_FAMILY_QUADS;
	if (!allocate(m, (rows + 1) * (columns + 1), faces * (quads ? 4 : 6)))
		return 0;
	for (size_t r = 0; r <= rows; r++)
		for (size_t c = 0; c <= columns; c++) {
			const size_t v = r * (columns + 1) + c;
			torus_vertex(family, r, rows, c, columns, m->positions + 3 * v, m->normals + 3 * v,
				m->texcoords + 2 * v);
		}
	unsigned *out = m->indices;
	for (size_t r = 0; r < rows; r++)
		for (size_t c = 0; c < columns; c++) {
			const unsigned i = (unsigned)(r * (columns + 1) + c), j = i + 1;
			const unsigned k = (unsigned)(j + columns + 1), l = (unsigned)(i + columns + 1);
			const unsigned quad[4] = {i, j, k, l}, pair[6] = {i, j, k, i, k, l};
			memcpy(out, quads ? quad : pair, (quads ? 4 : 6) * sizeof *out);
			out += quads ? 4 : 6;
		}
	if (quads) {
		m->face_sizes = malloc(faces);
		if (!m->face_sizes)
			return 0;
		memset(m->face_sizes, 4, faces);
	}
	m->triangle_count = 2 * faces;
	return 1;
}

static void swap_rows(float *rows, size_t floats, size_t i, size_t j)
{
	for (size_t c = 0; c < floats; c++) {
		const float value = rows[floats * i + c];
		rows[floats * i + c] = rows[floats * j + c];
		rows[floats * j + c] = value;
	}
}

static int shuffle(nt_family_mesh *m)
{
	const size_t vertices = m->mesh.vertex_count;
	unsigned *place = malloc(vertices * sizeof *place), *at = malloc(vertices * sizeof *at);
	if (!place || !at)
		return 0;
	for (size_t v = 0; v < vertices; v++)
		at[v] = (unsigned)v;
	for (size_t i = vertices; i > 1; i--) {
		const size_t j = random_below((uint32_t)i);
		swap_rows(m->positions, 3, i - 1, j);
		swap_rows(m->normals, 3, i - 1, j);
		swap_rows(m->texcoords, 2, i - 1, j);
		const unsigned v = at[i - 1];
		at[i - 1] = at[j];
		at[j] = v;
	}
	for (size_t i = 0; i < vertices; i++)
		place[at[i]] = (unsigned)i;
	for (size_t c = 0; c < m->corner_count; c++)
		m->indices[c] = place[m->indices[c]];
	for (size_t t = m->triangle_count; t > 1; t--) {
		unsigned *a = m->indices + 3 * (t - 1), *b = m->indices + 3 * (size_t)random_below((uint32_t)t);
		for (int k = 0; k < 3; k++) {
			const unsigned v = a[k];
			a[k] = b[k];
			b[k] = v;
		}
	}
	free(place);
	free(at);
	return 1;
}

static float *expand(const float *rows, size_t floats, const unsigned *indices, size_t corners)
{
	float *result = malloc(corners * floats * sizeof *result);
	for (size_t c = 0; result && c < corners; c++)
		memcpy(result + floats * c, rows + floats * indices[c], floats * sizeof *result);
	return result;
}

static int deindex(nt_family_mesh *m)
{
	nt_family_mesh flat = *m;
	flat.positions = expand(m->positions, 3, m->indices, m->corner_count);
	flat.normals = expand(m->normals, 3, m->indices, m->corner_count);
	flat.texcoords = expand(m->texcoords, 2, m->indices, m->corner_count);
	flat.indices = NULL;
	flat.mesh.vertex_count = m->corner_count;
	nt_family_free(m);
	*m = flat;
	return m->positions && m->normals && m->texcoords;
}

/* Texture coordinates of single triangles onto a point: both of an edge's ends take those of the first. */
static void flatten_uvs(nt_family_mesh *m)
{
	/* an edge collapses in UV for one vertex in 22: its two triangles lose their area */
	for (size_t t = 0; t < m->triangle_count; t += 2)
		if (random_below(22) == 0) {
			const unsigned *v = m->indices + 3 * t;
			memcpy(m->texcoords + 2 * (size_t)v[1], m->texcoords + 2 * (size_t)v[0], 8);
		}
}

/* Behind every n triangles comes one that repeats a corner of the last. */
static int add_collapsed(nt_family_mesh *m, size_t n)
{
	const size_t added = m->triangle_count / n;
	unsigned *indices = malloc((m->corner_count + 3 * added) * sizeof *indices), *out = indices;
	if (!indices)
		return 0;
	for (size_t t = 0; t < m->triangle_count; t++, out += 3) {
		const unsigned *v = m->indices + 3 * t;
		memcpy(out, v, 3 * sizeof *v);
		if (t % n == n - 1 && t / n < added) {
			out += 3;
			memcpy(out, (unsigned[3]){v[0], v[0], v[2]}, 3 * sizeof *v);
		}
	}
	free(m->indices);
	m->indices = indices;
	m->triangle_count += added;
	m->corner_count += 3 * added;
	return 1;
}

static int make_hubs(size_t triangles, nt_family_mesh *m)
{
	const size_t spokes = triangles < 100000 ? triangles : 100000, hubs = triangles / spokes;
	if (!allocate(m, hubs * (spokes + 1), hubs * spokes * 3))
		return 0;
	for (size_t h = 0; h < hubs; h++)
		for (size_t i = 0; i <= spokes; i++) {
			const size_t v = h * (spokes + 1) + i;
			const double a = 6.283185307179586 * (double)i / (double)spokes;
			const float x = i ? (float)cos(a) : 0.0f, y = i ? (float)sin(a) : 0.0f;
			memcpy(m->positions + 3 * v, (float[3]){x + 3.0f * (float)h, y, 0.0f}, 12);
			memcpy(m->normals + 3 * v, (float[3]){0.0f, 0.0f, 1.0f}, 12);
			memcpy(m->texcoords + 2 * v, (float[2]){x, y}, 8);
		}
	for (size_t h = 0; h < hubs; h++)
		for (size_t i = 0; i < spokes; i++) {
			const unsigned first = (unsigned)(h * (spokes + 1));
			unsigned *v = m->indices + 3 * (h * spokes + i);
			v[0] = first;
			v[1] = first + 1 + (unsigned)i;
			v[2] = first + 1 + (unsigned)((i + 1) % spokes);
		}
	m->triangle_count = hubs * spokes;
	return 1;
}

int nt_family_make(nt_family family, size_t triangles, nt_family_mesh *m)
{
	memset(m, 0, sizeof *m);
	random_state = 88172645463325252u;
	int made = family == NT_FAMILY_HUB ? make_hubs(triangles, m) : make_torus(family, triangles, m);
	if (made && family == NT_FAMILY_SHUFFLED)
		made = shuffle(m);
	if (made && family == NT_FAMILY_DEINDEXED)
		made = deindex(m);
	if (made && family == NT_FAMILY_ZERO_UV)
		flatten_uvs(m);
	if (made && (family == NT_FAMILY_COLLAPSED || family == NT_FAMILY_HALF))
		made = add_collapsed(m, family == NT_FAMILY_HALF ? 1 : 10);
	m->mesh.face_count = m->face_sizes ? m->triangle_count / 2 : m->triangle_count;
	m->mesh.face_sizes = m->face_sizes;
	m->mesh.indices = m->indices;
	m->mesh.positions = m->positions;
	m->mesh.normals = m->normals;
	m->mesh.texcoords = m->texcoords;
	return made;
}

void nt_family_free(nt_family_mesh *m)
{
	free(m->positions);
	free(m->normals);
	free(m->texcoords);
	free(m->indices);
	free(m->face_sizes);
	memset(m, 0, sizeof *m);
}

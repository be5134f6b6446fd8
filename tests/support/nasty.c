/* SPDX-License-Identifier: MIT */
/*
 * Nasty meshes: see nasty.h. A shape is drawn first, then each kind of damage with its own probability, then
 * how the arrays are laid out.
 */
#include "nasty.h"

#include <float.h>
#include <stdbool.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FACES = 2048, MOST_ROWS = 2048 };

typedef struct row {
	float p[3], n[3], t[2];
} row;

typedef struct maker {
	uint64_t random;
	row rows[MOST_ROWS];
	size_t row_count;
	uint32_t faces[MOST_FACES][4];
	uint8_t sizes[MOST_FACES];
	size_t face_count;
} maker;

/* splitmix64 */
static uint32_t next(maker *m)
{
	uint64_t z = m->random += 0x9e3779b97f4a7c15u;
	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
	z = (z ^ z >> 27) * 0x94d049bb133111ebu;
	return (uint32_t)(z >> 32);
}

static uint32_t below(maker *m, uint32_t count)
{
	return (uint32_t)((uint64_t)next(m) * count >> 32);
}

static bool chance(maker *m, unsigned percent)
{
	return below(m, 100) < percent;
}

static float uniform(maker *m)
{
	return (float)(int32_t)next(m) * 0x1p-31f;
}

static void unit(maker *m, float n[3])
{
	float length;
	do {
		for (int i = 0; i < 3; i++)
			n[i] = uniform(m);
		length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	} while (!(length > 0.1f));
	for (int i = 0; i < 3; i++)
		n[i] /= length;
}

static uint32_t add_row(maker *m, const float p[3], const float n[3], const float t[2])
{
	row *r = &m->rows[m->row_count];
	memcpy(r->p, p, sizeof r->p);
	memcpy(r->n, n, sizeof r->n);
	memcpy(r->t, t, sizeof r->t);
	return (uint32_t)m->row_count++;
}

static void add_face(maker *m, uint8_t size, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
	const uint32_t face[4] = {a, b, c, d};
	memcpy(m->faces[m->face_count], face, sizeof face);
	m->sizes[m->face_count++] = size;
}

/* A wavy grid whose columns may run backwards in u; faces are quads with the given probability. */
static void make_grid(maker *m, unsigned mirror_percent, unsigned quad_percent)
{
	const uint32_t w = 2 + below(m, 7), h = 2 + below(m, 7);
	float u = 0.0f, step = 1.0f;
	const float noise = chance(m, 50) ? 0.3f : 0.0f;
	float us[16];
	for (uint32_t x = 0; x <= w; x++) {
		us[x] = u;
		step = chance(m, mirror_percent) ? -step : step;
		u += step / (float)w;
	}
	for (uint32_t y = 0; y <= h; y++)
		for (uint32_t x = 0; x <= w; x++) {
			const float p[3] = {(float)x + noise * uniform(m), (float)y + noise * uniform(m),
				noise * uniform(m)};
			float n[3] = {noise * uniform(m), noise * uniform(m), 1.0f};
			const float l = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
			n[0] /= l, n[1] /= l, n[2] /= l;
			const float t[2] = {us[x] + 0.1f * noise * uniform(m), (float)y / (float)h};
			add_row(m, p, n, t);
		}
	for (uint32_t y = 0; y < h; y++)
		for (uint32_t x = 0; x < w; x++) {
			const uint32_t a = y * (w + 1) + x, b = a + 1, c = b + w + 1, d = a + w + 1;
			if (chance(m, quad_percent)) {
				add_face(m, 4, a, b, c, d);
			} else {
				add_face(m, 3, a, b, c, 0);
				add_face(m, 3, a, c, d, 0);
			}
		}
}

/* Random faces over few positions, normals and texture coordinates. */
static void make_soup(maker *m, unsigned quad_percent)
{
	const uint32_t points = 3 + below(m, 8), uvs = 1 + below(m, 5), normals = 1 + below(m, 2);
	const uint32_t faces = 1 + below(m, 60);
	float p[16][3], t[8][2], n[2][3];
	for (uint32_t i = 0; i < points; i++)
		for (int c = 0; c < 3; c++)
			p[i][c] = chance(m, 50) ? (float)(int)below(m, 3) : uniform(m);
	for (uint32_t i = 0; i < uvs; i++)
		for (int c = 0; c < 2; c++)
			t[i][c] = chance(m, 60) ? (float)(int)below(m, 3) : uniform(m);
	for (uint32_t i = 0; i < normals; i++)
		unit(m, n[i]);
	const bool by_point = chance(m, 60);
	for (uint32_t f = 0; f < faces; f++) {
		uint32_t at[4];
		for (int k = 0; k < 4; k++) {
			const uint32_t point = below(m, points);
			const uint32_t uv = by_point ? point % uvs : below(m, uvs);
			at[k] = add_row(m, p[point], n[below(m, normals)], t[uv]);
		}
		add_face(m, chance(m, quad_percent) ? 4 : 3, at[0], at[1], at[2], at[3]);
	}
}

/* Fans around one vertex; more than one makes a bowtie. Texture directions may turn with the fan. */
static void make_fans(maker *m, uint32_t spokes, uint32_t fans)
{
	const float up[3] = {0, 0, 1}, centre[3] = {0, 0, chance(m, 50) ? 0.0f : 1.0f};
	const bool turning = chance(m, 50), closed = chance(m, 70);
	const uint32_t hub = add_row(m, centre, up, (const float[2]){0.5f, 0.5f});
	for (uint32_t f = 0; f < fans; f++) {
		const uint32_t begin = (uint32_t)m->row_count;
		for (uint32_t i = 0; i < spokes; i++) {
			const float a = 6.2831853f * ((float)f + (float)i / (float)(spokes + 1)) / (float)fans;
			const float p[3] = {cosf(a), sinf(a), (float)f};
			const float planar[2] = {0.5f + 0.5f * p[0], 0.5f + 0.5f * p[1]};
			const float polar[2] = {(float)i / (float)spokes, 0.0f};
			add_row(m, p, up, turning ? polar : planar);
		}
		const bool flip = chance(m, 20);
		for (uint32_t i = 0; i + (closed ? 0 : 1) < spokes; i++) {
			const uint32_t a = begin + i, b = begin + (i + 1) % spokes;
			add_face(m, 3, hub, flip ? b : a, flip ? a : b, 0);
		}
	}
}

static void make_shape(maker *m)
{
	switch (below(m, 10)) {
	case 0:
	case 1:
		make_grid(m, below(m, 2) * 30, 0);
		break;
	case 2:
		make_grid(m, 30, 50);
		break;
	case 3:
		make_grid(m, below(m, 2) * 20, 100);
		break;
	case 4:
	case 5:
		make_soup(m, 0);
		break;
	case 6:
		make_soup(m, 40);
		break;
	case 7:
		make_soup(m, 100);
		break;
	case 8:
		make_fans(m, 3 + below(m, 14), 1 + below(m, 3));
		break;
	default:
		make_fans(m, 20 + below(m, 300), 1);
	}
}

/* Damage to faces */

static void repeat_faces(maker *m, bool reversed)
{
	for (uint32_t i = 1 + below(m, 5); i > 0 && m->face_count < MOST_FACES; i--) {
		const uint32_t f = below(m, (uint32_t)m->face_count);
		const uint32_t *v = m->faces[f];
		if (!reversed)
			add_face(m, m->sizes[f], v[0], v[1], v[2], v[3]);
		else if (m->sizes[f] == 3)
			add_face(m, 3, v[2], v[1], v[0], 0);
		else
			add_face(m, 4, v[3], v[2], v[1], v[0]);
	}
}

static void collapse_faces(maker *m, unsigned percent)
{
	for (size_t f = 0; f < m->face_count; f++)
		if (chance(m, percent))
			m->faces[f][below(m, m->sizes[f])] = m->faces[f][below(m, m->sizes[f])];
}

static void shuffle_faces(maker *m)
{
	for (size_t f = m->face_count; f > 1; f--) {
		const size_t g = below(m, (uint32_t)f);
		uint32_t face[4];
		memcpy(face, m->faces[f - 1], sizeof face);
		memcpy(m->faces[f - 1], m->faces[g], sizeof face);
		memcpy(m->faces[g], face, sizeof face);
		const uint8_t size = m->sizes[f - 1];
		m->sizes[f - 1] = m->sizes[g];
		m->sizes[g] = size;
	}
}

static void turn_faces(maker *m)
{
	for (size_t f = 0; f < m->face_count; f++)
		for (uint32_t turn = below(m, 3); turn > 0; turn--) {
			uint32_t *v = m->faces[f];
			const uint32_t first = v[0];
			memmove(v, v + 1, (m->sizes[f] - 1u) * sizeof *v);
			v[m->sizes[f] - 1] = first;
		}
}

/* Damage to values */

/* Texture coordinates on a line or in a point for some faces: the vertices get their own rows. */
static void flatten_uvs(maker *m, unsigned percent)
{
	for (size_t f = 0; f < m->face_count; f++) {
		if (!chance(m, percent))
			continue;
		const bool point = chance(m, 50);
		for (int k = 0; k < m->sizes[f]; k++) {
			row *r = &m->rows[m->faces[f][k]];
			r->t[0] = point ? 0.25f : r->t[1];
		}
	}
}

static void scale_values(maker *m)
{
	static const float scales[] = {1e-30f, 1e-22f, 1e-19f, 1e-12f, 1e-4f, 1e4f, 1e12f, 1e18f, 1e20f};
	const float p = chance(m, 50) ? scales[below(m, 9)] : 1.0f, t = chance(m, 50) ? scales[below(m, 9)] : 1.0f;
	const float n = chance(m, 20) ? scales[below(m, 9)] : 1.0f;
	for (size_t i = 0; i < m->row_count; i++) {
		for (int c = 0; c < 3; c++) {
			m->rows[i].p[c] *= p;
			m->rows[i].n[c] *= n;
		}
		m->rows[i].t[0] *= t;
		m->rows[i].t[1] *= t;
	}
}

static void put_odd_values(maker *m)
{
	static const float odd[] = {NAN, INFINITY, -INFINITY, FLT_MAX / 4, -FLT_MAX / 4, FLT_MIN, 1e-42f, 0.0f};
	for (uint32_t i = 1 + below(m, 4); i > 0; i--) {
		float *values = (float *)&m->rows[below(m, (uint32_t)m->row_count)];
		values[below(m, 8)] = odd[below(m, 8)];
	}
}

static void negate_zeros(maker *m)
{
	for (size_t i = 0; i < m->row_count; i++) {
		float *values = (float *)&m->rows[i];
		for (int c = 0; c < 8; c++)
			if (values[c] == 0.0f && chance(m, 50))
				values[c] = -0.0f;
	}
}

static void damage(maker *m)
{
	if (chance(m, 20))
		repeat_faces(m, false);
	if (chance(m, 20))
		repeat_faces(m, true);
	if (chance(m, 30))
		collapse_faces(m, 1 + below(m, 30));
	if (chance(m, 30))
		flatten_uvs(m, 1 + below(m, 30));
	if (chance(m, 30))
		shuffle_faces(m);
	if (chance(m, 30))
		turn_faces(m);
	if (chance(m, 10))
		scale_values(m);
	if (chance(m, 7))
		put_odd_values(m);
	if (chance(m, 20))
		negate_zeros(m);
}

/* Layout */

static float *lay_out(const maker *m, nt_nasty *nasty, int block, size_t offset, size_t floats, size_t stride,
	const uint32_t *source, size_t count)
{
	float *data = malloc(count * stride * sizeof *data + 1);
	for (size_t i = 0; i < count; i++)
		for (size_t c = 0; c < stride; c++)
			data[i * stride + c] = c < floats ? ((const float *)&m->rows[source[i]])[offset + c] : NAN;
	nasty->blocks[block] = data;
	return data;
}

static void build(maker *m, nt_nasty *nasty)
{
	nmtan_mesh *mesh = &nasty->mesh;
	mesh->struct_bytes = sizeof *mesh;
	uint8_t *sizes = malloc(m->face_count + 1);
	uint32_t *indices = malloc((4 * m->face_count + 1) * sizeof *indices), *source = NULL;
	bool quads = false;
	for (size_t f = 0; f < m->face_count; f++) {
		sizes[f] = m->sizes[f];
		quads = quads || sizes[f] == 4;
		for (int k = 0; k < sizes[f]; k++)
			indices[nasty->corner_count++] = m->faces[f][k];
	}
	const bool indexed = chance(m, 60), doubled = indexed && chance(m, 30);
	mesh->face_count = m->face_count;
	mesh->face_sizes = quads || chance(m, 20) ? sizes : NULL;
	mesh->vertex_count = indexed ? m->row_count * (doubled ? 2 : 1) : nasty->corner_count;
	source = malloc((mesh->vertex_count + 1) * sizeof *source);
	for (size_t i = 0; i < mesh->vertex_count; i++)
		source[i] = indexed ? (uint32_t)(i % m->row_count) : indices[i];
	for (size_t c = 0; doubled && c < nasty->corner_count; c++)
		indices[c] += chance(m, 50) ? (uint32_t)m->row_count : 0;
	mesh->indices = indexed ? indices : NULL;
	const size_t more = chance(m, 30) ? 1 + below(m, 3) : 0;
	mesh->positions = lay_out(m, nasty, 0, 0, 3, 3 + more, source, mesh->vertex_count);
	mesh->normals = lay_out(m, nasty, 1, 3, 3, 3 + more, source, mesh->vertex_count);
	mesh->texcoords = lay_out(m, nasty, 2, 6, 2, 2 + more, source, mesh->vertex_count);
	mesh->position_stride_bytes = mesh->normal_stride_bytes = more ? (3 + more) * sizeof(float) : 0;
	mesh->texcoord_stride_bytes = more ? (2 + more) * sizeof(float) : 0;
	nasty->blocks[3] = sizes;
	nasty->blocks[4] = indices;
	free(source);
}

void nt_nasty_make(uint64_t seed, nt_nasty *nasty)
{
	maker *m = calloc(1, sizeof *m);
	*nasty = (nt_nasty){.corner_count = 0};
	m->random = seed * 0x2545f4914f6cdd1du + 1;
	make_shape(m);
	damage(m);
	build(m, nasty);
	free(m);
}

void nt_nasty_free(nt_nasty *nasty)
{
	for (int i = 0; i < 5; i++)
		free(nasty->blocks[i]);
}

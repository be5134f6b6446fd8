/* SPDX-License-Identifier: MIT */
/*
 * See surfaces.h. dP/du comes from the parametric derivatives and the Jacobian of (u, v) by (a, b), both
 * written out, in double.
 */
#include "surfaces.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const nt_surface_names[NT_SURFACE_COUNT] = {"sphere", "torus", "strip", "saddle", "noise"};

static void *zeroed(size_t count, size_t size)
{
	void *block = calloc(count ? count : 1, size);
	if (!block) {
		fprintf(stderr, "out of memory\n");
		exit(4);
	}
	return block;
}

static nt_owned make(size_t vertex_count, size_t face_count, size_t face_size)
{
	nt_owned o = {.corner_count = face_size * face_count};
	o.positions = zeroed(vertex_count, sizeof *o.positions);
	o.normals = zeroed(vertex_count, sizeof *o.normals);
	o.texcoords = zeroed(vertex_count, sizeof *o.texcoords);
	o.truth = zeroed(vertex_count, sizeof *o.truth);
	o.indices = zeroed(o.corner_count, sizeof *o.indices);
	if (face_size == 4) {
		o.face_sizes = zeroed(face_count, 1);
		memset(o.face_sizes, 4, face_count);
	}
	o.mesh = (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = face_count,
		.face_sizes = o.face_sizes, .vertex_count = vertex_count,
		.indices = o.indices, .positions = &o.positions[0][0], .normals = &o.normals[0][0],
		.texcoords = &o.texcoords[0][0]};
	return o;
}

nt_owned nt_owned_make(size_t vertex_count, size_t triangle_count)
{
	return make(vertex_count, triangle_count, 3);
}

nt_owned nt_owned_make_quads(size_t vertex_count, size_t quad_count)
{
	return make(vertex_count, quad_count, 4);
}

void nt_owned_free(nt_owned *o)
{
	free(o->positions);
	free(o->normals);
	free(o->texcoords);
	free(o->truth);
	free(o->indices);
	free(o->face_sizes);
	*o = (nt_owned){0};
}

nt_random nt_random_seed(uint64_t seed)
{
	return (nt_random){(seed + 1) * 0x9e3779b97f4a7c15u};
}

static uint64_t next(nt_random *random)
{
	uint64_t x = random->state;
	x ^= x >> 12;
	x ^= x << 25;
	x ^= x >> 27;
	random->state = x;
	return x * 0x2545f4914f6cdd1du;
}

uint32_t nt_random_below(nt_random *random, uint32_t count)
{
	return (uint32_t)(((next(random) >> 32) * count) >> 32);
}

double nt_random_real(nt_random *random)
{
	return (double)(next(random) >> 11) / 9007199254740992.0;
}

/* Position and its derivatives by a and b. */
static void evaluate(nt_surface surface, double a, double b, double p[3], double pa[3], double pb[3])
{
	const double turn = 6.283185307179586;
	if (surface == NT_SPHERE) {
		const double theta = turn * a, phi = 0.15 + b * (turn / 2 - 0.3);
		const double range = turn / 2 - 0.3, st = sin(theta), ct = cos(theta), sp = sin(phi), cp = cos(phi);
		memcpy(p, (double[3]){sp * ct, sp * st, -cp}, 24);
		memcpy(pa, (double[3]){-turn * sp * st, turn * sp * ct, 0}, 24);
		memcpy(pb, (double[3]){range * cp * ct, range * cp * st, range * sp}, 24);
	} else if (surface == NT_TORUS) {
		const double st = sin(turn * a), ct = cos(turn * a), sp = sin(turn * b), cp = cos(turn * b);
		const double r = 1 + 0.4 * cp;
		memcpy(p, (double[3]){r * ct, r * st, 0.4 * sp}, 24);
		memcpy(pa, (double[3]){-turn * r * st, turn * r * ct, 0}, 24);
		memcpy(pb, (double[3]){-0.4 * turn * sp * ct, -0.4 * turn * sp * st, 0.4 * turn * cp}, 24);
	} else if (surface == NT_STRIP) {
		const double theta = turn * a, w = b - 0.5;
		const double st = sin(theta), ct = cos(theta), sh = sin(theta / 2), ch = cos(theta / 2);
		const double r = 1 + w * ch, ra = -0.5 * turn * w * sh;
		memcpy(p, (double[3]){r * ct, r * st, w * sh}, 24);
		memcpy(pa, (double[3]){ra * ct - turn * r * st, ra * st + turn * r * ct, 0.5 * turn * w * ch}, 24);
		memcpy(pb, (double[3]){ch * ct, ch * st, sh}, 24);
	} else if (surface == NT_SADDLE) {
		const double x = 2 * a - 1, y = 2 * b - 1;
		memcpy(p, (double[3]){x, y, 0.5 * (x * x - y * y)}, 24);
		memcpy(pa, (double[3]){2, 0, 2 * x}, 24);
		memcpy(pb, (double[3]){0, 2, -2 * y}, 24);
	} else {
		const double h = 0.05 * (sin(13 * a + 2 * b) + sin(7 * b - 3 * a) + 0.5 * sin(23 * a * b));
		const double ha = 0.05 * (13 * cos(13 * a + 2 * b) - 3 * cos(7 * b - 3 * a) +
						 11.5 * b * cos(23 * a * b));
		const double hb = 0.05 * (2 * cos(13 * a + 2 * b) + 7 * cos(7 * b - 3 * a) +
						 11.5 * a * cos(23 * a * b));
		memcpy(p, (double[3]){a, b, h}, 24);
		memcpy(pa, (double[3]){1, 0, ha}, 24);
		memcpy(pb, (double[3]){0, 1, hb}, 24);
	}
}

static void normalise(double v[3])
{
	const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
	for (int i = 0; i < 3; i++)
		v[i] /= length;
}

nt_surface_point nt_surface_at(nt_surface surface, double a, double b)
{
	nt_surface_point point;
	double pa[3], pb[3];
	evaluate(surface, a, b, point.p, pa, pb);
	/* (u, v) = J (a, b): the identity, or a shear */
	const bool sheared = surface == NT_SADDLE;
	const double j00 = 1, j01 = sheared ? 0.6 : 0, j10 = sheared ? -0.3 : 0, j11 = 1;
	const double det = j00 * j11 - j01 * j10;
	point.uv[0] = j00 * a + j01 * b;
	point.uv[1] = j10 * a + j11 * b;
	for (int i = 0; i < 3; i++) {
		const int k = (i + 1) % 3, l = (i + 2) % 3;
		point.n[i] = pa[k] * pb[l] - pa[l] * pb[k];
		point.t[i] = (pa[i] * j11 - pb[i] * j10) / det;
	}
	normalise(point.n);
	normalise(point.t);
	return point;
}

static void set_vertex(nt_owned *o, size_t vertex, const nt_surface_point *point)
{
	for (int i = 0; i < 3; i++) {
		o->positions[vertex][i] = (float)point->p[i];
		o->normals[vertex][i] = (float)point->n[i];
		o->truth[vertex][i] = point->t[i];
	}
	o->texcoords[vertex][0] = (float)point->uv[0];
	o->texcoords[vertex][1] = (float)point->uv[1];
}

nt_owned nt_surface_grid(nt_surface surface, uint32_t columns, uint32_t rows, double jitter, uint64_t seed)
{
	nt_random random = nt_random_seed(seed);
	nt_owned o = nt_owned_make((size_t)(columns + 1) * (rows + 1), (size_t)columns * rows * 2);
	for (uint32_t y = 0; y <= rows; y++) {
		for (uint32_t x = 0; x <= columns; x++) {
			const bool inner = x > 0 && y > 0 && x < columns && y < rows;
			const double dx = inner ? jitter * (2 * nt_random_real(&random) - 1) : 0;
			const double dy = inner ? jitter * (2 * nt_random_real(&random) - 1) : 0;
			const nt_surface_point point = nt_surface_at(surface, (x + dx) / columns, (y + dy) / rows);
			set_vertex(&o, (size_t)y * (columns + 1) + x, &point);
		}
	}
	uint32_t *to = o.indices;
	for (uint32_t y = 0; y < rows; y++) {
		for (uint32_t x = 0; x < columns; x++) {
			const uint32_t a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
			const uint32_t even[6] = {a, b, c, a, c, d}, odd[6] = {a, b, d, b, c, d};
			memcpy(to, (x + y) % 2 ? odd : even, sizeof even);
			to += 6;
		}
	}
	return o;
}

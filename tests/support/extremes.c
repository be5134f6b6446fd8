/* SPDX-License-Identifier: MIT */
/*
 * See extremes.h. Values are computed in double and rounded once, so that a level means what it says.
 */
#include "extremes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "soup.h"

enum { SOUP = 600, FANS = 60, SPOKES = 8 };

static nt_owned torus(uint64_t seed)
{
	return nt_surface_grid(NT_TORUS, 24, 16, 0.25, seed);
}

static double between(nt_random *random, double low, double high)
{
	return low + (high - low) * nt_random_real(random);
}

static void set3(float *to, double x, double y, double z)
{
	to[0] = (float)x;
	to[1] = (float)y;
	to[2] = (float)z;
}

static void set2(float *to, double x, double y)
{
	to[0] = (float)x;
	to[1] = (float)y;
}

/* A direction, evenly over the sphere. */
static void direction(nt_random *random, double d[3])
{
	const double z = between(random, -1, 1), a = between(random, 0, 6.283185307179586);
	d[0] = sqrt(1 - z * z) * cos(a);
	d[1] = sqrt(1 - z * z) * sin(a);
	d[2] = z;
}

/* Scales and offsets */

static nt_owned moved(uint64_t seed, double uv_scale, double uv_offset, double scale, double offset)
{
	nt_owned o = torus(seed);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		const nt_owned *c = &o;
		set2(o.texcoords[v], c->texcoords[v][0] * uv_scale + uv_offset,
			c->texcoords[v][1] * uv_scale + uv_offset);
		set3(o.positions[v], c->positions[v][0] * scale + offset, c->positions[v][1] * scale + offset,
			c->positions[v][2] * scale + offset);
	}
	return o;
}

static nt_owned uv_scale(double level, uint64_t seed)
{
	return moved(seed, level, 0, 1, 0);
}

static nt_owned uv_offset(double level, uint64_t seed)
{
	return moved(seed, 0.1, level, 1, 0);
}

static nt_owned position_scale(double level, uint64_t seed)
{
	return moved(seed, 1, 0, level, 0);
}

static nt_owned position_offset(double level, uint64_t seed)
{
	return moved(seed, 1, 0, 1, level);
}

static nt_owned both_scales(double level, uint64_t seed)
{
	return moved(seed, level, 0, 1 / level, 0);
}

/* Soups: triangles of their own. The normal is that of the triangle before it became thin. */
static nt_owned triangles_alone(uint64_t seed, double uv_aspect, double aspect)
{
	nt_random random = nt_random_seed(seed);
	nt_owned o = nt_owned_make(3 * SOUP, SOUP);
	for (uint32_t i = 0; i < 3 * SOUP; i += 3) {
		double e[3], f[3], n[3];
		direction(&random, e);
		direction(&random, f);
		for (int k = 0; k < 3; k++)
			n[k] = e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
		const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
		const double s = between(&random, 0.1, 0.9), a = between(&random, 0, 6.283185307179586);
		const double p[3] = {between(&random, -1, 1), between(&random, -1, 1), between(&random, -1, 1)};
		set3(o.positions[i], p[0], p[1], p[2]);
		set3(o.positions[i + 1], p[0] + e[0], p[1] + e[1], p[2] + e[2]);
		set3(o.positions[i + 2], p[0] + s * e[0] + aspect * f[0], p[1] + s * e[1] + aspect * f[1],
			p[2] + s * e[2] + aspect * f[2]);
		const double t[2] = {nt_random_real(&random), nt_random_real(&random)};
		const double side = nt_random_below(&random, 2) ? uv_aspect : -uv_aspect;
		set2(o.texcoords[i], t[0], t[1]);
		set2(o.texcoords[i + 1], t[0] + cos(a), t[1] + sin(a));
		set2(o.texcoords[i + 2], t[0] + s * cos(a) - side * sin(a), t[1] + s * sin(a) + side * cos(a));
		for (uint32_t k = 0; k < 3; k++) {
			set3(o.normals[i + k], n[0] / length, n[1] / length, n[2] / length);
			o.indices[i + k] = i + k;
		}
	}
	return o;
}

static nt_owned uv_needles(double level, uint64_t seed)
{
	return triangles_alone(seed, level, 1);
}

static nt_owned needles(double level, uint64_t seed)
{
	return triangles_alone(seed, 1, level);
}

static nt_owned both_needles(double level, uint64_t seed)
{
	return triangles_alone(seed, level, level);
}

/* A value with a random exponent between -level and level decades. */
static double any_scale(nt_random *random, double level)
{
	const double magnitude = pow(10, between(random, -level, level)) * between(random, 0.5, 1);
	return nt_random_below(random, 2) ? magnitude : -magnitude;
}

static nt_owned mixed_exponents(double level, uint64_t seed)
{
	nt_owned o = triangles_alone(seed, 1, 1);
	nt_random random = nt_random_seed(seed);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		set3(o.positions[v], any_scale(&random, level), any_scale(&random, level),
			any_scale(&random, level));
		set2(o.texcoords[v], any_scale(&random, level), any_scale(&random, level));
	}
	return o;
}

/* UVs a, b, 2 b - a on a lattice: the determinant is exactly zero, or one unit of b's away from it. */
static nt_owned cancelling(double level, uint64_t seed)
{
	nt_owned o = triangles_alone(seed, 1, 1);
	nt_random random = nt_random_seed(seed);
	const uint32_t size = (uint32_t)level;
	for (size_t v = 0; v < o.mesh.vertex_count; v += 3) {
		const double a[2] = {nt_random_below(&random, size), nt_random_below(&random, size)};
		const double b[2] = {nt_random_below(&random, size), nt_random_below(&random, size)};
		const double nudge = (double)nt_random_below(&random, 3) - 1;
		set2(o.texcoords[v], a[0], a[1]);
		set2(o.texcoords[v + 1], b[0], b[1]);
		set2(o.texcoords[v + 2], 2 * b[0] - a[0] + nudge, 2 * b[1] - a[1]);
	}
	return o;
}

/* Fans: a hub and its rim in a plane, u along x. */

/* Spokes of fan i: vertices begin at i * (SPOKES + 1), the hub first. Fans lie above each other, so that
 * their hubs are not welded. */
static nt_owned fans(uint64_t seed, double squash)
{
	nt_random random = nt_random_seed(seed);
	nt_owned o = nt_owned_make((size_t)FANS * (SPOKES + 1), (size_t)FANS * SPOKES);
	uint32_t *to = o.indices;
	for (uint32_t i = 0; i < FANS; i++) {
		const uint32_t hub = i * (SPOKES + 1);
		const double turn = between(&random, 0, 6.283185307179586);
		for (uint32_t k = 0; k <= SPOKES; k++) {
			const double angle = 6.283185307179586 * k / SPOKES + between(&random, -0.2, 0.2);
			const double x = k ? cos(angle) : 0, y = k ? sin(angle) : 0;
			set3(o.positions[hub + k], x, y * squash, i);
			set3(o.normals[hub + k], 0, 0, 1);
			set2(o.texcoords[hub + k], 0.5 + 0.1 * (cos(turn) * x - sin(turn) * y),
				0.5 + 0.1 * (sin(turn) * x + cos(turn) * y));
		}
		for (uint32_t k = 0; k < SPOKES; k++) {
			const uint32_t corners[3] = {hub, hub + 1 + k, hub + 1 + (k + 1) % SPOKES};
			memcpy(to, corners, sizeof corners);
			to += 3;
		}
	}
	return o;
}

static nt_owned squashed_fans(double level, uint64_t seed)
{
	return fans(seed, level);
}

/* Every other triangle of a fan has its UVs turned about the hub by half a turn, but for `level`. */
static nt_owned opposed_fans(double level, uint64_t seed)
{
	const nt_owned from = fans(seed, 1);
	nt_random random = nt_random_seed(seed);
	nt_owned o = nt_owned_make(from.corner_count, from.mesh.face_count);
	for (size_t c = 0; c < from.corner_count; c++) {
		const uint32_t v = from.indices[c];
		memcpy(o.positions[c], from.positions[v], 12);
		memcpy(o.normals[c], from.normals[v], 12);
		memcpy(o.texcoords[c], from.texcoords[v], 8);
		o.indices[c] = (uint32_t)c;
	}
	for (size_t c = 3; c < from.corner_count; c += 6) {
		const double turn = 3.141592653589793 + level * between(&random, -1, 1);
		for (size_t k = c + 1; k < c + 3; k++) {
			const double x = o.texcoords[k][0] - 0.5, y = o.texcoords[k][1] - 0.5;
			set2(o.texcoords[k], 0.5 + cos(turn) * x - sin(turn) * y,
				0.5 + sin(turn) * x + cos(turn) * y);
		}
	}
	nt_owned copy = from;
	nt_owned_free(&copy);
	return o;
}

static nt_owned valence(double level, uint64_t seed)
{
	(void)seed;
	const uint32_t n = (uint32_t)level;
	nt_owned o = nt_owned_make((size_t)n + 1, n);
	set3(o.normals[0], 0, 0, 1);
	set2(o.texcoords[0], 0.5, 0.5);
	for (uint32_t k = 0; k < n; k++) {
		const double angle = 6.283185307179586 * k / n, x = cos(angle), y = sin(angle);
		set3(o.positions[k + 1], x, y, -0.25);
		set3(o.normals[k + 1], 0.25 * x, 0.25 * y, 0.9682458365518543);
		set2(o.texcoords[k + 1], 0.5 + 0.5 * x, 0.5 + 0.4 * y);
		const uint32_t corners[3] = {0, k + 1, (k + 1) % n + 1};
		memcpy(o.indices + 3 * (size_t)k, corners, sizeof corners);
	}
	return o;
}

/* Damage */

static nt_owned collapsed(double level, uint64_t seed)
{
	nt_owned o = torus(seed);
	nt_random random = nt_random_seed(seed);
	for (size_t c = 0; c < o.corner_count; c += 3)
		if (nt_random_real(&random) * 100 < level)
			o.indices[c + nt_random_below(&random, 3)] = o.indices[c + nt_random_below(&random, 3)];
	return o;
}

/* Normals that leave T by `level` radians only. */
static nt_owned near_normal(double level, uint64_t seed)
{
	nt_owned o = torus(seed);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		const double *t = o.truth[v], c = cos(level), s = sin(level);
		const float *n = o.normals[v];
		set3(o.normals[v], c * t[0] + s * n[0], c * t[1] + s * n[1], c * t[2] + s * n[2]);
	}
	return o;
}

/* Every vertex alone, with zeros whose sign is chance: u along x in a plane through the origin. */
static nt_owned negative_zeros(double level, uint64_t seed)
{
	nt_random random = nt_random_seed(seed);
	nt_owned o = nt_owned_make(3 * SOUP, SOUP);
	for (uint32_t v = 0; v < 3 * SOUP; v++) {
		const uint32_t t = v / 3, cell = t / 2, x = cell % 10, y = cell / 10 % 10, k = v % 3;
		const uint32_t dx = k == 1 || (k == 2 && t % 2 == 0), dy = k == 2 || (k == 1 && t % 2 == 1);
		set3(o.positions[v], (double)(x + dx) - 5, (double)(y + dy) - 5, 0);
		set3(o.normals[v], 0, 0, 1);
		set2(o.texcoords[v], (double)(x + dx) - 5, (double)(y + dy) - 5);
		float *values[3] = {o.positions[v], o.normals[v], o.texcoords[v]};
		for (int i = 0; i < 8; i++) {
			float *at = &values[i / 3][i % 3];
			if (*at == 0 && nt_random_real(&random) < level)
				*at = -0.0f;
		}
		o.indices[v] = v;
	}
	return o;
}

/* A part of the vertices has one value that is NaN or an infinity. */
static nt_owned not_finite(double level, uint64_t seed)
{
	static const float odd[3] = {NAN, INFINITY, -INFINITY};
	nt_owned o = torus(seed);
	nt_random random = nt_random_seed(seed);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		float *values[3] = {o.positions[v], o.normals[v], o.texcoords[v]};
		const uint32_t i = nt_random_below(&random, 8);
		if (nt_random_real(&random) < level)
			values[i / 3][i % 3] = odd[nt_random_below(&random, 3)];
	}
	return o;
}

/* Quads whose fourth corner wanders off by `level` in UV space: folded, collapsed, both. */
static nt_owned quads(double level, uint64_t seed)
{
	nt_random random = nt_random_seed(seed);
	nt_owned o = nt_owned_make_quads(4 * SOUP, SOUP);
	for (uint32_t v = 0; v < 4 * SOUP; v++) {
		const uint32_t k = v % 4, cell = v / 4;
		const double x = cell % 20 + (k == 1 || k == 2), y = cell / 20 + (k >= 2);
		const double s = k == 3 ? level : 0;
		set3(o.positions[v], x, y, 0.1 * sin(x + 2 * y));
		set3(o.normals[v], 0, 0, 1);
		set2(o.texcoords[v], x / 20 + s * between(&random, -1, 1), y / 20 + s * between(&random, -1, 1));
		o.indices[v] = v;
	}
	return o;
}

/* A scan of a lumpy ball with UVs projected along z: the back is mirrored, the outline runs through triangles that are
 * needles in UV space. `level` is the size of the lumps; normals are those of the ball, as a decimated scan has
 * them. */
static nt_owned planar_scan(double level, uint64_t seed)
{
	nt_owned o = nt_surface_grid(NT_SPHERE, 48, 32, 0.25, seed);
	nt_random random = nt_random_seed(seed);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		const float *n = o.normals[v];
		const double r = 1 + level * between(&random, -1, 1);
		set3(o.positions[v], r * n[0], r * n[1], r * n[2]);
		set2(o.texcoords[v], 0.5 + 0.5 * o.positions[v][0], 0.5 + 0.5 * o.positions[v][1]);
	}
	return o;
}

/* Public models, where ../shared/models/obj has them; an empty mesh where it has not. */
static const char *const model_names[] = {"spot", "suzanne", "crangeract", "tangeract", "doomcone_smooth",
	"rancid_geometry", "obliterated", "mat_test", "test_nm"};
static const double models[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};

static nt_owned public_model(double level, uint64_t seed)
{
	(void)seed;
	char path[256];
	snprintf(path, sizeof path, "../shared/models/obj/%s.obj", model_names[(size_t)level]);
	soup s = soup_read_obj(path, 20000);
	nt_owned o = nt_owned_make_quads(s.corner_count, s.face_count);
	memcpy(o.positions, s.positions, 12 * s.corner_count);
	memcpy(o.normals, s.normals, 12 * s.corner_count);
	memcpy(o.texcoords, s.texcoords, 8 * s.corner_count);
	memcpy(o.face_sizes, s.sizes, s.face_count);
	for (size_t c = 0; c < s.corner_count; c++)
		o.indices[c] = (uint32_t)c;
	o.corner_count = s.corner_count;
	soup_free(&s);
	return o;
}

static nt_owned size_of_mesh(double level, uint64_t seed)
{
	const uint32_t side = (uint32_t)sqrt(level / 2);
	return nt_surface_grid(NT_NOISE, side, side, 0.25, seed);
}

static const double decades_30[] = {1e-30, 1e-25, 1e-20, 1e-15, 1e-10, 1e-5, 1, 1e5, 1e10, 1e15, 1e20, 1e25,
	1e30};
static const double offsets[] = {1e-2, 1e-1, 1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6};
static const double far_offsets[] = {1e-2, 1e-1, 1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
static const double thin[] = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
static const double spreads[] = {1, 2, 3, 5, 7, 10, 14, 19, 24, 30};
static const double lattices[] = {2, 16, 256, 4096, 65536, 1048576, 4194304};
static const double valences[] = {3, 10, 100, 1000, 1e4, 1e5, 1e6};
static const double percents[] = {0, 1, 5, 20, 50, 80, 95, 100};
static const double tiny[] = {1e-36, 1e-38, 1e-40, 1e-42, 1e-44};
static const double parts[] = {0, 0.001, 0.01, 0.1, 0.5, 1};
static const double wander[] = {0, 0.01, 0.03, 0.1, 0.3, 1};
static const double lumps[] = {1e-4, 1e-3, 1e-2, 1e-1};
static const double sizes[] = {1e3, 1e4, 1e5, 1e6};

#define LEVELS(list) list, sizeof list / sizeof *list
#define ALL_BOUNDED SIZE_MAX, 0

/* In units of 2^-24 the arithmetic of a direction has a condition of some 1 / level in a triangle that is a needle in
 * both spaces, ten times that in one of a hundred random ones; 8 units of 10 / level are a quarter turn at 3e-6. */
#define BOTH_NEEDLES 6, 100

/* Triangles of random exponents: some in a hundred are such needles from 10 decades on. */
#define MIXED 5, 1

/* Six members around a vertex whose directions, once the normal has taken all but `level` of them, are spread over the
 * circle. Some are opposite, as on the two sides of an edge that runs along u. MikkTSpace keeps opposite ones apart,
 * and whether they are is a matter of the last bit; taken together they cancel, and what is left is rounding. */
#define NEAR_NORMAL 1, 25

/* Files that are meant to be nasty: several surfaces in one edge, opposite directions across it, texture coordinates
 * that are one unit of rounding from having no area. The first two are plain models. */
#define MODELS 2, 5

/* All triangles of a vertex with a NaN or infinity are undetermined, and so are the corners beside these. */
#define NOT_FINITE 2, 40

const family families[] = {
	{"uv scale", "scale of UVs", LEVELS(decades_30), false, ALL_BOUNDED, uv_scale},
	{"uv offset", "offset of UVs of size 0.1", LEVELS(offsets), false, ALL_BOUNDED, uv_offset},
	{"position scale", "scale of positions", LEVELS(decades_30), false, ALL_BOUNDED, position_scale},
	{"position offset", "offset of positions of size 1", LEVELS(far_offsets), false, ALL_BOUNDED,
		position_offset},
	{"both scales", "scale of UVs, inverse scale of positions", LEVELS(decades_30), false, ALL_BOUNDED,
		both_scales},
	{"uv needles", "aspect in UV space", LEVELS(thin), false, ALL_BOUNDED, uv_needles},
	{"needles", "aspect in space", LEVELS(thin), false, ALL_BOUNDED, needles},
	{"both needles", "aspect in UV space and in space", LEVELS(thin), false, BOTH_NEEDLES, both_needles},
	{"mixed exponents", "decades on either side of 1", LEVELS(spreads), false, MIXED, mixed_exponents},
	{"cancelling", "size of the UV lattice", LEVELS(lattices), false, ALL_BOUNDED, cancelling},
	{"squashed fans", "height", LEVELS(thin), false, ALL_BOUNDED, squashed_fans},
	{"opposed fans", "distance from half a turn", LEVELS(thin), false, ALL_BOUNDED, opposed_fans},
	{"valence", "triangles at the hub", LEVELS(valences), true, ALL_BOUNDED, valence},
	{"collapsed", "per cent of triangles collapsed", LEVELS(percents), false, ALL_BOUNDED, collapsed},
	{"near normal", "angle between T and N in radians", LEVELS(thin), false, NEAR_NORMAL, near_normal},
	{"negative zeros", "part of zeros that are negative", LEVELS(parts), false, ALL_BOUNDED, negative_zeros},
	{"quads", "how far the fourth corner wanders", LEVELS(wander), false, ALL_BOUNDED, quads},
	{"planar scan", "size of lumps", LEVELS(lumps), false, ALL_BOUNDED, planar_scan},
	{"public models", "model", LEVELS(models), false, MODELS, public_model},
	{"size", "triangles", LEVELS(sizes), true, ALL_BOUNDED, size_of_mesh},
	{"denormal uvs", "scale of UVs", LEVELS(tiny), false, ALL_BOUNDED, uv_scale},
	{"denormal positions", "scale of positions", LEVELS(tiny), false, ALL_BOUNDED, position_scale},
	{"not finite", "part of vertices with NaN or infinity", LEVELS(parts), false, NOT_FINITE, not_finite},
};
const size_t family_count = sizeof families / sizeof *families;

/* SPDX-License-Identifier: MIT */
/*
 * See oracle128.h. Floats are integers times 2^-149, so determinants are integers of 640 bits times 2^-298
 * and have exact signs; from there on everything is 113-bit arithmetic (libquadmath on x86-64, long double
 * where that has 113 bits). Slow, about 10 microseconds a triangle.
 */
#include "oracle128.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(__x86_64__) || defined(__i386__)
typedef __float128 quad;
/* Not by quadmath.h, which clang does not find. */
quad sqrtq(quad);
quad atan2q(quad, quad);
static quad square_root(quad x) { return sqrtq(x); }
static quad arc_tangent(quad y, quad x) { return atan2q(y, x); }
#else
typedef long double quad;
static quad square_root(quad x) { return sqrtl(x); }
static quad arc_tangent(quad y, quad x) { return atan2l(y, x); }
#endif

/* Integers: two's complement, least significant limb first. */

enum { SHORT = 5, LONG = 10 }; /* limbs: differences are below 2^278, products of two below 2^556 */

typedef struct integer {
	uint64_t limb[LONG];
} integer;

/* x * 2^149 */
static integer from_float(float x)
{
	integer r = {{0}};
	int exponent;
	const int64_t mantissa = (int64_t)ldexpf(frexpf(x, &exponent), 24);
	const int shift = exponent - 24 + 149;
	const uint64_t magnitude = (uint64_t)(mantissa < 0 ? -mantissa : mantissa);
	if (mantissa == 0)
		return r;
	if (shift < 0) { /* a denormal: the low bits are zero */
		r.limb[0] = magnitude >> -shift;
	} else {
		r.limb[shift / 64] = magnitude << (shift % 64);
		if (shift % 64 > 0)
			r.limb[shift / 64 + 1] = magnitude >> (64 - shift % 64);
	}
	if (mantissa < 0) {
		uint64_t carry = 1;
		for (int i = 0; i < LONG; i++) {
			r.limb[i] = ~r.limb[i] + carry;
			carry = carry && r.limb[i] == 0;
		}
	}
	return r;
}

static integer subtract(integer a, integer b)
{
	integer r;
	uint64_t borrow = 0;
	for (int i = 0; i < LONG; i++) {
		const unsigned __int128 d = (unsigned __int128)a.limb[i] - b.limb[i] - borrow;
		r.limb[i] = (uint64_t)d;
		borrow = (uint64_t)(d >> 64) & 1;
	}
	return r;
}

static bool is_negative(integer a)
{
	return a.limb[LONG - 1] >> 63;
}

static integer absolute(integer a)
{
	return is_negative(a) ? subtract((integer){{0}}, a) : a;
}

static int sign_of(integer a)
{
	if (is_negative(a))
		return -1;
	for (int i = 0; i < LONG; i++)
		if (a.limb[i])
			return 1;
	return 0;
}

static integer multiply(integer a, integer b)
{
	const integer x = absolute(a), y = absolute(b);
	integer r = {{0}};
	for (int i = 0; i < SHORT; i++) {
		uint64_t carry = 0;
		for (int k = 0; k < SHORT; k++) {
			const unsigned __int128 p =
				(unsigned __int128)x.limb[i] * y.limb[k] + r.limb[i + k] + carry;
			r.limb[i + k] = (uint64_t)p;
			carry = (uint64_t)(p >> 64);
		}
		if (i + SHORT < LONG)
			r.limb[i + SHORT] = carry;
	}
	return is_negative(a) != is_negative(b) ? subtract((integer){{0}}, r) : r;
}

/* 2^-149 and its square, the units of floats and of their products. */
static quad unit_of(int factors)
{
	const quad half = (quad)ldexp(1, -149);
	return factors == 1 ? half : half * half;
}

/* The value of an integer that counts units of 2^-149 or 2^-298. */
static quad to_quad(integer a, int factors)
{
	const integer magnitude = absolute(a);
	quad sum = 0, unit = unit_of(factors);
	for (int i = 0; i < LONG; i++, unit *= 18446744073709551616.0)
		if (magnitude.limb[i])
			sum += (quad)magnitude.limb[i] * unit;
	return is_negative(a) ? -sum : sum;
}

static integer difference(float a, float b)
{
	return subtract(from_float(a), from_float(b));
}

/* (b0 - a0)(c1 - a1) - (b1 - a1)(c0 - a0) for two pairs of coordinates */
static integer determinant(float a0, float b0, float c0, float a1, float b1, float c1)
{
	return subtract(multiply(difference(b0, a0), difference(c1, a1)),
		multiply(difference(b1, a1), difference(c0, a0)));
}

static bool all_finite(const float *p, int count)
{
	for (int i = 0; i < count; i++)
		if (!isfinite(p[i]))
			return false;
	return true;
}

int oracle_sign(const float a[2], const float b[2], const float c[2])
{
	if (!all_finite(a, 2) || !all_finite(b, 2) || !all_finite(c, 2))
		return 0;
	return sign_of(determinant(a[0], b[0], c[0], a[1], b[1], c[1]));
}

/* Vectors */

typedef struct vec {
	quad x[3];
} vec;

static quad dot(vec a, vec b)
{
	return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

static quad length(vec a)
{
	return square_root(dot(a, a));
}

static vec scale(quad s, vec a)
{
	return (vec){{s * a.x[0], s * a.x[1], s * a.x[2]}};
}

static vec add(vec a, vec b)
{
	return (vec){{a.x[0] + b.x[0], a.x[1] + b.x[1], a.x[2] + b.x[2]}};
}

static vec project(vec n, vec a)
{
	return add(a, scale(-dot(n, a), n));
}

static vec unit_normal(const float *p)
{
	const vec n = {{p[0], p[1], p[2]}};
	if (!all_finite(p, 3) || dot(n, n) == 0)
		return (vec){{0, 0, 0}};
	return scale(1 / length(n), n);
}

/* The mesh */

typedef struct corner_row {
	float value[8];
	size_t corner;
} corner_row;

typedef struct sums {
	vec t, b;
	quad spread_t, spread_b; /* sums of lengths times conditions */
	double degrees; /* the largest angle between t and a triangle's own */
	quad spread_float, spread_angle; /* the same in float, of directions and of weights */
	size_t triangles;
} sums;

/* A square leaves the range of normal floats; the sign of a UV determinant may be lost. */
enum { OUT_OF_RANGE = 1, SIGN_LOST = 2 };

typedef struct oracle {
	oracle_corner *corners; /* [corner_count] */
	const nmtan_mesh *mesh;
	oracle_weight weight;
	size_t corner_count;
	size_t *vertex; /* [corner_count] welded */
	sums (*sum)[2]; /* [corner_count] */
	unsigned char *beyond; /* [corner_count] OUT_OF_RANGE, SIGN_LOST: what float does to a triangle at the welded vertex */
} oracle;

static size_t vertex_of(const nmtan_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : corner;
}

static const float *row(const float *data, size_t stride, size_t size, size_t vertex)
{
	return (const float *)((const char *)data + vertex * (stride ? stride : size));
}

static const float *position(const nmtan_mesh *mesh, size_t corner)
{
	return row(mesh->positions, mesh->position_stride_bytes, 12, vertex_of(mesh, corner));
}

static const float *normal(const nmtan_mesh *mesh, size_t corner)
{
	return row(mesh->normals, mesh->normal_stride_bytes, 12, vertex_of(mesh, corner));
}

static const float *texcoord(const nmtan_mesh *mesh, size_t corner)
{
	return row(mesh->texcoords, mesh->texcoord_stride_bytes, 8, vertex_of(mesh, corner));
}

static int compare_rows(const void *left, const void *right)
{
	const corner_row *a = left, *b = right;
	for (int i = 0; i < 8; i++)
		if (a->value[i] != b->value[i])
			return a->value[i] < b->value[i] ? -1 : 1;
	return (a->corner > b->corner) - (a->corner < b->corner);
}

/* Equal rows of floats are one vertex; a row with a NaN is alone. By sorting. */
static bool weld(oracle *o)
{
	corner_row *rows = malloc((o->corner_count + 1) * sizeof *rows);
	if (!rows)
		return false;
	size_t count = 0;
	for (size_t c = 0; c < o->corner_count; c++) {
		corner_row *r = &rows[count];
		memcpy(r->value, position(o->mesh, c), 12);
		memcpy(r->value + 3, normal(o->mesh, c), 12);
		memcpy(r->value + 6, texcoord(o->mesh, c), 8);
		r->corner = c;
		o->vertex[c] = c;
		bool ordered = true;
		for (int i = 0; i < 8; i++)
			ordered = ordered && r->value[i] == r->value[i];
		count += ordered;
	}
	qsort(rows, count, sizeof *rows, compare_rows);
	for (size_t i = 1; i < count; i++) {
		bool equal = true;
		for (int k = 0; k < 8; k++)
			equal = equal && rows[i].value[k] == rows[i - 1].value[k];
		if (equal)
			o->vertex[rows[i].corner] = o->vertex[rows[i - 1].corner];
	}
	free(rows);
	return true;
}

static float squared(const float *a, const float *b, int count)
{
	float sum = 0;
	for (int i = 0; i < count; i++)
		sum += (b[i] - a[i]) * (b[i] - a[i]);
	return sum;
}

/* The one or two triangles of a face, cut as MikkTSpace cuts: that is float arithmetic by definition. */
static int cut_face(const oracle *o, size_t first, size_t size, size_t out[2][3])
{
	for (size_t k = 0; k < 3; k++)
		out[0][k] = first + k;
	if (size == 3)
		return 1;
	const nmtan_mesh *m = o->mesh;
	const float uv02 = squared(texcoord(m, first), texcoord(m, first + 2), 2);
	const float uv13 = squared(texcoord(m, first + 1), texcoord(m, first + 3), 2);
	const float p02 = squared(position(m, first), position(m, first + 2), 3);
	const float p13 = squared(position(m, first + 1), position(m, first + 3), 3);
	if (uv02 < uv13 || (!(uv13 < uv02) && !(p13 < p02))) {
		const size_t second[3] = {first, first + 2, first + 3};
		memcpy(out[1], second, sizeof second);
	} else {
		const size_t halves[2][3] = {{first, first + 1, first + 3}, {first + 1, first + 2, first + 3}};
		memcpy(out, halves, sizeof halves);
	}
	return 2;
}

static integer uv_determinant(const oracle *o, const size_t c[3])
{
	const float *a = texcoord(o->mesh, c[0]), *b = texcoord(o->mesh, c[1]), *d = texcoord(o->mesh, c[2]);
	if (!all_finite(a, 2) || !all_finite(b, 2) || !all_finite(d, 2))
		return (integer){{0}};
	return determinant(a[0], b[0], d[0], a[1], b[1], d[1]);
}

/* A face has one orientation: that of the half with the larger area when they differ. */
static int face_sign(const oracle *o, size_t triangles[2][3], int count)
{
	const integer first = uv_determinant(o, triangles[0]);
	if (count == 1)
		return sign_of(first);
	const integer second = uv_determinant(o, triangles[1]);
	if (sign_of(first) * sign_of(second) >= 0)
		return sign_of(first) ? sign_of(first) : sign_of(second);
	return is_negative(subtract(absolute(first), absolute(second))) ? sign_of(second) : sign_of(first);
}

/* Adds direction d at a corner with normal n. angle_condition is the angle times its condition. */
static void add_direction(oracle_weight weight, vec d, vec n, quad factor, quad angle, quad angle_condition,
	vec *sum, quad *spread)
{
	const vec p = project(n, d);
	const quad size = length(p);
	if (weight == ORACLE_NONE) {
		*sum = add(*sum, p);
		*spread += length(d);
	} else if (size > 0) {
		*sum = add(*sum, scale(factor * angle / size, p));
		*spread += factor * (angle * length(d) / size + angle_condition);
	}
}

/* What float arithmetic does to a triangle. u is its dP/du before it is normalised: MikkTSpace rounds the two products
 * whose difference it is, and those of the UV determinant. */
typedef struct in_float {
	quad condition; /* of u */
	unsigned beyond;
} in_float;

static bool leaves_range(quad squared)
{
	return squared > 0 && (squared < 0x1p-100 || squared > 0x1p100);
}

static in_float judge_float(const float *const p[3], const float *const t[3], vec u, quad det)
{
	quad d[2] = {0, 0}, e[2][2];
	for (int k = 0; k < 2; k++) {
		for (int i = 0; i < 3; i++)
			d[k] += ((quad)p[k + 1][i] - p[0][i]) * ((quad)p[k + 1][i] - p[0][i]);
		for (int i = 0; i < 2; i++)
			e[k][i] = fabs((double)t[k + 1][i] - t[0][i]);
	}
	const quad products = e[1][1] * square_root(d[0]) + e[0][1] * square_root(d[1]);
	const quad areas = e[0][0] * e[1][1] + e[0][1] * e[1][0], size = length(u);
	const bool leaves = leaves_range(size * size) || leaves_range(det) || leaves_range(d[0]) || leaves_range(d[1]);
	return (in_float){size > 0 ? products / size : 0,
		(leaves ? OUT_OF_RANGE : 0) | (areas > 0x1p21 * det ? SIGN_LOST : 0)};
}

/* Adds what the triangle does to the float condition at a corner. Weights are acos() of the cosine of two unit vectors:
 * 1 / sine, but for what is left near 0 and pi, half of the bits. They do not matter where there is only one. off_unit: |n|^2 - 1, in units of 2^-24. */
static void add_float(oracle_corner *own, sums *s, in_float f, vec unit_u, vec n, quad off_unit, quad angle, quad sine,
	quad squares, quad edges)
{
	const vec projected = project(n, unit_u);
	const quad size = length(projected);
	const quad worst = 4096, inverse = sine > 0 ? square_root(squares) / sine : worst;
	for (int i = 0; i < 3 && size > 0; i++)
		own->own[own->own_count][i] = (double)(projected.x[i] / size);
	own->own_count += size > 0;
	if (size > 0)
		s->spread_float += angle * (f.condition + 1 + off_unit) / size;
	if (size > 0 && !(f.beyond & OUT_OF_RANGE))
		own->own_condition_float = (double)((f.condition + 1 + off_unit) / size);
	s->spread_angle += (inverse < worst ? inverse : worst) + (squares > 0 ? edges / square_root(squares) : 0);
	s->triangles++;
}

static void add_triangle(oracle *o, const size_t c[3], int side)
{
	const nmtan_mesh *m = o->mesh;
	const integer det = uv_determinant(o, c);
	const int sign = sign_of(det);
	const float *p[3], *t[3];
	for (int k = 0; k < 3; k++) {
		p[k] = position(m, c[k]);
		t[k] = texcoord(m, c[k]);
		if (!all_finite(p[k], 3))
			return;
	}
	if (sign == 0)
		return;
	vec u, v, across, edge[3];
	for (int i = 0; i < 3; i++) {
		const int j = (i + 1) % 3, l = (i + 2) % 3;
		/* u = (cv d1 - bv d2), v = (bu d2 - cu d1), both times the sign */
		u.x[i] = sign * to_quad(determinant(p[0][i], p[1][i], p[2][i], t[0][1], t[1][1], t[2][1]), 2);
		v.x[i] = sign * to_quad(determinant(t[0][0], t[1][0], t[2][0], p[0][i], p[1][i], p[2][i]), 2);
		across.x[i] = to_quad(determinant(p[0][j], p[1][j], p[2][j], p[0][l], p[1][l], p[2][l]), 2);
		for (int k = 0; k < 3; k++)
			edge[k].x[i] = to_quad(difference(p[(k + 1) % 3][i], p[k][i]), 1);
	}
	const quad magnitude = to_quad(absolute(det), 2);
	const quad lu = length(u), lv = length(v);
	const in_float in = judge_float(p, t, u, magnitude);
	const vec unit_u = lu > 0 ? scale(1 / lu, u) : u;
	if (o->weight == ORACLE_NONE) {
		u = scale(1 / magnitude, u);
		v = scale(1 / magnitude, v);
	} else {
		u = lu > 0 ? scale(1 / lu, u) : u;
		v = lv > 0 ? scale(1 / lv, v) : v;
	}
	for (int k = 0; k < 3; k++) {
		const vec n = unit_normal(normal(m, c[k]));
		const vec e = edge[k], g = scale(-1, edge[(k + 2) % 3]);
		const quad cosine = dot(project(n, e), project(n, g));
		quad sine = dot(n, n) > 0 ? dot(n, across) : length(across);
		sine = sine < 0 ? -sine : sine + 0; /* no -0: atan2(-0, -1) is -pi */
		const quad squares = sine * sine + cosine * cosine;
		const quad angle = squares > 0 ? arc_tangent(sine, cosine) : 0;
		const quad angle_condition = squares > 0 ? ((cosine < 0 ? -cosine : cosine) * length(across) +
			sine * length(e) * length(g)) / squares : 0;
		const quad factor = o->weight == ORACLE_AREA ? length(e) * length(g) : 1;
		sums *s = &o->sum[o->vertex[c[k]]][side];
		add_direction(o->weight, u, n, factor, angle, angle_condition, &s->t, &s->spread_t);
		add_direction(o->weight, v, n, factor, angle, angle_condition, &s->b, &s->spread_b);
		const float *raw = normal(m, c[k]);
		const double off = (double)raw[0] * raw[0] + (double)raw[1] * raw[1] + (double)raw[2] * raw[2] - 1;
		add_float(&o->corners[c[k]], s, in, unit_u, n, isfinite(off) ? fabs(off) * 0x1p24 : 0, angle, sine,
			squares, length(e) * length(g));
		o->beyond[o->vertex[c[k]]] |= (unsigned char)in.beyond;
	}
}

static double finish(vec sum, quad spread, double out[3])
{
	const quad size = length(sum);
	for (int i = 0; i < 3; i++)
		out[i] = size > 0 ? (double)(sum.x[i] / size) : 0;
	return size > 0 ? (double)(spread / size) : (double)INFINITY;
}

/* For ORACLE_ANGLE, whose sums have its weights. */
static double finish_float(const oracle *o, size_t vertex, int side)
{
	const sums *s = &o->sum[vertex][side];
	const quad size = length(s->t), spread = s->spread_float + (s->triangles > 1 ? s->spread_angle : 0);
	/* alone, a triangle whose sign is lost has a wrong w, which repair sees */
	const bool alone = s->triangles + o->sum[vertex][!side].triangles < 2;
	return size > 0 && !(o->beyond[vertex] & (alone ? OUT_OF_RANGE : OUT_OF_RANGE | SIGN_LOST)) ? (double)(spread / size) : (double)INFINITY;
}

static double degrees_between(const double a[3], const double b[3])
{
	const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
	const double sine = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
	return atan2(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * 57.29577951308232;
}

static void find_spreads(const oracle *o)
{
	for (size_t c = 0; c < o->corner_count; c++) {
		oracle_corner *corner = &o->corners[c];
		double *most = &o->sum[o->vertex[c]][corner->sign > 0].degrees;
		for (int i = 0; i < corner->own_count; i++)
			*most = fmax(*most, degrees_between(corner->t, corner->own[i]));
	}
	for (size_t c = 0; c < o->corner_count; c++) {
		const double degrees = o->sum[o->vertex[c]][o->corners[c].sign > 0].degrees;
		o->corners[c].spread_degrees = degrees < 90 ? degrees : 180;
	}
}

bool oracle_solve(const nmtan_mesh *mesh, oracle_weight weight, oracle_corner *corners)
{
	oracle o = {.corners = corners, .mesh = mesh, .weight = weight, .corner_count = 3 * mesh->face_count};
	for (size_t f = 0; mesh->face_sizes && f < mesh->face_count; f++)
		o.corner_count += mesh->face_sizes[f] == 4;
	o.vertex = malloc((o.corner_count + 1) * sizeof *o.vertex);
	o.sum = calloc(o.corner_count + 1, sizeof *o.sum);
	o.beyond = calloc(o.corner_count + 1, 1);
	bool done = o.vertex && o.sum && o.beyond && weld(&o);
	for (size_t c = 0; c < o.corner_count; c++)
		corners[c] = (oracle_corner){.own_condition_float = INFINITY};
	for (size_t f = 0, first = 0; done && f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		size_t triangles[2][3];
		const int count = cut_face(&o, first, size, triangles);
		const int sign = face_sign(&o, triangles, count);
		/* the halves of a folded quad pull in opposite directions; what MikkTSpace makes of them is its own */
		if (count == 2 && sign_of(uv_determinant(&o, triangles[0])) != sign_of(uv_determinant(&o, triangles[1])))
			for (size_t c = first; c < first + 4; c++)
				o.beyond[o.vertex[c]] |= OUT_OF_RANGE;
		for (int i = 0; i < count; i++)
			add_triangle(&o, triangles[i], sign > 0);
		for (size_t c = first; c < first + size; c++)
			corners[c].sign = sign;
		first += size;
	}
	for (size_t c = 0; done && c < o.corner_count; c++) {
		const sums *s = &o.sum[o.vertex[c]][corners[c].sign > 0];
		corners[c].condition = finish(s->t, s->spread_t, corners[c].t);
		corners[c].condition_b = finish(s->b, s->spread_b, corners[c].b);
		corners[c].condition_float = finish_float(&o, o.vertex[c], corners[c].sign > 0);
	}
	if (done)
		find_spreads(&o);
	free(o.beyond);
	free(o.vertex);
	free(o.sum);
	return done;
}

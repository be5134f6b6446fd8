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
} sums;

typedef struct oracle {
	oracle_corner *corners; /* [corner_count] */
	const nmtan_mesh *mesh;
	oracle_weight weight;
	size_t corner_count;
	size_t *vertex; /* [corner_count] welded */
	sums (*sum)[2]; /* [corner_count] */
	oracle_triangle *triangles; /* filled one after the other; NULL: not wanted */
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

static bool equal_rows(const float *a, const float *b)
{
	return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool is_collapsed(const oracle *o, const size_t c[3])
{
	const float *p[3] = {position(o->mesh, c[0]), position(o->mesh, c[1]), position(o->mesh, c[2])};
	return equal_rows(p[0], p[1]) || equal_rows(p[1], p[2]) || equal_rows(p[2], p[0]);
}

/* A face has one orientation: that of its visible half, if the other one has two corners at one place; else that of the
 * half with the larger area if they differ. */
static int face_sign(const oracle *o, size_t triangles[2][3], int count)
{
	const integer first = uv_determinant(o, triangles[0]);
	if (count == 1)
		return sign_of(first);
	const integer second = uv_determinant(o, triangles[1]);
	if (sign_of(first) != sign_of(second) && is_collapsed(o, triangles[0]) != is_collapsed(o, triangles[1]))
		return sign_of(is_collapsed(o, triangles[0]) ? second : first);
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

static void to_doubles(vec v, double *to)
{
	const quad size = length(v);
	for (int i = 0; i < 3; i++)
		to[i] = size > 0 ? (double)(v.x[i] / size) : 0;
}

static void find_range(const quad *values, size_t count, double *least, double *largest)
{
	*least = INFINITY;
	*largest = 0;
	for (size_t i = 0; i < count; i++) {
		*least = fmin(*least, (double)values[i]);
		*largest = fmax(*largest, (double)values[i]);
	}
}

/* The effect of float on the triangle as a whole. u and v are the lengths of dP/du and dP/dv times |determinant|;
 * products [2] receives the two products that each is the difference of. */
static void judge_float(const float *const p[3], const float *const t[3], quad u, quad v, quad det, oracle_triangle *to,
	quad products[2])
{
	quad d[3] = {0, 0, 0}, e[2][2];
	for (int k = 0; k < 3; k++)
		for (int i = 0; i < 3; i++)
			d[k] += ((quad)p[(k + 1) % 3][i] - p[k][i]) * ((quad)p[(k + 1) % 3][i] - p[k][i]);
	for (int k = 0; k < 2; k++)
		for (int i = 0; i < 2; i++)
			e[k][i] = fabs((double)t[k + 1][i] - t[0][i]);
	for (int i = 0; i < 2; i++)
		products[i] = e[1][1 - i] * square_root(d[0]) + e[0][1 - i] * square_root(d[2]);
	const quad formed[] = {det, u, v, det > 0 ? u / det : 0, det > 0 ? v / det : 0},
		squares[] = {d[0], d[1], d[2], u * u};
	find_range(formed, sizeof formed / sizeof *formed, &to->least, &to->largest);
	find_range(squares, sizeof squares / sizeof *squares, &to->least_square, &to->largest_square);
}

/* dP/du or dP/dv across n; returns its condition. Products and their difference may leave the range of normal floats: a
 * unit is 2^-149 then, not 2^-24 of them. */
static double give_direction(vec direction, vec n, double off_unit, quad products, double *to)
{
	const quad size = length(direction);
	const vec projected = project(n, size > 0 ? scale(1 / size, direction) : direction);
	const quad left = length(projected);
	to_doubles(projected, to);
	return left > 0 ? (double)(((products + 0x1p-123) / size + 1 + off_unit) / left) : (double)INFINITY;
}

/* Its result for corner k. off_unit: |n|^2 - 1 in units of 2^-24. Weights are acos() of the cosine of two unit vectors:
 * 1 / sine, but for what is left near 0 and pi, half of the bits. */
static void give_corner(oracle_triangle *to, int k, const vec directions[2], vec n, double off_unit,
	const quad products[2], quad angle, quad sine, quad squares, quad edges)
{
	const quad worst = 4096, inverse = sine > 0 ? square_root(squares) / sine : worst;
	to->at[k].t_condition = give_direction(directions[0], n, off_unit, products[0], to->at[k].t);
	to->at[k].b_condition = give_direction(directions[1], n, off_unit, products[1], to->at[k].b);
	to->at[k].angle = (double)angle;
	to->at[k].angle_condition =
		(double)((inverse < worst ? inverse : worst) + (squares > 0 ? edges / square_root(squares) : 0));
}

/* The one place of MikkTSpace where a rounded number decides what a triangle is. */
static int sign_in_float(const float *a, const float *b, const float *c)
{
	const float bu = b[0] - a[0], bv = b[1] - a[1], cu = c[0] - a[0], cv = c[1] - a[1], p = bu * cv, q = bv * cu;
	const float det = p - q;
	return det > 0x1p-126f ? 1 : det < -0x1p-126f ? -1 : 0;
}

/* Its corners and orientation; NULL: not wanted. */
static oracle_triangle *begin_triangle(oracle *o, const size_t c[3], int side, int sign)
{
	oracle_triangle *to = o->triangles;
	if (!to)
		return NULL;
	o->triangles++;
	*to = (oracle_triangle){.sign = sign, .side = side ? 1 : -1, .largest = INFINITY,
		.largest_square = INFINITY};
	to->float_sign = sign_in_float(texcoord(o->mesh, c[0]), texcoord(o->mesh, c[1]), texcoord(o->mesh, c[2]));
	for (int k = 0; k < 3; k++) {
		to->corner[k] = c[k];
		to->vertex[k] = o->vertex[c[k]];
	}
	to->sound = !is_collapsed(o, c);
	return to;
}

/* A triangle of a face of that orientation. */
static void add_triangle(oracle *o, const size_t c[3], int face)
{
	const int side = face > 0;
	const nmtan_mesh *m = o->mesh;
	const integer det = uv_determinant(o, c);
	const int sign = sign_of(det);
	oracle_triangle *given = begin_triangle(o, c, side, sign);
	const float *p[3], *t[3];
	for (int k = 0; k < 3; k++) {
		p[k] = position(m, c[k]);
		t[k] = texcoord(m, c[k]);
		if (!all_finite(p[k], 3))
			return;
	}
	if (sign == 0) {
		quad ignored[2];
		if (given && all_finite(t[0], 2) && all_finite(t[1], 2) && all_finite(t[2], 2))
			judge_float(p, t, 0, 0, 0, given, ignored);
		return;
	}
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
	const vec directions[2] = {u, v};
	quad products[2] = {0, 0};
	if (given)
		judge_float(p, t, lu, lv, magnitude, given, products);
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
		/* of an edge along the normal MikkTSpace takes acos(0) */
		const quad point = length(e) > 0 && length(g) > 0 ? arc_tangent(1, 0) : 0;
		const quad angle = squares > 0 ? arc_tangent(sine, cosine) : point;
		const quad angle_condition = squares > 0 ? ((cosine < 0 ? -cosine : cosine) * length(across) +
			sine * length(e) * length(g)) / squares : 0;
		const quad factor = o->weight == ORACLE_AREA ? length(e) * length(g) : 1;
		sums *s = &o->sum[o->vertex[c[k]]][side];
		if (face) {
			add_direction(o->weight, u, n, factor, angle, angle_condition, &s->t, &s->spread_t);
			add_direction(o->weight, v, n, factor, angle, angle_condition, &s->b, &s->spread_b);
		}
		const float *raw = normal(m, c[k]);
		const double off = (double)raw[0] * raw[0] + (double)raw[1] * raw[1] + (double)raw[2] * raw[2] - 1;
		if (given)
			give_corner(given, k, directions, n, isfinite(off) ? fabs(off) * 0x1p24 : 0, products,
				angle, sine, squares, length(e) * length(g));
	}
}

static double finish(vec sum, quad spread, double out[3])
{
	const quad size = length(sum);
	for (int i = 0; i < 3; i++)
		out[i] = size > 0 ? (double)(sum.x[i] / size) : 0;
	return size > 0 ? (double)(spread / size) : (double)INFINITY;
}

size_t oracle_triangle_count(const nmtan_mesh *mesh)
{
	size_t count = mesh->face_count;
	for (size_t f = 0; mesh->face_sizes && f < mesh->face_count; f++)
		count += mesh->face_sizes[f] == 4;
	return count;
}

static bool solve(const nmtan_mesh *mesh, oracle_weight weight, oracle_corner *corners, oracle_triangle *list)
{
	oracle o = {.corners = corners, .mesh = mesh, .weight = weight, .triangles = list,
		.corner_count = oracle_triangle_count(mesh) + 2 * mesh->face_count};
	o.vertex = malloc((o.corner_count + 1) * sizeof *o.vertex);
	o.sum = calloc(o.corner_count + 1, sizeof *o.sum);
	const bool done = o.vertex && o.sum && weld(&o);
	for (size_t f = 0, first = 0; done && f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		size_t triangles[2][3];
		const int count = cut_face(&o, first, size, triangles);
		const int sign = face_sign(&o, triangles, count);
		for (int i = 0; i < count; i++)
			add_triangle(&o, triangles[i], sign);
		for (size_t c = first; c < first + size; c++)
			corners[c].sign = sign;
		first += size;
	}
	for (size_t c = 0; done && c < o.corner_count; c++) {
		const sums *s = &o.sum[o.vertex[c]][corners[c].sign > 0];
		corners[c].condition = finish(s->t, s->spread_t, corners[c].t);
		corners[c].condition_b = finish(s->b, s->spread_b, corners[c].b);
	}
	free(o.vertex);
	free(o.sum);
	return done;
}

bool oracle_solve(const nmtan_mesh *mesh, oracle_weight weight, oracle_corner *corners)
{
	return solve(mesh, weight, corners, NULL);
}

bool oracle_solve_triangles(const nmtan_mesh *mesh, oracle_corner *corners, oracle_triangle *triangles)
{
	return solve(mesh, ORACLE_ANGLE, corners, triangles);
}

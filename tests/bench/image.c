/* SPDX-License-Identifier: MIT */
/* See image.h. */
#include "image.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include "surfaces.h"

static const double DEGREES = 57.29577951308232;

const image_convention image_conventions[IMAGE_CONVENTIONS] = {
	{"B per pixel, 16 bits", true, false, 16},
	{"B per pixel, unit, 16 bits", true, true, 16},
	{"B per vertex, 16 bits", false, false, 16},
	{"B per vertex, unit, 16 bits", false, true, 16},
	{"B per pixel, 8 bits", true, false, 8},
	{"B per pixel, unit, 8 bits", true, true, 8},
	{"B per vertex, 8 bits", false, false, 8},
	{"B per vertex, unit, 8 bits", false, true, 8},
};

static void cross(const double a[3], const double b[3], double out[3])
{
	for (int i = 0; i < 3; i++)
		out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise(double v[3])
{
	const double length = sqrt(dot(v, v));
	for (int i = 0; i < 3; i++)
		v[i] = length > 0 ? v[i] / length : 0;
}

void image_field(const double p[3], const double n[3], double m[3])
{
	const double bump[3] = {0.35 * sin(97 * p[1] + 31 * p[2]), 0.35 * sin(89 * p[2] + 27 * p[0]),
		0.35 * sin(103 * p[0] + 35 * p[1])};
	const double along = dot(bump, n);
	for (int i = 0; i < 3; i++)
		m[i] = n[i] + bump[i] - along * n[i];
	normalise(m);
}

typedef struct frame {
	double t[3], b[3], n[3];
} frame;

static frame interpolate(const image_triangle *triangle, const double weights[3], const image_convention *convention)
{
	frame f = {{0}, {0}, {0}};
	double w = 0;
	for (int k = 0; k < 3; k++) {
		double b[3];
		cross(triangle->n[k], triangle->t[k], b);
		w += weights[k] * triangle->w[k];
		for (int i = 0; i < 3; i++) {
			f.t[i] += weights[k] * triangle->t[k][i];
			f.n[i] += weights[k] * triangle->n[k][i];
			f.b[i] += weights[k] * triangle->w[k] * b[i];
		}
	}
	if (convention->per_pixel) {
		cross(f.n, f.t, f.b);
		for (int i = 0; i < 3; i++)
			f.b[i] *= w;
	}
	if (convention->normalised) {
		normalise(f.t);
		normalise(f.b);
		normalise(f.n);
	}
	return f;
}

/* The inverse of decode() up to a factor, by cross products; false: there is none. */
static bool encode(const frame *f, const double m[3], double texel[3])
{
	double bn[3], nt[3], tb[3];
	cross(f->b, f->n, bn);
	cross(f->n, f->t, nt);
	cross(f->t, f->b, tb);
	const double determinant = dot(f->t, bn);
	if (!(fabs(determinant) > 1e-6))
		return false;
	texel[0] = dot(m, bn) / determinant;
	texel[1] = dot(m, nt) / determinant;
	texel[2] = dot(m, tb) / determinant;
	normalise(texel);
	return true;
}

static void quantise(double texel[3], int bits)
{
	const double most = (double)((1 << bits) - 1);
	for (int i = 0; i < 3; i++)
		texel[i] = round((texel[i] * 0.5 + 0.5) * most) / most * 2 - 1;
}

static void decode(const frame *f, const double texel[3], double shown[3])
{
	for (int i = 0; i < 3; i++)
		shown[i] = texel[0] * f->t[i] + texel[1] * f->b[i] + texel[2] * f->n[i];
	normalise(shown);
}

double image_error(const image_triangle *baker, const image_triangle *shader, const double weights[3],
	const double m[3], const image_convention *convention)
{
	const frame baked = interpolate(baker, weights, convention), shading = interpolate(shader, weights, convention);
	double texel[3], shown[3], across[3];
	if (!encode(&baked, m, texel))
		return NAN;
	quantise(texel, convention->bits);
	decode(&shading, texel, shown);
	cross(shown, m, across);
	const double degrees = atan2(sqrt(dot(across, across)), dot(shown, m)) * DEGREES;
	return isfinite(degrees) ? degrees : 180;
}

/* A frame around z, turned by an angle. */
static image_triangle turned(double radians, double w)
{
	image_triangle triangle = {.w = {w, w, w}};
	for (int k = 0; k < 3; k++) {
		triangle.t[k][0] = cos(radians);
		triangle.t[k][1] = sin(radians);
		triangle.n[k][2] = 1;
	}
	return triangle;
}

bool image_check(void)
{
	static const double angles[] = {0, 0.001, 0.1, 1, 3.1};
	const image_triangle baker = turned(0, 1), other = turned(0, -1);
	nt_random random = nt_random_seed(5);
	for (int c = 0; c < IMAGE_CONVENTIONS; c++) {
		const image_convention *convention = &image_conventions[c];
		const double step = 2.0 / ((1 << convention->bits) - 1), most = sqrt(3) / 2 * step * DEGREES * 1.01;
		double squares = 0, worst = 0;
		enum { POINTS = 2000 };
		for (int i = 0; i < POINTS; i++) {
			const double p[3] = {nt_random_real(&random), nt_random_real(&random), nt_random_real(&random)};
			double m[3];
			image_field(p, baker.n[0], m);
			const double tilt = sqrt(m[0] * m[0] + m[1] * m[1]); /* its sine */
			const double weights[3] = {0.5, 0.3, 0.2};
			for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
				const image_triangle shader = turned(angles[a], 1);
				const double error = image_error(&baker, &shader, weights, m, convention);
				const double theory = 2 * asin(tilt * sin(angles[a] / 2)) * DEGREES;
				worst = fmax(worst, fabs(error - theory));
				squares += a == 0 ? error * error : 0;
			}
			const double mirrored = image_error(&baker, &other, weights, m, convention);
			worst = fmax(worst, fabs(mirrored - 2 * asin(fabs(m[1])) * DEGREES));
		}
		const double rms = sqrt(squares / POINTS), expected = step / sqrt(6) * DEGREES;
		if (!(worst <= most) || !(fabs(rms / expected - 1) < 0.05)) {
			fprintf(stderr, "bench: the image error departs from theory: %s: by %g degrees (at "
				"most %g), rms %g for %g\n",
				convention->name, worst, most, rms, expected);
			return false;
		}
	}
	return true;
}

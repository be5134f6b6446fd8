/* SPDX-License-Identifier: MIT */
/*
 * See error_eye.h. As renderers do: T and N are interpolated and not normalised before they are used,
 * B = cross(N, T) w, the decoded normal is normalised. Texels are quantised to 8 bits; filtering is left
 * out.
 */
#include "error_eye.h"

#include <math.h>

enum { STEPS = 5 }; /* samples per triangle: STEPS (STEPS + 1) / 2 */

typedef struct frame {
	double t[3], b[3], n[3];
} frame;

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

/* The detail, as a normal over the smooth surface: bumps of about 20 degrees. */
static void detail(const double uv[2], double m[3])
{
	m[0] = 0.25 * sin(40 * uv[0]) * cos(30 * uv[1]) + 0.1 * sin(90 * uv[1]);
	m[1] = 0.25 * cos(25 * uv[0] + 10 * uv[1]) + 0.1 * sin(80 * uv[0]);
	m[2] = 1;
	normalise(m);
}

static void apply(const frame *f, const double m[3], double out[3])
{
	for (int i = 0; i < 3; i++)
		out[i] = m[0] * f->t[i] + m[1] * f->b[i] + m[2] * f->n[i];
	normalise(out);
}

/* The inverse of apply(), by cross products. */
static void encode(const frame *f, const double normal[3], double m[3])
{
	double bn[3], nt[3], tb[3];
	cross(f->b, f->n, bn);
	cross(f->n, f->t, nt);
	cross(f->t, f->b, tb);
	const double det = dot(f->t, bn) < 0 ? -1 : 1;
	m[0] = det * dot(normal, bn);
	m[1] = det * dot(normal, nt);
	m[2] = det * dot(normal, tb);
	normalise(m);
}

static void quantise(double m[3])
{
	for (int i = 0; i < 3; i++)
		m[i] = round((m[i] * 0.5 + 0.5) * 255) / 255 * 2 - 1;
}

static frame interpolate(const nt_owned *mesh, size_t triangle, const double weights[3],
	const float (*tangents)[4])
{
	frame f = {{0}, {0}, {0}};
	for (size_t k = 0; k < 3; k++) {
		const size_t c = 3 * triangle + k;
		for (int i = 0; i < 3; i++) {
			f.t[i] += weights[k] * tangents[c][i];
			f.n[i] += weights[k] * mesh->normals[mesh->indices[c]][i];
		}
	}
	cross(f.n, f.t, f.b);
	for (int i = 0; i < 3; i++)
		f.b[i] *= tangents[3 * triangle][3];
	return f;
}

static double shade(const double n[3])
{
	static const double light[3] = {0.4242640687, 0.5656854249, 0.7071067812};
	return fmax(0, dot(n, light));
}

static void add_sample(const double shown[3], const double wanted[3], eye_sum *sum)
{
	double across[3];
	cross(shown, wanted, across);
	const double degrees = atan2(sqrt(dot(across, across)), dot(shown, wanted)) * 57.29577951308232;
	const double difference = shade(shown) - shade(wanted);
	sum->samples++;
	sum->squared_degrees += degrees * degrees;
	sum->worst_degrees = fmax(sum->worst_degrees, degrees);
	sum->squared_shade += difference * difference;
}

void eye_add(const bench_mesh *mesh, const float (*baker)[4], const float (*decoder)[4], eye_sum *sum)
{
	const nt_owned *o = &mesh->mesh;
	for (size_t t = 0; t < o->mesh.face_count; t++) {
		for (int i = 0; i < STEPS; i++) {
			for (int k = 0; k + i < STEPS; k++) {
				const double a = (i + 1.0 / 3) / STEPS, b = (k + 1.0 / 3) / STEPS;
				const double weights[3] = {a, b, 1 - a - b};
				double uv[2] = {0, 0};
				for (size_t j = 0; j < 3; j++)
					for (int x = 0; x < 2; x++)
						uv[x] += weights[j] * o->texcoords[o->indices[3 * t + j]][x];
				frame truth;
				if (!bench_frame_at(mesh, uv, truth.t, truth.n))
					continue;
				cross(truth.n, truth.t, truth.b);
				double m[3], wanted[3], shown[3];
				detail(uv, m);
				apply(&truth, m, wanted);
				if (baker) {
					const frame baked = interpolate(o, t, weights, baker);
					encode(&baked, wanted, m);
				}
				quantise(m);
				const frame decoded = interpolate(o, t, weights, decoder);
				apply(&decoded, m, shown);
				add_sample(shown, wanted, sum);
			}
		}
	}
}

double eye_rms_degrees(const eye_sum *sum)
{
	return sqrt(sum->squared_degrees / (double)(sum->samples ? sum->samples : 1));
}

double eye_psnr(const eye_sum *sum)
{
	return -10 * log10(sum->squared_shade / (double)(sum->samples ? sum->samples : 1));
}

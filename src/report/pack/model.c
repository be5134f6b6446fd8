/* SPDX-License-Identifier: MIT */
/*
 * A small picture of a mesh: see thumb.h. Triangles are drawn with a depth for each pixel, seen without perspective
 * from the front, from the right and a little from above; brighter where they face the eye. Triangles smaller than a
 * pixel have no middle of one inside: of a mesh of many the others cover the surface.
 */
#include "report/pack/thumb.h"

#include <math.h>
#include <stdlib.h>
#include "ext/deflate.h"

enum { PIXELS = NT_MODEL_WIDTH * NT_MODEL_HEIGHT, MARGIN = 4 };

/* To the right, up and towards the eye, of a camera turned by 0.6 and raised by 0.3. */
static const double axes[3][3] = {{0.8253356, 0.0, -0.5646425}, {-0.1668633, 0.9553365, -0.2439034},
	{0.5394236, 0.2955202, 0.7884732}};

typedef struct view {
	double middle[2], scale;
	float *depth;         /* [PIXELS] */
	unsigned char *shade; /* [PIXELS] */
} view;

/* The place of a position along the axes; false where it is not finite. */
static bool turn(const float *p, double turned[3])
{
	for (int i = 0; i < 3; i++)
		turned[i] = axes[i][0] * p[0] + axes[i][1] * p[1] + axes[i][2] * p[2];
	return isfinite(turned[0]) && isfinite(turned[1]) && isfinite(turned[2]);
}

static void fit(const nt_report_geometry *g, view *v)
{
	double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, p[3];
	for (size_t c = 0; c < 3 * g->triangle_count; c++)
		for (int i = 0; i < 2 && turn(g->positions + 3 * (size_t)g->indices[c], p); i++) {
			low[i] = fmin(low[i], p[i]);
			high[i] = fmax(high[i], p[i]);
		}
	const double across = (NT_MODEL_WIDTH - 2 * MARGIN) / (high[0] - low[0]);
	const double down = (NT_MODEL_HEIGHT - 2 * MARGIN) / (high[1] - low[1]);
	v->scale = fmin(across, down);
	for (int i = 0; i < 2; i++)
		v->middle[i] = (low[i] + high[i]) / 2.0;
}

/* From 1 to 255. */
static unsigned char shade_of(const double p[3][3])
{
	double a[3], b[3];
	for (int i = 0; i < 3; i++) {
		a[i] = p[1][i] - p[0][i];
		b[i] = p[2][i] - p[0][i];
	}
	const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
	const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	/* light from the left above the eye, and as much of it on the back of a sheet */
	const double light = length > 0.0 ? fabs(-0.3 * n[0] + 0.45 * n[1] + 0.84 * n[2]) / length : 0.0;
	return (unsigned char)(60.0 + 190.0 * fmin(light, 1.0));
}

static int clamp(double x, int most)
{
	return x < 0.0 ? 0 : x > most ? most : (int)x;
}

/* p: in pixels, depth towards the eye. */
static void draw_triangle(const view *v, double p[3][3], unsigned char shade)
{
	const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
	if (!(fabs(area) > 0.0))
		return;
	const int x1 = clamp(fmax(fmax(p[0][0], p[1][0]), p[2][0]) + 1.0, NT_MODEL_WIDTH);
	const int y1 = clamp(fmax(fmax(p[0][1], p[1][1]), p[2][1]) + 1.0, NT_MODEL_HEIGHT);
	for (int y = clamp(fmin(fmin(p[0][1], p[1][1]), p[2][1]), NT_MODEL_HEIGHT); y < y1; y++)
		for (int x = clamp(fmin(fmin(p[0][0], p[1][0]), p[2][0]), NT_MODEL_WIDTH); x < x1; x++) {
			double share[3], depth = 0.0;
			for (int k = 0; k < 3; k++) {
				const double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
				share[k] = ((b[0] - a[0]) * (y + 0.5 - a[1]) - (b[1] - a[1]) * (x + 0.5 - a[0])) / area;
				depth += share[k] * p[k][2];
			}
			const int pixel = y * NT_MODEL_WIDTH + x;
			if (share[0] < 0.0 || share[1] < 0.0 || share[2] < 0.0 || (float)depth < v->depth[pixel])
				continue;
			v->depth[pixel] = (float)depth;
			v->shade[pixel] = shade;
		}
}

nt_status nt_thumb_model(const nt_report_geometry *g, nt_buffer *out)
{
	view v = {.depth = nt_alloc(PIXELS, sizeof(float)), .shade = nt_calloc(PIXELS, 1)};
	const bool failed = !v.depth || !v.shade;
	if (!failed)
		fit(g, &v);
	for (size_t i = 0; i < PIXELS && !failed; i++)
		v.depth[i] = -INFINITY;
	for (size_t t = 0; t < g->triangle_count && !failed && isfinite(v.scale); t++) {
		double p[3][3];
		bool there = true;
		for (int k = 0; k < 3; k++)
			there &= turn(g->positions + 3 * (size_t)g->indices[3 * t + (size_t)k], p[k]);
		if (!there)
			continue;
		const unsigned char shade = shade_of((const double(*)[3])p);
		for (int k = 0; k < 3; k++) {
			p[k][0] = NT_MODEL_WIDTH / 2 + (p[k][0] - v.middle[0]) * v.scale;
			p[k][1] = NT_MODEL_HEIGHT / 2 - (p[k][1] - v.middle[1]) * v.scale;
		}
		draw_triangle(&v, p, shade);
	}
	if (!failed)
		nt_deflate(v.shade, PIXELS, out);
	free(v.depth);
	free(v.shade);
	return failed || out->failed ? NT_ERROR_MEMORY : NT_OK;
}

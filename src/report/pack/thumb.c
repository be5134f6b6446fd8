/* SPDX-License-Identifier: MIT */
/*
 * Small pictures: see pack.h. Triangles are drawn row by row; a mesh, with a depth for each pixel, is seen without
 * perspective from the front, from the right and a little from above, brighter where it faces the eye. Triangles
 * smaller than a pixel have no middle of one inside: of a mesh of many the others cover the surface.
 */
#include "report/pack/pack.h"

#include <math.h>
#include <stdlib.h>
#include "ext/deflate.h"

enum { PIXELS = NT_THUMB_WIDTH * NT_THUMB_HEIGHT, CHANGES = (NT_THUMB_WIDTH + 1) * NT_THUMB_HEIGHT, MARGIN = 4 };

/* To the right, up and towards the eye, of a camera turned by 0.6 and raised by 0.3. */
static const double axes[3][3] = {{0.8253356, 0.0, -0.5646425}, {-0.1668633, 0.9553365, -0.2439034},
	{0.5394236, 0.2955202, 0.7884732}};

typedef struct picture {
	const nt_report_geometry *geometry;
	bool layout, v_down;
	double middle[2], scale;
	float *depth;         /* [PIXELS] of a mesh */
	/* [CHANGES] of a layout, unmirrored and mirrored: how many triangles begin at a pixel of a row, less those that
	 * end before it, so that stacked ones take a step for each row */
	int32_t *changes[2];
	unsigned char *shade; /* [PIXELS] */
} picture;

/* The places of a triangle's corners: to the right, down and towards the eye. False where one is not finite, or no
 * place in a texture. */
static bool place(const picture *d, size_t triangle, double p[3][3])
{
	const nt_report_geometry *g = d->geometry;
	bool finite = true;
	for (size_t k = 0; k < 3; k++) {
		const size_t vertex = g->indices[3 * triangle + k];
		if (d->layout) {
			p[k][0] = g->texcoords[2 * vertex];
			p[k][1] = d->v_down ? g->texcoords[2 * vertex + 1] : -g->texcoords[2 * vertex + 1];
			p[k][2] = g->orientation[triangle] < 0; /* not a depth: its shade */
		} else {
			const float *at = g->positions + 3 * vertex;
			for (int i = 0; i < 3; i++)
				p[k][i] = axes[i][0] * at[0] + axes[i][1] * at[1] + axes[i][2] * at[2];
			p[k][1] = -p[k][1];
		}
		finite &= isfinite(p[k][0]) && isfinite(p[k][1]) && isfinite(p[k][2]);
		finite &= !d->layout || (fabs(p[k][0]) <= NT_MOST_TEXCOORD && fabs(p[k][1]) <= NT_MOST_TEXCOORD);
	}
	return finite;
}

static void fit(picture *d)
{
	double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, p[3][3];
	for (size_t t = 0; t < d->geometry->triangle_count; t++) {
		if (!place(d, t, p))
			continue;
		for (int i = 0; i < 6; i++) {
			low[i % 2] = fmin(low[i % 2], p[i / 2][i % 2]);
			high[i % 2] = fmax(high[i % 2], p[i / 2][i % 2]);
		}
	}
	const double across = (NT_THUMB_WIDTH - 2 * MARGIN) / (high[0] - low[0]);
	const double down = (NT_THUMB_HEIGHT - 2 * MARGIN) / (high[1] - low[1]);
	d->scale = fmin(across, down);
	for (int i = 0; i < 2; i++)
		d->middle[i] = (low[i] + high[i]) / 2.0;
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
	const double light = length > 0.0 ? fabs(0.3 * n[0] + 0.45 * n[1] - 0.84 * n[2]) / length : 0.0;
	return (unsigned char)(60.0 + 190.0 * fmin(light, 1.0));
}

static int clamp(double x, int most)
{
	return x < 0.0 ? 0 : x > most ? most : (int)x;
}

/* The pixels of a row whose middles lie between two points; depth runs from one to the other. */
static void draw_row(const picture *d, int y, const double *left, const double *right, unsigned char shade)
{
	const int begin = clamp(ceil(left[0] - 0.5), NT_THUMB_WIDTH);
	const int end = clamp(floor(right[0] - 0.5) + 1.0, NT_THUMB_WIDTH);
	const double slope = right[0] > left[0] ? (right[2] - left[2]) / (right[0] - left[0]) : 0.0;
	if (d->layout && begin < end) {
		int32_t *changes = d->changes[shade - 1] + y * (NT_THUMB_WIDTH + 1);
		changes[begin]++;
		changes[end]--;
	}
	for (int x = begin; x < end && !d->layout; x++) {
		const float depth = (float)(left[2] + (x + 0.5 - left[0]) * slope);
		const int pixel = y * NT_THUMB_WIDTH + x;
		if (depth < d->depth[pixel])
			continue;
		d->depth[pixel] = depth;
		d->shade[pixel] = shade;
	}
}

/* p: in pixels, depth towards the eye. An edge is cut by a row at the same place whichever triangle has it, so that
 * nothing shows between neighbours. */
static void draw_triangle(const picture *d, double p[3][3], unsigned char shade)
{
	const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
	if (!(fabs(area) > 0.0))
		return;
	const int last = clamp(fmax(fmax(p[0][1], p[1][1]), p[2][1]) + 0.5, NT_THUMB_HEIGHT);
	for (int y = clamp(fmin(fmin(p[0][1], p[1][1]), p[2][1]) - 0.5, NT_THUMB_HEIGHT); y < last; y++) {
		double cuts[2][3];
		int count = 0;
		for (int k = 0; k < 3 && count < 2; k++) {
			const double *a = p[k], *b = p[(k + 1) % 3];
			const double *upper = a[1] < b[1] ? a : b, *lower = a[1] < b[1] ? b : a;
			if (upper[1] > y + 0.5 || lower[1] <= y + 0.5)
				continue;
			const double share = (y + 0.5 - upper[1]) / (lower[1] - upper[1]);
			for (int i = 0; i < 3; i++)
				cuts[count][i] = upper[i] + share * (lower[i] - upper[i]);
			count++;
		}
		if (count == 2)
			draw_row(d, y, cuts[cuts[0][0] > cuts[1][0]], cuts[cuts[0][0] <= cuts[1][0]], shade);
	}
}

/* Mirrored triangles lie on unmirrored ones. */
static void shade_layout(const picture *d)
{
	for (int y = 0; y < NT_THUMB_HEIGHT; y++) {
		int32_t covers[2] = {0, 0};
		for (int x = 0; x < NT_THUMB_WIDTH; x++) {
			for (int mirrored = 0; mirrored < 2; mirrored++) {
				covers[mirrored] += d->changes[mirrored][y * (NT_THUMB_WIDTH + 1) + x];
				if (covers[mirrored])
					d->shade[y * NT_THUMB_WIDTH + x] = (unsigned char)(1 + mirrored);
			}
		}
	}
}

static nt_status draw(picture d, nt_buffer *out)
{
	d.depth = nt_alloc(PIXELS, sizeof(float));
	d.shade = nt_calloc(PIXELS, 1);
	for (int i = 0; i < 2; i++)
		d.changes[i] = nt_calloc(CHANGES, sizeof(int32_t));
	const bool made = d.depth && d.shade && d.changes[0] && d.changes[1];
	if (made)
		fit(&d);
	for (size_t i = 0; i < PIXELS && made; i++)
		d.depth[i] = -INFINITY;
	for (size_t t = 0; t < d.geometry->triangle_count && made && isfinite(d.scale); t++) {
		double p[3][3];
		if (!place(&d, t, p))
			continue;
		const unsigned char shade = d.layout ? (unsigned char)(1 + p[0][2]) : shade_of((const double(*)[3])p);
		for (int k = 0; k < 3; k++) {
			p[k][0] = NT_THUMB_WIDTH / 2 + (p[k][0] - d.middle[0]) * d.scale;
			p[k][1] = NT_THUMB_HEIGHT / 2 + (p[k][1] - d.middle[1]) * d.scale;
		}
		draw_triangle(&d, p, shade);
	}
	if (made && d.layout)
		shade_layout(&d);
	if (made)
		nt_deflate(d.shade, PIXELS, out);
	free(d.depth);
	free(d.shade);
	free(d.changes[0]);
	free(d.changes[1]);
	return made && !out->failed ? NT_OK : NT_ERROR_MEMORY;
}

nt_status nt_thumb_model(const nt_report_geometry *geometry, nt_buffer *out)
{
	return draw((picture){.geometry = geometry}, out);
}

nt_status nt_thumb_layout(const nt_report_geometry *geometry, bool v_down, nt_buffer *out)
{
	const picture wanted = {.geometry = geometry, .layout = true, .v_down = v_down};
	return geometry->texcoords ? draw(wanted, out) : NT_OK;
}

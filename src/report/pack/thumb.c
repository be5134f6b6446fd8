/* SPDX-License-Identifier: MIT */
/*
 * Small pictures: see pack.h. Triangles are drawn row by row; a mesh, with a depth for each pixel, is seen without
 * perspective from the front, from the right and a little from above, brighter where it faces the eye. Triangles
 * smaller than a pixel have no middle of one inside: of a mesh of many the others cover the surface.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "ext/linked.h"
#include "report/pack/pack.h"

enum { WIDTH = NT_THUMB_WIDTH, HEIGHT = NT_THUMB_HEIGHT, MARGIN = 4 };

/* The subject of a picture: a mesh in space, or, with rows of two numbers, its layout. */
typedef struct subject {
	const nt_report_geometry *geometry;
	const float *rows; /* [vertex_count][width] positions, or texture coordinates */
	size_t width;
	float most;        /* beyond which numbers are no place */
	double axes[3][3]; /* to the right, down and towards the eye */
} subject;

typedef struct picture {
	subject of;
	double middle[2], scale;
	float depth[HEIGHT][WIDTH]; /* of a mesh */
	/* of a layout, unmirrored and mirrored: how many triangles begin at a pixel of a row, less those that end
	 * before it, so that stacked ones take a step for each row */
	int32_t changes[2][HEIGHT][WIDTH + 1];
	unsigned char shade[HEIGHT][WIDTH];
} picture;

/* The places of a triangle's corners along the axes. False where one has none. */
static bool place(const picture *d, size_t triangle, double p[3][3])
{
	bool there = true;
	for (size_t k = 0; k < 3; k++) {
		const float *at = d->of.rows + d->of.width * d->of.geometry->indices[3 * triangle + k];
		for (size_t i = 0; i < 3; i++)
			p[k][i] = 0.0;
		for (size_t j = 0; j < d->of.width; j++) {
			there &= fabsf(at[j]) <= d->of.most;
			for (size_t i = 0; i < 3; i++)
				p[k][i] += d->of.axes[i][j] * at[j];
		}
	}
	return there;
}

/* Scales what is drawn to the picture. False: nothing is. */
static bool fit(picture *d)
{
	double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, p[3][3];
	for (size_t t = 0; t < d->of.geometry->triangle_count; t++) {
		const bool there = place(d, t, p);
		for (int i = 0; i < 6 && there; i++) {
			low[i % 2] = fmin(low[i % 2], p[i / 2][i % 2]);
			high[i % 2] = fmax(high[i % 2], p[i / 2][i % 2]);
		}
	}
	d->scale = fmin((WIDTH - 2 * MARGIN) / (high[0] - low[0]), (HEIGHT - 2 * MARGIN) / (high[1] - low[1]));
	for (int i = 0; i < 2; i++)
		d->middle[i] = (low[i] + high[i]) / 2.0;
	return isfinite(d->scale);
}

/* From 1 to 255. */
static unsigned char shade_of(double p[3][3])
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
static void draw_row(picture *d, int y, const double *left, const double *right, unsigned char shade)
{
	const int begin = clamp(ceil(left[0] - 0.5), WIDTH), end = clamp(floor(right[0] - 0.5) + 1.0, WIDTH);
	const double slope = right[0] > left[0] ? (right[2] - left[2]) / (right[0] - left[0]) : 0.0;
	if (d->of.width == 2 && begin < end) {
		d->changes[shade - 1][y][begin]++;
		d->changes[shade - 1][y][end]--;
	}
	for (int x = begin; x < end && d->of.width == 3; x++) {
		const float depth = (float)(left[2] + (x + 0.5 - left[0]) * slope);
		if (depth >= d->depth[y][x]) {
			d->depth[y][x] = depth;
			d->shade[y][x] = shade;
		}
	}
}

/* p: in pixels, depth towards the eye. An edge is cut by a row at the same place whichever triangle has it, so that
 * nothing shows between neighbours. */
static void draw_triangle(picture *d, double p[3][3], unsigned char shade)
{
	const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
	const int last = clamp(fmax(fmax(p[0][1], p[1][1]), p[2][1]) + 0.5, HEIGHT);
	for (int y = clamp(fmin(fmin(p[0][1], p[1][1]), p[2][1]) - 0.5, HEIGHT); y < last && fabs(area) > 0.0; y++) {
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

static void draw_triangles(picture *d)
{
	double p[3][3];
	for (size_t t = 0; t < d->of.geometry->triangle_count; t++) {
		if (!place(d, t, p))
			continue;
		const unsigned char shade = d->of.width == 3 ? shade_of(p) : d->of.geometry->orientation[t] < 0 ? 2 : 1;
		for (int k = 0; k < 3; k++) {
			p[k][0] = WIDTH / 2 + (p[k][0] - d->middle[0]) * d->scale;
			p[k][1] = HEIGHT / 2 + (p[k][1] - d->middle[1]) * d->scale;
		}
		draw_triangle(d, p, shade);
	}
}

/* From what begins and ends in each row; mirrored triangles lie on unmirrored ones. */
static void shade_layout(picture *d)
{
	for (int y = 0; y < HEIGHT; y++) {
		int32_t covers[2] = {0, 0};
		for (int x = 0; x < WIDTH; x++) {
			for (int mirrored = 0; mirrored < 2; mirrored++) {
				covers[mirrored] += d->changes[mirrored][y][x];
				d->shade[y][x] = covers[mirrored] ? (unsigned char)(1 + mirrored) : d->shade[y][x];
			}
		}
	}
}

static nt_status draw(const subject *of, nt_buffer *out)
{
	picture *d = nt_calloc(1, sizeof *d);
	if (!d)
		return NT_ERROR_MEMORY;
	d->of = *of;
	for (int i = 0; i < WIDTH * HEIGHT; i++)
		d->depth[i / WIDTH][i % WIDTH] = -INFINITY;
	if (fit(d))
		draw_triangles(d);
	if (d->of.width == 2)
		shade_layout(d);
	nt_deflate(d->shade, sizeof d->shade, out);
	free(d);
	return out->failed ? NT_ERROR_MEMORY : NT_OK;
}

/* Seen by a camera that is turned by 0.6 and raised by 0.3. */
nt_status nt_thumb_model(const nt_report_geometry *geometry, nt_buffer *out)
{
	const subject of = {geometry, geometry->positions, 3, FLT_MAX, {{0.8253356, 0.0, -0.5646425},
		{0.1668633, -0.9553365, 0.2439034}, {0.5394236, 0.2955202, 0.7884732}}};
	return draw(&of, out);
}

nt_status nt_thumb_layout(const nt_report_geometry *geometry, bool v_down, nt_buffer *out)
{
	const subject of = {geometry, geometry->texcoords, 2, NT_MOST_TEXCOORD, {{1.0}, {0.0, v_down ? 1.0 : -1.0}}};
	return geometry->texcoords ? draw(&of, out) : NT_OK;
}

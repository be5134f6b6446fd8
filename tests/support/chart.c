/* SPDX-License-Identifier: MIT */
/*
 * See chart.h. Colours are O. Okabe's and K. Ito's, which colour-blind readers can tell apart; marks differ
 * in shape as well.
 */
#include "chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 960, HEIGHT = 520, LEFT = 80, RIGHT = 660, TOP = 60, BOTTOM = 460 };

static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
	"#000000", "#999999", "#8c564b", "#6a3d9a", "#b15928", "#e31a1c"};
enum { COLOUR_COUNT = sizeof colours / sizeof *colours };

typedef struct axis {
	double low, high;
	bool logarithmic;
} axis;

static bool shown(double value, bool logarithmic)
{
	return isfinite(value) && (!logarithmic || value > 0);
}

static axis make_axis(const chart *c, bool vertical)
{
	axis a = {INFINITY, -INFINITY, vertical ? c->log_y : c->log_x};
	for (size_t s = 0; s < c->series_count; s++) {
		for (size_t i = 0; i < c->series[s].count; i++) {
			const double v = (vertical ? c->series[s].y : c->series[s].x)[i];
			if (shown(v, a.logarithmic)) {
				a.low = fmin(a.low, v);
				a.high = fmax(a.high, v);
			}
		}
	}
	if (!(a.low <= a.high))
		a.low = a.high = 1;
	if (a.logarithmic) {
		a.low = pow(10, floor(log10(a.low)));
		a.high = pow(10, ceil(log10(a.high)));
		if (a.low == a.high)
			a.high *= 10;
	} else {
		a.low = fmin(a.low, 0);
		a.high += a.high == a.low ? 1 : 0.05 * (a.high - a.low);
	}
	return a;
}

static double share(const axis *a, double v)
{
	return a->logarithmic ? (log10(v) - log10(a->low)) / (log10(a->high) - log10(a->low))
			      : (v - a->low) / (a->high - a->low);
}

static double place_x(const axis *a, double v)
{
	return LEFT + share(a, v) * (RIGHT - LEFT);
}

static double place_y(const axis *a, double v)
{
	return BOTTOM - share(a, v) * (BOTTOM - TOP);
}

static void print_text(FILE *f, const char *text)
{
	for (; text && *text; text++) {
		if (*text == '<')
			fputs("&lt;", f);
		else if (*text == '&')
			fputs("&amp;", f);
		else
			fputc(*text, f);
	}
}

static void print_label(FILE *f, double x, double y, const char *attributes, const char *text)
{
	fprintf(f, "<text x=\"%.0f\" y=\"%.0f\" %s>", x, y, attributes);
	print_text(f, text);
	fprintf(f, "</text>\n");
}

/* Ticks at powers of ten, or at five even steps. */
static void draw_ticks(FILE *f, const axis *a, bool vertical)
{
	const double decades = log10(a->high / a->low);
	const int step = decades > 24 ? 10 : decades > 12 ? 5 : decades > 8 ? 2 : 1;
	const int count = a->logarithmic ? (int)(decades + 0.5) / step : 5;
	for (int i = 0; i <= count; i++) {
		const double v = a->logarithmic ? a->low * pow(10, i * step) : a->low + (a->high - a->low) * i / 5;
		char text[32];
		snprintf(text, sizeof text, a->logarithmic && (v < 0.009 || v > 2000) ? "%.0e" : "%g", v);
		if (vertical) {
			const double y = place_y(a, v);
			fprintf(f, "<path class=\"grid\" d=\"M%d %.1fH%d\"/>\n", LEFT, y, RIGHT);
			print_label(f, LEFT - 6, y + 4, "text-anchor=\"end\"", text);
		} else {
			const double x = place_x(a, v);
			fprintf(f, "<path class=\"grid\" d=\"M%.1f %dV%d\"/>\n", x, TOP, BOTTOM);
			print_label(f, x, BOTTOM + 16, "text-anchor=\"middle\"", text);
		}
	}
}

static void draw_mark(FILE *f, double x, double y, size_t shape, const char *colour)
{
	const double r = 4.5;
	switch (shape % 4) {
	case 0:
		fprintf(f, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>\n", x, y, r, colour);
		break;
	case 1:
		fprintf(f, "<path d=\"M%.1f %.1fh%.1fv%.1fh%.1fz\" fill=\"%s\"/>\n", x - r, y - r, 2 * r,
			2 * r, -2 * r, colour);
		break;
	case 2:
		fprintf(f, "<path d=\"M%.1f %.1fl%.1f %.1fh%.1fz\" fill=\"%s\"/>\n", x, y - r - 1, r + 1,
			2 * r + 1, -2 * r - 2, colour);
		break;
	default:
		fprintf(f, "<path d=\"M%.1f %.1fl%.1f %.1fl%.1f %.1fl%.1f %.1fz\" fill=\"%s\"/>\n", x,
			y - r - 1, r + 1, r + 1, -r - 1, r + 1, -r - 1, -r - 1, colour);
		break;
	}
}

static void draw_series(FILE *f, const chart *c, size_t s, const axis *ax, const axis *ay)
{
	const chart_series *series = &c->series[s];
	const char *colour = colours[s % COLOUR_COUNT];
	bool drawing = false;
	if (!c->points)
		fprintf(f, "<path fill=\"none\" stroke-width=\"1.5\" stroke=\"%s\" d=\"M0 0", colour);
	for (size_t i = 0; i < series->count && !c->points; i++) {
		const bool here = shown(series->x[i], c->log_x) && shown(series->y[i], c->log_y);
		if (here)
			fprintf(f, "%c%.1f %.1f", drawing ? 'L' : 'M', place_x(ax, series->x[i]),
				place_y(ay, series->y[i]));
		drawing = here;
	}
	if (!c->points)
		fprintf(f, "\"/>\n");
	for (size_t i = 0; i < series->count; i++) {
		if (!shown(series->x[i], c->log_x) || !shown(series->y[i], c->log_y))
			continue;
		const double x = place_x(ax, series->x[i]), y = place_y(ay, series->y[i]);
		draw_mark(f, x, y, c->points ? i : s, colour);
	}
	const double y = TOP + 10 + 20.0 * (double)s;
	draw_mark(f, RIGHT + 18, y - 4, c->points ? 0 : s, colour);
	print_label(f, RIGHT + 30, y, "", series->name);
}

bool chart_write(const char *path, const chart *c)
{
	FILE *f = fopen(path, "w");
	if (!f)
		return false;
	const axis ax = make_axis(c, false), ay = make_axis(c, true);
	fprintf(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\""
		" font-family=\"sans-serif\" font-size=\"12\">\n<style>.grid{stroke:#ddd}</style>\n"
		"<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n", WIDTH, HEIGHT, WIDTH, HEIGHT);
	print_label(f, LEFT, 24, "font-size=\"16\"", c->title);
	print_label(f, LEFT, 44, "fill=\"#555\" font-size=\"11\"", c->subtitle);
	draw_ticks(f, &ax, false);
	draw_ticks(f, &ay, true);
	fprintf(f, "<path fill=\"none\" stroke=\"#333\" d=\"M%d %dV%dH%d\"/>\n", LEFT, TOP, BOTTOM, RIGHT);
	print_label(f, (LEFT + RIGHT) / 2.0, BOTTOM + 40, "text-anchor=\"middle\"", c->x_label);
	char turned[80];
	snprintf(turned, sizeof turned, "text-anchor=\"middle\" transform=\"rotate(-90 20 %d)\"",
		(TOP + BOTTOM) / 2);
	print_label(f, 20, (TOP + BOTTOM) / 2.0, turned, c->y_label);
	for (size_t s = 0; s < c->series_count; s++)
		draw_series(f, c, s, &ax, &ay);
	for (size_t m = 0; c->points && c->marks && c->marks[m]; m++) {
		const double y = TOP + 30 + 20.0 * (double)(c->series_count + m);
		draw_mark(f, RIGHT + 18, y - 4, m, "#777");
		print_label(f, RIGHT + 30, y, "", c->marks[m]);
	}
	fprintf(f, "</svg>\n");
	return fclose(f) == 0;
}

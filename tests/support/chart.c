/* SPDX-License-Identifier: MIT */
/*
 * See chart.h. Colours are O. Okabe's and K. Ito's, which colour-blind readers can tell apart; marks differ
 * in shape as well.
 */
#include "chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 1020, LEFT = 80, RIGHT = 660, TOP = 60, LEAST_HEIGHT = 400, LEGEND_LINE = 18 };

static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
	"#000000", "#999999", "#8c564b", "#6a3d9a", "#b15928", "#e31a1c"};
enum { COLOUR_COUNT = sizeof colours / sizeof *colours };

typedef struct axis {
	double low, high;
	bool logarithmic;
	int from, to; /* where these are in the picture */
} axis;

static bool shown(double value, bool logarithmic)
{
	return isfinite(value) && (!logarithmic || value > 0);
}

static void widen(axis *a, const double *values, size_t count)
{
	for (size_t i = 0; values && i < count; i++) {
		if (shown(values[i], a->logarithmic)) {
			a->low = fmin(a->low, values[i]);
			a->high = fmax(a->high, values[i]);
		}
	}
}

static axis make_axis(const chart *c, bool vertical, int bottom)
{
	axis a = {INFINITY, -INFINITY, vertical ? c->log_y : c->log_x, vertical ? bottom : LEFT,
		vertical ? TOP : RIGHT};
	for (size_t s = 0; s < c->series_count; s++) {
		widen(&a, vertical ? c->series[s].y : c->series[s].x, c->series[s].count);
		widen(&a, vertical ? c->series[s].high : NULL, c->series[s].count);
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

static double place(const axis *a, double v)
{
	const double share = a->logarithmic ? log10(v / a->low) / log10(a->high / a->low)
					    : (v - a->low) / (a->high - a->low);
	return a->from + share * (a->to - a->from);
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
static void draw_ticks(FILE *f, const axis *a, bool vertical, int bottom)
{
	const double decades = log10(a->high / a->low);
	const int step = decades > 24 ? 10 : decades > 12 ? 5 : decades > 8 ? 2 : 1;
	const int count = a->logarithmic ? (int)(decades + 0.5) / step : 5;
	for (int i = 0; i <= count; i++) {
		const double v = a->logarithmic ? a->low * pow(10, i * step) : a->low + (a->high - a->low) * i / 5;
		char text[32];
		snprintf(text, sizeof text, a->logarithmic && (v < 0.009 || v > 2000) ? "%.0e" : "%g", v);
		if (vertical) {
			const double y = place(a, v);
			fprintf(f, "<path class=\"grid\" d=\"M%d %.1fH%d\"/>\n", LEFT, y, RIGHT);
			print_label(f, LEFT - 6, y + 4, "text-anchor=\"end\"", text);
		} else {
			const double x = place(a, v);
			fprintf(f, "<path class=\"grid\" d=\"M%.1f %dV%d\"/>\n", x, TOP, bottom);
			print_label(f, x, bottom + 16, "text-anchor=\"middle\"", text);
		}
	}
}

static void draw_mark(FILE *f, double x, double y, size_t shape, bool hollow, const char *colour)
{
	const double r = hollow ? 3.5 : 4.5;
	char style[64];
	snprintf(style, sizeof style, hollow ? "fill=\"#fff\" stroke=\"%s\"" : "fill=\"%s\"", colour);
	switch (shape % 4) {
	case 0:
		fprintf(f, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" %s/>\n", x, y, r, style);
		break;
	case 1:
		fprintf(f, "<path d=\"M%.1f %.1fh%.1fv%.1fh%.1fz\" %s/>\n", x - r, y - r, 2 * r,
			2 * r, -2 * r, style);
		break;
	case 2:
		fprintf(f, "<path d=\"M%.1f %.1fl%.1f %.1fh%.1fz\" %s/>\n", x, y - r - 1, r + 1,
			2 * r + 1, -2 * r - 2, style);
		break;
	default:
		fprintf(f, "<path d=\"M%.1f %.1fl%.1f %.1fl%.1f %.1fl%.1f %.1fz\" %s/>\n", x,
			y - r - 1, r + 1, r + 1, -r - 1, r + 1, -r - 1, -r - 1, style);
		break;
	}
}

static void draw_path(FILE *f, const chart *c, size_t s, const axis *ax, const axis *ay, const char *colour)
{
	const chart_series *series = &c->series[s];
	const bool steps = series->style == CHART_STEPS || series->style == CHART_DASHED_STEPS;
	double before = 0;
	bool drawing = false;
	fprintf(f, "<path fill=\"none\" stroke-width=\"1.5\" stroke=\"%s\"%s d=\"M0 0", colour,
		series->style == CHART_DASHED_STEPS ? " stroke-dasharray=\"5 4\"" : "");
	for (size_t i = 0; i < series->count; i++) {
		const bool here = shown(series->x[i], c->log_x) && shown(series->y[i], c->log_y);
		if (here && drawing && steps)
			fprintf(f, "L%.1f %.1f", place(ax, series->x[i]), before);
		if (here)
			fprintf(f, "%c%.1f %.1f", drawing ? 'L' : 'M', place(ax, series->x[i]),
				before = place(ay, series->y[i]));
		drawing = here;
	}
	fprintf(f, "\"/>\n");
}

static void draw_series(FILE *f, const chart *c, size_t s, const axis *ax, const axis *ay)
{
	const chart_series *series = &c->series[s];
	const char *colour = series->style > CHART_RANGES ? "#000" : colours[s % COLOUR_COUNT];
	const size_t shape = series->style == CHART_LINE ? s : s / COLOUR_COUNT;
	draw_path(f, c, s, ax, ay, colour);
	for (size_t i = 0; i < series->count; i++) {
		if (!shown(series->x[i], c->log_x) || !shown(series->y[i], c->log_y) || series->style > CHART_RANGES)
			continue;
		const double x = place(ax, series->x[i]), y = place(ay, series->y[i]);
		if (series->high && shown(series->high[i], c->log_y)) {
			const double top = place(ay, series->high[i]);
			fprintf(f, "<path stroke=\"%s\" stroke-opacity=\"0.4\" d=\"M%.1f %.1fV%.1f\"/>\n",
				colour, x, y, top);
			draw_mark(f, x, top, shape, true, colour);
		}
		draw_mark(f, x, y, shape, false, colour);
		if (series->style == CHART_RANGES && i == 0) {
			char number[24];
			snprintf(number, sizeof number, "%zu", s + 1);
			print_label(f, x, y + 16, "text-anchor=\"middle\" font-size=\"10\"", number);
		}
	}
	char name[160];
	if (series->style == CHART_RANGES)
		snprintf(name, sizeof name, "%zu  %s", s + 1, series->name);
	else
		snprintf(name, sizeof name, "%s", series->name);
	const double y = TOP + 10 + LEGEND_LINE * (double)s;
	if (series->style > CHART_RANGES)
		fprintf(f, "<path stroke=\"%s\" stroke-width=\"1.5\"%s d=\"M%d %.0fh16\"/>\n", colour,
			series->style == CHART_DASHED_STEPS ? " stroke-dasharray=\"5 4\"" : "", RIGHT + 10, y - 4);
	else
		draw_mark(f, RIGHT + 18, y - 4, shape, false, colour);
	print_label(f, RIGHT + 30, y, "font-size=\"11\"", name);
}

bool chart_write(const char *path, const chart *c)
{
	FILE *f = fopen(path, "w");
	if (!f)
		return false;
	const int legend = LEGEND_LINE * (int)c->series_count,
		bottom = TOP + (legend > LEAST_HEIGHT ? legend : LEAST_HEIGHT);
	const axis ax = make_axis(c, false, bottom), ay = make_axis(c, true, bottom);
	fprintf(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\""
		" font-family=\"sans-serif\" font-size=\"12\">\n<style>.grid{stroke:#ddd}</style>\n"
		"<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n", WIDTH, bottom + 60, WIDTH, bottom + 60);
	print_label(f, LEFT, 24, "font-size=\"16\"", c->title);
	print_label(f, LEFT, 44, "fill=\"#555\" font-size=\"11\"", c->subtitle);
	draw_ticks(f, &ax, false, bottom);
	draw_ticks(f, &ay, true, bottom);
	fprintf(f, "<path fill=\"none\" stroke=\"#333\" d=\"M%d %dV%dH%d\"/>\n", LEFT, TOP, bottom, RIGHT);
	print_label(f, (LEFT + RIGHT) / 2.0, bottom + 40, "text-anchor=\"middle\"", c->x_label);
	char turned[80];
	snprintf(turned, sizeof turned, "text-anchor=\"middle\" transform=\"rotate(-90 20 %d)\"",
		(TOP + bottom) / 2);
	print_label(f, 20, (TOP + bottom) / 2.0, turned, c->y_label);
	for (size_t s = 0; s < c->series_count; s++)
		draw_series(f, c, s, &ax, &ay);
	fprintf(f, "</svg>\n");
	return fclose(f) == 0;
}

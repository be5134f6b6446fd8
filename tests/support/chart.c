/* SPDX-License-Identifier: MIT */
/*
 * See chart.h. Colours are O. Okabe's and K. Ito's, which colour-blind readers can tell apart; marks differ
 * in shape as well. A name in place is put where it covers no mark, bar or other name: beside its mark, below or
 * above it; red where there is no such place.
 */
#include "chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
	WIDTH = 1020,
	LEFT = 80,
	RIGHT = 660, /* with a legend */
	RIGHT_ALONE = 1000,
	TOP = 60,
	PANEL_TITLE = 26,     /* height */
	PANEL_HEIGHT = 400,   /* at least, with a legend */
	PANEL_IN_PLACE = 270,
	PANEL_GAP = 30,       /* for the numbers of the axis */
	LEGEND_LINE = 18,
	NAME_LINE = 15,
	MOST_BOXES = 256
};

/* The width of a letter of a name, in its 11 pixels: the average of a wide font, DejaVu Sans. */
static const double LETTER = 6.6;

static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
	"#000000", "#999999", "#8c564b", "#6a3d9a", "#b15928", "#e31a1c"};
enum { COLOUR_COUNT = sizeof colours / sizeof *colours };

typedef struct box {
	double left, top, right, bottom;
} box;

/* What is drawn already and no name may cover. */
typedef struct taken {
	box boxes[MOST_BOXES];
	size_t count;
} taken;

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

/* An axis that has the values of all panels. */
static axis make_axis(const chart *c, bool vertical, int from, int to)
{
	axis a = {INFINITY, -INFINITY, vertical ? c->log_y : c->log_x, from, to};
	for (const chart_panel *p = c->panels; p < c->panels + c->panel_count; p++) {
		for (size_t s = 0; s < p->series_count; s++) {
			widen(&a, vertical ? p->series[s].y : p->series[s].x, p->series[s].count);
			widen(&a, vertical ? p->series[s].high : NULL, p->series[s].count);
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
static void draw_ticks(FILE *f, const axis *a, bool vertical, const axis *across)
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
			fprintf(f, "<path class=\"grid\" d=\"M%d %.1fH%d\"/>\n", across->from, y,
				across->to);
			print_label(f, across->from - 6, y + 4, "text-anchor=\"end\"", text);
		} else {
			const double x = place(a, v);
			fprintf(f, "<path class=\"grid\" d=\"M%.1f %dV%d\"/>\n", x, across->to,
				across->from);
			print_label(f, x, across->from + 16, "text-anchor=\"middle\"", text);
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

static void draw_path(FILE *f, const chart *c, const chart_series *series, const axis *ax,
	const axis *ay, const char *colour)
{
	bool drawing = false;
	fprintf(f, "<path fill=\"none\" stroke-width=\"1.5\" stroke=\"%s\" d=\"M0 0", colour);
	for (size_t i = 0; i < series->count; i++) {
		const bool here = shown(series->x[i], c->log_x) && shown(series->y[i], c->log_y);
		if (here)
			fprintf(f, "%c%.1f %.1f", drawing ? 'L' : 'M', place(ax, series->x[i]),
				place(ay, series->y[i]));
		drawing = here;
	}
	fprintf(f, "\"/>\n");
}

static void take(taken *t, box b)
{
	if (t->count < MOST_BOXES)
		t->boxes[t->count++] = b;
}

static bool is_free(const taken *t, box b)
{
	for (const box *o = t->boxes; o < t->boxes + t->count; o++)
		if (b.left < o->right && o->left < b.right && b.top < o->bottom &&
			o->top < b.bottom)
			return false;
	return true;
}

static void draw_series(FILE *f, const chart *c, const chart_series *series, const axis *ax,
	const axis *ay, const char *colour, size_t shape, taken *marks)
{
	draw_path(f, c, series, ax, ay, colour);
	for (size_t i = 0; i < series->count; i++) {
		if (!shown(series->x[i], c->log_x) || !shown(series->y[i], c->log_y))
			continue;
		const double x = place(ax, series->x[i]), y = place(ay, series->y[i]);
		double top = y;
		if (series->high && shown(series->high[i], c->log_y)) {
			top = place(ay, series->high[i]);
			fprintf(f, "<path stroke=\"%s\" stroke-opacity=\"0.4\" d=\"M%.1f %.1fV%.1f\"/>\n",
				colour, x, y, top);
			draw_mark(f, x, top, shape, true, colour);
			take(marks, (box){x - 6, top - 6, x + 6, top + 6});
		}
		draw_mark(f, x, y, shape, false, colour);
		take(marks, (box){x - 6, y - 6, x + 6, y + 6});
		take(marks, (box){x - 1, top, x + 1, y});
	}
}

/* A name in row `row` from its mark: 0 is beside it, 1 and 2 are below, -1 and -2 above the bar. False: no place. */
static bool draw_name_in(FILE *f, const char *name, int row, double x, double y, const axis *ax, const axis *ay,
	taken *t)
{
	const double width = LETTER * (double)strlen(name), aside = row ? -4 : 9;
	const struct {
		double x, left;
		const char *attributes;
	} ways[] = {{x + aside, x + aside, "font-size=\"11\""},
		{x - aside, x - aside - width, "font-size=\"11\" text-anchor=\"end\""}};
	for (int i = 0; i < 2; i++) {
		const box b = {ways[i].left, y - 6.5, ways[i].left + width, y + 6.5};
		if (b.left < ax->from + 2 || b.right > ax->to || b.top < ay->to || b.bottom > ay->from ||
			!is_free(t, b))
			continue;
		print_label(f, ways[i].x, y + 4, ways[i].attributes, name);
		take(t, b);
		return true;
	}
	return false;
}

static void draw_name(FILE *f, const chart *c, const chart_series *series, const axis *ax, const axis *ay, taken *t)
{
	static const int rows[] = {0, 1, -1, 2, -2};
	if (!series->count || !shown(series->x[0], c->log_x) || !shown(series->y[0], c->log_y))
		return;
	const double x = place(ax, series->x[0]), y = place(ay, series->y[0]);
	const double top = series->high && shown(series->high[0], c->log_y) ? place(ay, series->high[0]) : y;
	bool done = false;
	for (size_t i = 0; i < sizeof rows / sizeof *rows && !done; i++)
		done = draw_name_in(f, series->name, rows[i], x, (rows[i] < 0 ? top : y) + NAME_LINE * rows[i], ax, ay,
			t);
	if (!done)
		print_label(f, x, y + NAME_LINE, "font-size=\"11\" fill=\"#d00\"", series->name);
}

static void draw_panel(FILE *f, const chart *c, const chart_panel *p, int top, int bottom)
{
	const axis ax = make_axis(c, false, LEFT, c->in_place ? RIGHT_ALONE : RIGHT),
		   ay = make_axis(c, true, bottom, top);
	taken marks = {.count = 0};
	draw_ticks(f, &ax, false, &ay);
	draw_ticks(f, &ay, true, &ax);
	fprintf(f, "<path fill=\"none\" stroke=\"#333\" d=\"M%d %dV%dH%d\"/>\n", LEFT, top, bottom,
		ax.to);
	if (p->title)
		print_label(f, LEFT, top - 8, "font-weight=\"bold\"", p->title);
	for (size_t s = 0; s < p->series_count; s++) {
		const char *colour = colours[s % COLOUR_COUNT];
		draw_series(f, c, &p->series[s], &ax, &ay, colour, s, &marks);
		const double y = top + 10 + LEGEND_LINE * (double)s;
		if (!c->in_place) {
			draw_mark(f, RIGHT + 18, y - 4, s, false, colour);
			print_label(f, RIGHT + 30, y, "font-size=\"11\"", p->series[s].name);
		}
	}
	for (size_t s = 0; s < p->series_count && c->in_place; s++)
		draw_name(f, c, &p->series[s], &ax, &ay, &marks);
}

static int panel_height(const chart *c, const chart_panel *p)
{
	const int legend = LEGEND_LINE * (int)p->series_count;
	return c->in_place ? PANEL_IN_PLACE : legend > PANEL_HEIGHT ? legend : PANEL_HEIGHT;
}

bool chart_write(const char *path, const chart *c)
{
	FILE *f = fopen(path, "w");
	if (!f)
		return false;
	int height = TOP;
	for (const chart_panel *p = c->panels; p < c->panels + c->panel_count; p++)
		height += (p->title ? PANEL_TITLE : 0) + panel_height(c, p) + PANEL_GAP;
	fprintf(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\""
		" font-family=\"sans-serif\" font-size=\"12\">\n<style>.grid{stroke:#ddd}</style>\n"
		"<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n", WIDTH, height + 30, WIDTH, height + 30);
	print_label(f, LEFT, 24, "font-size=\"16\"", c->title);
	print_label(f, LEFT, 44, "fill=\"#555\" font-size=\"11\"", c->subtitle);
	int top = TOP;
	for (const chart_panel *p = c->panels; p < c->panels + c->panel_count; p++) {
		top += p->title ? PANEL_TITLE : 0;
		const int bottom = top + panel_height(c, p);
		draw_panel(f, c, p, top, bottom);
		char turned[80];
		snprintf(turned, sizeof turned,
			"text-anchor=\"middle\" transform=\"rotate(-90 20 %d)\"",
			(top + bottom) / 2);
		print_label(f, 20, (top + bottom) / 2.0, turned, c->y_label);
		top = bottom + PANEL_GAP;
	}
	print_label(f, (LEFT + (c->in_place ? RIGHT_ALONE : RIGHT)) / 2.0, height + 10,
		"text-anchor=\"middle\"", c->x_label);
	fprintf(f, "</svg>\n");
	return fclose(f) == 0;
}

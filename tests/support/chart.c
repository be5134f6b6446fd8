/* SPDX-License-Identifier: MIT */
/*
 * See chart.h. Colours are O. Okabe's and K. Ito's, which colour-blind readers can tell apart; marks differ in
 * shape as well. A name is put where it covers no mark, bar or other name: beside its mark, below or above it; red
 * where there is no such place.
 */
#include "chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
	WIDTH = 1020,
	LEFT = 80,
	RIGHT = 1000,
	TOP = 60,
	PANEL_TITLE = 26, /* height */
	PANEL_HEIGHT = 270,
	PANEL_GAP = 30,   /* for the numbers of the axis */
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

/* Boxes that are drawn already, which no name may cover. */
typedef struct taken {
	box boxes[MOST_BOXES];
	size_t count;
} taken;

/* Logarithmic. */
typedef struct axis {
	double low, high;
	int from, to; /* where these are in the picture */
} axis;

static bool shown(double value)
{
	return isfinite(value) && value > 0;
}

static void widen(axis *a, double value)
{
	if (shown(value)) {
		a->low = fmin(a->low, value);
		a->high = fmax(a->high, value);
	}
}

/* An axis that has the values of all panels. */
static axis make_axis(const chart *c, bool vertical, int from, int to)
{
	axis a = {INFINITY, -INFINITY, from, to};
	for (const chart_panel *p = c->panels; p < c->panels + c->panel_count; p++) {
		for (size_t i = 0; i < p->mark_count; i++) {
			widen(&a, vertical ? p->marks[i].y : p->marks[i].x);
			widen(&a, vertical ? p->marks[i].high : NAN);
		}
	}
	if (!(a.low <= a.high))
		a.low = a.high = 1;
	a.low = pow(10, floor(log10(a.low)));
	a.high = pow(10, ceil(log10(a.high)));
	if (a.low == a.high)
		a.high *= 10;
	return a;
}

static double place(const axis *a, double v)
{
	return a->from + log10(v / a->low) / log10(a->high / a->low) * (a->to - a->from);
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

/* Ticks at powers of ten. */
static void draw_ticks(FILE *f, const axis *a, bool vertical, const axis *across)
{
	const double decades = log10(a->high / a->low);
	const int step = decades > 24 ? 10 : decades > 12 ? 5 : decades > 8 ? 2 : 1;
	for (int i = 0; i <= (int)(decades + 0.5) / step; i++) {
		const double v = a->low * pow(10, i * step), at = place(a, v);
		char text[32];
		snprintf(text, sizeof text, v < 0.009 || v > 2000 ? "%.0e" : "%g", v);
		if (vertical) {
			fprintf(f, "<path class=\"grid\" d=\"M%d %.1fH%d\"/>\n", across->from, at, across->to);
			print_label(f, across->from - 6, at + 4, "text-anchor=\"end\"", text);
		} else {
			fprintf(f, "<path class=\"grid\" d=\"M%.1f %dV%d\"/>\n", at, across->to, across->from);
			print_label(f, at, across->from + 16, "text-anchor=\"middle\"", text);
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

/* Full at y, hollow at `high`, with a bar between them. */
static void draw_marks(FILE *f, const chart_mark *m, const axis *ax, const axis *ay, size_t number, taken *marks)
{
	if (!shown(m->x) || !shown(m->y))
		return;
	const char *colour = colours[number % COLOUR_COUNT];
	const double x = place(ax, m->x), y = place(ay, m->y), top = shown(m->high) ? place(ay, m->high) : y;
	if (shown(m->high)) {
		fprintf(f, "<path stroke=\"%s\" stroke-opacity=\"0.4\" d=\"M%.1f %.1fV%.1f\"/>\n", colour, x, y, top);
		draw_mark(f, x, top, number, true, colour);
		take(marks, (box){x - 6, top - 6, x + 6, top + 6});
	}
	draw_mark(f, x, y, number, false, colour);
	take(marks, (box){x - 6, y - 6, x + 6, y + 6});
	take(marks, (box){x - 1, top, x + 1, y});
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

static void draw_name(FILE *f, const chart_mark *m, const axis *ax, const axis *ay, taken *t)
{
	static const int rows[] = {0, 1, -1, 2, -2};
	if (!shown(m->x) || !shown(m->y))
		return;
	const double x = place(ax, m->x), y = place(ay, m->y), top = shown(m->high) ? place(ay, m->high) : y;
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		if (draw_name_in(f, m->name, rows[i], x, (rows[i] < 0 ? top : y) + NAME_LINE * rows[i], ax, ay, t))
			return;
	print_label(f, x, y + NAME_LINE, "font-size=\"11\" fill=\"#d00\"", m->name);
}

static void draw_panel(FILE *f, const chart *c, const chart_panel *p, int top, int bottom)
{
	const axis ax = make_axis(c, false, LEFT, RIGHT), ay = make_axis(c, true, bottom, top);
	taken marks = {.count = 0};
	draw_ticks(f, &ax, false, &ay);
	draw_ticks(f, &ay, true, &ax);
	fprintf(f, "<path fill=\"none\" stroke=\"#333\" d=\"M%d %dV%dH%d\"/>\n", LEFT, top, bottom, RIGHT);
	print_label(f, LEFT, top - 8, "font-weight=\"bold\"", p->title);
	for (size_t i = 0; i < p->mark_count; i++)
		draw_marks(f, &p->marks[i], &ax, &ay, i, &marks);
	for (size_t i = 0; i < p->mark_count; i++)
		draw_name(f, &p->marks[i], &ax, &ay, &marks);
}

bool chart_write(const char *path, const chart *c)
{
	FILE *f = fopen(path, "w");
	if (!f)
		return false;
	const int height = TOP + (int)c->panel_count * (PANEL_TITLE + PANEL_HEIGHT + PANEL_GAP);
	fprintf(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\""
		" font-family=\"sans-serif\" font-size=\"12\">\n<style>.grid{stroke:#ddd}</style>\n"
		"<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n", WIDTH, height + 30, WIDTH, height + 30);
	print_label(f, LEFT, 24, "font-size=\"16\"", c->title);
	print_label(f, LEFT, 44, "fill=\"#555\" font-size=\"11\"", c->subtitle);
	int top = TOP;
	for (const chart_panel *p = c->panels; p < c->panels + c->panel_count; p++) {
		top += PANEL_TITLE;
		const int bottom = top + PANEL_HEIGHT;
		draw_panel(f, c, p, top, bottom);
		char turned[80];
		snprintf(turned, sizeof turned,
			"text-anchor=\"middle\" transform=\"rotate(-90 20 %d)\"",
			(top + bottom) / 2);
		print_label(f, 20, (top + bottom) / 2.0, turned, c->y_label);
		top = bottom + PANEL_GAP;
	}
	print_label(f, (LEFT + RIGHT) / 2.0, height + 10, "text-anchor=\"middle\"", c->x_label);
	fprintf(f, "</svg>\n");
	return fclose(f) == 0;
}

/* SPDX-License-Identifier: MIT */
/*
 * A chart of named marks as a small SVG file: panels over the same logarithmic axes, one below the other.
 */
#ifndef NT_CHART_H
#define NT_CHART_H

#include <stdbool.h>
#include <stddef.h>

/* A value that is not positive and finite is not shown. */
typedef struct chart_mark {
	const char *name;
	double x, y, high; /* a bar leads up to `high`, where a hollow mark is */
} chart_mark;

typedef struct chart_panel {
	const char *title;
	const chart_mark *marks;
	size_t mark_count;
} chart_panel;

typedef struct chart {
	const char *title, *subtitle, *x_label, *y_label;
	const chart_panel *panels;
	size_t panel_count;
} chart;

/* False where the file cannot be written. */
bool chart_write(const char *path, const chart *c);

#endif

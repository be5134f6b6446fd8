/* SPDX-License-Identifier: MIT */
/*
 * Charts as small SVG files: panels over the same linear or logarithmic axes, one below the other.
 */
#ifndef NT_CHART_H
#define NT_CHART_H

#include <stdbool.h>
#include <stddef.h>

typedef struct chart_series {
	const char *name;
	const double *x, *y; /* [count]; a value that is not finite, or not positive on a logarithmic axis,
	                        leaves a gap */
	size_t count;
	const double *
		high; /* [count]: each mark has a bar up to here, where a hollow mark is; NULL: no bars */
} chart_series;

typedef struct chart_panel {
	const char *title; /* NULL: none */
	const chart_series *series;
	size_t series_count;
} chart_panel;

typedef struct chart {
	const char *title, *subtitle, *x_label, *y_label;
	bool log_x, log_y;
	bool in_place; /* names stand at the first mark of their series, not in a legend */
	const chart_panel *panels;
	size_t panel_count;
} chart;

/* False where the file cannot be written. */
bool chart_write(const char *path, const chart *c);

#endif

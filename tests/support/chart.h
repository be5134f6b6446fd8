/* SPDX-License-Identifier: MIT */
/*
 * Charts as small SVG files: lines, ranges and steps over linear or logarithmic axes.
 */
#ifndef NT_CHART_H
#define NT_CHART_H

#include <stdbool.h>
#include <stddef.h>

typedef enum chart_style {
	CHART_LINE,        /* marks, joined */
	CHART_RANGES,      /* the same, numbered, each with a bar up to `high`, which has a hollow mark */
	CHART_STEPS,       /* no marks; right, then up or down */
	CHART_DASHED_STEPS
} chart_style;

typedef struct chart_series {
	const char *name;
	const double *x, *y; /* [count]; a value that is not finite, or not positive on a logarithmic axis,
	                        leaves a gap */
	size_t count;
	chart_style style;
	const double *high; /* [count]; NULL: no bars */
} chart_series;

typedef struct chart {
	const char *title, *subtitle, *x_label, *y_label;
	bool log_x, log_y;
	const chart_series *series;
	size_t series_count;
} chart;

/* False where the file cannot be written. */
bool chart_write(const char *path, const chart *c);

#endif
